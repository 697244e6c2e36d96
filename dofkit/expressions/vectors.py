"""Vectors and matrices of expressions, exact."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from dofkit.expressions.tree import MINUS_ONE, ONE, TWO, ZERO, Expr, mul, num, power, sqrt

Vec = tuple[Expr, ...]


Matrix = tuple[Vec, ...]


_Number = int | Fraction


def total(multiples: Iterable[tuple[_Number, Expr]]) -> Expr:
    """Return the sum of numbers times expressions, equal terms collected: `add` for many short sums.

    Whole numbers are kept as int while they are added, which is several times faster than Fraction.
    """
    collected: dict[Expr, _Number] = {}
    for factor, e in multiples:
        for term in e.args if e.op == "add" else (e,):
            number: _Number = factor
            if term.op == "num":
                number, term = factor * _whole(term.args[0]), ONE
            elif term.op == "mul" and term.args[0].op == "num":
                number = factor * _whole(term.args[0].args[0])
                factors = term.args[1:]
                term = factors[0] if len(factors) == 1 else Expr("mul", factors)
            collected[term] = collected[term] + number if term in collected else number
    terms = [_times(number, term) for term, number in collected.items() if number]
    if len(terms) > 1:
        return Expr("add", tuple(terms))
    return terms[0] if terms else ZERO


def _whole(number: Fraction) -> _Number:
    return number.numerator if number.denominator == 1 else number


def _times(number: _Number, term: Expr) -> Expr:
    if number == 1:
        return term
    factor = MINUS_ONE if number == -1 else num(number)
    if term is ONE:
        return factor
    return Expr("mul", (factor, *term.args) if term.op == "mul" else (factor, term))


def plus(*vectors: Vec) -> Vec:
    """Return the sum."""
    return tuple(total([(1, part) for part in components]) for components in zip(*vectors, strict=True))


def minus(a: Vec, b: Vec) -> Vec:
    """a - b."""
    return tuple(difference(p, q) for p, q in zip(a, b, strict=True))


def difference(a: Expr, b: Expr) -> Expr:
    """a - b."""
    if a.op == "sym" and b.op == "sym" and a != b:
        return Expr("add", (a, Expr("mul", (MINUS_ONE, b))))
    return a if b.is_zero else total(((1, a), (-1, b)))


def scaled(factor: Expr, a: Vec) -> Vec:
    """factor a."""
    return a if factor is ONE or factor == ONE else tuple(mul(factor, part) for part in a)


def dot(a: Vec, b: Vec) -> Expr:
    """a . b."""
    return total([_product(p, q) for p, q in zip(a, b, strict=True)])


def _product(p: Expr, q: Expr) -> tuple[_Number, Expr]:
    if q.op == "num":
        return _whole(q.args[0]), p
    return (_whole(p.args[0]), q) if p.op == "num" else (1, mul(p, q))


def square(a: Vec) -> Expr:
    """a . a."""
    return total([(1, Expr("pow", (p, TWO)) if p.op in ("sym", "add") else power(p, TWO)) for p in a])


def square_between(a: Vec, b: Vec) -> Expr:
    """|b - a|^2, at once for numbers."""
    if all(part.op == "num" for part in (*a, *b)):
        return num(sum((_whole(q.args[0]) - _whole(p.args[0])) ** 2 for p, q in zip(a, b, strict=True)))
    return square(minus(b, a))


def length(a: Vec) -> Expr:
    """|a|, folded where it is rational."""
    return sqrt(square(a))


def cross(a: Vec, b: Vec) -> Vec:
    """a x b in space."""
    return tuple(difference(mul(a[i], b[j]), mul(a[j], b[i])) for i, j in ((1, 2), (2, 0), (0, 1)))


def apply(matrix: Matrix, a: Vec) -> Vec:
    """Return the matrix times a vector."""
    return tuple(dot(row, a) for row in matrix)


def product(first: Matrix, second: Matrix) -> Matrix:
    """Return the product of two matrices."""
    columns = tuple(zip(*second, strict=True))
    return tuple(tuple(dot(row, column) for column in columns) for row in first)


def transposed(matrix: Matrix) -> Matrix:
    """Return the transpose."""
    return tuple(zip(*matrix, strict=True))


def unit(axis: int, dimension: int) -> Vec:
    """Return the world's axis number ``axis``."""
    return tuple(ONE if i == axis else ZERO for i in range(dimension))


def is_zero(a: Vec) -> bool:
    """Return whether every component is the number 0 as written."""
    return all(part.is_zero for part in a)


def across(n: Vec, pivot: int) -> tuple[Vec, ...]:
    """d - 1 independent vectors perpendicular to ``n``, whose component ``pivot`` is not zero.

    In the plane the one turned left by a right angle.
    """
    if len(n) == 2:
        return ((mul(MINUS_ONE, n[1]), n[0]),)
    spanning = []
    for i in range(len(n)):
        if i != pivot:
            vector = [ZERO] * len(n)
            vector[i], vector[pivot] = n[pivot], mul(MINUS_ONE, n[i])
            spanning.append(tuple(vector))
    return tuple(spanning)
