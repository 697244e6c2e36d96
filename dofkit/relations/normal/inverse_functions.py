"""Functions undone: u with f(u) = value, each with the conditions under which there is one."""

from __future__ import annotations

from dataclasses import dataclass

from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition


@dataclass(frozen=True)
class Root:
    """The value of the unknown on one branch, and where that branch is."""

    value: Expr
    conditions: tuple[DomainCondition, ...] = ()


def positive_or_zero(e: Expr) -> tuple[DomainCondition, ...]:
    """That it is not negative."""
    return (DomainCondition(e, ">="),)


def _log(value: Expr) -> Expr:
    if value == ex.E:
        return ex.ONE
    inside = value.args[1] if value.op == "fn" and value.args[0] == "exp" else None
    return ex.fn("log", value) if inside is None else inside


def inverse_of(name: str, value: Expr) -> list[Root] | None:
    """u with name(u) = value, for functions with finitely many such u."""
    square = value * value
    if name == "exp":
        return [Root(_log(value), (DomainCondition(value, ">"),))]
    if name == "log":
        return [Root(ex.fn("exp", value))]
    if name == "abs":
        if value.is_zero:
            return [Root(ex.ZERO)]
        return [Root(s * value, positive_or_zero(value)) for s in (1, -1)]
    if name == "sinh":
        return [Root(ex.fn("log", value + ex.sqrt(square + 1)))]
    if name == "cosh":
        if value == ex.ONE:
            return [Root(ex.ZERO)]
        return [Root(s * ex.fn("log", value + ex.sqrt(square - 1)), positive_or_zero(value - 1)) for s in (1, -1)]
    if name == "tanh":
        return [Root(ex.fn("log", (1 + value) / (1 - value)) / 2, (DomainCondition(1 - square, ">"),))]
    half = ex.PI / 2
    if name == "atan":
        return [Root(ex.fn("tan", value), (DomainCondition(half * half - square, ">"),))]
    if name == "asin":
        return [Root(ex.fn("sin", value), positive_or_zero(half * half - square))]
    if name == "acos":
        return [Root(ex.fn("cos", value), (DomainCondition(value, ">="), DomainCondition(ex.PI - value, ">=")))]
    return None
