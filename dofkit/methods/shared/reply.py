"""What a method is given beside a scene, and what it tells."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from dofkit.base.verdicts import Verdict


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


@dataclass(frozen=True)
class MethodLabel:
    """What a method knows of one constraint's holonomy, and why; ``exact``: closed as written."""

    holonomic: bool | None
    reason: str
    verdict: Verdict = "proved"
    alone: bool | None = None
    exact: bool | None = None


@dataclass(frozen=True)
class MethodFindings:
    """What a method tells: fields of the report it is sound for, labels by constraint, and sentences.

    ``independent``: all equations are independent, as surely as ``verdict`` says.
    """

    fields: Mapping[str, Any]
    labels: Mapping[int, MethodLabel]
    warnings: Sequence[str]
    independent: bool = False
    verdict: Verdict = "proved"
