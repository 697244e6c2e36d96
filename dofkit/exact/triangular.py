"""Points on the variety {g = 0} over GF(p), by solving the relations one unknown at a time.

A relation with an unknown that occurs in no other is set aside and solved last, for that unknown (peeling). Unknowns
for which no relation is solved have random values, so that a point is generic on its branch.
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
from dofkit.exact.unknowns import Unknown, circle, root_relations, roots_of, univariate, unknowns_in, value_along

#: Attempts at a point before giving up (half of all numbers have no square root modulo p).
DRAWS = 60


@dataclass
class Plan:
    """How points are computed: ``steps`` are (relation, unknown solved for) in order; ``free`` unknowns are random.

    ``contradictory``: a relation without unknowns is not satisfied; ``witness`` is that relation. ``stuck``: some
    relations cannot be solved one unknown at a time.
    """

    steps: list[tuple[int, Unknown]] = field(default_factory=list)
    free: list[Unknown] = field(default_factory=list)
    contradictory: bool = False
    witness: int = -1
    stuck: bool = False


class Planner:
    """Makes the `Plan` for some relations; ``fixed`` unknowns have values already and are not solved for.

    ``degree(relation, unknown)`` is evaluated at one random point, the ``probe`` (None if there is none).
    """

    def __init__(self, ring: Ring, fixed: frozenset[Unknown], seed: int) -> None:
        self.ring, self.fixed = ring, fixed
        self.plan = Plan()
        self.probe = _point(ring, seed)
        self.degree = cache(self._degree)

    def _degree(self, node: int, unknown: Unknown) -> int:
        """Return the degree in ``unknown`` of the numerator of a relation ``node``; -1 if it is not known."""
        try:
            return -1 if self.probe is None else max(0, int(univariate(self.ring, node, unknown, self.probe).degree()))
        except NoValueError:
            return -1

    def plan_for(self, relations: Sequence[int]) -> Plan:
        """Return the plan for relations, which must include those of the roots (`root_relations`)."""
        remaining, size, solved_last = list(relations), len(relations) + 1, list[tuple[int, Unknown]]()
        everything = {u for node in relations for u in unknowns_in(self.ring, node)}
        while self.probe is not None and len(remaining) < size and not self.plan.contradictory:
            check()
            size = len(remaining)
            self._peel(remaining, solved_last)
            remaining = self._settle(remaining)
        self.plan.stuck = self.probe is None or (bool(remaining) and not self.plan.contradictory)
        self.plan.steps = solved_last[::-1]
        self.plan.free = sorted(everything - {unknown for _, unknown in solved_last} - self.fixed)
        return self.plan

    def _peel(self, remaining: list[int], solved_last: list[tuple[int, Unknown]]) -> None:
        """Move every relation with a solvable unknown that occurs in no other from ``remaining`` to ``solved_last``."""
        containing: dict[Unknown, set[int]] = defaultdict(set)
        unknowns_of = {node: unknowns_in(self.ring, node) - self.fixed for node in remaining}
        for node, unknowns in unknowns_of.items():
            for unknown in unknowns:
                containing[unknown].add(node)
        pending = [node for node in remaining if any(len(containing[u]) == 1 for u in unknowns_of[node])]
        peeled = set()
        for node in pending:
            if node in peeled:
                continue
            check()
            private = [u for u in unknowns_of[node] if containing[u] == {node}]
            best = self._best(node, private)
            if best is None:
                continue
            peeled.add(node)
            solved_last.append((node, best))
            for u in unknowns_of[node]:
                containing[u].discard(node)
                if len(containing[u]) == 1:
                    pending.extend(containing[u])
        remaining[:] = [node for node in remaining if node not in peeled]

    def _best(self, node: int, unknowns: Sequence[Unknown]) -> Unknown | None:
        """Return the unknown of lowest degree, then lowest `_rank`; None if none is solvable or all are parameters."""
        if self._parameters_only(node):
            return None
        ranked = []
        for unknown in unknowns:
            degree = self.degree(node, unknown)
            if degree > 0:
                ranked.append((degree, _rank(self.ring, unknown), unknown))
        return min(ranked)[2] if ranked else None

    def _settle(self, remaining: list[int]) -> list[int]:
        """Return the relations with unknowns; record in the plan one without unknowns that is not satisfied."""
        probe, kept = self.probe, []
        assert probe is not None
        for node in remaining:
            check()
            if any(self.degree(node, u) for u in unknowns_in(self.ring, node) - self.fixed):
                kept.append(node)
            elif value_along(self.ring, node, {}, probe) != 0 and not self.fixed:
                self.plan.contradictory, self.plan.witness = True, node
        return kept

    def _parameters_only(self, node: int) -> bool:
        """Return whether all unknowns of a relation are named parameters."""
        unknowns = {u for u in unknowns_in(self.ring, node) if self.degree(node, u)}
        return bool(unknowns) and all(_is_parameter(self.ring, u) for u in unknowns)


def _is_parameter(ring: Ring, unknown: Unknown) -> bool:
    """Return whether an unknown is a parameter of the scene, not one that dofkit introduced (with the prefix _)."""
    var = ring.vars[unknown[1]]
    if unknown[0] == "angle" or var.kind != "symbol":
        return False
    kind, name = var.key.args
    return bool(kind == "parameter" and not name.startswith("_"))


def _rank(ring: Ring, unknown: Unknown) -> tuple[int, int]:
    """Return a sort key: unnamed parameters, velocities, coordinates, functions, other symbols; later ones first."""
    var = ring.vars[unknown[1]]
    if var.kind == "symbol":
        kind, name = var.key.args
        order = 0 if name.startswith("_") else {"velocity": 1, "coordinate": 2}.get(kind, 4)
    else:
        order = 3
    return (order, -unknown[1])


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
    """Computes random points on the zero set of ``relations``, nodes of a ring, by a `Plan`."""

    def __init__(
        self, ring: Ring, relations: Sequence[int], fixed: frozenset[Unknown] = frozenset(), seed: int = 0
    ) -> None:
        self.ring = ring
        planner = Planner(ring, fixed, seed)
        self.plan = planner.plan_for([*relations, *root_relations(ring, list(relations))])
        self.degree = planner.degree

    def draw(self, seed: int) -> FieldPoint | None:
        """Return a random point on the zero set; None if there is no plan or `DRAWS` attempts fail."""
        return self._first_complete(lambda k: field_point([self.ring], seed * DRAWS + k), DRAWS)

    def completed(self, base: FieldPoint) -> FieldPoint | None:
        """Return a point on the zero set with the values of the fixed unknowns at ``base``, or None."""
        return self._first_complete(lambda _: base.copy(), DRAWS // 4)

    def _first_complete(self, begin: Callable[[int], FieldPoint], draws: int) -> FieldPoint | None:
        """Return the first of the points begin(0), begin(1), ... that can be completed, or None."""
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
        for node, unknown in self.plan.steps:
            self._solve(node, unknown, point)

    def _preset_roots(self, point: FieldPoint) -> None:
        """Set roots that are free unknowns to random values; relations are then solved for their radicands."""
        for _, index in self.plan.free:
            var = self.ring.vars[index]
            if var.kind == "root":
                point.set(var, point.random())

    def _solve(self, node: int, unknown: Unknown, point: FieldPoint) -> None:
        """Set ``unknown`` to a random root of a relation at ``point``; raises NoPointError if there is none."""
        roots = roots_of(univariate(self.ring, node, unknown, point))
        if not roots:
            raise NoPointError("no root")
        value = point.rng.choice(roots)
        var = self.ring.vars[unknown[1]]
        if unknown[0] == "var":
            point.set(var, value)
            return
        below = 5 * (1 + value * value)
        cos, sin = (top / below for top in circle(value, value * 0 + 1))
        partner = self.ring.vars[var.partner]
        point.set(var, cos if var.kind == "cos" else sin)
        point.set(partner, sin if var.kind == "cos" else cos)
