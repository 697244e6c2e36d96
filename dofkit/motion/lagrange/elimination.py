"""Finite relations solved for coordinates in closed form; what was solved is checked against the relation identically.

A relation g = 0 that is linear in a coordinate q gives q = -g(0)/g_q where g_q is not 0; one that is quadratic gives
two branches, of which one is taken: that through the reference configuration, else that of lower potential energy.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from dofkit.base.deadline import check
from dofkit.exact.errors import NoValueError, raising_no_value
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import ONE, TWO, ZERO, Expr
from dofkit.motion.lagrange.term_order import ordered
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian


class Care(NamedTuple):
    """What is eliminated: solutions of at most so many nodes, and at most so many relations by a root.

    With more roots there are too many branches, and none is taken.
    """

    nodes: int
    roots: int


#: From the freest to none at all: the next is taken where the equations would be too long to read.
ELIMINATIONS = (Care(400, 1), Care(24, 0), Care(0, 0))

Remaining = Finite | Pfaffian | Nonlinear


class EliminatedRelation(NamedTuple):
    """g = 0, and the constants of integration that it brought with it."""

    expr: Expr
    constants: frozenset[Expr] = frozenset()


@dataclass(frozen=True)
class Elimination:
    """Coordinates as functions of those kept (and of time); ``notes`` say what was assumed on the way."""

    solved: Mapping[str, Expr] = field(default_factory=dict)
    constants: frozenset[Expr] = frozenset()
    notes: tuple[str, ...] = ()

    def kept(self, names: Sequence[str]) -> list[str]:
        """The coordinates that are left."""
        return [name for name in names if name not in self.solved]


class Candidate(NamedTuple):
    """A solution q = value of a relation.

    ``cost`` orders them, ``over`` must not vanish, ``other`` is the second root.
    """

    cost: tuple[int, int, int]
    name: str
    value: Expr
    over: Expr
    other: Expr | None


@dataclass
class Eliminator:
    """Solves relations one after another, the plainest first.

    ``choose``: of the two roots for a coordinate, the one to take and why.
    """

    positive: frozenset[Expr]
    choose: Callable[[str, Expr, Expr, Mapping[str, Expr]], tuple[Expr, str]]
    care: Care = ELIMINATIONS[0]

    @raising_no_value
    def eliminated(
        self, relations: Sequence[EliminatedRelation], names: Sequence[str], preferred: Sequence[str]
    ) -> Elimination:
        """As many relations as possible solved for some of ``names``; ``preferred`` ones go first.

        Relations that need more than `care.roots` roots are all left.
        """
        found = self._attempt(relations, names, preferred, self.care.roots)
        if found is None:
            found = self._attempt(relations, names, preferred, 0) or Elimination()
            many = "Several relations are quadratic; they keep multipliers, so that the equations hold on every branch."
            found = replace(found, notes=(*found.notes, many))
        return found

    def _attempt(
        self, relations: Sequence[EliminatedRelation], names: Sequence[str], preferred: Sequence[str], most: int
    ) -> Elimination | None:
        """An elimination by ``most`` roots; None where it would need more, unless that is 0."""
        solved: dict[str, Expr] = {}
        constants: set[Expr] = set()
        notes: list[str] = []
        left = list(relations)
        roots = 0
        while left:
            check()
            found = self._best(left, [n for n in names if n not in solved], preferred, most > 0)
            if found is None:
                break
            relation, candidate = found
            if candidate.other is not None and roots == most:
                return None
            left.remove(relation)
            value = ordered(candidate.value)
            if candidate.other is not None:
                roots += 1
                value, why = self.choose(candidate.name, value, ordered(candidate.other), solved)
                notes.append(why)
            elif not _never_zero(candidate.over, self.positive):
                notes.append(
                    f"The solution for {candidate.name} is valid where {to_text(_unsigned(candidate.over))} is not 0."
                )
            mapping = {ex.coordinate(candidate.name): value}
            try:
                solved = {n: substitute(e, mapping) for n, e in solved.items()} | {candidate.name: value}
                left = [relation_ for r in left for relation_ in self._rest(r, mapping)]
            except NoValueError:
                break
            constants |= relation.constants
        return Elimination(solved, frozenset(constants), tuple(notes))

    def _rest(self, relation: EliminatedRelation, mapping: Mapping[Expr, Expr]) -> list[EliminatedRelation]:
        """A relation after a substitution; nothing where it then holds identically."""
        e = substitute(relation.expr, mapping)
        return [] if is_identically_zero(e, self.positive) else [relation._replace(expr=e)]

    def _best(
        self, relations: Sequence[EliminatedRelation], names: Sequence[str], preferred: Sequence[str], roots: bool
    ) -> tuple[EliminatedRelation, Candidate] | None:
        found = [
            (relation, candidate)
            for relation in relations
            for place, name in enumerate(names)
            if (candidate := self._solved(relation.expr, name, (name not in preferred, -place))) is not None
            and (roots or candidate.other is None)
        ]
        found.sort(key=lambda pair: pair[1].cost)
        return next((pair for pair in found if self._checked(*pair)), None)

    def _solved(self, g: Expr, name: str, order: tuple[int, int]) -> Candidate | None:
        """The relation solved for one coordinate where it is linear or quadratic in that."""
        q = ex.coordinate(name)
        if q not in g.symbols:
            return None
        first = diff(g, q)
        second = diff(first, q)
        at_zero = {q: ZERO}
        try:
            start, slope = substitute(g, at_zero), substitute(first, at_zero)
        except NoValueError:
            return None
        if second.is_zero or is_identically_zero(second, self.positive):
            if is_identically_zero(slope, self.positive) is not False:
                return None
            moving = any(s.args[0] in ("coordinate", "time") for s in slope.symbols)
            return Candidate((moving, *order), name, -start / slope, slope, None)
        if q in second.symbols or not _free_of(second, q, self.positive):
            return None
        half = slope / second
        root = ex.sqrt(self._tidy(half**2 - TWO * start / second))
        return Candidate((2, *order), name, root - half, second, -root - half)

    def _tidy(self, e: Expr) -> Expr:
        return ex.add(*(ex.mul(*(t.args if t.op == "mul" else (t,))) for t in (e.args if e.op == "add" else (e,))))

    def _checked(self, relation: EliminatedRelation, candidate: Candidate) -> bool:
        """Does the relation hold identically with what it was solved to? Zero in the canonical ring is a proof."""
        q = ex.coordinate(candidate.name)
        for value in (candidate.value, candidate.other):
            if value is None:
                continue
            if sum(1 for _ in ex.nodes(value)) > self.care.nodes:
                return False
            try:
                inserted = substitute(relation.expr, {q: value})
            except NoValueError:
                return False
            if is_identically_zero(inserted, self.positive) is not True:
                return False
        return True


def _unsigned(e: Expr) -> Expr:
    """Without a number in front."""
    return ex.mul(*(p for p in e.args if p.op != "num")) if e.op == "mul" else e


def _free_of(e: Expr, q: Expr, positive: frozenset[Expr]) -> bool:
    slope = diff(e, q)
    return slope.is_zero or is_identically_zero(slope, positive) is True


def _never_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """A number, or a product of positive parameters and numbers."""
    parts = e.args if e.op == "mul" else (e,)
    return all(p.op in ("num", "const") or (p.args[0] if p.op == "pow" else p) in positive for p in parts)


def by_potential(
    potential: Expr, reference: Mapping[Expr, Expr] | None
) -> Callable[[str, Expr, Expr, Mapping[str, Expr]], tuple[Expr, str]]:
    """Chooses the root through the reference configuration, else that of lower potential energy, else the first."""

    def choose(name: str, first: Expr, second: Expr, solved: Mapping[str, Expr]) -> tuple[Expr, str]:
        taken, why = first, "the other root is the other branch"
        if reference is not None and ex.coordinate(name) in reference:
            here = reference[ex.coordinate(name)]
            start = {**reference, ex.TIME: ZERO}
            gaps = [_figure(_sampled(substitute(v, start) - here)) for v in (first, second)]
            if None not in gaps and abs(gaps[0] or 0) != abs(gaps[1] or 0):
                taken = first if abs(gaps[0] or 0) < abs(gaps[1] or 0) else second
                why = "the branch through the reference configuration"
                return taken, _branch_note(name, taken, first if taken is second else second, why)
        heights = [_figure(_sampled(substitute(potential, _all(name, v, solved)))) for v in (first, second)]
        if heights[0] is not None and heights[1] is not None and heights[0] != heights[1]:
            taken = first if heights[0] < heights[1] else second
            why = "the branch of lower potential energy"
        return taken, _branch_note(name, taken, first if taken is second else second, why)

    return choose


def _branch_note(name: str, taken: Expr, other: Expr, why: str) -> str:
    return f"{name} = {to_text(taken)} on the chosen branch ({why}); on the other branch, {name} = {to_text(other)}."


def _all(name: str, value: Expr, solved: Mapping[str, Expr]) -> dict[Expr, Expr]:
    found = {ex.coordinate(n): substitute(e, {ex.coordinate(name): value}) for n, e in solved.items()}
    return {**found, ex.coordinate(name): value}


def _sampled(e: Expr) -> Expr:
    """At a point near 0 where parameters are of the order of 1: what the two roots are compared at."""
    values = {}
    for k, symbol in enumerate(sorted(e.symbols, key=lambda s: s.args)):
        near = symbol.args[0] == "coordinate"
        values[symbol] = ex.num(1) / ex.num(17 + 3 * k) if near else ONE + ex.num(1) / ex.num(7 + k)
    return substitute(e, values)


def _figure(e: Expr) -> float | None:
    try:
        return approximate(e)
    except (ArithmeticError, ValueError):
        return None


def inserted(piece: Remaining, elimination: Elimination) -> Remaining:
    """A relation in the coordinates that are left: q = f(q', t) brings dq = sum f_q' dq' + f_t dt."""
    solved = elimination.solved
    if not solved:
        return piece
    places = {ex.coordinate(n): e for n, e in solved.items()}
    if isinstance(piece, Finite):
        return Finite(substitute(piece.expr, places))
    if isinstance(piece, Nonlinear):
        rates = {ex.velocity(n): _rate(e) for n, e in solved.items()}
        return Nonlinear(substitute(piece.expr, {**places, **rates}))
    coefficients: dict[str, Expr] = {}
    dt = substitute(piece.dt, places)
    for name, coefficient in piece.coefficients.items():
        factor = substitute(coefficient, places)
        if name not in solved:
            coefficients[name] = coefficients.get(name, ZERO) + factor
            continue
        for s in solved[name].symbols:
            if s.args[0] == "coordinate":
                own = str(s.args[1])
                coefficients[own] = coefficients.get(own, ZERO) + factor * diff(solved[name], s)
        dt = dt + factor * diff(solved[name], ex.TIME)
    return replace(piece, coefficients={n: e for n, e in coefficients.items() if not e.is_zero}, dt=dt)


def _rate(e: Expr) -> Expr:
    own = [s for s in e.symbols if s.args[0] == "coordinate"]
    return ex.add(*(diff(e, s) * ex.velocity(str(s.args[1])) for s in own), diff(e, ex.TIME))


def vanishes(piece: Remaining, positive: frozenset[Expr]) -> bool:
    """Does a relation hold identically? Proved in the canonical ring."""
    parts = [*piece.coefficients.values(), piece.dt] if isinstance(piece, Pfaffian) else [piece.expr]
    return all(e.is_zero or is_identically_zero(e, positive) is True for e in parts)
