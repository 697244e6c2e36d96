"""Matrices: ranks modulo p, certified ranks, sparse elimination."""
