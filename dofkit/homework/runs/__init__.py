"""Grading of many submissions by workers, with a journal from which an interrupted run continues."""
