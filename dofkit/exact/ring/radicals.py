"""Roots, signs, logarithms and inverse functions as nodes of a ring, split into products, primes and signs."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal

from flint import fmpz

from dofkit.exact.ring.program import Instructions
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import content, sorted_sum
from dofkit.expressions.enclosures import interval_of, is_constant
from dofkit.expressions.tree import Expr

Key = tuple[Any, int]
#: Integers of more than 128 bits are divided by so many small primes only.
TRIAL_PRIMES = 12


def root(ring: Instructions, radicand: Expr, degree: int) -> int:
    """Return the node of the real ``degree``-th root; a product is split into factors, an integer into its primes.

    An even root is not split between factors of unknown sign, because sqrt(a b) = sqrt(a) sqrt(b) needs a, b >= 0.
    """
    if radicand.op == "mul":
        nonnegative, cofactor = known_signs(ring, radicand)
        if degree % 2:
            nonnegative, cofactor = list(radicand.args), ex.ONE
        if cofactor.op != "mul" or nonnegative:
            factors = [*nonnegative, *([cofactor] if cofactor != ex.ONE else [])]
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
    """Return (factors that are never negative, product of the others); -3 x counts as the factor 3 and -x."""
    nonnegative: list[Expr] = []
    signed: list[Expr] = []
    for part in product.args:
        (nonnegative if never_negative(part, ring.positive) else signed).append(part)
    number = next((p for p in signed if p.op == "num"), None)
    if number is not None and number.args[0] != -1:
        nonnegative.append(ex.num(abs(number.args[0])))
        signed = [ex.MINUS_ONE if p is number else p for p in signed]
    return nonnegative, Expr("mul", tuple(signed)) if len(signed) > 1 else signed[0] if signed else ex.ONE


def never_negative(part: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether the form of ``part`` shows that it is >= 0 wherever it is defined."""
    return sense_of(part, positive) is not None


def sense_of(e: Expr, positive: frozenset[Expr]) -> Literal[">", ">="] | None:
    """Return ">" or ">=" if the form of ``e`` shows that it is > 0 or >= 0 wherever it has a value; otherwise None."""
    if e in positive or e.op == "const" or (e.op == "num" and e.args[0] > 0):
        return ">"
    if e.op == "fn":
        return ">" if e.args[0] in ("exp", "cosh") else ">=" if e.args[0] in ("abs", "acos") else None
    if e.op in ("add", "mul"):
        senses = {sense_of(part, positive) for part in e.args}
        strict = ">" in senses if e.op == "add" else senses == {">"}
        return None if None in senses else ">" if strict else ">="
    if e.op != "pow":
        return None
    sense, exponent = sense_of(e.args[0], positive), e.args[1]
    if exponent.op != "num" or sense == ">":
        return sense
    even = exponent.args[0].denominator % 2 == 0 or exponent.args[0].numerator % 2 == 0
    return None if not even and sense is None else ">" if exponent.args[0] < 0 else ">="


def _new_root(ring: Instructions, key: Key, radicand: Expr, node: int) -> int:
    expression = Expr("pow", (radicand, ex.num(Fraction(1, key[1]))))
    return ring.generator("root", key, expression, (node,), key[1])


def _root_of_power(ring: Instructions, radicand: Expr, degree: int) -> int:
    """Return the node of a root of base^exponent, with |base| or a sign where the exponent is even."""
    base, exponent = radicand.args[0], radicand.args[1].args[0]
    whole, fraction = divmod(exponent / degree, 1)
    even_inside = exponent.numerator % 2 == 0 and degree % 2 == 0
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
    """Return the node of the real root of a number, as a product of roots of primes."""
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
    """Return (prime, exponent) pairs of a positive integer; of a long one the cofactor of small primes stays whole."""
    if value == 1:
        return []
    few = None if value.bit_length() <= 128 else TRIAL_PRIMES
    return [(int(p), int(k)) for p, k in fmpz(value).factor(trial_limit=few)]


def sign(ring: Instructions, e: Expr) -> int:
    """Return the node of the sign of ``e``, which has the square 1 and the derivative 0; sign(-e) = -sign(e)."""
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
    """Return 1 or -1 if a ball proves this sign; 0 if ``e`` is not constant or its ball contains 0."""
    ball = interval_of(e) if is_constant(e) else None
    if ball is None or ball.contains(0):
        return 0
    return 1 if ball > 0 else -1


def leads_with_minus(e: Expr) -> bool:
    """Return whether the first of the sorted terms has a minus sign, which is so for exactly one of ``e``, ``-e``."""
    terms = sorted_sum(e)
    return bool(terms) and terms[0][1] < 0


def inverse_function(ring: Instructions, name: str, e: Expr) -> int:
    """Return the node of ``e`` = asin u, atan u, atan2(y, x) or acos u = pi/2 - asin u; asin(-u) becomes -asin u."""
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
    """Return whether an odd function of u is written as minus that of -u."""
    if u.op == "num":
        return bool(u.args[0] < 0)
    return leads_with_minus(u) if u.op in ("add", "mul") else False


def log(ring: Instructions, u: Expr) -> int:
    """Return the node of log u; a product of positive factors, a power and a rational number are expanded."""
    if u.op == "mul":
        positive, cofactor = known_signs(ring, u)
        if positive:
            return ring.total(*(log(ring, part) for part in [*positive, *([cofactor] if cofactor != ex.ONE else [])]))
    odd = u.op == "pow" and (u.args[1].op != "num" or u.args[1].args[0].numerator % 2)
    if odd or (u.op == "pow" and never_negative(u.args[0], ring.positive)):
        return ring.product(ring.node(u.args[1]), log(ring, u.args[0]))
    if u.op == "fn" and u.args[0] == "exp":
        return ring.node(u.args[1])
    if u.op == "num" and u.args[0] > 0:
        return _log_of_number(ring, u.args[0])
    return ring.generator("log", sorted_sum(u), Expr("fn", ("log", u)), (ring.node(u),))


def _log_of_number(ring: Instructions, value: Fraction) -> int:
    """Return the node of the logarithm of a positive number, as a sum over its primes."""
    logs = []
    for p, k in _primes(value):
        prime = ring.generator("log", p, Expr("fn", ("log", ex.num(p))), (ring.number(p),))
        logs.append(ring.product(ring.number(k), prime))
    return ring.total(*logs) if logs else ring.number(0)


def over_primes(u: Expr) -> Expr:
    """Return an exponent with logarithms of numbers expanded over primes, so that 4^w becomes (e^(w log 2))^2."""
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
    """Return (prime, exponent) pairs of a positive rational number, with negative exponents in the denominator."""
    return prime_powers(value.numerator) + [(p, -k) for p, k in prime_powers(value.denominator)]
