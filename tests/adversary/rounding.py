"""Bounds that are tight in their last digits: possible or not as exact fractions say, whatever is lost in rounding."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from dofkit.benchmark.trials.construction import IMPOSSIBLE, KnownScene, scene_of, truths

from .draws import decimal, factor

#: How far the bound is used up: below 1 there is a curve, at 1 a point, above it nothing.
SHARES = (Fraction(1, 2), Fraction(1), 1 + Fraction(1, 10**9), Fraction(2), Fraction(99, 100), 1 - Fraction(1, 10**12))


def within(share: Fraction, dof: int) -> Mapping[str, Any]:
    """Of a set of that dimension where the share is below 1, of a point at 1, of nothing above."""
    return truths(dof if share < 1 else 0, holonomic=True) if share <= 1 else IMPOSSIBLE


def reciprocal(rng: random.Random, size: int) -> KnownScene:
    """z = 1/(B + u^2) is at most 1/B, and z - n = s = e + w^2 with e a share of 1/B - n, B the float of 1/n: below 1
    what is left is an oval in u and w. Where 1/B < n, n - z = s = (2 - share)(n - 1/B) - w^2: the same."""
    n = rng.choice([k for k in range(3, 200) if Fraction(1 / k) * k != 1])
    b, share = Fraction(1 / n), rng.choice(SHARES)
    gap = 1 / b - n
    if gap > 0:
        relations = [f"z = 1/({b} + u^2)", f"z - {n} = s", f"s = {gap * share} + w^2"]
        return KnownScene(scene_of("u w z s", *relations), within(share, 1))
    relations = [f"z = 1/({b} + u^2)", f"{n} - z = s", f"s = {-gap * (2 - share)} - w^2"]
    return KnownScene(scene_of("u w z s", *relations), within(share, 1))


#: A function of x, and whether a number is more than its least value.
LEAST: tuple[tuple[str, Fraction, Callable[[Fraction], bool]], ...] = (
    ("x^4 - x", Fraction(-47247039371, 10**11), lambda c: c > 0 or (-c) ** 3 * 256 < 27),
    ("x^2 - 3*x", Fraction(-9, 4), lambda c: c > Fraction(-9, 4)),
    ("x^6 - x", Fraction(-58236, 10**5), lambda c: c > 0 or (-c) ** 5 * 6**6 < 5**5),
    ("x^2 + 1/x^2", Fraction(2), lambda c: c > 2),
    ("x^4 - 2*x^2", Fraction(-1), lambda c: c > -1),
    ("exp(x) + exp(-x)", Fraction(2), lambda c: c > 2),
    ("x/(1 + x^2)", Fraction(-1, 2), lambda c: c > Fraction(-1, 2)),
    ("sin(x)*cos(x)", Fraction(-1, 2), lambda c: c > Fraction(-1, 2)),
    ("sin(x) + cos(x)", Fraction(-141421356, 10**8), lambda c: c > 0 or c * c < 2),
)


def least(rng: random.Random, size: int) -> KnownScene:
    """f(x) + y^2 = c holds on a curve where c is more than the least value of f, and nowhere where it is less.

    The least values: x^4 - x: -3/4^(4/3); x^6 - x: -5/6^(6/5); the others are -9/4, 2, -1, 2, -1/2, -1/2, -sqrt(2).
    """
    f, near, above = rng.choice(LEAST)
    places, sign = rng.randint(8 if near.denominator > 4 else 3, 9 + 6 * size), rng.choice((-1, 1))
    c = near + sign * Fraction(1, 10**places)
    known = truths(1, holonomic=True) if above(c) else IMPOSSIBLE
    return KnownScene(scene_of("x y", f"{f} + y^2 = {near} + ({sign})/10^{places}"), known)


def motzkin(rng: random.Random, size: int) -> KnownScene:
    """x^4 y^2 + x^2 y^4 + z^6 - 3 x^2 y^2 z^2 >= 0, and no sum of squares: on z = 1 it is 0 at (+-1, +-1), so it is
    c on a curve, at four points or nowhere."""
    c = rng.choice((-1, 0, 1)) * Fraction(1, 10 ** rng.randint(0, 4 + 2 * size))
    known = IMPOSSIBLE if c < 0 else truths(1 if c else 0, holonomic=True)
    return KnownScene(scene_of("x y", f"x^4*y^2 + x^2*y^4 + 1 - 3*x^2*y^2 = {factor(c)}"), known)


def decimals(rng: random.Random, size: int) -> KnownScene:
    """Decimals are exact: x = 0.1, y = 0.2 and x + y = 0.3 agree, and do not with a digit more."""
    places = rng.randint(1, min(6 + 4 * size, 14))
    a, b = (Fraction(rng.randint(1, 10**places), 10**places) for _ in range(2))
    wrong = rng.choice((Fraction(0), Fraction(1, 10 ** rng.randint(2 * places, 29))))
    operation = rng.choice("+*")
    c = (a + b if operation == "+" else a * b) + wrong
    relations = [f"x = {decimal(a)}", f"y = {decimal(b)}", f"x{operation}y = {decimal(c)}"]
    known = IMPOSSIBLE if wrong else truths(0, redundant=["c3"], redundant_equations=1)
    return KnownScene(scene_of("x y", *relations), known, chart=None if wrong else {"x": str(a), "y": str(b)})
