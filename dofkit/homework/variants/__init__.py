"""A sheet for each student, from a seed: other numbers, names and constraints, as hard as the others, its key proved."""
