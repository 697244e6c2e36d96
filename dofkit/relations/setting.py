"""What the engines may assume about the symbols of a system, which engines to use, and which questions to answer."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Literal, NamedTuple

from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions.tree import Expr
from dofkit.system import Coordinate, Distance

ReductionName = Literal[
    "untouched", "blocks", "twins", "copies", "eliminations", "bridges", "classes", "closed", "cheapest"
]  # fmt: skip
Reductions = frozenset[ReductionName]

#: What each reduction leaves out of the model, and why no answer changes.
REDUCTIONS: Mapping[ReductionName, str] = {
    "untouched": "coordinates that no relation mentions: the set is a product with a line for each of them",
    "blocks": "zeros between equations that share no coordinate: the set is a product, the codistribution a direct sum",
    "twins": "blocks that equal another one up to names: renaming coordinates is a diffeomorphism",
    "copies": "equations that an earlier constraint states already, up to a numerical factor",
    "eliminations": "coordinates that a linear equation gives at the reference configuration (z = 0, a body that does "
    "not turn, or welded to another); elsewhere linear equations are solved beforehand: the set is a graph",
    "bridges": "at a reference configuration, joints that alone connect some bodies to the others: the set is a "
    "product with the joint's own manifold, after moving these bodies as one",
    # [ImplicitFunctions] [AsimowRoth1978]
    "classes": "at a reference configuration, equations in no dependent set; the others are treated class by class: "
    "where every class defines a manifold, so do all equations together",
    "closed": "the integrability test of holonomic equations: d(dg) = 0, so their differentials are in I^(inf)",
    "cheapest": "coordinates, where generic rigid links between particles are answered by counting in their graph",
}

#: All reductions, the default.
ALL: Reductions = frozenset(REDUCTIONS)


class NamedRows(NamedTuple):
    """Rows over GF(``p``) by the names of coordinates, without zeros."""

    rows: list[dict[str, int]]
    p: int


@dataclass(frozen=True)
class Setting:
    """What the engines may assume about the symbols, which ``engines`` and ``reductions`` they use, and the questions.

    ``grows``, ``flag``: whether to compute growth vectors and derived flags. ``positive`` symbols are > 0; ``generic``
    parameters have no name; ``pose`` has the given initial values; ``size`` is the unit of length. Constraints are
    given by number: ``distances`` that they fix, in a world of ``dimension``; pairs of particles joined by rigid
    ``links``; ``geometric`` ones, not written as formulas, whose numbers have the ``tolerance``; ``bridges``, joints
    that close no loop; ``afloat`` ones, connected to the ground by nothing else. ``arms``: vectors from bodies' origins
    to their material points at the scene's centre. ``tilts``: the second Euler angles of bodies whose angles occur in
    formulas (gimbal lock where the sine is 0). ``joint_rows``: gives the rows of constraints at the reference, or None.
    """

    positive: frozenset[Expr]
    generic: tuple[Expr, ...] = ()
    pose: Mapping[Expr, Expr] = field(default_factory=dict)
    reference: Mapping[Expr, Expr] | None = None
    roles: tuple[Coordinate, ...] = ()
    tolerance: Fraction | None = None
    size: float = 1.0
    grows: bool = True
    engines: Engines = BOTH
    flag: bool = False
    dimension: int = 3
    distances: Mapping[int, Sequence[Distance]] = field(default_factory=dict)
    links: Mapping[int, Sequence[tuple[str, str]]] = field(default_factory=dict)
    reductions: Reductions = ALL
    geometric: frozenset[int] = frozenset()
    arms: Mapping[str, tuple[Expr, ...]] = field(default_factory=dict)
    tilts: frozenset[str] = frozenset()
    bridges: frozenset[int] = frozenset()
    afloat: frozenset[int] = frozenset()
    joint_rows: Callable[[Iterable[int]], NamedRows | None] | None = None
