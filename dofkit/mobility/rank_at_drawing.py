"""Joints and links as they are drawn, where their rows modulo p already tell everything: independent, or rigid.

A rank modulo p is never above the true one, so that these are proofs: where all rows are independent the freedom is
the coordinates less their number [ImplicitFunctions]; where they leave nothing but motions of the whole, or nothing at
all, nothing else moves (infinitesimally rigid is rigid [AsimowRoth1978]), unless lengths change in time, which
dependent ones need not allow. No relation is looked at.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import doubt
from dofkit.expressions.tree import TIME, Expr, coordinate
from dofkit.mobility.placement import Placement, drawn_placement
from dofkit.mobility.twists import rows_of
from dofkit.system import GROUND, System


@dataclass(frozen=True)
class DrawnRank:
    """The rows at the drawing modulo ``p`` with the constraint of each; their rank, and what it leaves.

    ``freedom``: of finite motions. ``independent``: all rows are. ``copies``: constraints that an earlier one wrote
    already; they have no rows.
    """

    rows: Sequence[SparseRow]
    owners: Sequence[int]
    p: int
    freedom: int
    independent: bool
    copies: Sequence[int] = ()


def drawn_rank(system: System, positive: frozenset[Expr]) -> DrawnRank | None:
    """What the rows at the drawing prove; None where they prove nothing, or something else than geometry is given."""
    if system.reference is None or system.tolerance is not None or not _drawn_throughout(system):
        return None
    if doubt(Ring([e for e in _numbers(system) if e.op != "num"], positive)) is not None:
        return None
    placement = drawn_placement(system, positive)
    if placement is None:
        return None
    rows: list[SparseRow] = []
    owners: list[int] = []
    copies = _copies(system)
    for c, found in zip(system.connections, placement.located, strict=True):
        own = [] if c.constraint in copies else rows_of(found) or []
        rows += [{k: int(v % placement.p) for k, v in row.items() if v % placement.p} for row in own]
        owners += [c.constraint] * len(own)
    if len(rows) != sum(len(c.relations) for i, c in enumerate(system.constraints) if i not in copies):
        return None
    rank = rank_of_rows(rows, placement.p)
    left = len(system.coordinates) - rank
    if rank == len(rows) or (left in (0, _motions_of_the_whole(system, placement)) and _still(system)):
        return DrawnRank(rows, owners, placement.p, left, rank == len(rows), copies)
    return None


def _drawn_throughout(system: System) -> bool:
    """Is every constraint a joint or link of given geometry, and every particle where the reference has it?

    None of them is driven, and their rows hold numbers of the drawing only (a screw's advance is transcendental).
    """
    own = [c for c in system.connections if c.facts.velocities is not None and c.number is None and not c.driven]
    if len(own) != len(system.connections) or {c.constraint for c in own} != set(range(len(system.constraints))):
        return False
    if any(None in (*c.places, *c.directions, *(point.at for point in c.points)) for c in own):
        return False
    reference, homes = system.reference or {}, dict[str, list[Expr | None]]()
    for q in system.coordinates:
        if q.owner is not None:
            homes.setdefault(q.owner, []).append(reference.get(coordinate(q.name)))
    return all(list(x.at or ()) == homes[x.carrier] for c in own for x in c.points if x.particle)


def _copies(system: System) -> list[int]:
    """Constraints with the same members and geometry as an earlier one that say the same.

    Links have lengths too, and couplings texts, of which the rates at the drawing are not all.
    """
    seen: set[object] = set()
    found = []
    for c in system.connections:
        alike = (c.facts.velocities, c.members, c.points, c.places, c.directions)
        if alike in seen and c.facts.placed and not c.facts.bars and not c.rates:
            found.append(c.constraint)
        seen.add(alike)
    return found


def _numbers(system: System) -> Iterator[Expr]:
    for start in system.starts.values():
        yield from start
    for c in system.connections:
        for vector in (*c.places, *c.directions, *(point.at for point in c.points)):
            yield from vector or ()
        for rate in c.rates:
            yield from (*rate.place, *rate.direction, rate.factor)


def _still(system: System) -> bool:
    """Does time not enter?"""
    return all(TIME not in r.expr.symbols for c in system.constraints for r in c.relations)


def _motions_of_the_whole(system: System, placement: Placement) -> int:
    """d(d+1)/2 for links between particles that nothing joins to the ground and that span d - 1 dimensions; else -1."""
    d = system.dimension
    if system.bodies or any(not c.facts.bars or GROUND in c.members for c in system.connections):
        return -1
    places = {member.column: at for found in placement.located for member, at in found.points}
    first, *rest = places.values()
    arms = [{k: (a - b) % placement.p for k, (a, b) in enumerate(zip(q, first, strict=True))} for q in rest]
    spanned = rank_of_rows([{k: v for k, v in arm.items() if v} for arm in arms], placement.p)
    return d * (d + 1) // 2 if spanned >= d - 1 else -1
