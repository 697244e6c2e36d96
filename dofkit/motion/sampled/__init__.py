"""Configurations along a motion, followed by arclength."""
