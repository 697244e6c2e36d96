"""What the engines may assume of the symbols of a system, which of them may be asked, and what is asked."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Literal, NamedTuple

from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions.tree import Expr
from dofkit.system import Coordinate, Distance

ReductionName = Literal[
    "untouched",
    "blocks",
    "twins",
    "copies",
    "still",
    "welds",
    "eliminations",
    "bridges",
    "classes",
    "closed",
    "cheapest",
]
Reductions = frozenset[ReductionName]


class Reduction(NamedTuple):
    """``title``: a few words for a chart; ``leaves_out``: of the model; ``sound``: why nothing changes."""

    title: str
    leaves_out: str
    sound: str


REDUCTIONS: Mapping[ReductionName, Reduction] = {
    "untouched": Reduction(
        "coordinates nothing touches",
        "coordinates that occur in no relation, coefficients and velocities included",
        "the configuration space is a product with a line for each of them",
    ),
    "blocks": Reduction(
        "independent blocks",
        "the zeros between equations that share no coordinate",
        "the configuration space is a product, and the codistribution, its derived flag and its rank are direct sums",
    ),
    "twins": Reduction(
        "equal blocks once",
        "blocks that equal another one up to the names of coordinates",
        "renaming coordinates is a diffeomorphism, and every answer is invariant under those",
    ),
    "copies": Reduction(
        "constraints written twice",
        "equations that an earlier constraint states already, up to a numerical factor",
        "the solution set and the span are the same; which constraints are redundant is known from the list of copies",
    ),
    "still": Reduction(
        "bodies that do not turn",
        "where equations are evaluated at the reference configuration, the angles that a linear equation fixes or "
        "relates to other angles",
        "the configuration space is a graph over the other coordinates, so they are coordinates of it",
    ),
    "welds": Reduction(
        "welded bodies are one",
        "where equations are evaluated at the reference configuration, the coordinates of the second body of a linear "
        "weld, whose frames coincide there",
        "the set is a graph over the coordinates of the first body",
    ),
    "eliminations": Reduction(
        "explicit coordinates",
        "linear holonomic equations, solved beforehand and not at every point; where equations are evaluated at the "
        "reference configuration, the coordinates that such an equation gives (z = 0)",
        "an invertible change of linear equations has the same solutions (Gauss), and they are a graph",
    ),
    "bridges": Reduction(
        "joints that close no loop",
        "at a reference configuration, the equations of joints that alone connect some bodies to the others; in space "
        "they are not written out",
        "the set is a product with the joint's own manifold, after moving these bodies as one; so its equations are "
        "independent of all others",
    ),
    "classes": Reduction(
        "classes of dependent relations",
        "at a reference configuration, equations in no dependent set are not evaluated further; the others are "
        "treated class by class, and a class that allows rigid motions only is one body",
        # [ImplicitFunctions] [AsimowRoth1978]
        "where every class defines a manifold, so do all equations together (implicit function theorem); "
        "infinitesimal rigidity implies rigidity (Asimow and Roth)",
    ),
    "closed": Reduction(
        "no Frobenius test of holonomic equations",
        "the integrability test of blocks all of whose equations are holonomic",
        "d(dg) = 0: their differentials are closed, so they are in I^(inf)",
    ),
    "cheapest": Reduction(
        "the cheapest sound method",
        "coordinates altogether, where generic rigid links between particles are answered by counting in their graph",
        "Pollaczek-Geiringer and Laman in the plane, spanning forests on the line; in space a rank at random positions",
    ),
}

#: All of them: what is in use unless something else is asked for.
ALL: Reductions = frozenset(REDUCTIONS)


class NamedRows(NamedTuple):
    """Rows over GF(``p``) by the names of coordinates, without zeros."""

    rows: list[dict[str, int]]
    p: int


@dataclass(frozen=True)
class Setting:
    """What the engines may assume of the symbols, which of them may be asked, and what is asked beyond the labels.

    ``grows``: the growth vector; ``flag``: the derived flag.
    ``distances``: those that constraints hold, by constraint, in a world of ``dimension``; ``links``: the particles
    that rigid links join, by constraint; ``reductions``: those in use; ``welds``: the constraints that weld;
    ``geometric``: those that are no texts, whose numbers are measured where there is a ``tolerance``; then ``arms`` are
    the vectors from the bodies' origins to their material points at the scene's centre. ``tilts``: the second of the
    Euler angles of bodies whose angles texts name; where its sine is 0 the other two turn alike. ``bridges``: the
    joints that close no loop;
    ``afloat``: the constraints that hold after any motion of all that they hold, without these, as one;
    ``within``: what is asked of hangs by such joints on more. ``joint_rows``: of constraints at the drawing, where the
    geometry of joints alone tells them.
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
    welds: frozenset[int] = frozenset()
    geometric: frozenset[int] = frozenset()
    arms: Mapping[str, tuple[Expr, ...]] = field(default_factory=dict)
    tilts: frozenset[str] = frozenset()
    bridges: frozenset[int] = frozenset()
    afloat: frozenset[int] = frozenset()
    within: bool = False
    joint_rows: Callable[[Iterable[int]], NamedRows | None] | None = None
