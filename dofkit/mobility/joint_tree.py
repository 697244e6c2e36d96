"""Angles and displacements of joints that describe a tree of bodies, where joints are all that holds them."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from dofkit.base.libraries import nx
from dofkit.system import GROUND, Connection, System


def tree_coordinates(system: System) -> list[str] | None:
    """An independent choice, in the order written; None where bodies form no tree of joints, or a factor is no number.

    Of a coupling the joint that it names first is told by the others. What hangs on nothing has its first body's own
    coordinates, and what nothing joins its own.
    """
    joints = [c for c in system.connections if c.facts.freedoms or c.facts.welded]
    if not joints or not _is_tree(system, joints):
        return None
    rows = [dict(row) for row in _coupled(system)]
    if len(rows) != sum(bool(c.rates) for c in system.connections):
        return None
    told_by_others = _first_of_each(rows)
    names = [f"{system.constraints[c.constraint].name}.{what}" for c in joints for what in c.facts.freedoms]
    return [name for name in (*names, *_floating(system, joints)) if name not in told_by_others]


def _is_tree(system: System, joints: list[Connection]) -> bool:
    """Does every joint join what was apart, and is there nothing else but couplings and bounds?"""
    own = {c.constraint for c in joints}
    for index, c in enumerate(system.connections):
        if index in own or c.rates:
            continue
        if any(relation.sense == "=" for relation in system.constraints[index].relations):
            return False
    apart: nx.utils.UnionFind[str] = nx.utils.UnionFind()
    for c in joints:
        if len(c.members) != 2 or c.driven or apart[c.members[0]] == apart[c.members[1]]:
            return False
        apart.union(*c.members)
    return True


def _floating(system: System, joints: list[Connection]) -> Iterator[str]:
    """Coordinates of the first body of what the ground does not hold, and of what no joint joins."""
    held: nx.utils.UnionFind[str] = nx.utils.UnionFind()
    for c in joints:
        held.union(*c.members)
    roots = {held[GROUND]}
    own: dict[str | None, list[str]] = {}
    for q in system.coordinates:
        own.setdefault(q.owner, []).append(q.name)
    for name in system.bodies:
        if held[name] not in roots:
            roots.add(held[name])
            yield from own.get(name, ())
    bodies = frozenset(system.bodies)
    yield from (q.name for q in system.coordinates if q.owner not in bodies)


def _coupled(system: System) -> Iterator[dict[str, Fraction]]:
    """The factors of each coupling by what they belong to; nothing of one whose factors are no numbers."""
    for c in system.connections:
        if c.rates and all(rate.slope.op == "num" for rate in c.rates):
            yield {rate.name: rate.slope.args[0] for rate in c.rates}


def _first_of_each(rows: list[dict[str, Fraction]]) -> set[str]:
    """What the rows tell by the others: of each the first that no row before it told already."""
    pivots: dict[str, dict[str, Fraction]] = {}
    for row in rows:
        for name, pivot in pivots.items():
            factor = row.get(name, Fraction(0)) / pivot[name]
            if factor:
                row = {k: v for k in {**row, **pivot} if (v := row.get(k, Fraction(0)) - factor * pivot.get(k, 0))}
        if row:
            pivots[next(iter(row))] = row
    return set(pivots)
