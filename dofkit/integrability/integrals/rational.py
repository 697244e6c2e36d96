"""Antiderivatives of rational functions by partial fractions, and of roots of quadratic polynomials."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.algebra import Algebra, Poly, Quotient, bounded, factored, solve, square_root

#: The highest degree of a numerator or denominator.
MAX_DEGREE = 10


def linear(u: Expr, x: Expr) -> tuple[Expr, Expr] | None:
    """(a, b) where u = a x + b as written."""
    a = diff(u, x)
    if x in a.symbols or a.is_zero:
        return None
    try:
        return a, substitute(u, {x: ex.ZERO})
    except NoValueError:
        return None


def quadratic(u: Expr, x: Expr) -> tuple[Expr, Expr, Expr] | None:
    """(a, b, c) where u = a x^2 + b x + c as written."""
    found = linear(diff(u, x), x)
    if found is None:
        return None
    try:
        return found[0] / 2, found[1], substitute(u, {x: ex.ZERO})
    except NoValueError:
        return None


def negative(work: Algebra, e: Expr) -> bool:
    """Every term of ``e`` carries a minus sign: taken for negative."""
    tidy = work.tidy(e)
    if tidy.op == "mul":
        signs = [f.args[0] < 0 for f in tidy.args if f.op == "num"]
        sums = [f for f in tidy.args if f.op == "add" and negative(work, f)]
        return bool((sum(signs) + len(sums)) % 2)
    if tidy.op == "add":
        return all(negative(work, term) for term in tidy.args)
    return tidy.op == "num" and bool(tidy.args[0] < 0)


def rational(work: Algebra, e: Expr, x: Expr) -> Expr | None:
    """The antiderivative of a rational function of x whose denominator has factors of degree 2 at most."""
    return work.attempt(lambda: _rational(work, e, x))


def _rational(work: Algebra, e: Expr, x: Expr) -> Expr | None:
    canon, ((top, bottom),) = work.lowered([e])
    place = canon.ring.var_index(x)
    if place is None or not (bounded(top) and bounded(bottom)):
        return None
    used = {*canon.generators_in(top), *canon.generators_in(bottom)} - {place}
    if any(x in canon.ring.var_expr[i].symbols for i in used):
        return None
    coefficients = _Powers(canon, place)
    degree_top, degree_bottom = coefficients.degree(top), coefficients.degree(bottom)
    if max(degree_top, degree_bottom) > MAX_DEGREE:
        return None
    constant, factors = _constant_and_factors(bottom, coefficients)
    if any(coefficients.degree(f) > 2 for f, _ in factors):
        return None
    pieces = _pieces(factors, degree_top - degree_bottom, canon.gens[place])
    rows = _rows(top, constant, factors, pieces, coefficients)
    found = solve(rows, canon.one)
    if found is None:
        return None
    shown = [factored(canon, a) / factored(canon, b) for a, b in found]
    return _assembled(work, canon, pieces, shown, x)


class _Powers:
    """Polynomials sorted by the powers of one generator."""

    def __init__(self, canon: Canon, place: int) -> None:
        self.canon, self.place = canon, place

    def degree(self, poly: Poly) -> int:
        return max(0, int(poly.degrees()[-1 - self.place]))

    def coefficients(self, poly: Poly, count: int) -> list[Poly]:
        terms: list[dict[tuple[int, ...], Any]] = [{} for _ in range(count)]
        for exponents, coefficient in poly.to_dict().items():
            at = list(exponents)
            power, at[-1 - self.place] = int(at[-1 - self.place]), 0
            terms[power][tuple(at)] = coefficient
        return [self.canon.ctx.from_dict(part) for part in terms]


def _constant_and_factors(bottom: Poly, powers: _Powers) -> tuple[Poly, list[tuple[Poly, int]]]:
    """The denominator as what is free of x times powers of irreducible factors."""
    constant, factors = powers.canon.one, []
    number, found = bottom.factor()
    constant = constant * number
    for f, k in found:
        if powers.degree(f):
            factors.append((f, int(k)))
        else:
            constant = constant * f ** int(k)
    return constant, factors


#: (factor, its power in the denominator, power of x in the numerator); factor None for the polynomial part.
Piece = tuple[Poly | None, int, int]


def _pieces(factors: list[tuple[Poly, int]], surplus: int, gen: Poly) -> list[Piece]:
    """The unknown parts of the decomposition."""
    pieces: list[Piece] = [(None, 0, k) for k in range(surplus + 1)]
    for f, multiplicity in factors:
        for k in range(1, multiplicity + 1):
            pieces.extend((f, k, power) for power in range(2 if _is_quadratic(f, gen) else 1))
    return pieces


def _is_quadratic(f: Poly, gen: Poly) -> bool:
    place = next(i for i, k in enumerate(gen.degrees()) if k)
    return bool(f.degrees()[place] == 2)


def _rows(
    top: Poly, constant: Poly, factors: list[tuple[Poly, int]], pieces: list[Piece], powers: _Powers
) -> list[list[Quotient]]:
    """N = sum of unknown times cofactor, compared by powers of x."""
    one, gen = powers.canon.one, powers.canon.gens[powers.place]
    whole = constant
    for f, k in factors:
        whole = whole * f**k
    cofactors = []
    for factor, k, power in pieces:
        below = one if factor is None else factor**k
        cofactors.append(whole / below * gen**power)
    count = max(powers.degree(p) for p in (*cofactors, top)) + 1
    columns = [powers.coefficients(p, count) for p in (*cofactors, top)]
    return [[(column[i], one) for column in columns] for i in range(count)]


def _assembled(work: Algebra, canon: Canon, pieces: list[Piece], found: list[Expr], x: Expr) -> Expr | None:
    total: list[Expr] = []
    grouped: dict[tuple[Expr, int], list[Expr]] = {}
    for (factor, k, power), value in zip(pieces, found, strict=True):
        if factor is None:
            total.append(value * x ** (power + 1) / (power + 1))
        else:
            grouped.setdefault((canon.to_expr(factor), k), [ex.ZERO, ex.ZERO])[power] = value
    for (f, k), (constant, slope) in grouped.items():
        part = _fraction(work, f, k, constant, slope, x)
        if part is None:
            return None
        total.append(part)
    return ex.add(*total)


def _fraction(work: Algebra, f: Expr, k: int, constant: Expr, slope: Expr, x: Expr) -> Expr | None:
    """The antiderivative of (slope x + constant) / f^k."""
    straight = linear(f, x)
    if straight is not None:
        a = straight[0]
        return constant * ex.fn("log", f) / a if k == 1 else constant * f ** (1 - k) / (a * (1 - k))
    bent = quadratic(f, x)
    if bent is None:
        return None
    a, b, _ = bent
    head = slope / (2 * a)
    first = head * ex.fn("log", f) if k == 1 else head * f ** (1 - k) / (1 - k)
    rest = work.tidy(constant - slope * b / (2 * a))
    return first if rest.is_zero else first + rest * _inverse_power(work, f, k, bent, x)


def _inverse_power(work: Algebra, f: Expr, k: int, bent: tuple[Expr, Expr, Expr], x: Expr) -> Expr:
    """The antiderivative of 1 / f^k for a quadratic f."""
    a, b, c = bent
    slope, delta = 2 * a * x + b, work.tidy(4 * a * c - b * b)
    if k > 1:
        below = _inverse_power(work, f, k - 1, bent, x)
        return slope / ((k - 1) * delta * f ** (k - 1)) + below * (2 * k - 3) * 2 * a / ((k - 1) * delta)
    if negative(work, delta):
        root = square_root(work, -delta) or ex.sqrt(work.tidy(-delta))
        return ex.fn("log", (slope - root) / (slope + root)) / root
    root = square_root(work, delta) or ex.sqrt(delta)
    return 2 * ex.fn("atan", work.tidy(slope / root)) / root


def root_of_quadratic(work: Algebra, base: Expr, exponent: Fraction, x: Expr) -> Expr | None:
    """The antiderivative of base^exponent for a quadratic base and the exponents -3/2, -1/2, 1/2."""
    bent = quadratic(base, x)
    if bent is None or exponent not in (Fraction(-3, 2), Fraction(-1, 2), Fraction(1, 2)):
        return None
    a, b, c = bent
    slope, delta, root = 2 * a * x + b, work.tidy(4 * a * c - b * b), ex.sqrt(base)
    if delta.is_zero:
        return None
    if exponent == Fraction(-3, 2):
        return 2 * slope / (delta * root)
    if negative(work, a):
        width = ex.sqrt(work.tidy(-a))
        inverse = ex.fn("atan", -slope / (2 * width * root)) / width
    else:
        width = ex.sqrt(a)
        inverse = ex.fn("log", 2 * width * root + slope) / width
    return inverse if exponent < 0 else slope * root / (4 * a) + delta * inverse / (8 * a)
