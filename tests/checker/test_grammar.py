"""Texts -> trees: what people write, what can be read in two ways, what is hostile; the engines' reading beside it."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest
from checker.values import of_engine, of_tree
from flint import arb

from dofkit.base.errors import TextError
from dofkit.checker.grammar import EULER, PI, KnownNames, parse, parse_relations
from dofkit.checker.point import evaluated
from dofkit.checker.trees import FUNCTIONS as HEADS
from dofkit.checker.trees import (
    ONE,
    ZERO,
    CheckError,
    Effort,
    Tree,
    add,
    call,
    derivative,
    number,
    power,
    symbol,
    times,
)
from dofkit.expressions.text import AmbiguousError, Names, parse_expression
from dofkit.expressions.tree import num, parameter

FUNCTIONS_OF_ONE = [name for name in HEADS if name not in ("atan2", "diff")]
COORDINATES = frozenset({"x", "y", "theta", "phi", "s", "x_A", "x1"})
PARAMETERS = ("R", "L", "m", "g", "l", "v", "omega")
FUNCTIONS = {"h": ("s",), "f": ("t",), "w": ("x", "t")}
NAMES = KnownNames(COORDINATES, {**{name: symbol(name) for name in PARAMETERS}, "a": number(Fraction(3, 2))}, FUNCTIONS)
x, y, theta, phi, s, t, R, L, m, g, ell, v = (
    symbol(name) for name in ("x", "y", "theta", "phi", "s", "t", "R", "L", "m", "g", "l", "v")
)
xdot, ydot, sdot, dt = (symbol(name) for name in ("xdot", "ydot", "sdot", "dt"))
dx, dy = times(xdot, dt), times(ydot, dt)
half, two, three = number(Fraction(1, 2)), number(2), number(3)


def over(tree: Tree) -> Tree:
    return power(tree, number(-1))


def squared(tree: Tree) -> Tree:
    return power(tree, two)


def h(argument: Tree, order: int = 0) -> Tree:
    return Tree("apply", (argument,), "h", (order,))


def w(*arguments: Tree) -> Tree:
    return Tree("apply", arguments, "w", (0, 0))


READ: dict[str, Tree] = {
    # numbers
    "0.5": half,
    "1e-6": number(Fraction(1, 10**6)),
    ".5x": times(half, x),
    "2^-1": half,
    "2^3^2": number(512),
    "a": number(Fraction(3, 2)),
    "E": EULER,
    "E^x": call("exp", x),
    "exp(0)": ONE,
    "π": PI,
    # products
    "2 x y": times(two, x, y),
    "m g l": times(m, g, ell),
    "2pi R": times(two, PI, R),
    "x(y+1)": times(x, add(y, ONE)),
    "x·y×R": times(x, y, R),
    "x**2": squared(x),
    "x²": squared(x),
    "-x^2": -squared(x),
    "−x": -x,
    "x - -y": add(x, y),
    "x^y^R": power(x, power(y, R)),
    # a space decides how a quotient reads
    "1/2 m v^2": times(half, m, squared(v)),
    "g/l sin(theta)": times(g, over(ell), call("sin", theta)),
    "R/2 (x + y)": times(half, R, add(x, y)),
    "y^2/2 dx": times(half, squared(y), dx),
    "x/(2 y) R": times(x, over(times(two, y)), R),
    "x/y/R": times(x, over(y), over(R)),
    "(1/2)x": times(half, x),
    "1/2*x": times(half, x),
    # names
    "θ": theta,
    "ϑ + φ": add(theta, phi),
    "x_A": symbol("x_A"),
    # functions
    "R sin(theta) dphi": times(R, call("sin", theta), symbol("phidot"), dt),
    "sin^2(x)": squared(call("sin", x)),
    "sin²(x)": squared(call("sin", x)),
    "R cos θ dφ": times(R, call("cos", theta), symbol("phidot"), dt),
    "sin² x cos y": times(squared(call("sin", x)), call("cos", y)),
    "sin x (y + R)": times(call("sin", x), add(y, R)),
    "atan2(y, x)": call("atan2", y, x),
    "log(x) + asin(y)": add(call("log", x), call("asin", y)),
    "sqrt(x^2 + y^2)": call("sqrt", add(squared(x), squared(y))),
    # motions
    "dx": dx,
    "dt": dt,
    "xdot": xdot,
    "x_dot": xdot,
    "x'": xdot,
    "ẋ": xdot,
    "x\u0307": xdot,
    "xdot_A": symbol("x_Adot"),
    "dx_A": times(symbol("x_Adot"), dt),
    "θ̇": symbol("thetadot"),
    "dx/dt": times(dx, over(dt)),
    "-dx/dt y": times(number(-1), dx, over(dt), y),
    "(x dy + y dx)/dt": times(add(times(x, dy), times(y, dx)), over(dt)),
    "dy/dx": times(dy, over(dx)),
    # declared functions
    "h(x - f(t))": h(add(x, -Tree("apply", (t,), "f", (0,)))),
    "h'(s)": h(s, 1),
    "diff(h(s), s)": h(s, 1),
    "diff(w(x, y), y)": Tree("apply", (x, y), "w", (0, 1)),
    "h''(x)": h(x, 2),
    "h'(2x)": h(times(two, x), 1),
    "w(x, y)": w(x, y),
}


@pytest.mark.parametrize("text", READ)
def test_a_text_is_read(text: str) -> None:
    found = parse(text, NAMES)
    if found != READ[text]:  # sums and products within one another may be grouped in another way
        assert flat(found) == flat(READ[text])


def flat(tree: Tree) -> Tree:
    """A tree with sums in sums and products in products taken apart, and their parts in one order."""
    below = tuple(map(flat, tree.below))
    if tree.head not in ("sum", "product"):
        return Tree(tree.head, below, tree.value, tree.orders)
    parts = [part for one in below for part in (one.below if one.head == tree.head else (one,))]
    built = (add if tree.head == "sum" else times)(*parts)
    return Tree(built.head, tuple(sorted(built.below, key=repr)), built.value, built.orders)


DOUBTFUL = (
    *("1/2m", "g/2l", "1/2x", "1/2(x)", "x/y(x + y)", "1/xy", "1/2sin(x)", "x(y)", "x(2)", "L(t)", "h s", "h^2(s)"),
    *(
        "h²(s)",
        "sin theta/2",
        "sin x(y + R)",
        "sin x h(s)",
        "sin x (t)",
        "sin x 2",
        "sin x y",
        "sin x^2",
        "sin^-1(x)",
        "sin^²(x)",
        "sin^x(y)",
        "sin⁻¹ x",
        "x 2",
        "2 3",
        "1½",
        "x²^2",
        "2 ½",
    ),
    *("dx/dt2", "sin ½ x1 y", "exp 2 h(s)"),
)
MISTAKEN = (
    *("", "  ", "q", "thetta", "e^x", "sin", "sin()", "sin(x, y)", "atan2(y)", "w(x)", "w'(x, t)", "L'", "t'", "x'''"),
    *("x +", "* x", "(x", "x)", "(x]", "|x", "x = y; s", "x\ny", "x # y", "x ≠ y", "x != y", "x => y", "1_000"),
    *("0x10", "nan", "х", "30°", "x ± y", "1/0", "0^0", "0^-1", "(-1)^(1/2)", "x.y", "f'(t)(", "diff(x)", "diff(x, 2)"),
    *(
        "lambda: x",
        "__import__('os')",
        "x.__class__",
        "\\frac{x}{y}",
        "partial(x, 1)",
        "diff(x, 1.5)",
        "diff(x, 2, y)",
        "diff(x, x, 99)",
        "x // y",
        "x*** y",
        "h(s",
        "d(x)",
    ),
)
#: What need not be read, as plain notation stands for it: letters written together, braces, functions without their
#: arguments, other signs, names of other forms, derivatives by time.
FOREIGN = (
    *("$x$", "δx", "δ x", r"\mathbf{x}", "\theta", "x = 1, y = 2", "x = const", "x (t)"),
    *("xy", "mgl", "vt", "2piR", "[x]", "x^{2}", "h", "w", "h y"),
    *("½ x", "x⁻¹", "x₁", "x_1", "|x|", "√x", "x_{1}", "x(t)", "x^2(t)", "x'(t)", "xddot", "x''", "ẍ", "d^2x/dt^2"),
    *("dh", "dh/dt", "hdot", "diff(x^2, t)", "sin 2 x", "sin2x", "log sin x", "sqrt3"),
)
HOSTILE = (
    *("9**9**9", "2**2**40", "64^64^64", "x^65", "x^(1/65)", "(((x+1)^9)^64)^64", "(((2^64)^64)^64)", "1e999999999"),
    *("(" * 10**5, "(" * 100 + "x" + ")" * 100, "sin(" * 500, "9" * 10**6, "a" * 10**6, "ab" * 900, "|" * 1000),
    *(
        "x^" * 400 + "x",
        "x+" * 10**5 + "x",
        "diff(" * 100,
        "diff(" + "x*y*(x+1)*" * 150 + "y, x)",
        "x'''",
        "1e64*" * 999,
    ),
)


@pytest.mark.parametrize("text", [*DOUBTFUL, *MISTAKEN, *FOREIGN, *HOSTILE], ids=lambda text: ascii(text)[:30])
def test_what_cannot_be_read_in_one_way_is_an_error(text: str) -> None:
    with pytest.raises(CheckError):
        parse_relations(text, NAMES)


#: Quotients and what follows them, at x = 2, y = 3, R = 5, L = 7, m = 11, g = 13: None where the text asks which is
#: meant. A space before what follows makes it a factor of the whole quotient, read from the left.
QUOTIENTS: dict[str, Fraction | None] = {
    "1/2 m x^2": Fraction(22),  # (1/2) 11 4
    "m/2 x": Fraction(11),  # (11/2) 2
    "1/2 m x/R": Fraction(11, 5),  # ((1/2) 11 2)/5
    "g/L (x + y)": Fraction(65, 7),  # (13/7) 5
    "g/L abs(x)": Fraction(26, 7),  # (13/7) 2
    "x/y R/L": Fraction(10, 21),  # ((2/3) 5)/7
    "x/y R^2": Fraction(50, 3),  # (2/3) 25
    "-x/y R": Fraction(-10, 3),  # -((2/3) 5)
    "y^2/2 x R": Fraction(45),  # (9/2) 2 5
    "1/x^2 y": Fraction(3, 4),  # (1/4) 3
    "1/2 x(y + 1)": Fraction(4),  # (1/2) 2 4
    "x/(2 y) R": Fraction(5, 3),  # (2/6) 5
    "x/(2y) R": Fraction(5, 3),
    "1 / 2 x": Fraction(1),
    "1/2*x y": Fraction(3),  # (1/2) 2 3
    "x/2 + 1/2 y": Fraction(5, 2),  # 1 + 3/2
    "1/2m": None,
    "g/2L": None,
    "1/2x": None,
    "1/ 2x": None,
    "x/y(R + L)": None,
    "x/(2y)R": None,
    "g/L(x + y)": None,
    "m/2x^2": None,
    "1/2 x/y(R + L)": None,
    "1/2sin(x)": None,
}


@pytest.mark.parametrize("text", QUOTIENTS)
def test_a_space_decides_how_a_quotient_reads_in_both_grammars(text: str) -> None:
    expected = QUOTIENTS[text]
    if expected is None:
        with pytest.raises(CheckError, match="unclear"):
            parse(text, NAMES)
        with pytest.raises(AmbiguousError) as caught:
            parse_expression(text, ENGINES)
        assert len(caught.value.readings) == 2
        assert all(f"`{reading}`" in str(caught.value.hint) for reading in caught.value.readings)
        return
    values = {"x": 2.0, "y": 3.0, "R": 5.0, "L": 7.0, "m": 11.0, "g": 13.0}
    kinds = {name: "coordinate" if name in "xy" else "parameter" for name in values}
    theirs = {(kinds[name], name): value for name, value in values.items()}
    assert of_tree(parse(text, NAMES), values) == pytest.approx(float(expected))
    assert of_engine(parse_expression(text, ENGINES), theirs) == pytest.approx(float(expected))


def test_a_declared_e_makes_powers_of_ten_doubtful() -> None:
    with pytest.raises(CheckError, match="power of ten"):
        parse("2e-3", KnownNames(values={"e": symbol("e")}))


RELATIONS = {
    "x^2 = R": [("x^2 - R", "=")],
    "x": [("x", "=")],
    "x == y": [("x - y", "=")],
    "0 <= x < L": [("x - 0", ">="), ("L - x", ">")],
    "x = y = s": [("x - y", "="), ("y - s", "=")],
    "xdot ≥ 0": [("xdot", ">=")],
    "x > y": [("x - y", ">")],
}


@pytest.mark.parametrize("text", RELATIONS)
def test_relations(text: str) -> None:
    found = [(flat(one.tree), one.sign) for one in parse_relations(text, NAMES)]
    assert found == [(flat(parse(tree, NAMES)), sign) for tree, sign in RELATIONS[text]]


def test_a_value_is_no_relation() -> None:
    with pytest.raises(CheckError):
        parse("x = y", NAMES)


ENGINES = Names(
    COORDINATES,
    {**{name: parameter(name) for name in PARAMETERS}, "a": num(Fraction(3, 2))},
    {name: len(given) for name, given in FUNCTIONS.items()},
    FUNCTIONS,
    allow_accelerations=True,
)
PIECES = (
    *("x", "y", "theta", "R", "m", "x y", "2", "1/2", "3", "(x+y)", "sin", "cos", "sin(x)", "h", "h(s)", "h'", "f"),
    *("f(t)", "w(x,t)", "dx", "dy", "dt", "xdot", "ẋ", "x'", "θ", "²", "^2", "^", "+", "-", "*", "/", "/2", "/dt"),
    *("dx/dt", " ", "(", ")", "t", "x(t)", "pi", "E", "|", "|x|", "½", "x1", "x_1", "x₁", "exp", "^(1/2)", "^-1"),
    *("a", "m g l", "sin^2", "dθ", "df/dt", "dh", "hdot", "diff(h(s),s)", "diff(x^2,t)", "1e-3", "2e", "e3", ".5"),
    *("d", "dot", "_A", "=", "<="),
)
SYMBOLS = {"velocity": "{}dot", "differential": "d{}", "acceleration": "{}ddot", "dt": "d{}"}


@pytest.mark.parametrize("seed", range(20))
def test_what_both_readings_take_they_take_alike(seed: int) -> None:
    rng = random.Random(seed)
    met = 0
    for _ in range(400):
        text = "".join(rng.choice(PIECES) + rng.choice(("", " ", " ")) for _ in range(rng.randint(1, 6)))
        try:
            theirs, ours = parse_expression(text, ENGINES), parse(text, NAMES)
        except (TextError, CheckError):
            continue
        values = {symbol.args: rng.uniform(0.3, 0.9) for symbol in sorted(theirs.symbols, key=lambda s: s.args)}
        for name in [name for kind, name in values if kind == "differential"]:
            rate = values.setdefault(("velocity", name), 0.4)
            values["differential", name] = rate * values.setdefault(("dt", "t"), 0.6)
        named = {SYMBOLS.get(kind, "{}").format(name): value for (kind, name), value in values.items()}
        expected = of_engine(theirs, values)
        assert of_tree(ours, {**dict.fromkeys(ours.symbols, 0.5), **named}) == pytest.approx(expected), text
        met += 1
    assert met > 40


def test_what_the_engines_print_is_read_back() -> None:
    for text in ("h''(x + y)", "1/sqrt(x)", "-3*x*y/2", "R*x/(2*y)", "x^(2/3)"):
        values = {"x": 0.7, "y": 0.4, "R": 1.3, "t": 0.2}
        theirs = {(kind, name): values[name] for kind in ("coordinate", "parameter", "time") for name in values}
        assert of_tree(parse(text, NAMES), values) == pytest.approx(of_engine(parse_expression(text, ENGINES), theirs))


def test_the_number_zero_is_read() -> None:
    assert parse("0", NAMES) == ZERO
    assert parse("3 - 3", NAMES) == ZERO
    assert parse("3", NAMES) == three


@pytest.mark.parametrize("name", [*FUNCTIONS_OF_ONE, "x^3", "2^x", "x^x", "atan2(x, 2)", "h(x^2)", "w(x, x)"])
def test_derivatives_are_slopes(name: str) -> None:
    tree = parse(name if "x" in name.removeprefix("exp") else f"{name}(x)", NAMES)
    step, at = 1e-6, 0.6
    slope = (of_tree(tree, {"x": at + step}) - of_tree(tree, {"x": at - step})) / (2 * step)
    assert of_tree(derivative(tree, "x"), {"x": at}) == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("text", ["0*log(-1 - x^2)", "0*sqrt(-1 - x^2)", "0/x", "log(-1 - x^2)^0", "x/x", "1/x - 1/x"])
def test_what_is_cancelled_keeps_its_domain(text: str) -> None:
    """None of these has a value at x = 0."""
    with pytest.raises(CheckError):
        evaluated(parse(text, KnownNames(frozenset("x"))), {"x": arb(0)}, Effort())
