"""A relation in one combination of velocities, solved for it: exp(xdot) = y says xdot = log(y).

All of its velocities stand in one combination w = sum c_i(q, t) qdot_i. Where w stands in one place, functions are
undone from the outside in; each step says what the other side must satisfy. Where it stands inside one function only,
the relation is first solved for that function's value, as a polynomial of degree 2. What has infinitely many roots
(sin w = 0), or roots that no formula gives, is left.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero.identity import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition, constantly
from dofkit.relations.normal.inverse_functions import Root, inverse_of, positive_or_zero
from dofkit.relations.normal.semidefinite import never_holds

#: The combination of velocities, while it is solved for; no scene declares such a name.
RATE = ex.sym("parameter", "the rate")
_INSIDE = ex.sym("parameter", "what is inside")
#: Functions that are undone one inside the other.
MAX_DEPTH = 8
MAX_ROOTS = 8


def rates(e: Expr) -> list[Expr]:
    """The velocity symbols of an expression."""
    return sorted((s for s in e.symbols if s.args[0] == "velocity"), key=repr)


def in_one_rate(e: Expr, positive: frozenset[Expr]) -> bool:
    """Do all velocities stand in one combination of them?"""
    return _in_one_rate(e, positive) is not None


def velocity_branches(e: Expr, positive: frozenset[Expr]) -> list[tuple[Expr, tuple[DomainCondition, ...]]] | None:
    """The branches of ``e = 0``, each linear in the velocities, with its conditions; None where they were not found."""
    found = _in_one_rate(e, positive)
    if found is None:
        return None
    relation, combination = found
    roots = _roots(relation, RATE, 0)
    if roots is None:
        return None
    branches = []
    for root in roots:
        told = {c: constantly(c, positive) for c in root.conditions}
        if any(t is None and not _moves(c.expr) for c, t in told.items()):
            return None
        if False not in told.values() and not any(_never(c, positive) for c in told):
            branches.append((combination - root.value, tuple(c for c, t in told.items() if t is None)))
    return branches


def _never(c: DomainCondition, positive: frozenset[Expr]) -> bool:
    return c.sense != "!=" and never_holds(c.expr, c.strict, positive)


def _moves(e: Expr) -> bool:
    return any(s.args[0] != "parameter" for s in e.symbols)


# -- one combination ----------------------------------------------------------------------------------


def _in_one_rate(e: Expr, positive: frozenset[Expr]) -> tuple[Expr, Expr] | None:
    """(``e`` in `RATE`, the combination that it stands for); None where there are several."""
    parts = list(dict.fromkeys(_linear_parts(e)))
    if not parts:
        return None
    first = _coefficients(parts[0])
    if not first:
        return None
    v = next((s for s, c in first.items() if c.op == "num"), next(iter(first)))
    combination = ex.add(*(c / first[v] * s for s, c in first.items()))
    mapping: dict[Expr, Expr] = {}
    for part in parts:
        own = _coefficients(part)
        if set(own) != set(first):
            return None
        if any(not is_proved_zero(own[s] * first[v] - own[v] * c, positive) for s, c in first.items()):
            return None
        mapping[part] = own[v] * RATE + substitute(part, dict.fromkeys(rates(part), ex.ZERO))
    return _replaced(e, mapping), combination


def _linear_parts(e: Expr) -> Iterator[Expr]:
    """The largest parts that are linear in the velocities; of a sum, its linear terms together."""
    if not rates(e):
        return
    if _is_linear(e):
        yield e
        return
    if e.op == "add":
        linear = _linear_terms(e)
        if linear:
            yield ex.add(*linear)
    for part in ex.children(e):
        if e.op != "add" or not (rates(part) and _is_linear(part)):
            yield from _linear_parts(part)


def _linear_terms(e: Expr) -> list[Expr]:
    return [term for term in e.args if rates(term) and _is_linear(term)]


def _is_linear(e: Expr) -> bool:
    return all(not rates(diff(e, v)) for v in rates(e))


def _coefficients(part: Expr) -> dict[Expr, Expr]:
    """The coefficients of velocities in a linear part, less those of terms that cancel."""
    return {v: c for v in rates(part) if not (c := diff(part, v)).is_zero}


def _replaced(e: Expr, mapping: dict[Expr, Expr]) -> Expr:
    """``e`` with linear parts replaced; the linear terms of a sum are one part."""
    if e in mapping:
        return mapping[e]
    if not rates(e):
        return e
    if e.op == "add":
        linear = _linear_terms(e)
        others = [_replaced(term, mapping) for term in e.args if term not in linear]
        return ex.add(*others, *([mapping[ex.add(*linear)]] if linear else []))
    return ex.rebuild(e, tuple(_replaced(part, mapping) for part in ex.children(e)))


# -- its roots ----------------------------------------------------------------------------------------


def _roots(e: Expr, unknown: Expr, depth: int) -> list[Root] | None:
    """The real roots of ``e = 0`` in the unknown."""
    slope = diff(e, unknown)
    if unknown not in slope.symbols:
        if is_proved_zero(slope, frozenset()):
            return None
        return [Root(-substitute(e, {unknown: ex.ZERO}) / slope, _apart(slope))]
    if depth > MAX_DEPTH:
        return None
    inner = _sole_function(e, unknown)
    if inner is not None and inner != e:
        outside = _outside(e, inner)
        values = None if unknown in outside.symbols else _polynomial_roots(outside)
        return None if values is None else _each(values, inner, unknown, depth)
    if inner is None and depth == 0:
        rewritten = _numerator(e)
        if rewritten is not None and rewritten != e:
            return _roots(rewritten, unknown, 1)
    return (
        _polynomial_roots(substitute(e, {unknown: _INSIDE}))
        if inner is None
        else _each([Root(ex.ZERO)], inner, unknown, depth)
    )


def _numerator(e: Expr) -> Expr | None:
    """``e`` as a polynomial in its functions, where it has exponentials below the line only: exp(-w) is 1/exp(w)."""
    try:
        ring = Ring([e])
        node = ring.node(e)
        canon = Canon(ring)
        top, bottom = canon.quotient(node)
    except NoValueError:
        return None
    harmless = all(ring.vars[i].kind == "exp" for i in canon.generators_in(bottom)) and len(bottom) == 1
    return canon.to_expr(top) if harmless else None


def _each(values: Sequence[Root], inner: Expr, unknown: Expr, depth: int) -> list[Root] | None:
    """The unknown from every value that the function around it may have."""
    found: list[Root] = []
    for value in values:
        undone = _undone(inner, value.value, unknown, depth)
        if undone is None or len(found) + len(undone) > MAX_ROOTS:
            return None
        found += [Root(r.value, (*value.conditions, *r.conditions)) for r in undone]
    return found


def _sole_function(e: Expr, unknown: Expr) -> Expr | None:
    """The outermost function, or root, that every occurrence of the unknown is in."""
    found: list[Expr] = []

    def look(node: Expr) -> None:
        if unknown not in node.symbols:
            return
        if node == unknown or _is_function(node):
            found.append(node)
            return
        for part in ex.children(node):
            look(part)

    look(e)
    different = set(found)
    return different.pop() if len(different) == 1 and unknown not in different else None


def _is_function(node: Expr) -> bool:
    if node.op in ("fn", "call"):
        return True
    return node.op == "pow" and (node.args[1].op != "num" or node.args[1].args[0].denominator > 1)


def _outside(e: Expr, inner: Expr) -> Expr:
    if e == inner:
        return _INSIDE
    parts = ex.children(e)
    return ex.rebuild(e, tuple(_outside(part, inner) for part in parts)) if parts else e


def _polynomial_roots(e: Expr) -> list[Root] | None:
    """Of what is linear, quadratic or a single power in `_INSIDE`, cleared of a denominator that is a power of it."""
    z = _INSIDE
    terms = [_power_term(term) for term in (e.args if e.op == "add" else (e,))]
    if any(t is None for t in terms):
        return None
    table: dict[int, Expr] = {}
    for t in terms:
        if t is not None:
            table[t[0]] = table.get(t[0], ex.ZERO) + t[1]
    table = {k: c for k, c in table.items() if not c.is_zero}
    if not table or any(z in c.symbols for c in table.values()):
        return None
    low = min(table)
    powers = {k - low: c for k, c in table.items()}
    zero = [Root(ex.ZERO)] if low > 0 else []
    n = max(powers)
    others: list[Root] | None = None
    if len(powers) == 1:
        others = []
    elif len(powers) == 2:
        others = _radicals(-powers[0] / powers[n], n)
    elif set(powers) == {0, 1, 2}:
        a, b, c = powers[2], powers[1], powers[0]
        inside = b * b - 4 * a * c
        others = [Root((-b + s * ex.sqrt(inside)) / (2 * a), positive_or_zero(inside)) for s in (1, -1)]
    return None if others is None else [Root(r.value, (*r.conditions, *_apart(powers[n]))) for r in zero + others]


def _apart(divisor: Expr) -> tuple[DomainCondition, ...]:
    """Where a solution was divided by what moves: where that is 0 the relation says something else, or nothing."""
    return (DomainCondition(divisor, "!=", True),) if _moves(divisor) else ()


def _power_term(term: Expr) -> tuple[int, Expr] | None:
    """(n, c) of a term c z^n."""
    n, rest = 0, []
    for factor in term.args if term.op == "mul" else (term,):
        if _INSIDE not in factor.symbols:
            rest.append(factor)
        elif factor == _INSIDE:
            n += 1
        elif factor.op == "pow" and factor.args[0] == _INSIDE and factor.args[1].op == "num":
            exponent = factor.args[1].args[0]
            if exponent.denominator != 1:
                return None
            n += int(exponent)
        else:
            return None
    return n, ex.mul(*rest) if rest else ex.ONE


def _radicals(value: Expr, n: int) -> list[Root]:
    """z with z^n = value."""
    root = ex.power(value, ex.num(Fraction(1, n)))
    if n % 2:
        return [Root(root)]
    if value.is_zero:
        return [Root(ex.ZERO)]
    return [Root(root, positive_or_zero(value)), Root(-root, positive_or_zero(value))]


def _undone(node: Expr, value: Expr, unknown: Expr, depth: int) -> list[Root] | None:
    """The unknown where a function of it has a value."""
    if node.op == "call" or (node.op == "fn" and len(node.args) != 2):
        return None
    if node.op == "pow":
        return _undone_power(node, value, unknown, depth)
    inverse = inverse_of(node.args[0], value)
    return None if inverse is None else _all_inside(inverse, node.args[1], unknown, depth)


def _all_inside(values: Sequence[Root], inside: Expr, unknown: Expr, depth: int) -> list[Root] | None:
    found: list[Root] = []
    for v in values:
        deeper = _roots(inside - v.value, unknown, depth + 1)
        if deeper is None or len(found) + len(deeper) > MAX_ROOTS:
            return None
        found += [Root(r.value, (*v.conditions, *r.conditions)) for r in deeper]
    return found


def _undone_power(node: Expr, value: Expr, unknown: Expr, depth: int) -> list[Root] | None:
    """base^(p/q) = value, or base^exponent = value for a base free of the unknown."""
    base, exponent = node.args
    if exponent.op != "num":
        if unknown in base.symbols:
            return None
        logs = [Root(ex.fn("log", value) / ex.fn("log", base), (DomainCondition(value, ">"),))]
        return _all_inside(logs, exponent, unknown, depth)
    power: Fraction = exponent.args[0]
    if power.denominator % 2 == 0:
        return _all_inside([Root(ex.power(value, ex.num(1 / power)), positive_or_zero(value))], base, unknown, depth)
    roots = _radicals(value if power > 0 else 1 / value, abs(power.numerator))
    raised = [Root(ex.power(r.value, ex.num(power.denominator)), r.conditions) for r in roots]
    return _all_inside(raised, base, unknown, depth)
