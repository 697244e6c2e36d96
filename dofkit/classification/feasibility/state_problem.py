"""What a state of motion has to satisfy for the inequalities to hold: relations, conditions, and what moves.

Where nothing depends on time and every relation between velocities allows rest, a configuration at rest is a motion,
and only the finite relations count. Else a motion passes through a state (q, v) at the time t at which the rows that
are linear in v by their differentials are independent: there v is a smooth function of (q, t) and free numbers
[ImplicitFunctions], and what holds strictly there holds for a while.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import combinations, combinations_with_replacement
from itertools import product as cartesian
from math import prod
from typing import Literal, NamedTuple

from flint import fmpq

from dofkit.base.errors import NoValueError
from dofkit.exact.linear_inequalities import LinearCondition, solution
from dofkit.exact.matrices.sparse import components
from dofkit.exact.zero import zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import has_call
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row, coordinates_of
from dofkit.relations.linear_relations import solve_linear
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Finite, Inequality, Nonlinear, Pfaffian, Reduced
from dofkit.relations.velocity_reductions import rate

#: Inequalities of which products are taken; equations times symbols; symbols whose differences are squared.
MAX_FACTORS, MAX_MULTIPLES, MAX_SQUARED = 8, 24, 4
#: Terms of all together, or twice as many as claims where those are more.
MAX_TERMS = 80
#: More claims than this are not put to boxes.
MAX_BOXED = 40
#: Functions that are nowhere negative, and those that are above 0; bounded by 1 in size.
_NOT_NEGATIVE, _POSITIVE, _BOUNDED = frozenset({"abs", "acos"}), frozenset({"exp", "cosh"}), ("sin", "cos", "tanh")

ZERO = fmpq(0)
Sense = Literal["=", ">=", ">"]


class SignClaim(NamedTuple):
    """``expr`` is 0, or >= 0, or > 0, by its ``sense``."""

    expr: Expr
    sense: Sense


def refuted(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """True where no real point satisfies all claims: proved. False says nothing.

    Parameters may have any value (those of ``positive`` a positive one), and so may every value of an unknown function.
    """
    if contradictory(claims, positive):
        return True
    if all(u.op == "sym" or u == ex.ONE for c in claims for u in _terms(c.expr)):
        return False
    more = list(_products(claims, positive))
    if more and contradictory([*claims, *more], positive):
        return True
    equations = [c.expr for c in claims if c.sense == "="]
    others = [c.expr for c in claims if c.sense != "="]
    return len(claims) <= MAX_BOXED and no_solution(equations, positive, others)


@lru_cache(maxsize=4096)
def _terms(e: Expr) -> Mapping[Expr, Fraction]:
    """The expression as a combination of its terms."""
    return linear_terms(e)


def contradictory(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> bool:
    """True where no values of the terms, taken for unknowns of their own, satisfy the claims and the terms' signs."""
    facts, terms = list(claims), set[Expr]()
    for _ in range(2):
        fresh = {u for c in facts for u in _terms(c.expr) if u != ex.ONE} - terms
        terms |= fresh
        facts += [fact for u in sorted(fresh, key=repr) for fact in _facts(u, terms, positive)]
    order = sorted({u for c in facts for u in _terms(c.expr)} - {ex.ONE}, key=repr)
    if len(order) > max(MAX_TERMS, 2 * len(claims)):
        return False
    return solution([linear_condition(c, order) for c in facts]) is False


def linear_condition(claim: SignClaim, order: Sequence[Expr]) -> LinearCondition:
    """Return a claim as a linear condition on the terms in ``order``."""
    terms = _terms(claim.expr)
    *row, constant = (fmpq(v.numerator, v.denominator) if (v := terms.get(u)) else ZERO for u in (*order, ex.ONE))
    return LinearCondition(tuple(row), constant, claim.sense)


