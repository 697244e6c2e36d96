"""Equations of motion to grade by: what is right as expressions, and how an answer compares with it.

Lagrangians are the same where the difference satisfies Euler's equation identically (then it is a total derivative by
time). Equations of motion are the same where they allow the same accelerations: an answer's equation follows where the
accelerations of the scene's own equations satisfy it, and the system is complete where it fixes all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from itertools import permutations
from typing import Any, NamedTuple

from flint import nmod_mat

from dofkit.base.errors import DofkitError
from dofkit.exact.errors import NoValueError, raising_no_value
from dofkit.exact.points.field import field_point
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.solving.triangular import TriangularSolver
from dofkit.exact.zero.identity import zero_and_verdict
from dofkit.exact.zero.independence import independent_generators
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import MINUS_ONE, ONE, ZERO, Expr
from dofkit.motion.lagrange.derivation import derive
from dofkit.motion.lagrange.elimination import ELIMINATIONS
from dofkit.motion.lagrange.equations import derived_of, read
from dofkit.motion.lagrange.model import in_velocities
from dofkit.motion.lagrange.rates import by_time
from dofkit.relations.normal.normal_form import Finite, Pfaffian
from dofkit.scene.scene import Scene

#: Points over GF(p), and how many are tried for them.
POINTS, ATTEMPTS = 3, 40
#: Systems up to this size are solved by Cramer's rule where points alone may mislead.
BY_CRAMER = 3
#: Larger expressions are not compared.
MOST_NODES = 4000


@dataclass(frozen=True)
class Sought:
    """What is right: in the coordinates that are kept.

    ``motions`` replaces what is eliminated, ``rates`` the velocities that constraints give by others. ``rows`` are
    d/dt of the constraints that keep a multiplier, ``relations`` those of them that hold between coordinates.
    """

    names: tuple[str, ...]
    lagrangian: Expr
    total: Expr
    momenta: Mapping[str, Expr]
    forces: Mapping[str, Expr]
    equations: Mapping[str, Expr]
    multipliers: tuple[Expr, ...]
    motions: Mapping[Expr, Expr]
    rates: Mapping[Expr, Expr]
    rows: tuple[Expr, ...]
    relations: tuple[Expr, ...]
    unreduced: Mapping[str, tuple[Expr, Expr]]
    positive: frozenset[Expr]

    def inserted(self, e: Expr) -> Expr:
        """An answer in the coordinates that are kept."""
        return substitute(e, self.motions)

    def moved(self, e: Expr) -> Expr:
        """The same where the constraints hold."""
        return substitute(e, self.rates)

    def zero(self, e: Expr) -> bool | None:
        """Is an expression 0 where the constraints hold? None where that was not decided."""
        moved = self.moved(e)
        found = is_zero(moved, self.positive)
        return found if found is not False or not self.relations else self._zero_there(moved)

    def _zero_there(self, e: Expr) -> bool | None:
        """At points where the finite relations hold."""
        ring = Ring([e, *self.relations], self.positive)
        node = ring.node(e)
        told = [found[node] == 0 for _, found in places(ring, self.relations)]
        if len(told) < POINTS:
            return None
        return all(told) if all(told) or independent_generators(ring) else None


def places(ring: Ring, relations: Sequence[Expr]) -> Iterator[tuple[int, Any]]:
    """Random points over GF(p) where the relations hold, a few: the prime, and the values of the ring's nodes."""
    solver = TriangularSolver(ring, [ring.node(g) for g in relations], seed=3) if relations else None
    found = 0
    for seed in range(ATTEMPTS):
        point = field_point([ring], 500 + seed) if solver is None else solver.draw(500 + seed)
        if point is None:
            return
        try:
            at = values(ring, point)
        except NoValueError:
            continue
        yield point.p, at
        found += 1
        if found == POINTS:
            return


