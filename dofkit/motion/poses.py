"""Poses of a system in floating point: coordinates, rotations as unit quaternions, and time; for pictures only.

A rotation R(g) with Gibbs vector g is kept as a quaternion (w, v), g = v / w, and changed by a small rotation vector
omega in world axes: dg = (omega + omega x g + g (g.omega)) / 2. Near half a turn, where g is infinite, relations are
evaluated in high precision.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from flint import arb

from dofkit.exact.points.balls import BallPoint, FloatPoint, jacobian
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.pieces import Pfaffian
from dofkit.system import System

Array = np.ndarray[Any, Any]
#: The |w| below which the relations are evaluated in high precision, and the least |w| distinguished from 0.
HALF_TURN, NO_LESS = 1e-3, 1e-14
#: A gradient below this share of the usual length is not normalized; the random poses that give the usual length.
FLAT, USUAL = 1e-9, 5
#: The roles of coordinates that are angles.
ANGLES = ("angle", "phi", "theta", "psi")
FAULTS = (ArithmeticError, ValueError)


@dataclass(frozen=True)
class Pose:
    """A pose: ``plain`` are coordinates, then time; ``turns`` the unit quaternion of each body in the Gibbs chart."""

    plain: Array
    turns: Array


class PoseRelations:
    """Geometric equations and one-forms, and their derivatives by the columns (see `columns`)."""

    def __init__(
        self,
        system: System,
        finite: Sequence[Expr],
        forms: Sequence[Pfaffian],
        positive: frozenset[Expr],
        limits: Sequence[Expr] = (),
    ) -> None:
        """``limits``: expressions that are to stay at 0 or above."""
        coefficients = [e for f in forms for _, e in f.items()]
        self.ring = Ring([*finite, *coefficients], positive)
        self.limiting = Ring(limits, positive)
        self.limits = [self.limiting.node(e) for e in limits]
        self.finite = [self.ring.node(g) for g in finite]
        self.forms = [{s: self.ring.node(e) for s, e in f.items()} for f in forms]
        self.timed = any(ex.TIME in e.symbols for e in [*finite, *coefficients]) or any(
            ex.TIME in f for f in self.forms
        )
        self.rotations = [r for r in system.rotations if r.chart == "gibbs"]
        turning = {name for r in self.rotations for name in r.names}
        coordinates = [c for c in system.coordinates if c.name not in turning]
        self.names = [c.name for c in coordinates]
        self.scales = np.array([system.size if c.role in ("x", "y", "z") else 1.0 for c in coordinates])
        self.angles = np.array([c.role in ANGLES for c in coordinates], dtype=bool)
        self.plain = [ex.coordinate(n) for n in self.names]
        if self.timed:
            self.plain.append(ex.TIME)
            self.scales, self.angles = np.append(self.scales, 1.0), np.append(self.angles, False)
        self.symbols = [*self.plain, *(ex.coordinate(n) for r in self.rotations for n in r.names)]
        indices = (self.ring.var_index(s) for s in self.symbols)
        self.generators = [-1 if index is None else index for index in indices]  # no generator has the number -1
        self.constants = {s: 1.0 for e in limits for s in e.symbols if s.args[0] == "parameter"}
        if not self.timed and any(ex.TIME in e.symbols for e in limits):
            self.constants[ex.TIME] = 0.0  # only limits know of time: it stands still

    @property
    def columns(self) -> int:
        """The number of columns: plain coordinates over `scales`, then time, then a rotation vector for each turn."""
        return len(self.plain) + 3 * len(self.rotations)

    @property
    def time(self) -> int:
        """The column of time, if it occurs."""
        return len(self.plain) - 1

    def pose(self, symbols: Mapping[Expr, float]) -> Pose:
        """Return the pose with the given values, 0 for others."""
        turns = []
        for r in self.rotations:
            q = np.array([1.0, *(symbols.get(ex.coordinate(n), 0.0) for n in r.names)])
            turns.append(q / np.linalg.norm(q))
        plain = np.array([symbols.get(s, 0.0) for s in self.plain])
        return Pose(plain, np.array(turns).reshape(-1, 4))

    def moved(self, pose: Pose, step: Array) -> Pose:
        """Return the pose after a step, which is a vector over the columns."""
        n = len(self.plain)
        turns = [_times(_turn(step[n + 3 * k : n + 3 * k + 3]), q) for k, q in enumerate(pose.turns)]
        return Pose(pose.plain + self.scales * step[:n], np.array(turns).reshape(-1, 4))

    def between(self, first: Pose, last: Pose) -> Array:
        """Return the step from one pose to another."""
        back = np.array([1.0, -1.0, -1.0, -1.0])
        turns = [_vector(_times(b, a * back)) for a, b in zip(first.turns, last.turns, strict=True)]
        return np.concatenate([(last.plain - first.plain) / self.scales, *turns])

    def at(self, pose: Pose) -> tuple[Array, Array]:
        """Return (values, derivatives by the columns) of the geometric equations, normalized to rows of length 1."""
        f, j = self._gradients(pose)
        norms = np.linalg.norm(j, axis=1)
        usual = self._usual
        norms = np.where(norms > FLAT * usual, norms, usual)
        return f / norms, j / norms[:, None]

    @cached_property
    def _usual(self) -> Array:
        """The largest length of each geometric equation's gradient at random poses, 1 if it is 0."""
        rng = np.random.default_rng(1)
        lengths = np.zeros(len(self.finite))
        for _ in range(USUAL):
            turns = np.hstack([np.ones((len(self.rotations), 1)), rng.uniform(-1, 1, (len(self.rotations), 3))])
            turns = turns / np.linalg.norm(turns, axis=1, keepdims=True)
            try:
                _, j = self._gradients(Pose(self.scales * rng.standard_normal(len(self.plain)), turns))
            except FAULTS:
                continue
            lengths = np.maximum(lengths, np.linalg.norm(j, axis=1))
        return np.where(lengths > 0, lengths, 1.0)

    def forms_at(self, pose: Pose) -> Array:
        """Return the forms over the columns, as rows of length 1."""
        point, vectors = self._point(pose)
        at, zero = values(self.ring, point), point.number(ex.ZERO.args[0])
        rows = [[at[form[s]] if s in form else zero for s in self.symbols] for form in self.forms]
        j = self._by_columns(rows, vectors)
        norms = np.linalg.norm(j, axis=1)
        return j / np.where(norms > FLAT, norms, 1.0)[:, None]

    def margins(self, pose: Pose) -> list[float]:
        """Return the values of the limits at a pose, negative if one is violated; empty if one has no value."""
        try:
            at = values(self.limiting, self._point(pose)[0])
        except FAULTS:
            return []
        return [_middle(at[n]) for n in self.limits]

    def axis(self, name: str, pose: Pose) -> Array:
        """Return the step that moves only the coordinate ``name``; for an Euler angle a rotation about its axis."""
        step = np.zeros(self.columns)
        if name in self.names:
            step[self.names.index(name)] = 1.0
            return step
        for k, r in enumerate(self.rotations):
            if name in r.names:
                here = matrix_of(pose.turns[k]) @ from_euler(*map(number, r.initial))
                phi, _, _ = euler_angles(here, [0.0, 0.0, 0.0])
                axes = np.array([[0.0, 0.0, 1.0], [math.cos(phi), math.sin(phi), 0.0], here[:, 2]])
                step[len(self.plain) + 3 * k :][:3] = axes[r.names.index(name)]
        return step

    def step_of(self, rates: Mapping[Expr, float]) -> Array:
        """Return the step over the columns with these rates of symbols, for rotations as in the reference."""
        plain = np.array([rates.get(s, 0.0) for s in self.plain]) / self.scales
        turns = [2 * rates.get(ex.coordinate(n), 0.0) for r in self.rotations for n in r.names]
        return np.concatenate([plain, turns])

    def same(self, pose: Pose, near: Pose) -> Pose:
        """Return ``pose`` with full turns added to its angles, so that they are close to those of ``near``."""
        turns = np.where(self.angles, np.round((near.plain - pose.plain) / (2 * math.pi)), 0.0)
        return Pose(pose.plain + 2 * math.pi * turns, pose.turns)

    def _point(self, pose: Pose) -> tuple[Any, list[Any]]:
        """Return (point of evaluation, Gibbs vectors), as balls if a rotation is close to half a turn."""
        symbols: dict[Expr, Any] = {**self.constants, **dict(zip(self.plain, map(float, pose.plain), strict=True))}
        exact = bool(len(pose.turns)) and float(np.min(np.abs(pose.turns[:, 0]))) < HALF_TURN
        vectors: list[Any] = []
        for r, q in zip(self.rotations, pose.turns, strict=True):
            w = math.copysign(max(abs(float(q[0])), NO_LESS), float(q[0]))
            vector = [(arb(float(v)) / arb(w)).mid() if exact else float(v) / w for v in q[1:]]
            symbols.update(zip(map(ex.coordinate, r.names), vector, strict=True))
            vectors.append(vector)
        return (BallPoint(symbols) if exact else FloatPoint(symbols)), vectors

    def _gradients(self, pose: Pose) -> tuple[Array, Array]:
        """Return (values, derivatives by the columns) of the geometric equations."""
        point, vectors = self._point(pose)
        at, zero = values(self.ring, point), point.number(ex.ZERO.args[0])
        lines = jacobian(self.ring, at, point, self.finite, self.generators, zero)
        return np.array([_middle(at[n]) for n in self.finite]), self._by_columns(lines, vectors)

    def _by_columns(self, lines: Sequence[Sequence[Any]], vectors: Sequence[Sequence[Any]]) -> Array:
        """Return rows of derivatives by the symbols as rows of derivatives by the columns."""
        n, j = len(self.plain), np.zeros((len(lines), self.columns))
        for row, line in zip(j, lines, strict=True):
            row[:n] = [_middle(v) * s for v, s in zip(line[:n], self.scales, strict=True)]
            for k, g in enumerate(vectors):
                part = slice(n + 3 * k, n + 3 * k + 3)
                row[part] = [_middle(v) for v in _by_turn(line[part], g)]
        return j

    def coordinate_values(self, pose: Pose, last: Mapping[str, float]) -> dict[str, float]:
        """Return {coordinate: value}, with t if it occurs; Euler angles near those of ``last``."""
        coordinates = {str(s.args[1]): float(v) for s, v in zip(self.plain, pose.plain, strict=True) if s != ex.TIME}
        for r, q in zip(self.rotations, pose.turns, strict=True):
            initial = [number(e) for e in r.initial]
            near = [last.get(n, v) for n, v in zip(r.names, initial, strict=True)]
            coordinates.update(zip(r.names, euler_angles(matrix_of(q) @ from_euler(*initial), near), strict=True))
        if self.timed:
            coordinates["t"] = float(pose.plain[-1])
        return {n: v + 0.0 for n, v in coordinates.items()}


