"""Geometric equations solved for coordinates in closed form; each solution is checked by inserting it.

A relation g = 0 that is linear in a coordinate q gives q = -g(0)/g_q where g_q is not 0. A quadratic relation gives two
branches; the one through the reference configuration is chosen, else the one of lower potential energy at a sample.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import is_identically_zero, square_root
from dofkit.exact.ring.program import false_without_value, none_without_value, raising_no_value
from dofkit.expressions import calculus
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import HALF, ONE, TWO, ZERO, Expr
from dofkit.motion.lagrange.tidying import ordered
from dofkit.relations.normal.normal_form import linear_form
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian


def by_time(e: Expr) -> Expr:
    """Return de/dt = sum (de/dq) qdot + (de/dqdot) qddot + de/dt. Raises ValueError for accelerations."""
    rate = calculus.by_time(e)
    if rate is None:
        raise ValueError("the derivative of an acceleration or a differential by time has no meaning here")
    return rate


def motions(solved: Mapping[str, Expr]) -> dict[Expr, Expr]:
    """Return {q, qdot, qddot: expression} for every solved coordinate; ``solved`` gives q = f(other coordinates, t)."""
    values: dict[Expr, Expr] = {}
    for name, value in solved.items():
        velocity = by_time(value)
        values[ex.coordinate(name)] = value
        values[ex.velocity(name)] = velocity
        values[ex.sym("acceleration", name)] = by_time(velocity)
    return values


#: The most nodes of a solution that is used.
LONGEST_SOLUTION = 400

Remaining = Finite | Pfaffian | Nonlinear


class EliminatedRelation(NamedTuple):
    """A relation ``expr`` = 0, and the constants of integration in it."""

    expr: Expr
    constants: frozenset[Expr] = frozenset()


@dataclass(frozen=True)
class Elimination:
    """Eliminated coordinates as functions of the remaining ones and time; ``notes`` state the assumptions made."""

    solved: Mapping[str, Expr] = field(default_factory=dict)
    constants: frozenset[Expr] = frozenset()
    notes: tuple[str, ...] = ()

    def kept(self, names: Sequence[str]) -> list[str]:
        """Return the names that are not eliminated."""
        return [name for name in names if name not in self.solved]


class Candidate(NamedTuple):
    """A solution q = value of a relation for the coordinate ``name``.

    Candidates are ordered by ``cost``; the ``divisor`` must not vanish; ``other_root``: of a quadratic relation.
    """

    cost: tuple[int, int, int]
    name: str
    value: Expr
    divisor: Expr
    other_root: Expr | None


@dataclass
class Eliminator:
    """Solves relations for coordinates one after another, the simplest first.

    Of two roots the one through the ``reference`` is chosen, else the one of lower ``potential`` energy.
    """

    positive: frozenset[Expr]
    potential: Expr
    reference: Mapping[Expr, Expr] | None

    @raising_no_value
    def eliminated(
        self,
        relations: Sequence[EliminatedRelation],
        names: Sequence[str],
        preferred: Sequence[str],
        roots: bool = True,
    ) -> Elimination:
        """Return as many relations as possible solved for some of ``names``, ``preferred`` ones first.

        At most one relation is solved by a root; if a second one would be needed, no root is used at all.
        """
        elimination = self._attempt(relations, names, preferred, roots)
        if elimination is None:
            elimination = self._attempt(relations, names, preferred, False) or Elimination()
            many = "Several relations are quadratic; they keep multipliers, so that the equations hold on every branch."
            elimination = replace(elimination, notes=(*elimination.notes, many))
        return elimination

    def _attempt(
        self, relations: Sequence[EliminatedRelation], names: Sequence[str], preferred: Sequence[str], roots: bool
    ) -> Elimination | None:
        """Return an elimination of one coordinate after the other; None if a second square root would be needed.

        Without ``roots`` no quadratic relation is solved. It ends where a solution has no value in another relation.
        """
        solved: dict[str, Expr] = {}
        constants: set[Expr] = set()
        notes: list[str] = []
        remaining = list(relations)
        has_root = False
        while remaining:
            check()
            best = self._best(remaining, [n for n in names if n not in solved], preferred, roots)
            if best is None:
                break
            relation, candidate = best
            if candidate.other_root is not None and has_root:
                return None
            value, note = ordered(candidate.value), None
            if candidate.other_root is not None:
                value, note = self._chosen(candidate.name, value, ordered(candidate.other_root), solved)
            elif not _never_zero(candidate.divisor, self.positive):
                divisor = to_text(_unsigned(candidate.divisor))
                note = f"The solution for {candidate.name} is valid where {divisor} is not 0."
            mapping = {ex.coordinate(candidate.name): value}
            try:
                with_value = {n: substitute(e, mapping) for n, e in solved.items()}
                others = [r._replace(expr=substitute(r.expr, mapping)) for r in remaining if r is not relation]
                remaining = [r for r in others if not is_identically_zero(r.expr, self.positive)]
            except NoValueError:
                break
            solved = {**with_value, candidate.name: value}
            has_root = has_root or candidate.other_root is not None
            constants |= relation.constants
            notes += [note] if note else []
        return Elimination(solved, frozenset(constants), tuple(notes))

    def _best(
        self, relations: Sequence[EliminatedRelation], names: Sequence[str], preferred: Sequence[str], roots: bool
    ) -> tuple[EliminatedRelation, Candidate] | None:
        candidates = [
            (relation, candidate)
            for relation in relations
            for place, name in enumerate(names)
            if (candidate := self._solved(relation.expr, name, (name not in preferred, -place))) is not None
            and (roots or candidate.other_root is None)
        ]
        candidates.sort(key=lambda pair: pair[1].cost)
        return next((pair for pair in candidates if self._checked(*pair)), None)

    @none_without_value
    def _solved(self, g: Expr, name: str, order: tuple[int, int]) -> Candidate | None:
        """Return g = 0 solved for a coordinate in which it is linear or quadratic, else None; ``order`` is a cost."""
        q = ex.coordinate(name)
        if q not in g.symbols:
            return None
        first = diff(g, q)
        second = diff(first, q)
        at_zero = {q: ZERO}
        start, slope = substitute(g, at_zero), substitute(first, at_zero)
        if second.is_zero or is_identically_zero(second, self.positive):
            if is_identically_zero(slope, self.positive) is not False:
                return None
            moving = any(s.args[0] in ("coordinate", "time") for s in slope.symbols)
            return Candidate((moving, *order), name, -start / slope, slope, None)
        if q in second.symbols:
            return None
        half = slope / second
        root = ex.sqrt(self._tidy(half**2 - TWO * start / second))
        return Candidate((2, *order), name, root - half, second, -root - half)

    def _tidy(self, e: Expr) -> Expr:
        return ex.add(*(ex.mul(*(t.args if t.op == "mul" else (t,))) for t in (e.args if e.op == "add" else (e,))))

    @false_without_value
    def _checked(self, relation: EliminatedRelation, candidate: Candidate) -> bool:
        """Return whether the relation is proved to be 0 with the solution (and the other root), and short enough."""
        q, solutions = ex.coordinate(candidate.name), (candidate.value, candidate.other_root)
        return all(
            ex.size(value) <= LONGEST_SOLUTION
            and is_identically_zero(substitute(relation.expr, {q: value}), self.positive) is True
            for value in solutions
            if value is not None
        )

    def _chosen(self, name: str, first: Expr, second: Expr, solved: Mapping[str, Expr]) -> tuple[Expr, str]:
        """Return (chosen root, note on the other branch); the first root if nothing distinguishes them."""
        q, start = ex.coordinate(name), {**(self.reference or {}), ex.TIME: ZERO}
        figures: list[float | None] = [None, None]
        why = "the branch through the reference configuration"
        if q in start:
            distances = (_figure(_sampled(substitute(v, start) - start[q])) for v in (first, second))
            figures = [None if d is None else abs(d) for d in distances]
        if None in figures or figures[0] == figures[1]:
            why = "the branch of lower potential energy where parameters are near 1 and coordinates near 0"
            figures = [_figure(_sampled(substitute(self.potential, _all(name, v, solved)))) for v in (first, second)]
        if None in figures or figures[0] == figures[1]:
            why = "the other root is the other branch"
            figures = [0.0, 1.0]
        taken, other = (first, second) if (figures[0] or 0) < (figures[1] or 0) else (second, first)
        note = f"{name} = {to_text(taken)} on the chosen branch ({why}); "
        return taken, f"{note}on the other branch, {name} = {to_text(other)}."


def _unsigned(e: Expr) -> Expr:
    """Return a product without its numerical factor."""
    return ex.mul(*(p for p in e.args if p.op != "num")) if e.op == "mul" else e


def _never_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether ``e`` is a number, or a product of numbers and of powers of positive parameters."""
    factors = e.args if e.op == "mul" else (e,)
    return all(p.op in ("num", "const") or (p.args[0] if p.op == "pow" else p) in positive for p in factors)


