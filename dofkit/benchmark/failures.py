"""What makes a trial hard, and why a method fails on it, in one sentence a student understands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import resources
from typing import Any

import yaml

from dofkit.methods.table import METHODS

_TABLES: Mapping[str, Mapping[str, Any]] = yaml.safe_load(
    (resources.files(__package__) / "failures.yaml").read_text(encoding="utf-8")
)
#: Every trait of a trial, in words.
TRAITS: Mapping[str, str] = _TABLES["traits"]
#: The sentence for a method and a trait.
WHY: Mapping[tuple[str, str], str] = {
    (method, trait): row["why"]
    for method, rows in _TABLES["sentences"].items()
    for row in rows
    for trait in row["traits"].split()
}


def explained(method: str, question: str, traits: Sequence[str], outcome: str, reason: str = "") -> str:
    """Return why a method fails on a trial, as a sentence; never empty.

    ``traits``: of the trial, the one that matters most first; ``outcome``: ``wrong``, ``undecided``, ``cannot`` or
    ``timed out``; ``reason``: what the method said itself.
    """
    row = next((row for name, row in METHODS.items() if name == method), None)
    cannot = _sentence(row.cannot) if row is not None else f"{method} does not answer this."
    if outcome == "cannot" or (outcome == "undecided" and reason):
        return _sentence(reason) if reason else cannot
    if outcome == "timed out":
        costs = [use.costs for asked, use in row.uses.items() if asked == question] if row is not None else []
        return " ".join([_TABLES["slow"].get(method, cannot), *(f"Its cost: {cost}." for cost in costs)])
    return next((WHY[method, trait] for trait in traits if (method, trait) in WHY), cannot)


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}{'' if text.endswith('.') else '.'}"
