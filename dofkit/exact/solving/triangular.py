"""Points on the variety {g = 0} over GF(p), by solving the relations one unknown at a time.

The relations are first made algebraic: a root is an unknown with root^d = radicand, a basic angle an unknown
point of the circle. A relation with an unknown of its own is set aside and solved last, for that unknown
(peeling); where no relation has one, an unknown that enters some relation linearly is eliminated from the
others. What is left unassigned is drawn at random, so a point is generic on its branch.
"""

from __future__ import annotations

import random
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from flint import fmpq_mat, nmod, nmod_poly

from dofkit.base.deadline import check
from dofkit.exact.errors import NoPointError, NoValueError, raising_no_value
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.points.rational import Rational
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.program import reachable
from dofkit.exact.ring.ring import ADD, MUL, NUM, POW, VAR, Ring
from dofkit.exact.zero.independence import independent_generators

#: An elimination that makes the program longer than this is given up.
MAX_CODE = 20_000
#: Relations are combined linearly while their coefficients fit a matrix of this many entries.
COMBINED_ENTRIES = 20_000
#: Draws of a point before giving up (each square root that is asked for fails half the time).
DRAWS = 60

Unit = tuple[str, int]
ZERO, ONE = Fraction(0), Fraction(1)


def unit_of(ring: Ring, index: int) -> Unit:
    """The unknown that a generator belongs to: sin and cos are one."""
    var = ring.vars[index]
    return ("angle", min(index, var.partner)) if var.kind in ("cos", "sin") else ("var", index)


def units_in(ring: Ring, node: int) -> frozenset[Unit]:
    """The unknowns of a relation."""
    found = set()
    for i in reachable(ring, [node], through_generators=False):
        op, payload = ring.code[i]
        if op == VAR and ring.vars[payload].kind != "sign" and not _constant(ring, payload):
            found.add(unit_of(ring, payload))
    return frozenset(found)


def _constant(ring: Ring, index: int) -> bool:
    """True for generators that stand for one number: pi, roots and angles of numbers."""
    var = ring.vars[index]
    if var.kind in ("symbol", "call"):
        return False
    return all(ring.code[i][0] != VAR or _constant(ring, ring.code[i][1]) for i in reachable(ring, var.args))


@dataclass
class Plan:
    """How points are found: ``steps`` in the order of solving; ``free`` unknowns are drawn at random.

    ``contradictory``: elimination left a relation between no unknowns that does not hold.
    ``witness`` is that relation. ``special``: it left one between parameters only, which holds for special values.
    ``stuck``: relations were left that cannot be solved one unknown at a time.
    """

    steps: list[tuple[int, Unit]] = field(default_factory=list)
    free: list[Unit] = field(default_factory=list)
    dropped: int = 0
    contradictory: bool = False
    special: bool = False
    witness: int = -1
    stuck: bool = False


