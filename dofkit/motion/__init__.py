"""A classified system in time: Lagrange's equations, and configurations along a motion.

The room of Lagrange's equations bears the name of its function, so ``lagrange`` is handed on by that room, not here.
"""
