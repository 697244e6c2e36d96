"""Inequalities together with the constraints: points at which all hold, and proofs that there is none."""