class TriangularSolver:
    """Plans and draws points on the zero set of some nodes of a ring."""

    def __init__(
        self, ring: Ring, relations: Sequence[int], fixed: frozenset[Unit] = frozenset(), seed: int = 0
    ) -> None:
        self.ring = ring
        self.fixed = fixed
        self.seed = seed
        self.rng = random.Random(f"dofkit plan {seed}")
        self.relations = [*relations, *self._root_relations(relations)]
        self.probe = self._probe()
        self.plan = Plan()
        self._degrees: dict[tuple[int, Unit], int] = {}
        self._linears: dict[tuple[int, Unit], bool] = {}
        self._make_plan()

    def _probe(self) -> FieldPoint | None:
        for attempt in range(DRAWS):
            try:
                return field_point([self.ring], self.seed + attempt)
            except NoPointError:
                continue
        return None

    def _root_relations(self, relations: Sequence[int]) -> list[int]:
        """root^d - radicand for every root that the relations reach."""
        ring, found, seen = self.ring, [], set()
        pending = list(relations)
        while pending:
            for i in reachable(ring, [pending.pop()], through_generators=False):
                op, payload = ring.code[i]
                if op != VAR or payload in seen:
                    continue
                seen.add(payload)
                var = ring.vars[payload]
                if var.kind == "root" and not _constant(ring, payload):
                    relation = ring.emit(ADD, (ring.power_node(i, var.degree), ring.negative(var.args[0])))
                    found.append(relation)
                    pending.append(relation)
        return found

    # -- planning -------------------------------------------------------------------------------

    def _make_plan(self) -> None:
        if self.probe is None:
            self.plan.stuck = True
            return
        remaining = list(self.relations)
        solved_last: list[tuple[int, Unit]] = []
        everything = {u for node in remaining for u in units_in(self.ring, node)}
        combined = False
        while remaining:
            check()
            if self._peel(remaining, solved_last):
                continue
            remaining = self._settle(remaining)
            if not remaining or self.plan.contradictory:
                break
            eliminated = self._eliminate(remaining)
            if eliminated is None:
                self._clash(remaining)
                if self.plan.contradictory:
                    break
                together = None if combined else self._combine(remaining)
                combined = True
                if together is None:
                    self.plan.stuck = True
                    break
                remaining = together
                continue
            node, unit, remaining = eliminated
            solved_last.append((node, unit))
        self.plan.steps = solved_last[::-1]
        solved = {unit for _, unit in solved_last}
        self.plan.free = sorted(everything - solved - self.fixed)

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
            own = [u for u in of[node] if where[u] == {node}]
            best = self._best(node, own)
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

    def _best(self, node: int, own: Sequence[Unit]) -> Unit | None:
        """The unknown of lowest degree; of equals, what is not a parameter, then by order."""
        if self._parameters_only(node):
            return None
        ranked = []
        for unit in own:
            degree = self.degree(node, unit)
            if degree:
                ranked.append((degree, self._rank(unit), unit))
        return min(ranked)[2] if ranked else None

    def _rank(self, unit: Unit) -> tuple[int, int]:
        var = self.ring.vars[unit[1]]
        if var.kind == "symbol":
            kind, name = var.key.args
            order = 0 if name.startswith("_") else {"velocity": 1, "coordinate": 2}.get(kind, 4)
        else:
            order = 3
        return (order, -unit[1])

    def degree(self, node: int, unit: Unit) -> int:
        """The degree of a relation's numerator in one unknown at random values of the others; 0: unsolvable."""
        if (node, unit) not in self._degrees:
            self._degrees[node, unit] = self._degree(node, unit)
        return self._degrees[node, unit]

    def _degree(self, node: int, unit: Unit) -> int:
        if self.probe is None:
            return 0
        try:
            return max(0, int(self._univariate(node, unit, self.probe).degree()))
        except NoValueError:
            return 0

    @raising_no_value
    def _univariate(self, node: int, unit: Unit, point: FieldPoint) -> Any:
        """The numerator of a relation as a polynomial in one unknown."""
        check()
        x = nmod_poly([0, 1], point.p)
        one = nmod_poly([1], point.p)
        if unit[0] == "angle":
            below = 5 * (one + x * x)
            cos, sin = (Rational(top, below) for top in _circle(x, one))
            var = self.ring.vars[unit[1]]
            pair = {var.index: cos if var.kind == "cos" else sin, var.partner: sin if var.kind == "cos" else cos}
        else:
            pair = {unit[1]: Rational(x, one)}
        result = self._run(node, pair, point)
        if not isinstance(result, Rational):
            return nmod_poly([result], point.p)
        return result.numerator()

    @raising_no_value
    def _run(self, node: int, pair: dict[int, Rational], point: FieldPoint) -> Any:
        """The value of a relation where some generators are functions of one unknown."""
        values: dict[int, Any] = {}
        for i in reversed(reachable(self.ring, [node], through_generators=False)):
            values[i] = self._step(i, values, pair, point)
        return values[node]

    def _step(self, i: int, values: dict[int, Any], pair: dict[int, Rational], point: FieldPoint) -> Any:
        op, payload = self.ring.code[i]
        if op == NUM:
            return point.number(payload)
        if op == ADD:
            total = values[payload[0]]
            for j in payload[1:]:
                total = values[j] + total if isinstance(values[j], Rational) else total + values[j]
            return total
        if op == MUL:
            total = values[payload[0]]
            for j in payload[1:]:
                total = values[j] * total if isinstance(values[j], Rational) else total * values[j]
            return total
        if op == POW:
            base, n = values[payload[0]], payload[1]
            return base**n if n > 0 else 1 / base**-n
        if payload in pair:
            return pair[payload]
        return self._independent(payload, point)

    def _independent(self, index: int, point: FieldPoint) -> Any:
        """A generator's value where its argument is not looked at."""
        var = self.ring.vars[index]
        found = point.given.get((var.kind, var.key))
        if found is not None:
            return found
        if var.kind == "root" and not _constant(self.ring, index):
            point.set(var, point.random())
            return point.given[var.kind, var.key]
        known = _constant(self.ring, index)
        args = [self._constant_value(a, point) if known else point.random() for a in var.args]
        return point.generator(var, args)

    def _constant_value(self, node: int, point: FieldPoint) -> Any:
        return self._run(node, {}, point)

    def _settle(self, remaining: list[int]) -> list[int]:
        """Drop relations between no unknowns that hold; notice those that do not."""
        kept = []
        for node in remaining:
            check()
            if self._parameters_only(node):
                self.plan.special = True
            if any(self.degree(node, u) for u in units_in(self.ring, node) - self.fixed):
                kept.append(node)
            elif self.probe is not None and self._constant_value(node, self.probe) == 0:
                self.plan.dropped += 1
            elif not self.fixed:
                self.plan.contradictory, self.plan.witness = True, node
        return kept

    def _clash(self, remaining: list[int]) -> None:
        """Notice two relations in the same one unknown that have no common root."""
        if self.probe is None or self.fixed or not independent_generators(self.ring):
            return
        known: dict[Unit, Any] = {}
        for node in remaining:
            units = list(units_in(self.ring, node))
            if len(units) != 1 or not self.degree(node, units[0]):
                continue
            polynomial = self._univariate(node, units[0], self.probe)
            known[units[0]] = known.get(units[0], polynomial).gcd(polynomial)
            if known[units[0]].degree() == 0:
                self.plan.contradictory, self.plan.witness = True, node

    def _parameters_only(self, node: int) -> bool:
        """Does the relation hold between named parameters alone (generic geometry is not named)?"""
        units = {u for u in units_in(self.ring, node) if self.degree(node, u)}
        return bool(units) and all(self._is_parameter(u) for u in units)

    def _is_parameter(self, unit: Unit) -> bool:
        var = self.ring.vars[unit[1]]
        if unit[0] == "angle" or var.kind != "symbol":
            return False
        kind, name = var.key.args
        return bool(kind == "parameter" and not name.startswith("_"))

    def _eliminate(self, remaining: list[int]) -> tuple[int, Unit, list[int]] | None:
        """Solve one relation for an unknown that it holds linearly and put that into the others."""
        choices = []
        for node in remaining:
            check()
            for unit in units_in(self.ring, node) - self.fixed:
                if unit[0] == "var" and self._linear(node, unit):
                    size = len(reachable(self.ring, [node], through_generators=False))
                    choices.append((size, self._rank(unit), node, unit))
        if not choices:
            return None
        _, _, node, unit = min(choices)
        zero, one = self.ring.emit(NUM, ZERO), self.ring.emit(NUM, ONE)
        at_zero = self.ring.replaced(node, {unit[1]: zero})
        slope = self.ring.emit(ADD, (self.ring.replaced(node, {unit[1]: one}), self.ring.negative(at_zero)))
        solution = self.ring.emit(MUL, (self.ring.negative(at_zero), self.ring.emit(POW, (slope, -1))))
        others = [
            self.ring.replaced(other, {unit[1]: solution}) if unit in units_in(self.ring, other) else other
            for other in remaining
            if other != node
        ]
        others = [other for other in others if not self._vanishes(other)]
        return None if len(self.ring.code) > MAX_CODE else (node, unit, others)

    def _combine(self, remaining: list[int]) -> list[int] | None:
        """Linear combinations of the relations of lower degree (two circles meet on a line); None: none were found."""
        try:
            canon = Canon(self.ring)
            tables = [canon.quotient(node)[0].to_dict() for node in remaining]
        except NoValueError:
            return None
        monomials = sorted({m for table in tables for m in table}, key=lambda m: (-sum(m), m))
        if not monomials or len(monomials) * len(tables) > COMBINED_ENTRIES:
            return None
        reduced, rank = fmpq_mat([[table.get(m, 0) for m in monomials] for table in tables]).rref()
        self.plan.dropped += len(remaining) - rank
        rows = [{m: reduced[r, c] for c, m in enumerate(monomials) if reduced[r, c] != 0} for r in range(rank)]
        return [self._emit_polynomial(row) for row in rows]

    def _emit_polynomial(self, table: dict[tuple[int, ...], Any]) -> int:
        ring, n, terms = self.ring, len(next(iter(table))), []
        for exponents, value in table.items():
            factors = [ring.emit(NUM, Fraction(int(value.p), int(value.q)))]
            factors += [ring.power_node(ring.var_node[n - 1 - i], int(k)) for i, k in enumerate(exponents) if k]
            terms.append(ring.emit(MUL, tuple(factors)))
        return ring.emit(ADD, tuple(terms))

    def _vanishes(self, node: int) -> bool:
        """True where a relation holds for random values of all its unknowns: it says nothing new."""
        point = self._fresh()
        if point is None:
            return False
        try:
            zero = self._constant_value(node, point) == 0
        except NoValueError:
            return False
        self.plan.dropped += zero
        return bool(zero)

    def _fresh(self) -> FieldPoint | None:
        try:
            return field_point([self.ring], self.rng.randrange(1 << 30))
        except NoPointError:
            return None

    def _linear(self, node: int, unit: Unit) -> bool:
        """True where the relation is a polynomial of degree 1 in the unknown, with no denominator in it."""
        if (node, unit) not in self._linears:
            self._linears[node, unit] = self._is_linear(node, unit)
        return self._linears[node, unit]

    def _is_linear(self, node: int, unit: Unit) -> bool:
        if self.probe is None:
            return False
        x, one = nmod_poly([0, 1], self.probe.p), nmod_poly([1], self.probe.p)
        try:
            result = self._run(node, {unit[1]: Rational(x, one)}, self.probe)
        except NoValueError:
            return False
        return isinstance(result, Rational) and result.bottom.degree() == 0 and result.top.degree() == 1

    # -- drawing ----------------------------------------------------------------------------------

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
        polynomial = self._univariate(node, unit, point)
        if polynomial == 0:
            raise NoPointError("the relation does not determine the unknown")
        roots = [root for root, _ in polynomial.roots()] if polynomial.degree() > 1 else _linear_root(polynomial)
        if not roots:
            raise NoPointError("no root")
        value = point.rng.choice(roots)
        var = self.ring.vars[unit[1]]
        if unit[0] == "var":
            point.set(var, value)
            return
        below = 5 * (1 + value * value)
        cos, sin = (top / below for top in _circle(value, value * 0 + 1))
        partner = self.ring.vars[var.partner]
        point.set(var, cos if var.kind == "cos" else sin)
        point.set(partner, sin if var.kind == "cos" else cos)


def _circle(w: Any, one: Any) -> tuple[Any, Any]:
    """5 (1 + w^2) times cos and sin of 2 atan(w) + atan(4/3): the point that no w gives is no special one."""
    cos, sin = one - w * w, 2 * w
    return 3 * cos - 4 * sin, 4 * cos + 3 * sin


def _linear_root(polynomial: Any) -> list[Any]:
    if polynomial.degree() < 1:
        return []
    return [-nmod(int(polynomial[0]), polynomial.modulus()) / nmod(int(polynomial[1]), polynomial.modulus())]
