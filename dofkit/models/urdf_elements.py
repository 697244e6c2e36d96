"""The elements of a URDF file: its links and joints, their faults with lines, and their poses."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from dofkit.base.errors import Fault, SceneError
from dofkit.base.wording import nearest
from dofkit.models.markup import Element, read_markup
from dofkit.models.model_document import ModelFile, listed

Array: TypeAlias = Any
KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar", "ball", "spherical", "cylindrical")
FIXED = "fixed"
#: Kinds of joints with one angle or displacement, which can be mimicked, and kinds with an axis.
SCALAR = ("revolute", "continuous", "prismatic")
WITH_AXIS = (*SCALAR, "planar", "cylindrical")
_X = (1.0, 0.0, 0.0)
_ZERO = (0.0, 0.0, 0.0)
#: {tag of elements that do not affect the motion: note about them}.
_OTHERS = {
    "transmission": "transmissions: actuators are forces, not constraints",
    "gazebo": "elements for Gazebo, which only Gazebo defines",
    "sensor": "sensors",
    "ros2_control": "elements for controllers",
}


class Transform(NamedTuple):
    """A frame relative to another: x -> turn x + at."""

    turn: Array
    at: Array

    def after(self, other: Transform) -> Transform:
        """Return ``other``, which is relative to this frame, relative to the same frame as this one."""
        return Transform(self.turn @ other.turn, self.at + self.turn @ other.at)


def moved_by(at: tuple[float, ...] = _ZERO) -> Transform:
    """Return a frame that is displaced and not rotated."""
    return Transform(np.eye(3), np.array(at))


class Mimic(NamedTuple):
    """A joint value q = factor * (value of ``joint``) + offset."""

    joint: str
    factor: float
    offset: float
    line: int


class RobotLink(NamedTuple):
    """A link: its centre of mass with axes, its mass, and its inertia about the centre in these axes."""

    line: int
    centre: Transform
    mass: float
    inertia: Array


class RobotJoint(NamedTuple):
    """A joint: its frame in the parent link, and the axis in that frame."""

    name: str
    kind: str
    parent: str
    child: str
    origin: Transform
    axis: tuple[float, ...]
    range: tuple[float, float] | None
    mimic: Mimic | None
    line: int


class LoopJoint(NamedTuple):
    """A joint that closes a loop, by its frames in two links."""

    name: str
    kind: str
    ends: tuple[tuple[str, Transform], tuple[str, Transform]]
    axis: tuple[float, ...]
    line: int


class Poses(NamedTuple):
    """The poses of links and joint frames; ``order``: links from the root outwards; ``joint_of``: parent joints.

    ``closing``: joints whose child already has a parent joint.
    """

    order: tuple[str, ...]
    pose: Mapping[str, Transform]
    frame: Mapping[str, Transform]
    joint_of: Mapping[str, RobotJoint]
    closing: tuple[RobotJoint, ...]


@dataclass(frozen=True)
class Robot:
    """The content of a URDF file without faults; ``unread``: notes on what is left out."""

    name: str
    root: Element
    links: Mapping[str, RobotLink]
    joints: tuple[RobotJoint, ...]
    loops: tuple[LoopJoint, ...]
    unread: tuple[str, ...]

    def drawn(self) -> dict[str, float]:
        """Return {joint: nonzero value in the reference configuration}, by the offsets of `mimic` elements."""
        by_name = {joint.name: joint for joint in self.joints}
        values: dict[str, float] = {}
        for joint in self.joints:
            chain: list[Mimic] = []
            leader = joint
            while leader.mimic is not None and len(chain) <= len(by_name):
                chain.append(leader.mimic)
                leader = by_name[leader.mimic.joint]
            value = 0.0
            for mimic in reversed(chain):
                value = mimic.factor * value + mimic.offset
            if value:
                values[joint.name] = value
        return values

    def poses(self) -> Poses:
        """Return the poses in the reference configuration, along a tree of joints from the root links at the origin."""
        drawn = self.drawn()
        below: dict[str, list[RobotJoint]] = {}
        for joint in self.joints:
            below.setdefault(joint.parent, []).append(joint)
        children = {joint.child for joint in self.joints}
        pose = {name: moved_by() for name in self.links if name not in children}
        order, frame, joint_of, closing = [*pose], dict[str, Transform](), dict[str, RobotJoint](), []
        for name in order:
            for joint in below.get(name, ()):
                frame[joint.name] = pose[name].after(joint.origin)
                if joint.child in pose:
                    closing.append(joint)
                    continue
                pose[joint.child] = frame[joint.name].after(_displaced(joint, drawn.get(joint.name, 0.0)))
                joint_of[joint.child] = joint
                order.append(joint.child)
        return Poses(tuple(order), pose, frame, joint_of, tuple(closing))


def _displaced(joint: RobotJoint, value: float) -> Transform:
    """Return the child's frame relative to the joint's frame for a joint value."""
    if not value:
        return moved_by()
    n = np.array(joint.axis) / np.linalg.norm(joint.axis)
    if joint.kind == "prismatic":
        return moved_by(value * n)
    k = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return Transform(np.eye(3) + math.sin(value) * k + (1 - math.cos(value)) * k @ k, np.zeros(3))


def read_robot(file: ModelFile) -> Robot:
    """Return the robot of a file. Raises SceneError with all faults."""
    reader = _RobotReader(read_markup(file.data, file.name))
    robot = reader.robot()
    if reader.faults:
        raise SceneError(tuple(sorted(reader.faults, key=lambda fault: fault.line or 0)), file.name)
    return robot


@dataclass
class _RobotReader:
    """Reads a robot, and collects ``faults``."""

    root: Element
    faults: list[Fault] = field(default_factory=list)

    def robot(self) -> Robot:
        """Return the robot, which must not be used if there are faults."""
        macro = next((part for part in self.root.every() if part.tag.startswith("xacro:")), None)
        if macro is not None:
            self._fault(macro, "this file has xacro macros", "expand them first: `xacro FILE > robot.urdf`")
            return Robot("", self.root, {}, (), (), ())
        links: dict[str, RobotLink] = {}
        for part in self.root.all("link"):
            if part.get("name") in links or not part.get("name"):
                self._fault(part, f"a link needs a name of its own, not '{part.get('name')}'", "rename it")
            links[part.get("name")] = self._link(part)
        if not links:
            hint = "a URDF file holds <link name='...'/>; an SRDF file holds none"
            self._fault(self.root, "this robot has no link", hint)
        joints = tuple(self._joint(part, links) for part in self.root.all("joint"))
        self._check_joints(joints)
        if links and {joint.child for joint in joints}.issuperset(links):
            self._fault(self.root, "no link is the root: each is the child of a joint", "remove the joint of the root")
        loops = [self._loop_joint(part, links) for part in self.root.all("loop_joint")]
        loops += [self._ball_constraint(part, links) for part in self.root.all("ball_constraint")]
        unread = [what for tag, what in _OTHERS.items() if self.root.first(tag) is not None]
        dynamics = [part.first("dynamics") for part in self.root.all("joint")]
        if any((part.get("damping") + part.get("friction")).strip(" 0.") for part in dynamics if part is not None):
            unread.append("damping and friction of joints: they are forces, not constraints")
        read_tags = {"link", "joint", "material", "loop_joint", "ball_constraint", *_OTHERS}
        undefined = dict.fromkeys(f"<{part.tag}>" for part in self.root.below if part.tag not in read_tags)
        if undefined:
            unread.append(f"{listed(undefined)}: elements that URDF does not define")
        return Robot(self.root.get("name"), self.root, links, joints, tuple(loops), tuple(unread))

    def _link(self, part: Element) -> RobotLink:
        """Return a link, without mass if it has no `inertial` element."""
        inertial = part.first("inertial")
        if inertial is None:
            return RobotLink(part.line, moved_by(), 0.0, np.zeros((3, 3)))
        mass, inertia = inertial.first("mass"), inertial.first("inertia")
        value = self._number(mass, "value", 0.0)
        if mass is not None and value < 0:
            self._fault(mass, f"the mass of '{part.get('name')}' is negative", "write its mass, or 0")
        xx, xy, xz, yy, yz, zz = (self._number(inertia, f"i{ij}", 0.0) for ij in ("xx", "xy", "xz", "yy", "yz", "zz"))
        rows = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        return RobotLink(part.line, self._origin(inertial.first("origin")), value, rows)

    def _joint(self, part: Element, links: Mapping[str, RobotLink]) -> RobotJoint:
        """Return the joint of an element, whose faults are recorded."""
        name, kind = part.get("name"), part.get("type")
        if kind not in KINDS:
            near = nearest(kind, KINDS)
            hint = f"did you mean '{near}'?" if near else f"the types are {', '.join(KINDS)}"
            self._fault(part, f"there is no joint type '{kind}'", hint)
        parent, child = (self._named(part, tag, "link", links) for tag in ("parent", "child"))
        direction = self._axis(part)
        if not any(direction) and kind in WITH_AXIS:
            hint = "write a direction, such as xyz='0 0 1'"
            self._fault(part.first("axis") or part, f"the axis of '{name}' is zero", hint)
        limit, mimic = part.first("limit"), part.first("mimic")
        limits = None
        if limit is not None and (limit.get("lower") or limit.get("upper")):
            limits = self._number(limit, "lower", 0.0), self._number(limit, "upper", 0.0)
        follows = None
        if mimic is not None:
            factor, offset = self._number(mimic, "multiplier", 1.0), self._number(mimic, "offset", 0.0)
            follows = Mimic(mimic.get("joint"), factor, offset, mimic.line)
        origin = self._origin(part.first("origin"))
        return RobotJoint(name, kind, parent, child, origin, direction, limits, follows, part.line)

    def _check_joints(self, joints: tuple[RobotJoint, ...]) -> None:
        """Record faults of repeated joint names, and of `mimic` elements that are impossible or cyclic."""
        by_name: dict[str, RobotJoint] = {}
        lines = {part.get("name"): part for part in self.root.all("joint")}
        for joint, part in zip(joints, self.root.all("joint"), strict=True):
            if joint.name in by_name:
                self._fault(part, f"the joint '{joint.name}' is defined twice", "rename one of them")
            by_name[joint.name] = joint
        for joint in joints:
            if joint.mimic is None:
                continue
            other, kinds = by_name.get(joint.mimic.joint), (*SCALAR, FIXED)
            if other is None or other is joint or other.kind not in kinds or joint.kind not in kinds:
                near = nearest(joint.mimic.joint, tuple(by_name)) if other is None else None
                hint = f"did you mean '{near}'?" if near else f"joints that can be mimicked are {', '.join(SCALAR)}"
                self._fault(lines[joint.name], f"'{joint.name}' mimics '{joint.mimic.joint}', which it cannot", hint)
        for name, joint in by_name.items():
            seen, leader = {name}, joint
            while leader.mimic is not None and leader.mimic.joint in by_name and leader.mimic.joint not in seen:
                leader = by_name[leader.mimic.joint]
                seen.add(leader.name)
            if leader.mimic is not None and leader.mimic.joint == name:
                self._fault(lines[name], f"'{name}' mimics itself through other joints", "remove one `mimic` element")

    def _loop_joint(self, part: Element, links: Mapping[str, RobotLink]) -> LoopJoint:
        first, second = (
            (self._named(part, end, "link", links), self._origin(part.first(end))) for end in ("link1", "link2")
        )
        kind = part.get("type", "ball")
        if kind not in KINDS or kind == "floating":
            self._fault(part, f"there is no loop joint of type '{kind}'", f"the types are {', '.join(KINDS)}")
        return LoopJoint(part.get("name") or f"loop_{part.line}", kind, (first, second), self._axis(part), part.line)

    def _ball_constraint(self, part: Element, links: Mapping[str, RobotLink]) -> LoopJoint:
        """Return the joint of a `drake:ball_constraint`: point P of body A coincides with Q of B."""
        first, second = (
            (
                self._named(part, f"ball_constraint_body_{end}", "name", links),
                moved_by(self._numbers(part.first(f"ball_constraint_p_{end}{letter}"), "value", _ZERO)),
            )
            for end, letter in ("AP", "BQ")
        )
        return LoopJoint(f"ball_{part.line}", "ball", (first, second), _X, part.line)

    def _named(self, part: Element, tag: str, key: str, links: Mapping[str, RobotLink]) -> str:
        """Return the link that the attribute ``key`` of the child element ``tag`` names; a fault if there is none."""
        below = part.first(tag)
        name = "" if below is None else below.get(key)
        if name not in links:
            near = nearest(name, tuple(links)) if name else None
            hint = f"did you mean '{near}'?" if near else f"write <{tag} {key}='LINK'/>"
            owner = f"'{part.get('name')}'" if part.get("name") else f"<{part.tag}>"
            self._fault(below or part, f"{owner} needs a {tag} that is a link, not '{name}'", hint)
        return name

    def _axis(self, part: Element) -> tuple[float, ...]:
        return self._numbers(part.first("axis"), "xyz", _X)

    def _origin(self, part: Element | None) -> Transform:
        """Return the frame x -> Rz(yaw) Ry(pitch) Rx(roll) x + xyz of an `origin` element."""
        r, p, y = self._numbers(part, "rpy", _ZERO)
        (cr, cp, cy), (sr, sp, sy) = (tuple(map(f, (r, p, y))) for f in (math.cos, math.sin))
        turn = np.array(
            [
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ]
        )
        return Transform(turn, np.array(self._numbers(part, "xyz", _ZERO)))

    def _number(self, part: Element | None, key: str, default: float) -> float:
        return self._numbers(part, key, (default,))[0]

    def _numbers(self, part: Element | None, key: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """Return as many numbers as ``default`` has; ``default`` if they are missing or after a fault."""
        text = "" if part is None else part.get(key)
        if part is None or not text.strip():
            return default
        try:
            numbers = tuple(map(float, text.split()))
        except ValueError:
            numbers = ()
        if len(numbers) != len(default) or not all(map(math.isfinite, numbers)):
            count = "a number" if len(default) == 1 else f"{len(default)} numbers"
            hint = f"write {key}='{' '.join(['0'] * len(default))}'"
            self._fault(part, f"`{key}` needs {count}, not '{text[:40]}'", hint)
            return default
        return numbers

    def _fault(self, part: Element, message: str, hint: str) -> None:
        self.faults.append(Fault(message, line=part.line, column=1, hint=hint))
