"""Which constraints depend on which: redundant ones, groups, circuits, by rank over GF(p).

A row is a scalar equation's differential at a generic point; finite rows come before differential ones,
because only a finite relation fixes the constant. Dependent sets of constraints are those whose rows are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import networkx as nx
from flint import nmod_mat

#: Sets of constraints are searched exhaustively up to this many members of a group.
SEARCHED = 12


@dataclass(frozen=True)
class Redundancies:
    """What was found, constraints by their numbers."""

    independent: dict[int, int]
    redundant: list[int]
    groups: list[tuple[int, list[int]]]
    circuits: dict[int, list[int]]


def rank(matrix: Sequence[Sequence[int]], p: int) -> int:
    """Over GF(p)."""
    rows = [row for row in matrix if any(row)]
    return int(nmod_mat(rows, p).rank()) if rows else 0


@dataclass(frozen=True)
class Rows:
    """The matrix of a block: ``owners[i]`` wrote row i, ``finite[i]`` tells a finite row."""

    matrix: Sequence[Sequence[int]]
    owners: Sequence[int]
    finite: Sequence[bool]
    p: int

    def of(self, owners: frozenset[int] | set[int], finite_only: bool = False) -> list[Sequence[int]]:
        """The rows that some constraints wrote."""
        return [
            row
            for row, owner, finite in zip(self.matrix, self.owners, self.finite, strict=True)
            if owner in owners and (finite or not finite_only)
        ]


def analyse(rows: Rows) -> Redundancies:
    """Redundant constraints, groups and circuits of one block."""
    order = _order(rows)
    basis = _Basis(rows, order)
    independent = {owner: len(basis.pivot_rows_of(owner)) for owner in order}
    if not basis.supports:
        return Redundancies(independent, [], [], {})
    groups = _groups(rows, basis)
    redundant: list[int] = []
    for _, members in groups:
        redundant += _droppable(rows, [o for o in order if o in members], basis)
    circuits = {owner: _circuit(rows, order, owner, basis) for owner in redundant}
    return Redundancies(independent, sorted(redundant), groups, circuits)


class _Basis:
    """The first independent rows in the order of their constraints, and the others in terms of them."""

    def __init__(self, rows: Rows, order: Sequence[int]) -> None:
        place = {owner: i for i, owner in enumerate(order)}
        self.owners = rows.owners
        numbers = sorted(range(len(rows.matrix)), key=lambda i: (place[rows.owners[i]], not rows.finite[i], i))
        numbers.sort(key=lambda i: not rows.finite[i])
        columns = [rows.matrix[i] for i in numbers]
        reduced, found = nmod_mat([list(column) for column in zip(*columns, strict=True)], rows.p).rref()
        self.pivots: list[int] = []
        column = 0
        for r in range(found):
            while reduced[r, column] == 0:
                column += 1
            self.pivots.append(numbers[column])
            column += 1
        kept = set(self.pivots)
        self.supports = {
            i: [self.pivots[r] for r in range(found) if reduced[r, c] != 0] for c, i in enumerate(numbers) if i not in kept
        }

    def pivot_rows_of(self, owner: int) -> list[int]:
        return [i for i in self.pivots if self.owners[i] == owner]


def _order(rows: Rows) -> list[int]:
    """Constraints whose rows are all finite first, each part as written."""
    owners = sorted(set(rows.owners))
    differential = {o for o, f in zip(rows.owners, rows.finite, strict=True) if not f}
    return [o for o in owners if o not in differential] + [o for o in owners if o in differential]


def _groups(rows: Rows, basis: _Basis) -> list[tuple[int, list[int]]]:
    """Constraints joined by circuits of rows."""
    graph: nx.Graph = nx.Graph()
    for i, support in basis.supports.items():
        graph.add_node(rows.owners[i])
        graph.add_edges_from((rows.owners[i], rows.owners[j]) for j in support)
    groups = []
    for component in nx.connected_components(graph):
        nullity = sum(rows.owners[i] in component for i in basis.supports)
        groups.append((nullity, sorted(component)))
    return sorted(groups, key=lambda group: group[1])


def _spans(rows: Rows, kept: set[int], everything: set[int], full: int, full_finite: int) -> bool:
    """Do the kept constraints imply the others? Finite ones only by finite ones: a rate does not fix a constant."""
    if rank(rows.of(kept), rows.p) != full:
        return False
    return rank(rows.of(kept, finite_only=True), rows.p) == full_finite


def _droppable(rows: Rows, members: list[int], basis: _Basis) -> list[int]:
    """As many constraints of a group as can go together; of several choices the last in the order."""
    if len(members) > SEARCHED or all(list(rows.owners).count(o) == 1 for o in members):
        return [o for o in members if not basis.pivot_rows_of(o)]
    everything = set(members)
    full, full_finite = rank(rows.of(everything), rows.p), rank(rows.of(everything, finite_only=True), rows.p)
    kept, dropped = set(members), []
    for owner in reversed(members):
        if _spans(rows, kept - {owner}, everything, full, full_finite):
            kept.discard(owner)
            dropped.append(owner)
    for size in range(len(members) - 1, len(dropped), -1):
        for choice in combinations(reversed(members), size):
            if _spans(rows, everything - set(choice), everything, full, full_finite):
                return list(choice)
    return dropped


def _circuit(rows: Rows, order: list[int], owner: int, basis: _Basis) -> list[int]:
    """A minimal set of other constraints on which a redundant one depends, of those before it where that can be."""
    own_rows = [i for i, o in enumerate(rows.owners) if o == owner]
    if all(i in basis.supports for i in own_rows):
        supports = {rows.owners[j] for i in own_rows for j in basis.supports[i]} - {owner}
        if len(own_rows) == 1:
            return sorted(supports)
        kept = [o for o in order if o in supports]
    else:
        kept = [o for o in order if o != owner]
    own = rows.of({owner})
    for other in reversed(list(kept)):
        fewer = rows.of(set(kept) - {other})
        if rank(fewer, rows.p) == rank([*fewer, *own], rows.p):
            kept.remove(other)
    return sorted(kept)
