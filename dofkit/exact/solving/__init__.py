"""Polynomial systems: triangular solving modulo p, ideals."""