def _facts(term: Expr, terms: set[Expr], positive: frozenset[Expr]) -> Iterator[SignClaim]:
    """What holds of a term wherever it has a value."""
    sense = _sign(term, positive)
    if sense is not None:
        yield SignClaim(term, sense)
    if term.op == "fn" and term.args[0] in _BOUNDED:
        yield from (SignClaim(ex.ONE - term, ">="), SignClaim(ex.ONE + term, ">="))
    if term.op == "fn" and term.args[0] == "cosh":
        yield SignClaim(term - ex.ONE, ">=")
    if term.op == "fn" and term.args[0] == "abs":
        yield from (SignClaim(term - term.args[1], ">="), SignClaim(term + term.args[1], ">="))
    if term.op == "pow" and term.args[1] == ex.TWO and term.args[0].op == "fn" and term.args[0].args[0] == "sin":
        other = ex.power(ex.fn("cos", term.args[0].args[1]), ex.TWO)
        if other in terms:
            yield SignClaim(term + other - ex.ONE, "=")


def _sign(term: Expr, positive: frozenset[Expr]) -> Sense | None:
    """>= or > where a product is so wherever it has a value; None where that is not seen."""
    signs = [_sign_of_factor(f, positive) for f in (term.args if term.op == "mul" else (term,))]
    if None in signs:
        return None
    return ">=" if ">=" in signs else ">"


def _sign_of_factor(factor: Expr, positive: frozenset[Expr]) -> Sense | None:
    if factor in positive or factor.op == "const" or (factor.op == "fn" and factor.args[0] in _POSITIVE):
        return ">"
    if factor.op == "fn" and factor.args[0] in _NOT_NEGATIVE:
        return ">="
    if factor.op == "pow" and factor.args[1].op == "num":
        exponent = factor.args[1].args[0]
        if _sign_of_factor(factor.args[0], positive) == ">":
            return ">"
        if exponent.denominator % 2 == 0 or exponent.numerator % 2 == 0:
            return ">" if exponent < 0 else ">="
    return None


def _products(claims: Sequence[SignClaim], positive: frozenset[Expr]) -> Iterator[SignClaim]:
    """Inequalities times each other, positive parameters among them, equations times symbols, and a few squares."""
    symbols = sorted(_symbols(claims), key=repr)
    for a, b in combinations(symbols, 2) if len(symbols) <= MAX_SQUARED else ():
        yield from (SignClaim(ex.power(u, ex.TWO), ">=") for u in (a + b, a - b))
    factors = [c for c in claims if c.sense != "="] + [SignClaim(s, ">") for s in symbols if s in positive]
    functions = {u for c in claims for e in _terms(c.expr) for u in ex.nodes(e) if u.op == "fn"}
    factors += [fact for u in sorted(functions, key=repr) for fact in _facts(u, set(), positive)]
    if len(factors) <= MAX_FACTORS:
        for first, other in combinations_with_replacement(factors, 2):
            yield SignClaim(ex.mul(first.expr, other.expr), ">" if first.sense == other.sense == ">" else ">=")
    equations = [c for c in claims if c.sense == "="]
    if len(equations) * len(symbols) <= MAX_MULTIPLES:
        yield from (SignClaim(ex.mul(c.expr, s), "=") for c in equations for s in symbols)


def _symbols(claims: Iterable[SignClaim]) -> frozenset[Expr]:
    return frozenset[Expr]().union(*(c.expr.symbols for c in claims))


