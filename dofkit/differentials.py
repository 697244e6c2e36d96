"""Differentials and velocities: dq = qdot dt.

A relation homogeneous of degree k in (dq, dt) is divided by dt^k; one that adds differentials to finite terms
says nothing, and one in accelerations is no constraint on configurations or velocities.
"""

from __future__ import annotations

from dofkit import expr as ex
from dofkit.errors import TextError
from dofkit.expr import Expr


def differential_degree(e: Expr) -> int | None:
    """The degree in (dq, dt), None for the number 0. Raises TextError where terms differ."""
    if e.is_zero:
        return None
    if not any(s.args[0] in ("differential", "dt") for s in e.symbols):
        return 0
    if e.op == "sym":
        return 1
    if e.op == "add":
        degrees = {differential_degree(term) for term in e.args} - {None}
        if len(degrees) > 1:
            raise TextError(
                "differentials and finite terms are added together",
                hint="divide every term by dt (write qdot), or multiply every term by a differential",
            )
        return degrees.pop() if degrees else None
    if e.op == "mul":
        return sum(differential_degree(factor) or 0 for factor in e.args)
    if e.op == "pow" and e.args[1].op == "num":
        degree = (differential_degree(e.args[0]) or 0) * e.args[1].args[0]
        if degree.denominator == 1:
            return int(degree)
    raise TextError("a differential stands inside a function", hint="differentials are only added, multiplied, divided")


def in_velocities(e: Expr) -> tuple[Expr, bool]:
    """``e`` in velocities instead of differentials, and whether it had a dt to divide by."""
    degree = differential_degree(e)
    if not degree and not any(s.args[0] in ("differential", "dt") for s in e.symbols):
        return e, False
    mapping = {s: ex.velocity(s.args[1]) for s in e.symbols if s.args[0] == "differential"}
    mapping |= {s: ex.ONE for s in e.symbols if s.args[0] == "dt"}
    return ex.substitute(e, mapping), bool(degree)


def no_acceleration(e: Expr) -> None:
    """Raise TextError for a relation that holds a second derivative."""
    if any(s.args[0] == "acceleration" for s in e.symbols):
        raise TextError(
            "a second derivative is no constraint on configurations or velocities",
            hint="integrate it once, or put it into the equations of motion",
        )
