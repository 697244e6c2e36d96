"""Expressions -> text -> expressions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dofkit.base.errors import TextError
from dofkit.exact.zero import is_zero
from dofkit.expressions.calculus import content, substitute
from dofkit.expressions.text import Names, parse_expression, to_text
from dofkit.expressions.tree import (
    DT,
    FUNCTIONS,
    PI,
    TIME,
    E,
    Expr,
    call,
    children,
    coordinate,
    differential,
    fn,
    mul,
    num,
    parameter,
    power,
    rebuild,
    sym,
    velocity,
)

NAMES = Names(
    frozenset({"x", "y", "theta_1", "x_A"}),
    {name: parameter(name) for name in ("R", "omega")},
    {"h": 1, "w": 2},
    allow_accelerations=True,
)
x, y, R = coordinate("x"), coordinate("y"), parameter("R")

PRINTED = {
    "x*y": x * y,
    "y - x": y - x,
    "-x + y": -x + y,
    "x^2 + y^2 - R^2": x**2 + y**2 - R**2,
    "x/2": x / 2,
    "-3*x*y/2": num(Fraction(-3, 2)) * x * y,
    "R*x/(2*y)": R * x / (2 * y),
    "1/y": 1 / y,
    "-1/(x*y^2)": -1 / (x * y**2),
    "(x + y)^3": (x + y) ** 3,
    "R*(x + y)": R * (x + y),
    "R/(x + y)": R / (x + y),
    "sqrt(x)": power(x, num(Fraction(1, 2))),
    "1/sqrt(x)": power(x, num(Fraction(-1, 2))),
    "x^(2/3)": power(x, num(Fraction(2, 3))),
    "x^(-y)": power(x, -y),
    "(x^y)^R": power(power(x, y), R),
    "x^(y^R)": power(x, power(y, R)),
    "sin(x)^2": fn("sin", x) ** 2,
    "xdot": velocity("x"),
    "x_Addot": sym("acceleration", "x_A"),
    "x*dy - R*dt": x * differential("y") - R * DT,
    "diff(h(x), x)": call("h", (x,), (1,)),
    "diff(h(x), x, 2)": call("h", (x,), (2,)),
    "diff(h(t), t)": call("h", (TIME,), (1,)),
    "h''(x + y)": call("h", (x + y,), (2,)),
    "diff(w(x, R), x, R, 2)": call("w", (x, R), (1, 2)),
    "partial(w(x, t), t)": call("w", (x, TIME), (0, 1)),
    "diff(w(x, t), x)": call("w", (x, TIME), (1, 0)),
    "partial(w(x, x), 1, 2, 2)": call("w", (x, x), (1, 2)),
    "partial(w(x*y, y), 1)": call("w", (x * y, y), (1, 0)),
    "pi*E": PI * E,
}


def unordered(e: Expr) -> Any:
    """``e`` with the order of terms and factors taken out."""
    parts = tuple(unordered(child) for child in children(e))
    if e.op in ("add", "mul"):
        return (e.op, *sorted(parts, key=repr))
    kept = e.args if not parts else e.args[:1] if e.op == "fn" else e.args[:2] if e.op == "call" else ()
    return (e.op, kept, *parts)


@pytest.mark.parametrize("text", PRINTED)
def test_printing(text: str) -> None:
    assert to_text(PRINTED[text]) == text


@pytest.mark.parametrize("text", PRINTED)
def test_printed_text_is_read_back(text: str) -> None:
    back = parse_expression(text, NAMES)
    assert unordered(back) == unordered(PRINTED[text])


def test_fractions_stand_with_their_factors() -> None:
    assert to_text(num(Fraction(-1, 2))) == "-1/2"
    assert to_text(num(Fraction(1, 3)) + x) == "1/3 + x"


@pytest.mark.parametrize("value", [10**30, 15 * 10**63, 7**99, 7**99 * 10**40, -(10**120) + 1])
def test_long_numbers_are_read_back(value: int) -> None:
    for number in (num(value), num(Fraction(1, value)), num(Fraction(value, 3))):
        assert parse_expression(to_text(number * x), NAMES) == number * x


LEAVES = st.one_of(
    st.fractions(-9, 9, max_denominator=7).map(num),
    st.sampled_from([x, y, R, coordinate("theta_1"), TIME, DT, PI, E, velocity("x_A"), differential("theta_1")]),
    st.just(sym("acceleration", "x_A")),
)


def grow(below: st.SearchStrategy[Expr]) -> st.SearchStrategy[Expr]:
    single = [name for name, count in FUNCTIONS.items() if count == 1]
    return st.one_of(
        st.tuples(below, below).map(lambda p: p[0] + p[1]),
        st.tuples(below, below).map(lambda p: p[0] - p[1]),
        st.tuples(below, below).map(lambda p: p[0] * p[1]),
        st.tuples(below, below).filter(lambda p: not p[1].is_zero).map(lambda p: p[0] / p[1]),
        st.tuples(below, st.integers(1, 3)).map(lambda p: power(p[0], num(p[1]))),
        below.filter(lambda e: e.op != "num").map(lambda e: power(e, num(Fraction(1, 2)))),
        st.tuples(below, below).filter(lambda p: p[0].op != "num").map(lambda p: power(*p)),
        st.tuples(st.sampled_from(single), below).filter(lambda p: p[1].op != "num").map(lambda p: fn(*p)),
        st.tuples(below, below).filter(lambda p: not p[0].is_zero).map(lambda p: fn("atan2", *p)),
        st.tuples(below, st.integers(0, 3)).map(lambda p: call("h", (p[0],), (p[1],))),
        st.tuples(below, below, st.integers(0, 2), st.integers(0, 2)).map(lambda p: call("w", p[:2], p[2:])),
    )


@settings(max_examples=120, deadline=None)
@given(st.recursive(LEAVES, grow, max_leaves=10))
def test_what_is_printed_is_read_back(e: Expr) -> None:
    text = to_text(e)
    back = read(text)
    if isinstance(back, TextError):  # only what is beyond the bounds may be refused
        assert any(word in back.message for word in ("exponent", "powers", "large", "characters", "nested")), back
    elif unordered(fold_again(back)) != unordered(fold_again(e)):  # numbers may be multiplied out on the way
        assert is_zero(in_differentials(back) - in_differentials(e), frozenset())


def in_differentials(e: Expr) -> Expr:
    """A velocity written as dtheta/dt, which is read as one."""
    return substitute(e, {velocity(name): differential(name) / DT for name in ("theta_1", "x_A")})


def read(text: str) -> Expr | TextError:
    try:
        return parse_expression(text, NAMES)
    except TextError as error:
        return error


def fold_again(e: Expr) -> Expr:
    """``e`` built once more from its leaves: folding may find more the second time.

    A number in a power of a sum is taken out of it: 1/(2 x + 2 y) and 1/2 1/(x + y) are one.
    """
    parts = tuple(fold_again(child) for child in children(e))
    if e.op == "pow" and parts[0].op == "add" and parts[1].op == "num" and parts[1].args[0].denominator == 1:
        number, rest = content(parts[0])
        return mul(power(num(number), parts[1]), power(rest, parts[1]))
    return rebuild(e, parts) if parts else e


@settings(max_examples=500, deadline=None)
@given(st.text(alphabet="xyRt0123456789 +-*/^()|'dsin_.=<>θ²½{}\\,eE!\u0307", max_size=25))
def test_any_text_is_read_or_refused_with_a_column(text: str) -> None:
    found = read(text)
    if isinstance(found, Expr):
        assert to_text(found)
    else:
        assert found.hint
        assert found.column is not None
        assert 1 <= found.column <= len(text) + 1
