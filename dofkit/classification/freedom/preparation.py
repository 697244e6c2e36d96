"""A system made ready for the engines: every relation as what it says, and what may be assumed of its symbols."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from itertools import chain, count

from dofkit.base.deadline import check
from dofkit.base.errors import Fault, SceneError, TextError
from dofkit.exact.analyticity import is_analytic
from dofkit.expressions import tree as ex
from dofkit.expressions.renaming import Unwritten, kinds_in, shape_of
from dofkit.expressions.tree import Expr
from dofkit.integrability import accelerations
from dofkit.mobility.bridges import Bridges, bridges
from dofkit.mobility.rows_at_drawing import RowsAtDrawing
from dofkit.relations.normal.normal_form import normalise
from dofkit.relations.normal.pieces import INSTANT_NOTE, Finite, Inequality, Normal, Piece, Reduced, unwritten
from dofkit.relations.normal.polynomial_zeros import PRODUCT_NOTE
from dofkit.relations.piece_shapes import NormalTemplate
from dofkit.relations.setting import ALL, Reductions, Setting
from dofkit.system import System

#: The kinds of symbols that no finite relation holds.
RATES = frozenset({"velocity", "acceleration", "differential", "dt"})


def prepared(system: System, reductions: Reductions = ALL) -> tuple[list[Reduced], Setting]:
    """Each relation as what it says, and what may be assumed of the symbols."""
    positive = frozenset(ex.parameter(p) for p, sign in system.parameters.items() if sign == "positive")
    generic = tuple([ex.parameter(p) for p in system.generic])
    positive |= frozenset([p for p in generic if p.args[1].startswith("_L")])
    apart = bridges(system) if "bridges" in reductions and system.tolerance is None else Bridges()
    reduced = reduce_all(system, positive, apart.joints)
    setting = Setting(
        positive,
        generic,
        system.pose,
        system.reference,
        system.coordinates,
        system.tolerance,
        system.size,
        dimension=system.dimension,
        distances={} if system.tolerance else system.distances,
        links=_links(system),
        reductions=reductions,
        welds=frozenset(i for i, c in enumerate(system.constraints) if c.facts.welded),
        geometric=frozenset(i for i, c in enumerate(system.constraints) if not c.facts.written or c.facts.contact),
        arms=system.arms,
        tilts=frozenset(r.names[1] for r in system.rotations if r.chart == "euler"),
        bridges=apart.joints,
        afloat=apart.afloat,
        joint_rows=RowsAtDrawing(system, positive).of if apart.joints else None,
    )
    return reduced, setting


def _links(system: System) -> dict[int, list[tuple[str, str]]]:
    """The particles that rigid links join, by constraint."""
    found: dict[int, list[tuple[str, str]]] = {}
    for i, a, b in system.links:
        found.setdefault(i, []).append((a, b))
    return found


def reduce_all(system: System, positive: frozenset[Expr], apart: frozenset[int] = frozenset()) -> list[Reduced]:
    """Every relation of every constraint as what it says; all that cannot be one are faults together.

    Those of joints ``apart`` are not written out where they are not yet.
    """
    found, faults = [], []
    read = _Normals(system, positive)
    for i, constraint in enumerate(system.constraints):
        if i in apart and isinstance(constraint.relations, Unwritten):
            found.append(Reduced(constraint, unwritten(constraint.relations), (), constraint.relations))
            continue
        normals, inequalities, written = [], [], []
        for relation in constraint.relations:
            check()
            if relation.sense != "=":
                inequalities.append(Inequality(relation.expr, relation.sense == ">"))
                continue
            try:
                normal = read.normal(relation.expr, constraint.facts.written)
                normals.append(normal)
                written.append(relation)
            except TextError as error:
                faults.append(Fault(f"'{constraint.name}': {error.message}", ("constraints", i), hint=error.hint))
        found.append(Reduced(constraint, tuple(normals), tuple(inequalities), tuple(written)))
    if faults:
        raise SceneError(tuple(faults), system.name)
    return found


class _Normals:
    """What relations say; of those that are the same up to names, in the same order, one is looked at."""

    def __init__(self, system: System, positive: frozenset[Expr]) -> None:
        self._positive = positive
        self._fresh = _fresh(system)
        self._known: dict[Hashable, NormalTemplate] = {}

    def normal(self, e: Expr, written: bool) -> Normal:
        """What ``e = 0`` says. Raises TextError where it can be no relation."""
        kinds = kinds_in(e)
        if not written and kinds.isdisjoint(RATES):
            return Normal(((),) if e.is_zero else ((Finite(e),),))
        if "acceleration" in kinds:
            return accelerations.without_accelerations(e, self._positive, self._fresh)
        if not written:
            return without_instants(normalise(e, self._positive, written), self._positive)
        shape = shape_of(e)
        key = (shape.skeleton, shape.order)
        if key in self._known:
            return self._known[key].of(shape.names)
        found = without_instants(normalise(e, self._positive, written), self._positive)
        self._known[key] = NormalTemplate(found, shape.names)
        return found


def _fresh(system: System) -> Iterator[str]:
    """Names for constants of integration: C, C1, C2, ... without those of the scene."""
    taken = {c.name for c in system.coordinates} | {*system.parameters, *system.generic, *system.functions}
    return (name for name in chain(("C",), (f"C{i}" for i in count(1))) if name not in taken)


def without_instants(normal: Normal, positive: frozenset[Expr]) -> Normal:
    """A product's branch that only fixes the time (t = 0 of ``t (x - y) = 0``) is no branch of motion: left out."""
    kept = tuple(b for b in normal.branches if not any(_fixes_time(p, positive) for p in b))
    if not kept or len(kept) == len(normal.branches):
        return normal
    return Normal(kept, (*(n for n in normal.notes if n != PRODUCT_NOTE), INSTANT_NOTE))


def _fixes_time(piece: Piece, positive: frozenset[Expr]) -> bool:
    """Return whether a piece is a relation of time and parameters alone that is satisfied at isolated values only."""
    if not isinstance(piece, Finite) or not piece.expr.symbols:
        return False
    alone = all(s.args[0] in ("time", "parameter") for s in piece.expr.symbols)
    return alone and is_analytic(piece.expr, piece.expr.symbols, positive)
