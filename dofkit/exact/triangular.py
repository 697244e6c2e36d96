"""Points on the variety {g = 0} over GF(p), by solving the relations one unknown at a time.

A relation with an unknown of its own is set aside and solved last, for that unknown (peeling). What is left unassigned
is drawn at random, so a point is generic on its branch.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache

from dofkit.base.deadline import check
from dofkit.base.errors import NoValueError
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.ring.program import NoPointError, raising_no_value, value_of
from dofkit.exact.ring.ring import Ring
from dofkit.exact.unknowns import Unit, circle, root_relations, roots_of, units_in, univariate, value_along

#: Draws of a point before giving up (each square root that is asked for fails half the time).
DRAWS = 60


@dataclass
class Plan:
    """How points are found: ``steps`` in the order of solving; ``free`` unknowns are drawn at random.

    ``contradictory``: a relation between no unknowns does not hold; ``witness`` is that relation. ``stuck``: relations
    were left that cannot be solved one unknown at a time.
    """

    steps: list[tuple[int, Unit]] = field(default_factory=list)
    free: list[Unit] = field(default_factory=list)
    contradictory: bool = False
    witness: int = -1
    stuck: bool = False


class Planner:
    """Finds the `Plan` for some relations; ``fixed`` unknowns have their values.

    ``degree`` is that of a relation's numerator in an unknown, at one random point, the ``probe``.
    """

    def __init__(self, ring: Ring, fixed: frozenset[Unit], seed: int) -> None:
        self.ring, self.fixed = ring, fixed
        self.plan = Plan()
        self.probe = _point(ring, seed)
        self.degree = cache(self._degree)

    def _degree(self, node: int, unit: Unit) -> int:
        """Return the degree at random values of the other unknowns; 0 where it cannot be solved for this one."""
        try:
            return 0 if self.probe is None else max(0, int(univariate(self.ring, node, unit, self.probe).degree()))
        except NoValueError:
            return 0

    def plan_for(self, relations: Sequence[int]) -> Plan:
        """The plan for relations, those of the roots among them."""
        remaining, size, solved_last = list(relations), len(relations) + 1, list[tuple[int, Unit]]()
        everything = {u for node in relations for u in units_in(self.ring, node)}
        while self.probe is not None and len(remaining) < size and not self.plan.contradictory:
            check()
            size = len(remaining)
            self._peel(remaining, solved_last)
            remaining = self._settle(remaining)
        self.plan.stuck = self.probe is None or (bool(remaining) and not self.plan.contradictory)
        self.plan.steps = solved_last[::-1]
        self.plan.free = sorted(everything - {unit for _, unit in solved_last} - self.fixed)
        return self.plan

    def _peel(self, remaining: list[int], solved_last: list[tuple[int, Unit]]) -> None:
        """Set aside every relation that has a solvable unknown of its own."""
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
        probe, kept = self.probe, []
        assert probe is not None
        for node in remaining:
            check()
            if any(self.degree(node, u) for u in units_in(self.ring, node) - self.fixed):
                kept.append(node)
            elif value_along(self.ring, node, {}, probe) != 0 and not self.fixed:
                self.plan.contradictory, self.plan.witness = True, node
        return kept

    def _parameters_only(self, node: int) -> bool:
        """Return whether the relation is one between named parameters alone (generic geometry is not named)."""
        units = {u for u in units_in(self.ring, node) if self.degree(node, u)}
        return bool(units) and all(_is_parameter(self.ring, u) for u in units)


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
    """Return a random point at which functions of numbers, such as sqrt(pi), have a value; None where none is found."""
    numbers = [node for e, node in zip(ring.var_expr, ring.var_node, strict=True) if not e.symbols]
    for attempt in range(DRAWS):
        try:
            point = field_point([ring], seed + attempt)
            for node in numbers:
                value_of(ring, point, node)
            return point
        except NoValueError:
            continue
    return None


class TriangularSolver:
    """Plans and draws points on the zero set of some nodes of a ring."""

    def __init__(
        self, ring: Ring, relations: Sequence[int], fixed: frozenset[Unit] = frozenset(), seed: int = 0
    ) -> None:
        self.ring = ring
        planner = Planner(ring, fixed, seed)
        self.plan = planner.plan_for([*relations, *root_relations(ring, list(relations))])
        self.degree = planner.degree

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
        for _, index in self.plan.free:
            var = self.ring.vars[index]
            if var.kind == "root":
                point.set(var, point.random())

    def _solve(self, node: int, unit: Unit, point: FieldPoint) -> None:
        roots = roots_of(univariate(self.ring, node, unit, point))
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
