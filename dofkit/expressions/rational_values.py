"""Powers, roots and values of functions that are rational numbers."""

from __future__ import annotations

from fractions import Fraction

from flint import fmpz

from dofkit.base.errors import PoleError

#: A power of numbers is folded only while the result stays below this many bits.
FOLD_BITS = 4096
#: Roots of higher degree are not computed.
MAX_DEGREE = 64


def exact_power(base: Fraction, exponent: Fraction) -> Fraction | None:
    """Return base^exponent, or None if it is irrational or too long. Raises PoleError for 0 to a negative power."""
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
    """Return the positive root of ``value`` > 0, or None if it is irrational or ``degree`` exceeds `MAX_DEGREE`."""
    if degree > MAX_DEGREE:
        return None
    top, bottom = _integer_root(value.numerator, degree), _integer_root(value.denominator, degree)
    return None if top is None or bottom is None else Fraction(top, bottom)


def _integer_root(value: int, degree: int) -> int | None:
    root = int(fmpz(value).root(degree))
    return root if root**degree == value else None


_ZERO, _HALF, _ONE = Fraction(0), Fraction(1, 2), Fraction(1)
_AT_ZERO: dict[str, Fraction] = {
    **dict.fromkeys(("sin", "tan", "asin", "atan", "sinh", "tanh"), _ZERO),
    **dict.fromkeys(("cos", "sec", "cosh", "exp"), _ONE),
}
#: The rational values at multiples of pi/12 in the first half turn (Niven: sine and cosine have no others).
_AT_TWELFTHS: dict[str, dict[int, Fraction]] = {
    "sin": {0: _ZERO, 2: _HALF, 6: _ONE, 10: _HALF},
    "cos": {0: _ONE, 4: _HALF, 6: _ZERO, 8: -_HALF},
    "tan": {0: _ZERO, 3: _ONE, 9: -_ONE},
}
#: The functions with rational values at some multiples of pi.
TURNING = frozenset(_AT_TWELFTHS)


def value_at(name: str, argument: Fraction) -> Fraction | None:
    """Return the value of the function ``name`` at ``argument`` if it is known to be rational, else None.

    >>> value_at("cos", Fraction(0)), value_at("abs", Fraction(-2, 3)), value_at("sin", Fraction(1))
    (Fraction(1, 1), Fraction(2, 3), None)
    """
    if name == "abs":
        return abs(argument)
    if name == "log" and argument == 1:
        return _ZERO
    return None if argument else _AT_ZERO.get(name)


def value_at_turn(name: str, multiple: Fraction) -> Fraction | None:
    """Return the value of the function ``name`` of `TURNING` at ``multiple`` times pi if it is rational, else None.

    >>> value_at_turn("sin", Fraction(1, 6)), value_at_turn("cos", Fraction(-2, 3))
    (Fraction(1, 2), Fraction(-1, 2))
    """
    twelfths = multiple * 12
    if twelfths.denominator != 1:
        return None
    half_turns, remainder = divmod(int(twelfths), 12)
    value = _AT_TWELFTHS[name].get(remainder)
    return -value if value is not None and half_turns % 2 and name != "tan" else value
