"""How certain an answer is, for which points, and by which argument."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log2
from typing import Literal, get_args

Verdict = Literal["proved", "probable", "numeric", "undecided"]

#: The points for which a claim is made: those near the reference, those near a witness point, all.
About = Literal["reference", "component", "everywhere"]

#: The arguments by which answers are given. Each is a row of the table in `classification/arguments.yaml`.
ArgumentKey = Literal[
    "nothing constrains",
    "regular point",
    "one relation",
    "graph",
    "cases",
    "joints that close no loop",
    "independent relations",
    "rigid to first order",
    "zero along a curve",
    "flat along a curve",
    "isolated zero of one variable",
    "indefinite form",
    "definite form",
    "definite combination",
    "least along a motion",
    "change of sign",
    "critical branch",
    "branch followed",
    "singular values",
    "links in general position",
    "linear contradiction",
    "no real solution",
    "lengths compared",
    "inequality nowhere",
    "outside the domain",
    "number left over",
    "time fixed",
    "generic points",
    "Lie algebra, certified",
    "Lie algebra at points",
    "Lie algebra with balls",
    "states of motion",
    "finite relation",
    "inequality",
    "curved velocities",
    "line field",
    "form by itself",
    "in the integrable part",
    "outside the integrable part",
    "as written",
    "identity",
    "zero with another derivative",
    "rank at the reference",
    "zero at the reference",
    "free Lie algebra",
    "brackets at points",
    "rows at a point",
    "implication",
    "leaving out",
    "count",
    "one method alone",
    "exact elimination",
    "met at a point",
    "excluded together",
]
ARGUMENTS: frozenset[str] = frozenset(get_args(ArgumentKey))

#: An answer to a yes-no question (None: undecided), and its verdict.
TraitAnswer = tuple[bool | None, Verdict]

#: From the strongest to the weakest.
VERDICTS: tuple[Verdict, ...] = ("proved", "probable", "numeric", "undecided")
#: From the smallest set of points to the largest.
ABOUTS: tuple[About, ...] = ("reference", "component", "everywhere")


def weakest(*verdicts: Verdict) -> Verdict:
    """Return the weakest of ``verdicts``, ``proved`` if there are none.

    >>> weakest("proved", "numeric", "probable")
    'numeric'
    """
    return max(verdicts, key=VERDICTS.index, default="proved")


def all_of(answers: Sequence[TraitAnswer]) -> TraitAnswer:
    """Return whether all answers are True, with its verdict: one False decides, else one None leaves it undecided."""
    denied = [sure for holds, sure in answers if holds is False]
    if denied:
        return False, min(denied, key=VERDICTS.index)
    if any(holds is None for holds, _ in answers):
        return None, "undecided"
    return True, weakest(*(sure for _, sure in answers))


def least(*abouts: About) -> About:
    """Return the smallest of ``abouts``: the points for which a claim that needs several others is made.

    >>> least("everywhere", "reference")
    'reference'
    """
    return min(abouts, key=ABOUTS.index, default="everywhere")


@dataclass(frozen=True)
class Claim:
    """How certain one answer is (``verdict``), by which argument, and for which points (``about``).

    ``bits``: a ``probable`` answer is wrong with probability below 2^-bits; ``gap``: the ratio that separates nonzero
    from zero values in a ``numeric`` answer. Raises ValueError if the argument, or this number, is missing.

    >>> Claim("proved")
    Traceback (most recent call last):
    ValueError: 'proved' by no argument of the table: None
    """

    verdict: Verdict
    argument: ArgumentKey | None = None
    bits: int | None = None
    gap: float | None = None
    about: About = "everywhere"

    def __post_init__(self) -> None:
        if self.verdict != "undecided" and self.argument not in ARGUMENTS:
            raise ValueError(f"{self.verdict!r} by no argument of the table: {self.argument}")
        if self.verdict == "probable" and self.bits is None:
            raise ValueError("a probable answer needs a bound on its error")
        if self.verdict == "numeric" and self.gap is None:
            raise ValueError("a numeric answer needs a gap")

    @property
    def bound(self) -> str | None:
        """The bound on the error probability, or the gap, as text; None for other verdicts."""
        if self.verdict == "probable":
            return f"2^-{self.bits}"
        return f"{self.gap:.1e}" if self.verdict == "numeric" and self.gap is not None else None


OPEN = Claim("undecided")


def together(*claims: Claim) -> Claim:
    """Return the claim that all ``claims`` are true, with the argument of the weakest; error probabilities add up.

    >>> together(Claim("proved", "graph"), Claim("probable", "cases", bits=40), Claim("probable", "graph", bits=40))
    Claim(verdict='probable', argument='cases', bits=39, gap=None, about='everywhere')
    """
    if not claims:
        return Claim("proved", "nothing constrains")
    worst = max(claims, key=lambda c: VERDICTS.index(c.verdict))
    about = least(*(c.about for c in claims))
    errors = sum(2.0**-c.bits for c in claims if c.verdict == "probable" and c.bits is not None)
    bits = None if worst.verdict != "probable" else int(-log2(errors))
    gaps = [c.gap for c in claims if c.verdict == "numeric" and c.gap is not None]
    return Claim(worst.verdict, worst.argument, bits, min(gaps) if worst.verdict == "numeric" else None, about)
