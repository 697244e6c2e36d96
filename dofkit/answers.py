"""What is known of one block, and what the engines may assume of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

from dofkit.exact.engines import BOTH, Engines
from dofkit.exact.sparse import SparseRow, Supports
from dofkit.exact.trust import Doubt
from dofkit.expr import Expr
from dofkit.reductions import ALL, Reductions
from dofkit.report import Verdict
from dofkit.separate import Looked
from dofkit.system import Coordinate, Distance


@dataclass(frozen=True)
class Label:
    """Whether a row is a consequence of finite relations, how sure, and why.

    ``modulo``: it is none, but one of finite relations together with the other rows.
    """

    holonomic: bool | None
    verdict: Verdict
    reason: str = ""
    modulo: bool = False


class Size(NamedTuple):
    """What was computed with: coordinates, finite relations, and one-forms that were put to an integrability test."""

    coordinates: int = 0
    relations: int = 0
    forms: int = 0


@dataclass
class Answer:
    """What is known of a block. Numbers are None where undecided; ``reasons`` say why.

    ``matrix``: the rows (in the block's order) over the coordinates and time at a generic point over GF(p), for
    redundancy; ``supports``: where something else than the matrix tells what depends on what; ``hidden`` the finite
    relations that the differential ones force; ``doubt``: functions or numbers occur that may be related in a way that
    GF(p) does not show; ``late``: there was no time for it;
    ``conflict``: a minimal set of constraints that cannot hold together, where the proof shows one;
    ``looked``: what was looked at of the relations; ``size``: of the model that was computed with.
    """

    consistent: bool | None = True
    dof: int | None = None
    velocity_dof: int | None = None
    verdict: Verdict = "proved"
    labels: dict[int, Label] = field(default_factory=dict)
    reasons: list[str] = field(default_factory=list)
    hidden: list[Expr] = field(default_factory=list)
    matrix: list[SparseRow] = field(default_factory=list)
    modulus: int = 2
    supports: Supports | None = None
    degenerate: bool = False
    instantaneous: int | None = None
    curved: bool = False
    dependent: tuple[str, ...] = ()
    growth: tuple[int, ...] | None = None
    derived: tuple[int, ...] | None = None
    doubt: Doubt | None = None
    method: str = ""
    late: bool = False
    conflict: tuple[int, ...] = ()
    looked: Looked = field(default_factory=Looked)
    size: Size = field(default_factory=Size)


@dataclass(frozen=True)
class Setting:
    """What the engines may assume of the symbols, which of them may be asked, and what is asked beyond the labels.

    ``grows``: the growth vector; ``flag``: the derived flag.
    ``distances``: those that constraints hold, by constraint, in a world of ``dimension``; ``links``: the particles
    that rigid links join, by constraint; ``reductions``: those in use; ``welds``: the
    constraints that weld.
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