def sought(scene: Scene, whole: bool = False) -> Sought:
    """What is right of a scene; ``whole``: with nothing eliminated. Raises DofkitError without equations of motion."""
    derived = derive(read(scene).model(ELIMINATIONS[-1])) if whole else derived_of(scene)
    model = derived.model
    rates: dict[Expr, Expr] = {}
    for piece in model.constraints:
        if isinstance(piece, (Pfaffian, Finite)):
            form = by_time(piece.expr) if isinstance(piece, Finite) else in_velocities(piece)
            _solved(form, rates, model.positive)
    given = model.whole
    unreduced = {}
    for c in model.study.system.coordinates:
        v = ex.velocity(c.name)
        force = diff(given.lagrangian, ex.coordinate(c.name)) - diff(given.dissipation, v)
        pair = (diff(given.lagrangian, v), force + given.forces.get(c.name, ZERO))
        unreduced[c.name] = (substitute(pair[0], model.motions), substitute(pair[1], model.motions))
    rows = [by_time(by_time(p.expr)) if isinstance(p, Finite) else by_time(in_velocities(p)) for p in model.constraints]
    return Sought(
        model.names,
        derived.lagrangian,
        model.energy.kinetic + model.energy.potential,
        derived.momenta,
        derived.forces,
        derived.equations,
        tuple(ex.parameter(n) for n in derived.multipliers),
        model.motions,
        rates,
        tuple(rows),
        tuple(model.holonomic),
        unreduced,
        model.positive,
    )


def _solved(form: Expr, rates: dict[Expr, Expr], positive: frozenset[Expr]) -> None:
    """One more velocity by the others, from a form that is 0."""
    form = substitute(form, rates)
    for v in sorted((s for s in form.symbols if s.args[0] == "velocity"), key=lambda s: s.args):
        slope = diff(form, v)
        if is_zero(slope, positive) is False:
            value = -substitute(form, {v: ZERO}) / slope
            rates.update({w: substitute(e, {v: value}) for w, e in rates.items()})
            rates[v] = value
            return


def is_zero(e: Expr, positive: frozenset[Expr]) -> bool | None:
    """Zero identically? None where it is too large, has no value or was told by figures only."""
    if sum(1 for _ in ex.nodes(e)) > MOST_NODES:
        return None
    try:
        found, verdict = zero_and_verdict(e, positive)
    except ArithmeticError:
        return None
    return None if found and verdict not in ("proved", "probable") else found


def euler(e: Expr, name: str) -> Expr:
    """d/dt de/dqdot - de/dq."""
    return by_time(diff(e, ex.velocity(name))) - diff(e, ex.coordinate(name))


def same_lagrangian(answer: Expr, right: Expr, known: Sought) -> bool | None:
    """Is the difference a total derivative by time? Euler's equation of it is then 0 identically, and only then.

    Beside finite relations it is enough that it gives no other force than the relations do, where they hold.
    """
    gap = answer - right
    if any(s.args[0] == "acceleration" for s in gap.symbols):
        return None
    forces = [euler(gap, n) for n in known.names]
    told = [is_zero(e, known.positive) for e in forces]
    if False in told and known.relations:
        return _spanned(forces, known)
    return False if False in told else None if None in told else True


def _spanned(forces: Sequence[Expr], known: Sought) -> bool | None:
    """Are forces sums of those of the constraints, at every state and acceleration that these allow?"""
    columns = [ex.sym("acceleration", n) for n in known.names]
    lines = [linear(known.moved(e), columns) for e in forces]
    held = [linear(known.moved(e), columns) for e in known.rows]
    if None in lines or None in held:
        return None
    ring = Ring([e for row in (*lines, *held) for e in row or ()] + [*known.relations], known.positive)
    nodes = [[[ring.node(e) for e in row or ()] for row in rows] for rows in (lines, held)]
    told = []
    for p, at in places(ring, known.relations):
        own, rows = ([[int(at[i]) for i in row] for row in part] for part in nodes)
        moving = _accelerations(rows, p)
        if moving is None:
            continue
        force = [(_dot(row[:-1], moving) + row[-1]) % p for row in own]
        gradients = [row[:-1] for row in rows]
        told.append(_rank_of([*gradients, force], p) == _rank_of(gradients, p))
    if len(told) < POINTS:
        return None
    return all(told) if all(told) or independent_generators(ring) else None


