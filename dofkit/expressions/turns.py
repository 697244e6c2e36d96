"""Where an elementary function is rational: at 0, and at some rational multiples of pi."""

from __future__ import annotations

from fractions import Fraction

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
#: The functions that are rational at some multiples of pi.
TURNING = frozenset(_AT_TWELFTHS)


def value_at(name: str, argument: Fraction) -> Fraction | None:
    """The value of a function of one argument, where that is known to be rational; else None.

    >>> value_at("cos", Fraction(0)), value_at("abs", Fraction(-2, 3)), value_at("sin", Fraction(1))
    (Fraction(1, 1), Fraction(2, 3), None)
    """
    if name == "abs":
        return abs(argument)
    if name == "log" and argument == 1:
        return _ZERO
    return None if argument else _AT_ZERO.get(name)


def value_at_turn(name: str, multiple: Fraction) -> Fraction | None:
    """The value of a function of `TURNING` at ``multiple`` times pi, where it is rational; else None.

    >>> value_at_turn("sin", Fraction(1, 6)), value_at_turn("cos", Fraction(-2, 3))
    (Fraction(1, 2), Fraction(-1, 2))
    """
    place = multiple * 12
    if place.denominator != 1:
        return None
    half_turns, within = divmod(int(place), 12)
    value = _AT_TWELFTHS[name].get(within)
    return -value if value is not None and half_turns % 2 and name != "tan" else value
