"""Where powers and functions have a real value: conditions on their arguments."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from dofkit.expressions.tree import ONE, Expr, fn

#: An expression, and what it has to be against 0.
DomainSense = Literal[">=", ">", "!="]
Requirement = tuple[Expr, DomainSense]


def of_power(base: Expr, exponent: Expr) -> Iterator[Requirement]:
    """Yield what ``base^exponent`` requires; a number as base was checked when it was read."""
    if base.op == "num":
        return
    if exponent.op != "num":
        yield base, ">"
    elif exponent.args[0].denominator % 2 == 0:
        yield base, ">=" if exponent.args[0] > 0 else ">"
    elif exponent.args[0] < 0:
        yield base, "!="


def of_function(name: str, u: Expr, *others: Expr) -> Iterator[Requirement]:
    """Yield what an elementary function requires of its arguments."""
    if name == "sqrt":
        yield u, ">="
    elif name == "log":
        yield u, ">"
    elif name in ("asin", "acos"):
        yield ONE - u * u, ">="
    elif name in ("tan", "sec"):
        yield fn("cos", u), "!="
    elif name in ("cot", "csc"):
        yield fn("sin", u), "!="
    elif name == "atan2":
        yield u * u + others[0] * others[0], "!="