@dataclass(frozen=True)
class StateProblem:
    """``equations`` = 0 and ``conditions`` in ``places``, ``rates`` (velocities), time and parameters.

    ``moving``: those of the equations that are to be independent by the rates, where there are rates; else all are to
    be so by the places. ``still``: a configuration at rest is asked for. ``fixed``: values of time and parameters;
    those without one may have any. ``drawn_only``: of points only the drawn one is meant by all relations.
    """

    equations: tuple[Expr, ...]
    conditions: tuple[DomainCondition, ...]
    places: tuple[Expr, ...]
    rates: tuple[Expr, ...] = ()
    moving: tuple[Expr, ...] = ()
    still: bool = False
    fixed: Mapping[Expr, Fraction] = field(default_factory=dict)
    drawn_only: bool = False

    @cached_property
    def symbols(self) -> frozenset[Expr]:
        """All that occurs."""
        return frozenset[Expr]().union(*(e.symbols for e in self.expressions))

    @property
    def expressions(self) -> list[Expr]:
        """All equations, then what the conditions are about."""
        return [*self.equations, *(c.expr for c in self.conditions)]

    @property
    def constants(self) -> list[Expr]:
        """Time and the parameters that occur."""
        return sorted((s for s in self.symbols if s.args[0] in ("parameter", "time")), key=repr)

    @property
    def unknowns(self) -> list[Expr]:
        """Places, rates, and what may have any value."""
        return [*self.places, *self.rates, *(s for s in self.constants if s not in self.fixed)]

    @property
    def independent(self) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
        """(rows, symbols by which they are to be independent, so that a motion passes through a point)."""
        return (self.moving, self.rates) if self.rates else (self.equations, self.places)

    @property
    def rigidly(self) -> bool:
        """Will any one point do? Nothing varies but places, and they rest."""
        return self.still and not self.constants

    @property
    def unknown_functions(self) -> bool:
        """Return whether an unknown function occurs."""
        return any(map(has_call, self.expressions))


def problems_of(
    rows: Sequence[Row], conditions: Sequence[DomainCondition], names: Sequence[str]
) -> Iterator[StateProblem]:
    """At rest, where that is a motion, and then in motion, where the rows or the conditions hold velocities."""
    finite = [r.piece.expr for r in rows if isinstance(r.piece, Finite)]
    others = [r.piece.rate for r in rows if isinstance(r.piece, Pfaffian)]
    others += [r.piece.expr for r in rows if isinstance(r.piece, Nonlinear)]
    boundaries, conditions = _boundaries(conditions)
    finite += [e for e in boundaries if not velocities_of(e)]
    others += [e for e in boundaries if velocities_of(e)]
    places = tuple(ex.coordinate(name) for name in names)
    no_velocity = {ex.velocity(name): ex.ZERO for name in names}
    asked = [*finite, *others, *(c.expr for c in conditions)]
    finite = _independent(finite)
    timed = any(ex.TIME in e.symbols for e in asked)
    still = None if timed else _at_rest(others, conditions, no_velocity)
    if still is not None:
        yield StateProblem(tuple(finite), still, places, still=True)
    elif not others and not any(map(velocities_of, asked)):
        yield StateProblem(tuple(finite), conditions, places)
    if any(map(velocities_of, asked)) and (timed or others or any(velocities_of(c.expr) for c in conditions)):
        moving = (*(rate(g) for g in finite), *others)
        yield StateProblem((*finite, *moving), conditions, places, tuple(no_velocity), moving)


def _at_rest(
    others: Sequence[Expr], conditions: Sequence[DomainCondition], no_velocity: Mapping[Expr, Expr]
) -> tuple[DomainCondition, ...] | None:
    """The conditions at velocities 0; None where the relations are not satisfied, or have no value, there."""
    try:
        if all(zero_and_verdict(substitute(e, no_velocity), frozenset()) == (True, "proved") for e in others):
            return tuple(DomainCondition(substitute(c.expr, no_velocity), c.sense) for c in conditions)
    except NoValueError:
        pass
    return None


def _boundaries(conditions: Sequence[DomainCondition]) -> tuple[list[Expr], tuple[DomainCondition, ...]]:
    """(what e >= 0 and -e >= 0 make 0, the other conditions)."""
    closed = [c for c in conditions if c.sense == ">="]
    pairs = [(a, b) for a, b in combinations(closed, 2) if not linear_terms(a.expr + b.expr)]
    gone = {id(c) for pair in pairs for c in pair}
    return [a.expr for a, _ in pairs], tuple(c for c in conditions if id(c) not in gone)


def _independent(finite: Sequence[Expr]) -> list[Expr]:
    """The equations without linear ones that other linear ones imply."""
    implied = solve_linear(finite).implied
    return [e for i, e in enumerate(finite) if i not in implied]


#: Choices of branches that are looked at.
MAX_CHOICES = 16


