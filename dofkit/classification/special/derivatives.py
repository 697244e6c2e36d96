"""Partial derivatives of polynomials in the canonical ring, by the chain rule over its generators."""

from __future__ import annotations

from dofkit.exact.errors import TooLargeError
from dofkit.exact.ring.canonical import Canon, Poly, Quotient
from dofkit.exact.ring.program import Var
from dofkit.expressions.tree import Expr


class Derivation:
    """d/ds for every symbol s; memoised."""

    def __init__(self, canon: Canon) -> None:
        self.canon = canon
        self.zero: Quotient = (canon.one * 0, canon.one)
        self._known: dict[tuple[int, Expr], Quotient] = {}

    def of(self, value: Quotient, symbol: Expr) -> Quotient:
        """The derivative of a quotient, in lowest terms. Raises TooLargeError for functions it does not know."""
        top, bottom = value
        if bottom.is_constant():
            return self._of_poly(top, symbol)
        above, below = self._of_poly(top, symbol), self._of_poly(bottom, symbol)
        total = above[0] * below[1] * bottom - below[0] * above[1] * top
        return self.lowest(self.canon.reduce(total), above[1] * below[1] * bottom**2)

    def lowest(self, top: Poly, bottom: Poly) -> Quotient:
        """A quotient without common factors, its denominator 1 where it is a number."""
        if bottom.is_constant():
            return top / bottom.leading_coefficient(), self.canon.one
        common = top.gcd(bottom)
        return (top / common, bottom / common) if common.total_degree() else (top, bottom)

    def _of_poly(self, poly: Poly, symbol: Expr) -> Quotient:
        total, below, n = self.zero[0], self.canon.one, len(self.canon.gens)
        for i in self.canon.generators_in(poly):
            top, bottom = self._of_generator(i, symbol)
            if top == 0:
                continue
            term = poly.derivative(n - 1 - i) * top
            if bottom == below:
                total = total + term
            else:
                total, below = total * bottom + term * below, below * bottom
        return self.lowest(self.canon.reduce(total), below)

    def _of_generator(self, index: int, symbol: Expr) -> Quotient:
        var, shown = self.canon.ring.vars[index], self.canon.ring.var_expr[index]
        if symbol not in shown.symbols:
            return self.zero
        if var.kind == "symbol":
            return self.canon.one, self.canon.one
        found = self._known.get((index, symbol))
        if found is None:
            inner = self.of(self.canon.quotient(var.args[0]), symbol)
            top, bottom = self._outer(var)
            found = self._known[index, symbol] = self.lowest(self.canon.reduce(inner[0] * top), inner[1] * bottom)
        return found

    def _outer(self, var: Var) -> Quotient:
        """The derivative of a generator by its argument."""
        gens, one = self.canon.gens, self.canon.one
        if var.kind == "cos":
            return -gens[var.partner], one
        if var.kind == "sin":
            return gens[var.partner], one
        if var.kind == "exp":
            return gens[var.index], one
        if var.kind == "sign":
            return one * 0, one
        top, bottom = self.canon.quotient(var.args[0])
        if var.kind == "root":
            return gens[var.index] * bottom, var.degree * top
        if var.kind == "log":
            return bottom, top
        if var.kind == "atan":
            return bottom**2, bottom**2 + top**2
        raise TooLargeError
