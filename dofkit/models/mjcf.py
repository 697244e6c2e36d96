"""MJCF, the models of MuJoCo, as scenes: the compiled bodies, joints, equalities and tendons.

The compiler runs in a worker that can be killed (`mujoco_model`). The origin of a body is its centre of mass. Several
joints of one body are in series, as in MuJoCo, with bodies without mass between them, named after the joint before.
Bodies that MuJoCo welds to the world are part of the ground.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from dofkit.base.errors import Fault, SceneError
from dofkit.base.runs import shared
from dofkit.base.workers import Job
from dofkit.models.joint_relations import JointSum, bounds, relation
from dofkit.models.markup import Element, read_markup
from dofkit.models.model_document import (
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
from dofkit.system import GROUND

#: Attributes that give positions or orientations.
_PLACING = ("pos", "quat", "axisangle", "xyaxes", "zaxis", "euler", "axis", "fromto", "anchor", "relpose", "ref")
_KINDS = {"hinge": "revolute", "slide": "prismatic", "ball": "spherical"}

#: The time limit of the compiler in seconds.
SECONDS = 60.0
#: The module that runs in a worker process, which is kept for later models.
COMPILER = "dofkit.models.mujoco_model"
#: The most files that a model may include, nested ones counted.
MOST_INCLUDED = 300

#: Attributes whose numbers must be finite.
_MEASURES = (*_PLACING, "mass", "diaginertia", "fullinertia", "density", "polycoef", "size", "gravity")
_NO_NUMBER = re.compile(r"[+-]?(?:nan|inf|infinity)", re.IGNORECASE)
_LINE = re.compile(r"line (\d+)")
_NOISE = re.compile(r"^(?:XML )?Error: (?:Error: )?|,? ?line \d+\s*$|\bElement name '', id -?\d+")


def read(file: ModelFile) -> ModelDocument:
    """Return the scene of an MJCF file. Raises SceneError if it cannot be compiled, or no near pose is closed."""
    model = compiled(file)
    if not model.content["closed"]:
        hint = "give a pose that satisfies them, or switch them off: active='false'"
        fault = Fault("the equalities are satisfied neither in the given pose nor in one near it", hint=hint)
        raise SceneError((fault,), file.name)
    title = model.root.get("model") or file.name
    return _MjcfScene(model, SceneDraft(title), file.limits).document()


@dataclass
class _MjcfScene:
    """Writes the scene: ``carriers`` lists the scene's body for each body of MuJoCo, ``names`` maps joints to names.

    ``loops``: whether equalities close loops; otherwise the freedom does not depend on special positions.
    """

    model: CompiledModel
    draft: SceneDraft
    limits: bool
    carriers: list[str] = field(default_factory=list)
    names: dict[int, str] = field(default_factory=dict)
    loops: bool = False

    def __post_init__(self) -> None:
        self.content = self.model.content
        self.line: dict[tuple[str, str], int] = {}
        for element in self.model.root.every():
            kind = "joint" if element.tag == "freejoint" else element.tag
            self.line.setdefault((kind, element.get("name")), element.line)

    def document(self) -> ModelDocument:
        """Return the scene, with its entries in the order of the model."""
        used = {body for e in self.content["equalities"] for body, _ in e.get("ends", ())}
        used |= {step["end"][0] for t in self.content["tendons"] for step in t["path"] if step["end"]}
        parents = {b["parent"] for b in self.content["bodies"]}
        still, markers = [], []
        for i, body in enumerate(self.content["bodies"]):
            if body["static"]:
                self.carriers.append(GROUND)
                still += [body["name"]] if i and body["name"] else []
            elif not body["joints"] and not body["mass"] and i not in used | parents:
                self.carriers.append(self.carriers[body["parent"]])
                markers.append(body["name"])
            else:
                self._body(i, body)
        if still:
            self.draft.leave_out(f"{listed(still)}: fixed to the world, so they belong to the ground")
        if markers:
            self.draft.leave_out(f"{listed(markers)}: markers without mass that nothing refers to")
        for equality in self.content["equalities"]:
            self._equality(equality)
        self._ranges()
        self._remarks()
        return self.draft.document(self._tolerance(), self.loops)

    def _body(self, index: int, body: Mapping[str, Any]) -> None:
        """Add a body with its joints, and bodies without mass between several joints; without joints weld it."""
        name = body["name"] or f"body_{index}"
        line = self.line.get(("body", body["name"]))
        below = self.carriers[body["parent"]]
        joints = [(j, self.content["joints"][j]) for j in body["joints"]]
        for j, joint in joints[:-1]:
            called = joint["name"] or f"{name}_{joint['kind']}_{j}"
            between = self.draft.body(f"after_{called}", line, mass=0, inertia=[0, 0, 0])
            self.draft.place(between, joint["anchor"])
            self._joint(j, joint, (below, between))
            below = between
        inner = self.draft.body(name, line, mass=number(body["mass"]), inertia=inertia_of(body["inertia"]))
        self.draft.place(inner, body["centre"])
        self.carriers.append(inner)
        if joints:
            self._joint(*joints[-1], (below, inner))
        else:
            self.draft.constraint(name, "weld", line, between=[below, inner])

    def _joint(self, index: int, joint: Mapping[str, Any], between: tuple[str, str]) -> None:
        """Add a joint, unless it is free, and note its name in ``names``."""
        if joint["kind"] == "free":
            return
        line = self.line.get(("joint", joint["name"]))
        fields: dict[str, Any] = {"between": [*between], "at": vector(joint["anchor"])}
        if joint["kind"] != "ball":
            fields["axis"] = vector(joint["axis"])
        kind = _KINDS[joint["kind"]]
        self.names[index] = self.draft.constraint(joint["name"] or between[1], kind, line, **fields)

    def _equality(self, entry: Mapping[str, Any]) -> None:
        """Add an equality as a constraint, or note why it is left out."""
        kind, name = entry["kind"], entry["name"] or entry["kind"]
        line = self.line.get((kind, entry["name"])) if entry["name"] else None
        if not entry["active"]:
            self.draft.leave_out(f"the equality {name}: it is switched off")
        elif kind in ("connect", "weld"):
            first, second = bodies = [self.carriers[body] for body, _ in entry["ends"]]
            if first == second:
                self.draft.leave_out(f"the equality {name}: both of its ends belong to {first}")
                return
            self.loops = True
            if entry["turning"]:
                self.draft.constraint(name, "weld", line, between=bodies)
            else:
                self.draft.constraint(name, "coincident", line, between=self._points(entry["ends"]))
        elif kind in ("joint", "tendon"):
            self._coupling(name, kind, entry, line)
        else:
            self.draft.leave_out(f"{name}: of kind {kind}, which only MuJoCo defines", binding=True)

    def _coupling(self, name: str, kind: str, entry: Mapping[str, Any], line: int | None) -> None:
        """Add an equality between joints or tendons, or of a tendon's length, or note why it is left out."""
        of = [i for i in entry["of"] if i >= 0]
        if kind == "tendon" and len(of) == 1 and self._string(name, of[0], entry["polynomial"][0], line):
            return
        sums = [self._joint_sum(i) if kind == "joint" else self._fixed_tendon(i) for i in of]
        totals = [total for total in sums if total is not None]
        if len(totals) < len(sums):
            self.draft.leave_out(f"{name}: of tendons that wrap around shapes", binding=True)
            return
        fields = relation(totals[0], totals[1] if len(totals) > 1 else None, entry["polynomial"])
        self.draft.constraint(name, "coupling", line, **fields)

    def _joint_sum(self, index: int) -> JointSum:
        joint = self.content["joints"][index]
        return JointSum(((self.names[index], 1.0),), joint["reference"] - joint["zero"])

    def _fixed_tendon(self, index: int) -> JointSum | None:
        """Return the elongation, from MuJoCo's zero, of a tendon that is a sum of joint values; None for others."""
        tendon = self.content["tendons"][index]
        if any(step["kind"] != "joint" for step in tendon["path"]):
            return None
        terms = tuple((self.names[step["of"]], step["factor"]) for step in tendon["path"])
        return JointSum(terms, tendon["length"] - tendon["zero"])

    def _string(self, name: str, index: int, more: float, line: int | None) -> bool:
        """Add a tendon between sites as a string, ``more`` longer than in the zero pose; False for other tendons."""
        tendon = self.content["tendons"][index]
        if any(step["kind"] != "site" for step in tendon["path"]):
            return False
        self.loops = True
        fields = {} if not more else {"length": number(tendon["zero"] + more)}
        along = self._points([step["end"] for step in tendon["path"]])
        self.draft.constraint(name, "string", line, along=along, **fields)
        return True

    def _points(self, ends: Iterable[Sequence[Any]]) -> list[Any]:
        """Return the points of the scene for ``ends``: (number of a body, world position)."""
        return [point_of(self.carriers[body], at) for body, at in ends]

    def _ranges(self) -> None:
        """Add ranges of joints and tendons as inequalities with ``limits``, else note them as left out."""
        joints = [(name, self.content["joints"][i]) for i, name in self.names.items()]
        self.draft.ranges(
            [
                JointRange(name, j["kind"] == "hinge", j["reference"], j["range"], self.line.get(("joint", j["name"])))
                for name, j in joints
                if j["range"] and not (self.limits and j["kind"] == "ball")
            ],
            self.limits,
        )
        if self.limits and (balls := [name for name, j in joints if j["range"] and j["kind"] == "ball"]):
            self.draft.leave_out(f"the ranges of {listed(balls)}: of ball joints")
        tendons = [(i, t) for i, t in enumerate(self.content["tendons"]) if t["range"]]
        if tendons and not self.limits:
            self.draft.leave_out(f"the ranges of tendons ({listed(t['name'] for _, t in tendons)})")
        for i, tendon in tendons if self.limits else ():
            total = self._fixed_tendon(i)
            if total is None:
                self.draft.leave_out(f"the range of the tendon {tendon['name']}: it runs through space")
            else:
                fields = bounds(JointSum(total.terms, tendon["length"]), tendon["range"])
                self.draft.constraint(f"{tendon['name']} range", "coupling", None, **fields)

    def _remarks(self) -> None:
        """Add gravity, and note forces, contacts and other parts that are left out, and changes to the model."""
        entry = self.content
        if any(entry["gravity"]) and self.draft.bodies:
            self.draft.forces.append({"type": "gravity", "acceleration": vector(entry["gravity"])})
        for key, what in (
            ("contacts", "contacts between shapes: they open and close during the motion"),
            ("actuators", "actuators: they are forces, not constraints"),
            ("springs", "springs of joints and tendons: they are forces, not constraints"),
            ("friction", "damping and friction of joints and tendons: they are forces, not constraints"),
            ("rotors", "armature, the inertia of rotors that turn with joints: it is not a constraint"),
            ("lifted", "compensation of gravity: it is a force, not a constraint"),
            ("medium", "the medium that bodies move in: its drag is a force, not a constraint"),
            ("flexible", "flexible bodies: only MuJoCo defines them"),
        ):
            if entry[key]:
                self.draft.leave_out(what)
        straight = {"joint", "site"}
        around = [t["name"] for t in entry["tendons"] if not {step["kind"] for step in t["path"]} <= straight]
        if around:
            what = "wrap around shapes or pulleys: their length there is defined by MuJoCo only"
            self.draft.leave_out(f"the tendons {listed(around)}, which {what}; without an equality they only pull")
        for note in entry["notes"]:
            self.draft.leave_out(note)

    def _tolerance(self) -> float:
        """Return the tolerance by the digits of the positions and orientations in the files."""
        written = (
            value
            for root in (self.model.root, *self.model.included)
            for element in root.every()
            for key, value in element.attributes.items()
            if key in _PLACING
        )
        places = [*(j["anchor"] for j in self.content["joints"]), *(b["centre"] for b in self.content["bodies"][1:])]
        size = max((max(c) - min(c) for c in zip(*places, strict=True)), default=1.0)
        return tolerance_of(written, size)


