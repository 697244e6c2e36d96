"""Sheets of students, made from a seed: other numbers, names and constraints, as hard as each other, keys proved."""
