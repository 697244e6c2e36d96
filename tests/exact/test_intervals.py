"""Intervals are rounded outward: held against fractions."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import example, given
from hypothesis import strategies as s

from dofkit.exact.boxes import functions
from dofkit.exact.boxes.intervals import INF, inverse

FINITE = s.floats(min_value=1e-300, max_value=1e300, allow_nan=False)


@given(FINITE, FINITE)
@example(1 / 3, 1 / 3)
@example(1 / 49, 1 / 49)
def test_the_inverse_holds_the_inverse_of_both_ends(a: float, b: float) -> None:
    low, high = min(a, b), max(a, b)
    ((below, above),) = inverse((low, high))
    assert Fraction(below) <= 1 / Fraction(high)
    assert above == INF or Fraction(above) >= 1 / Fraction(low)


def test_whole_quotients_stay_points() -> None:
    for n in range(1, 53):
        assert inverse((1 / 2**n, 1 / 2**n)) == [(2.0**n, 2.0**n)]


def test_ends_of_one_over_a_rounded_fraction() -> None:
    """1/3 in 53 bits is less than 1/3, so its inverse is more than 3."""
    for n in range(2, 200):
        x = 1.0 / n
        ((below, above),) = inverse((x, x))
        assert Fraction(below) <= 1 / Fraction(x) <= Fraction(above)


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_of_angles_too_large_to_reduce_nothing_is_told(name: str) -> None:
    """Nor of intervals longer than a turn."""
    far = 2 * functions.MAX_ANGLE
    assert functions._circular(name, (far, far + 0.1)) == (-1.0, 1.0)
    assert functions._circular(name, (-far - 0.1, -far)) == (-1.0, 1.0)
    assert functions._circular(name, (0.0, 7.0)) == (-1.0, 1.0)
