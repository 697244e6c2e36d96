"""The rows of a review: one for each different answer, with what a person decided of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

#: The columns of the table, in order; those that a person fills in come last.
COLUMNS = (
    "id", "problem", "question", "variant", "text", "why", "readings", "would_earn", "max_points", "students",
    "given_by", "points", "remark", "decided_by",
)  # fmt: skip
#: Who decided, where the table does not say.
SOMEONE = "review"


class Decision(NamedTuple):
    """The points that a person gave an answer, what the person says to it, and who that is."""

    points: Fraction
    remark: str = ""
    by: str = SOMEONE


#: What a person decided, by the answer's identity.
Decisions = Mapping[str, Decision]


@dataclass(frozen=True)
class ReviewRow:
    """One row, every cell as text; ``decision`` is what its last columns say, None while it is open."""

    cells: Mapping[str, str]
    decision: Decision | None = None

    @property
    def id(self) -> str:
        """The answer's identity."""
        return self.cells["id"]

    @property
    def filled(self) -> bool:
        """Has a person written anything into it?"""
        return self.decision is not None or bool(self.cells.get("remark"))
