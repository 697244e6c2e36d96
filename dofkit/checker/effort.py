"""The work that one verification may cost, counted in units of its own so that it is the same on every machine."""

from __future__ import annotations

from dofkit.checker.errors import CheckError

#: Units of work of a whole certificate: about products of terms of polynomials, or nodes evaluated.
MOST_WORK = 60_000_000


class Effort:
    """A purse of units: what has spent them all is refused."""

    def __init__(self, units: int = MOST_WORK) -> None:
        self.left = units

    def spend(self, units: int) -> None:
        """Take units out of the purse."""
        self.left -= units
        if self.left < 0:
            raise CheckError("the work that a certificate may cost is used up")
