"""The right equations of motion of a scene, as expressions with which answers are compared."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from dofkit.base.errors import DofkitError, NoValueError
from dofkit.exact.points.field import field_point
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.triangular import TriangularSolver
from dofkit.exact.zero import independent_generators, zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.tree import ZERO, Expr
from dofkit.motion.lagrange.derivation import derive
from dofkit.motion.lagrange.elimination import by_time, in_velocities
from dofkit.motion.lagrange.equations import derived_of, read
from dofkit.relations.normal.pieces import Finite, Pfaffian
from dofkit.scene.scene import Scene

#: The number of points over GF(p), and of attempts to find them.
POINTS, ATTEMPTS = 3, 40
#: The most nodes of an expression that is compared.
MOST_NODES = 4000


@dataclass(frozen=True)
class RightMotion:
    """The right motion in the remaining coordinates ``names``; ``total``: T + V.

    ``motions`` replaces eliminated coordinates, ``rates`` velocities that constraints express by others. ``rows``: the
    constraints with a multiplier, differentiated until they contain accelerations; ``relations``: their geometric
    equations; ``unreduced``: {coordinate of the scene: (momentum, force)} before elimination.
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

    def in_kept(self, e: Expr) -> Expr:
        """Return an expression in the remaining coordinates."""
        return substitute(e, self.motions)

    def on_constraints(self, e: Expr) -> Expr:
        """Return an expression with dependent velocities replaced by independent ones."""
        return substitute(e, self.rates)

    def zero(self, e: Expr) -> bool | None:
        """Return whether an expression is 0 where the constraints are satisfied, or None if undecided."""
        moved = self.on_constraints(e)
        zero_everywhere = is_zero(moved, self.positive)
        return zero_everywhere if zero_everywhere is not False or not self.relations else self._zero_there(moved)

    def _zero_there(self, e: Expr) -> bool | None:
        """Return whether an expression is 0 at random points on the geometric equations, or None if undecided."""
        ring = Ring([e, *self.relations], self.positive)
        node = ring.node(e)
        zeros = [node_values[node] == 0 for _, node_values in points(ring, self.relations)]
        if len(zeros) < POINTS:
            return None
        return all(zeros) if all(zeros) or independent_generators(ring) else None


def points(ring: Ring, relations: Sequence[Expr]) -> Iterator[tuple[int, Any]]:
    """Yield (p, values of the nodes) at up to `POINTS` random points over GF(p) that satisfy the relations."""
    solver = TriangularSolver(ring, [ring.node(g) for g in relations], seed=3) if relations else None
    count = 0
    for seed in range(ATTEMPTS):
        point = field_point([ring], 500 + seed) if solver is None else solver.draw(500 + seed)
        if point is None:
            return
        try:
            at = values(ring, point)
        except NoValueError:
            continue
        yield point.p, at
        count += 1
        if count == POINTS:
            return


def right_motion(scene: Scene, whole: bool = False) -> RightMotion:
    """Return the motion of a scene; ``whole``: without elimination. Raises DofkitError if there is none."""
    derived = derive(read(scene).model(eliminates=False)) if whole else derived_of(scene)
    model = derived.model
    rates: dict[Expr, Expr] = {}
    for constraint in model.constraints:
        if isinstance(constraint, (Pfaffian, Finite)):
            form = by_time(constraint.expr) if isinstance(constraint, Finite) else in_velocities(constraint)
            _add_rate(form, rates, model.positive)
    whole_model = model.whole
    unreduced = {}
    for c in model.study.system.coordinates:
        v = ex.velocity(c.name)
        force = diff(whole_model.lagrangian, ex.coordinate(c.name)) - diff(whole_model.dissipation, v)
        pair = (diff(whole_model.lagrangian, v), force + whole_model.forces.get(c.name, ZERO))
        unreduced[c.name] = (substitute(pair[0], model.motions), substitute(pair[1], model.motions))
    rows = [by_time(by_time(p.expr)) if isinstance(p, Finite) else by_time(in_velocities(p)) for p in model.constraints]
    return RightMotion(
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


def _add_rate(form: Expr, rates: dict[Expr, Expr], positive: frozenset[Expr]) -> None:
    """Add to ``rates`` a velocity expressed by others, from a form that is 0, if its coefficient is not 0."""
    form = substitute(form, rates)
    for v in sorted((s for s in form.symbols if s.args[0] == "velocity"), key=lambda s: s.args):
        slope = diff(form, v)
        if is_zero(slope, positive) is False:
            value = -substitute(form, {v: ZERO}) / slope
            rates.update({w: substitute(e, {v: value}) for w, e in rates.items()})
            rates[v] = value
            return


def is_zero(e: Expr, positive: frozenset[Expr]) -> bool | None:
    """Return whether an expression is 0 identically; None if it is too large or undefined, or if uncertain."""
    if ex.size(e) > MOST_NODES:
        return None
    try:
        zero, verdict = zero_and_verdict(e, positive)
    except ArithmeticError:
        return None
    return None if zero and verdict not in ("proved", "probable") else zero


def right_motion_or_why(scene: Scene, whole: bool = False) -> RightMotion | DofkitError:
    """Return the motion of a scene, or the error for which it is unknown."""
    try:
        return right_motion(scene, whole)
    except DofkitError as error:
        return error
