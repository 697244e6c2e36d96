"""Roots of rational numbers that are rational."""

from __future__ import annotations

from fractions import Fraction

#: Higher roots are not looked for.
MAX_DEGREE = 64


def exact_root(value: Fraction, degree: int) -> Fraction | None:
    """The root of a positive number; None where it is not rational, or the degree is above `MAX_DEGREE`."""
    if degree > MAX_DEGREE:
        return None
    top, bottom = _integer_root(value.numerator, degree), _integer_root(value.denominator, degree)
    return None if top is None or bottom is None else Fraction(top, bottom)


def _integer_root(value: int, degree: int) -> int | None:
    low, high = 0, 1 << (value.bit_length() // degree + 1)
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if middle**degree <= value else (low, middle - 1)
    return low if low**degree == value else None
