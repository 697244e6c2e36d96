"""Antiderivatives by one variable: a bounded table of rules. What it finds is checked by whoever uses it."""

from __future__ import annotations

from fractions import Fraction

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.terms import expand
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.algebra import Algebra, replace
from dofkit.integrability.integrals.elementary import (
    as_power,
    collected_powers,
    of_call,
    of_exponential_wave,
    of_function,
    of_power,
    of_waves,
)
from dofkit.integrability.integrals.rational import linear, rational
from dofkit.integrability.integrals.trigonometry import powers, to_sum

MAX_DEPTH = 9
MAX_CANDIDATES = 6
_INVERSE = frozenset(("log", "atan", "asin", "acos"))
#: The variable of a substitution; no scene declares such a name.
_FRESH = ex.sym("parameter", "new variable")


def antiderivative(work: Algebra, e: Expr, x: Expr, depth: int = 0) -> Expr | None:
    """F with dF/dx = e, all other symbols held; None where no rule applies."""
    if x not in e.symbols:
        return e * x
    if depth > MAX_DEPTH:
        return None
    found = _by_terms(work, expand(e), x, depth)
    if found is not None:
        return found
    tidy = work.tidy(e)
    if tidy != e:
        if x not in tidy.symbols:
            return tidy * x
        found = _by_terms(work, expand(tidy), x, depth)
    if found is None:
        found = _total_derivative(work, e, x, depth) or rational(work, tidy, x) or _sum_by_parts(work, e, x, depth)
        found = found or _under_exponential(work, tidy, x)
    return found or _by_substitution(work, tidy, x, depth)


def _by_terms(work: Algebra, e: Expr, x: Expr, depth: int) -> Expr | None:
    if depth > MAX_DEPTH:
        return None
    parts = []
    for term in e.args if e.op == "add" else (e,):
        work.tick()
        part = _term(work, term, x, depth)
        if part is None:
            return None
        parts.append(part)
    return ex.add(*parts)


def _term(work: Algebra, term: Expr, x: Expr, depth: int) -> Expr | None:
    constants, factors = collected_powers(term, x)
    if not factors:
        return term * x
    found = _single(work, factors[0], x, depth) if len(factors) == 1 else _product(work, factors, x, depth)
    return None if found is None else ex.mul(constants, found)


# -- one factor ------------------------------------------------------------------------------------


def _single(work: Algebra, e: Expr, x: Expr, depth: int) -> Expr | None:
    if e == x:
        return x * x / 2
    if e.op == "pow":
        return of_power(work, e, x) or _inverse_by_parts(work, ex.ONE, e, x, depth)
    if e.op == "call":
        return of_call(e, x)
    if e.op != "fn":
        return None
    straight = linear(e.args[1], x) if len(e.args) == 2 else None
    if straight is not None:
        found = of_function(e.args[0], e.args[1])
        return None if found is None else found / straight[0]
    return _inverse_by_parts(work, ex.ONE, e, x, depth)


def _names(e: Expr) -> frozenset[str]:
    return frozenset(n.args[0] for n in ex.nodes(e) if n.op == "fn")


# -- products --------------------------------------------------------------------------------------


def _product(work: Algebra, factors: list[Expr], x: Expr, depth: int) -> Expr | None:
    trig = powers(factors)
    if trig is not None and len(trig) == 1:
        return of_waves(trig, x)
    total = to_sum(factors)
    if total is not None:
        return antiderivative(work, total, x, depth + 1)
    waves = of_exponential_wave(factors, x)
    if waves is not None:
        return waves
    others = [f for f in factors if as_power(f)[0] != x]
    monomial = ex.mul(*(f for f in factors if as_power(f)[0] == x))
    if len(others) == len(factors):
        return None
    if len(others) == 1:
        base, exponent = as_power(others[0])
        straight = linear(base, x)
        if straight is not None and exponent.denominator != 1:
            return _shifted(work, ex.mul(*factors), x, straight, depth)
        found = _inverse_by_parts(work, monomial, others[0], x, depth)
        if found is not None:
            return found
    return _by_parts(work, monomial, ex.mul(*others), x, depth)


