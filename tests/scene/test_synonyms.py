"""Words that people use: a scene in them is the scene in the standard words, and hints show lines that work."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.base.errors import Fault, SceneError
from dofkit.interface.explanations import explanations_of
from dofkit.scene.constraints import TYPES
from dofkit.scene.hints import lines, section_lines
from dofkit.scene.synonyms import standard_words, synonyms

PLANE = {"name": "s", "dimension": 2}
SPACE = {"name": "s", "bodies": ["a", "b"]}
AXES = {"type": "universal", "between": ["a", "b"], "at": [0, 0, 0]}

#: What may be written, and the same in standard words.
PAIRS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "hinge": (
        {**SPACE, "constraints": [{"type": "hinge", "between": ["a", "b"], "at": [0, 0, 0], "axis": "z"}]},
        {**SPACE, "constraints": [{"type": "revolute", "between": ["a", "b"], "at": [0, 0, 0], "axis": [0, 0, 1]}]},
    ),
    "pin": (
        {**PLANE, "bodies": ["a"], "constraints": [{"type": "pin", "between": ["ground", "a"], "at": [0, 0]}]},
        {**PLANE, "bodies": ["a"], "constraints": [{"type": "revolute", "between": ["ground", "a"], "at": [0, 0]}]},
    ),
    "slider": (
        {**PLANE, "bodies": ["a"], "constraints": [{"type": "slider", "between": ["ground", "a"], "direction": "-y"}]},
        {**PLANE, "bodies": ["a"], "constraints": [{"type": "prismatic", "between": ["ground", "a"], "axis": [0, -1]}]},
    ),
    "ball": (
        {**SPACE, "constraints": [{"type": "ball", "between": ["a", "b"], "at": [0, 0, 0]}]},
        {**SPACE, "constraints": [{"type": "spherical", "between": ["a", "b"], "at": [0, 0, 0]}]},
    ),
    "rod": (
        {**PLANE, "particles": ["A", "B"], "constraints": [{"type": "rod", "between": ["A", "B"], "distance": 2}]},
        {**PLANE, "particles": ["A", "B"], "constraints": [{"type": "link", "between": ["A", "B"], "length": 2}]},
    ),
    "distance": (
        {**PLANE, "particles": ["A", "B"], "constraints": [{"type": "distance", "between": ["A", "B"]}]},
        {**PLANE, "particles": ["A", "B"], "constraints": [{"type": "link", "between": ["A", "B"]}]},
    ),
    "string": (
        {**PLANE, "particles": ["A", "B"], "constraints": [{"type": "string", "between": ["A", [0, 0], "B"]}]},
        {**PLANE, "particles": ["A", "B"], "constraints": [{"type": "string", "along": ["A", [0, 0], "B"]}]},
    ),
    "axes": (
        {**SPACE, "constraints": [{**AXES, "axes": ["x", "y"]}]},
        {**SPACE, "constraints": [{**AXES, "axes": [[1, 0, 0], [0, 1, 0]]}]},
    ),
    "joints beside constraints, in the order of the file": (
        {"joints": [{"type": "ball", "between": ["a", "b"]}], **SPACE, "constraints": ["x_a = 0"]},
        {**SPACE, "constraints": [{"type": "spherical", "between": ["a", "b"]}, "x_a = 0"]},
    ),
    "names in LaTeX": (
        {**PLANE, "coordinates": [r"\theta", "$s$", "\theta_{1}"], "parameters": {r"\omega_0": 2, "x_{A}": 1}},
        {**PLANE, "coordinates": ["theta", "s", "theta_1"], "parameters": {"omega_0": 2, "x_A": 1}},
    ),
    "a text without a type": (
        {"name": "s", "coordinates": ["x"], "constraints": [{"name": "spin", "text": "x = 1"}]},
        {"name": "s", "coordinates": ["x"], "constraints": [{"name": "spin", "type": "equation", "text": "x = 1"}]},
    ),
    "subscripts": (
        {"name": "s", "coordinates": ["x₁"], "parameters": {"l₁₂": 2}, "configuration": {"x₁": 2}},
        {"name": "s", "coordinates": ["x_1"], "parameters": {"l_12": 2}, "configuration": {"x_1": 2}},
    ),
    "the direction of a force": (
        {**PLANE, "particles": ["A"], "forces": [{"type": "gravity", "acceleration": 9, "direction": "-y"}]},
        {**PLANE, "particles": ["A"], "forces": [{"type": "gravity", "acceleration": 9, "direction": [0, -1]}]},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", PAIRS)
def test_a_scene_in_other_words_is_the_scene(name: str, tmp_path: Path) -> None:
    written, standard = PAIRS[name]
    before = json.dumps(written)
    scene, meant = dofkit.load(written), dofkit.load(standard)
    assert scene == meant
    assert json.dumps(written) == before
    one, other = (dofkit.classify(s, certificate=True) for s in (scene, meant))
    assert one == other
    path = tmp_path / "s.json"
    path.write_text(before, encoding="utf-8")
    for given in (written, path, standard):
        verification = dofkit.verify(given, one.certificate or {})
        assert verification.claims > 0
        assert verification.verified == verification.claims


@pytest.mark.parametrize("name", [n for n in PAIRS if n != "subscripts"])
def test_standard_words_stay_as_they_are(name: str) -> None:
    standard = PAIRS[name][1]
    words = standard_words(standard)
    assert words.value == standard
    assert words.places == {}


def test_degrees_and_subscripts_are_checked_again_in_standard_texts() -> None:
    scene = {"coordinates": ["x₁", "y₁"], "constraints": ["x₁² + y₁² = 4", "y₁ = 2 sin 30°", "x₁ = 4 cos(30 deg) y₁/2"]}
    report = dofkit.classify(scene, certificate=True)
    assert report.dof == 0
    assert report.constraints[1].text == "y₁ = 2 sin 30°"
    verification = dofkit.verify(scene, report.certificate or {})
    assert verification.claims > 0
    assert verification.verified == verification.claims


def test_a_parameter_may_be_called_deg() -> None:
    scene = dofkit.load({"coordinates": ["x"], "parameters": ["deg"], "constraints": ["x = 30 deg"]})
    report = dofkit.classify(scene, certificate=True)
    assert report.consistent
    assert dofkit.verify(scene, report.certificate or {}).failed == []


def faults(text: str) -> tuple[Fault, ...]:
    with pytest.raises(SceneError) as caught:
        dofkit.loads(text)
    return caught.value.faults


def test_faults_stand_where_the_words_were_written() -> None:
    text = "bodies: [a]\nconstraints: [x_a = 0]\njoints:\n"
    text += "- {type: hinge, between: [ground, b], at: [0, 0, 0], direction: [1, 0]}\n"
    told = {(f.line, f.column, f.where) for f in faults(text)}
    assert told == {(4, 35, ("joints", 0, "between", 1)), (4, 65, ("joints", 0, "direction"))}
    fault = faults("coordinates: [x₁]\nparameters: {l₀: psitive}\nconfiguration: {y₁: 1}\n")
    assert [(f.line, f.where) for f in fault] == [(2, ("parameters", "l₀")), (3, ("configuration", "y₁"))]


#: What is written wrongly ({A}: of a body a, {B}: and a particle A) -> what its hint shows.
SHOWN: dict[str, tuple[str, str]] = {
    "a word that is understood": ("{A}[{type: pivot, between: [ground, a]}]", "{type: revolute,"),
    "a misspelt other word": ("{A}[{type: hing, between: [ground, a]}]", "'revolute'? for example `{type: "),
    "a pinned point": ("particles: [A]\nconstraints: [{type: pin, point: A}]", "{type: fixed, point: A}"),
    "a slider that is a point": ("particles: [A]\nconstraints: [{type: slider, point: A, body: a}]", "{type: slot,"),
    "a spring": ("particles: [A, B]\nconstraints: [{type: spring, between: [A, B]}]", "forces: [{type: spring,"),
    "no type": ("{A}[{name: c, between: [a, b]}]", "the types with these keys are link, revolute,"),
    "a misspelt text and no type": ('coordinates: [x, y]\nconstraints: [{txt: "x dy = 0"}]', "are equation"),
    "an unknown type and a misspelt key": ("{B}[{type: foo, betwen: [A, A]}]", "the types with these keys are link"),
    "members of a link": ("particles: [A, B]\nconstraints: [{type: link, members: [A, B]}]", "did you mean 'between'?"),
    "bodies of a joint": ("bodies: [a, b]\nconstraints: [{type: weld, bodies: [a, b]}]", "did you mean 'between'?"),
    "members held": ("particles: [A]\nconstraints: [{type: fixed, members: [A]}]", "`{type: fixed, point: A}`"),
    "a key in capitals": ("particles: [A, B]\nconstraints: [{Type: link, between: [A, B]}]", "write `type` in place"),
    "a type that is a list": (
        "particles: [A, B]\nconstraints: [{type: [link], length: 2, between: [A, B]}]",
        "did you mean 'link'?",
    ),
    "a mass that is no unit": ("coordinates: [x]\nenergies: {kinetic: 1/2 m xdot^2}", "`parameters: [m]` for a"),
    "an undeclared name": ("coordinates: [x]\nconstraints: [Q = x]", "`coordinates: [Q]`, or `parameters: [Q]`"),
    "a unit": ("parameters: {l: 50 cm}", "`50`"),
    "a bar": ("particles: [A, B]\nconstraints:\n- |A - B| = 3\n", '- "|x - y| = 3"'),
    "a distance": (
        'particles: [A, B]\nconstraints: ["|A - B| = 3"]', "`{type: link, between: [A, B], length: 3}`",
    ),
    "time in a place": ("{A}[{type: ball, between: [ground, a], at: [t, 0, 0]}]", "`x_A = cos(t)`"),
    "a negative length": ("particles: [A, B]\nconstraints: [{type: link, between: [A, B], length: -2}]", "`length: 2`"),
    "one end": ("{A}[{type: hinge, between: [a], at: [0, 0, 0]}]", "between: [ground, crank]"),
    "one end of a link": ("particles: [A]\nconstraints: [{type: link, between: [A]}]", "between: [A, B]"),
    "a place in space": ("dimension: 2\n{A}[{type: pin, between: [ground, a], at: [0, 1, 0]}]", "`at: [0, 1]`"),
    "a place in the plane": ("{A}[{type: ball, between: [ground, a], at: [0, 1]}]", "`at: [0, 1, 0]`"),
    "an axis that is no direction": (
        "{A}[{type: hinge, between: [ground, a], at: [0, 0, 0], axis: w}]", "axis: [0, 0, 1]",
    ),
    "an axis out of the plane": (
        "dimension: 2\n{A}[{type: slider, between: [ground, a], axis: z}]",
        "a direction is x or y, or its components; for example `{type: prismatic, ",
    ),
    "no axis": ("{A}[{type: hinge, between: [ground, a], at: [0, 0, 0]}]", "`axis: [0, 0, 1]`"),
    "a body for a point": ("{B}[{type: link, between: [a, A]}]", "`{on: a, at: [0, 0, 0]}`"),
    "a particle for a body": ("{B}[{type: weld, between: [a, A]}]", "`{type: fixed, point: A}`"),
    "no list": ("coordinates: x", "`coordinates: [x, y]`"),
    "a misspelt key": ("configuraton: {x: 1}", "`configuration: {theta: 0}`"),
    "no radius": ("{A}[{type: roll, body: a}]", "`{type: roll, body: wheel, radius: 1}`"),
    "two words for one thing": (
        "{A}[{type: hinge, between: [ground, a], at: [0, 0, 0], axis: x, direction: y}]",
        "`direction` is a synonym of `axis`",
    ),
    "a joint of space in the plane": (
        "dimension: 2\n{A}[{type: ball, between: [ground, a], at: [0, 0]}]", "in the plane use revolute,",
    ),
    "a length that contradicts": (
        "dimension: 1\nparticles: [{name: A, at: [0]}, {name: B, at: [5]}]\n"
        "constraints: [{type: link, between: [A, B], length: 6}]", "`length: 5`",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SHOWN)
def test_a_hint_shows_one_line_that_would_work(name: str) -> None:
    text, line = SHOWN[name]
    text = text.replace("{A}", "bodies: [a]\nconstraints: ").replace(
        "{B}", "bodies: [a]\nparticles: [A]\nconstraints: "
    )
    hints = [fault.hint or "" for fault in faults(text)]
    assert any(line in hint for hint in hints), hints


def test_every_section_is_explained() -> None:
    assert section_lines().keys() < set(dofkit.Scene.model_fields)
    for word in (*section_lines(), *TYPES):
        assert explanations_of(word)


def test_no_other_word_for_a_type_is_a_type() -> None:
    assert synonyms()["hinge"] == "revolute"
    assert not synonyms().keys() & TYPES.keys()


@pytest.mark.parametrize("kind", TYPES)
def test_the_example_of_a_type_is_a_scene(kind: str) -> None:
    for d in TYPES[kind].dimensions:
        scene = dofkit.loads(
            f"dimension: {d}\nbodies: [crank, rod, wheel]\nparticles: [A, B, C]\ncoordinates: [x, y]\n"
            "constraints:\n" + "".join(f"- {line}\n" for line in TYPES[kind].example(d))
        )
        assert scene.constraints[0].kind() == kind


def test_the_line_of_a_key_is_a_scene() -> None:
    for key in ("coordinates", "particles", "bodies", "parameters", "functions", "dimension", "tolerance", "expect"):
        assert dofkit.loads(lines()[key]).name == "scene"
    assert dofkit.loads(f"coordinates: [theta]\n{lines()['configuration']}").configuration == {"theta": 0}
