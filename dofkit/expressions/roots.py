"""Powers and roots of rational numbers that are rational."""

from __future__ import annotations

from fractions import Fraction

from dofkit.base.errors import PoleError

#: A power of numbers is folded only while the result stays below this many bits.
FOLD_BITS = 4096
#: Higher roots are not looked for.
MAX_DEGREE = 64


def exact_power(base: Fraction, exponent: Fraction) -> Fraction | None:
    """A number to a power, where that is a number of bounded size. Raises PoleError for 0 to a negative power."""
    if base == 0:
        if exponent < 0:
            raise PoleError
        return Fraction(exponent == 0)
    if base == 1:
        return base
    if exponent.denominator == 1:
        bits = max(base.numerator.bit_length(), base.denominator.bit_length())
        return base ** int(exponent) if bits * abs(exponent) <= FOLD_BITS else None
    if base > 0 and abs(exponent.numerator) <= 64:
        root = exact_root(base, exponent.denominator)
        return None if root is None else exact_power(root, Fraction(exponent.numerator))
    return None


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
