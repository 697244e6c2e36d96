"""Matrices: ranks modulo p, certified ranks, sparse and dense elimination."""
