"""What depends on what by the rank of the rows, and whether that holds wherever the others do."""

from __future__ import annotations

from collections.abc import Sequence

import networkx as nx

from dofkit.base.deadline import check
from dofkit.classification.dependence.by_implication import MAX_CHOICES, constraint_follows
from dofkit.classification.dependence.circuits import OwnedRows, Redundancies, analyse
from dofkit.classification.dependence.implication import SLACK
from dofkit.classification.freedom.through_reference import algebraic, all_of
from dofkit.exact.matrices.sparse import SparseRow
from dofkit.exact.ring.ring import Ring
from dofkit.exact.solving.ideals import complex_dimension
from dofkit.expressions import tree as ex
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block
from dofkit.relations.normal.normal_form import Finite
from dofkit.relations.reduced import Reduced
from dofkit.relations.setting import Setting

#: Functions of which a relation may say one branch only.
BRANCHES = ("abs", "exp", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh")


def at_a_point(r: Redundancies) -> Redundancies:
    """Redundant by rank at a point, and not known to be so elsewhere."""
    independent = {i: k for i, k in r.independent.items() if i not in r.redundant}
    return Redundancies(independent, [], [], {}, tuple(r.redundant))


def everywhere(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], by_rank: Sequence[Redundancies]
) -> bool | None:
    """Does what is redundant by rank hold wherever the others do? False where a written equation does not.

    x^2 + y^2 = 1, x = 1, y = 0: the first two have one gradient at the solution, but without x = 1 there is x = -1.
    """
    dropped = {i for r in by_rank for i in r.redundant}
    if not dropped or setting.reference is not None or len(numbers) > MAX_CHOICES:
        return True
    plain = all(reduced[i].constraint.facts.written for i in numbers)
    pieces = [p for i in numbers for n in reduced[i].normals for p in n.pieces]
    if not plain or not all(isinstance(p, Finite) and algebraic(p.expr, *BRANCHES) for p in pieces):
        return True
    kept = [i for i in numbers if i not in dropped]
    told = all_of(constraint_follows(reduced, i, kept, setting) for i in dropped)
    return None if told and any(_fails_on_a_part(reduced, i, kept, setting) for i in dropped) else told


def _fails_on_a_part(reduced: Sequence[Reduced], i: int, kept: Sequence[int], setting: Setting) -> bool:
    """Is there a complex point of the others where some relation is not 0? Drawn points may all lie on another part.

    There is one where s g = 1 has a solution [Rabinowitsch1929]. Two minors of a matrix imply the third, but not where
    the column that they share is 0.
    """
    known = [p.expr for j in kept for n in reduced[j].normals for p in n.pieces if isinstance(p, Finite)]
    for g in (p.expr for n in reduced[i].normals for p in n.pieces if isinstance(p, Finite)):
        relations = [*known, ex.coordinate(SLACK) * g - ex.ONE]
        ring = Ring(relations, setting.positive)
        nodes = [ring.node(e) for e in relations]
        symbols = {s for e in relations for s in e.symbols if s.args[0] != "parameter"}
        moving = [k for s in symbols if (k := ring.var_index(s)) is not None]
        whole = complex_dimension(ring, nodes, moving)
        if whole is not None and whole >= 0:
            return True
    return False


def analysed(group: list[OwnedRows]) -> Redundancies:
    """One group's redundancies."""
    check()
    return analyse(group)


def sharing(parts: Sequence[OwnedRows]) -> list[list[OwnedRows]]:
    """Blocks that share a constraint are looked at together."""
    graph: nx.Graph = nx.Graph()
    for k, part in enumerate(parts):
        graph.add_edges_from((("part", k), ("constraint", o)) for o in part.owners)
    components = nx.connected_components(graph)
    return [[parts[k] for kind, k in sorted(c) if kind == "part"] for c in components]


def without_hidden(block: Block, a: Answer) -> list[SparseRow]:
    """The matrix without the rows of hidden relations."""
    first = len(block.finite)
    return a.matrix[:first] + a.matrix[first + len(a.hidden) :]
