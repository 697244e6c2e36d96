"""Geometric equations that Pfaffian forms integrate to, each proved by differentiating."""
