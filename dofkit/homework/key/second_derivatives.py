"""Constraints that were differentiated until they hold accelerations: a finite one twice, one of velocities once."""

from __future__ import annotations

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.homework.answers.relations import AnswerReading
from dofkit.homework.key.compared_motion import in_time
from dofkit.homework.key.key import Key
from dofkit.homework.key.right_motion import is_zero
from dofkit.motion.lagrange.elimination import by_time
from dofkit.scene.lowering import lower


def held_accelerations(way: AnswerReading, key: Key, names: tuple[str, ...]) -> bool | None:
    """Is every equation a constant multiple of such a derivative of one of the constraints, and none left out?"""
    system = lower(key.scene)
    wanted = [r.expr for i in system.numbers_of(*names) for r in system.constraints[i].relations if r.sense == "="]
    if not wanted or any(c.relation != "=" for c in way.relations):
        return False
    given = [c.left - c.right for c in way.relations]
    twice = [by_time(_in_velocities(g)) for g in wanted]
    told = [[_multiple(e, g) for g in twice] for e in given]
    if any(True not in row and None in row for row in told):
        return None
    columns = [[row[j] for row in told] for j in range(len(twice))]
    if any(True not in column and None in column for column in columns):
        return None
    return all(True in row for row in told) and all(True in column for column in columns)


def _in_velocities(e: Expr) -> Expr:
    """A relation between velocities: a finite one differentiated by time, a form divided by dt."""
    if all(s.args[0] in ("coordinate", "parameter", "time") for s in e.symbols):
        return by_time(e)
    return in_time(e)


def _multiple(e: Expr, g: Expr) -> bool | None:
    """Is ``e`` a constant times ``g``, a constant that is not 0?"""
    empty: frozenset[Expr] = frozenset()
    for s in sorted((s for s in g.symbols if s.args[0] == "acceleration"), key=repr):
        a, b = diff(e, s), diff(g, s)
        if b.is_zero:
            continue
        told = is_zero(e * b - g * a, empty)
        factor = [is_zero(diff(a, x) * b - diff(b, x) * a, empty) for x in (a.symbols | b.symbols) if _moves(x)]
        if told is False or False in factor or a.is_zero:
            return False
        return None if told is None or None in factor else True
    return False


def _moves(symbol: Expr) -> bool:
    return symbol.op == "sym" and symbol.args[0] != "parameter" and symbol != ex.TIME
