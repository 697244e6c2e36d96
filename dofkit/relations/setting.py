"""What the engines may assume of the symbols of a system, which of them may be asked, and what is asked."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions.tree import Expr
from dofkit.relations.reductions import ALL, Reductions
from dofkit.system import Coordinate, Distance


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
