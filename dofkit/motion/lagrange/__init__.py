"""Lagrange's equations of a scene: energies, elimination, multipliers, conserved quantities, small motions."""
