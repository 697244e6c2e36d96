"""Roots, signs, logarithms and inverse functions as a ring writes them: over primes, of factors, of one sign."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from flint import fmpz

from dofkit.exact.ring.program import Instructions
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import content, sorted_sum
from dofkit.expressions.enclosures import interval_of, is_constant
from dofkit.expressions.tree import Expr

Key = tuple[Any, int]
#: Primes by which a long number is divided.
TRIAL_PRIMES = 12


def root(ring: Instructions, radicand: Expr, degree: int) -> int:
    """Return the real ``degree``-th root; of a product, the product of the roots; of an integer, over its primes."""
    if radicand.op == "mul":
        apart, cofactor = known_signs(ring, radicand)
        if degree % 2:
            apart, cofactor = list(radicand.args), ex.ONE
        if cofactor.op != "mul" or apart:
            factors = [*apart, *([cofactor] if cofactor != ex.ONE else [])]
            return ring.product(*(root(ring, part, degree) for part in factors))
    if radicand.op == "pow" and radicand.args[1].op == "num":
        return _root_of_power(ring, radicand, degree)
    if radicand.op == "num":
        return root_of_number(ring, radicand.args[0], degree)
    if radicand.op == "add":
        return _root_of_sum(ring, radicand, degree)
    return _new_root(ring, (sorted_sum(radicand), degree), radicand, ring.node(radicand))


def _root_of_sum(ring: Instructions, radicand: Expr, degree: int) -> int:
    number, primitive = content(radicand)
    if number != 1:
        return ring.product(root_of_number(ring, number, degree), root(ring, primitive, degree))
    return _new_root(ring, (sorted_sum(radicand), degree), radicand, ring.node(radicand))


def known_signs(ring: Instructions, product: Expr) -> tuple[list[Expr], Expr]:
    """(factors that are never negative, the product of the others): only those have roots and logs of their own."""
    apart: list[Expr] = []
    signed: list[Expr] = []
    for part in product.args:
        (apart if never_negative(part, ring.positive) else signed).append(part)
    number = next((p for p in signed if p.op == "num"), None)
    if number is not None and number.args[0] != -1:
        apart.append(ex.num(abs(number.args[0])))
        signed = [ex.MINUS_ONE if p is number else p for p in signed]
    return apart, Expr("mul", tuple(signed)) if len(signed) > 1 else signed[0] if signed else ex.ONE


def never_negative(part: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether it is >= 0 by its form, wherever it is defined."""
    if part.op == "num":
        return bool(part.args[0] > 0)
    if part in positive or part.op == "const" or (part.op == "fn" and part.args[0] in ("exp", "abs", "cosh")):
        return True
    if part.op in ("add", "mul"):
        return all(never_negative(p, positive) for p in part.args)
    if part.op != "pow":
        return False
    if part.args[1].op != "num":
        return never_negative(part.args[0], positive)
    exponent: Fraction = part.args[1].args[0]
    return exponent.denominator % 2 == 0 or exponent.numerator % 2 == 0 or never_negative(part.args[0], positive)


def _new_root(ring: Instructions, key: Key, radicand: Expr, node: int) -> int:
    expression = Expr("pow", (radicand, ex.num(Fraction(1, key[1]))))
    return ring.generator("root", key, expression, (node,), key[1])


def _root_of_power(ring: Instructions, radicand: Expr, degree: int) -> int:
    base, exponent = radicand.args[0], radicand.args[1].args[0]
    whole, fraction = divmod(exponent / degree, 1)
    even_inside = exponent.denominator == 1 and exponent % 2 == 0 and degree % 2 == 0
    if fraction == 0:
        power = ring.power_node(ring.node(base), int(whole))
        return ring.product(power, ring.power_node(sign(ring, base), abs(int(whole)))) if even_inside else power
    reduced = Fraction(exponent, degree)
    if even_inside and not never_negative(base, ring.positive):
        if reduced.denominator % 2 == 0:
            return ring.power_node(root(ring, ex.fn("abs", base), reduced.denominator), reduced.numerator)
        outer = ring.product(sign(ring, base), root(ring, base, reduced.denominator))
        return ring.power_node(outer, reduced.numerator)
    return ring.power_node(root(ring, base, reduced.denominator), reduced.numerator)


def root_of_number(ring: Instructions, value: Fraction, degree: int) -> int:
    """Over the primes of numerator and denominator."""
    if value < 0:
        if degree % 2:
            return ring.product(ring.number(-1), root_of_number(ring, -value, degree))
        return _new_root(ring, (ex.num(value), degree), ex.num(value), ring.number(value))
    top = value.numerator * value.denominator ** (degree - 1)
    factors = [ring.number(Fraction(1, value.denominator))]
    for prime, power in prime_powers(top):
        whole, exponent = divmod(power, degree)
        factors.append(ring.number(prime**whole))
        if exponent:
            expression = ex.num(prime)
            factors.append(
                ring.power_node(_new_root(ring, (expression, degree), expression, ring.number(prime)), exponent)
            )
    return ring.product(*factors)


