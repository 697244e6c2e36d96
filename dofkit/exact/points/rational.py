"""Quotients of polynomials in one unknown over GF(p)."""

from __future__ import annotations

from typing import Any

from dofkit.exact.errors import PoleError


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
        return Rational(self.top * b.bottom + b.top * self.bottom, self.bottom * b.bottom)

    def __mul__(self, other: Any) -> Rational:
        b = self._pair(other)
        return Rational(self.top * b.top, self.bottom * b.bottom)

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
