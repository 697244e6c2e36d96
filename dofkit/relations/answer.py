"""The result of the engines for one block (`Answer`), and which constraints depend on which (`Redundancies`)."""

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

#: The probability of an error over GF(p) is below 2^-BITS; singular values that count as 0 are smaller by GAP.
BITS, GAP = 30, 1e3


@dataclass(frozen=True)
class HolonomyLabel:
    """Whether a row is a consequence of geometric equations, how certain this is, and why.

    ``modulo``: the row is not, but it is a consequence of geometric equations together with the other rows.
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
    """Numbers of coordinates, geometric equations, and one-forms tested for integrability, in the model of a block."""

    coordinates: int = 0
    relations: int = 0
    forms: int = 0


class FollowedClasses(NamedTuple):
    """Number of relations ``left_out`` of the analysis of finite motions, of ``coordinates`` used there, and saved."""

    left_out: int = 0
    coordinates: int = 0
    spared: int = 0


class AnsweredPart(NamedTuple):
    """A part of a block whose other rows are joints that close no loop, with its own answer."""

    block: Block
    answer: Answer


DEFECTS = logging.getLogger("dofkit.defects")


@dataclass
class Answer:
    """The result of the engines for a block. Numbers are None if undecided; ``reasons`` say why.

    The claim: ``verdict``, ``argument`` (a key of the table of arguments), ``bits`` (probability of error below
    2^-bits), ``gap`` (of singular values), ``about`` (the points for which it is valid), and ``most`` (a proved bound
    on the freedom, if this is not known). ``labels``: by row. ``witness``: a certified configuration, as text;
    ``real``: the Jacobian there. ``instantaneous``: velocity freedom at the reference, proved if
    ``first_order_sure``; ``exists``: it is proved that the reference satisfies the relations at all times.
    ``matrix``: the rows (hidden ones after the finite ones) over coordinates and time at a generic point modulo
    ``modulus``; ``supports``: computes dependences if these are not those of the matrix; ``identical``: dependent rows
    are combinations of their supports identically; ``dependent``: coordinates that the rows can be solved for;
    ``degenerate``: the rank of the rows is not that of the set. ``hidden``: geometric equations implied by the
    differential ones, ``hidden_branches``: those of each of several branches. ``curved``: the admissible velocities
    form no linear spaces. ``growth``, ``derived``: growth vector and derived flag. ``doubt``: functions or numbers
    may be related unnoticed over GF(p); ``trusted``: what is not 0 over GF(p) is known not to be 0. ``late``: time
    ran out. ``conflict``: a minimal contradictory set of constraints, if the proof gives one. ``linear``: all
    relations were eliminated exactly. ``looked``, ``size``: of the analysis and of the model. ``kind``: equal for
    blocks that are equal up to names, coordinate by coordinate. ``answered_parts``: parts analysed separately, the
    other rows being independent of each other and of them; otherwise None. ``separating``: expressions that may vanish
    on all components of the largest dimension and not on others. ``one_branch``: other branches may differ.
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
        """How certain the freedom or the contradiction is; undecided, and logged as a defect, without an argument."""
        if self.argument is None and self.verdict != "undecided":
            DEFECTS.error("an answer that is %s names no argument (method: %s)", self.verdict, self.method)
            return OPEN
        return Claim(self.verdict, self.argument, self.bits, self.gap, self.about)

    @property
    def first_order(self) -> Claim:
        """How certain ``instantaneous`` is, the velocity freedom at the reference."""
        if self.instantaneous is None:
            return OPEN
        sure: Verdict = "numeric" if self.verdict == "numeric" else "proved" if self.first_order_sure else "probable"
        return Claim(sure, "rank at the reference", self.bits, self.gap, "reference")


#: Claims of results obtained by counting from the freedom, and by identities of the equations as written.
COUNTED, IDENTITY = Claim("proved", "count"), Claim("proved", "identity")


@dataclass(frozen=True)
class Redundancies:
    """Which constraints, of a set that shares coordinates, depend on which; constraints are given by number.

    ``independent``: how many equations of each are independent of those before them; ``redundant``: a maximal
    redundant set; ``groups``: (nullity, members); ``circuits``: the constraints that imply a redundant one;
    ``undecided``: constraints that may be redundant. ``equations``: the numbers of the equations of each that are
    implied by those before them, if known; ``uncounted``: constraints for which their number is not known; ``seen``:
    constraints some of whose equations are implied by numerical evidence. ``claim``: of all this, given the freedom.
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
        """Return whether an equation may be implied by others; ``sizes``: numbers of equations by constraint."""
        return bool(self.uncounted) or any(count < sizes[i] for i, count in self.independent.items())

    def without(self, needed: set[int]) -> Redundancies:
        """Return a copy in which constraints ``needed`` are not redundant (because of equations in other blocks)."""
        redundant = [i for i in self.redundant if i not in needed]
        circuits = {i: c for i, c in self.circuits.items() if i not in needed}
        return replace(self, redundant=redundant, circuits=circuits)


def undecided_dependence(constraints: Iterable[int]) -> Redundancies:
    """Return a result in which everything about these constraints is undecided."""
    return Redundancies({}, undecided=tuple(sorted(set(constraints))))
