"""Rational arithmetic at one configuration: the reference, or a rational point that the equations can be solved for."""

from __future__ import annotations

import random
from collections.abc import Collection, Mapping, Sequence
from functools import partial

from flint import fmpq, fmpq_mat

from dofkit.base.errors import NoValueError
from dofkit.exact.points.balls import ExactPoint
from dofkit.exact.residues import null_vectors
from dofkit.exact.ring.program import NoPointError, Scalar, Var, raising_no_value
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, expand
from dofkit.expressions.tree import Expr
from dofkit.methods.as_written import (
    Decider,
    Matrix,
    SampledPoints,
    Written,
    WrittenRows,
    as_written,
    drawn_value,
    questions_at_points,
    sampled_points,
)
from dofkit.methods.table import CONTRADICTORY, Reply, cannot
from dofkit.relations.linear_relations import explicit_relations
from dofkit.scene.scene import Scene
from dofkit.system import System

#: Attempts to find a random rational point.
DRAWS = 8
IRRATIONAL = "a number that occurs is irrational, and only rational ones are computed with"
KINK = "something within abs() is 0 there, where there is no gradient"
NOWHERE = "no rational configuration is given, and none was found by solving the equations one after the other"


class IrrationalError(ArithmeticError):
    """A value is not a rational number, or a gradient does not exist."""


class ContradictionError(ArithmeticError):
    """The linear equations have no solution."""


class RationalPoint(ExactPoint):
    """Rational values of symbols; if ``free``, missing values are random, (cos, sin) on the unit circle."""

    def __init__(self, rng: random.Random, free: bool) -> None:
        super().__init__({})
        self.rng, self.free = rng, free
        self.values: dict[object, Scalar] = {}

    def draw(self) -> fmpq:
        return fmpq(self.rng.randrange(1, 97), self.rng.choice((3, 5, 7, 8)))

    def generator(self, var: Var, args: Sequence[Scalar]) -> Scalar:
        """Return the value of a generator of the ring at this point, which is chosen at the first call."""
        key = var.key if var.kind == "symbol" else (var.kind, var.key)
        if key not in self.values:
            self._set(key, var, args)
        return self.values[key]

    def _set(self, key: object, var: Var, args: Sequence[Scalar]) -> None:
        """Choose the value of a generator with these arguments. Raises IrrationalError if it has no rational value."""
        if var.kind in ("cos", "sin"):
            cos, sin = self._turn(args[0])
            self.values["cos", var.key], self.values["sin", var.key] = cos, sin
        elif var.kind == "sign":
            if args[0] == 0:
                raise IrrationalError(KINK)
            self.values[key] = fmpq(1 if args[0] > 0 else -1)
        elif var.kind in ("symbol", "call") or (self.free and var.kind != "root"):
            self.values[key] = self.draw()
        else:
            try:
                self.values[key] = super().generator(var, args)
            except NoPointError:
                raise IrrationalError(IRRATIONAL) from None

    def _turn(self, angle: Scalar) -> tuple[fmpq, fmpq]:
        """Return (cos, sin): (1, 0) for the angle 0, a random rational point of the circle for a free angle."""
        if angle == 0:
            return fmpq(1), fmpq(0)
        if not self.free:
            raise IrrationalError(IRRATIONAL)
        w = self.draw()
        below = 1 + w * w
        return (1 - w * w) / below, 2 * w / below


class Rationals:
    """The arithmetic of this method: rational numbers."""

    zero = fmpq(0)

    def rank(self, matrix: Matrix) -> int:
        return fmpq_mat(matrix).rank() if matrix and matrix[0] else 0

    def kernel(self, matrix: Matrix, columns: int) -> Matrix:
        """Return a basis of the kernel of a matrix."""
        return null_vectors(fmpq_mat(matrix) if matrix else fmpq_mat(0, columns))

    def vanishes(self, value: Scalar, scale: Sequence[Scalar]) -> bool:
        del scale
        return bool(value == 0)

    def points(self, written: Written, rows: WrittenRows, drawn: bool) -> list[RationalPoint]:
        """Return one rational point on the relations, or none; ``drawn``: the reference configuration."""
        if drawn:
            return [self._reference_point(written)]
        movable = {*written.coordinates, *(ex.parameter(p) for p in written.system.generic)}
        relations = [expand(g) for _, g in written.finite]
        if explicit_relations(relations).contradictory:
            raise ContradictionError("the linear equations contradict each other")
        solution = explicit_relations(relations, partial(linear_symbols, movable))
        for k in range(0 if solution.implicit else DRAWS):
            point = RationalPoint(random.Random(f"dofkit rational 0 {k}"), free=True)
            try:
                give_values(point, solution.by_others, rows)
            except (IrrationalError, NoValueError):
                continue
            return [point]
        return []

    def _reference_point(self, written: Written) -> RationalPoint:
        point = RationalPoint(random.Random("dofkit rational 0"), free=False)
        for symbol, value in (written.system.reference or {}).items():
            point.values[symbol] = drawn_value(value, point)
        point.values[ex.TIME] = fmpq(0)
        return point


def linear_symbols(movable: Collection[Expr], g: Expr) -> dict[Expr, Expr]:
    """Return {symbol: coefficient} of the ``movable`` symbols that occur linearly in one term only of ``g``."""
    terms = g.args if g.op == "add" else (g,)
    result = {}
    for s in sorted(g.symbols.intersection(movable), key=repr):
        (term, *others), slope = [t for t in terms if s in t.symbols], diff(g, s)
        if not others and s in (term, *(term.args if term.op == "mul" else ())) and s not in slope.symbols:
            result[s] = slope
    return result


@raising_no_value
def give_values(point: RationalPoint, solved: Mapping[Expr, Expr], rows: WrittenRows) -> None:
    """Give ``point`` the values of the ``solved`` symbols, and random values of all other symbols in the equations."""
    point.values |= {s: drawn_value(value, point) for s, value in solved.items()}
    rows.at(point, fmpq(0))


def _points_of(scene: Scene | System) -> tuple[SampledPoints, Decider] | Reply:
    """Return the rows at a rational point with the arithmetic, or the reply if there is no such point."""
    numbers = Rationals()
    written = as_written(scene)
    if written.system.tolerance is not None:
        return cannot("the geometry is measured, and rational arithmetic takes every number for exact")
    try:
        sampled = sampled_points(written, numbers)
    except IrrationalError as error:
        return cannot(str(error))
    except ContradictionError as error:
        return Reply(CONTRADICTORY, reason=str(error))
    if sampled is None:
        return cannot(NOWHERE)
    if any(sampled.samples[0].residuals):
        return cannot("the reference configuration does not satisfy the equations")
    return sampled, numbers


dof, integrability, redundancy = questions_at_points(_points_of, lambda sampled, numbers: "proved")
