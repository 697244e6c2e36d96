"""Laws: what must not change when a scene is written in another way.

The scenes of the catalog and of the tests are dealt out to the ways of writing them, so that every scene is written
in several other ways and every way is tried on dozens of scenes, most of them in the sweep. The few scenes to
which a law does not apply are told by a predicate, never by name.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import EVERY, SCENES, VARIED, dealt, few, report_of, scene_of, stem
from shared.report_laws import agrees_with_itself, surplus

import dofkit
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.constraints.base import Equation
from dofkit.scene.lowering import lower
from dofkit.scene.names import owner_kinds
from dofkit.scene.scene import Scene

Document = dict[str, Any]

NUMBERS = (
    "consistent", "dof", "velocity_dof", "instantaneous_dof", "singular", "holonomic", "scleronomic",
    "redundant_equations",
)  # fmt: skip
LABELS = ("form", "holonomic", "holonomic_alone", "scleronomic", "catastatic", "bilateral", "equations")
#: What tells the scene's story and not its mathematics.
STORY = ("title", "source", "notes", "picture", "expect", "energies")


every_scene = pytest.mark.parametrize("path", EVERY, ids=stem)


def on(what: str, paths: Sequence[Path]) -> pytest.MarkDecorator:
    """One in twelve of these, and the others in the sweep."""
    return pytest.mark.parametrize("path", few(what, paths, 12), ids=stem)


def document_of(path: Path) -> Document:
    """The scene as a mapping, every constraint with the name that it goes by."""
    told: Document = scene_of(path).model_dump(mode="json", exclude_unset=True)
    written = {key: value for key, value in told.items() if key not in STORY}
    constraints = zip(written.get("constraints", []), report_of(path).constraints, strict=True)
    return {**written, "constraints": [{**constraint, "name": entry.name} for constraint, entry in constraints]}


def classified(document: Mapping[str, Any]) -> Report:
    return dofkit.classify(dofkit.load(document))


def numbers(report: Report) -> dict[str, Any]:
    return {key: getattr(report, key) for key in NUMBERS} | {"nullities": nullities(report), "growth": growth(report)}


def nullities(report: Report) -> list[int]:
    return sorted(group.nullity for group in report.redundancies)


def labels(entry: ConstraintEntry) -> tuple[Any, ...]:
    return tuple(getattr(entry, key) for key in LABELS)


def all_labels(report: Report) -> dict[str, tuple[Any, ...]]:
    return {entry.name: labels(entry) for entry in report.constraints}


# Factors that never vanish

EQUATION = re.compile(r"[^=<>≤≥]*=?[^=<>≤≥]*")
FACTORS = ["exp(t)", "(2 + cos({q}))", "(1 + {q}^2)", "7", "(-3/1000000)", "(exp({q} - t)/(3 + sin({q})))"]


def multiplied(document: Document, factor: str, coordinate: str) -> Document:
    """Every equation that is written as a text, times the factor."""

    def scaled(constraint: Document) -> Document:
        text = constraint.get("text", "")
        if not text or constraint.get("type", "equation") != "equation" or not EQUATION.fullmatch(text):
            return constraint
        left, _, right = text.partition("=")
        return {**constraint, "text": f"{factor.format(q=coordinate)} (({left}) - ({right or 0})) = 0"}

    return {**document, "constraints": [scaled(c) for c in document["constraints"]]}


def coordinate_of(path: Path) -> str:
    """The first coordinate of the scene."""
    return next(q.name for q in lower(scene_of(path)).coordinates)


def has_equation(path: Path) -> bool:
    texts = [c.text for c in scene_of(path).constraints if isinstance(c, Equation)]
    return any(EQUATION.fullmatch(text) for text in texts)


#: One factor a scene.
MULTIPLIED = [
    pytest.param(*case.values, factor, marks=case.marks, id=f"{case.values[0].stem}-{factor}")
    for factor, hand in zip(FACTORS, dealt("factors", SCENES, len(FACTORS)), strict=True)
    for case in few(factor, hand, 4)
]


@pytest.mark.parametrize(("path", "factor"), MULTIPLIED)
def test_a_factor_that_never_vanishes_changes_nothing(path: Path, factor: str) -> None:
    if not has_equation(path):
        return
    report, other = report_of(path), classified(multiplied(document_of(path), factor, coordinate_of(path)))
    assert numbers(other) == numbers(report)
    assert all_labels(other) == all_labels(report)
    assert [e.circuit for e in other.constraints] == [e.circuit for e in report.constraints]
    assert other.redundant == report.redundant


# Names

OWNER_KEYS = ("between", "members", "point", "body", "on", "along", "carrier")
PLAIN_KEYS = ("type", "name", *STORY)
WORD = re.compile(r"[^\W\d]\w*")


class Renaming:
    """New names for all that a scene declares: of owners, and of symbols in texts."""

    def __init__(self, scene: Scene, new: Callable[[str], str]) -> None:
        kinds = owner_kinds(scene)
        self.owners = {part.name: new(part.name) for kind in kinds for part in kind.owners}
        self.symbols = {name: new(name) for name in (*scene.coordinates, *scene.parameters, *scene.functions)}
        for kind in kinds:
            for part in kind.owners:
                own = part.coordinates or tuple(f"{role}_{part.name}" for role in kind.roles)
                renamed = (
                    [f"{role}_{new(part.name)}" for role in kind.roles] if part.coordinates is None else map(new, own)
                )
                self.symbols |= dict(zip(own, renamed, strict=True))

    def word(self, word: str) -> str:
        """A name, its differential or its velocity under the new name."""
        for before, after in (("", ""), ("d", ""), ("", "dot")):
            if word.startswith(before) and word.endswith(after):
                name = word[len(before) : len(word) - len(after)]
                if name in self.symbols:
                    return before + self.symbols[name] + after
        name = word.replace("dot_", "_", 1)
        return f"{self.symbols[name]}dot" if name != word and name in self.symbols else word

    def text(self, text: str, kept: frozenset[str] = frozenset()) -> str:
        return WORD.sub(lambda match: match[0] if match[0] in kept else self.word(match[0]), text)

    def value(self, key: str, value: Any) -> Any:
        """What stands under a key of a scene, renamed."""
        if isinstance(value, list):
            return [self.value(key, item) for item in value]
        if isinstance(value, dict):
            return {k: self.value(k, v) for k, v in value.items()}
        if not isinstance(value, str) or key in PLAIN_KEYS:
            return value
        if key in OWNER_KEYS:
            return self.owners.get(value, value)
        return self.text(value, frozenset("xyz") if key in ("surface", "curve") else frozenset())

    def document(self, document: Document) -> Document:
        found: Document = {}
        for key, value in document.items():
            if key in ("particles", "bodies"):
                found[key] = [self._owner(owner) for owner in value]
            elif key == "coordinates":
                found[key] = [self.symbols[name] for name in value]
            elif key in ("parameters", "functions", "configuration"):
                found[key] = self._declared(value)
            elif key == "constraints":
                found[key] = [self.value("", constraint) for constraint in value]
            elif key == "forces":
                continue
            else:
                found[key] = value
        return found

    def _owner(self, owner: Document) -> Document:
        renamed: Document = self.value("", owner)
        own = {"coordinates": [self.symbols[q] for q in owner["coordinates"]]} if owner.get("coordinates") else {}
        return {**renamed, **own, "name": self.owners[owner["name"]]}

    def _declared(self, declared: Any) -> Any:
        if isinstance(declared, list):
            return [self.symbols[name] for name in declared]
        return {self.symbols[name]: self._meaning(value) for name, value in declared.items()}

    def _meaning(self, value: Any) -> Any:
        return value if value in ("real", "positive", "nonzero") else self.value("value", value)


def backwards(scene: Scene) -> Callable[[str], str]:
    """Names without meaning, in the opposite order of the alphabet."""
    numbers: dict[str, str] = {}
    return lambda name: numbers.setdefault(name, f"w{999 - len(numbers)}")


RENAMED, COPIED = dealt("names", VARIED, 2)


@on("other names", RENAMED)
def test_names_mean_nothing(path: Path) -> None:
    scene, report = scene_of(path), report_of(path)
    other = classified(Renaming(scene, backwards(scene)).document(document_of(path)))
    assert numbers(other) == numbers(report)
    assert all_labels(other) == all_labels(report)
    assert other.redundant == report.redundant
    assert other.conflicting == report.conflicting
    assert [(e.independent, e.circuit) for e in other.constraints] == [
        (e.independent, e.circuit) for e in report.constraints
    ]


# The order


BACKWARDS, TURNED = dealt("orders", VARIED, 2)


@on("backwards", BACKWARDS)
def test_the_order_of_constraints_means_nothing_to_numbers_and_labels(path: Path) -> None:
    document, report = document_of(path), report_of(path)
    other = classified({**document, "constraints": document["constraints"][::-1]})
    assert numbers(other) == numbers(report)
    assert all_labels(other) == all_labels(report)
    assert len(other.redundant or ()) == len(report.redundant or ())
    assert len(other.conflicting) == len(report.conflicting)


@on("turned", TURNED)
def test_the_order_of_coordinates_means_nothing(path: Path) -> None:
    document, report = document_of(path), report_of(path)
    turned = {key: document[key][::-1] for key in ("particles", "bodies", "coordinates") if document.get(key)}
    other = classified({**document, **turned})
    assert numbers(other) == numbers(report)
    assert all_labels(other) == all_labels(report)
    assert other.redundant == report.redundant


# Another clock


RATE = re.compile(r"\bd?t\b|\b\w+dot\b")
#: Keys under which a text may hold time.
TIMED = ("text", "surface", "curve", "length")
#: Of what is written so, time is no part that a word shows: derivatives of functions, accelerations, quotients of dt.
OF_TIME = re.compile(r"diff\(|'|/\s*dt|ddot")


def later(value: Any, key: str = "") -> Any:
    """What stands under a key of a scene, with 2 t + 3 for t."""
    if isinstance(value, list):
        return [later(item, key) for item in value]
    if isinstance(value, dict):
        return {k: later(v, k) for k, v in value.items()}
    return RATE.sub(clocked, value) if isinstance(value, str) and key in TIMED else value


def clocked(match: re.Match[str]) -> str:
    """Time, its differential or a velocity by the other clock."""
    return {"t": "(2 t + 3)", "dt": "(2 dt)"}.get(match[0], f"({match[0]}/2)")


def has_time(path: Path) -> bool:
    """Does a scene move in time, and is it drawn nowhere? A drawing is one at t = 0."""
    written = path.read_text(encoding="utf-8")
    if "\nbodies:" in written or "\nconfiguration:" in written or not RATE.search(written):
        return False
    scene = scene_of(path)
    texts = [str(value) for c in scene.constraints for key in TIMED if (value := getattr(c, key, None))]
    moves = any(RATE.search(text) for text in texts) and not any(OF_TIME.search(text) for text in texts)
    return moves and not scene.bodies and not scene.configuration and all(p.at is None for p in scene.particles)


TIMED_SCENES = [path for path in VARIED if has_time(path)]


@on("another clock", TIMED_SCENES)
def test_another_clock_changes_nothing(path: Path) -> None:
    document, report = document_of(path), report_of(path)
    other = classified({**document, "constraints": [later(c) for c in document["constraints"]]})
    assert numbers(other) == numbers(report)
    assert other.growth_vector == report.growth_vector
    assert all_labels(other) == all_labels(report)
    assert other.redundant == report.redundant
    assert other.conflicting == report.conflicting
    assert [(e.independent, e.circuit) for e in other.constraints] == [
        (e.independent, e.circuit) for e in report.constraints
    ]


# Twice the same constraint


def has_joints_somewhere(path: Path) -> bool:
    """Of a joint that is drawn nowhere, a second one is in general at another place."""
    return any(not name.startswith("_L") for name in lower(scene_of(path)).generic)


#: The first constraint of a scene is written again, or the last.
FIRST, LAST = dealt("again", VARIED, 2)


@pytest.mark.parametrize(
    ("path", "place"),
    [
        pytest.param(*case.values, place, marks=case.marks)
        for place, paths in ((0, FIRST), (-1, LAST))
        for case in few("once more", paths, 24)
    ],
    ids=lambda value: getattr(value, "stem", ""),
)
def test_a_constraint_written_again_is_redundant(path: Path, place: int) -> None:
    document, report = document_of(path), report_of(path)
    bilateral = [i for i, e in enumerate(report.constraints) if e.bilateral]
    if report.dof is None or not bilateral or has_joints_somewhere(path):
        return
    i = bilateral[place]
    again = {**document["constraints"][i], "name": "once_more"}
    other = classified({**document, "constraints": [*document["constraints"], again]})
    assert (other.dof, other.velocity_dof) == (report.dof, report.velocity_dof)
    assert other.redundant_equations == max(0, surplus(report) + report.constraints[i].equations)
    assert "once_more" in other.redundant
    assert len(other.redundant) == len(report.redundant) + 1
    assert other.constraints[-1].independent == 0
    assert {**all_labels(other), "once_more": None} == {**all_labels(report), "once_more": None}


# Two copies side by side


def beside(path: Path) -> Document:
    """The scene and a copy of it under other names."""
    scene, document = scene_of(path), document_of(path)
    copy = Renaming(scene, lambda name: f"{name}_too").document(document)
    copy["constraints"] = [{**c, "name": f"{c['name']}_too", **joints_too(c)} for c in copy["constraints"]]
    both = dict(document)
    for key, value in copy.items():
        if isinstance(value, list):
            both[key] = [*document[key], *value]
        elif isinstance(value, dict):
            both[key] = {**document[key], **value}
    return both


def joints_too(constraint: Document) -> Document:
    """The joints of the copy that a coupling of the copy couples, by the names that its text has."""
    joints = constraint.get("joints", [])
    named = joints if isinstance(joints, dict) else {name: name for name in joints}
    return {"joints": {letter: f"{name}_too" for letter, name in named.items()}} if named else {}


def doubled(value: Any) -> Any:
    return value if value is None or isinstance(value, bool) else 2 * value


def growth(report: Report) -> list[int] | None:
    """The growth vector without the direction of time, which is counted where time is written."""
    if report.growth_vector is None or report.velocity_dof is None:
        return None
    return [n - report.growth_vector[0] + report.velocity_dof for n in report.growth_vector]


@on("copied", COPIED)
def test_two_copies_have_twice_the_freedom(path: Path) -> None:
    report, other = report_of(path), classified(beside(path))
    if other.consistent is None and scene_of(path).functions:
        return  # two unknown functions of time may be 0 at no common time
    for key in NUMBERS:
        assert getattr(other, key) == doubled(getattr(report, key)), key
    assert nullities(other) == sorted(2 * nullities(report))
    dimensions = growth(report)
    assert growth(other) == (None if dimensions is None else [2 * n for n in dimensions])
    assert all_labels(other) == all_labels(report) | {f"{name}_too": said for name, said in all_labels(report).items()}
    if report.consistent:
        assert other.redundant == [*report.redundant, *(f"{name}_too" for name in report.redundant)]
    texts = {e.name: f"{e.reason} {e.integral}" for e in other.constraints}
    assert all(texts[e.name] == f"{e.reason} {e.integral}" for e in report.constraints)


# One report


@every_scene
def test_a_report_agrees_with_itself(path: Path) -> None:
    agrees_with_itself(report_of(path))


@on("the same", dealt("twice", VARIED, 3)[0])
def test_the_same_scene_has_the_same_report(path: Path) -> None:
    assert dofkit.classify(dofkit.load(path)) == report_of(path)


def test_the_renaming_renames() -> None:
    scene = dofkit.load(
        {
            "dimension": 2,
            "parameters": {"R": "positive"},
            "particles": ["A"],
            "bodies": ["b"],
            "coordinates": ["phi"],
            "constraints": [
                {"type": "equation", "text": "dx_A + xdot_A dt = R cos(phi) dphi"},
                {"type": "on", "members": ["A"], "curve": ["x = R"]},
                {"type": "link", "between": ["A", {"on": "b", "at": [1, 2]}], "length": "2 R"},
            ],
        }
    )
    document = scene.model_dump(mode="json", exclude_unset=True)
    renamed = Renaming(scene, lambda name: f"{name}9").document(document)
    assert renamed["parameters"] == {"R9": "positive"}
    assert renamed["particles"] == [{"name": "A9"}]
    equation, on, link = renamed["constraints"]
    assert equation["text"] == "dx_A9 + x_A9dot dt = R9 cos(phi9) dphi9"
    assert (on["members"], on["curve"]) == (["A9"], ["x = R9"])
    assert (link["between"], link["length"]) == (["A9", {"on": "b9", "at": [1, 2]}], "2 R9")


def test_every_kind_of_scene_is_there() -> None:
    """By what the scenes expect, which their reports are held against."""
    expected = [scene_of(path).expect or {} for path in SCENES]
    entries = [entry for known in expected for entry in known.get("constraints", {}).values()]
    assert {known["consistent"] for known in expected if "consistent" in known} == {True, False}
    assert {known["singular"] for known in expected if "singular" in known} == {True, False, None}
    assert {entry["form"] for entry in entries if "form" in entry} == {"finite", "pfaffian", "nonlinear", "inequality"}


def test_every_way_of_writing_is_tried_on_many_scenes() -> None:
    assert min(map(len, (RENAMED, COPIED, BACKWARDS, TURNED, FIRST, LAST))) > 150
    tried = Counter(parameters.values[1] for parameters in MULTIPLIED)
    assert tried.keys() == set(FACTORS)
    assert min(tried.values()) > 60
