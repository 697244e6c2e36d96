"""What is a number times the equation asked for is seen at once; what only looks so is not."""

from __future__ import annotations

import pytest

import dofkit
from dofkit.homework.equations import beside, read_equations
from dofkit.homework.key import Key
from dofkit.homework.multiples import same_up_to_numbers
from dofkit.lowering import lower
from dofkit.preparing import prepared

FINITE = ("x^2 + y^2 = 1", "z = x y")
FORMS = ("dx = R cos(theta) dphi", "dy = R sin(theta) dphi")


def seen(answer: str, *asked: str) -> bool:
    """Is the answer a multiple of the constraints asked for, the first of which is called c1?"""
    made = {"parameters": {"R": "positive"}, "coordinates": ["x", "y", "z", "theta", "phi"], "constraints": [*asked]}
    key = Key(dofkit.load(made))
    reduced, setting = prepared(lower(beside(key.scene, read_equations(answer, key.names, constants=False))))
    wanted, given = reduced[: len(asked)], reduced[len(asked) :]
    return same_up_to_numbers(given, wanted, setting.positive)


@pytest.mark.parametrize(
    ("answer", "asked", "truth"),
    [
        ("3 x^2 = 3 - 3 y^2", FINITE[:1], True),
        ("-(x + y)^2/7 + 2 x y/7 + 1/7 = 0", FINITE[:1], True),
        ("x y - z = 0; 2 x^2 + 2 y^2 = 2", FINITE, True),
        ("R xdot = R^2 phidot cos(theta)", FORMS[:1], False),  # R is no number; the long way tells that it is the same
        ("5 dx - 5 R cos(theta) dphi = 0", FORMS[:1], True),
        ("ydot = R phidot sin(theta); 2 xdot = 2 R phidot cos(theta)", FORMS, True),
        ("cos(theta)^2 + x^2 + y^2 + sin(theta)^2 = 2", FINITE[:1], True),
        ("x^2 + y^2 = 2", FINITE[:1], False),
        ("x^2 + 2 y^2 = 1", FINITE[:1], False),
        ("(x^2 + y^2 - 1)^2 = 0", FINITE[:1], False),
        ("x^2 + y^2 = 1", FINITE, False),
        ("x^2 + y^2 = 1; z = x y; x = 0", FINITE, False),
        ("(x^2 + y^2)/x = 1/x", FINITE[:1], False),
        ("sqrt(x) (x^2 + y^2 - 1) = 0", FINITE[:1], False),
        ("(sqrt(x) - 1) (sqrt(x) + 1) + x^2 - x + y^2 = 0", FINITE[:1], False),
        ("sqrt(x^2 + y^2) = 1", FINITE[:1], False),
        ("x dx + y dy = 0", FINITE[:1], False),
        ("dx + R cos(theta) dphi = 0", FORMS[:1], False),
        ("(dx - R cos(theta) dphi)^2 = 0", FORMS[:1], False),
    ],
)
def test_multiples(answer: str, asked: tuple[str, ...], truth: bool) -> None:
    assert seen(answer, *asked) is truth
