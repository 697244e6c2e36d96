"""Points on the variety {g = 0} over GF(p), by solving the relations one unknown at a time.

A relation with an unknown of its own is set aside and solved last, for that unknown (peeling); where no relation has
one, an unknown that enters some relation linearly is eliminated from the others. What is left unassigned is drawn at
random, so a point is generic on its branch.
"""

from __future__ import annotations

import random
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.ring.program import ADD, MUL, POW, NoPointError, raising_no_value, reachable
from dofkit.exact.ring.ring import Ring
from dofkit.exact.unknowns import Unit, circle, is_linear, root_relations, roots_of, units_in, univariate, value_along

#: An elimination that makes the program longer than this is given up.
MAX_CODE = 20_000
#: Draws of a point before giving up (each square root that is asked for fails half the time).
DRAWS = 60


@dataclass
class Plan:
    """How points are found: ``steps`` in the order of solving; ``free`` unknowns are drawn at random.

    ``contradictory``: elimination left a relation between no unknowns that does not hold.
    ``witness`` is that relation. ``special``: it left one between parameters only, which holds for special values.
    ``stuck``: relations were left that cannot be solved one unknown at a time. ``divided``: by a coefficient that may
    be 0 where the relations hold, so that nothing is said of what holds there.
    """

    steps: list[tuple[int, Unit]] = field(default_factory=list)
    free: list[Unit] = field(default_factory=list)
    contradictory: bool = False
    special: bool = False
    witness: int = -1
    stuck: bool = False
    divided: bool = False


class Planner:
    """Finds the `Plan` for some relations; ``fixed`` unknowns have their values.

    ``degree`` and ``is_linear`` are those of a relation's numerator in an unknown, at one random point, the ``probe``.
    """

    def __init__(self, ring: Ring, fixed: frozenset[Unit], seed: int) -> None:
        self.ring, self.fixed = ring, fixed
        self.rng = random.Random(f"dofkit plan {seed}")
        self.plan = Plan()
        self.probe = _point(ring, seed)
        self.degree, self.is_linear = cache(self._degree), cache(self._is_linear)

    def _degree(self, node: int, unit: Unit) -> int:
        """Return the degree at random values of the other unknowns; 0 where it cannot be solved for this one."""
        try:
            return 0 if self.probe is None else max(0, int(univariate(self.ring, node, unit, self.probe).degree()))
        except NoValueError:
            return 0

    def _is_linear(self, node: int, unit: Unit) -> bool:
        """Return whether the relation is a polynomial of degree 1 in the unknown, with no denominator in it."""
        try:
            return self.probe is not None and is_linear(self.ring, node, unit[1], self.probe)
        except NoValueError:
            return False

    def plan_for(self, relations: Sequence[int]) -> Plan:
        """The plan for relations, those of the roots among them; stuck where an elimination divides by 0 everywhere."""
        if self.probe is None:
            self.plan.stuck = True
            return self.plan
        everything = {u for node in relations for u in units_in(self.ring, node)}
        try:
            solved_last = self._solved_last(list(relations))
        except NoValueError:
            self.plan = Plan(stuck=True)
            return self.plan
        self.plan.steps = solved_last[::-1]
        self.plan.free = sorted(everything - {unit for _, unit in solved_last} - self.fixed)
        return self.plan

    def _solved_last(self, remaining: list[int]) -> list[tuple[int, Unit]]:
        """Return the steps, those that are taken last first."""
        solved_last: list[tuple[int, Unit]] = []
        while remaining:
            check()
            if self._peel(remaining, solved_last):
                continue
            remaining = self._settle(remaining)
            if not remaining or self.plan.contradictory:
                break
            eliminated = self._eliminate(remaining)
            if eliminated is not None:
                node, unit, remaining = eliminated
                solved_last.append((node, unit))
                continue
            self.plan.stuck = True
            break
        return solved_last

    def _peel(self, remaining: list[int], solved_last: list[tuple[int, Unit]]) -> bool:
        """Set aside every relation that has a solvable unknown of its own; True if there was one."""
        where: dict[Unit, set[int]] = defaultdict(set)
        of = {node: units_in(self.ring, node) - self.fixed for node in remaining}
        for node, units in of.items():
            for unit in units:
                where[unit].add(node)
        pending = [node for node in remaining if any(len(where[u]) == 1 for u in of[node])]
        peeled = set()
        for node in pending:
            if node in peeled:
                continue
            check()
            private = [u for u in of[node] if where[u] == {node}]
            best = self._best(node, private)
            if best is None:
                continue
            peeled.add(node)
            solved_last.append((node, best))
            for u in of[node]:
                where[u].discard(node)
                if len(where[u]) == 1:
                    pending.extend(where[u])
        remaining[:] = [node for node in remaining if node not in peeled]
        return bool(peeled)

    def _best(self, node: int, units: Sequence[Unit]) -> Unit | None:
        """Return the unknown of lowest degree; of equals, what is not a parameter, then by order."""
        if self._parameters_only(node):
            return None
        ranked = []
        for unit in units:
            degree = self.degree(node, unit)
            if degree:
                ranked.append((degree, _rank(self.ring, unit), unit))
        return min(ranked)[2] if ranked else None

    def _settle(self, remaining: list[int]) -> list[int]:
        """Drop relations between no unknowns that hold; notice those that do not."""
        probe = self.probe
        kept = []
        for node in remaining:
            check()
            if self._parameters_only(node):
                self.plan.special = True
            if any(self.degree(node, u) for u in units_in(self.ring, node) - self.fixed):
                kept.append(node)
            elif probe is not None and value_along(self.ring, node, {}, probe) == 0:
                continue
            elif not self.fixed:
                self.plan.contradictory, self.plan.witness = True, node
        return kept

    def _parameters_only(self, node: int) -> bool:
        """Return whether the relation is one between named parameters alone (generic geometry is not named)."""
        units = {u for u in units_in(self.ring, node) if self.degree(node, u)}
        return bool(units) and all(_is_parameter(self.ring, u) for u in units)

    def _eliminate(self, remaining: list[int]) -> tuple[int, Unit, list[int]] | None:
        """Solve one relation for an unknown that it holds linearly and put that into the others."""
        choices = []
        for node in remaining:
            check()
            for unit in units_in(self.ring, node) - self.fixed:
                if unit[0] == "var" and self.is_linear(node, unit):
                    size = len(reachable(self.ring, [node], through_generators=False))
                    choices.append((size, _rank(self.ring, unit), node, unit))
        if not choices:
            return None
        _, _, node, unit = min(choices)
        at_zero, slope = self._line(node, unit)
        self.plan.divided = self.plan.divided or self._may_be_zero(slope)
        solution = self.ring.emit(MUL, (self.ring.negative(at_zero), self.ring.emit(POW, (slope, -1))))
        others = [
            self.ring.replaced(other, {unit[1]: solution}) if unit in units_in(self.ring, other) else other
            for other in remaining
            if other != node
        ]
        others = [other for other in others if not self._vanishes(other)]
        return None if len(self.ring.code) > MAX_CODE else (node, unit, others)

    def _line(self, node: int, unit: Unit) -> tuple[int, int]:
        """Return the value at 0 and the coefficient of an unknown in a relation that is linear in it."""
        at_zero, at_one = (self.ring.replaced(node, {unit[1]: self.ring.number(n)}) for n in (0, 1))
        return at_zero, self.ring.emit(ADD, (at_one, self.ring.negative(at_zero)))

    def _may_be_zero(self, node: int) -> bool:
        """Return whether a coefficient holds unknowns, so that it may vanish where the relations hold."""
        moving = [u for u in units_in(self.ring, node) if not _is_parameter(self.ring, u)]
        try:
            return self.probe is None or any(univariate(self.ring, node, u, self.probe).degree() > 0 for u in moving)
        except NoValueError:
            return True

    def _vanishes(self, node: int) -> bool:
        """Return whether a relation holds for random values of all its unknowns: it says nothing new."""
        try:
            point = field_point([self.ring], self.rng.randrange(1 << 30))
            return bool(value_along(self.ring, node, {}, point) == 0)
        except NoValueError:
            return False