def _inverse_by_parts(work: Algebra, monomial: Expr, e: Expr, x: Expr, depth: int) -> Expr | None:
    """x^n times a power of log, atan, asin or acos: the function is differentiated away."""
    base, exponent = as_power(e)
    if base.op != "fn" or base.args[0] not in _INVERSE or not 0 < exponent <= 4:
        return None
    raised = None if exponent.denominator != 1 else antiderivative(work, monomial, x, depth + 1)
    if raised is None or as_power(monomial) == (x, Fraction(-1)):
        return None
    rest = antiderivative(work, work.tidy(raised * diff(e, x)), x, depth + 1)
    return None if rest is None else raised * e - rest


def _by_parts(work: Algebra, monomial: Expr, other: Expr, x: Expr, depth: int) -> Expr | None:
    """x^n g = (x^n G)' - n x^(n-1) G for whole n > 0."""
    _, exponent = as_power(monomial)
    if exponent.denominator != 1 or not 0 < exponent <= MAX_DEPTH or _names(other) & _INVERSE:
        return None
    if not any(n.op in ("fn", "call") for n in ex.nodes(other)):
        return None
    raised = _by_terms(work, expand(other), x, depth + 1)
    if raised is None:
        return None
    rest = _by_terms(work, expand(diff(monomial, x) * raised), x, depth + 1)
    return None if rest is None else monomial * raised - rest


def _shifted(work: Algebra, e: Expr, x: Expr, straight: tuple[Expr, Expr], depth: int) -> Expr | None:
    """x^n (a x + b)^r by powers of a x + b."""
    a, b = straight
    base = a * x + b
    inside = expand(substitute(e, {x: (_FRESH - b) / a}) / a)
    inside = replace(inside, expand(substitute(base, {x: (_FRESH - b) / a})), _FRESH)
    found = antiderivative(work, work.tidy(inside), _FRESH, depth + 1)
    return None if found is None else substitute(found, {_FRESH: base})


# -- whole sums ------------------------------------------------------------------------------------


def _total_derivative(work: Algebra, e: Expr, x: Expr, depth: int) -> Expr | None:
    """Sums with derivatives of unknown functions: the highest is integrated by parts until none is left."""
    calls = [n for n in ex.nodes(e) if n.op == "call" and x in n.symbols and any(n.args[1])]
    if not calls:
        return None
    highest = max(calls, key=lambda n: sum(n.args[1]))
    name, orders, arguments = highest.args
    place = next((i for i, k in enumerate(orders) if k and x in arguments[i].symbols), None)
    if place is None or any(x in u.symbols for i, u in enumerate(arguments) if i != place):
        return None
    lower = ex.call(name, arguments, tuple(k - (i == place) for i, k in enumerate(orders)))
    coefficient = diff(replace(e, highest, _FRESH), _FRESH)
    if _FRESH in coefficient.symbols:
        return None
    coefficient = replace(work.tidy(coefficient / diff(arguments[place], x)), lower, _FRESH)
    part = antiderivative(work, coefficient, _FRESH, depth + 1)
    if part is None:
        return None
    part = replace(part, _FRESH, lower)
    rest = antiderivative(work, work.tidy(e - diff(part, x)), x, depth + 1)
    return None if rest is None else part + rest


