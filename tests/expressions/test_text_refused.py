"""What is refused: hostile, doubtful and mistaken input, each with its column and quickly."""

from __future__ import annotations

import pickle
from typing import Any

import pytest
from shared.work import counted

from dofkit.base.errors import TextError
from dofkit.expressions.text import Names, UnknownNameError, parse_expression, parse_relations, why_invalid
from dofkit.expressions.tree import num, parameter

NAMES = Names(
    frozenset({"x", "y", "z", "theta", "s", "x_A"}),
    {name: parameter(name) for name in ("L", "omega", "a", "b")} | {"two": num(2)},
    {"h": 1, "u": 1, "w": 2},
    {"h": ("s",), "u": ("q",)},
)

CODE = [
    "__import__('os').system('touch c')",
    "open('c','w').write('x')",
    "exec(x)",
    "eval(x)",
    "x.__class__.__mod__.__globals__['__builtins__']['open']('c')",
    'f"{open(1)}"',
    "(lambda: open(1))()",
    "().__class__.__base__.__subclasses__()",
    "'{0.__class__}'.format(x)",
    "getattr(x,'name')",
    "lambdify(x,x)",
    "x.subs(x, y)",
    "S(x)",
    "[x for x in y]",
    "x := y",
    "lambda x: x",
    "x['a']",
    "@x",
    "\\write18{ls}",
    "x\0y",
    "\ud800",
    "x\u200by",
    "\u202ex",
]
EXHAUSTING = [
    "9**9**9",
    "2**2**40",
    "10**10**8",
    "64^64^64",
    "1e999999999",
    "1e-999999999",
    "1e65",
    "factorial(10**6)",
    "((((9!)!)!)!)",
    "binomial(10**9,5*10**8)",
    "(x+y+z)**400",
    "x^65",
    "x^-65",
    "x^(1/65)",
    "((x+1)^9)^9",
    "(((2^64)^64)^64)",
    "((2^64 x)^64 + 1)^2",
    "x*" * 700 + "x",
    "1e64*" * 300 + "1",
    "(" * 10**5,
    "(" * 1500,
    "(" * 61 + "x" + ")" * 61,
    "sin(" * 500,
    "sin " * 400 + "x",
    "-" * 10**5,
    "-" * 1900 + "x",
    "-" * 61 + "x",
    "x+" * 10**4 + "x",
    "x+" * 900 + "x",
    "9" * 10**6,
    "9" * 1900,
    "9" * 31,
    "0." + "9" * 10**5,
    "0." + "9" * 1900,
    "a" * 10**6,
    "ab" * 900,
    "q" * 64,
    "9^{9^{9}}",
    "{" * 500,
    "|" * 1000,
    "√" * 1000,
    "h(" * 300,
    "diff(" * 100,
    "x^" * 400 + "x",
    "diff(" + "x*y*(x+1)*" * 150 + "z, x)",
    "diff(diff(x^9, x, 6), x, 7)",
    "\\frac{" * 200,
    "\\dot" * 300,
    "'" * 1900,
    "." * 1900,
]

#: text -> (column, a part of the message, a part of the hint)
DOUBTFUL: dict[str, tuple[int, str, str]] = {
    "1/2x": (4, "`1/2x`", "`(1/2)*x` or `1/(2*x)`"),
    "1/2x y": (4, "two ways", "`(1/2)*x` or `1/(2*x)`"),
    "x/2y": (4, "two ways", "`(x/2)*y` or `x/(2*y)`"),
    "L/2a": (4, "`L/2a`", "`(L/2)*a` or `L/(2*a)`"),
    "1/ 2x": (5, "two ways", "`(1/2)*x` or `1/(2*x)`"),
    "1/(2a)x": (7, "two ways", "`(1/(2a))*x` or `1/((2a)*x)`"),
    "x^2/a^2y": (8, "two ways", "`(x^2/a^2)*y` or `x^2/(a^2*y)`"),
    "1/2sin(x)": (4, "two ways", "`(1/2)*sin(x)` or `1/(2*sin(x))`"),
    "a/b c": (5, "`c`", "declared"),
    "a/b(x+y)": (4, "two ways", "`(a/b)*(x+y)`"),
    "2 30°": (3, "side by side", "sign"),
    "sin^-1(x)": (4, "inverse", "`asin(...)` or `1/sin(...)`"),
    "sin⁻¹ x": (4, "inverse", "`asin(...)` or `1/sin(...)`"),
    "sin theta/2": (10, "`sin`", "`sin(theta/2)` or `sin(theta)/2`"),
    "sin omega t": (11, "`sin`", "`sin(omega*t)` or `sin(omega)*t`"),
    "sin x*y": (6, "`sin`", "`sin(x*y)` or `sin(x)*y`"),
    "√2x": (3, "√", "sqrt(2"),
    "xa/ab": (5, "two ways", "`(xa/a)*b`"),
    "x 2": (3, "right after `x`", "`x*2` or `x^2`"),
    "(x+y)2": (6, "right after", "^2"),
    "2 3": (3, "side by side", "sign"),
    "1½": (2, "side by side", "sign"),
    "x(2)": (1, "product or a value", "`x*2`"),
    "x(y)": (1, "product or a function", "`x*y`"),
    "L(t)": (1, "constant", "`L*t`"),
    "two(t)": (1, "constant", "functions"),
    "h^2(s)": (2, "power", "h(...)^2"),
    "h s": (1, "product", "`h(s)`"),
    "w'(x, y)": (2, "2 arguments", "diff"),
    "sin(x": (4, "never closed", "`)`"),
    "log10 x": (1, "`log10`", "log"),
}

