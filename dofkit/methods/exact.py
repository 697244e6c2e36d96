"""Rational arithmetic at one configuration: the drawing, or a rational point that the equations can be solved for."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from fractions import Fraction

from flint import fmpq, fmpq_mat, fmpz

from dofkit.base.errors import NoValueError, PoleError
from dofkit.base.verdicts import Verdict
from dofkit.exact.ring.program import Scalar, Var, raising_no_value, value_of
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.methods.as_written import (
    Matrix,
    SampledPoints,
    Written,
    WrittenRows,
    as_written,
    drawn_value,
    droppable,
    freedom,
    independent_at_reference,
    labels,
    look,
)
from dofkit.methods.ask import CONTRADICTORY
from dofkit.methods.table import Knobs, MethodReply, cannot
from dofkit.scene.scene import Scene
from dofkit.system import System

#: Draws of a rational point.
DRAWS = 8
IRRATIONAL = "a number that occurs is irrational, and only rational ones are computed with"
KINK = "something within abs() is 0 there, where there is no gradient"
NOWHERE = "no rational configuration is given, and none was found by solving the equations one after the other"


class IrrationalError(ArithmeticError):
    """A value is no rational number."""


class ContradictionError(ArithmeticError):
    """Linear equations have no solution."""


class RationalPoint:
    """Rational values of the symbols; functions of what is free are random too, on their circle if need be."""

    def __init__(self, rng: random.Random, free: bool) -> None:
        self.rng, self.free = rng, free
        self.values: dict[object, Scalar] = {}

    def number(self, value: Fraction) -> fmpq:
        return fmpq(value.numerator, value.denominator)

    def draw(self) -> fmpq:
        return fmpq(self.rng.randrange(1, 97), self.rng.choice((3, 5, 7, 8)))

    def generator(self, var: Var, args: Sequence[Scalar]) -> Scalar:
        key = var.key if var.kind == "symbol" else (var.kind, var.key)
        if key not in self.values:
            self._set(key, var, args)
        return self.values[key]

    def _set(self, key: object, var: Var, args: Sequence[Scalar]) -> None:
        if var.kind in ("cos", "sin"):
            cos, sin = self._turn(args[0])
            self.values["cos", var.key], self.values["sin", var.key] = cos, sin
        elif var.kind == "root":
            self.values[key] = rational_root(args[0], var.degree)
        elif var.kind == "sign":
            if args[0] == 0:
                raise IrrationalError(KINK)
            self.values[key] = fmpq(1 if args[0] > 0 else -1)
        elif var.kind == "symbol" or var.kind == "call" or self.free:
            self.values[key] = self.draw()
        elif args and args[0] == (1 if var.kind == "log" else 0):
            self.values[key] = fmpq(1 if var.kind == "exp" else 0)
        else:
            raise IrrationalError(IRRATIONAL)

    def _turn(self, angle: Scalar) -> tuple[fmpq, fmpq]:
        """cos and sin: of the angle 0, or of a free one, a random rational point of the circle."""
        if angle == 0:
            return fmpq(1), fmpq(0)
        if not self.free:
            raise IrrationalError(IRRATIONAL)
        w = self.draw()
        below = 1 + w * w
        return (1 - w * w) / below, 2 * w / below


def rational_root(value: fmpq, degree: int) -> fmpq:
    """The non-negative root of a rational number. Raises IrrationalError where it is none."""
    roots = []
    for part in (value.p, value.q):
        root = fmpz(part).root(degree) if part >= 0 else fmpz(-1)
        if root < 0 or root**degree != part:
            raise IrrationalError(IRRATIONAL)
        roots.append(root)
    return fmpq(*roots)


class Rationals:
    """The numbers of this method."""

    zero = fmpq(0)

    def rank(self, matrix: Matrix) -> int:
        return fmpq_mat(matrix).rank() if matrix and matrix[0] else 0

    def kernel(self, matrix: Matrix, columns: int) -> Matrix:
        """A basis of what all rows vanish on."""
        reduced, rank = fmpq_mat(matrix).rref() if matrix else (fmpq_mat(0, columns), 0)
        pivots = [next(c for c in range(columns) if reduced[r, c] != 0) for r in range(rank)]
        vectors = []
        for free in sorted(set(range(columns)) - set(pivots)):
            vector = [fmpq(0) for _ in range(columns)]
            vector[free] = fmpq(1)
            for r, c in enumerate(pivots):
                vector[c] = -reduced[r, free]
            vectors.append(vector)
        return vectors

    def vanishes(self, value: Scalar, scale: Sequence[Scalar]) -> bool:
        del scale
        return bool(value == 0)

    def points(self, written: Written, rows: WrittenRows, drawn: bool) -> list[RationalPoint]:
        if drawn:
            return [self._drawn(written)]
        order = solvable(written)
        if order is None and not _linear(written):
            return []
        for k in range(DRAWS):
            point = RationalPoint(random.Random(f"dofkit rational 0 {k}"), free=True)
            try:
                if order is None:
                    solved_together(written, point)
                else:
                    solved(written, rows.ring, order, point)
                value_of_all(rows, point)
            except (IrrationalError, NoValueError):
                continue
            return [point]
        return []

    def _drawn(self, written: Written) -> RationalPoint:
        point = RationalPoint(random.Random("dofkit rational 0"), free=False)
        for symbol, value in (written.system.reference or {}).items():
            point.values[symbol] = drawn_value(value, point)
        point.values[ex.TIME] = fmpq(0)
        return point


@raising_no_value
def value_of_all(rows: WrittenRows, point: RationalPoint) -> None:
    """Run the program once, so that every generator has its value."""
    rows.at(point, fmpq(0))


def solvable(written: Written) -> list[tuple[int, Expr]] | None:
    """An order in which each finite equation gives one symbol, in which it is linear, by those that are known then."""
    remaining = dict(enumerate(g for _, g in written.finite))
    movable = {*written.coordinates, *(ex.parameter(p) for p in written.system.generic)}
    order: list[tuple[int, Expr]] = []
    while remaining:
        ready = (
            (i, s)
            for i, g in remaining.items()
            for s in _private_symbols(i, remaining, movable)
            if s not in diff(g, s).symbols
        )
        step = next(ready, None)
        if step is None:
            return None
        order.append(step)
        del remaining[step[0]]
    return order[::-1]


def _private_symbols(i: int, remaining: Mapping[int, Expr], movable: set[Expr]) -> list[Expr]:
    """Symbols that only this equation holds of those that are left, in a fixed order."""
    mine = sorted(remaining[i].symbols & movable, key=repr)
    return [s for s in mine if not any(s in g.symbols for j, g in remaining.items() if j != i)]


@raising_no_value
def solved(written: Written, ring: Ring, order: Sequence[tuple[int, Expr]], point: RationalPoint) -> None:
    """Give values to the symbols that are solved for; raises PoleError where one cannot be."""
    relations = [g for _, g in written.finite]
    for i, symbol in order:
        slope = Ring([diff(relations[i], symbol)], written.positive)
        point.values[symbol] = fmpq(0)
        start = value_of(ring, point, ring.node(relations[i]))
        below = value_of(slope, point, slope.node(diff(relations[i], symbol)))
        if below == 0:
            raise PoleError
        point.values[symbol] = -start / below


def _linear(written: Written) -> bool:
    """Are the finite equations linear in the coordinates together?"""
    movable = set(written.coordinates)
    slopes = (diff(g, s) for _, g in written.finite for s in written.coordinates if s in g.symbols)
    return all(movable.isdisjoint(slope.symbols) for slope in slopes)


@raising_no_value
def solved_together(written: Written, point: RationalPoint) -> None:
    """Solve linear equations A q = b; what is free is drawn. Raises PoleError where there is no solution."""
    columns = written.coordinates
    for s in columns:
        point.values[s] = fmpq(0)
    rows = []
    for _, g in written.finite:
        slopes = [diff(g, s) for s in columns]
        ring = Ring([g, *slopes], written.positive)
        rows.append([value_of(ring, point, ring.node(e)) for e in (*slopes, g)])
    reduced, rank = fmpq_mat(rows).rref()
    pivots = [next(c for c in range(len(columns) + 1) if reduced[r, c] != 0) for r in range(rank)]
    if len(columns) in pivots:
        raise ContradictionError("the linear equations contradict each other")
    for c in set(range(len(columns))) - set(pivots):
        point.values[columns[c]] = point.draw()
    for r, c in enumerate(pivots):
        moved = sum((reduced[r, k] * point.values[columns[k]] for k in range(c + 1, len(columns))), fmpq(0))
        point.values[columns[c]] = -reduced[r, len(columns)] - moved


def _look(scene: Scene | System) -> tuple[SampledPoints, Rationals] | MethodReply:
    numbers = Rationals()
    written = as_written(scene)
    if written.system.tolerance is not None:
        return cannot("the geometry is measured, and rational arithmetic takes every number for exact")
    try:
        sampled = look(written, numbers)
    except IrrationalError as error:
        return cannot(str(error))
    except ContradictionError as error:
        return MethodReply(CONTRADICTORY, str(error))
    if sampled is None:
        return cannot(NOWHERE)
    if any(sampled.samples[0].residuals):
        return cannot("the reference configuration does not satisfy the equations")
    return sampled, numbers


def dof(scene: Scene | System, knobs: Knobs) -> MethodReply:
    """Coordinates less the rank of the Jacobian there, forms that pass Frobenius' test included."""
    del knobs
    samples = _look(scene)
    if isinstance(samples, MethodReply):
        return samples
    sure: Verdict = "proved" if independent_at_reference(*samples) else "undecided"
    return MethodReply(freedom(*samples), verdict=sure)


def integrability(scene: Scene | System, knobs: Knobs) -> MethodReply:
    """By Frobenius' test at that point."""
    del knobs
    samples = _look(scene)
    return _unless_contradictory(samples) if isinstance(samples, MethodReply) else MethodReply(labels(samples[0]))


def redundancy(scene: Scene | System, knobs: Knobs) -> MethodReply:
    """By the ranks there with and without each constraint."""
    del knobs
    samples = _look(scene)
    return _unless_contradictory(samples) if isinstance(samples, MethodReply) else MethodReply(droppable(*samples))


def _unless_contradictory(reply: MethodReply) -> MethodReply:
    """Where the constraints contradict each other there are no labels."""
    return MethodReply(None, reply.reason, reply.cannot)
