"""A system prepared for the engines: normal forms of all relations, and the `Setting`.

Also: which branches of a relation pass through the reference configuration, and which constraints are copies of others.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Sequence

from dofkit.base.deadline import check
from dofkit.base.errors import Fault, SceneError, TextError
from dofkit.configuration.at_reference import ball_matrix, ball_point
from dofkit.configuration.variety import point_at
from dofkit.exact.analyticity import is_analytic
from dofkit.exact.ring.program import false_without_value
from dofkit.exact.zero import is_zero, odd_constants
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.renaming import Renaming, Unwritten, kinds_in, shape_of
from dofkit.expressions.tree import Expr
from dofkit.mobility.joint_tree import Bridges, bridges
from dofkit.mobility.rows_at_reference import RowsAtReference
from dofkit.relations.blocks import Block, Row, coordinates_of, make_chart
from dofkit.relations.normal.domain import DomainCondition, arguments_of, is_satisfied_at, up_to_a_number
from dofkit.relations.normal.normal_form import normalise
from dofkit.relations.normal.pieces import (
    INSTANT_NOTE,
    Finite,
    Inequality,
    JointEquation,
    Normal,
    Pfaffian,
    Piece,
    Reduced,
    in_names,
    unwritten,
)
from dofkit.relations.normal.polynomial_zeros import PRODUCT_NOTE
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import Alternative, RewrittenRow
from dofkit.system import System

#: The kinds of symbols that no geometric equation determines.
RATES = frozenset({"velocity", "differential", "dt"})


def prepared(system: System) -> tuple[list[Reduced], Setting]:
    """Return (every constraint with its normal forms, the setting); raises SceneError as `reduce_all` does."""
    positive = frozenset(ex.parameter(p) for p, sign in system.parameters.items() if sign == "positive")
    generic = tuple([ex.parameter(p) for p in system.generic])
    positive |= frozenset([p for p in generic if p.args[1].startswith("_L")])  # squared lengths without a number
    exact = system.joints and system.tolerance is None
    bridging = bridges(system) if exact else Bridges()
    reduced = reduce_all(system, positive, bridging.joints)
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
        geometric=frozenset(i for i, c in enumerate(system.constraints) if not c.facts.written or c.facts.contact),
        arms=system.arms,
        tilts=frozenset(r.names[1] for r in system.rotations if r.chart == "euler"),
        bridges=bridging.joints,
        afloat=bridging.afloat,
        joint_rows=RowsAtReference(system, positive).rows_of_joints if bridging.joints else None,
    )
    return reduced, setting


def _links(system: System) -> dict[int, list[tuple[str, str]]]:
    """Return {constraint: pairs of particles that its rigid links join}."""
    result: dict[int, list[tuple[str, str]]] = {}
    for i, a, b in system.links:
        result.setdefault(i, []).append((a, b))
    return result


def reduce_all(system: System, positive: frozenset[Expr], bridging: frozenset[int] = frozenset()) -> list[Reduced]:
    """Return every constraint with the normal forms of its relations.

    The equations of ``bridging`` joints stay unwritten. Raises SceneError with a fault for each invalid relation.
    """
    result, faults = [], []
    normal_forms = _Normals(positive)
    for i, constraint in enumerate(system.constraints):
        if i in bridging and isinstance(constraint.relations, Unwritten):
            result.append(Reduced(constraint, unwritten(constraint.relations), (), constraint.relations))
            continue
        normals, inequalities, written = [], [], []
        for relation in constraint.relations:
            check()
            if relation.sense != "=":
                inequalities.append(Inequality(relation.expr, relation.sense == ">"))
                continue
            try:
                normal = normal_forms.normal(relation.expr, constraint.facts.written)
                normals.append(normal)
                written.append(relation)
            except TextError as error:
                faults.append(Fault(f"'{constraint.name}': {error.message}", ("constraints", i), hint=error.hint))
        result.append(Reduced(constraint, tuple(normals), tuple(inequalities), tuple(written)))
    if faults:
        raise SceneError(tuple(faults), system.name)
    return result


class _Normals:
    """Computes normal forms, once for relations that are equal up to names with the names in the same order."""

    def __init__(self, positive: frozenset[Expr]) -> None:
        self._positive = positive
        self._normals: dict[Hashable, tuple[Normal, tuple[str, ...]]] = {}

    def normal(self, e: Expr, written: bool) -> Normal:
        """Return the normal form of ``e = 0``; raises TextError if it is not a valid relation."""
        if not written and kinds_in(e).isdisjoint(RATES):
            return Normal(((),) if e.is_zero else ((Finite(e),),))
        if not written:
            return without_instants(normalise(e, self._positive, written), self._positive)
        shape = shape_of(e)
        key = (shape.skeleton, shape.name_order)
        if key in self._normals:
            earlier, names = self._normals[key]
            return in_names(earlier, Renaming(dict(zip(names, shape.names, strict=True))))
        result = without_instants(normalise(e, self._positive, written), self._positive)
        self._normals[key] = result, shape.names
        return result


def without_instants(normal: Normal, positive: frozenset[Expr]) -> Normal:
    """Return a normal form without branches that fix the time (t = 0 of ``t (x - y) = 0``), unless all do."""
    kept = tuple(b for b in normal.branches if not any(_fixes_time(p, positive) for p in b))
    if not kept or len(kept) == len(normal.branches):
        return normal
    return Normal(kept, (*(n for n in normal.notes if n != PRODUCT_NOTE), INSTANT_NOTE))


def _fixes_time(piece: Piece, positive: frozenset[Expr]) -> bool:
    """Return whether a piece is a relation of time and parameters alone that is satisfied at isolated values only."""
    if not isinstance(piece, Finite) or not piece.expr.symbols:
        return False
    constant = all(s.args[0] in ("time", "parameter") for s in piece.expr.symbols)
    return constant and is_analytic(piece.expr, piece.expr.symbols, positive)


def branches_at_reference(normal: Normal, setting: Setting) -> Normal:
    """Return the branches through the reference configuration; all of them if there is none, or none passes there."""
    if setting.reference is None or len(normal.branches) < 2:
        return normal
    through = tuple(b for b in normal.branches if passes_reference(b, setting))
    return normal._replace(branches=through) if through else normal


def reductions_at_reference(alternatives: Sequence[Alternative], setting: Setting) -> Sequence[Alternative]:
    """Return the alternatives whose rewritten rows are satisfied at the reference; all if none is, or without one."""
    if setting.reference is None or len(alternatives) < 2:
        return alternatives

    def is_valid(rewritten: RewrittenRow) -> bool:
        return rewritten.unchanged or passes_reference([row.piece for row in rewritten.rows], setting)

    return [a for a in alternatives if all(map(is_valid, a.slots))] or alternatives


@false_without_value
def has_kink_at_reference(normal: Normal, setting: Setting) -> bool:
    """Return whether the argument of an absolute value vanishes at the reference configuration.

    There is no gradient there. The equations of joints contain no absolute values.
    """
    if setting.reference is None:
        return False
    written = (p for p in normal.pieces if isinstance(p, Finite) and not isinstance(p, JointEquation))
    pieces = [p for p in written if "abs" in p.expr.functions or "pow" in p.expr.functions]
    if not pieces:  # the reference configuration may be long
        return False
    configuration = {**setting.reference, ex.TIME: ex.ZERO}
    arguments = [substitute(u, configuration) for p in pieces for u in arguments_of(p.expr)]
    return any(is_zero(u, setting.positive) for u in arguments)


def passes_reference(branch: Sequence[Piece], setting: Setting) -> bool:
    """Return whether the reference configuration satisfies the geometric equations of a branch.

    Balls decide if numbers may be related in a way that arithmetic modulo primes does not show.
    """
    finite = [p for p in branch if isinstance(p, Finite)]
    configuration = {**(setting.reference or {}), ex.TIME: ex.ZERO}
    chart = make_chart(_block(finite), setting)
    point = point_at(chart, configuration, 5) if "field" in setting.engines else None
    if "field" not in setting.engines or odd_constants(chart.ring, named=True):
        ball = ball_point(chart, configuration)
        return ball is not None and ball_matrix(chart, ball, True) is not None
    if point is None:
        return False
    conditions = (p for p in branch if isinstance(p, DomainCondition))
    return not any(is_satisfied_at(c, configuration, setting.positive) is False for c in conditions)


def _block(pieces: Sequence[Finite]) -> Block:
    names = sorted({n for p in pieces for n in coordinates_of(p)})
    return Block(tuple(names), tuple(Row(i, p) for i, p in enumerate(pieces)))


def all_of(answers: Iterable[bool | None]) -> bool | None:
    """Return False if one is False, otherwise None if one is None, otherwise True."""
    every: bool | None = True
    for answer in answers:
        if answer is False:
            return False
        every = every if answer else None
    return every


def any_of(answers: Sequence[bool | None]) -> bool | None:
    """Return True if one is True, otherwise None if one is None, otherwise False."""
    return True if True in answers else None if None in answers else False


def algebraic(e: Expr, *more: str) -> bool:
    """Return whether no functions other than sines, cosines, tangents (and ``more``) occur."""
    return all(n.op != "fn" or n.args[0] in ("sin", "cos", "tan", *more) for n in ex.nodes(e))


def conditional(normal: Normal) -> bool:
    """Return whether some branch consists of conditions only, so that it is satisfied on a region."""
    return any(all(isinstance(p, DomainCondition) for p in branch) for branch in normal.branches if branch)


def copies(reduced: Sequence[Reduced]) -> dict[int, int]:
    """Return {copy: original} for constraints whose relations are those of an earlier one up to numerical factors."""
    alike: dict[Hashable, list[int]] = {}
    for i, r in enumerate(reduced):
        check()
        if r.normals and not r.inequalities and not any(_is_not_compared(normal) for normal in r.normals):
            mentioned = frozenset([frozenset[str]().union(*map(coordinates_of, n.pieces)) for n in r.normals])
            alike.setdefault(mentioned, []).append(i)
    seen: dict[Hashable, int] = {}
    result = {}
    for i in sorted(i for numbers in alike.values() if len(numbers) > 1 for i in numbers):
        keys = Counter(map(scaled, reduced[i].normals))
        original = seen.setdefault(frozenset(keys.items()), i)
        if original != i:
            result[i] = original
    return result


def _is_not_compared(normal: Normal) -> bool:
    """Return whether a relation is not compared: it is satisfied always or never, or is a joint's equation."""
    branches = normal.branches
    return branches in ((), ((),)) or any(isinstance(p, JointEquation) for p in branches[0])


def scaled(normal: Normal) -> Hashable:
    """Return a key that is equal for normal forms that are multiples of each other, piece by piece."""
    return frozenset(frozenset(map(_scaled, branch)) for branch in normal.branches)


def _scaled(piece: Piece) -> Hashable:
    """Return a key that is equal for pieces that are multiples of each other."""
    if isinstance(piece, DomainCondition):
        return piece
    if isinstance(piece, Pfaffian):  # coefficients of dense forms are not expanded: that takes long
        written = sorted(piece.items(), key=lambda item: repr(item[0]))
        scale = next((ex.num(1 / ex.number_and_rest(e)[0]) for _, e in written), ex.ONE)
        return type(piece), tuple([(symbol, ex.mul(scale, e)) for symbol, e in written])
    return type(piece), up_to_a_number(piece.expr)
