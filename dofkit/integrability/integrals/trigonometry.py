"""Antiderivatives of products of trigonometric functions."""

from __future__ import annotations

from math import comb

from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr

#: sin^m cos^n of each function.
EXPONENTS = {"sin": (1, 0), "cos": (0, 1), "tan": (1, -1), "cot": (-1, 1), "sec": (0, -1), "csc": (-1, 0)}
MAX_POWER = 12


def trig_power(factor: Expr) -> tuple[Expr, int, int] | None:
    """(u, m, n) where the factor is sin(u)^m cos(u)^n."""
    exponent = 1
    if factor.op == "pow" and factor.args[1].op == "num" and factor.args[1].args[0].denominator == 1:
        factor, exponent = factor.args[0], int(factor.args[1].args[0])
    if factor.op != "fn" or factor.args[0] not in EXPONENTS or abs(exponent) > MAX_POWER:
        return None
    m, n = EXPONENTS[factor.args[0]]
    return factor.args[1], m * exponent, n * exponent


def powers(factors: list[Expr]) -> dict[Expr, tuple[int, int]] | None:
    """The argument -> (m, n) of a product of sin(u)^m cos(u)^n, None for anything else."""
    found: dict[Expr, tuple[int, int]] = {}
    for factor in factors:
        part = trig_power(factor)
        if part is None:
            return None
        u, m, n = part
        old = found.get(u, (0, 0))
        found[u] = (old[0] + m, old[1] + n)
    return found


def to_sum(factors: list[Expr]) -> Expr | None:
    """sin or cos of one argument times sin or cos of another, as a sum."""
    found = powers(factors)
    if found is None or len(found) != 2:
        return None
    (u, first), (v, second) = found.items()
    if not {first, second} <= {(1, 0), (0, 1)}:
        return None
    if first == second:
        sign = -1 if first == (1, 0) else 1
        return (ex.fn("cos", u - v) + sign * ex.fn("cos", u + v)) / 2
    if first == (0, 1):
        u, v = v, u
    return (ex.fn("sin", u - v) + ex.fn("sin", u + v)) / 2


def sin_cos(m: int, n: int, u: Expr) -> Expr | None:
    """The antiderivative by u of sin(u)^m cos(u)^n."""
    if max(abs(m), abs(n)) > MAX_POWER:
        return None
    if (m, n) == (0, 0):
        return u
    sin, cos = ex.fn("sin", u), ex.fn("cos", u)
    if (m, n) == (-1, 0):
        return ex.fn("log", (1 - cos) / sin)
    if (m, n) == (0, -1):
        return ex.fn("log", (1 + sin) / cos)
    if m > 0 and m % 2:
        return -_alternating((m - 1) // 2, n, cos)
    if n > 0 and n % 2:
        return _alternating((n - 1) // 2, m, sin)
    if m >= 0 and n >= 0:
        return _lowered(m, n, u)
    return _by_tangent(m, n, u) if (m + n) % 2 == 0 and m + n <= 0 else None


def _monomial(base: Expr, k: int) -> Expr:
    return ex.fn("log", base) if k == -1 else base ** (k + 1) / (k + 1)


def _alternating(k: int, n: int, s: Expr) -> Expr:
    """The antiderivative by s of (1 - s^2)^k s^n."""
    return ex.add(*(comb(k, i) * (-1) ** i * _monomial(s, n + 2 * i) for i in range(k + 1)))


def _lowered(m: int, n: int, u: Expr) -> Expr | None:
    """Both exponents even and not negative: lower one of them by two."""
    sin, cos = ex.fn("sin", u), ex.fn("cos", u)
    if n >= 2:
        rest = sin_cos(m, n - 2, u)
        return None if rest is None else sin ** (m + 1) * cos ** (n - 1) / (m + n) + rest * (n - 1) / (m + n)
    rest = sin_cos(m - 2, 0, u)
    return None if rest is None else -(sin ** (m - 1)) * cos / m + rest * (m - 1) / m


def _by_tangent(m: int, n: int, u: Expr) -> Expr | None:
    """With T = tan u: T^m (1 + T^2)^k dT, k = -(m + n)/2 - 1."""
    k = -(m + n) // 2 - 1
    if k < 0:
        down = 2 if m > 0 else -2
        rest = sin_cos(m - down, n + down, u)
        tangent = ex.fn("tan", u)
        return None if rest is None else _monomial(tangent, m - 2 if m > 0 else m) - rest
    tangent = ex.fn("tan", u)
    return ex.add(*(comb(k, i) * _monomial(tangent, m + 2 * i) for i in range(k + 1)))
