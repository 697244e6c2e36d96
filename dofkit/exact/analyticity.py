"""Analyticity: whether a function that is not identically zero vanishes on no open set [IsolatedZeros].

A quotient is analytic on the complex numbers without its poles. This set is connected, so poles are no obstacle; but
inside a root, a logarithm, an absolute value or an inverse function they are: t*sqrt(1 + 1/t^2) - sqrt(1 + t^2)
is 0 for t > 0 only.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

from dofkit.exact.ring.radicals import sense_of
from dofkit.expressions.tree import Expr

#: Functions that are analytic on the whole real line, and have one value at every complex number but their poles.
ENTIRE = frozenset({"exp", "sin", "cos", "sinh", "cosh", "tanh"})
#: Functions that are analytic except at real poles.
POLAR = frozenset({"tan", "cot", "sec", "csc"})


def is_analytic(
    e: Expr, symbols: Iterable[Expr], positive: frozenset[Expr] = frozenset(), *, poles: bool = True
) -> bool:
    """Return whether ``e`` is proved to be one analytic function of ``symbols``; False if this is not known.

    It is proved if no absolute value, root, logarithm or inverse function has an argument that can reach the boundary
    of its domain or of its branch. An argument of the first degree may reach the boundary of the domain, because the
    rest of the domain is convex. Other symbols are constants, those of ``positive`` are greater than 0, and unknown
    functions are generic ones. With ``poles=False``, ``e`` must also have a value at all real points.

    >>> from dofkit.expressions import tree as ex
    >>> x, t = ex.coordinate("x"), ex.TIME
    >>> is_analytic(t + ex.fn("abs", t), [t]), is_analytic(t + ex.fn("abs", x), [t])
    (False, True)
    >>> [is_analytic(ex.sqrt(u), [t]) for u in (t**2, t**2 - 1, 2 + t**2, t - 3)]
    [False, False, True, True]
    >>> is_analytic(ex.fn("acos", ex.fn("cos", t)) - t, [t]), is_analytic(ex.fn("log", ex.fn("cosh", t)), [t])
    (False, True)
    >>> is_analytic(1 / t, [t]), is_analytic(1 / t, [t], poles=False), is_analytic(ex.sqrt(1 + 1 / t**2), [t])
    (True, False, False)
    """
    moving = frozenset(symbols)
    if e.op == "sym" or moving.isdisjoint(e.symbols):
        return True
    within = partial(is_analytic, symbols=moving, positive=positive, poles=poles)
    without_poles = partial(is_analytic, symbols=moving, positive=positive, poles=False)
    if e.op == "call":
        return all(map(without_poles, e.args[2]))
    if e.op in ("add", "mul"):
        return all(map(within, e.args))
    if e.op == "fn":
        name, *arguments = e.args
        if name in ENTIRE or (poles and name in POLAR):
            return within(arguments[0])
        ends = poles and name in ("log", "asin", "acos") and _is_affine(arguments[0], moving)
        return ends or (all(map(without_poles, arguments)) and _is_inside_branch(name, arguments, positive))
    base, exponent = e.args
    if exponent.op == "num" and exponent.args[0].denominator == 1:
        return within(base) and (poles or exponent.args[0] > 0 or sense_of(base, positive) == ">")
    ends = poles and (exponent.op != "num" or exponent.args[0].denominator % 2 == 0) and _is_affine(base, moving)
    return (ends or (without_poles(base) and sense_of(base, positive) == ">")) and within(exponent)


def _is_affine(e: Expr, moving: frozenset[Expr]) -> bool:
    """Return whether ``e`` is a sum of constants and constant multiples of the symbols."""
    if e in moving or moving.isdisjoint(e.symbols):
        return True
    if e.op not in ("add", "mul"):
        return False
    variable = [part for part in e.args if not moving.isdisjoint(part.symbols)]
    return (e.op == "add" or len(variable) == 1) and all(_is_affine(part, moving) for part in variable)


def _is_inside_branch(name: str, arguments: Sequence[Expr], positive: frozenset[Expr]) -> bool:
    """Return whether the arguments of a function stay away from the boundaries of its domain and of its branch."""
    return name == "atan" or (name in ("log", "abs", "atan2") and sense_of(arguments[-1], positive) == ">")
