"""What number would a known error give for this scene? An answer that is one of them is explained by it."""

from __future__ import annotations

from fractions import Fraction

from dofkit.homework.key import Key
from dofkit.report import ConstraintEntry


def explain(given: Fraction, ask: str, key: Key) -> tuple[tuple[str, ...], str]:
    """(codes of the errors that give this number, the most likely first; what to say about them)."""
    del given, ask, key
    return (), ""


def explain_label(part: str, entry: ConstraintEntry, key: Key) -> tuple[str, str]:
    """(code, what to say) where the label of a part is wrong."""
    del key
    return f"LABEL_{part.upper()}", f"Whether it is {part} is not right: {entry.reason}"
