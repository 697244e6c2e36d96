"""Relations that hold on several branches: which pass through the reference."""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import product as cartesian

from dofkit.configuration.drawing.at_reference import ball_matrix, ball_point
from dofkit.configuration.generic_points import on_variety, pose_point
from dofkit.exact.errors import NoValueError
from dofkit.exact.zero import is_proved_zero, is_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.differentials import accelerations_of, in_velocities
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Row, coordinates_of
from dofkit.relations.chart_of_block import make_chart
from dofkit.relations.joint_equations import JointEquation
from dofkit.relations.normal.domain import DomainCondition, has_value, holds_at
from dofkit.relations.normal.normal_form import normalise, velocities_of
from dofkit.relations.normal.pieces import Finite, Normal, Piece
from dofkit.relations.normal.signs import arguments_of, by_signs
from dofkit.relations.normal.zero_set import zero_set
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import Way


def branches_at_reference(normal: Normal, setting: Setting) -> Normal:
    """The branches that hold at the reference configuration; all of them where none is given, or none holds there."""
    if setting.reference is None:
        return normal
    if any(isinstance(p, Finite) and _is_kinked(p) for branch in normal.branches for p in branch):
        normal = _at_kinks(normal, {**setting.reference, ex.TIME: ex.ZERO}, setting.positive)
    if len(normal.branches) < 2:
        return normal
    kept = tuple(b for b in normal.branches if _holds(b, setting))
    return normal._replace(branches=kept) if kept else normal


def reductions_at_reference(ways: Sequence[Way], setting: Setting) -> Sequence[Way]:
    """The ways in which rows read beside others that hold at the reference; all where none is given, or none does."""
    if setting.reference is None or len(ways) < 2:
        return ways
    kept = [way for way in ways if all(s.unchanged or _holds([r.piece for r in s.rows], setting) for s in way.slots)]
    return kept or ways


def crossing_at(normal: Normal, written: Expr, setting: Setting) -> tuple[tuple[Piece, ...], ...] | None:
    """What a relation with several branches asks of velocities at the reference, by branches; else its only branch.

    Of a finite one nothing: its gradient is 0 where branches cross. None where none holds there.
    """
    if len(normal.branches) == 1:
        return normal.branches
    if accelerations_of(written):
        return None
    relation, _ = in_velocities(written)
    if not velocities_of(relation):
        return ((),) if any(_holds(b, setting) for b in normal.branches) else None
    there = substitute(relation, {**(setting.reference or {}), ex.TIME: ex.ZERO})
    if not velocities_of(there):
        return ((),) if is_zero(there, setting.positive) else None
    return normalise(there, setting.positive, True).branches or None


def _is_kinked(piece: Finite) -> bool:
    """Are there absolute values? There are none in the equations of a joint."""
    return not isinstance(piece, JointEquation) and bool(arguments_of(piece.expr))


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
    return normal._replace(branches=tuple(branches), kinked=True) if kinked else normal


def _folded(e: Expr, known: Mapping[Expr, Expr], positive: frozenset[Expr]) -> list[Expr]:
    """The arguments of absolute values that vanish at the reference."""
    try:
        return [u for u in arguments_of(e) if is_zero(substitute(u, known), positive)]
    except NoValueError:
        return []


def _by_signs(e: Expr, arguments: Sequence[Expr], positive: frozenset[Expr]) -> list[tuple[Piece, ...]]:
    found: list[tuple[Piece, ...]] = []
    for signed, conditions in by_signs(e, arguments, positive):
        moving = frozenset(s for s in signed.symbols if s.args[0] in ("coordinate", "time"))
        zeros = ((),) if is_proved_zero(signed, positive) else zero_set(signed, positive, moving)[0]
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
    conditions = [p for p in branch if isinstance(p, DomainCondition)]
    ends = any(c.adjoining and not holds_at(replace(c, adjoining=False), known, setting.positive) for c in conditions)
    return all(_may_hold(c, known, ends, setting.positive) for c in conditions)


def _may_hold(c: DomainCondition, known: Mapping[Expr, Expr], ends: bool, positive: frozenset[Expr]) -> bool:
    """Is a condition not broken at a configuration? Where the branch ``ends`` there, one without a value is not."""
    if holds_at(c, known, positive) is not False:
        return True
    return ends and not has_value(c, known, positive)


def _block(pieces: Sequence[Finite]) -> Block:
    names = sorted({n for p in pieces for n in coordinates_of(p)})
    return Block(tuple(names), tuple(Row(i, p) for i, p in enumerate(pieces)))


def all_of(answers: Iterable[bool | None]) -> bool | None:
    """False where one is, else None where one is, else True."""
    found: bool | None = True
    for answer in answers:
        if answer is False:
            return False
        found = found if answer else None
    return found


def algebraic(e: Expr, *more: str) -> bool:
    """No functions beyond sines and cosines (and ``more``): then what is not 0 over GF(p) is not 0."""
    return all(n.op != "fn" or n.args[0] in ("sin", "cos", "tan", *more) for n in ex.nodes(e))


def conditional(normal: Normal) -> bool:
    """Does a branch say only where it holds?"""
    return any(all(isinstance(p, DomainCondition) for p in branch) for branch in normal.branches if branch)
