"""Relations that hold on several branches: which pass through the reference."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence

from dofkit.configuration.drawing.at_reference import ball_matrix, ball_point
from dofkit.configuration.generic_points import on_variety, pose_point
from dofkit.exact.errors import NoValueError
from dofkit.exact.zero import is_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Row, coordinates_of
from dofkit.relations.chart import make_chart
from dofkit.relations.normal.domain import DomainCondition, arguments_of, holds_at
from dofkit.relations.normal.pieces import Finite, JointEquation, Normal, Piece
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import Way


def branches_at_reference(normal: Normal, setting: Setting) -> Normal:
    """Return the branches through the reference configuration; all of them if there is none, or none passes there."""
    if setting.reference is None or len(normal.branches) < 2:
        return normal
    through = tuple(b for b in normal.branches if _passes(b, setting))
    return normal._replace(branches=through) if through else normal


def reductions_at_reference(ways: Sequence[Way], setting: Setting) -> Sequence[Way]:
    """Return the reductions of rows that are valid at the reference; all if there is none, or none is valid."""
    if setting.reference is None or len(ways) < 2:
        return ways
    valid = [way for way in ways if all(s.unchanged or _passes([r.piece for r in s.rows], setting) for s in way.slots)]
    return valid or ways


def has_kink_at_reference(normal: Normal, setting: Setting) -> bool:
    """Return whether the argument of an absolute value vanishes at the reference configuration.

    There is no gradient there. The equations of joints hold no absolute values.
    """
    if setting.reference is None:
        return False
    configuration = {**setting.reference, ex.TIME: ex.ZERO}
    pieces = (p for p in normal.pieces if isinstance(p, Finite) and not isinstance(p, JointEquation))
    try:
        arguments = [substitute(u, configuration) for p in pieces for u in arguments_of(p.expr)]
        return any(is_zero(u, setting.positive) for u in arguments)
    except NoValueError:
        return False


def _passes(branch: Sequence[Piece], setting: Setting) -> bool:
    finite = [p for p in branch if isinstance(p, Finite)]
    configuration = {**(setting.reference or {}), ex.TIME: ex.ZERO}
    chart = make_chart(_block(finite), setting)
    if "field" not in setting.engines:
        ball = ball_point(chart, configuration, random.Random("dofkit branch"))
        return ball is not None and ball_matrix(chart, ball, True) is not None
    point = pose_point(chart, configuration, 5)
    if point is None or not on_variety(chart, point):
        return False
    conditions = (p for p in branch if isinstance(p, DomainCondition))
    return not any(holds_at(c, configuration, setting.positive) is False for c in conditions)


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


def algebraic(e: Expr, *more: str) -> bool:
    """Return whether no functions beyond sines and cosines (and ``more``) occur.

    Then what is not 0 over GF(p) is not 0.
    """
    return all(n.op != "fn" or n.args[0] in ("sin", "cos", "tan", *more) for n in ex.nodes(e))


def conditional(normal: Normal) -> bool:
    """Return whether a branch only states where it is satisfied."""
    return any(all(isinstance(p, DomainCondition) for p in branch) for branch in normal.branches if branch)
