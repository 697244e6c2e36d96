"""Rendering of what was found."""
