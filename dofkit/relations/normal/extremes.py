"""Sines and cosines that take their largest or smallest value: cos(u) = 1, sin(u) + cos(v) = -2, cos(u)^2 = 1.

Written so, the gradient vanishes wherever the relation holds. 1 - cos u = 2 sin(u/2)^2, 1 + cos u = 2 cos(u/2)^2,
1 -+ sin u = (sin(u/2) -+ cos(u/2))^2 and 1 - cos(u)^2 = sin(u)^2 give the same set with a gradient that does not.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from dofkit.exact.ring.canonical import Canon
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

EXTREME_NOTE = (
    "a sine or cosine takes its largest or smallest value only: this is written in terms of half the angle, "
    "because its own gradient vanishes there"
)

Factors = list[tuple[Any, int]]


def apart(canon: Canon, factors: Factors, variables: frozenset[Expr]) -> tuple[list[tuple[Expr, ...]], Factors]:
    """(branches, each a list of regular expressions, of the factors that vanish at extremes only; the other factors).

    ``variables`` are coordinates and time; an angle with a velocity or an unknown function in it is left as it is.
    """
    found: dict[int, set[int]] = {}
    branches: list[tuple[Expr, ...]] = []
    others: Factors = []
    for factor, multiplicity in factors:
        extremes = _extremes(canon, factor, variables)
        if extremes is None:
            others.append((factor, multiplicity))
        elif len(extremes) == 1:
            index, value = extremes[0]
            found.setdefault(index, set()).add(value)
        else:
            branches.append(tuple(_regular(canon, index, value) for index, value in extremes))
    for index, values in found.items():
        both = len(values) == 2
        branches.append((_partner(canon, index) if both else _regular(canon, index, next(iter(values))),))
    return branches, others


def _extremes(canon: Canon, poly: Any, variables: frozenset[Expr]) -> Sequence[tuple[int, int]] | None:
    """(generator, its value 1 or -1) for c + sum a_i g_i with |c| = sum |a_i|; None for anything else."""
    n = len(canon.ring.vars)
    constant, weights = Fraction(0), dict[int, Fraction]()
    for exponents, coefficient in poly.to_dict().items():
        present = [n - 1 - i for i, k in enumerate(exponents) if k]
        value = Fraction(int(coefficient.p), int(coefficient.q))
        if not present:
            constant = value
        elif sum(exponents) == 1 and _plain(canon, present[0], variables):
            weights[present[0]] = value
        else:
            return None
    if not weights or abs(constant) != sum(map(abs, weights.values())):
        return None
    return [(index, -1 if (weight > 0) == (constant > 0) else 1) for index, weight in weights.items()]


def _plain(canon: Canon, index: int, variables: frozenset[Expr]) -> bool:
    """A sine or cosine of a known expression in the variables."""
    if canon.ring.vars[index].kind not in ("cos", "sin"):
        return False
    argument = canon.ring.var_expr[index].args[1]
    moving = argument.symbols & variables
    known = all(s.args[0] in ("coordinate", "time", "parameter") for s in argument.symbols)
    return bool(moving) and known and all(node.op != "call" for node in ex.nodes(argument))


def _regular(canon: Canon, index: int, value: int) -> Expr:
    """What is 0 where the generator has the value."""
    half = ex.HALF * canon.ring.var_expr[index].args[1]
    sin, cos = ex.fn("sin", half), ex.fn("cos", half)
    if canon.ring.vars[index].kind == "cos":
        return sin if value == 1 else cos
    return sin - cos if value == 1 else sin + cos


def _partner(canon: Canon, index: int) -> Expr:
    """The sine where the cosine is 1 or -1, and the other way round."""
    return canon.ring.var_expr[canon.ring.vars[index].partner]
