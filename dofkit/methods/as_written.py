"""A system's equations as they are written, without reduction to a canonical form, and answers from ranks at points."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Protocol

from dofkit.base.errors import TextError
from dofkit.base.verdicts import Verdict
from dofkit.exact.ring.program import Point, Scalar, gradient, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import cleared, in_velocities
from dofkit.expressions.tree import Expr
from dofkit.methods.table import Reply
from dofkit.relations.normal.domain import DomainCondition, is_satisfied_at
from dofkit.relations.normal.normal_form import linear_form, velocities_of
from dofkit.relations.normal.pieces import Pfaffian
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene
from dofkit.system import System


@dataclass(frozen=True)
class Written:
    """The scalar equations of a system as written, each with the number of its constraint.

    ``finite``: geometric equations; ``forms``: equations linear in velocities; ``others``: the constraints with other
    relations: inequalities, equations nonlinear in the velocities or with second derivatives.
    """

    system: System
    finite: tuple[tuple[int, Expr], ...]
    forms: tuple[tuple[int, Pfaffian], ...]
    others: Mapping[int, str] = field(default_factory=dict)

    @property
    def coordinates(self) -> list[Expr]:
        """The symbols of the coordinates, in order."""
        return [ex.coordinate(c.name) for c in self.system.coordinates]

    @property
    def timed(self) -> bool:
        """Whether t or dt occurs."""
        return any(not f.dt.is_zero for _, f in self.forms) or any(ex.TIME in e.symbols for e in self.expressions)

    @property
    def expressions(self) -> list[Expr]:
        """The geometric equations and the coefficients of the forms."""
        return [g for _, g in self.finite] + [a for _, f in self.forms for _, a in f.items()]

    @property
    def positive(self) -> frozenset[Expr]:
        """The positive parameters, including generic squared lengths."""
        positive_symbols = {ex.parameter(p) for p, sign in self.system.parameters.items() if sign == "positive"}
        return frozenset(positive_symbols | {ex.parameter(p) for p in self.system.generic if p.startswith("_L")})


def as_written(scene: Scene | System) -> Written:
    """Return the equations of a scene or system."""
    system = scene if isinstance(scene, System) else lower(scene)
    finite: list[tuple[int, Expr]] = []
    forms: list[tuple[int, Pfaffian]] = []
    others: dict[int, str] = {}
    for i, constraint in enumerate(system.constraints):
        for relation in constraint.relations:
            if relation.sense != "=":
                others[i] = "inequality"
                continue
            equation = _read(relation.expr)
            if isinstance(equation, str):
                others[i] = equation
            elif isinstance(equation, Pfaffian):
                forms.append((i, equation))
            else:
                finite.append((i, equation))
    return Written(system, tuple(finite), tuple(forms), others)


def _read(e: Expr) -> Expr | Pfaffian | str:
    """Return ``e`` as a geometric equation or as a form, or the text ``nonlinear`` if it is neither."""
    try:
        moving, divided = in_velocities(e)
    except TextError:
        return "nonlinear"
    if not velocities_of(moving):
        return Pfaffian({}, moving) if divided else moving
    form = linear_form(cleared(moving))
    return "nonlinear" if form is None else form


def labelled(written: Written, passing: Sequence[bool]) -> dict[str, bool]:
    """Return {name: label}: False for ``others`` and for constraints with a form that does not pass, else True."""
    failing = {i for (i, _), passes in zip(written.forms, passing, strict=True) if not passes} | {*written.others}
    return {c.name: i not in failing for i, c in enumerate(written.system.constraints)}


Matrix = list[list[Scalar]]


class Decider(Protocol):
    """The arithmetic of a method: its numbers, and how ranks, kernels and zeros are decided."""

    @property
    def zero(self) -> Scalar: ...

    def rank(self, matrix: Matrix) -> int: ...
    def kernel(self, matrix: Matrix, columns: int) -> Matrix: ...
    def vanishes(self, value: Scalar, scale: Sequence[Scalar]) -> bool: ...
    def points(self, written: Written, rows: WrittenRows, drawn: bool) -> Sequence[Point]: ...


class WrittenRows:
    """The equations of a scene as a program (ring) that is evaluated at points."""

    def __init__(self, written: Written) -> None:
        self.written = written
        self.columns = [*written.coordinates, *([ex.TIME] if written.timed else [])]
        self.n = len(written.coordinates)
        self.ring = Ring(written.expressions, written.positive)
        place = {s: k for k, s in enumerate(self.columns)}
        self.finite = [(i, self.ring.node(g)) for i, g in written.finite]
        self.forms = [(i, {place[s]: self.ring.node(a) for s, a in f.items()}) for i, f in written.forms]
        self.indices = [self.ring.var_index(s) for s in self.columns]

    def at(self, point: Point, zero: Scalar) -> SampledRows:
        """Return the gradients, coefficients, exterior derivatives and residuals at one point."""
        node_values = values(self.ring, point)
        slopes = {node: self._slope(node_values, point, node, zero) for node in self._nodes()}
        finite = [slopes[node] for _, node in self.finite]
        forms = [[node_values[a[c]] if c in a else zero for c in range(len(self.columns))] for _, a in self.forms]
        curls = [self._curl({c: slopes[node] for c, node in a.items()}, zero) for _, a in self.forms]
        return SampledRows(finite, forms, curls, [node_values[node] for _, node in self.finite])

    def _nodes(self) -> set[int]:
        return {node for _, node in self.finite} | {node for _, a in self.forms for node in a.values()}

    def _slope(self, node_values: Sequence[Scalar], point: Point, node: int, zero: Scalar) -> list[Scalar]:
        slopes = gradient(self.ring, node_values, point, [(node, zero + 1)])
        return [zero if c is None else slopes.get(c, zero) for c in self.indices]

    def _curl(self, slopes: dict[int, list[Scalar]], zero: Scalar) -> Matrix:
        """Return the matrix of d omega: d a_j/d q_i - d a_i/d q_j, from the gradients of the coefficients a."""
        whole = range(len(self.columns))
        empty = [zero for _ in whole]
        by = [slopes.get(c, empty) for c in whole]
        return [[by[j][i] - by[i][j] for j in whole] for i in whole]


@dataclass(frozen=True)
class SampledRows:
    """At one point: rows of geometric equations and of forms, the forms' exterior derivatives, the residuals."""

    finite: Matrix
    forms: Matrix
    curls: list[Matrix]
    residuals: list[Scalar]

    @property
    def rows(self) -> Matrix:
        return [*self.finite, *self.forms]


