"""Relations without a real solution: a proof by exclusion.

All of space is cut into boxes; a box goes where the relations, run over it in intervals, leave nothing [Moore1966].
Where every box goes there is no solution. Three descriptions of the same set are tried, all of which only forget: the
relations as written; polynomials in their generators, with their linear combinations and resultants; and those in
projective charts, x = 1/w and x_j = u_j/w, which are compact, so that a form that is definite at infinity is seen to be
so.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, islice
from typing import Any

from flint import arb, ctx, fmpq_mat, fmpz_poly

from dofkit.base.deadline import check
from dofkit.exact.boxes import NON_NEGATIVE, UNIT, WHOLE, Box, BoxProgram, EmptyError, Interval, bounds, middle
from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.program import Var
from dofkit.exact.ring.radicals import known_signs
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.normal.zero_set import never_vanishes

#: Steps of programs over boxes that one search may take; bits of the balls behind them.
MAX_STEPS, BITS = 60_000, 64
#: So many before polynomials are tried, which tell at once what boxes tell slowly: nested circles of nearly one radius.
SOON = 6_000
#: A box thinner than this, or this far out, is not cut any further.
THINNEST, FARTHEST = 1e-7, 1e7
#: Polynomials are combined up to this size.
MAX_TABLE, MAX_RESULTANT_TERMS, MAX_RESULTANT_DEGREE = 4000, 40, 8
#: Pairs of polynomials of which resultants are taken.
MAX_PAIRS = 60
#: Projective charts are tried for up to this many unbounded unknowns.
MAX_CHARTS = 6
ZERO: Interval = (0.0, 0.0)

#: An expression and where its value must lie.
Wanted = tuple[Expr, Interval]


def no_solution(relations: Sequence[Expr], positive: frozenset[Expr], conditions: Sequence[Expr] = ()) -> bool:
    """True where ``relations`` (= 0) and ``conditions`` (>= 0) are proved to hold together at no real point.

    Parameters may have any value (those of ``positive`` a positive one), unknown functions as well. False says nothing.
    """
    wanted = [(e, ZERO) for e in relations] + [(e, NON_NEGATIVE) for e in conditions]
    if not wanted:
        return False
    ranges = dict.fromkeys(positive, NON_NEGATIVE)
    with ctx.workprec(BITS):
        try:
            soon = _excluded(wanted, ranges, SOON)
            system = None if soon else _system(relations, positive)
            excluded = _excluded(wanted, ranges) if soon is None else soon
            return bool(excluded or (system is not None and _algebraically(system, excluded is None)))
        except EmptyError:
            return True
        except NoValueError:
            return False


def hold_nowhere(relations: Sequence[Expr], conditions: Sequence[DomainCondition], positive: frozenset[Expr]) -> bool:
    """Return whether it is proved that ``conditions`` hold together at no real point at which ``relations`` are 0.

    u > 0 is written u s^2 = 1 for some s, and u != 0 is u s = 1.
    """
    if any(never_holds(c.expr, c.strict, positive) for c in conditions if c.sense != "!="):
        return True
    slacks = [ex.coordinate(f"_slack {k}") for k in range(len(conditions))]
    strict = [
        c.expr * s * (s if c.strict else ex.ONE) - ex.ONE
        for c, s in zip(conditions, slacks, strict=True)
        if c.sense != ">="
    ]
    return no_solution([*relations, *strict], positive, [c.expr for c in conditions if c.sense != "!="])


def _excluded(wanted: Sequence[Wanted], ranges: Mapping[Expr, Interval], steps: int = MAX_STEPS) -> bool | None:
    """Branch and prune: is every box of the whole excluded within the bounds? False: one shrinks to a point."""
    try:
        relations = BoxProgram(wanted)
        boxes: list[Box] = [relations.contract([ranges.get(v, WHOLE) for v in relations.variables])]
    except EmptyError:
        return True
    while relations.work < steps:
        check()
        if not boxes:
            return True
        box = boxes.pop()
        k = _widest(box)
        if k is None:
            return None if any(math.isinf(v) for x in box for v in x) else False
        cut = middle(box[k])
        for part in ((box[k][0], cut), (cut, box[k][1])):
            try:
                boxes.append(relations.contract([*box[:k], part, *box[k + 1 :]]))
            except EmptyError:
                continue
    return None


def _widest(box: Box) -> int | None:
    """The variable to cut; None where that would not lead on."""
    best, width = None, THINNEST
    for k, (low, high) in enumerate(box):
        near = max((abs(v) for v in (low, high) if not math.isinf(v)), default=0.0)
        if high - low > width and not (math.isinf(high - low) and near > FARTHEST):
            best, width = k, high - low
    return best


# -- polynomials in the generators ------------------------------------------------------------------

Poly = Any


@dataclass(frozen=True)
class PolynomialSystem:
    """Polynomials that vanish wherever the relations hold; ``ranges`` of the generators, ``free`` unbounded ones."""

    polynomials: tuple[Poly, ...]
    symbols: tuple[Expr, ...]
    ranges: Mapping[Expr, Interval]

    @property
    def free(self) -> list[int]:
        """The generators that occur and are not bounded."""
        present = {i for p in self.polynomials for i, k in enumerate(p.degrees()) if k}
        return [i for i in sorted(present) if math.isinf(_width(self.ranges.get(self.symbols[i], WHOLE)))]


def _width(x: Interval) -> float:
    return x[1] - x[0]


def _faithful(relations: Sequence[Expr], positive: frozenset[Expr]) -> bool:
    """Has every root a value in the ring wherever it has one? There sqrt(u^2 v) is |u| sqrt(v), though u = 0 > v."""
    ring = Ring((), positive)
    for node in {n for e in relations for n in ex.nodes(e)}:
        if node.op == "pow" and node.args[1].op == "num" and node.args[1].args[0].denominator % 2 == 0:
            base = node.args[0]
            apart, rest = known_signs(ring, base) if base.op == "mul" else ([], base)
            if rest != ex.ONE and any(f.symbols and f not in positive and not _is_exp(f) for f in apart):
                return False
    return True


def _is_exp(e: Expr) -> bool:
    return e.op == "fn" and e.args[0] in ("exp", "cosh")


def _system(relations: Sequence[Expr], positive: frozenset[Expr]) -> PolynomialSystem | None:
    """Polynomials that vanish wherever the relations hold; None where there are none to be had.

    Raises EmptyError where one of them has no real root.
    """
    try:
        return _polynomials(relations, positive) if _faithful(relations, positive) else None
    except NoValueError:
        return None


def _polynomials(relations: Sequence[Expr], positive: frozenset[Expr]) -> PolynomialSystem:
    """Numerators in the canonical ring, the generators' own relations, linear combinations and resultants."""
    ring = Ring(relations, positive)
    nodes = [ring.node(e) for e in relations]
    canon = Canon(ring)
    own = [canon.quotient(node)[0] for node in nodes]
    if any(p == 0 for p in own):
        own = [p for p in own if p != 0]
    present = {i for p in own for i in canon.generators_in(p)}
    own += [g for g in canon.relations if not present.isdisjoint(canon.generators_in(g))]
    everything = _resultants(_combined(canon, _at_rest(canon, own)))
    count = len(ring.vars)
    symbols = tuple(ex.parameter(f"generator {count - 1 - i}") for i in range(count))
    ranges = {symbols[count - 1 - v.index]: _range(v, ring) for v in ring.vars}
    if any(_known(canon, p) and never_vanishes(canon.to_expr(p), positive) for p in everything):
        raise EmptyError
    if any(_without_real_roots(p) for p in everything):
        raise EmptyError
    return PolynomialSystem(tuple(everything), symbols, ranges)


