"""Relations between joint values as readable texts: letters for joints, short numbers, no zero terms."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

#: Decimals to which numbers are rounded, because a compiler with doubles is not more precise.
DECIMALS = 12
#: The reason why a hinge's range is left out.
OVER = (
    "it extends beyond half a turn from the reference configuration, where the angle of a hinge in space starts again"
)
_LETTERS = "pqrsuvwabcdefgh"


class JointSum(NamedTuple):
    """A sum of (joint, factor) ``terms``, joint values from the reference on, and its value there (``reference``)."""

    terms: tuple[tuple[str, float], ...]
    reference: float = 0.0

    def text(self, letters: dict[str, str]) -> str:
        """Return the sum as text; new joints are added to ``letters``, {joint: letter}."""
        terms = []
        for name, factor in self.terms:
            letter = letters.setdefault(name, _letter(len(letters)))
            terms.append(_term(factor, letter))
        if round(self.reference, DECIMALS):
            terms.append(_signed(figures(self.reference)))
        return _joined(terms)


def relation(driven: JointSum, driving: JointSum | None, polynomial: Sequence[float]) -> dict[str, Any]:
    """Return the fields of a coupling driven = a0 + a1 driving + a2 driving^2 + ..., with the a of ``polynomial``.

    >>> relation(JointSum((("hip", 1.0),)), JointSum((("knee", 1.0),)), [0, 2, 0, 0, 0])
    {'joints': {'p': 'hip', 'q': 'knee'}, 'text': 'p = 2 q'}
    >>> relation(JointSum((("hip", 1.0),)), JointSum((("knee", -1.0),)), [0, 0, 2, 0, 0])["text"]
    'p = 2 (-q)^2'
    """
    letters: dict[str, str] = {}
    first = driven.text(letters)
    terms = [_signed(figures(polynomial[0]))] if polynomial[0] else []
    if driving is not None:
        other = driving.text(letters)
        base = other if other in letters.values() else f"({other})"
        for power, factor in enumerate(polynomial[1:], 1):
            if factor:
                terms.append(_term(factor, base if power == 1 else f"{base}^{power}"))
    return {"joints": {letter: name for name, letter in letters.items()}, "text": f"{first} = {_joined(terms)}"}


def bounds(total: JointSum, between: Sequence[float]) -> dict[str, Any]:
    """Return the fields of a coupling with the inequality that a sum is between two numbers.

    >>> bounds(JointSum((("hip", 1.0),)), [-1, 0.5])
    {'joints': {'p': 'hip'}, 'text': '-1 <= p <= 0.5'}
    """
    letters: dict[str, str] = {}
    text = JointSum(total.terms).text(letters)
    low, high = (figures(b - total.reference) for b in between)
    return {"joints": {letter: name for name, letter in letters.items()}, "text": f"{low} <= {text} <= {high}"}


def whole_turns(reference: float, between: Sequence[float]) -> float | None:
    """Return the multiple of 2 pi by which a hinge's range must be shifted to be within half a turn of the reference.

    None if the range extends beyond half a turn, 0 if it contains a full turn around the reference. Angles in radians.

    >>> round(whole_turns(0.0, [3.5, 5.0]), 6), whole_turns(0.0, [-7.0, 7.0]), whole_turns(0.0, [3.0, 4.0])
    (6.283185, 0.0, None)
    """
    low, high = (b - reference for b in between)
    if high - low >= math.tau:
        return 0.0 if low <= -math.pi and high >= math.pi else None
    turns = math.tau * round((low + high) / 2 / math.tau)
    return turns if low - turns >= -math.pi and high - turns <= math.pi else None


def figures(value: float) -> str:
    """Return a number as decimal text, rounded to `DECIMALS`, without an exponent.

    >>> figures(1e-05), figures(-2.0)
    ('0.00001', '-2')
    """
    text = f"{value:.{DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _letter(k: int) -> str:
    return _LETTERS[k] if k < len(_LETTERS) else f"q{k}"


def _term(factor: float, what: str) -> str:
    """Return a term with its sign."""
    size = figures(abs(factor))
    return ("- " if factor < 0 else "+ ") + (what if size == "1" else f"{size} {what}")


def _signed(text: str) -> str:
    return f"- {text[1:]}" if text.startswith("-") else f"+ {text}"


def _joined(terms: Iterable[str]) -> str:
    text = " ".join(terms)
    if text.startswith("- "):
        return f"-{text[2:]}"
    return text.removeprefix("+ ") or "0"
