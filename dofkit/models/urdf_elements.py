"""The elements of a URDF file: its links and joints with every fault in its line, and where they stand."""

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
#: Those with one angle or displacement, which others may mimic; those with an axis.
FIXED = "fixed"
SCALAR = ("revolute", "continuous", "prismatic")
WITH_AXIS = (*SCALAR, "planar", "cylindrical")
#: Elements that say nothing of how a robot moves, and what they are.
_OTHERS = {
    "transmission": "transmissions: actuators are forces, not constraints",
    "gazebo": "elements for Gazebo, which only Gazebo defines",
    "sensor": "sensors",
    "ros2_control": "elements for controllers",
}


class Transform(NamedTuple):
    """A frame in another: x -> turn x + at."""

    turn: Array
    at: Array

    def after(self, other: Transform) -> Transform:
        """The other frame, given in this one, in what this is given in."""
        return Transform(self.turn @ other.turn, self.at + self.turn @ other.at)


class Mimic(NamedTuple):
    """q = factor times that of the other joint, and an offset."""

    joint: str
    factor: float
    offset: float
    line: int


class RobotLink(NamedTuple):
    """A link: its centre of mass with axes, mass, and inertia about the centre in these."""

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
    """Where links and the frames of joints stand; links from the root outwards, the joint that carries each.

    ``closing``: joints whose child is carried by another one already.
    """

    order: tuple[str, ...]
    pose: Mapping[str, Transform]
    frame: Mapping[str, Transform]
    joint_of: Mapping[str, RobotJoint]
    closing: tuple[RobotJoint, ...]


@dataclass(frozen=True)
class Robot:
    """A URDF file without faults."""

    name: str
    root: Element
    links: Mapping[str, RobotLink]
    joints: tuple[RobotJoint, ...]
    loops: tuple[LoopJoint, ...]
    unread: tuple[str, ...]

    def drawn(self) -> dict[str, float]:
        """The angle or displacement of every joint in the drawing that is not 0: offsets of those that mimic."""
        by_name = {joint.name: joint for joint in self.joints}
        found: dict[str, float] = {}
        for joint in self.joints:
            chain: list[Mimic] = []
            one = joint
            while one.mimic is not None and len(chain) <= len(by_name):
                chain.append(one.mimic)
                one = by_name[one.mimic.joint]
            value = 0.0
            for mimic in reversed(chain):
                value = mimic.factor * value + mimic.offset
            if value:
                found[joint.name] = value
        return found

    def poses(self) -> Poses:
        """Where everything stands, from the links that no joint carries."""
        drawn = self.drawn()
        below: dict[str, list[RobotJoint]] = {}
        for joint in self.joints:
            below.setdefault(joint.parent, []).append(joint)
        children = {joint.child for joint in self.joints}
        still = Transform(np.eye(3), np.zeros(3))
        pose = {name: still for name in self.links if name not in children}
        order, frame, joint_of, closing = [*pose], dict[str, Transform](), dict[str, RobotJoint](), []
        for name in order:
            for joint in below.get(name, ()):
                frame[joint.name] = pose[name].after(joint.origin)
                if joint.child in pose:
                    closing.append(joint)
                    continue
                pose[joint.child] = frame[joint.name].after(_moved(joint, drawn.get(joint.name, 0.0)))
                joint_of[joint.child] = joint
                order.append(joint.child)
        return Poses(tuple(order), pose, frame, joint_of, tuple(closing))


def _moved(joint: RobotJoint, by: float) -> Transform:
    """The child's frame in the joint's, where the joint stands so far from 0."""
    if not by:
        return Transform(np.eye(3), np.zeros(3))
    n = np.array(joint.axis) / np.linalg.norm(joint.axis)
    if joint.kind == "prismatic":
        return Transform(np.eye(3), by * n)
    k = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return Transform(np.eye(3) + math.sin(by) * k + (1 - math.cos(by)) * k @ k, np.zeros(3))


def read_robot(file: ModelFile) -> Robot:
    """The robot of a file. Raises SceneError with all its faults."""
    root = read_markup(file.data, file.name)
    reader = _RobotReader(root)
    robot = reader.robot()
    if reader.faults:
        raise SceneError(tuple(sorted(reader.faults, key=lambda fault: fault.line or 0)), file.name)
    return robot


