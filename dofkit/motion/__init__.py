"""A classified system in time: Lagrange's equations, and configurations along a motion."""
