"""Submissions: reading files and tables, and the texts of answers."""