def _under_exponential(work: Algebra, e: Expr, x: Expr) -> Expr | None:
    """P(x) exp(c x^m) with a polynomial P: Q exp(c x^m) with Q' + c m x^(m-1) Q = P, from the highest power down."""
    node = next((n for n in ex.nodes(e) if n.op == "fn" and n.args[0] == "exp" and x in n.symbols), None)
    if node is None:
        return None
    marked = replace(e, node, _FRESH)
    inside = diff(marked, _FRESH)
    (constant, powers_of_x), terms = collected_powers(node.args[1], x), _coefficients(inside, x)
    base, m = as_power(powers_of_x[0])
    if len(powers_of_x) != 1 or base != x or m.denominator != 1 or not 2 <= m <= 4 or terms is None:
        return None
    if _FRESH in inside.symbols or not work.vanishes(marked - inside * _FRESH):
        return None
    total, step = [], int(m)
    for n in range(max(terms), step - 2, -1):
        q = terms.pop(n, ex.ZERO) / (constant * step)
        total.append(q * x ** (n - step + 1))
        if n - step >= 0:
            terms[n - step] = terms.get(n - step, ex.ZERO) - q * (n - step + 1)
    return ex.add(*total) * node if all(map(work.vanishes, terms.values())) else None


def _coefficients(e: Expr, x: Expr) -> dict[int, Expr] | None:
    """A polynomial in x by powers; None for anything else."""
    found: dict[int, Expr] = {}
    total = expand(e)
    for term in total.args if total.op == "add" else (total,):
        constant, factors = collected_powers(term, x)
        base, k = as_power(factors[0]) if factors else (x, Fraction(0))
        if len(factors) > 1 or base != x or k.denominator != 1 or not 0 <= k <= 12:
            return None
        found[int(k)] = found.get(int(k), ex.ZERO) + constant
    return found


def _sum_by_parts(work: Algebra, e: Expr, x: Expr, depth: int) -> Expr | None:
    """c A + c0 with A a logarithm or an inverse function: G A + the antiderivative of c0 - G A', G' = c."""
    inverse = [n for n in ex.nodes(e) if n.op == "fn" and n.args[0] in _INVERSE and x in n.symbols]
    for node in inverse[:2]:
        marked = replace(e, node, _FRESH)
        coefficient = diff(marked, _FRESH)
        if _FRESH in coefficient.symbols or coefficient == ex.ONE:
            continue
        raised = antiderivative(work, work.tidy(coefficient), x, depth + 2)
        if raised is None:
            continue
        rest = work.tidy(substitute(marked, {_FRESH: ex.ZERO}) - raised * diff(node, x))
        found = antiderivative(work, rest, x, depth + 2)
        if found is not None:
            return raised * node + found
    return None


def _by_substitution(work: Algebra, e: Expr, x: Expr, depth: int) -> Expr | None:
    """e dx = g(u) du for a function u that occurs in e, or a power of x."""
    inner = [n for n in ex.nodes(e) if x in n.symbols and n != e and n.op in ("fn", "call")]
    inner += [ex.fn("sin", n.args[1]) for n in inner if n.op == "fn" and n.args[0] == "cos"]
    for u in dict.fromkeys(inner[:MAX_CANDIDATES]):
        slope = diff(u, x)
        if x not in slope.symbols:
            continue
        inside = replace(work.tidy(e / slope), u, _FRESH)
        if u.op == "fn" and u.args[0] == "sin":
            inside = replace(inside, ex.fn("cos", u.args[1]) ** 2, 1 - _FRESH**2)
        if x not in inside.symbols:
            found = antiderivative(work, inside, _FRESH, depth + 2)
            if found is not None:
                return replace(found, _FRESH, u)
    for k in (2, 3):
        inside = work.tidy(e / (k * x ** (k - 1)))
        inside = work.tidy(substitute(inside, {x: ex.power(_FRESH, ex.num(Fraction(1, k)))}))
        if not any(n.op == "pow" and n.args == (_FRESH, ex.num(Fraction(1, k))) for n in ex.nodes(inside)):
            found = antiderivative(work, inside, _FRESH, depth + 3)
            if found is not None:
                return _power_for_fresh(found, x, k)
    return None


def _power_for_fresh(e: Expr, x: Expr, k: int) -> Expr:
    """x^k for the new variable, x^(k r) for its power r."""
    for node in list(ex.nodes(e)):
        if node.op == "pow" and node.args[0] == _FRESH and node.args[1].op == "num":
            e = replace(e, node, ex.power(x, k * node.args[1]))
    return substitute(e, {_FRESH: x**k})