def _all(name: str, value: Expr, solved: Mapping[str, Expr]) -> dict[Expr, Expr]:
    values = {ex.coordinate(n): substitute(e, {ex.coordinate(name): value}) for n, e in solved.items()}
    return {**values, ex.coordinate(name): value}


def _sampled(e: Expr) -> Expr:
    """Return ``e`` at a fixed point, coordinates near 0 and parameters near 1, at which two roots are compared."""
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


def in_velocities(piece: Remaining) -> Expr:
    """Return the left side of a relation piece = 0 between velocities."""
    return piece.rate if isinstance(piece, Pfaffian) else piece.expr


def inserted(piece: Remaining, elimination: Elimination) -> Remaining:
    """Return a relation in the remaining coordinates, with the eliminated ones and their velocities inserted."""
    if not elimination.solved:
        return piece
    e = substitute(in_velocities(piece), motions(elimination.solved))
    if isinstance(piece, Finite):
        return Finite(e)
    form = linear_form(e) if isinstance(piece, Pfaffian) else None
    return Nonlinear(e) if form is None else form


def vanishes(piece: Remaining, positive: frozenset[Expr]) -> bool:
    """Return whether a relation is 0 = 0 identically, proved in the canonical ring."""
    return all(e.is_zero or is_identically_zero(e, positive) is True for e in expressions_of(piece))


