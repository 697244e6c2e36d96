"""Exclusion by boxes: interval arithmetic and contraction."""