def _accelerations(rows: Sequence[Sequence[int]], p: int) -> list[int] | None:
    """Some accelerations that satisfy rows whose last entry is the constant term, random where they are free."""
    n = len(rows[0]) - 1
    chosen = [pow(3, 7 + i, p) for i in range(n)]
    reduced, rank = nmod_mat([list(row) for row in rows], p).rref()
    for i in range(int(rank)):
        row = [int(reduced[i, j]) for j in range(n + 1)]
        pivot = next(j for j, v in enumerate(row) if v)
        if pivot == n:
            return None
        chosen[pivot] = (-row[n] - sum(v * chosen[j] for j, v in enumerate(row[:n]) if j > pivot)) % p
    for i in range(int(rank) - 1, -1, -1):
        row = [int(reduced[i, j]) for j in range(n + 1)]
        pivot = next(j for j, v in enumerate(row) if v)
        chosen[pivot] = (-row[n] - sum(v * chosen[j] for j, v in enumerate(row[:n]) if j != pivot)) % p
    return chosen


class MotionSameness(Enum):
    """How an equation of motion compares with the scene's; the value is a stable code."""

    FOLLOWS = "FOLLOWS"
    NOT = "WRONG_MOTION"
    TRIVIAL = "NO_ACCELERATION"


@dataclass(frozen=True)
class Answered:
    """Equations of an answer (each is 0) beside those that are right; ``own``: the answer's names for multipliers."""

    known: Sought
    equations: tuple[Expr, ...]
    own: tuple[Expr, ...] = ()

    @cached_property
    def columns(self) -> list[Expr]:
        """The accelerations of the coordinates kept."""
        return [ex.sym("acceleration", n) for n in self.known.names]

    @cached_property
    def rows(self) -> list[list[Expr]] | None:
        """Coefficients of accelerations and own multipliers, and the rest; None where the equations are not linear."""
        found = []
        unknown = [*self.columns, *self.own]
        for e in self.equations:
            e = self.known.moved(self.known.inserted(_in_time(e)))
            row = linear(e, unknown)
            if row is None:
                return None
            found.append(row)
        return found

    @cached_property
    def right(self) -> list[list[Expr]]:
        """The same of the scene's equations with their multipliers, and the constraints' accelerations."""
        unknown = [*self.columns, *self.known.multipliers]
        given = [*self.known.equations.values(), *self.known.rows]
        return [row for e in given if (row := linear(self.known.moved(e), unknown)) is not None]

    @property
    def decidable(self) -> bool:
        """Can it be decided at points: is everything linear?"""
        whole = len(self.known.names) + len(self.known.multipliers)
        return self.rows is not None and len(self.right) == whole

    def follow(self) -> tuple[list[MotionSameness], int] | None:
        """How each equation compares, and how many accelerations those that follow fix; None where it is open.

        Multipliers of the answer's own may have any value: an equation follows where there is one at which the
        scene's accelerations satisfy all that hold it.
        """
        rows = self.rows
        if rows is None or not self.decidable:
            return None
        ring = Ring([*(e for row in (*rows, *self.right) for e in row), *self.known.relations], self.known.positive)
        given = [[ring.node(e) for e in row] for row in rows]
        right = [[ring.node(e) for e in row] for row in self.right]
        told = list(_at_points(ring, right, given, len(self.columns), self.known))
        if not told:
            return None
        sound = [all(t.sound[i] for t in told) for i in range(len(rows))]
        if not all(sound) and not independent_generators(ring):
            exact = self._by_cramer()
            if exact is None:
                return None
            sound = exact
        n = len(self.columns)
        rank = max(t.rank if all(sound) else t.sound_rank(sound, n) for t in told)
        still = [not any(v for t in told for v in t.rows[i][:n]) for i in range(len(rows))]
        return [_verdict(s, z) for s, z in zip(sound, still, strict=True)], rank

    def _by_cramer(self) -> list[bool] | None:
        """Which equations the accelerations satisfy, identically: det(M) times the equation, by Cramer's rule."""
        n = len(self.columns)
        if self.own or self.known.multipliers or n > BY_CRAMER or self.rows is None:
            return None
        matrix = [row[:n] for row in self.right]
        rest = [row[n] for row in self.right]
        whole = determinant(matrix)
        solved = [determinant([[*r[:j], ex.mul(MINUS_ONE, b), *r[j + 1 :]] for r, b in zip(matrix, rest, strict=True)])
                  for j in range(n)]  # fmt: skip
        sums = [ex.add(row[n] * whole, *(a * s for a, s in zip(row[:n], solved, strict=True))) for row in self.rows]
        told = [is_zero(e, self.known.positive) for e in sums]
        return None if None in told else [t is True for t in told]


def _verdict(sound: bool, still: bool) -> MotionSameness:
    if not sound:
        return MotionSameness.NOT
    return MotionSameness.TRIVIAL if still else MotionSameness.FOLLOWS


