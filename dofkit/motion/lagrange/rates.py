"""Total derivatives by time, and what an elimination does to velocities and accelerations."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr

_NEXT: dict[str, ex.Kind] = {"coordinate": "velocity", "velocity": "acceleration"}


def by_time(e: Expr) -> Expr:
    """de/dt = sum (de/dq) qdot + (de/dqdot) qddot + de/dt. Raises ValueError for accelerations and differentials."""
    terms = []
    for symbol in sorted(e.symbols, key=lambda s: s.args):
        kind, name = symbol.args
        if kind in _NEXT:
            terms.append(diff(e, symbol) * ex.sym(_NEXT[kind], name))
        elif kind == "time":
            terms.append(diff(e, symbol))
        elif kind != "parameter":
            raise ValueError(f"the derivative of {symbol} by time has no meaning here")
    return ex.add(*terms)


def motions(solved: Mapping[str, Expr]) -> dict[Expr, Expr]:
    """q = f(q', t), its velocity and its acceleration, for every coordinate that was solved for."""
    found: dict[Expr, Expr] = {}
    for name, value in solved.items():
        velocity = by_time(value)
        found[ex.coordinate(name)] = value
        found[ex.velocity(name)] = velocity
        found[ex.sym("acceleration", name)] = by_time(velocity)
    return found
