"""Bodies of a measured drawing told by the place of a point near its middle, in floating point.

A body's coordinates are p and angles, and its material point that is drawn at a stands at p + R (a - s). A turn about
a frame far away moves everything by far more than a shift does, and a step of it leads astray. Here the body is told
by P = p + R (c - s), with c the middle of the drawing: dp = dP - sum dR/d(angle) (c - s) d(angle).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

from dofkit.base.libraries import np
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.setting import TurnedBody


@cache
def crosses() -> Any:
    """The matrices e~ of the axes: e~ v is the cross product."""
    return np.array(
        [[[0, 0, 0], [0, 0, -1], [0, 1, 0]], [[0, 0, 1], [0, 0, 0], [-1, 0, 0]], [[0, -1, 0], [1, 0, 0], [0, 0, 0]]]
    )


class BodyFrame(NamedTuple):
    """The columns of p and of the angles of a body, and the arm c - s."""

    body: TurnedBody
    places: list[int]
    angles: list[int]
    arm: Any


def frames_of(bodies: Sequence[TurnedBody], centre: Sequence[float], symbols: Sequence[Expr]) -> list[BodyFrame]:
    """The frames of those bodies of which all coordinates are there."""
    number = {s: i for i, s in enumerate(symbols)}
    found = []
    for body in bodies:
        named = [ex.coordinate(name) for name in (*body.places, *body.angles)]
        if all(s in number for s in named) and len(centre) == len(body.places):
            columns = [number[s] for s in named]
            d = len(body.places)
            found.append(BodyFrame(body, columns[:d], columns[d:], np.subtract(centre, body.start)))
    return found


def shifts(frame: BodyFrame, angles: Sequence[float]) -> tuple[Any, Any]:
    """R (c - s), and its derivatives by the angles as columns."""
    turn, slopes = _turn(frame.body, np.array(angles, dtype=float))
    return turn @ frame.arm, np.array([slope @ frame.arm for slope in slopes]).T


def of_points(frames: Sequence[BodyFrame], j: Any, at: Mapping[Expr, float], symbols: Sequence[Expr]) -> Any:
    """Derivatives by P and angles, from those by p and angles."""
    found = j.copy()
    for frame in frames:
        _, slopes = shifts(frame, [at.get(symbols[i], 0.0) for i in frame.angles])
        found[:, frame.angles] -= j[:, frame.places] @ slopes
    return found


def to_points(frames: Sequence[BodyFrame], rows: Any, at: Mapping[Expr, float], symbols: Sequence[Expr]) -> Any:
    """Velocities of P and angles, from those of p and angles."""
    found = rows.copy()
    for frame in frames:
        _, slopes = shifts(frame, [at.get(symbols[i], 0.0) for i in frame.angles])
        found[:, frame.places] += rows[:, frame.angles] @ slopes.T
    return found


def _turn(body: TurnedBody, angles: Any) -> tuple[Any, list[Any]]:
    """R, the identity as drawn, and its derivatives by the angles."""
    if body.chart == "plane":
        c, s = np.cos(angles[0] - body.initial[0]), np.sin(angles[0] - body.initial[0])
        return np.array([[c, -s], [s, c]]), [np.array([[-s, -c], [c, -s]])]
    if body.chart == "gibbs":
        return _by_gibbs(angles)
    now, slopes = _by_euler(angles)
    back = _by_euler(np.array(body.initial))[0].T
    return now @ back, [slope @ back for slope in slopes]


def _by_gibbs(g: Any) -> tuple[Any, list[Any]]:
    """R = N / w with N = (1 - g.g) I + 2 g g^T + 2 g~ and w = 1 + g.g."""
    w, one = 1 + g @ g, np.eye(3)
    n = (1 - g @ g) * one + 2 * np.outer(g, g) + 2 * np.einsum("k,kij->ij", g, crosses())
    slopes = []
    for k in range(3):
        slope = -2 * g[k] * one + 2 * (np.outer(one[k], g) + np.outer(g, one[k])) + 2 * crosses()[k]
        slopes.append(slope / w - n * (2 * g[k] / w**2))
    return n / w, slopes


def _by_euler(angles: Any) -> tuple[Any, list[Any]]:
    """Rz(phi) Rx(theta) Rz(psi); a turn about an axis has the derivative e~ R."""
    parts = [_about(axis, a) for axis, a in zip((2, 0, 2), angles, strict=True)]
    a, b, c = parts
    slopes = [crosses()[2] @ a @ b @ c, a @ crosses()[0] @ b @ c, a @ b @ crosses()[2] @ c]
    return a @ b @ c, slopes


def _about(axis: int, angle: float) -> Any:
    e = crosses()[axis]
    return np.eye(3) + np.sin(angle) * e + (1 - np.cos(angle)) * e @ e