def expressions_of(piece: Remaining) -> list[Expr]:
    """Return the coefficients of a form, or the expression that is 0."""
    return [*piece.coefficients.values(), piece.dt] if isinstance(piece, Pfaffian) else [piece.expr]


# Roots of squares


def without_roots(
    e: Expr, positive: frozenset[Expr], reference: Mapping[Expr, Expr] | None
) -> tuple[Expr, tuple[str, ...]]:
    """Return (``e`` with sqrt(u^2) replaced by u or -u, whichever is positive at the reference, notes about this).

    The length of a spring along a guide is such a root. Without a reference, or if u = 0 there, the root remains.
    """
    if reference is None:
        return e, ()
    notes: list[str] = []
    memo: dict[Expr, Expr] = {}
    for node in ex.nodes(e):
        new = ex.rebuild(node, tuple(memo[child] for child in ex.children(node)))
        if new.op == "pow" and new.args[1] == HALF and any(s.args[0] == "coordinate" for s in new.symbols):
            root = square_root(new.args[0], positive)
            here = None if root is None else _figure(substitute(root, {**reference, ex.TIME: ZERO}))
            if root is not None and here:
                new = ordered(root if here > 0 else -root)
                notes.append(f"The equations are valid while {to_text(new)} > 0, as in the reference configuration.")
        memo[node] = new
    return memo[e], tuple(dict.fromkeys(notes))
