"""Logarithms and inverse functions as a ring writes them: of factors, of prime numbers, odd ones by one sign."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from dofkit.exact.ring.instructions import Builder
from dofkit.exact.ring.radicals import known_signs, leads_with_minus, never_negative, prime_powers, sign
from dofkit.expressions import tree as ex
from dofkit.expressions.terms import sorted_sum
from dofkit.expressions.tree import Expr


def inverse_function(ring: Builder, name: str, e: Expr) -> int:
    """asin, acos, atan and atan2."""
    u = e.args[1]
    if name == "acos":
        return ring.node(ex.HALF * ex.PI - ex.fn("asin", u))
    if name == "atan2":
        return _atan2(ring, e)
    if _minus(u):
        return ring.product(ring.number(-1), ring.node(ex.fn(name, -u)))
    if name == "asin":
        root = ring.node(ex.sqrt(ex.ONE - u * u))
        return ring.generator("asin", sorted_sum(u), e, (ring.node(u), root))
    below = _inverse_of(u)
    if below is not None:
        quarter = ring.product(ring.number(Fraction(1, 2)), ring.node(ex.PI), sign(ring, below))
        return ring.total(quarter, ring.product(ring.number(-1), ring.node(ex.fn("atan", below))))
    return ring.generator(name, sorted_sum(u), e, (ring.node(u),))


def _minus(u: Expr) -> bool:
    """Of u and -u, is this the one that is written by the other?"""
    if u.op == "num":
        return bool(u.args[0] < 0)
    return leads_with_minus(u) if u.op in ("add", "mul") else False


def _inverse_of(u: Expr) -> Expr | None:
    """f where u = c / f, c a number and f no number: atan(1/f) = sign(f) pi/2 - atan(f)."""
    number, rest = (
        (u.args[0], u.args[1]) if u.op == "mul" and len(u.args) == 2 and u.args[0].op == "num" else (ex.ONE, u)
    )
    if rest.op != "pow" or rest.args[1].op != "num" or rest.args[1].args[0] >= 0:
        return None
    return ex.power(rest, ex.MINUS_ONE) / number


def _atan2(ring: Builder, e: Expr) -> int:
    """atan2(y, x) = atan(y/x) where x is known to be positive."""
    y, x = e.args[1:]
    if never_negative(ring, x) and (x.op == "num" or x in ring.positive):
        return ring.node(ex.fn("atan", y / x))
    return ring.generator("atan2", (y, x), e, (ring.node(y), ring.node(x)))


def split_logs(expressions: Iterable[Expr], positive: frozenset[Expr]) -> bool:
    """Is there a logarithm of an absolute value, or of a product whose factors have unknown signs?"""
    seen: set[Expr] = set()
    for e in expressions:
        for node in ex.nodes(e):
            if node in seen or node.op != "fn" or node.args[0] != "log":
                continue
            seen.add(node)
            u = node.args[1]
            if u.op == "fn" and u.args[0] == "abs":
                return True
            unknown = [p for p in (u.args if u.op == "mul" else (u,)) if p.op != "num" and p not in positive]
            if (u.op == "mul" and len(unknown) > 1) or (u.op == "pow" and _even(u)):
                return True
    return False


def _even(power: Expr) -> bool:
    exponent = power.args[1]
    return bool(exponent.op == "num" and exponent.args[0].denominator == 1 and exponent.args[0] % 2 == 0)


def log(ring: Builder, u: Expr, split: bool) -> int:
    """log of a product as the sum of logs, of a power as a multiple, of an integer over its primes.

    ``split``: log f is written (1/2) log(f^2), and 0 log f is added to keep its domain, so that the logarithm of a
    product is that of its factors whatever their signs.
    """
    if u.op == "mul":
        apart, rest = known_signs(ring, u)
        if apart:
            return ring.total(*(log(ring, part, split) for part in [*apart, *([rest] if rest != ex.ONE else [])]))
    if u.op == "pow" and (never_negative(ring, u.args[0]) or u.args[1].op != "num" or u.args[1].args[0] % 2):
        return ring.product(ring.node(u.args[1]), log(ring, u.args[0], split))
    if u.op == "fn" and u.args[0] == "exp":
        return ring.node(u.args[1])
    if u.op == "num" and u.args[0] > 0:
        return log_of_number(ring, u.args[0])
    plain = ring.generator("log", sorted_sum(u), Expr("fn", ("log", u)), (ring.node(u),))
    if not split or not u.symbols or (never_negative(ring, u) and not (u.op == "fn" and u.args[0] == "abs")):
        return plain
    return ring.total(_log_of_size(ring, u), ring.product(ring.number(0), plain))


def _log_of_size(ring: Builder, u: Expr) -> int:
    """log |u|."""
    if u.op == "mul":
        return ring.total(*(_log_of_size(ring, part) for part in u.args))
    if u.op == "pow" and u.args[1].op == "num":
        return ring.product(ring.node(u.args[1]), _log_of_size(ring, u.args[0]))
    if u.op == "fn" and u.args[0] == "abs":
        return _log_of_size(ring, u.args[1])
    if u.op == "num":
        return log_of_number(ring, abs(u.args[0]))
    return ring.product(ring.number(Fraction(1, 2)), log(ring, u * u, False))


def log_of_number(ring: Builder, value: Fraction) -> int:
    """Over the primes of a positive number."""
    logs = [ring.product(ring.number(k), _log_of_prime(ring, p)) for p, k in _primes(value)]
    return ring.total(*logs) if logs else ring.number(0)


def over_primes(u: Expr) -> Expr:
    """An exponent with the logarithms of numbers in its terms as sums over primes: 4^w is (e^(w log 2))^2."""
    if u.op in ("add", "mul"):
        return (ex.add if u.op == "add" else ex.mul)(*map(over_primes, u.args))
    if u.op != "fn" or u.args[0] != "log":
        return u
    base = u.args[1]
    if base.op == "pow" and base.args[0].op == base.args[1].op == "num" and base.args[0].args[0] > 0:
        return ex.mul(base.args[1], over_primes(ex.fn("log", base.args[0])))
    if base.op == "num" and base.args[0] > 0:
        return ex.add(*(ex.mul(ex.num(k), Expr("fn", ("log", ex.num(p)))) for p, k in _primes(base.args[0])))
    return u


def _primes(value: Fraction) -> list[tuple[int, int]]:
    """The primes of a positive number with their powers."""
    return prime_powers(value.numerator) + [(p, -k) for p, k in prime_powers(value.denominator)]


def _log_of_prime(ring: Builder, prime: int) -> int:
    return ring.generator("log", prime, Expr("fn", ("log", ex.num(prime))), (ring.number(prime),))
