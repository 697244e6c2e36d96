"""Integrals of single Pfaffian forms: potentials and integrating factors, each proved by differentiation."""
