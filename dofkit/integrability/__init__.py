"""Codistributions: the Lie algebra of admissible velocities, the derived flag, hidden relations, integrals.

`first_integrals` and `traits` stand in files of their own names, which hide a function that a room would hand on.
"""