class PointFindings(NamedTuple):
    """At one point over GF(p): which rows follow, the rank of all, and the rows."""

    sound: list[bool]
    rank: int
    rows: list[list[int]]
    p: int

    def sound_rank(self, sound: Sequence[bool], n: int) -> int:
        """The rank of the accelerations in the rows that follow everywhere, if they hold no multipliers."""
        return _rank_of([row[:n] for row, s in zip(self.rows, sound, strict=True) if s and not any(row[n:-1])], self.p)


def _at_points(
    ring: Ring, right: Sequence[Sequence[int]], given: Sequence[Sequence[int]], n: int, known: Sought
) -> Iterator[PointFindings]:
    """At random points: which rows hold with the right accelerations, and the rank of all."""
    constraints = len(known.rows)
    for p, at in places(ring, known.relations):
        rows = [[int(at[i]) for i in row] for row in right]
        try:
            solution = _solve(rows, p)
        except NoValueError:
            continue
        own = [[int(at[i]) for i in row] for row in given]
        inserted = [[*row[n:-1], (row[-1] + _dot(row[:n], solution[:n])) % p] for row in own]
        sound = _consistent(inserted, p)
        held = rows[len(rows) - constraints :] if constraints else []
        width = len(own[0]) - 1 - n if own else 0
        every = [row[:-1] for row in own] + [[*row[:n], *([0] * width)] for row in held]
        rank = _rank_of(every, p) - _rank_of([row[n:-1] for row in own], p) if own else 0
        yield PointFindings(sound, rank - (_rank_of([row[:n] for row in held], p) if held else 0), own, p)


def _dot(a: Sequence[int], b: Sequence[int]) -> int:
    return sum(x * y for x, y in zip(a, b, strict=True))


@raising_no_value
def _solve(rows: list[list[int]], p: int) -> list[int]:
    """The solution of rows whose last entry is the constant term."""
    if not rows:
        return []
    matrix = nmod_mat([row[:-1] for row in rows], p)
    column = nmod_mat([[-row[-1] % p] for row in rows], p)
    found = matrix.solve(column)
    return [int(found[i, 0]) for i in range(len(rows))]


def _consistent(rows: list[list[int]], p: int) -> list[bool]:
    """For each row (own multipliers, constant): can it hold together with the rows before it that can?"""
    kept: list[list[int]] = []
    told = []
    for row in rows:
        tried = [*kept, row]
        holds = _rank_of(tried, p) == _rank_of([r[:-1] for r in tried], p)
        told.append(holds)
        if holds:
            kept = tried
    return told


def _rank_of(rows: Sequence[Sequence[int]], p: int) -> int:
    return int(nmod_mat([list(row) for row in rows], p).rank()) if rows and rows[0] else 0


def _in_time(e: Expr) -> Expr:
    """Differentials read as velocities."""
    rates = {s: ex.velocity(str(s.args[1])) for s in e.symbols if s.args[0] == "differential"}
    return substitute(e, {**rates, **{s: ONE for s in e.symbols if s.args[0] == "dt"}})


def linear(e: Expr, unknown: Sequence[Expr]) -> list[Expr] | None:
    """The coefficients of unknowns and what is left without them; None where ``e`` is not linear as written."""
    row = [diff(e, s) for s in unknown]
    moving = {*unknown}
    if any(c.symbols & moving or any(s.args[0] == "acceleration" for s in c.symbols) for c in row):
        return None
    rest = substitute(e, dict.fromkeys(unknown, ZERO))
    if any(s.args[0] in ("acceleration", "differential", "dt") for s in rest.symbols):
        return None
    return [*row, rest]


def determinant(rows: Sequence[Sequence[Expr]]) -> Expr:
    """By Leibniz's formula, for a few rows."""
    terms = []
    for order in permutations(range(len(rows))):
        swaps = sum(a > b for i, a in enumerate(order) for b in order[i + 1 :])
        terms.append(ex.mul(MINUS_ONE if swaps % 2 else ONE, *(rows[i][j] for i, j in enumerate(order))))
    return ex.add(*terms)


def sought_or_why(scene: Scene, whole: bool = False) -> Sought | DofkitError:
    """What is right of a scene, or why it is not known."""
    try:
        return sought(scene, whole)
    except DofkitError as error:
        return error
