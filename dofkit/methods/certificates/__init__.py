"""Certificates: evidence for what a report says is proved, found afterwards in the checker's own reading."""
