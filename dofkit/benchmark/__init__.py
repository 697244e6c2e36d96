"""Trials whose answers are known by construction, every method on each of them, and the charts of it."""
