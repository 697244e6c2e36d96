"""The engines on cases computed by hand, and against SymPy: zero tests, ranks, points, series, forms, branches."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

import pytest
import sympy
import yaml
from flint import arb_poly, ctx
from shared.known_scenes import swept

import dofkit
from dofkit.base.errors import NoValueError, TextError
from dofkit.exact.points.balls import PRECISION, BallPoint
from dofkit.exact.points.field import field_point
from dofkit.exact.points.frames import FormRows, field_frame
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.points.series import Series, SeriesPoint
from dofkit.exact.ring.canonical import Canon, is_identically_zero
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.triangular import TriangularSolver
from dofkit.exact.zero import is_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.text import Names, parse_expression, parse_relations
from dofkit.expressions.tree import Expr
from dofkit.integrability.growth_vector import spanning_curves
from dofkit.integrability.lie_algebra import lie_span
from dofkit.relations.normal.normal_form import normalise
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.normal.zero_set import never_vanishes, zero_set
from dofkit.report import Report

X, Y, Z = map(ex.coordinate, "xyz")
NAMES = Names(
    coordinates=frozenset("xyzuvw"),
    parameters={"a": ex.parameter("a"), "R": ex.parameter("R")},
    functions={"h": 1, "g": 2},
)
POSITIVE = frozenset({ex.parameter("R")})
P = 2**61 - 1


def read(text: str) -> Expr:
    return parse_expression(text, NAMES)


def classified(coordinates: str, *constraints: str) -> Report:
    return dofkit.classify(dofkit.load({"coordinates": coordinates.split(), "constraints": list(constraints)}))


# The ring


ZERO = [
    "sin(x)^2 + cos(x)^2 - 1",
    "sin(x + y) - sin(x) cos(y) - cos(x) sin(y)",
    "16 sin(x)^5 - sin(5 x) + 5 sin(3 x) - 10 sin(x)",
    "tan(x/2) - sin(x)/(1 + cos(x))",
    "cosh(x)^2 - sinh(x)^2 - 1",
    "exp(x + y) - exp(x) exp(y)",
    "exp(log(1 + x^2)) - 1 - x^2",
    "log(exp(x)) - x",
    "log(6) - log(2) - log(3)",
    "log((1 + x^2)^3) - 3 log(1 + x^2)",
    "sqrt(x^2) - abs(x)",
    "abs(x)^2 - x^2",
    "abs(x y) - abs(x) abs(y)",
    "sqrt(6) - sqrt(2) sqrt(3)",
    "8^(1/3) - 2",
    "1/(sqrt(3) - sqrt(2)) - sqrt(3) - sqrt(2)",
    "(1 + x^2)^(3/2) - (1 + x^2) sqrt(1 + x^2)",
    "asin(x) + acos(x) - pi/2",
    "sin(atan(x)) - x/sqrt(1 + x^2)",
    "cos(pi/5) - (1 + sqrt(5))/4",
    "cos(2 pi/7) + cos(4 pi/7) + cos(6 pi/7) + 1/2",
    "exp(-200 x) exp(200 x) - 1",
    "x^64 - 1 - (x^32 + 1) (x^16 + 1) (x^8 + 1) (x^4 + 1) (x^2 + 1) (x^2 - 1)",
    "(x + 1)^20 - (x + 1)^10 (x^2 + 2 x + 1)^5",
    "0.1 + 0.2 - 0.3",
    "exp(1/2)^2 - E",
]
#: Zero as well, by identities that may be missed: undecided is an answer, not zero is none.
HARD_ZERO = [
    "sqrt(5 + 2 sqrt(6)) - sqrt(2) - sqrt(3)",
    "sqrt(11 + 6 sqrt(2)) - 3 - sqrt(2)",
    "(2 + sqrt(5))^(1/3) - (1 + sqrt(5))/2",
    "sqrt(2 + sqrt(2))/2 - cos(pi/8)",
    "atan(1) - pi/4",
    "4 atan(1/5) - atan(1/239) - pi/4",
    "asin(sin(pi/7)) - pi/7",
    "atan(x) + atan(1/x) - pi x/(2 abs(x))",
    "cos(acos(x)) - x",
    "cos(3 acos(x)) - 4 x^3 + 3 x",
    "atan(sinh(x)) - 2 atan(tanh(x/2))",
    "log(x + sqrt(x^2 + 1)) + log(sqrt(x^2 + 1) - x)",
    "log(abs(x)) - log(x^2)/2",
    "abs(-x) - abs(x)",
    "sqrt(x^2 + 2 x + 1) - abs(x + 1)",
    "sqrt(x^4 + 2 x^2 y^2 + y^4) - x^2 - y^2",
]
#: Of these, whether an equation follows takes seconds, and is undecided.
SLOW = ("sqrt(x^2 + 2 x + 1) - abs(x + 1)",)
NOT_ZERO = [
    "1e-12 x",
    "x/1e9",
    "1e-30 x",
    "exp(-200 x)",
    "exp(-200 x) - exp(-201 x)",
    "sin(x) - x",
    "sin(x) - x + x^3/6",
    "cos(1e-9 x) - 1",
    "exp(x) - 1 - x - x^2/2",
    "cos(pi/5) - 0.809016994374947",
    "sqrt(2) - 1.41421356237310",
    "pi - 22/7",
    "exp(pi sqrt(163)) - 262537412640768744",
    "x^64 - x^63",
    "(1 + 1e-15) x - x",
    "sqrt(x^2 + 1e-20) - abs(x)",
    "tanh(x) - 1",
    "cos(pi/7) - cos(pi/9)",
    "sqrt(1 + x^2) - 1",
]
#: Zero on a part of the line only.
SOMEWHERE_ZERO = [
    "asin(sin(x)) - x",
    "acos(cos(x)) - x",
    "abs(x) - x",
    "abs(x) + x",
    "sqrt((x - 1)^2) - x + 1",
    "sqrt(1 - cos(x)^2) - sin(x)",
    "sqrt(1 - sin(x)^2) - cos(x)",
    "atan(x) + atan(1/x) - pi/2",
]


@pytest.mark.parametrize("text", ZERO)
def test_zero_is_seen(text: str) -> None:
    assert is_zero(read(text), frozenset())


@pytest.mark.parametrize("text", NOT_ZERO)
def test_what_is_not_zero_is_not_taken_for_zero(text: str) -> None:
    assert not is_zero(read(text), frozenset())
    assert is_identically_zero(read(text)) is not True


@pytest.mark.parametrize(
    ("text", "holonomic"),
    [*((text, True) for text in [*ZERO, *HARD_ZERO]), *((text, False) for text in NOT_ZERO)],
)
def test_a_label_that_hangs_on_a_zero_test_is_right_or_undecided(text: str, holonomic: bool) -> None:
    """dz + E y dx integrates where E is zero, and is a contact form where it is not."""
    report = classified("x y z", f"dz + ({text}) y dx = 0")
    label = report.constraints[0].holonomic
    assert label is holonomic or (label is None and text in HARD_ZERO)
    assert report.dof in (2 if holonomic else 3, None)


@pytest.mark.parametrize("text", SOMEWHERE_ZERO)
def test_what_integrates_on_one_side_only_is_not_holonomic(text: str) -> None:
    report = classified("x y z", f"dz + ({text}) y dx = 0")
    assert report.constraints[0].holonomic is not True
    assert report.dof in (3, None)


@pytest.mark.parametrize("text", [*ZERO, *(swept(text) if text in SLOW else text for text in HARD_ZERO)])
def test_an_equation_that_says_the_same_takes_nothing_away(text: str) -> None:
    report = classified("x y z", "z = 0", f"z + ({text}) = 0")
    assert report.consistent is not False
    assert report.dof in (2, None)
    if text in ZERO:
        assert (report.dof, report.redundant) == (2, ["c2"])


@pytest.mark.parametrize("text", [text for text in NOT_ZERO if "x" not in text.replace("exp", "")])
def test_numbers_that_differ_contradict_each_other(text: str) -> None:
    report = classified("z", "z = 0", f"z + ({text}) = 0")
    assert report.consistent is not True
    assert report.dof is None


@pytest.mark.parametrize("text", ["abs(x)", "sqrt(x^2)", "sqrt((x + y)^2 (1 + x^2)^2)"])
def test_signs_of_both_sides_are_not_mixed_up(text: str) -> None:
    """abs(u) - u and abs(u) + u vanish on one side each: neither is zero."""
    for sign in "+-":
        inner = {"abs(x)": "x", "sqrt(x^2)": "x"}.get(text, "(x + y) (1 + x^2)")
        assert not is_zero(read(f"{text} {sign} {inner}"), frozenset()), sign


# Fields and balls


def test_balls_hold_true_values() -> None:
    f = read("exp(-200 x) + atan2(y, x) + sqrt(2)")
    ring = Ring([f])
    node = ring.node(f)
    at = values(ring, BallPoint({X: Fraction(1, 2).__float__(), Y: 0.25}, 0))
    assert abs(float(at[node].mid()) - (math.exp(-100) + math.atan2(0.25, 0.5) + math.sqrt(2))) < 1e-14
    small = values(ring, BallPoint({X: 0.5, Y: 0.25}, 0))[ring.node(read("exp(-200 x)"))]
    assert not small.contains(0)


# Points on a variety


@pytest.mark.parametrize(
    "texts",
    [
        ["x^2 + y^2 - 1"],
        ["x y z - 1", "x + y"],
        ["cos(x) + sin(y) z", "z^2 - u"],
        ["x^2 + y^2 + z^2 - 1", "x + 2 y"],
        ["sqrt(x^2 + y) - z"],
        ["sin(x + y) - sin(x - y)"],
        ["x - exp(y)", "z - log(x)"],
        ["(x - u)^2 + (y - v)^2 - 4", "u^2 + v^2 - 1"],
        ["y - x tan(z)"],
        ["z - h(x)", "u - g(x, z)"],
    ],
)
def test_drawn_points_satisfy_the_relations(texts: Sequence[str]) -> None:
    relations = [read(text) for text in texts]
    ring = Ring(relations)
    nodes = [ring.node(g) for g in relations]
    point = TriangularSolver(ring, nodes).draw(1)
    assert point is not None
    at = values(ring, point)
    assert [at[n] == 0 for n in nodes] == [True] * len(nodes)
    other = TriangularSolver(ring, nodes).draw(2)
    assert other is not None
    assert [int(v) for v in values(ring, other)] != [int(v) for v in at]


def test_a_real_point_is_certified() -> None:
    relations = [read("x^2 + y^2 + z^2 - 1"), read("x - y")]
    ring = Ring(relations)
    nodes = [ring.node(g) for g in relations]
    found = RealSearch(ring, nodes, [X, Y, Z], frozenset()).search(1)
    assert found is not None
    assert (found.part.rows, found.certified, found.consistent) == ([0, 1], True, True)
    with ctx.workprec(PRECISION):
        at = values(ring, found.point)
    assert all(at[n].contains(0) for n in nodes)
    assert ctx.prec < PRECISION
    assert max(float(at[n].rad()) for n in nodes) < 1e-30


# Series


@pytest.mark.parametrize(
    "text",
    ["exp(x)", "sin(x)", "cos(2 x)", "log(1 + x)", "sqrt(1 + x)", "(1 + x)^(1/3)", "atan(x)", "asin(x)",
     "1/(1 - x + x^2)", "tan(x)", "exp(sin(x))", "sinh(x)/(2 + x)", "atan2(x, 1 + x)", "sqrt(4 + x^2) cos(x)",
     "x^5 + 3 x - 7", "(1 + x)^(-5/2)"],
)  # fmt: skip
def test_series_are_those_of_sympy(text: str) -> None:
    """Along the path x = s + s^2."""
    order = 7
    f = read(text)
    ring = Ring([f])
    node = ring.node(f)
    base = BallPoint({X: 0.0}, 0)
    values(ring, base)
    like = arb_poly([])
    path = {ring.var_index(X) or 0: Series(arb_poly([0, 1, 1]), order)}
    found = values(ring, SeriesPoint(base, path, order, like))[node]
    x = sympy.Symbol("x")
    whole = sympy.sympify(text.replace("^", "**").replace("2 x", "2*x").replace("3 x", "3*x").replace(") cos", ")*cos"))
    true = sympy.Poly(sympy.series(whole.subs(x, x + x**2), x, 0, order).removeO(), x)
    for k in range(order):
        value = found.coefficient(k)
        assert abs(float(value.mid()) - float(true.coeff_monomial(x**k))) < 1e-12, k


# Forms


def span_of(
    columns: Sequence[Expr], forms: Sequence[Sequence[str]], seed: int = 1
) -> tuple[tuple[int, ...] | None, int]:
    """(growth vector, dimension of the Lie algebra) of the kernel of some forms."""
    coefficients = [[read(text) for text in form] for form in forms]
    ring = Ring([e for form in coefficients for e in form])
    entries = tuple({c: ring.node(e) for c, e in enumerate(form) if not e.is_zero} for form in coefficients)
    rows = FormRows(ring, entries, tuple(-1 if (i := ring.var_index(s)) is None else i for s in columns))
    point = field_point([ring], seed)
    at = values(ring, point)
    matrix = rows.matrix(at, point.number(Fraction(0)))
    frame = field_frame(matrix, len(columns), point.p)
    span = lie_span(rows, frame, point)
    return span.growth or spanning_curves(rows, frame, point, span)[1], span.dimension


@pytest.mark.parametrize(
    ("forms", "flag", "closure"),
    [
        ([["y", "x", "0"]], (2,), 2),  # d(x y)
        ([["-y", "x", "0"]], (2,), 2),  # x dy - y dx = x^2 d(y/x)
        ([["-y", "0", "1"]], (2, 3), 3),  # dz - y dx, contact
        ([["z", "z", "x + y"]], (2,), 2),  # d(z (x + y))
        ([["-y", "x", "1"]], (2, 3), 3),  # dz + x dy - y dx
        ([["y z", "2 x z", "3 x y"]], (2,), 2),  # d(x y^2 z^3)/(y z^2)
        ([["x", "y", "z"], ["y", "-x", "0"]], (1,), 1),
        ([["y", "z", "x"]], (2, 3), 3),  # omega.curl = (y, z, x).(-1, -1, -1) is not 0
        ([["exp(x)", "0", "exp(y) exp(x)"]], (2, 3), 3),  # dx + e^y dz
        ([["x", "y", "0"], ["0", "0", "1"]], (1,), 1),
    ],
)
def test_frobenius_on_textbook_forms(forms: list[list[str]], flag: tuple[int, ...], closure: int) -> None:
    assert span_of((X, Y, Z), forms) == (flag, closure)


def test_growth_of_the_disc_the_car_and_engel() -> None:
    u, v, w = map(ex.coordinate, "uvw")
    disc = [["1", "0", "0", "R sin(z)"], ["0", "1", "0", "-R cos(z)"]]
    assert span_of((X, Y, Z, u), disc) == ((2, 3, 4), 4)
    car = [["-sin(z)", "cos(z)", "0", "0"], ["-sin(z + u)", "cos(z + u)", "cos(u)", "0"]]
    assert span_of((X, Y, Z, u), car) == ((2, 3, 4), 4)
    engel = [["-u", "0", "1", "0"], ["-y", "1", "0", "0"]]
    assert span_of((X, Z, Y, u), [["-y", "1", "0", "0"], ["-u", "0", "1", "0"]]) == ((2, 3, 4), 4)
    assert span_of((X, Y, Z, u), engel)[1] <= 4
    cartan = [["-y", "0", "1", "0", "0"], ["-z", "0", "0", "1", "0"], ["0", "-z", "0", "0", "1"]]
    assert span_of((X, Y, Z, v, w), cartan) == ((2, 3, 5), 5)


# Real zeros


def same(one: Expr, other: Expr) -> bool:
    """Equal up to the sign."""
    return is_identically_zero(one - other) is True or is_identically_zero(one + other) is True


def same_branch(one: Sequence[Expr], other: Sequence[Expr]) -> bool:
    return len(one) == len(other) and all(any(same(g, f) for f in other) for g in one)


#: What is worked out by hand.
SIGNS = yaml.safe_load(Path(__file__).with_name("signs.yaml").read_text(encoding="utf-8"))


@pytest.mark.parametrize(("text", "expected"), SIGNS["zeros"])
def test_the_real_zero_set(text: str, expected: list[list[str]]) -> None:
    e = read(text)
    branches, _ = zero_set(e, POSITIVE, frozenset(s for s in e.symbols if s.args[0] != "parameter"))
    wanted = [[read(g) for g in branch] for branch in expected]
    assert len(branches) == len(wanted)
    assert all(any(same_branch(branch, other) for other in wanted) for branch in branches)
    assert all(any(same_branch(branch, other) for other in branches) for branch in wanted)


@pytest.mark.parametrize(("text", "never"), SIGNS["never zero"])
def test_what_never_vanishes(text: str, never: bool) -> None:
    assert never_vanishes(read(text), POSITIVE) is never


@pytest.mark.parametrize(("text", "strict", "never"), SIGNS["never holds"])
def test_what_never_holds(text: str, strict: bool, never: bool) -> None:
    assert never_holds(read(text), strict, POSITIVE) is never


@pytest.mark.parametrize("text", ["xddot = 1", "dx + y = 0", "sin(dx) = 0", "dx + dy dz = 0"])
def test_what_is_no_constraint(text: str) -> None:
    names = Names(coordinates=frozenset("xyz"), allow_accelerations=True)
    (relation,) = parse_relations(text, names)
    with pytest.raises(TextError):
        normalise(relation.left - relation.right, frozenset(), True)


def test_a_ring_refuses_parts_of_an_angle_that_it_was_not_made_for() -> None:
    """cos(x/2) is no polynomial in cos(x) and sin(x); a ring for both counts x in halves."""
    half = ex.fn("cos", ex.HALF * X)
    ring = Ring([ex.fn("cos", X)])
    with pytest.raises(NoValueError):
        ring.node(half)
    both = ring.another([half])
    double = ex.TWO * half**2 - 1
    difference = both.node(ex.fn("cos", X) - double)
    assert Canon(both).quotient(difference)[0] == 0


@pytest.mark.parametrize(
    ("names", "constraints", "place"),
    [
        ("x y", ["x^2 + y^2 = 1", "(x - 3)^2 + y^2 = 4"], {"x": 1, "y": 0}),
        ("x y", ["(x - 1)^2 + (y - 2)^2 = 4", "(x - 4)^2 + (y - 6)^2 = 9"], {"x": 11 / 5, "y": 18 / 5}),
        ("x y", ["y = sin(x)", "y = 1"], {"y": 1}),
        ("x y", ["x y = 1", "x + y = 2"], {"x": 1, "y": 1}),
    ],
)
def test_where_two_curves_touch(names: str, constraints: list[str], place: dict[str, float]) -> None:
    """The centres are as far apart as the sum of the radii: 3 = 1 + 2, and 5 = 2 + 3; a sine is at most 1."""
    report = dofkit.classify({"coordinates": names.split(), "constraints": constraints})
    assert (report.dof, report.verdicts["dof"].verdict) == (0, "proved")
    assert report.witness is not None
    assert all(abs(float(Fraction(report.witness[name])) - value) < 1e-9 for name, value in place.items())