def _middle(value: Any) -> float:
    return float(value.mid()) if isinstance(value, arb) else float(value)


def number(e: Expr, symbols: Mapping[Expr, float] | None = None) -> float:
    """Return the value of an expression at the values of its symbols."""
    ring = Ring([e])
    node = ring.node(e)
    return float(values(ring, FloatPoint(symbols or {}))[node])


def _by_turn(line: Sequence[Any], g: Sequence[Any]) -> list[Any]:
    """Return the covector a on dg as a covector on omega, (a + g x a + g (g.a)) / 2."""
    a, along = line, sum((x * y for x, y in zip(line, g, strict=True)), line[0] * 0)
    cross = [g[1] * a[2] - g[2] * a[1], g[2] * a[0] - g[0] * a[2], g[0] * a[1] - g[1] * a[0]]
    return [(a[i] + cross[i] + g[i] * along) / 2 for i in range(3)]


def _turn(omega: Array) -> Array:
    """Return the unit quaternion of a rotation vector."""
    half = math.hypot(*omega) / 2
    return np.array([math.cos(half), *((math.sin(half) / half if half else 1.0) / 2 * omega)])


def _vector(q: Array) -> Array:
    """Return the rotation vector, of at most half a turn, of a unit quaternion."""
    q = q if q[0] >= 0 else -q
    size = float(np.linalg.norm(q[1:]))
    return q[1:] * (2.0 if size < 1e-12 else 2 * math.atan2(size, float(q[0])) / size)


