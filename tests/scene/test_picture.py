"""The picture of a scene: what is read, what is refused and where, and that no answer depends on it."""

from __future__ import annotations

from typing import Any

import pytest
from jsonschema import Draft202012Validator

import dofkit
from dofkit.base.errors import SceneError
from dofkit.base.yaml_events import compose
from dofkit.scene.names import vocabulary_of
from dofkit.scene.picture import picture_of, shape_kinds
from dofkit.scene.schema import scene_schema

HEAD = "coordinates: [x, y, theta, phi, x1, x2]\nparameters: {R: positive, l: positive}\npicture:\n"
VALID = Draft202012Validator(scene_schema())


@pytest.mark.parametrize("kind", shape_kinds())
def test_the_example_of_each_shape_is_read(kind: str) -> None:
    text = f"{HEAD}- {shape_kinds()[kind].example}\n"
    scene = dofkit.loads(text)
    faults: list[Any] = []
    picture = picture_of(scene, vocabulary_of(scene), faults)
    assert [shape.kind for shape in picture.shapes] == [kind]
    assert not faults
    assert dofkit.load(scene.model_dump(mode="json")) == scene
    assert VALID.is_valid(compose(text).value)


@pytest.mark.parametrize(
    ("entry", "place", "message"),
    [
        ("{dics: coin, at: [x, 0]}", (4, 4), "did you mean 'disc'?"),
        ("{disc: coin, at: [x, 0]}", (4, 3), "a disc needs 'radius'"),
        ("{disc: c, at: [x, 0], radius: R, trun: 3}", (4, 36), "did you mean 'turn'?"),
        ("{rod: l, from: [0, 0], to: [l sin(thta), 0]}", (4, 37), "`thta` is not declared (did you mean `theta`?)"),
        ("{ball: m, at: [x, 0], radius: xdot}", (4, 33), "the velocity of x cannot stand here"),
        ("{curve: c, at: [u, v], range: {u: [0, theta]}}", (4, 22), "`v` is not declared"),
        ("{rod: l, from: [0, 0], to: [x, y, R]}", (4, 30), "a place has 2 components in this picture, not 3"),
        ("{point: P, at: [atan2(y, x), 0]}", (4, 18), "a comma ends an entry of a place"),
        ("{point: P, at: [x]}", (4, 18), "a place has 2 or 3 components, not 1"),
        ("{at: [x, 0]}", (4, 3), "a shape begins with its kind"),
        ("{point: q, disc: q}", (4, 20), "one entry is a point and a disc"),
        ("disc", (4, 3), "a shape is a mapping"),
    ],
)
def test_a_fault_is_reported_with_its_place(entry: str, place: tuple[int, int], message: str) -> None:
    with pytest.raises(SceneError) as caught:
        dofkit.loads(f"{HEAD}- {entry}\n")
    fault = caught.value.faults[0]
    assert (fault.line, fault.column) == place
    assert message in str(caught.value)


def test_all_faults_are_told_at_once() -> None:
    entries = "- {dics: c, at: [x, 0]}\n- {point: P, at: [q, 0]}\nconstraints: [x = z]\n"
    with pytest.raises(SceneError) as caught:
        dofkit.loads(HEAD + entries)
    assert [fault.line for fault in caught.value.faults] == [4, 5, 6]


def test_what_is_hidden_needs_no_place() -> None:
    scene = dofkit.loads(f"{HEAD}- {{point: c1, show: false}}\n")
    assert picture_of(scene, vocabulary_of(scene), []).taken == {"c1"}


@pytest.mark.parametrize(
    ("scene", "entry"),
    [
        ("disc-rolling-on-plane", {"disc": "coin", "at": ["x", "y", "R"], "heading": "theta", "radius": "R"}),
        ("free-rigid-body-3d", {"point": "P", "at": ["cos(phi_B)", "theta_B", 0]}),
    ],
)
def test_no_answer_depends_on_a_picture(scene: str, entry: dict[str, Any]) -> None:
    plain = dofkit.load(scene).model_copy(update={"picture": ()})
    body = plain.bodies[0].name if plain.bodies else ""
    entry = {key: [str(e).replace("_B", f"_{body}") for e in v] if key == "at" else v for key, v in entry.items()}
    with_picture = dofkit.load({**plain.model_dump(mode="json"), "picture": [entry]})
    assert dofkit.classify(with_picture) == dofkit.classify(plain)
