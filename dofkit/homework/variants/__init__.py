"""Sheets for students, from a seed: other numbers, names and constraints, as hard as the others, with its key proved."""
