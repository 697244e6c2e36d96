"""Answers that wait for a person: the queue of them, and what the person decides."""