def _times(p: Array, q: Array) -> Array:
    """Return the product of two quaternions, normalized."""
    (a, b, c, d), (w, x, y, z) = map(float, p), map(float, q)
    product = (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )
    return np.array(product) / math.hypot(*product)


def matrix_of(q: Array) -> Array:
    """Return the rotation matrix of a unit quaternion."""
    w, v = q[0], q[1:]
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.asarray(np.eye(3) + 2 * w * cross + 2 * cross @ cross)


def from_euler(phi: float, theta: float, psi: float) -> Array:
    """Return the rotation matrix of z-x-z Euler angles."""
    return about(2, phi) @ about(0, theta) @ about(2, psi)


def about(axis: int, angle: float) -> Array:
    """Return the rotation matrix about a coordinate axis (0, 1 or 2)."""
    q = np.zeros(4)
    q[0], q[1 + axis] = math.cos(angle / 2), math.sin(angle / 2)
    return matrix_of(q)


def euler_angles(r: Array, last: Sequence[float]) -> list[float]:
    """Return the z-x-z Euler angles of a rotation near ``last``; if its z axis is vertical, phi is that of ``last``."""
    theta = math.atan2(math.hypot(r[0, 2], r[1, 2]), r[2, 2])
    if math.hypot(r[0, 2], r[1, 2]) < 1e-9:
        up = 1.0 if r[2, 2] > 0 else -1.0
        phi = last[0]
        psi = up * (math.atan2(r[1, 0], r[0, 0]) - phi)
        choices = [(phi, theta, psi)]
    else:
        phi, psi = math.atan2(r[0, 2], -r[1, 2]), math.atan2(r[2, 0], r[2, 1])
        choices = [(phi, theta, psi), (phi + math.pi, -theta, psi + math.pi)]
    near = [[a - 2 * math.pi * round((a - b) / (2 * math.pi)) for a, b in zip(c, last, strict=True)] for c in choices]
    return min(near, key=lambda c: sum(abs(a - b) for a, b in zip(c, last, strict=True)))
