"""Vectors and matrices of expressions, exact."""

from __future__ import annotations

from fractions import Fraction

from dofkit.expressions.tree import MINUS_ONE, ONE, TWO, ZERO, Expr, mul, num, power, sqrt, total, whole

Vec = tuple[Expr, ...]
Matrix = tuple[Vec, ...]


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


def _product(p: Expr, q: Expr) -> tuple[int | Fraction, Expr]:
    if q.op == "num":
        return whole(q.args[0]), p
    return (whole(p.args[0]), q) if p.op == "num" else (1, mul(p, q))


def square(a: Vec) -> Expr:
    """a . a."""
    return total([(1, Expr("pow", (p, TWO)) if p.op in ("sym", "add") else power(p, TWO)) for p in a])


def square_between(a: Vec, b: Vec) -> Expr:
    """|b - a|^2, at once for numbers."""
    if all(part.op == "num" for part in (*a, *b)):
        return num(sum((whole(q.args[0]) - whole(p.args[0])) ** 2 for p, q in zip(a, b, strict=True)))
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
