"""The arguments of a method beside a scene, and its answer to one question."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from dofkit.base.verdicts import Verdict


@dataclass(frozen=True)
class Knobs:
    """Settings of a method.

    ``tolerance``: singular values and differences below this share of the largest count as 0 (numeric); ``bits``: the
    precision of balls, None for the ladder that they climb by themselves; ``prime_bits``: the size of a field's primes.
    """

    tolerance: float = 1e-9
    bits: int | None = None
    prime_bits: int = 61
    seed: int = 0


@dataclass(frozen=True)
class MethodReply:
    """The answer of a method to a question; ``value`` is None where it gives none, with the reason.

    ``cannot``: it never answers such a question, or one about such a scene. ``verdict``: how certain the value is by
    the method's own argument; of a mapping of labels, how certain those are that are true.
    """

    value: Any | None
    reason: str = ""
    cannot: bool = False
    verdict: Verdict = "undecided"


def cannot(reason: str) -> MethodReply:
    """Return a reply without a value."""
    return MethodReply(None, reason, cannot=True)