def _known(canon: Canon, p: Poly) -> bool:
    """No generator is a number of its own: such numbers may be related, and their polynomials hidden zeros."""
    return all(canon.ring.var_expr[i].symbols for i in canon.generators_in(p))


def _range(var: Var, ring: Ring) -> Interval:
    if var.kind in ("cos", "sin", "sign"):
        return UNIT
    if var.kind in ("asin", "atan"):
        return -1.6, 1.6
    if var.kind == "atan2":
        return -3.2, 3.2
    if var.kind == "pi":
        return bounds(arb.pi())
    if var.kind == "exp" or (var.kind == "root" and var.degree % 2 == 0):
        return NON_NEGATIVE
    return NON_NEGATIVE if var.kind == "symbol" and var.key in ring.positive else WHOLE


def _at_rest(canon: Canon, polynomials: list[Poly]) -> list[Poly]:
    """Where all polynomials are unchanged by translations along some directions, the solutions with pivots 0 suffice.

    The directions d have sum d_i dp/dx_i = 0 for every p.
    """
    ring = canon.ring
    inside = frozenset().union(*(ring.var_expr[v.index].symbols for v in ring.vars if v.kind != "symbol"))
    symbols = [v for v in ring.vars if v.kind == "symbol" and v.key not in inside and v.key not in ring.positive]
    places = [len(ring.vars) - 1 - v.index for v in symbols]
    rows = [_directional(p, places) for p in polynomials]
    system = [row for part in rows for row in part]
    if not places or len(system) * len(places) > MAX_TABLE:
        return polynomials
    directions, nullity = _nullspace(system, len(places))
    fixed = {places[c] for c in _pivots(directions, nullity)}
    if not fixed:
        return polynomials
    return [
        canon.ctx.from_dict({m: c for m, c in p.to_dict().items() if not any(m[i] for i in fixed)}) for p in polynomials
    ]


def _directional(p: Poly, places: Sequence[int]) -> list[list[Any]]:
    """One row for every monomial of the derivatives: their coefficients, by the variable."""
    slopes = [p.derivative(i).to_dict() for i in places]
    return [[s.get(m, 0) for s in slopes] for m in {m for s in slopes for m in s}]


