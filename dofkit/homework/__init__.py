"""Assignments, answers, judgements, results, and the platforms that take them."""
