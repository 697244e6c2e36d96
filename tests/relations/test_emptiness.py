"""Relations without a real solution: proved where they have none, never claimed where they have one."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

import dofkit
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.text import Names, parse_relations
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.no_solution import no_solution

R = ex.parameter("R")
NAMES = Names(
    coordinates=frozenset(["x", "y", "z", "u", "v", "a", "b", "c"]),
    parameters={"R": R, "k": ex.parameter("k")},
    functions={"h": 1},
)


def read(text: str) -> list[Expr]:
    return [c.left - c.right for part in text.split(";") for c in parse_relations(part, NAMES)]


#: (relations, why there is no solution)
EMPTY = [
    ("x^2 + cos(x) = -2", "cos x >= -1"),
    ("x^2 + x y + y^2 + 1 = 0", "(x + y/2)^2 + 3 y^2/4 + 1"),
    ("x^2 + y^2 = 1; (x - 5)^2 + y^2 = 1", "circles of radius 1, centres 5 apart"),
    ("x^2 + y^2 = 9; (x - 1)^2 + y^2 = 1", "one circle inside the other: 1 + 1 < 3"),
    ("x^2 + y^2 = 1; (x - 2 - 1e-12)^2 + y^2 = 1", "a gap of 1e-12"),
    ("x^2 + y^2 + z^2 = 1; x + y + z = 2", "the plane is 2/sqrt(3) > 1 away"),
    ("x y = 1; x + y = 1", "y - y^2 = 1 has discriminant -3"),
    ("x^2 = 2; x^3 = 3", "8 is not 9"),
    ("x^5 - x - 1 = 0; x^3 - x - 1 = 0", "no common root"),
    ("x^2 + y^2 = R^2; x = 2 R", "y^2 = -3 R^2 with R > 0"),
    ("x^2 + y^2 = 1; x^2 - y^2 = 3", "x^2 = 2, y^2 = -1"),
    ("u^2 + v^2 = 1; (x - u)^2 + (y - v)^2 = 1; x = 3; y = 0", "two links of length 1 do not reach 3"),
    ("asin(x) = 2", "pi/2 at most"),
    ("acos(x) = -1", "not negative"),
    ("atan(y/x) = 2", "pi/2 at most"),
    ("log(-x^2) = y", "-x^2 is never positive"),
    ("sqrt(-1 - x^2) = y", "the radicand is negative"),
    ("asin(x^2 + 2) = y", "the argument is above 1"),
    ("sqrt(x) + sqrt(-x - 1) = y", "x >= 0 and x <= -1"),
    ("abs(x) = y; y = -1", "not negative"),
    ("x + abs(x) = 0; x = y^2 + 1", "x <= 0 and x >= 1"),
    ("sqrt(x^2 + y^2) = x - 1; x = y", "sqrt(2) |x| = x - 1 has no root"),
    ("sqrt(x^2 + y^2) = x; y = 1", "y^2 = 0"),
    ("tanh(x) = 2", "below 1"),
    ("cosh(x) = 1/2", "1 at least"),
    ("x^2 + exp(y) = 0", "exp is positive"),
    ("h(x)^2 + 1 = 0", "whatever h is"),
]

#: (relations, a solution)
SOLVABLE = [
    ("x^2 + y^2 = 1; (x - 2)^2 + y^2 = 1", "(1, 0), where the circles touch"),
    ("x y = 1; x + y = 2", "(1, 1)"),
    ("x^4 + y^4 + 1 = 4 x y", "on the diagonal 2 x^4 - 4 x^2 + 1 = 0"),
    ("exp(x) = x + 1", "0"),
    ("x = sin(x)", "0"),
    ("3 cos(a) + 4 sin(a) = 5", "cos a = 3/5"),
    ("sqrt(x) = y; x = -y", "(0, 0)"),
    ("x^4 y^2 + x^2 y^4 + 1 = 3 x^2 y^2", "(1, 1), though it is never negative (Motzkin)"),
    ("asin(x^2 + 1) = y", "(0, pi/2)"),
    ("x^2 + y^2 = k", "where k is positive"),
    ("sqrt(x^2 y) = 1", "(1, 1)"),
    ("x + abs(x) = 0", "-1"),
    ("h(x) = -1", "for some h"),
    ("x^2 + y^2 = R^2; x = R", "(R, 0)"),
    ("tan(x) = 1e6", "just below pi/2"),
    ("(x - y)^2 = 0; x = 1e8", "(1e8, 1e8)"),
    ("z = 0; z + atan(1) - pi/4 = 0", "0, by an identity between numbers"),
    ("z = 0; z + sqrt(5 + 2 sqrt(6)) = sqrt(2) + sqrt(3)", "0, the nested root is the sum"),
    ("z = 0; z + 4 atan(1/5) - atan(1/239) - pi/4 = 0", "0, Machin's formula"),
    ("z = 0; z + cos(pi/5) = (1 + sqrt(5))/4", "0"),
    ("(x^2 + 1) (atan(1) - pi/4) = 0", "everything"),
    ("sqrt(x^2) = 0; asin(x) = x", "0, where abs(x)/x has no value"),
    ("(x^2 + 1) z = (x^2 + 1) (asin(sin(pi/7)) - pi/7)", "z = 0"),
]


@pytest.mark.parametrize("text", [row[0] for row in EMPTY])
def test_what_has_no_solution(text: str) -> None:
    assert no_solution(read(text), frozenset({R}))


@pytest.mark.parametrize("text", [row[0] for row in SOLVABLE])
def test_what_has_one(text: str) -> None:
    assert not no_solution(read(text), frozenset({R}))


@pytest.mark.parametrize("text", ["x^2 + y^2 = 1; (x - 5)^2 + y^2 = 1", "sqrt(-1 - x^2) y = z"])
def test_the_report_says_so(text: str) -> None:
    report = dofkit.classify(dofkit.load({"coordinates": ["x", "y", "z"], "constraints": text.split(";")}))
    assert (report.consistent, report.dof, report.verdict) == (False, None, "proved")
    assert report.conflicting == [f"c{i + 1}" for i in range(len(text.split(";")))]


def drawn(rng: random.Random, depth: int, symbols: list[Expr]) -> Expr:
    """A random expression."""
    kind = rng.random()
    if depth == 0 or kind < 0.2:
        return rng.choice(symbols) if rng.random() < 0.75 else ex.num(Fraction(rng.randint(-4, 4), rng.randint(1, 3)))
    parts = [drawn(rng, depth - 1, symbols) for _ in range(2)]
    if kind < 0.45:
        return ex.add(*parts)
    if kind < 0.65:
        return ex.mul(*parts)
    if kind < 0.75:
        return ex.power(parts[0], ex.num(rng.choice([2, 3, 4, Fraction(1, 2), Fraction(1, 3), -1])))
    names = ["sin", "cos", "tan", "exp", "log", "atan", "asin", "acos", "abs", "tanh", "sinh", "cosh"]
    return ex.fn(rng.choice(names), parts[0])


@pytest.mark.parametrize("seed", range(40))
def test_what_holds_at_a_point_is_not_ruled_out(seed: int) -> None:
    """f(x) = f(p) for random functions f and a rational point p, wherever f has a value at p."""
    rng = random.Random(seed)
    symbols = [ex.coordinate(c) for c in "xyz"][: rng.randint(1, 3)]
    point = {s: ex.num(Fraction(rng.randint(-6, 6), rng.randint(1, 4))) for s in symbols}
    relations = []
    while len(relations) < 2:
        try:
            f = drawn(rng, rng.randint(1, 3), symbols)
            at = substitute(f, point)
        except (ZeroDivisionError, ValueError):
            continue
        if f.symbols and all(interval_of(substitute(n, point)) is not None for n in ex.nodes(f)):
            relations.append(f - at)
    assert not no_solution(relations, frozenset())
