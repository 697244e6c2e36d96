"""Roots, signs, logarithms and inverse functions as a ring writes them: over primes, of factors, of one sign."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from flint import Ordering, fmpq, fmpq_mpoly_ctx, fmpz, fmpz_poly
from flint.utils.flint_exceptions import DomainError

from dofkit.exact.ring.program import Instructions
from dofkit.expressions import tree as ex
from dofkit.expressions.enclosures import interval_of, is_constant
from dofkit.expressions.terms import content, linear_terms, sorted_sum
from dofkit.expressions.tree import Expr

#: Sums of more terms than this are not looked at for a square.
MAX_SQUARE = 40
Key = tuple[Any, int]


def root(ring: Instructions, radicand: Expr, degree: int) -> int:
    """The real ``degree``-th root; of a product, the product of the roots; of an integer, over its primes."""
    if radicand.op == "mul":
        apart, rest = known_signs(ring, radicand)
        if degree % 2:
            apart, rest = list(radicand.args), ex.ONE
        if rest.op != "mul" or apart:
            parts = [*apart, *([rest] if rest != ex.ONE else [])]
            return ring.product(*(root(ring, part, degree) for part in parts))
    if radicand.op == "pow" and radicand.args[1].op == "num":
        return _root_of_power(ring, radicand, degree)
    if radicand.op == "num":
        return root_of_number(ring, radicand.args[0], degree)
    if radicand.op == "add":
        return _root_of_sum(ring, radicand, degree)
    return _new_root(ring, (sorted_sum(radicand), degree), radicand, ring.node(radicand))


def _root_of_sum(ring: Instructions, radicand: Expr, degree: int) -> int:
    number, rest = content(radicand)
    if number != 1:
        return ring.product(root_of_number(ring, number, degree), root(ring, rest, degree))
    undone = _undone(radicand, degree)
    if undone is not None:
        return ring.node(undone)
    base = square_root(ring, radicand) if degree == 2 else None
    if base is not None:
        return ring.product(sign(ring, base), ring.node(base))
    return _new_root(ring, (sorted_sum(radicand), degree), radicand, ring.node(radicand))


def known_signs(ring: Instructions, product: Expr) -> tuple[list[Expr], Expr]:
    """(factors that are never negative, the product of the others): only those have roots and logs of their own."""
    apart: list[Expr] = []
    rest: list[Expr] = []
    for part in product.args:
        (apart if never_negative(ring, part) else rest).append(part)
    number = next((p for p in rest if p.op == "num"), None)
    if number is not None and number.args[0] != -1:
        apart.append(ex.num(abs(number.args[0])))
        rest = [ex.MINUS_ONE if p is number else p for p in rest]
    return apart, Expr("mul", tuple(rest)) if len(rest) > 1 else rest[0] if rest else ex.ONE


def never_negative(ring: Instructions, part: Expr) -> bool:
    """Is it >= 0 by its form, wherever it is defined?"""
    if part.op == "num":
        return bool(part.args[0] > 0)
    if part in ring.positive or part.op == "const" or (part.op == "fn" and part.args[0] in ("exp", "abs", "cosh")):
        return True
    if part.op in ("add", "mul"):
        return all(never_negative(ring, p) for p in part.args)
    if part.op != "pow":
        return False
    if part.args[1].op != "num":
        return never_negative(ring, part.args[0])
    exponent: Fraction = part.args[1].args[0]
    return exponent.denominator % 2 == 0 or exponent.numerator % 2 == 0 or never_negative(ring, part.args[0])


def _new_root(ring: Instructions, key: Key, radicand: Expr, node: int) -> int:
    shown = Expr("pow", (radicand, ex.num(Fraction(1, key[1]))))
    return ring.generator("root", key, shown, (node,), key[1])


def _root_of_power(ring: Instructions, radicand: Expr, degree: int) -> int:
    base, exponent = radicand.args[0], radicand.args[1].args[0]
    whole, rest = divmod(exponent / degree, 1)
    even_inside = exponent.denominator == 1 and exponent % 2 == 0 and degree % 2 == 0
    if rest == 0:
        power = ring.power_node(ring.node(base), int(whole))
        return ring.product(power, ring.power_node(sign(ring, base), abs(int(whole)))) if even_inside else power
    reduced = Fraction(exponent, degree)
    if even_inside and not never_negative(ring, base):
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
    parts = [ring.number(Fraction(1, value.denominator))]
    for prime, power in prime_powers(top):
        whole, rest = divmod(power, degree)
        parts.append(ring.number(prime**whole))
        if rest:
            shown = ex.num(prime)
            parts.append(ring.power_node(_new_root(ring, (shown, degree), shown, ring.number(prime)), rest))
    return ring.product(*parts)


def prime_powers(value: int) -> list[tuple[int, int]]:
    """Prime powers of a positive integer; a part without small factors beyond 64 bits counts as one."""
    if value == 1:
        return []
    if value.bit_length() <= 128:
        return [(int(p), int(k)) for p, k in fmpz(value).factor()]
    powers, rest = [], value
    for prime in (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37):
        k = 0
        while rest % prime == 0:
            rest, k = rest // prime, k + 1
        if k:
            powers.append((prime, k))
    return [*powers, (rest, 1)] if rest > 1 else powers


def sign(ring: Instructions, e: Expr) -> int:
    """The sign of ``e``, with square 1 and derivative 0; an odd function of it."""
    if e.op == "num" and not e.is_zero:
        return ring.number(1 if e.args[0] > 0 else -1)
    if never_negative(ring, e):
        return ring.number(1)
    if e.op == "mul":
        return ring.product(*(sign(ring, part) for part in e.args))
    if e.op == "pow" and e.args[1].op == "num" and e.args[1].args[0].denominator == 1:
        return ring.power_node(sign(ring, e.args[0]), abs(int(e.args[1].args[0])))
    known = _sign_of_constant(e)
    if known:
        return ring.number(known)
    if leads_with_minus(e):
        return ring.product(ring.number(-1), sign(ring, -e))
    if e.op == "add":
        number, rest = content(e)
        if number != 1:
            return sign(ring, rest)
    shown = ex.fn("abs", e) / e if not e.is_zero else ex.ZERO
    return ring.generator("sign", sorted_sum(e), shown, (ring.node(e),))


def _sign_of_constant(e: Expr) -> int:
    """1 or -1 where a ball tells; 0 where ``e`` is no constant or no ball tells."""
    found = interval_of(e) if is_constant(e) else None
    if found is None or found.contains(0):
        return 0
    return 1 if found > 0 else -1


def leads_with_minus(e: Expr) -> bool:
    """Has the first of the sorted terms a minus sign? Of ``e`` and ``-e`` one has."""
    terms = sorted_sum(e)
    return bool(terms) and terms[0][1] < 0


# -- nested roots ----------------------------------------------------------------------------------


def _undone(radicand: Expr, degree: int) -> Expr | None:
    """The root of a + b sqrt(c) as a sum of simpler roots, where it is one; a, b, c are rational."""
    parts = _quadratic_number(radicand)
    if parts is None or degree not in (2, 3):
        return None
    return _square_root_of(*parts) if degree == 2 else _cubic_root_of(*parts)


def _quadratic_number(e: Expr) -> tuple[Fraction, Fraction, Fraction] | None:
    """(a, b, c) of a + b sqrt(c)."""
    terms = linear_terms(e)
    surds = [(rest, factor) for rest, factor in terms.items() if rest != ex.ONE]
    if len(surds) != 1 or len(terms) > 2:
        return None
    rest, b = surds[0]
    if rest.op != "pow" or rest.args[1] != ex.HALF or rest.args[0].op != "num" or rest.args[0].args[0] <= 0:
        return None
    return terms.get(ex.ONE, Fraction(0)), b, rest.args[0].args[0]


def _square_root_of(a: Fraction, b: Fraction, c: Fraction) -> Expr | None:
    """sqrt(x) +- sqrt(y) with x + y = a and 4 x y = b^2 c."""
    r = _rational_root(a * a - b * b * c, 2)
    if a <= 0 or r is None:
        return None
    larger, smaller = (ex.sqrt(ex.num(v)) for v in ((a + r) / 2, (a - r) / 2))
    return larger + smaller if b > 0 else larger - smaller


def _cubic_root_of(a: Fraction, b: Fraction, c: Fraction) -> Expr | None:
    """x + y sqrt(c) with (x + y sqrt(c))^3 = a + b sqrt(c): x is a root of 4 x^3 - 3 n x - a, n^3 = a^2 - b^2 c."""
    n = _rational_root(a * a - b * b * c, 3)
    if n is None:
        return None
    for x in _rational_zeros([-a, -3 * n, Fraction(0), Fraction(4)]):
        below = 4 * x * x - n
        if below and x**3 + 3 * x * (b / below) ** 2 * c == a and 3 * x * x * (b / below) + (b / below) ** 3 * c == b:
            return ex.num(x) + ex.num(b / below) * ex.sqrt(ex.num(c))
    return None


def _rational_root(value: Fraction, degree: int) -> Fraction | None:
    found = ex.power(ex.num(abs(value)), ex.num(Fraction(1, degree)))
    if found.op != "num" or (value < 0 and degree % 2 == 0):
        return None
    root_of: Fraction = found.args[0]
    return root_of if value >= 0 else -root_of


def _rational_zeros(coefficients: list[Fraction]) -> list[Fraction]:
    """Of a polynomial, by the linear factors over the rationals."""
    below = 1
    for v in coefficients:
        below *= v.denominator
    poly = fmpz_poly([int(v * below) for v in coefficients])
    return [Fraction(int(-f[0]), int(f[1])) for f, _ in poly.factor()[1] if f.degree() == 1]


# -- squares of sums -------------------------------------------------------------------------------


def square_root(ring: Instructions, radicand: Expr) -> Expr | None:
    """f where the radicand is f^2: a polynomial in symbols and functions, in the square roots of positive symbols."""
    terms = linear_terms(radicand)
    if not 3 <= len(terms) <= MAX_SQUARE:
        return None
    table: list[tuple[dict[Expr, int], Fraction]] = []
    for rest, factor in terms.items():
        monomial = _monomial(ring, rest)
        if monomial is None:
            return None
        table.append((monomial, factor))
    atoms = sorted({a for monomial, _ in table for a in monomial}, key=repr)
    context = fmpq_mpoly_ctx.get(tuple(f"a{i}" for i in range(len(atoms))), Ordering.lex)
    polynomial = context.from_dict(
        {tuple(m.get(a, 0) for a in atoms): fmpq(f.numerator, f.denominator) for m, f in table}
    )
    try:
        found = polynomial.sqrt()
    except DomainError:
        return None
    shown = []
    for exponents, value in found.to_dict().items():
        factors = [ex.power(a, ex.num(int(k))) for a, k in zip(atoms, exponents, strict=True) if k]
        shown.append(ex.mul(ex.num(Fraction(int(value.p), int(value.q))), *factors))
    return ex.add(*shown)


def _monomial(ring: Instructions, term: Expr) -> dict[Expr, int] | None:
    """A product as powers of atoms; those of positive symbols are their square roots."""
    found: dict[Expr, int] = {}
    for part in () if term == ex.ONE else term.args if term.op == "mul" else (term,):
        inner = _monomial_of_power(ring, part)
        if inner is None:
            return None
        for atom, k in inner.items():
            found[atom] = found.get(atom, 0) + k
    return found


def _monomial_of_power(ring: Instructions, part: Expr) -> dict[Expr, int] | None:
    base, exponent = part, Fraction(1)
    if part.op == "pow" and part.args[1].op == "num":
        base, exponent = part.args[0], part.args[1].args[0]
    if base.op == "mul" and exponent == Fraction(1, 2) and all(p in ring.positive for p in base.args):
        return {ex.sqrt(p): 1 for p in base.args}
    if base in ring.positive:
        atom, exponent = ex.sqrt(base), 2 * exponent
    else:
        atom = base
    if base.op in ("num", "add") or exponent.denominator != 1 or exponent < 0:
        return None
    return {atom: int(exponent)}


def inverse_function(ring: Instructions, name: str, e: Expr) -> int:
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


def _atan2(ring: Instructions, e: Expr) -> int:
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


def log(ring: Instructions, u: Expr, split: bool) -> int:
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


def _log_of_size(ring: Instructions, u: Expr) -> int:
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


def log_of_number(ring: Instructions, value: Fraction) -> int:
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


def _log_of_prime(ring: Instructions, prime: int) -> int:
    return ring.generator("log", prime, Expr("fn", ("log", ex.num(prime))), (ring.number(prime),))
