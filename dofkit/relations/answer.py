"""What is known of one block, and what the engines may assume of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from dofkit.base.verdicts import Verdict
from dofkit.exact.matrices.sparse import SparseRow, Supports
from dofkit.exact.zero.independence import Doubt
from dofkit.expressions.tree import Expr


@dataclass(frozen=True)
class HolonomyLabel:
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


class FollowedClasses(NamedTuple):
    """What was looked at: relations ``left_out``, classes that are ``rigid``, and those that were ``followed``.

    The latter in so many ``coordinates``, where there would have been ``spared`` more.
    """

    left_out: int = 0
    rigid: int = 0
    followed: int = 0
    coordinates: int = 0
    spared: int = 0


@dataclass
class Answer:
    """What is known of a block. Numbers are None where undecided; ``reasons`` say why.

    ``matrix``: the rows (in the block's order) over the coordinates and time at a generic point over GF(p), for
    redundancy; ``supports``: where something else than the matrix tells what depends on what; ``hidden`` the finite
    relations that the differential ones force; ``doubt``: functions or numbers occur that may be related in a way that
    GF(p) does not show; ``late``: there was no time for it;
    ``conflict``: a minimal set of constraints that cannot hold together, where the proof shows one;
    ``linear``: every relation is linear with rational coefficients, and all of them were eliminated exactly;
    ``looked``: what was looked at of the relations; ``size``: of the model that was computed with.
    """

    consistent: bool | None = True
    dof: int | None = None
    velocity_dof: int | None = None
    verdict: Verdict = "proved"
    labels: dict[int, HolonomyLabel] = field(default_factory=dict)
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
    linear: bool = False
    looked: FollowedClasses = field(default_factory=FollowedClasses)
    size: Size = field(default_factory=Size)
