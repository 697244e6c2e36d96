"""The ways to answer how a system can move, as a table: each sound for something, none for everything but ``auto``.

What they share is exact: reading, and rewriting a relation to its real zero set in the canonical ring. They differ
in who decides ranks, zeros and integrability.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from dofkit.exact.engines import BALLS, BOTH, FIELD, Engines

if TYPE_CHECKING:
    from dofkit.report import Verdict

MethodName = Literal["auto", "field", "balls"]
#: What the methods are held against each other in.
Question = Literal["dof", "integrability", "redundancy", "equivalence"]


@dataclass(frozen=True)
class Method:
    """One way to answer: the engines it may ask, what it is sound for, what it cannot answer, its best verdict."""

    engines: Engines
    sound_for: str
    cannot: str
    best: Verdict


METHODS: Mapping[MethodName, Method] = {
    "auto": Method(
        BOTH,
        "everything it does not call undecided: the engines check each other, and proofs are used where there are any",
        "what neither engine nor a proof decides is undecided, with the reason",
        "proved",
    ),
    "field": Method(
        FIELD,
        "zero, and so dependence and integrability, with a chance of an error below 10^-15 a point; non-zero where the "
        "functions of the scene are algebraically independent",
        "it does not tell whether a real configuration exists (its numbers are those of the complex solutions), which "
        "way a second-order form bends, nor anything of measured geometry; integrals are not sought",
        "probable",
    ),
    "balls": Method(
        BALLS,
        "non-zero, full rank and non-holonomy, which are proofs; zero only as what no ball tells from 0",
        "it does not tell that relations contradict each other unless they do so as written, gives no growth vector, "
        "and takes a difference too small for its precision for 0; integrals are not sought",
        "proved",
    ),
}
