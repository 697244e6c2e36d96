"""A sheet for each student, from a seed: other numbers, names and constraints, of the same difficulty, its key proved."""
