"""Relations that hold on several branches: which pass through the reference, and what follows from what."""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import product as cartesian

from flint import arb

from dofkit import expr as ex
from dofkit.answers import Setting
from dofkit.blocks import Block, Row, coordinates_of
from dofkit.charting import make_chart
from dofkit.conditions import Condition, holds_at
from dofkit.exact.balls import BallPoint, OutsideDomainError
from dofkit.exact.field import FieldPoint, NoPointError
from dofkit.exact.identity import is_zero
from dofkit.exact.program import values
from dofkit.exact.ring import Ring, Scalar
from dofkit.exact.trust import doubt
from dofkit.expr import Expr
from dofkit.local import ball_matrix, ball_point
from dofkit.normal import Finite, Normal, Piece
from dofkit.signs import arguments_of, by_signs
from dofkit.variety import Variety, find, on_variety, pose_point
from dofkit.zeros import zero_set

#: Choices of branches that are looked at.
MAX_CHOICES = 16
#: Times that points are drawn: each may land on another part of the set.
SEEDS = 4


def through_reference(normal: Normal, setting: Setting) -> Normal:
    """The branches that hold at the reference configuration; all of them where none is given, or none holds there."""
    if setting.reference is None:
        return normal
    normal = _at_kinks(normal, {**setting.reference, ex.TIME: ex.ZERO}, setting.positive)
    if len(normal.branches) < 2:
        return normal
    kept = tuple(b for b in normal.branches if _holds(b, setting))
    return replace(normal, branches=kept) if kept else normal


def _at_kinks(normal: Normal, known: Mapping[Expr, Expr], positive: frozenset[Expr]) -> Normal:
    """Finite relations told apart by the signs of what stands in abs() and vanishes at the reference."""
    branches: list[tuple[Piece, ...]] = []
    kinked = False
    for branch in normal.branches:
        options: list[list[tuple[Piece, ...]]] = []
        for p in branch:
            folded = _folded(p.expr, known, positive) if isinstance(p, Finite) else []
            kinked = kinked or bool(folded)
            options.append(_by_signs(p.expr, folded, positive) if folded and isinstance(p, Finite) else [(p,)])
        branches += [tuple(q for part in choice for q in part) for choice in cartesian(*options)]
    return replace(normal, branches=tuple(branches), kinked=True) if kinked else normal


def _folded(e: Expr, known: Mapping[Expr, Expr], positive: frozenset[Expr]) -> list[Expr]:
    """The arguments of absolute values that vanish at the reference."""
    try:
        return [u for u in arguments_of(e) if is_zero(ex.substitute(u, known), positive)]
    except ZeroDivisionError:
        return []


def _by_signs(e: Expr, arguments: Sequence[Expr], positive: frozenset[Expr]) -> list[tuple[Piece, ...]]:
    found: list[tuple[Piece, ...]] = []
    for signed, conditions in by_signs(e, arguments, positive):
        moving = frozenset(s for s in signed.symbols if s.args[0] in ("coordinate", "time"))
        zeros = ((),) if is_zero(signed, positive) else zero_set(signed, positive, moving)[0]
        found += [(*map(Finite, conjunction), *conditions) for conjunction in zeros]
    return found


def _holds(branch: Sequence[Piece], setting: Setting) -> bool:
    finite = [p for p in branch if isinstance(p, Finite)]
    known = {**(setting.reference or {}), ex.TIME: ex.ZERO}
    chart = make_chart(_block(finite), setting)
    if "field" not in setting.engines:
        ball = ball_point(chart, known, random.Random("dofkit branch"))
        return ball is not None and ball_matrix(chart, ball, True) is not None
    point = pose_point(chart, known, 5)
    if point is None or not on_variety(chart, point):
        return False
    return all(holds_at(p, known, setting.positive) is not False for p in branch if isinstance(p, Condition))


def _block(pieces: Sequence[Finite]) -> Block:
    names = sorted({n for p in pieces for n in coordinates_of(p)})
    return Block(tuple(names), tuple(Row(i, p) for i, p in enumerate(pieces)))


def follows(normal: Normal, others: Sequence[Normal], setting: Setting) -> bool | None:
    """Does a finite relation hold on every branch of the others?

    It is evaluated at generic points of each branch. None where no such points were found.
    """
    if not _finite(normal) or not all(_finite(o) for o in others) or _conditional(normal):
        return None
    choices = list(cartesian(*(o.branches for o in others)))
    if len(choices) > MAX_CHOICES:
        return None
    return all_of(
        _vanishes(normal, [p for b in choice for p in b if isinstance(p, Finite)], setting) for choice in choices
    )


def all_of(answers: Iterable[bool | None]) -> bool | None:
    """False where one is, else None where one is, else True."""
    found: bool | None = True
    for answer in answers:
        if answer is False:
            return False
        found = found if answer else None
    return found


def algebraic(e: Expr) -> bool:
    """No functions beyond sines and cosines: then what is not 0 over GF(p) is not 0."""
    return all(n.op != "fn" or n.args[0] in ("sin", "cos", "tan") for n in ex.nodes(e))


def _conditional(normal: Normal) -> bool:
    """Does a branch say only where it holds?"""
    return any(all(isinstance(p, Condition) for p in branch) for branch in normal.branches if branch)


def _finite(normal: Normal) -> bool:
    return all(isinstance(p, Finite) for p in normal.pieces)


def _vanishes(normal: Normal, pieces: Sequence[Finite], setting: Setting) -> bool | None:
    """Does one of the relation's branches hold at generic points of the pieces' set?"""
    extra = [p.expr for p in normal.pieces if isinstance(p, Finite)]
    names = sorted({n for p in (*pieces, *normal.pieces) for n in coordinates_of(p)})
    block = Block(tuple(names), tuple(Row(i, p) for i, p in enumerate(pieces)))
    chart = make_chart(block, replace(setting, reference=None), (), extra)
    nodes: dict[Expr, int] = {e: chart.ring.node(e) for e in extra}
    doubted = doubt(chart.ring) is not None
    told: list[bool | None] = []
    for seed in range(SEEDS):
        found = find(chart, {}, 10 * seed)
        if found.consistent is False:
            return True
        for point in _points(found, doubted):
            holds = _holds_at(chart.ring, point, normal, nodes)
            if holds is False:
                return False
            told.append(holds)
    return all_of(told) if told else None


def _holds_at(ring: Ring, point: FieldPoint | BallPoint, normal: Normal, nodes: Mapping[Expr, int]) -> bool | None:
    """Does one of the relation's branches hold at a point? None where it has no value there."""
    try:
        at = values(ring, point)
    except (ZeroDivisionError, NoPointError, OutsideDomainError):
        return None
    return any(all(_zero(at[nodes[p.expr]]) for p in b if isinstance(p, Finite)) for b in normal.branches)


def _points(found: Variety, doubted: bool) -> Sequence[FieldPoint | BallPoint]:
    """Points over GF(p); the real one where there are none, or where they may mislead."""
    if found.samples and not doubted:
        return found.samples
    real = found.real
    return [real.point] if real is not None and real.certified and real.consistent else []


def _zero(value: Scalar) -> bool:
    """0 over GF(p), or what no ball tells from 0."""
    return bool(value.contains(0)) if isinstance(value, arb) else bool(value == 0)
