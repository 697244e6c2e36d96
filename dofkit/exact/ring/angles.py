"""Sines and cosines as a ring writes them: polynomials in those of the angles that the arguments have in common."""

from __future__ import annotations

from fractions import Fraction

from dofkit.exact.ring.instructions import Builder
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

#: sin(n u) is a polynomial in sin u and cos u up to this n; beyond, it is a generator of its own.
MAX_MULTIPLE = 64

#: (cos, sin) by nodes.
Turn = tuple[int, int]


def rotated(ring: Builder, a: Turn, b: Turn) -> Turn:
    """cos and sin of a sum of two angles."""
    if a == (ring.number(1), ring.number(0)):
        return b
    minus = ring.number(-1)
    return (
        ring.total(ring.product(a[0], b[0]), ring.product(minus, a[1], b[1])),
        ring.total(ring.product(a[0], b[1]), ring.product(a[1], b[0])),
    )


def multiple(ring: Builder, angle: Turn, n: int) -> Turn:
    """cos and sin of n times an angle."""
    if n < 0:
        cos, sin = multiple(ring, angle, -n)
        return cos, ring.product(ring.number(-1), sin)
    if n == 0:
        return ring.number(1), ring.number(0)
    half = multiple(ring, angle, n // 2)
    total = angle if n == 1 else rotated(ring, half, half)
    return rotated(ring, total, angle) if n > 1 and n % 2 else total


def of_inverse(ring: Builder, rest: Expr) -> Turn:
    """cos and sin of asin u, acos u, atan u or atan2(y, x)."""
    u = rest.args[1]
    if rest.args[0] in ("asin", "acos"):
        other = ring.node(ex.sqrt(ex.ONE - u * u))
        return (other, ring.node(u)) if rest.args[0] == "asin" else (ring.node(u), other)
    x = ex.ONE if rest.args[0] == "atan" else rest.args[2]
    inverse = ring.power_node(ring.node(ex.sqrt(x * x + u * u)), -1)
    return ring.product(ring.node(x), inverse), ring.product(ring.node(u), inverse)


def exact_turn(factor: Fraction) -> tuple[Fraction, Fraction]:
    """factor = a + b modulo 2 with the prime powers 2, 4 and 3 of its denominator in that of a, the others in b's."""
    twos, rest = 1, factor.denominator
    while rest % 2 == 0:
        twos, rest = 2 * twos, rest // 2
    threes = 1
    while rest % 3 == 0:
        threes, rest = 3 * threes, rest // 3
    known = (twos if twos <= 4 else 1) * (threes if threes <= 3 else 1)
    other = factor.denominator // known
    a = Fraction(factor.numerator * pow(other, -1, known) % known, known) if known > 1 else Fraction(0)
    return a % 2, (factor - a) % 2


def turn_of_twelfths(ring: Builder, factor: Fraction) -> Turn:
    """cos and sin of factor pi, for a denominator that divides 12."""
    thirds = int(12 * factor) % 3
    quarters = int(4 * (factor - Fraction(thirds, 3))) % 8
    return rotated(ring, multiple(ring, _third(ring), thirds), _quarters(ring, quarters))


def _third(ring: Builder) -> Turn:
    half = ring.number(Fraction(1, 2))
    return half, ring.product(half, ring.node(ex.sqrt(ex.num(3))))


def _quarters(ring: Builder, n: int) -> Turn:
    one, zero, minus = ring.number(1), ring.number(0), ring.number(-1)
    if n % 2 == 0:
        return {0: (one, zero), 2: (zero, one), 4: (minus, zero), 6: (zero, minus)}[n]
    plus = ring.product(ring.number(Fraction(1, 2)), ring.node(ex.sqrt(ex.TWO)))
    less = ring.product(minus, plus)
    return {1: (plus, plus), 3: (less, plus), 5: (less, less), 7: (plus, less)}[n]
