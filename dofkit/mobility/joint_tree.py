"""Trees of joints: joint coordinates where joints alone hold the bodies, and joints that close no loop (bridges).

Let a joint with f freedoms be the only connection between bodies S, the ground not among them, and all others. The
constraints on S by itself do not change when all of S is moved as one body. So every configuration of the system is one
of the others, one of S up to rigid motions, and any value q of the joint: M = M_others x (M_S / SE(d)) x J, with J the
joint's own manifold of dimension f, and the map from there is a diffeomorphism. So the joint's d(d+1)/2 - f equations
are independent of all others, everywhere, whatever M_others and M_S are; and so on for every bridge, one after another.

A text refers to fixed places, so that what it names is fixed to the ground; so is what any other constraint names that
is not known to stay the same when all its members are moved together.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from dofkit.base.libraries import nx
from dofkit.system import GROUND, Connection, Constraint, System


def tree_coordinates(system: System) -> list[str] | None:
    """An independent choice, in the order written; None where bodies form no tree of joints, or a factor is no number.

    Of a coupling the joint that it names first depends on the others. What hangs on nothing has its first body's own
    coordinates, and what nothing joins its own.
    """
    joints = system.joints
    if not joints or not _is_tree(system, joints):
        return None
    rows = [dict(row) for row in _coupled(system)]
    if len(rows) != sum(bool(c.rates) for c in system.connections):
        return None
    told_by_others = _first_of_each(rows)
    names = [f"{system.constraints[c.constraint].name}.{what}" for c in joints for what in c.facts.freedoms]
    return [name for name in (*names, *_floating(system, joints)) if name not in told_by_others]


def _is_tree(system: System, joints: Sequence[Connection]) -> bool:
    """Return whether every joint joins what was apart, and there is nothing else but couplings and bounds."""
    of_joints = {c.constraint for c in joints}
    for index, c in enumerate(system.connections):
        if index in of_joints or c.rates:
            continue
        if any(relation.sense == "=" for relation in system.constraints[index].relations):
            return False
    apart: nx.utils.UnionFind[str] = nx.utils.UnionFind()
    for c in joints:
        if len(c.members) != 2 or c.driven or apart[c.members[0]] == apart[c.members[1]]:
            return False
        apart.union(*c.members)
    return True


def _floating(system: System, joints: Sequence[Connection]) -> Iterator[str]:
    """Coordinates of the first body of what the ground does not hold, and of what no joint joins."""
    held: nx.utils.UnionFind[str] = nx.utils.UnionFind()
    for c in joints:
        held.union(*c.members)
    roots = {held[GROUND]}
    names_of: dict[str | None, list[str]] = {}
    for q in system.coordinates:
        names_of.setdefault(q.owner, []).append(q.name)
    for name in system.bodies:
        if held[name] not in roots:
            roots.add(held[name])
            yield from names_of.get(name, ())
    bodies = frozenset(system.bodies)
    yield from (q.name for q in system.coordinates if q.owner not in bodies)


def _coupled(system: System) -> Iterator[dict[str, Fraction]]:
    """Yield the factors of each coupling by what they belong to; nothing of one whose factors are no numbers."""
    for c in system.connections:
        if c.rates and all(rate.slope.op == "num" for rate in c.rates):
            yield {rate.name: rate.slope.args[0] for rate in c.rates}


def _first_of_each(rows: list[dict[str, Fraction]]) -> set[str]:
    """What the rows determine from the others: of each the first that no row before it determined."""
    pivots: dict[str, dict[str, Fraction]] = {}
    for row in rows:
        for name, pivot in pivots.items():
            factor = row.get(name, Fraction(0)) / pivot[name]
            if factor:
                row = {k: v for k in {**row, **pivot} if (v := row.get(k, Fraction(0)) - factor * pivot.get(k, 0))}
        if row:
            pivots[next(iter(row))] = row
    return set(pivots)


# Bridges

#: A node of the graph: a body, a particle, the ground, a coordinate that is nobody's, or a constraint by its number.
Node = Hashable


class Bridges(NamedTuple):
    """The ``joints`` that close no loop, and the constraints that hold ``afloat``: without these joints nothing ties
    them to the ground, so that they hold after any motion of all their bodies as one.
    """

    joints: frozenset[int] = frozenset()
    afloat: frozenset[int] = frozenset()


def bridges(system: System) -> Bridges:
    """Return the joints that close no loop, of those of a drawing in fractions, by numbers; none without a drawing."""
    if system.dimension == 1:
        return Bridges()
    joints = {c.constraint: c.members for c in system.joints if _is_drawn(c, system)}
    graph = _graph(system, joints)
    ends = _ends_of_bridges(graph)
    apart = frozenset(i for i in joints if ends[i] == len(graph.adj[i]))
    graph.remove_nodes_from(apart)
    grounded = nx.node_connected_component(graph, GROUND) if GROUND in graph else set()
    return Bridges(apart, frozenset(i for i in graph if isinstance(i, int)) - grounded)


def _graph(system: System, joints: Mapping[int, Sequence[Node]]) -> nx.Graph[Node]:
    """What connects which members, from every constraint to all that it connects.

    One between coordinates that are nobody's is left out: with all that holds these too it ends at the ground.
    """
    owners: dict[str, Node] = {q.name: q.owner or ("coordinate", q.name) for q in system.coordinates}
    connected = {c.constraint: c for c in system.connections}
    graph: nx.Graph[Node] = nx.Graph()
    for i, constraint in enumerate(system.constraints):
        nodes = joints.get(i) or _held(constraint, connected.get(i), owners)
        if not all(isinstance(node, tuple) or node == GROUND for node in nodes):
            graph.add_edges_from((i, node) for node in nodes)
    return graph


def _ends_of_bridges(graph: nx.Graph[Node]) -> Counter[Node]:
    """Of how many bridges each node is an end: of those of leaves, peeled off one after another, and of the others."""
    degrees = dict(graph.degree)
    leaves = [node for node, degree in degrees.items() if degree == 1]
    ends: Counter[Node] = Counter()
    for leaf in leaves:
        del degrees[leaf]
        for other in graph.adj[leaf]:
            if other in degrees:
                ends.update((leaf, other))
                degrees[other] -= 1
                if degrees[other] == 1:
                    leaves.append(other)
    ends.update(node for edge in nx.bridges(graph.subgraph(degrees).copy()) for node in edge)
    return ends


def _is_drawn(c: Connection, system: System) -> bool:
    """Return whether an undriven joint of two bodies is drawn in fractions, as its bodies are."""
    if len(c.members) != 2 or c.driven or c.number is not None:
        return False
    vectors = (*c.places, *c.directions, *(system.starts.get(member, ()) for member in c.members))
    return all(vector is not None and all(part.op == "num" for part in vector) for vector in vectors)


def _held(constraint: Constraint, c: Connection | None, owners: Mapping[str, Node]) -> set[Node]:
    """What a constraint that is no such joint holds together: the ground too, unless all may move as one."""
    members: set[Node] = set() if c is None else {*c.members}
    named = {owners[name] for name in constraint.mentioned if name in owners}
    facts = constraint.facts
    moves = facts.bars or facts.merged or facts.welded or bool(facts.freedoms) or (c is not None and bool(c.rates))
    return members | named | (set() if moves and named <= members else {GROUND})