MISTAKEN: dict[str, tuple[int, str, str]] = {
    "": (1, "empty", ""),
    "   ": (1, "empty", ""),
    "x + thetta": (5, "`thetta` is not declared", "`theta`"),
    "x + xa_A": (5, "`xa_A`", "`x_A`"),
    "xA": (1, "`xA`", "`x_A`"),
    "Theta": (1, "`Theta`", "`theta`"),
    "2 + sine(x)": (5, "no function `sine`", "`sin`"),
    "foo(x)": (1, "no function `foo`", "sin, cos"),
    "dthet": (1, "`dthet`", "`dtheta`"),
    "e^x": (1, "`e`", "`E`"),
    "d(x)": (1, "`d`", "`dx`"),
    "w(x)": (1, "2 arguments, not 1", ""),
    "sin(x, y)": (1, "one argument, not 2", ""),
    "atan2(y)": (1, "2 arguments, not 1", ""),
    "w": (1, "`w` needs its argument", "w("),
    "u": (1, "`q` is not declared", "`u(...)`"),
    "x + 1/0": (7, "zero", "denominator"),
    "x/0": (3, "zero", "denominator"),
    "1/(x-x)": (3, "zero", "denominator"),
    "0^-1": (2, "zero", ""),
    "0^0": (2, "`0^0`", ""),
    "0^x": (2, "no real value", "positive base"),
    "(-2)^pi": (5, "no real value", "positive base"),
    "sqrt(-1)": (1, "a root of a negative number is not read", "an even root is not real"),
    "log(0)": (1, "no real value", ""),
    "asin(2)": (1, "no real value", ""),
    "x = y; z": (6, "one relation", ""),
    "x\n= y": (2, "one relation", ""),
    "x\r\ny": (2, "one relation", ""),
    "1_000": (1, "`_`", ""),
    "0x10": (1, "decimal", ""),
    "010": (1, "0", "`10`"),
    "nan": (1, "`nan`", ""),
    "oo - oo": (1, "`oo`", ""),
    "True": (1, "`True`", ""),
    "None": (1, "`None`", ""),
    "'abc'": (1, "quote", ""),
    "...": (1, "ellipsis", "dots"),
    "x and y": (3, "`and`", "its own text"),
    "x if y else z": (3, "`if`", ""),
    "x # y": (3, "comment", ""),
    "x ≠ y": (3, "≠", "<="),
    "x != y": (3, "!=", "<="),
    "x => y": (3, "`=>`", "`>=`"),
    "x < = y": (5, "missing before `=`", ""),
    "x =": (4, "missing after `=`", ""),
    "= x": (1, "missing before `=`", ""),
    "(x = y)": (4, "inside parentheses", ""),
    "x + * y": (5, "missing before `*`", ""),
    "x)": (2, "closes nothing", ""),
    "(x]": (3, "closed by", ""),
    "|x": (1, "never closed", ""),
    "()": (2, "missing before this `)`", ""),
    "sin": (4, "needs its argument", "sin(...)"),
    "1,5": (2, "comma", "point"),
    "x''": (1, "acceleration", ""),
    "x'''": (2, "second", ""),
    "L'": (2, "not a coordinate", ""),
    "t'": (2, "not a coordinate", ""),
    "хy": (1, "Cyrillic", "`x`"),
    "y + Α": (5, "Greek", "`A`"),
    "ｘ": (1, "Fullwidth", "`x`"),
    "x⃗": (2, "mark", ""),
    "x°": (2, "after a number", "pi/180"),
    "30°°": (4, "after a number", "pi/180"),
    "deg": (1, "after a number", "60°"),
    "x + 50 cm": (8, "without units", "write `50`"),
    "2 rad": (3, "without units", "write `2`"),
    "x ± y": (3, "±", ""),
    "∂h": (1, "∂", "diff"),
    "½x ≤ ∞": (6, "infinity", ""),
    "ẋ + ω₁ b": (5, "`ω_1`", "omega"),
    "x\u0307 + q": (6, "`q`", ""),
    r"\frac{1}{2} q": (13, "`q`", ""),
    r"\theta + \foo": (10, r"\foo", ""),
    r"\dot{xy}": (1, "single letter", "xdot"),
    r"\sqrt[3]{x}": (1, "index", "1/3"),
    "$x": (1, "$", "around the whole text"),
    "$x$ = $y$": (1, "$", "around the whole text"),
    "$$x$": (1, "$", "around the whole text"),
    "x + y = const": (9, "`const` is not declared", "`parameters: {C: real}`"),
    "x = 1, y = 2": (6, "two relations", "`x = 1` and `y = 2`"),
    "x = 1,5": (6, "comma", "decimals with a point"),
    r"\begin{aligned} x &= 1 \\ y &= 2 \end{aligned}": (1, "several equations", "each line its own text"),
    r"x = 1 \\ y = 2": (7, "several equations", "each line its own text"),
    "δL": (1, "`δL`", ""),
    "δ x_B": (1, "`δ`", ""),
    "x_{A,1}": (2, "subscript", ""),
}


