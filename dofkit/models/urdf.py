"""URDF, the robot models of ROS, as scenes: links, joints, `mimic` elements, and loops by extensions of URDF.

In the reference configuration every joint is at 0, a joint that mimics another at its offset, and loops must be closed.
The origin of a link is its centre of mass.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from dofkit.base.errors import Fault, SceneError
from dofkit.models.joint_relations import JointSum, relation
from dofkit.models.model_document import (
    FINEST,
    JointRange,
    ModelDocument,
    ModelFile,
    SceneDraft,
    inertia_of,
    listed,
    number,
    point_of,
    tolerance_of,
    vector,
)
from dofkit.models.urdf_elements import (
    FIXED,
    SCALAR,
    WITH_AXIS,
    Array,
    LoopJoint,
    Poses,
    Robot,
    RobotJoint,
    Transform,
    read_robot,
)
from dofkit.system import GROUND

#: {kind of joint: constraint type}; a floating joint has none.
_KINDS = {
    "revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic", "fixed": "weld", "planar": "planar",
    "ball": "spherical", "spherical": "spherical", "cylindrical": "cylindrical",
}  # fmt: skip
#: The largest gap of a loop in tolerances, because the rounding of several joints adds up.
SLACK = 8.0
#: The kinds of joints that allow rotation about the axis, and translation along it.
_TURNING = ("revolute", "continuous", "cylindrical", "planar")
_SLIDING = ("prismatic", "cylindrical")
_BALLS = ("ball", "spherical")


def read(file: ModelFile) -> ModelDocument:
    """Return the scene of a URDF file. Raises SceneError with all faults and their lines."""
    robot = read_robot(file)
    poses = robot.poses()
    places = [at.at for at in poses.pose.values()]
    size = float(max((max(c) - min(c) for c in zip(*places, strict=True)), default=1.0))
    tolerance = tolerance_of(_written(robot), size)
    faults = [*faults_of_loops(robot, poses, size, tolerance)]
    if faults:
        raise SceneError(tuple(faults), file.name)
    return _UrdfScene(robot, poses, SceneDraft(robot.name or file.name), file.limits).document(tolerance)


@dataclass
class _UrdfScene:
    """Writes the scene: ``stands`` is {link: body of the scene}, ``names`` {joint: constraint}."""

    robot: Robot
    poses: Poses
    draft: SceneDraft
    limits: bool
    stands: dict[str, str] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)

    def document(self, tolerance: float) -> ModelDocument:
        """Return the scene, in the order of the tree, without massless links at the ends of fixed joints."""
        robot, poses = self.robot, self.poses
        parents = {joint.parent for joint in robot.joints} | {end for loop in robot.loops for end, _ in loop.ends}
        markers = []
        for name in poses.order:
            link, joint = robot.links[name], poses.joint_of.get(name)
            loose = link.mass == 0 and name not in parents and joint is not None and joint.kind == FIXED
            if loose and joint is not None:
                markers.append(name)
                self.stands[name] = self.stands[joint.parent]
            elif joint is None and (link.mass == 0 and name in parents):
                self.stands[name] = GROUND
                if name != "world":
                    self.draft.leave_out(f"{name}: the root link, without mass, is the ground")
            else:
                self._link(name, poses.pose[name], joint)
            if joint is not None and not loose:
                self._joint(joint, poses.frame[joint.name])
        if markers:
            self.draft.leave_out(f"{listed(markers)}: frames without mass at the ends of the tree")
        for joint in poses.closing:
            self._joint(joint, poses.frame[joint.name])
        for loop in robot.loops:
            self._loop(loop, poses.pose)
        self._mimics()
        self.draft.ranges([*self._joint_ranges()], self.limits)
        self._remarks()
        loops = bool(robot.loops or poses.closing)
        return self.draft.document(tolerance, loops)

    def _link(self, name: str, pose: Transform, joint: RobotJoint | None) -> None:
        link = self.robot.links[name]
        centre = pose.after(link.centre)
        rows = centre.turn @ link.inertia @ centre.turn.T
        body = self.stands[name] = self.draft.body(name, link.line, mass=number(link.mass), inertia=inertia_of(rows))
        self.draft.place(body, centre.at)
        if joint is None:
            self.draft.constraint(name, "weld", link.line, between=[GROUND, body])
            self.draft.leave_out(f"the support of {name}, the root link: it is taken to be fixed")

    def _joint(self, joint: RobotJoint, frame: Transform) -> None:
        if joint.kind in _KINDS:
            between = [self.stands[joint.parent], self.stands[joint.child]]
            fields = {"between": between, **_geometry(joint, frame)}
            self.names[joint.name] = self.draft.constraint(joint.name, _KINDS[joint.kind], joint.line, **fields)

    def _loop(self, loop: LoopJoint, pose: Mapping[str, Transform]) -> None:
        """Add a joint that closes a loop: a ball by its points on both links, others by the frame on the first link."""
        frames = [pose[link].after(at) for link, at in loop.ends]
        bodies = [self.stands[link] for link, _ in loop.ends]
        if loop.kind in _BALLS:
            points = [point_of(body, frame.at) for body, frame in zip(bodies, frames, strict=True)]
            self.draft.constraint(loop.name, "coincident", loop.line, between=points)
        else:
            fields = {"between": bodies, **_geometry(loop, frames[0])}
            self.draft.constraint(loop.name, _KINDS[loop.kind], loop.line, **fields)

    def _mimics(self) -> None:
        """Add the coupling of each joint that mimics another; if the other is fixed, the joint is fixed too."""
        kinds = {joint.name: joint.kind for joint in self.robot.joints}
        for joint in self.robot.joints:
            if joint.mimic is None or joint.kind == FIXED:
                continue
            other = kinds[joint.mimic.joint]
            right = None if other == FIXED else JointSum(((self.names[joint.mimic.joint], 1.0),))
            fields = relation(JointSum(((self.names[joint.name], 1.0),)), right, [0.0, joint.mimic.factor])
            self.draft.constraint(f"{joint.name} mimics {joint.mimic.joint}", "coupling", joint.mimic.line, **fields)

    def _joint_ranges(self) -> Iterator[JointRange]:
        """Yield the ranges of the joints whose value in the reference configuration is known."""
        drawn, closing = self.robot.drawn(), {joint.name for joint in self.poses.closing}
        for joint in self.robot.joints:
            if joint.range and joint.kind in SCALAR and joint.name in closing:
                self.draft.leave_out(f"the range of {joint.name}: it closes a loop")
            elif joint.range and joint.kind in SCALAR:
                turns, value = joint.kind != "prismatic", drawn.get(joint.name, 0.0)
                yield JointRange(self.names[joint.name], turns, value, joint.range, joint.line)

    def _remarks(self) -> None:
        if any(body.get("mass") for body in self.draft.bodies):
            self.draft.forces.append({"type": "gravity", "acceleration": [0, 0, -9.81]})
        for remark in self.robot.unread:
            self.draft.leave_out(remark)


def _geometry(joint: RobotJoint | LoopJoint, frame: Transform) -> dict[str, Any]:
    """Return the fields ``at`` and ``axis`` of a joint in the world, as far as its kind has them."""
    place = {} if joint.kind == FIXED else {"at": vector(frame.at)}
    return place | ({"axis": vector(frame.turn @ np.array(joint.axis))} if joint.kind in WITH_AXIS else {})


def _written(robot: Robot) -> Iterator[str]:
    """Yield the texts of all positions and orientations in the file."""
    for element in robot.root.every():
        yield from (element.attributes[key] for key in ("xyz", "rpy") if key in element.attributes)


class Closure(NamedTuple):
    """A joint that closes a loop, with its two frames in the reference configuration, and its axis in the first frame.

    ``turned``: whether the second frame gives an orientation, and not only a position.
    """

    name: str
    kind: str
    first: Transform
    second: Transform
    axis: tuple[float, ...]
    turned: bool
    line: int

    def is_closed(self, size: float, tolerance: float) -> bool:
        """Return whether the ends of the joint meet in the reference configuration.

        Lengths and angles are accurate to ``tolerance``, a fraction of ``size``, which is the last digit in the file;
        positions to the displacements by such angles.
        """
        arm = self.first.turn.T @ (self.second.at - self.first.at)
        turn = self.first.turn.T @ self.second.turn if self.turned else np.eye(3)
        n = np.array(self.axis) / (np.linalg.norm(self.axis) or 1.0)
        along = float(arm @ n)
        off = abs(along) if self.kind == "planar" else float(np.linalg.norm(arm - n * along * (self.kind in _SLIDING)))
        digit = SLACK * max(tolerance * size, FINEST)
        return off <= digit * max(size, 1.0) and self._twist(turn, n) <= digit

    def _twist(self, turn: Array, axis: Array) -> float:
        """Return the size of the part of a relative rotation that the joint does not allow."""
        if self.kind in _BALLS:
            return 0.0
        return float(np.linalg.norm(turn @ axis - axis if self.kind in _TURNING else turn - np.eye(3)))


def closures(robot: Robot, poses: Poses) -> Iterator[Closure]:
    """Yield the joints that close loops: those whose child is already in the tree, and those of extensions."""
    for joint in poses.closing:
        if joint.kind != "floating":
            frame, child = poses.frame[joint.name], poses.pose[joint.child]
            yield Closure(joint.name, joint.kind, frame, child, joint.axis, True, joint.line)
    for loop in robot.loops:
        if loop.kind not in _BALLS:
            (first_link, first), (other, second) = loop.ends
            turned = not np.array_equal(second.turn, np.eye(3))
            ends = poses.pose[first_link].after(first), poses.pose[other].after(second)
            yield Closure(loop.name, loop.kind, *ends, loop.axis, turned, loop.line)


def faults_of_loops(robot: Robot, poses: Poses, size: float, tolerance: float) -> Iterator[Fault]:
    """Yield the faults of links without a root, of open loops, and of joints in a loop that mimic or are mimicked."""
    adrift = [name for name in robot.links if name not in poses.pose]
    if adrift:
        detail = f"the link '{adrift[0]}' is not connected to a root link: the joints above it form a cycle"
        hint = "let the joints lead from one root to every link"
        yield Fault(detail, line=robot.links[adrift[0]].line, column=1, hint=hint)
        return
    for closure in closures(robot, poses):
        if not closure.is_closed(size, tolerance):
            places = " and ".join(f"({', '.join(map(str, _short(f.at)))})" for f in (closure.first, closure.second))
            detail = f"its ends are at {places}, or in orientations that a {closure.kind} joint does not allow"
            message = f"the loop that '{closure.name}' closes is open where every joint is at 0: {detail}"
            yield Fault(message, line=closure.line, column=1, hint="change the origins so that its ends meet")
    closing = {joint.name for joint in poses.closing}
    for joint in robot.joints:
        if joint.mimic is not None and joint.kind != FIXED and not closing.isdisjoint((joint.name, joint.mimic.joint)):
            message = f"'{joint.name}' mimics '{joint.mimic.joint}', and one of them closes a loop"
            hint = "let another joint of the loop mimic, which the tree carries"
            yield Fault(message, line=joint.mimic.line, column=1, hint=hint)


def _short(values: Array) -> list[float | int]:
    return [float(f"{v:.6g}") for v in vector(values)]
