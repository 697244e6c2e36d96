"""What a method is given beside a scene, and what it tells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Knobs:
    """What can be turned on a method.

    ``tolerance``: singular values and differences below this share of the largest count as 0 (numeric); ``bits``: the
    precision of balls, None for the ladder that they climb by themselves; ``prime_bits``: the size of a field's primes.
    """

    tolerance: float = 1e-9
    bits: int | None = None
    prime_bits: int = 61
    seed: int = 0


@dataclass(frozen=True)
class MethodReply:
    """What a method answers to a question: None where it cannot or does not, and then why.

    ``cannot``: it never answers such a question, or one about such a scene; else it tried.
    """

    value: Any | None
    reason: str = ""
    cannot: bool = False


def cannot(reason: str) -> MethodReply:
    """Nothing, and why."""
    return MethodReply(None, reason, cannot=True)