@dataclass(frozen=True)
class SampledPoints:
    """The rows at all points, and which forms pass Frobenius' test at all of them."""

    rows: WrittenRows
    samples: list[SampledRows]
    passing: list[bool]


def sampled_points(written: Written, numbers: Decider) -> SampledPoints | None:
    """Return the rows at the reference, or without one at points that ``numbers`` finds; None if it finds none."""
    rows = WrittenRows(written)
    drawn = written.system.reference is not None
    samples = [rows.at(p, numbers.zero) for p in numbers.points(written, rows, drawn)]
    if not samples:
        return None
    passing = [True for _ in rows.forms]
    for s in samples if rows.forms else []:
        basis = numbers.kernel(s.rows, len(rows.columns))
        for k, curl in enumerate(s.curls):
            passing[k] = passing[k] and _flat(curl, basis, numbers)
    return SampledPoints(rows, samples, passing)


def _flat(curl: Matrix, basis: Matrix, numbers: Decider) -> bool:
    """Return whether N^T C N = 0 for the matrix C of d omega (``curl``) and the kernel vectors N (``basis``)."""
    scale = [v for row in curl for v in row]
    for count, u in enumerate(basis):
        product = [sum((u[i] * curl[i][j] for i in range(len(u))), numbers.zero) for j in range(len(u))]
        for v in basis[:count]:
            if not numbers.vanishes(sum((x * y for x, y in zip(product, v, strict=True)), numbers.zero), scale):
                return False
    return True


def freedom(sampled: SampledPoints, numbers: Decider) -> int:
    """Return coordinates less the rank of geometric equations and forms that pass: the least over the points."""
    n = sampled.rows.n
    kept = [[*s.finite, *(f for f, p in zip(s.forms, sampled.passing, strict=True) if p)] for s in sampled.samples]
    return min(n - numbers.rank([row[:n] for row in rows]) for rows in kept)


