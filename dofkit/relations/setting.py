"""What the engines may assume about the symbols of a system, which engines to use, and which questions to answer."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

from dofkit.exact.zero import BOTH, Engines
from dofkit.expressions.tree import Expr
from dofkit.system import Coordinate, Distance


class NamedRows(NamedTuple):
    """Rows over GF(``p``) by the names of coordinates, without zeros."""

    rows: list[dict[str, int]]
    p: int


@dataclass(frozen=True)
class Setting:
    """What the engines may assume about the symbols, which ``engines`` they use, and the questions.

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
    geometric: frozenset[int] = frozenset()
    arms: Mapping[str, tuple[Expr, ...]] = field(default_factory=dict)
    tilts: frozenset[str] = frozenset()
    bridges: frozenset[int] = frozenset()
    afloat: frozenset[int] = frozenset()
    joint_rows: Callable[[Iterable[int]], NamedRows | None] | None = None
