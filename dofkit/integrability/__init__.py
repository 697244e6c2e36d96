"""Codistributions: the Lie algebra of admissible velocities, the derived flag, hidden relations, integrals."""
