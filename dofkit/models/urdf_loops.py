"""Joints of a URDF file that close loops: how far each has moved in the drawing, or that its ends do not meet there."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from dofkit.base.errors import Fault
from dofkit.models.model_document import FINEST, vector
from dofkit.models.urdf_elements import FIXED, Array, Poses, Robot, Transform

#: What the joints of a chain may add up to, in tolerances.
SLACK = 8.0
#: Which of a joint's ends may turn about its axis, and move along it.
_TURNING = ("revolute", "continuous", "cylindrical", "planar")
_SLIDING = ("prismatic", "cylindrical")
_BALLS = ("ball", "spherical")


class Closure(NamedTuple):
    """A joint that closes a loop, by its frames in the drawing as its two ends carry them; the axis is in the first.

    ``turned``: the second frame is told with its axes; else only its place is.
    """

    name: str
    kind: str
    first: Transform
    second: Transform
    axis: tuple[float, ...]
    turned: bool
    line: int

    def moved(self, size: float, tolerance: float) -> float | None:
        """How far the joint has moved where it is drawn, 0 where no one number tells; None where it cannot be there.

        The drawing is right to within ``tolerance``, a fraction of its ``size``: lengths and angles to the last digit
        that is written, and places to what such angles move them by.
        """
        arm = self.first.turn.T @ (self.second.at - self.first.at)
        turn = self.first.turn.T @ self.second.turn if self.turned else np.eye(3)
        n = np.array(self.axis) / (np.linalg.norm(self.axis) or 1.0)
        along = float(arm @ n)
        off = abs(along) if self.kind == "planar" else float(np.linalg.norm(arm - n * along * (self.kind in _SLIDING)))
        digit = SLACK * max(tolerance * size, FINEST)
        if off > digit * max(size, 1.0) or self._twist(turn, n) > digit:
            return None
        if self.kind in _TURNING[:2]:
            return _angle_about(turn, n)
        return along if self.kind == "prismatic" else 0.0

    def _twist(self, turn: Array, axis: Array) -> float:
        """What the turn of one end against the other has that the joint does not allow."""
        if self.kind in _BALLS:
            return 0.0
        return float(np.linalg.norm(turn @ axis - axis if self.kind in _TURNING else turn - np.eye(3)))


def closures(robot: Robot, poses: Poses) -> Iterator[Closure]:
    """The joints that close loops: those whose child hangs on another one, and those of extensions."""
    for joint in poses.closing:
        if joint.kind != "floating":
            frame, child = poses.frame[joint.name], poses.pose[joint.child]
            yield Closure(joint.name, joint.kind, frame, child, joint.axis, True, joint.line)
    for loop in robot.loops:
        if loop.kind not in _BALLS:
            (one, first), (other, second) = loop.ends
            turned = not np.array_equal(second.turn, np.eye(3))
            ends = poses.pose[one].after(first), poses.pose[other].after(second)
            yield Closure(loop.name, loop.kind, *ends, loop.axis, turned, loop.line)


def drawn_joints(robot: Robot, poses: Poses, size: float, tolerance: float) -> tuple[dict[str, float], list[Fault]]:
    """The angle or displacement of every joint in the drawing that is not 0, and what is at fault there.

    That are links which stand nowhere, and loops that are open.
    """
    adrift = [name for name in robot.links if name not in poses.pose]
    if adrift:
        told = f"the link '{adrift[0]}' is not connected to a root link: the joints above it form a cycle"
        hint = "let the joints lead from one root to every link"
        return {}, [Fault(told, line=robot.links[adrift[0]].line, column=1, hint=hint)]
    drawn, faults = robot.drawn(), list[Fault]()
    for closure in closures(robot, poses):
        moved = closure.moved(size, tolerance)
        if moved is None:
            places = " and ".join(f"({', '.join(map(str, _short(f.at)))})" for f in (closure.first, closure.second))
            told = f"its ends are at {places}, or in orientations that a {closure.kind} joint does not allow"
            message = f"the loop that '{closure.name}' closes is open where every joint is at 0: {told}"
            faults.append(Fault(message, line=closure.line, column=1, hint="change the origins so that its ends meet"))
        else:
            drawn[closure.name] = moved
    return drawn, faults or [*_open_mimics(robot, poses, drawn, SLACK * max(tolerance * size, FINEST))]


def _short(values: Array) -> list[float | int]:
    return [float(f"{v:.6g}") for v in vector(values)]


def _open_mimics(robot: Robot, poses: Poses, drawn: Mapping[str, float], gap: float) -> Iterator[Fault]:
    """Joints that close loops and stand elsewhere than where what they mimic, or what mimics them, lets them."""
    closing = {joint.name for joint in poses.closing}
    for joint in robot.joints:
        mimic = joint.mimic
        if mimic is None or joint.kind == FIXED or closing.isdisjoint((joint.name, mimic.joint)):
            continue
        here, there = (drawn.get(name, 0.0) for name in (joint.name, mimic.joint))
        wanted = mimic.factor * there + mimic.offset
        if abs(here - wanted) > gap * max(1.0, abs(wanted)):
            message = (
                f"'{joint.name}' is at {here:.6g} in the reference configuration, but what it mimics puts it at "
                f"{wanted:.6g}"
            )
            yield Fault(message, line=mimic.line, column=1, hint="change the origins, or the offset")


def _angle_about(turn: Array, axis: Array) -> float:
    """The angle of a turn about the axis, right-handed."""
    sine = float(axis @ np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])) / 2
    return math.atan2(sine, (float(np.trace(turn)) - 1) / 2)