class CompiledModel(NamedTuple):
    """A compiled model (see `mujoco_model.described_model`), the root of its XML, and the roots of included files."""

    content: dict[str, Any]
    root: Element
    included: tuple[Element, ...]


def compiled(file: ModelFile) -> CompiledModel:
    """Return the compiled model. Raises SceneError if the compiler refuses it or is stopped."""
    root = read_markup(file.data, file.name)
    included = tuple(_included(root, file))
    faults = [*_not_finite(root), *(fault for part in included for fault in _not_finite(part))]
    if faults:
        raise SceneError(tuple(faults), file.name)
    payload = {"path": None if file.path is None else str(file.path), "text": file.text}
    outcome = shared(COMPILER).run(Job(f"{COMPILER}:described_model", payload, SECONDS))
    if not outcome.finished:
        raise SceneError((_fault(outcome.reason, outcome.error),), file.name)
    return CompiledModel(outcome.value, root, included)


def _not_finite(root: Element) -> Iterator[Fault]:
    """Yield a fault for every number that is not finite, which the compiler would accept."""
    for part in root.every():
        for key in _MEASURES:
            odd = [word for word in part.get(key).split() if _NO_NUMBER.fullmatch(word)]
            if odd:
                hint = "write a finite number"
                yield Fault(f"`{key}` of <{part.tag}> holds '{odd[0]}'", line=part.line, column=1, hint=hint)