def prime_powers(value: int) -> list[tuple[int, int]]:
    """Prime powers of a positive integer; of one of more than 128 bits what small primes leave counts as one."""
    if value == 1:
        return []
    few = None if value.bit_length() <= 128 else TRIAL_PRIMES
    return [(int(p), int(k)) for p, k in fmpz(value).factor(trial_limit=few)]


def sign(ring: Instructions, e: Expr) -> int:
    """Return the sign of ``e``, with square 1 and derivative 0; an odd function of it."""
    if e.op == "num" and not e.is_zero:
        return ring.number(1 if e.args[0] > 0 else -1)
    if never_negative(e, ring.positive):
        return ring.number(1)
    if e.op == "mul":
        return ring.product(*(sign(ring, part) for part in e.args))
    if e.op == "pow" and e.args[1].op == "num" and e.args[1].args[0].denominator == 1:
        return ring.power_node(sign(ring, e.args[0]), abs(int(e.args[1].args[0])))
    constant_sign = _sign_of_constant(e)
    if constant_sign:
        return ring.number(constant_sign)
    if leads_with_minus(e):
        return ring.product(ring.number(-1), sign(ring, -e))
    if e.op == "add":
        number, primitive = content(e)
        if number != 1:
            return sign(ring, primitive)
    expression = ex.fn("abs", e) / e if not e.is_zero else ex.ZERO
    return ring.generator("sign", sorted_sum(e), expression, (ring.node(e),))


def _sign_of_constant(e: Expr) -> int:
    """1 or -1 where a ball tells; 0 where ``e`` is no constant or no ball tells."""
    ball = interval_of(e) if is_constant(e) else None
    if ball is None or ball.contains(0):
        return 0
    return 1 if ball > 0 else -1


def leads_with_minus(e: Expr) -> bool:
    """Return whether the first of the sorted terms has a minus sign: of ``e`` and ``-e`` one has."""
    terms = sorted_sum(e)
    return bool(terms) and terms[0][1] < 0


def inverse_function(ring: Instructions, name: str, e: Expr) -> int:
    """Return the node of asin, acos, atan or atan2 of ``e``: acos is written by asin, a sign is taken out."""
    u = e.args[1]
    if name == "acos":
        return ring.node(ex.HALF * ex.PI - ex.fn("asin", u))
    if name == "atan2":
        return ring.generator("atan2", e.args[1:], e, tuple(map(ring.node, e.args[1:])))
    if _minus(u):
        return ring.product(ring.number(-1), ring.node(ex.fn(name, -u)))
    if name == "asin":
        root = ring.node(ex.sqrt(ex.ONE - u * u))
        return ring.generator("asin", sorted_sum(u), e, (ring.node(u), root))
    return ring.generator(name, sorted_sum(u), e, (ring.node(u),))


def _minus(u: Expr) -> bool:
    """Return whether, of u and -u, this is the one that is written by the other."""
    if u.op == "num":
        return bool(u.args[0] < 0)
    return leads_with_minus(u) if u.op in ("add", "mul") else False


def log(ring: Instructions, u: Expr) -> int:
    """Return log u: of a product of positive factors the sum, of a power a multiple, of an integer over its primes."""
    if u.op == "mul":
        apart, cofactor = known_signs(ring, u)
        if apart:
            return ring.total(*(log(ring, part) for part in [*apart, *([cofactor] if cofactor != ex.ONE else [])]))
    if u.op == "pow" and (never_negative(u.args[0], ring.positive) or u.args[1].op != "num" or u.args[1].args[0] % 2):
        return ring.product(ring.node(u.args[1]), log(ring, u.args[0]))
    if u.op == "fn" and u.args[0] == "exp":
        return ring.node(u.args[1])
    if u.op == "num" and u.args[0] > 0:
        return _log_of_number(ring, u.args[0])
    return ring.generator("log", sorted_sum(u), Expr("fn", ("log", u)), (ring.node(u),))


def _log_of_number(ring: Instructions, value: Fraction) -> int:
    """Return the logarithm of a positive number over its primes."""
    logs = []
    for p, k in _primes(value):
        prime = ring.generator("log", p, Expr("fn", ("log", ex.num(p))), (ring.number(p),))
        logs.append(ring.product(ring.number(k), prime))
    return ring.total(*logs) if logs else ring.number(0)


def over_primes(u: Expr) -> Expr:
    """Return an exponent with the logarithms of numbers in its terms as sums over primes: 4^w is (e^(w log 2))^2."""
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
    """Return the primes of a positive number with their powers."""
    return prime_powers(value.numerator) + [(p, -k) for p, k in prime_powers(value.denominator)]
