"""Finite relations that Pfaffian forms integrate to, each proved by differentiating."""