def _fault(reason: str, error: str) -> Fault:
    """Return the compiler's error as a fault with its line; without ``error`` the worker was stopped."""
    if not error:
        return Fault(f"MuJoCo's compiler was stopped: {reason}", hint="make the model smaller, or split it")
    said = reason.removeprefix(f"{error}: ")
    lines = _LINE.findall(said)
    while (shorter := _NOISE.sub("", said).strip()) != said:
        said = shorter
    line = int(lines[-1]) if lines and int(lines[-1]) > 0 else None
    hint = "correct the model; `python -m mujoco.viewer --mjcf=FILE` shows it"
    return Fault(f"MuJoCo's compiler: {said}", line=line, column=None if line is None else 1, hint=hint)


def _included(root: Element, file: ModelFile) -> Iterator[Element]:
    """Yield the root elements of all included files; missing ones are skipped, because the compiler reports them."""
    if file.path is None:
        return
    top, seen = file.path.parent, {file.path.resolve()}
    stack = [(root, top)]
    while stack:
        element, folder = stack.pop()
        for part in element.every():
            if part.tag != "include" or not part.get("file"):
                continue
            places = [(at / part.get("file")) for at in (folder, top)]
            place = next((p for p in places if p.is_file()), None)
            if place is None or place.resolve() in seen:
                continue
            seen.add(place.resolve())
            if len(seen) > MOST_INCLUDED:
                hint = "split the model"
                raise SceneError(
                    (Fault(f"more than {MOST_INCLUDED} files are included", line=part.line, column=1, hint=hint),)
                )
            model = _read_part(place, part)
            yield model
            stack.append((model, place.parent))


def _read_part(place: Path, part: Element) -> Element:
    """Return the root of an included file. Raises SceneError at the line of the ``include`` element ``part``."""
    try:
        return read_markup(place.read_bytes(), place.name)
    except SceneError as error:
        faults = "; ".join(fault.message for fault in error.faults)
        message = f"the file '{part.get('file')}' cannot be included: {faults}"
        raise SceneError((Fault(message, line=part.line, column=1, hint=error.faults[0].hint),)) from None
    except OSError as error:
        message = f"the file '{part.get('file')}' cannot be read: {error.strerror}"
        raise SceneError((Fault(message, line=part.line, column=1, hint="check the path"),)) from None
