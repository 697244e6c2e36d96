"""Unknown functions at points: smooth, and the same wherever they are asked for."""

from __future__ import annotations

from fractions import Fraction

from dofkit.exact.points.balls import SmoothFunction


def test_a_function_begins_at_its_start_and_rises_by_its_slopes() -> None:
    f = SmoothFunction(Fraction(3, 4), (Fraction(2), Fraction(-5)), ())
    args = [Fraction(1, 3), Fraction(7)]
    assert f.value(args, [0, 0], Fraction, None, Fraction(0)) == Fraction(3, 4) + Fraction(2, 3) - 35
    assert f.value(args, [0, 1], Fraction, None, Fraction(0)) == -5
    assert f.value(args, [1, 1], Fraction, None, Fraction(0)) == 0
