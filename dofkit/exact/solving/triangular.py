"""Points on the variety {g = 0} over GF(p), by solving the relations one unknown at a time.

What the plan leaves unassigned is drawn at random, so a point is generic on its branch.
"""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.exact.errors import NoPointError, NoValueError, raising_no_value
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.ring.ring import Ring
from dofkit.exact.solving.plan import DRAWS, plan_for
from dofkit.exact.solving.unknowns import Unit, circle, roots_of, univariate


class TriangularSolver:
    """Plans and draws points on the zero set of some nodes of a ring."""

    def __init__(
        self, ring: Ring, relations: Sequence[int], fixed: frozenset[Unit] = frozenset(), seed: int = 0
    ) -> None:
        self.ring = ring
        self.plan, self._degrees = plan_for(ring, relations, fixed, seed)

    def degree(self, node: int, unit: Unit) -> int:
        """The degree of a relation's numerator in one unknown at random values of the others; 0: unsolvable."""
        return self._degrees.degree(node, unit)

    def draw(self, seed: int) -> FieldPoint | None:
        """A random point on the zero set, or None where none was found."""
        if self.plan.stuck or self.plan.contradictory:
            return None
        for attempt in range(DRAWS):
            try:
                point = field_point([self.ring], seed * DRAWS + attempt)
                self._complete(point)
            except NoValueError:
                continue
            return point
        return None

    def completed(self, base: FieldPoint) -> FieldPoint | None:
        """A point on the zero set with the values that ``base`` gives, or None where none was found."""
        if self.plan.stuck or self.plan.contradictory:
            return None
        for _ in range(DRAWS // 4):
            point = base.copy()
            try:
                self._complete(point)
            except NoValueError:
                continue
            return point
        return None

    @raising_no_value
    def _complete(self, point: FieldPoint) -> None:
        self._preset_roots(point)
        for node, unit in self.plan.steps:
            self._solve(node, unit, point)

    def _preset_roots(self, point: FieldPoint) -> None:
        """Roots that are free unknowns are drawn here, so that their radicands are solved for them."""
        for kind, index in self.plan.free:
            var = self.ring.vars[index]
            if kind == "var" and var.kind == "root":
                point.set(var, point.random())

    def _solve(self, node: int, unit: Unit, point: FieldPoint) -> None:
        polynomial = univariate(self.ring, node, unit, point)
        if polynomial.degree() < 0:
            raise NoPointError("the relation does not determine the unknown")
        roots = roots_of(polynomial)
        if not roots:
            raise NoPointError("no root")
        value = point.rng.choice(roots)
        var = self.ring.vars[unit[1]]
        if unit[0] == "var":
            point.set(var, value)
            return
        below = 5 * (1 + value * value)
        cos, sin = (top / below for top in circle(value, value * 0 + 1))
        partner = self.ring.vars[var.partner]
        point.set(var, cos if var.kind == "cos" else sin)
        point.set(partner, sin if var.kind == "cos" else cos)
