"""What depends on what by the rank of the rows, and where that holds."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Literal

from dofkit.base.components import components
from dofkit.base.deadline import check
from dofkit.base.verdicts import About
from dofkit.classification.dependence.circuits import OwnedRows, Redundancies, analyse
from dofkit.classification.dependence.implication import SLACK
from dofkit.classification.dependence.implied_constraints import MAX_CHOICES, constraint_follows
from dofkit.classification.freedom.reference_branches import algebraic, all_of
from dofkit.configuration.states import States
from dofkit.exact.ideals import complex_dimension
from dofkit.exact.matrices.sparse import SparseRow
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, coordinates_of
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.reduced import Reduced
from dofkit.relations.setting import Setting

#: Real points that are looked for where a relation may fail.
POINTS = 4
#: Functions of which a relation may say one branch only.
BRANCHES = ("abs", "exp", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh")


def at_a_point(r: Redundancies, reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int]) -> Redundancies:
    """Redundant by rank at a point, and not known to be so elsewhere.

    Nothing is, where every one of a group fails at some real point of all others; it is then not counted there.
    """
    independent = {i: k for i, k in r.independent.items() if i not in r.redundant}
    members = {i for _, group in r.groups for i in group}
    needed = all(_fails_at_a_real_point(reduced, i, [j for j in numbers if j != i], setting) for i in members)
    if needed:
        return Redundancies(independent, [], [], {}, uncounted=tuple(r.redundant))
    return Redundancies(independent, [], [], {}, tuple(r.redundant))


def _fails_at_a_real_point(reduced: Sequence[Reduced], i: int, others: Sequence[int], setting: Setting) -> bool:
    """Is a real point of the others certified at which an equation g of constraint i is not 0, where s g = 1?"""
    rows = [Row(j, p) for j in others for n in reduced[j].normals for p in n.pieces if isinstance(p, Finite)]
    for g in (p.expr for n in reduced[i].normals for p in n.pieces if isinstance(p, Finite)):
        away = Row(i, Finite(ex.coordinate(SLACK) * g - ex.ONE))
        names = sorted(frozenset[str]().union(*(coordinates_of(row.piece) for row in (*rows, away))))
        states = States(names, [*rows, away], (), setting, (), True)
        if next(states.certain(POINTS), None) is not None:
            return True
    return False


def holds_where(
    reduced: Sequence[Reduced], setting: Setting, numbers: Sequence[int], by_rank: Sequence[Redundancies]
) -> About | Literal[False] | None:
    """Where does what is redundant by rank hold? False where it fails on some part of what the others leave.

    x^2 + y^2 = 1, x = 1, y = 0: the first two have one gradient at the solution, but without x = 1 there is x = -1.
    Only few algebraic relations are looked at on all parts; else it is told of the point at which the rank was taken.
    Finite ones beside forms are held against each other: of sin(z) = 0 and z = 0 the first can go.
    """
    dropped = {i for r in by_rank for i in r.redundant}
    if setting.reference is not None:
        return "reference"
    if not dropped or len(numbers) > MAX_CHOICES:
        return "component"
    plain = all(reduced[i].constraint.facts.written for i in numbers)
    finite = [i for i in numbers if all(isinstance(p, Finite) for n in reduced[i].normals for p in n.pieces)]
    pieces = [p for i in finite for n in reduced[i].normals for p in n.pieces]
    if not plain or not all(isinstance(p, Finite) and algebraic(p.expr, *BRANCHES) for p in pieces):
        return "component"
    kept = [i for i in finite if i not in dropped]
    told = all_of(constraint_follows(reduced, i, kept, setting) for i in dropped if i in finite)
    if len(finite) < len(numbers):
        return False if told is False else "component"
    if not told:
        return told
    fails = [_fails_on_a_part(reduced, i, kept, setting) for i in dropped]
    return None if True in fails else "component" if None in fails else "everywhere"


def _fails_on_a_part(reduced: Sequence[Reduced], i: int, kept: Sequence[int], setting: Setting) -> bool | None:
    """Is there a complex point of the others where some relation is not 0? Drawn points may all lie on another part.

    There is one where s g = 1 has a solution [Rabinowitsch1929]. Two minors of a matrix imply the third, but not where
    the column that they share is 0. None where the ideal is too large to tell.
    """
    known = [p.expr for j in kept for n in reduced[j].normals for p in n.pieces if isinstance(p, Finite)]
    told: bool | None = False
    for g in (p.expr for n in reduced[i].normals for p in n.pieces if isinstance(p, Finite)):
        relations = [*known, ex.coordinate(SLACK) * g - ex.ONE]
        ring = Ring(relations, setting.positive)
        nodes = [ring.node(e) for e in relations]
        symbols = {s for e in relations for s in e.symbols if s.args[0] != "parameter"}
        moving = [k for s in symbols if (k := ring.var_index(s)) is not None]
        whole = complex_dimension(ring, nodes, moving)
        if whole is not None and whole >= 0:
            return True
        told = None if whole is None else told
    return told


def analysed(group: list[OwnedRows], needed: Collection[int]) -> Redundancies:
    """One group's redundancies; those ``needed`` for what else they say cannot go."""
    check()
    return analyse(group, needed)


def joined_parts(parts: Sequence[OwnedRows]) -> list[list[OwnedRows]]:
    """Blocks that share a constraint are looked at together."""
    owned = [part for part in parts if part.owners]
    return [[owned[k] for k in numbers] for numbers in components(part.owners for part in owned)]


def without_hidden(block: Block, a: Answer) -> list[SparseRow]:
    """The matrix without the rows of hidden relations."""
    first = len(block.finite)
    return a.matrix[:first] + a.matrix[first + len(a.hidden) :]
