"""Joint coordinates of systems whose bodies form trees of joints, and joints that close no loop (bridges).

Let a joint with f freedoms be the only connection between bodies S, without the ground, and all others. The constraints
within S do not change when all of S is moved as one body. So every configuration of the system consists of one of the
others, one of S up to rigid motions, and a value q of the joint: M = M_others x (M_S / SE(d)) x J, with J the joint's
own manifold of dimension f, and the map from there is a diffeomorphism. So the joint's d(d+1)/2 - f equations are
independent of all others, everywhere, whatever M_others and M_S are; and so on for every bridge, one after another.

A formula refers to fixed places, so that its coordinates are connected to the ground; so are those of any constraint
that is not known to be invariant when all its members are moved together.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from dofkit.base.libraries import nx
from dofkit.system import GROUND, Connection, Constraint, System


def tree_coordinates(system: System) -> list[str] | None:
    """Return names of independent coordinates of a tree of joints, in the order of the scene; None if it is no tree.

    They are joint coordinates, without the first joint of each coupling; the coordinates of the first body of each part
    that is not connected to the ground; and those of no body. None also if a factor of a coupling is not a number.
    """
    joints = system.joints
    trees = _trees(system, joints) if joints else None
    if trees is None:
        return None
    rows = [dict(row) for row in _coupled(system)]
    if len(rows) != sum(bool(c.rates) for c in system.connections):
        return None
    dependent = _pivots(rows)
    names = [f"{system.constraints[c.constraint].name}.{what}" for c in joints for what in c.facts.freedoms]
    return [name for name in (*names, *_floating(system, trees)) if name not in dependent]


def _trees(system: System, joints: Sequence[Connection]) -> nx.utils.UnionFind[str] | None:
    """Return the trees of undriven joints; None if there is a loop, or more than couplings and inequalities besides."""
    of_joints = {c.constraint for c in joints}
    for index, c in enumerate(system.connections):
        if index in of_joints or c.rates:
            continue
        if any(relation.sense == "=" for relation in system.constraints[index].relations):
            return None
    trees: nx.utils.UnionFind[str] = nx.utils.UnionFind()
    for c in joints:
        if len(c.members) != 2 or c.driven or trees[c.members[0]] == trees[c.members[1]]:
            return None
        trees.union(*c.members)
    return trees


def _floating(system: System, trees: nx.utils.UnionFind[str]) -> Iterator[str]:
    """Yield coordinates of the first body of each tree without the ground, and coordinates of no body."""
    roots = {trees[GROUND]}
    names_of: dict[str | None, list[str]] = {}
    for q in system.coordinates:
        names_of.setdefault(q.owner, []).append(q.name)
    for name in system.bodies:
        if trees[name] not in roots:
            roots.add(trees[name])
            yield from names_of.get(name, ())
    bodies = frozenset(system.bodies)
    yield from (q.name for q in system.coordinates if q.owner not in bodies)


def _coupled(system: System) -> Iterator[dict[str, Fraction]]:
    """Yield {joint coordinate: factor} for each coupling, except those with a factor that is not a number."""
    for c in system.connections:
        if c.rates and all(rate.slope.op == "num" for rate in c.rates):
            yield {rate.name: rate.slope.args[0] for rate in c.rates}


def _pivots(rows: list[dict[str, Fraction]]) -> set[str]:
    """Return the names for which the rows are solved: of each row the first that earlier rows leave; no entry is 0."""
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

#: A node of the graph: a body, a particle, the ground, ("coordinate", name) without owner, or a constraint's number.
Node = Hashable


class Bridges(NamedTuple):
    """The ``joints`` that close no loop; constraints ``afloat`` are connected to the ground by these joints only."""

    joints: frozenset[int] = frozenset()
    afloat: frozenset[int] = frozenset()


def bridges(system: System) -> Bridges:
    """Return the bridges among the joints whose geometry is given by rational numbers, as constraint numbers."""
    if system.dimension == 1:
        return Bridges()
    joints = {c.constraint: c.members for c in system.joints if _has_rational_geometry(c, system)}
    graph = _graph(system, joints)
    ends = _ends_of_bridges(graph)
    bridging = frozenset(i for i in joints if ends[i] == len(graph.adj[i]))
    graph.remove_nodes_from(bridging)
    grounded = nx.node_connected_component(graph, GROUND) if GROUND in graph else set()
    return Bridges(bridging, frozenset(i for i in graph if isinstance(i, int)) - grounded)


def _graph(system: System, joints: Mapping[int, Sequence[Node]]) -> nx.Graph[Node]:
    """Return the graph with an edge from every constraint to each member that it connects.

    A constraint on coordinates without owner only is left out, as it is connected to the ground with all their others.
    """
    owners: dict[str, Node] = {q.name: q.owner or ("coordinate", q.name) for q in system.coordinates}
    connected = {c.constraint: c for c in system.connections}
    graph: nx.Graph[Node] = nx.Graph()
    for i, constraint in enumerate(system.constraints):
        nodes = joints.get(i) or _connected_members(constraint, connected.get(i), owners)
        if not all(isinstance(node, tuple) or node == GROUND for node in nodes):
            graph.add_edges_from((i, node) for node in nodes)
    return graph


def _ends_of_bridges(graph: nx.Graph[Node]) -> Counter[Node]:
    """Return {node: number of bridges (edges in no cycle) that end there}; leaves are removed first, one by one."""
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


def _has_rational_geometry(c: Connection, system: System) -> bool:
    """Return whether a joint is undriven, joins two bodies, and its and their geometry are rational numbers."""
    if len(c.members) != 2 or c.driven or c.number is not None:
        return False
    vectors = (*c.places, *c.directions, *(system.starts.get(member, ()) for member in c.members))
    return all(vector is not None and all(part.op == "num" for part in vector) for vector in vectors)


def _connected_members(constraint: Constraint, c: Connection | None, owners: Mapping[str, Node]) -> set[Node]:
    """Return the members that a constraint connects, with GROUND unless rigid motions of all members preserve it."""
    members: set[Node] = set() if c is None else {*c.members}
    named = {owners[name] for name in constraint.mentioned if name in owners}
    facts = constraint.facts
    invariant = facts.bars or facts.merged or facts.welded or bool(facts.freedoms) or (c is not None and bool(c.rates))
    return members | named | (set() if invariant and named <= members else {GROUND})
