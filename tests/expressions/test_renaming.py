"""Expressions and texts that are the same up to names: what may be told of one by the other, and what may not."""

from __future__ import annotations

import pickle
import random

import pytest

from dofkit.base.errors import TextError
from dofkit.expressions.renaming import Renaming, shape_of
from dofkit.expressions.text import Names, parse_relations
from dofkit.expressions.tree import Expr, coordinate, fn, parameter, velocity
from dofkit.scene.ledger import pattern_of

NAMES = Names(
    coordinates=frozenset({"x", "y", "z", "u", "v", "w", "d", "e5", "x1", "theta", "phi", "x0"}),
    parameters={"R": parameter("R"), "a": parameter("a")},
    functions={"h": 1},
    allow_accelerations=True,
)


def read(text: str) -> list[Expr]:
    """Both sides of every relation of a text."""
    return [side for c in parse_relations(text, NAMES) for side in (c.left, c.right)]


def test_a_coordinate_that_occurs_twice_is_no_two_coordinates() -> None:
    twice = shape_of(fn("sin", coordinate("x")) + coordinate("x")).skeleton
    once = shape_of(fn("sin", coordinate("x")) + coordinate("y")).skeleton
    assert twice != once


def test_a_renamed_expression_is_as_if_it_had_been_written_so() -> None:
    """Symbols, functions and shape, and as a key, in a sum, in a file."""
    x, y, u, v, r = coordinate("x"), velocity("y"), coordinate("u"), velocity("v"), parameter("R")
    e, written = r * fn("sin", x) + y**2 + x, r * fn("sin", u) + v**2 + u
    assert shape_of(e).names == ("x", "y")
    made = Renaming({"x": "u", "y": "v"}).of(e)
    assert (made.op, made.symbols, made.functions) == ("add", {u, v, r}, {"sin"})
    assert (made.shape.names, made.shape.kept) == (("u", "v"), ("R",))
    assert shape_of(made) == shape_of(written)
    assert {made: 1}[written] == 1
    assert made.args == written.args
    assert (made - written).is_zero
    assert pickle.loads(pickle.dumps(made)) == written
    assert Renaming({"x": "v", "y": "u"}).of(e) != written


#: Texts that are the same up to names.
ALIKE = [
    ("dx = R cos(theta) dphi", "du = R cos(w) dz"),
    ("x^2 + y^2 <= R^2 + 2 x y", "y^2 + x^2 <= R^2 + 2 y x"),
    ("0 <= x <= |y|", "0 <= x1 <= |theta|"),
    ("xdot y' - sqrt(u) = 2z sin v", "zdot w' - sqrt(v) = 2u sin x"),
    ("dx/dt = 3.5 y t", "du/dt = 3.5 v t"),
    ("x(t) + y = pi", "u(t) + v = pi"),
    ("xddot + y = 0", "phiddot + theta = 0"),
]
#: Texts that are not, or that have to be read by themselves.
UNLIKE = [
    ("2x = y", "2e5 = y"),
    ("0x1 = y", "0z = y"),
    ("d^2x/dt^2 = 0", "u^2x/dt^2 = 0"),
    ("x + x = 1", "x + y = 1"),
    ("dx = y", "x = y"),
    ("xdot = y", "dx = y"),
    ("x = R", "x = a"),
    ("sin x y = 0", "sin x*y = 0"),
    ("h(x) = y", "h(u) = v"),
    ("\\theta = x", "\\phi = x"),
    ("x(y) = 1", "x (y) = 1"),
]


@pytest.mark.parametrize(("text", "other"), ALIKE)
def test_a_text_with_the_pattern_of_another_is_it_in_other_names(text: str, other: str) -> None:
    own, twin = pattern_of(text, NAMES.lookup), pattern_of(other, NAMES.lookup)
    assert own is not None
    assert twin is not None
    assert own.key == twin.key
    renaming = Renaming(dict(zip(own.names, twin.names, strict=True)))
    assert [renaming.of(e) for e in read(text)] == read(other)


@pytest.mark.parametrize(("text", "other"), UNLIKE)
def test_texts_that_mean_another_thing_have_another_pattern(text: str, other: str) -> None:
    own, twin = pattern_of(text, NAMES.lookup), pattern_of(other, NAMES.lookup)
    assert own is None or twin is None or own.key != twin.key


def test_no_text_is_read_otherwise_by_its_pattern() -> None:
    """Random texts: where two have one pattern, both are read, and alike, or neither is."""
    rng = random.Random(17)
    words = [*sorted(NAMES.coordinates), "dx", "dy", "ydot", "x1dot", "R", "t", "dt", "sin", "2", "0", "3.", " ", " "]
    signs = [*"+-*/^()=|'", "^2", "^2/dt^2"]
    seen: dict[object, tuple[tuple[str, ...], list[Expr] | None]] = {}
    met = 0
    for _ in range(6000):
        text = "".join(rng.choice(words if rng.random() < 0.6 else signs) for _ in range(rng.randint(2, 6)))
        pattern = pattern_of(text, NAMES.lookup)
        if pattern is None:
            continue
        try:
            found = read(text)
        except TextError:
            found = None
        names, known = seen.setdefault(pattern.key, (pattern.names, found))
        met += known is not found
        if known is None or found is None:
            assert known is found, text
        else:
            renaming = Renaming(dict(zip(names, pattern.names, strict=True)))
            assert [renaming.of(e) for e in known] == found, text
    assert met > 100