def labels(samples: SampledPoints, numbers: Decider) -> dict[str, bool]:
    """Return {name: whether the constraint is taken to be holonomic}."""
    del numbers
    return labelled(samples.rows.written, samples.passing)


def droppable(sampled: SampledPoints, numbers: Decider) -> list[str]:
    """Return the names of a set of constraints whose removal does not change the ranks at the first point."""
    sample, rows = sampled.samples[0], sampled.rows

    def ranks(finite: Sequence[int], forms: Sequence[int]) -> tuple[int, int]:
        kept = [sample.finite[k] for k in finite]
        return numbers.rank(kept), numbers.rank([*kept, *(sample.forms[k] for k in forms)])

    return without_loss(rows.written, ranks)


def without_loss(written: Written, ranks: Callable[[Sequence[int], Sequence[int]], tuple[int, int]]) -> list[str]:
    """Return the names of constraints that are removed, forms and later ones first, while ``ranks`` do not change.

    ``ranks`` returns, for the numbers of geometric equations and forms, the rank of the equations alone and of both.
    Constraints in ``others`` are not removed.
    """
    finite, forms = [i for i, _ in written.finite], [i for i, _ in written.forms]

    def ranks_of(constraints: set[int]) -> tuple[int, int]:
        kept = ([k for k, i in enumerate(owners) if i in constraints] for owners in (finite, forms))
        return ranks(*kept)

    everything, dropped = {*finite, *forms}, set[int]()
    whole = ranks_of(everything)
    for i in sorted(everything - set(written.others), key=lambda i: (i in forms, i), reverse=True):
        if ranks_of(everything - dropped - {i}) == whole:
            dropped.add(i)
    return sorted(written.system.constraints[i].name for i in dropped)


def drawn_value(value: Expr, point: Any) -> Scalar:
    """Return the value of a constant expression, with the point's values of its parameters."""
    ring = Ring([value])
    node = ring.node(value)
    return values(ring, point)[node]


def independent_at_reference(sampled: SampledPoints, numbers: Decider) -> bool:
    """Return whether all constraints are geometric equations, independent at the reference, where they have values.

    Then the freedom there is the number of coordinates less the number of equations [ImplicitFunctions].
    """
    written = sampled.rows.written
    if written.system.reference is None or written.others or written.forms:
        return False
    here = {**written.system.reference, ex.TIME: ex.ZERO}
    domain = (DomainCondition(*d) for c in written.system.constraints for r in c.relations for d in r.domain)
    if not all(is_satisfied_at(c, here, written.positive, strictly=True) for c in domain):
        return False
    rows = sampled.samples[0].rows
    return numbers.rank([row[: sampled.rows.n] for row in rows]) == len(rows)


Look = Callable[[Scene | System], tuple[SampledPoints, Decider] | Reply]
Answering = Callable[[Scene | System], Reply]


def questions_at_points(
    look_at: Look, certainty: Callable[[SampledPoints, Decider], Verdict]
) -> tuple[Answering, Answering, Answering]:
    """Return a method's functions for dof, integrability and redundancy, from the points that ``look_at`` returns.

    ``certainty``: the verdict of the freedom if all equations are independent at the reference configuration.
    """

    def dof(scene: Scene | System) -> Reply:
        """Return coordinates less the rank of the Jacobian with the forms that pass Frobenius' test."""
        samples = look_at(scene)
        if isinstance(samples, Reply):
            return samples
        sure = certainty(*samples) if independent_at_reference(*samples) else "undecided"
        return Reply(freedom(*samples), verdict=sure)

    def at_points(answer: Callable[[SampledPoints, Decider], Any], scene: Scene | System) -> Reply:
        """Return the reply with ``answer(points, decider)``; without a value if no points were found."""
        samples = look_at(scene)
        if isinstance(samples, Reply):
            return replace(samples, value=None)
        return Reply(answer(*samples))

    return dof, partial(at_points, labels), partial(at_points, droppable)
