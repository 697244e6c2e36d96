"""Quotients of polynomials in one unknown over GF(p)."""

from __future__ import annotations

from typing import Any

from dofkit.base.deadline import check
from dofkit.exact.errors import NoValueError, PoleError

#: Denominators past this degree are reduced; quotients past this one are given up.
LOW, LARGEST = 48, 4096


class Rational:
    """A quotient of polynomials in one unknown over GF(p)."""

    __slots__ = ("bottom", "top")

    def __init__(self, top: Any, bottom: Any) -> None:
        self.top = top
        self.bottom = bottom

    def _pair(self, other: Any) -> Rational:
        return other if isinstance(other, Rational) else Rational(self.top * 0 + other, self.bottom * 0 + 1)

    def __add__(self, other: Any) -> Rational:
        b = self._pair(other)
        if self.bottom == b.bottom:
            return Rational(self.top + b.top, self.bottom)
        return _lowest(self.top * b.bottom + b.top * self.bottom, self.bottom * b.bottom)

    def __mul__(self, other: Any) -> Rational:
        b = self._pair(other)
        return _lowest(self.top * b.top, self.bottom * b.bottom)

    __radd__ = __add__
    __rmul__ = __mul__

    def __neg__(self) -> Rational:
        return Rational(-self.top, self.bottom)

    def __pow__(self, n: int) -> Rational:
        return Rational(self.top**n, self.bottom**n)

    def __rtruediv__(self, other: Any) -> Rational:
        if self.top == 0:
            raise PoleError
        return self._pair(other) * Rational(self.bottom, self.top)

    def numerator(self) -> Any:
        """In lowest terms."""
        return self.top // self.top.gcd(self.bottom) if self.top != 0 else self.top


def _lowest(top: Any, bottom: Any) -> Rational:
    """A quotient, in lowest terms where it is large. Raises NoValueError where it stays too large to go on with."""
    if bottom.degree() <= LOW:
        return Rational(top, bottom)
    check()
    common = top.gcd(bottom)
    top, bottom = top // common, bottom // common
    if max(top.degree(), bottom.degree()) > LARGEST:
        raise NoValueError("a quotient of polynomials is too large")
    return Rational(top, bottom)
