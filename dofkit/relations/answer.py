"""What is known of one block, and what the engines may assume of it."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from flint import arb

from dofkit.base.verdicts import OPEN, About, ArgumentKey, Claim, Verdict
from dofkit.exact.matrices.sparse import SparseRow, Supports
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block

#: The chance of an error at points over GF(p) is below 2 to the minus this; ratios that tell 0 from not 0 are larger.
BITS, GAP = 30, 1e3


@dataclass(frozen=True)
class HolonomyLabel:
    """Whether a row is a consequence of geometric equations, how certain, and why.

    ``modulo``: it is none, but one of geometric equations together with the other rows.
    """

    holonomic: bool | None
    verdict: Verdict
    reason: str = ""
    modulo: bool = False


class RealRows(NamedTuple):
    """The Jacobian of geometric equations at a certified real point, in balls, by coordinates."""

    names: tuple[str, ...]
    matrix: Sequence[Sequence[arb]]


class Size(NamedTuple):
    """What was computed with: coordinates, geometric equations, and one-forms that were tested for integrability."""

    coordinates: int = 0
    relations: int = 0
    forms: int = 0


class FollowedClasses(NamedTuple):
    """Relations ``left_out``, and the ``coordinates`` of those that were followed, ``spared`` fewer than these have."""

    left_out: int = 0
    coordinates: int = 0
    spared: int = 0


class AnsweredPart(NamedTuple):
    """Of a block that joints without loops hold together: what they hold, answered by itself."""

    block: Block
    answer: Answer


DEFECTS = logging.getLogger("dofkit.defects")


@dataclass
class Answer:
    """What is known of a block. Numbers are None where undecided; ``reasons`` say why.

    ``matrix``: the rows (in the block's order) over the coordinates and time at a generic point over GF(p), for
    redundancy; ``supports``: where something else than the matrix tells what depends on what; ``hidden`` the geometric
    equations that the differential ones force, ``hidden_branches`` those on each of several branches; ``doubt``:
    functions or numbers occur that may be related in a way that GF(p) does not show; ``late``: no time was left;
    ``conflict``: a minimal set of constraints that cannot hold together, where the proof shows one;
    ``linear``: every relation is linear with rational coefficients, and all of them were eliminated exactly;
    ``looked``: what was looked at of the relations; ``size``: of the model that was computed with; ``about``: of which
    points it is; ``argument``: by which row of the table, with a chance of error below 2^-``bits``, or a ``gap``;
    ``witness``: a certified configuration, as text, and ``real`` the rows there; ``first_order_sure``: is the
    number of velocities at the reference proved? ``exists``: and that the relations hold there at all times?
    ``trusted``: is what is not 0 over GF(p) known not to be 0? ``identical``: do dependent rows depend on the others in
    their supports by identities? ``kind``: the same for blocks that are each other's up
    to names, whose coordinates then correspond place by place; None for one that was not compared. ``answered_parts``:
    what was answered apart, all other rows being independent of each other and of these; None where the whole was
    looked at together, and only then is there a ``matrix``; ``most``: where the freedom is not known, what it is proved
    not to exceed; ``separating``: expressions each of which may vanish on every component that is as large, and not on
    others; ``one_branch``: that of one of several branches, of which others may integrate to something else.
    """

    consistent: bool | None = True
    dof: int | None = None
    velocity_dof: int | None = None
    verdict: Verdict = "proved"
    about: About = "everywhere"
    argument: ArgumentKey | None = None
    bits: int = BITS
    gap: float = GAP
    labels: dict[int, HolonomyLabel] = field(default_factory=dict)
    reasons: list[str] = field(default_factory=list)
    hidden: list[Expr] = field(default_factory=list)
    hidden_branches: list[list[Expr]] = field(default_factory=list)
    matrix: list[SparseRow] = field(default_factory=list)
    modulus: int = 2
    supports: Supports | None = None
    degenerate: bool = False
    instantaneous: int | None = None
    curved: bool = False
    first_order_sure: bool = False
    exists: bool = False
    trusted: bool = False
    identical: bool = False
    real: RealRows | None = None
    dependent: tuple[str, ...] = ()
    growth: tuple[int, ...] | None = None
    derived: tuple[int, ...] | None = None
    doubt: bool = False
    method: str = ""
    late: bool = False
    conflict: tuple[int, ...] = ()
    witness: Mapping[Expr, str] | None = None
    linear: bool = False
    looked: FollowedClasses = field(default_factory=FollowedClasses)
    kind: int | None = None
    size: Size = field(default_factory=Size)
    answered_parts: tuple[AnsweredPart, ...] | None = None
    most: int | None = None
    separating: tuple[Expr, ...] = ()
    one_branch: bool = False

    @property
    def claim(self) -> Claim:
        """How certain the freedom is, or that there is none; undecided, and logged as a defect, without an argument."""
        if self.argument is None and self.verdict != "undecided":
            DEFECTS.error("an answer that is %s names no argument (method: %s)", self.verdict, self.method)
            return OPEN
        return Claim(self.verdict, self.argument, self.bits, self.gap, self.about)

    @property
    def first_order(self) -> Claim:
        """How certain the velocities at the reference are."""
        if self.instantaneous is None:
            return OPEN
        sure: Verdict = "numeric" if self.verdict == "numeric" else "proved" if self.first_order_sure else "probable"
        return Claim(sure, "rank at the reference", self.bits, self.gap, "reference")


#: Of what the freedom tells, and of what is seen as it is written.
COUNTED, IDENTITY = Claim("proved", "count"), Claim("proved", "identity")


@dataclass(frozen=True)
class Redundancies:
    """Which constraints of some that share coordinates depend on which, by their numbers.

    ``independent``: how many equations of each are independent of those before; ``redundant``: a maximal redundant
    set; ``groups``: (nullity, members); ``circuits``: what a redundant one depends on; ``undecided``: of which it
    is not known whether they are redundant.
    ``equations``: which scalar equations of a constraint follow from those before them, where that is known.
    ``uncounted``: constraints of which it is not known how many of their equations do; ``seen``: of which some were
    seen in numbers to do. ``claim``: of what is redundant and of how many equations are independent, given the freedom.
    """

    independent: dict[int, int]
    redundant: list[int] = field(default_factory=list)
    groups: list[tuple[int, list[int]]] = field(default_factory=list)
    circuits: dict[int, list[int]] = field(default_factory=dict)
    undecided: tuple[int, ...] = ()
    equations: Mapping[int, tuple[int, ...]] = field(default_factory=dict)
    uncounted: tuple[int, ...] = ()
    seen: tuple[int, ...] = ()
    claim: Claim = COUNTED

    @property
    def needed(self) -> set[int]:
        """The constraints that were examined and are not redundant, as far as is known."""
        return {*self.independent, *self.undecided, *self.uncounted} - {*self.redundant}

    def has_dependent_equations(self, sizes: Sequence[int]) -> bool:
        """Return whether an equation is known to follow from others; ``sizes``: the equations of each constraint."""
        return bool(self.uncounted) or any(count < sizes[i] for i, count in self.independent.items())

    def without(self, needed: set[int]) -> Redundancies:
        """Return the same where some constraints are needed because of other equations of theirs."""
        redundant = [i for i in self.redundant if i not in needed]
        circuits = {i: c for i, c in self.circuits.items() if i not in needed}
        return replace(self, redundant=redundant, circuits=circuits)


def undecided_dependence(constraints: Iterable[int]) -> Redundancies:
    """Return that nothing is known of these constraints."""
    return Redundancies({}, undecided=tuple(sorted(set(constraints))))