@dataclass
class _RobotReader:
    """Reads a robot; ``faults`` are collected on the way."""

    root: Element
    faults: list[Fault] = field(default_factory=list)

    def robot(self) -> Robot:
        """The robot, of which nothing may be used where there are faults."""
        macro = next((part for part in self.root.every() if part.tag.startswith("xacro:")), None)
        if macro is not None:
            self._fault(macro, "this file has xacro macros", "expand them first: `xacro FILE > robot.urdf`")
            return Robot("", self.root, {}, (), (), ())
        links: dict[str, RobotLink] = {}
        for part in self.root.all("link"):
            if part.get("name") in links or not part.get("name"):
                self._fault(part, f"a link needs a name of its own, not '{part.get('name')}'", "rename it")
            links[part.get("name")] = self._link(part)
        joints = tuple(self._joint(part, links) for part in self.root.all("joint"))
        if not links:
            self._fault(
                self.root, "this robot has no link", "a URDF file holds <link name='...'/>; an SRDF file holds none"
            )
        self._check(joints, links)
        loops = tuple(found for part in self.root.below if (found := self._loop(part, links)) is not None)
        unread = [told for tag, told in _OTHERS.items() if self.root.first(tag) is not None]
        rubs = [part.first("dynamics") for part in self.root.all("joint")]
        if any((one.get("damping") + one.get("friction")).strip(" 0.") for one in rubs if one is not None):
            unread.append("damping and friction of joints: they are forces, not constraints")
        known = {"link", "joint", "material", "loop_joint", "ball_constraint", *_OTHERS}
        odd = dict.fromkeys(f"<{part.tag}>" for part in self.root.below if part.tag not in known)
        if odd:
            unread.append(f"{listed(odd)}: elements that URDF does not define")
        return Robot(self.root.get("name"), self.root, links, joints, loops, tuple(unread))

    def _link(self, part: Element) -> RobotLink:
        inertial = part.first("inertial")
        if inertial is None:
            return RobotLink(part.line, Transform(np.eye(3), np.zeros(3)), 0.0, np.zeros((3, 3)))
        mass, inertia = inertial.first("mass"), inertial.first("inertia")
        weight = 0.0 if mass is None else self._numbers(mass, "value", (0.0,))[0]
        if mass is not None and weight < 0:
            self._fault(mass, f"the mass of '{part.get('name')}' is negative", "write its mass, or 0")
        xx, xy, xz, yy, yz, zz = (
            0.0 if inertia is None else self._numbers(inertia, key, (0.0,))[0]
            for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        )
        rows = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        return RobotLink(part.line, self._origin(inertial.first("origin")), weight, rows)

    def _joint(self, part: Element, links: Mapping[str, RobotLink]) -> RobotJoint:
        name, kind = part.get("name"), part.get("type")
        if kind not in KINDS:
            near = nearest(kind, KINDS)
            hint = f"did you mean '{near}'?" if near else f"the types are {', '.join(KINDS)}"
            self._fault(part, f"there is no joint type '{kind}'", hint)
        ends = [self._named(part, tag, "link", links) for tag in ("parent", "child")]
        axis = part.first("axis")
        direction = (1.0, 0.0, 0.0) if axis is None else self._numbers(axis, "xyz", (1.0, 0.0, 0.0))
        if axis is not None and not any(direction) and kind in WITH_AXIS:
            self._fault(axis, f"the axis of '{name}' is zero", "write a direction, such as xyz='0 0 1'")
        limit, mimic = part.first("limit"), part.first("mimic")
        limits = None
        if limit is not None and (limit.get("lower") or limit.get("upper")):
            limits = (self._numbers(limit, "lower", (0.0,))[0], self._numbers(limit, "upper", (0.0,))[0])
        follows = None
        if mimic is not None:
            factor, offset = self._numbers(mimic, "multiplier", (1.0,))[0], self._numbers(mimic, "offset", (0.0,))[0]
            follows = Mimic(mimic.get("joint"), factor, offset, mimic.line)
        origin = self._origin(part.first("origin"))
        return RobotJoint(name, kind, ends[0], ends[1], origin, direction, limits, follows, part.line)

    def _check(self, joints: tuple[RobotJoint, ...], links: Mapping[str, RobotLink]) -> None:
        """What is told of joints together: names, what is mimicked, and that every link hangs on something."""
        known = {joint.name: joint for joint in joints}
        lines = {part.get("name"): part for part in self.root.all("joint")}
        if len(known) < len(joints):
            seen: set[str] = set()
            for part in self.root.all("joint"):
                if part.get("name") in seen:
                    self._fault(part, f"the joint '{part.get('name')}' is defined twice", "rename one of them")
                seen.add(part.get("name"))
        for joint in joints:
            if joint.mimic is None:
                continue
            other = known.get(joint.mimic.joint)
            kinds = (*SCALAR, FIXED)
            if other is None or other.kind not in kinds or joint.kind not in kinds or other is joint:
                near = nearest(joint.mimic.joint, tuple(known)) if other is None else None
                hint = f"did you mean '{near}'?" if near else f"joints that can be mimicked are {', '.join(SCALAR)}"
                self._fault(lines[joint.name], f"'{joint.name}' mimics '{joint.mimic.joint}', which it cannot", hint)
        self._check_mimics(known, lines)
        children = {joint.child for joint in joints}
        if links and children.issuperset(links):
            self._fault(self.root, "no link is the root: each is the child of a joint", "remove the joint of the root")

    def _check_mimics(self, known: Mapping[str, RobotJoint], lines: Mapping[str, Element]) -> None:
        for name, joint in known.items():
            seen, one = {name}, joint
            while one.mimic is not None and one.mimic.joint in known and one.mimic.joint not in seen:
                one = known[one.mimic.joint]
                seen.add(one.name)
            if one.mimic is not None and one.mimic.joint == name:
                self._fault(lines[name], f"'{name}' mimics itself through other joints", "remove one `mimic` element")

    def _loop(self, part: Element, links: Mapping[str, RobotLink]) -> LoopJoint | None:
        """A joint that closes a loop, as <loop_joint> or Drake's <ball_constraint> say it."""
        if part.tag == "loop_joint":
            ends = [(end, self._named(part, end, "link", links)) for end in ("link1", "link2")]
            frames = [(link, self._origin(part.first(end))) for end, link in ends]
            axis = part.first("axis")
            direction = (1.0, 0.0, 0.0) if axis is None else self._numbers(axis, "xyz", (1.0, 0.0, 0.0))
            kind = part.get("type", "ball")
            if kind not in KINDS or kind == "floating":
                self._fault(part, f"there is no loop joint of type '{kind}'", f"the types are {', '.join(KINDS)}")
            return LoopJoint(
                part.get("name") or f"loop_{part.line}", kind, (frames[0], frames[1]), direction, part.line
            )
        if part.tag == "ball_constraint":
            frames = []
            for end in "AB":
                place = part.first(f"ball_constraint_p_{end}{'P' if end == 'A' else 'Q'}")
                at = (0.0, 0.0, 0.0) if place is None else self._numbers(place, "value", (0.0, 0.0, 0.0))
                frames.append(
                    (
                        self._named(part, f"ball_constraint_body_{end}", "name", links),
                        Transform(np.eye(3), np.array(at)),
                    )
                )
            return LoopJoint(f"ball_{part.line}", "ball", (frames[0], frames[1]), (1.0, 0.0, 0.0), part.line)
        return None

    def _named(self, part: Element, tag: str, key: str, links: Mapping[str, RobotLink]) -> str:
        """The link that an element right below names."""
        found = part.first(tag)
        name = "" if found is None else found.get(key)
        if name not in links:
            near = nearest(name, tuple(links)) if name else None
            hint = f"did you mean '{near}'?" if near else f"write <{tag} {key}='LINK'/>"
            what = f"'{part.get('name')}'" if part.get("name") else f"<{part.tag}>"
            self._fault(found or part, f"{what} needs a {tag} that is a link, not '{name}'", hint)
        return name

    def _origin(self, part: Element | None) -> Transform:
        """x -> Rz(yaw) Ry(pitch) Rx(roll) x + xyz."""
        if part is None:
            return Transform(np.eye(3), np.zeros(3))
        zero = (0.0, 0.0, 0.0)
        r, p, y = self._numbers(part, "rpy", zero)
        (cr, cp, cy), (sr, sp, sy) = (tuple(map(f, (r, p, y))) for f in (math.cos, math.sin))
        turn = np.array(
            [
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ]
        )
        return Transform(turn, np.array(self._numbers(part, "xyz", zero)))

    def _numbers(self, part: Element, key: str, otherwise: tuple[float, ...]) -> tuple[float, ...]:
        """As many numbers as there are otherwise."""
        text = part.get(key)
        if not text.strip():
            return otherwise
        try:
            found = tuple(map(float, text.split()))
        except ValueError:
            found = ()
        if len(found) != len(otherwise) or not all(map(math.isfinite, found)):
            count = "a number" if len(otherwise) == 1 else f"{len(otherwise)} numbers"
            self._fault(
                part, f"`{key}` needs {count}, not '{text[:40]}'", f"write {key}='{' '.join(['0'] * len(otherwise))}'"
            )
            return otherwise
        return found

    def _fault(self, part: Element, message: str, hint: str) -> None:
        self.faults.append(Fault(message, line=part.line, column=1, hint=hint))