def _is_parameter(ring: Ring, unit: Unit) -> bool:
    var = ring.vars[unit[1]]
    if unit[0] == "angle" or var.kind != "symbol":
        return False
    kind, name = var.key.args
    return bool(kind == "parameter" and not name.startswith("_"))


def _rank(ring: Ring, unit: Unit) -> tuple[int, int]:
    var = ring.vars[unit[1]]
    if var.kind == "symbol":
        kind, name = var.key.args
        order = 0 if name.startswith("_") else {"velocity": 1, "coordinate": 2}.get(kind, 4)
    else:
        order = 3
    return (order, -unit[1])


def _point(ring: Ring, seed: int) -> FieldPoint | None:
    for attempt in range(DRAWS):
        try:
            return field_point([ring], seed + attempt)
        except NoPointError:
            continue
    return None


class TriangularSolver:
    """Plans and draws points on the zero set of some nodes of a ring.

    What was emitted for a plan that is stuck leaves the ring.
    """

    def __init__(
        self, ring: Ring, relations: Sequence[int], fixed: frozenset[Unit] = frozenset(), seed: int = 0
    ) -> None:
        self.ring = ring
        size = len(ring.code)
        planner = Planner(ring, fixed, seed)
        self.plan = planner.plan_for([*relations, *root_relations(ring, list(relations))])
        self.degree = planner.degree
        if self.plan.stuck:  # planning appends expressions to the ring: without a plan they are of no use
            ring.forget(size)

    def draw(self, seed: int) -> FieldPoint | None:
        """Return a random point on the zero set, or None where none was found."""
        return self._first_complete(lambda k: field_point([self.ring], seed * DRAWS + k), DRAWS)

    def completed(self, base: FieldPoint) -> FieldPoint | None:
        """Return a point on the zero set with the values that ``base`` gives, or None where none was found."""
        return self._first_complete(lambda _: base.copy(), DRAWS // 4)

    def _first_complete(self, begin: Callable[[int], FieldPoint], draws: int) -> FieldPoint | None:
        if self.plan.stuck or self.plan.contradictory:
            return None
        for k in range(draws):
            try:
                point = begin(k)
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