def _nullspace(system: list[list[Any]], n: int) -> tuple[fmpq_mat, int]:
    """Vectors d with row . d = 0 for every row, as rows in echelon form, and how many."""
    reduced, rank = fmpq_mat(system).rref() if system else (fmpq_mat(0, n), 0)
    pivots = _pivots(reduced, rank)
    free = [c for c in range(n) if c not in pivots]
    basis: list[list[Any]] = [[0] * n for _ in free]
    for row, c in zip(basis, free, strict=True):
        row[c] = 1
        for r, pivot in enumerate(pivots):
            row[pivot] = -reduced[r, c]
    return (fmpq_mat(basis).rref()[0], len(free)) if basis else (fmpq_mat(0, n), 0)


def _pivots(reduced: fmpq_mat, rank: int) -> list[int]:
    return [next(c for c in range(reduced.ncols()) if reduced[r, c] != 0) for r in range(rank)]


def _combined(canon: Canon, polynomials: Sequence[Poly]) -> list[Poly]:
    """The polynomials and, where there are several, an echelon form of them by degree (two circles meet on a line)."""
    tables = [p.to_dict() for p in polynomials]
    monomials = sorted({m for table in tables for m in table}, key=lambda m: (-sum(m), m))
    if len(tables) < 2 or len(tables) * len(monomials) > MAX_TABLE:
        return list(polynomials)
    reduced, rank = fmpq_mat([[table.get(m, 0) for m in monomials] for table in tables]).rref()
    rows = [
        canon.ctx.from_dict({m: reduced[r, c] for c, m in enumerate(monomials) if reduced[r, c] != 0})
        for r in range(rank)
    ]
    return [*polynomials, *(row for row in rows if row not in polynomials)]


def _resultants(polynomials: list[Poly]) -> list[Poly]:
    """The polynomials and the resultants of pairs: they vanish wherever both do."""
    found = list(polynomials)
    for a, b in islice(combinations(polynomials, 2), MAX_PAIRS):
        if len(a) + len(b) > MAX_RESULTANT_TERMS:
            continue
        for i, (j, k) in enumerate(zip(a.degrees(), b.degrees(), strict=True)):
            if j and k and j + k <= MAX_RESULTANT_DEGREE:
                eliminated = a.resultant(b, i)
                if eliminated != 0 and len(eliminated) <= MAX_RESULTANT_TERMS and eliminated not in found:
                    found.append(eliminated)
    return found


def _without_real_roots(p: Poly) -> bool:
    """A polynomial in one generator all of whose roots are certified not to be real."""
    used = [i for i, k in enumerate(p.degrees()) if k]
    if not used:
        return bool(p != 0)
    if len(used) > 1:
        return False
    table = {int(m[used[0]]): Fraction(int(c.p), int(c.q)) for m, c in p.to_dict().items()}
    scale = math.lcm(*(c.denominator for c in table.values()))
    whole = fmpz_poly([int(table.get(k, Fraction(0)) * scale) for k in range(max(table) + 1)])
    roots: Any = whole.complex_roots()
    return all(not root.imag.contains(0) for root, _ in roots)


def _algebraically(system: PolynomialSystem, search: bool) -> bool:
    """No real solution of the polynomials: every box of space or of its charts goes."""
    plain = [(_expression(p, system.symbols), ZERO) for p in system.polynomials]
    excluded = _excluded(plain, system.ranges) if search else False
    if excluded or excluded is False:
        return bool(excluded)
    free = system.free
    return 0 < len(free) <= MAX_CHARTS and all(
        _excluded([(_in_chart(p, system, free, k), ZERO) for p in system.polynomials], _chart_ranges(system, free, k))
        for k in (None, *free)
    )


def _expression(p: Poly, symbols: Sequence[Expr]) -> Expr:
    return ex.add(*(_term(c, m, symbols) for m, c in p.to_dict().items()))


def _term(coefficient: Any, exponents: Sequence[int], symbols: Sequence[Expr]) -> Expr:
    powers = [ex.power(s, ex.num(int(k))) for s, k in zip(symbols, exponents, strict=True) if k]
    return ex.mul(ex.num(Fraction(int(coefficient.p), int(coefficient.q))), *powers)


def _in_chart(p: Poly, system: PolynomialSystem, free: Sequence[int], k: int | None) -> Expr:
    """p times w^degree with x_k = 1/w and x_j = u_j/w for the other unbounded ones; ``w`` stands in x_k's place."""
    if k is None:
        return _expression(p, system.symbols)
    table = p.to_dict()
    degree = max(sum(m[i] for i in free) for m in table)
    terms = []
    for m, c in table.items():
        moved = list(m)
        moved[k] = degree - sum(m[i] for i in free)
        terms.append(_term(c, moved, system.symbols))
    return ex.add(*terms)


def _chart_ranges(system: PolynomialSystem, free: Sequence[int], k: int | None) -> dict[Expr, Interval]:
    """Every unbounded generator within -1 and 1; where it is never negative, so it is beside the largest one."""
    found = dict(system.ranges)
    for i in free:
        s = system.symbols[i]
        known = k is None or system.ranges.get(system.symbols[k]) == NON_NEGATIVE
        found[s] = (0.0, 1.0) if known and system.ranges.get(s) == NON_NEGATIVE else UNIT
    return found
