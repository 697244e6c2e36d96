"""Is a constant 0? Proofs, for algebraic numbers and for sums of logarithms and of inverse functions of them.

A number built from integers by + - * / and roots is U / L with algebraic integers U and L. All conjugates of U, of
which there are at most D (the product of the roots' degrees), have a size of at most u, and those of L of at most l; a
norm is an integer, so a number that is not 0 has a size of at least 1 / (u^(D-1) l): the separation bound [BFMSS2001].
A ball below that proves 0.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from math import lcm, log2

from flint import arb

from dofkit.expressions import tree as ex
from dofkit.expressions.enclosures import interval_of, is_constant
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr

#: Bits of a separation bound, and degrees, up to which a proof is tried; multiples of an angle or a logarithm.
MAX_BITS, MAX_DEGREE, MAX_MULTIPLE = 40_000, 4096, 64
#: Bits of the first look.
FIRST = 256
ARCS = ("asin", "acos", "atan", "atan2")


class NotAlgebraicError(Exception):
    """The number is not built from integers by arithmetic, roots and roots of unity."""


def proved_zero(e: Expr) -> bool:
    """True where the constant ``e`` is proved to be 0. False says nothing."""
    if e.op == "num":
        return e.is_zero
    if not is_constant(e) or not _may_be_zero(e):
        return False
    if e.op == "mul":
        return any(proved_zero(part) for part in e.args)
    try:
        return _below_the_bound(e)
    except NotAlgebraicError:
        return _by_groups(e)


def _may_be_zero(e: Expr) -> bool:
    found = interval_of(e, bits=FIRST)
    return found is not None and bool(found.contains(0))


# -- algebraic numbers -------------------------------------------------------------------------------


@dataclass
class _Field:
    """The roots that occur, by radicand and degree, and the order of the roots of unity."""

    roots: set[tuple[Expr, int]] = field(default_factory=set)
    order: int = 1

    @property
    def degree(self) -> int:
        """An upper bound of the degree of the field that they generate."""
        total = _totient(self.order)
        for _, k in self.roots:
            total *= k
        return total


def _totient(n: int) -> int:
    count, rest, p = n, n, 2
    while p * p <= rest:
        if rest % p == 0:
            count -= count // p
            while rest % p == 0:
                rest //= p
        p += 1
    return count - count // rest if rest > 1 else count


def _below_the_bound(e: Expr) -> bool:
    known = _Field()
    upper, lower = _sizes(e, known)
    if known.degree > MAX_DEGREE:
        return False
    bits = int(upper * (known.degree - 1) + lower) + 2
    if bits > MAX_BITS:
        return False
    found = interval_of(e, bits=bits + FIRST)
    return found is not None and bool(found.abs_upper() < arb(2) ** -bits)


def _sizes(e: Expr, known: _Field) -> tuple[float, float]:
    """log2 of u and of l, at least 0; rounding is made up for by the last bits of the bound."""
    if e.op == "num":
        value: Fraction = e.args[0]
        return log2(max(1, abs(value.numerator))), log2(value.denominator)
    if e.op == "add":
        parts = [_sizes(t, known) for t in e.args]
        below = sum(lower for _, lower in parts)
        largest = max(upper - lower for upper, lower in parts)
        return below + largest + log2(len(parts)), below
    if e.op == "mul":
        parts = [_sizes(t, known) for t in e.args]
        return sum(upper for upper, _ in parts), sum(lower for _, lower in parts)
    if e.op == "pow" and e.args[1].op == "num":
        return _size_of_power(e.args[0], e.args[1].args[0], known)
    if e.op == "fn":
        return _size_of_function(e, known)
    raise NotAlgebraicError


def _size_of_power(base: Expr, exponent: Fraction, known: _Field) -> tuple[float, float]:
    upper, lower = _sizes(base, known)
    if exponent.denominator > 1:
        k = exponent.denominator
        known.roots.add((base, k))
        upper = (upper + (k - 1) * lower) / k
    n = exponent.numerator
    upper, lower = upper * abs(n), lower * abs(n)
    return (upper, lower) if n > 0 else (lower, upper)


def _size_of_function(e: Expr, known: _Field) -> tuple[float, float]:
    """Sines and cosines of rational multiples of pi: twice them are algebraic integers with conjugates up to 2."""
    name, u = e.args[0], e.args[1]
    if name == "abs":
        return _sizes(u, known)
    terms = linear_terms(u)
    if name not in ("sin", "cos", "tan") or set(terms) != {ex.PI}:
        raise NotAlgebraicError
    known.order = lcm(known.order, 4, 2 * terms[ex.PI].denominator)
    return (1.0, 1.0) if name != "tan" else (2.0, 2.0)


# -- sums of arcs and logarithms -----------------------------------------------------------------------


def _by_groups(e: Expr) -> bool:
    """Terms with the same algebraic factor: their arcs, their logarithms and the rest vanish each by itself."""
    arcs: dict[Expr, dict[Expr, Fraction]] = {}
    logs: dict[Expr, dict[Expr, Fraction]] = {}
    rest: list[Expr] = []
    for term, number in linear_terms(e).items():
        factors = term.args if term.op == "mul" else (term,)
        beyond = [f for f in factors if _is_arc(f) or _is_log(f)]
        if len(beyond) > 1:
            return False
        if not beyond:
            rest.append(ex.num(number) * term)
            continue
        place = arcs if _is_arc(beyond[0]) else logs
        others = ex.mul(*(f for f in factors if f is not beyond[0]))
        place.setdefault(others, {})[beyond[0]] = number
    left = ex.add(*rest)
    sums = all(map(_arcs_vanish, arcs.values())) and all(map(_logs_vanish, logs.values()))
    return bool(arcs or logs) and sums and (left.is_zero or proved_zero(left))


def _is_arc(e: Expr) -> bool:
    return e == ex.PI or (e.op == "fn" and e.args[0] in ARCS)


def _is_log(e: Expr) -> bool:
    return e.op == "fn" and e.args[0] == "log"


def _scaled(terms: dict[Expr, Fraction]) -> dict[Expr, int] | None:
    """The coefficients as integers without a common denominator; None where they are large."""
    whole = lcm(*(f.denominator for f in terms.values()))
    found = {term: int(f * whole) for term, f in terms.items()}
    return found if all(abs(n) <= MAX_MULTIPLE for n in found.values()) else None


def _arcs_vanish(terms: dict[Expr, Fraction]) -> bool:
    """Sum n_k theta_k = 0: it is small, and the product of the exp(i theta_k)^n_k is real."""
    scaled = _scaled(_over_asin(terms))
    if scaled is None:
        return False
    total = interval_of(ex.add(*(ex.num(n) * term for term, n in scaled.items())), bits=FIRST)
    if total is None or not total.contains(0) or not total.abs_upper() < 1:
        return False
    real, imaginary = ex.ONE, ex.ZERO
    for term, n in scaled.items():
        if term == ex.PI:
            continue
        x, y = _on_the_ray(term)
        for _ in range(abs(n)):
            s = y if n > 0 else -y
            real, imaginary = real * x - imaginary * s, real * s + imaginary * x
    try:
        return imaginary.is_zero or _below_the_bound(imaginary)
    except NotAlgebraicError:
        return False


def _over_asin(terms: dict[Expr, Fraction]) -> dict[Expr, Fraction]:
    """With acos u = pi/2 - asin u."""
    found: dict[Expr, Fraction] = {}
    for term, number in terms.items():
        if term.op == "fn" and term.args[0] == "acos":
            found[ex.PI] = found.get(ex.PI, Fraction(0)) + number / 2
            term, number = ex.fn("asin", term.args[1]), -number
        found[term] = found.get(term, Fraction(0)) + number
    return found


def _on_the_ray(arc: Expr) -> tuple[Expr, Expr]:
    """A point (x, y) in the direction of the angle: of atan u it is (1, u)."""
    u = arc.args[1]
    if arc.args[0] == "asin":
        return ex.sqrt(ex.ONE - u * u), u
    return (ex.ONE, u) if arc.args[0] == "atan" else (arc.args[2], u)


def _logs_vanish(terms: dict[Expr, Fraction]) -> bool:
    """Sum n_k log u_k = 0: the product of the u_k^n_k is 1."""
    scaled = _scaled(terms)
    if scaled is None:
        return False
    product = ex.mul(*(ex.power(term.args[1], ex.num(n)) for term, n in scaled.items()))
    try:
        return product == ex.ONE or _below_the_bound(product - 1)
    except NotAlgebraicError:
        return False
