"""How sure an answer is."""

from __future__ import annotations

from typing import Literal

Verdict = Literal["proved", "probable", "numeric", "undecided"]

#: Which points a claim speaks of: the part near the reference, that near the witness, all.
About = Literal["reference", "component", "everywhere"]


#: From the strongest to the weakest.
VERDICTS: tuple[Verdict, ...] = ("proved", "probable", "numeric", "undecided")


def weakest(*verdicts: Verdict) -> Verdict:
    """The weakest of some verdicts; of none, ``proved``.

    >>> weakest("proved", "numeric", "probable")
    'numeric'
    """
    return max(verdicts, key=VERDICTS.index, default="proved")