@dataclass(frozen=True)
class Choice:
    """One branch of every relation: its rows, and the conditions, inequalities among them."""

    rows: tuple[Row, ...]
    conditions: tuple[DomainCondition, ...]

    @property
    def names(self) -> list[str]:
        """The coordinates that occur."""
        result = [*(coordinates_of(r.piece) for r in self.rows), *map(coordinates_of, self.conditions)]
        return sorted(frozenset[str]().union(*result))

    def claims(self) -> list[SignClaim]:
        """What holds at every state of motion; what is only != 0 is left out."""
        finite = [r.piece.expr for r in self.rows if isinstance(r.piece, Finite)]
        forms = [r.piece.rate for r in self.rows if isinstance(r.piece, Pfaffian)]
        curved = [r.piece.expr for r in self.rows if isinstance(r.piece, Nonlinear)]
        held = [SignClaim(c.expr, ">" if c.sense == ">" else ">=") for c in self.conditions if c.sense != "!="]
        if forms or curved or any(velocities_of(c.expr) for c in held):
            finite += [*map(rate, finite), *forms, *curved]
        return [*(SignClaim(e, "=") for e in finite), *held]


@dataclass(frozen=True)
class Part:
    """Constraints by their ``numbers`` that share coordinates, one after another, an inequality among them."""

    numbers: tuple[int, ...]
    reduced: tuple[Reduced, ...]

    @property
    def inequalities(self) -> list[Inequality]:
        """All of them."""
        return [q for r in self.reduced for q in r.inequalities]

    @property
    def readable(self) -> bool:
        """Return whether the inequalities are about configurations and velocities only."""
        kinds = {s.args[0] for q in self.inequalities for s in q.expr.symbols}
        return kinds.isdisjoint({"differential", "dt"})

    def choices(self) -> Iterator[Choice] | None:
        """Every choice of branches; None where they are too many."""
        normals = [(i, n) for i, r in zip(self.numbers, self.reduced, strict=True) for n in r.normals]
        if prod(len(n.branches) for _, n in normals) > MAX_CHOICES:
            return None
        conditions = tuple(DomainCondition(q.expr, ">" if q.strict else ">=") for q in self.inequalities)
        return (
            _choice([(i, branch) for (i, _), branch in zip(normals, chosen, strict=True)], conditions)
            for chosen in cartesian(*(n.branches for _, n in normals))
        )

    def written(self) -> list[SignClaim]:
        """The finite relations and the inequalities as they were written, all branches in one."""
        relations = [q for r in self.reduced for q in r.constraint.relations if q.sense == "=" and _finite(q.expr)]
        sides = [SignClaim(q.expr, ">" if q.strict else ">=") for q in self.inequalities]
        return [*(SignClaim(q.expr, "=") for q in relations), *sides]


def _finite(e: Expr) -> bool:
    return all(s.args[0] in ("coordinate", "parameter", "time") for s in e.symbols)


def _choice(
    branches: Sequence[tuple[int, Sequence[object]]],
    inequalities: tuple[DomainCondition, ...],
) -> Choice:
    rows = [Row(i, p) for i, branch in branches for p in branch if isinstance(p, Finite | Pfaffian | Nonlinear)]
    conditions = [p for _, branch in branches for p in branch if isinstance(p, DomainCondition)]
    return Choice(tuple(rows), tuple(dict.fromkeys((*conditions, *inequalities))))


def parts_of(reduced: Sequence[Reduced], numbers: Sequence[int], shared: bool) -> list[Part]:
    """The parts with an inequality; ``shared``: what shares time or a parameter belongs together as well."""
    together = components(_mentioned(reduced[i], shared) for i in numbers)
    groups = [sorted(numbers[k] for k in group) for group in together]
    every = [Part(tuple(g), tuple(reduced[i] for i in g)) for g in groups]
    return sorted((p for p in every if p.inequalities), key=lambda p: p.numbers)


def _mentioned(r: Reduced, shared: bool) -> frozenset[str]:
    pieces = [*(p for n in r.normals for branch in n.branches for p in branch), *r.inequalities]
    names = frozenset[str]().union(*map(coordinates_of, pieces))
    constants = (s for q in r.constraint.relations for s in q.expr.symbols if s.args[0] in ("parameter", "time"))
    return names | frozenset(repr(s) for s in constants) if shared else names
