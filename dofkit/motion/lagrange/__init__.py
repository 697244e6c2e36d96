"""Lagrange's equations: energies, elimination, multipliers, small motions."""