def refusal(text: str, names: Names = NAMES) -> TextError:
    with pytest.raises(TextError) as caught:
        parse_relations(text, names)
    return caught.value


@pytest.mark.parametrize("text", CODE + EXHAUSTING, ids=lambda text: ascii(text)[:40])
def test_hostile_text_is_refused_with_little_work(text: str) -> None:
    """60 000 calls of functions are some 10 ms."""
    NAMES.lookup.meaning("x")
    error, calls = counted(lambda: refusal(text))
    assert error.column is not None
    assert 1 <= error.column <= len(text) + 1
    assert len(error.message) < 400
    assert calls < 60_000


@pytest.mark.parametrize("text", DOUBTFUL | MISTAKEN, ids=ascii)
def test_refusal_says_what_where_and_what_to_do(text: str) -> None:
    column, message, hint = (DOUBTFUL | MISTAKEN)[text]
    error = refusal(text)
    assert (error.column, message in error.message) == (column, True), error.message
    assert error.hint
    assert hint in error.hint


@pytest.mark.parametrize("value", [None, 3, 1.5, ["x"]])
def test_only_text_is_read(value: Any) -> None:
    assert "a text is needed" in refusal(value).message


def test_a_value_holds_no_relation() -> None:
    with pytest.raises(TextError, match="value is needed") as caught:
        parse_expression("L = 2", NAMES)
    assert caught.value.column == 3


def test_letters_together_need_one_reading() -> None:
    names = Names(frozenset(), {name: parameter(name) for name in ("a", "b", "ab", "ba")})
    error = refusal("2 + abab", names)
    assert (error.column, error.message) == (5, "`abab` can be read as `a*b*a*b` or `a*b*ab`")
    assert parse_expression("ab", names) == parameter("ab")


def test_a_declared_e_makes_powers_of_ten_doubtful() -> None:
    error = refusal("2e-3", Names(frozenset({"e"})))
    assert "declared name `e`" in error.message
    assert error.hint is not None
    assert "2*10^(-3)" in error.hint


@pytest.mark.parametrize(
    ("text", "column", "what"),
    [("x + t", 5, "time"), ("2 xdot", 3, "velocity"), ("dx/dt", 1, "velocity"), ("dt", 1, "")],
)
def test_kinds_that_have_no_place(text: str, column: int, what: str) -> None:
    error = refusal(text, Names(frozenset({"x"}), allow_time=False, allow_velocities=False))
    assert error.column == column
    assert what in error.message


def test_an_unknown_name_can_be_asked_for_and_travels() -> None:
    error = refusal("x = C")
    assert isinstance(error, UnknownNameError)
    copy = pickle.loads(pickle.dumps(error))
    assert (type(copy), copy.name, copy.column) == (UnknownNameError, "C", 5)


def test_the_nearest_of_many_names_is_found_with_little_work() -> None:
    names = Names(frozenset(f"q_{i}" for i in range(5000)))
    refusal("p_1", names)
    error, calls = counted(lambda: refusal("p_7", names))
    assert error.hint == "did you mean `q_7`?"
    assert calls < 10 * 5000


@pytest.mark.parametrize("name", ["x", "theta", "θ", "θ_1", "x_A", "E", "e", "lambda", "is", "S", "N", "q1", "x" * 64])
def test_names_that_may_be_declared(name: str) -> None:
    assert why_invalid(name) is None


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("", "empty"),
        ("x" * 65, "65 letters"),
        ("t", "time"),
        ("dt", "time"),
        ("ground", "fixed world"),
        ("pi", "number"),
        ("π", "number"),
        ("sin", "function"),
        ("ln", "function"),
        ("sqrt", "function"),
        ("diff", "function"),
        ("1x", "begins with"),
        ("_x", "begins with"),
        ("x y", "character"),
        ("x.y", "character"),
        ("x'", "character"),
        ("ẋ", "character"),
        ("é", "character"),
        ("x²", "character"),
        ("х", "Cyrillic"),
        ("x\n", "character"),
        (3, "not int"),
    ],
)
def test_names_that_may_not_be_declared(name: str, why: str) -> None:
    reason = why_invalid(name)
    assert reason is not None
    assert why in reason
