"""What a scene expects, held against its report; and scenes without some constraints."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.base.errors import ArgumentError
from dofkit.scene.expectation import unmet
from dofkit.scene.scene import without

SCENE: dict[str, Any] = {
    "coordinates": ["x", "y", "z"],
    "parameters": {"v": "positive"},
    "constraints": [{"name": "form", "type": "equation", "text": "x dy + y dx = 0"}, "z = 1", "2 z = 2"],
}
#: By hand: x y = C and z = 1 leave one coordinate; the third says what the second does.
RIGHT: dict[str, Any] = {
    "dof": 1,
    "redundant": ["c3"],
    "redundancies": [{"nullity": 1, "members": ["c2", "c3"]}],
    "count": {"naive_dof": 1, "coordinates": 3},
    "forces": [],
    "constraints": {"form": {"holonomic": True, "integral": "x*y = C"}, "c3": {"circuit": ["c2"]}},
}


def missed(expect: dict[str, Any]) -> list[str]:
    scene = dofkit.load({**SCENE, "expect": expect})
    return unmet(scene, dofkit.classify(scene).model_dump(mode="json"))


def test_what_is_right_is_met() -> None:
    assert missed(RIGHT) == []
    assert missed({"constraints": {"form": {"integral": "log(x) + log(y) = C"}}}) == []


@pytest.mark.parametrize(
    ("expect", "line"),
    [
        ({"dof": 2}, "dof: 2 expected, but the report has 1"),
        ({"dof": None}, "dof: None expected, but the report has 1"),
        ({"redundant": []}, "redundant: [] expected, but the report has ['c3']"),
        ({"redundancies": [{"nullity": 2}]}, "redundancies: [{'nullity': 2}] expected, "),
        ({"redundancies": [{"nullity": 1, "members": ["c2", "form"]}]}, "redundancies: [{'nullity': 1, "),
        ({"count": {"naive_dof": 2}}, "count: {'naive_dof': 2} expected, "),
        ({"count": 7}, "count: 7 expected, "),
        ({"forces": ["f1"]}, "forces: ['f1'] expected, but the report has []"),
        (
            {"constraints": {"form": {"integral": "x + y = C"}}},
            "form.integral: x + y = C expected, but the report has x*y = C",
        ),
        (
            {"constraints": {"form": {"integral": "x*y*z = C"}}},
            "form.integral: x*y*z = C expected, but the report has x*y = C",
        ),
        ({"constraints": {"form": {"integral": "q ="}}}, "form.integral: q = expected, but the report has x*y = C"),
        ({"constraints": {"other": {"holonomic": True}}}, "other.name: other expected, but the report has None"),
        ({"constraints": 3}, "constraints: 3 expected, "),
    ],
)
def test_what_is_otherwise_is_named(expect: dict[str, Any], line: str) -> None:
    (told,) = missed(expect)
    assert told.startswith(line)


def test_without_constraints_the_others_keep_their_names() -> None:
    scene = dofkit.load({**SCENE, "expect": RIGHT})
    left = without(scene, ["form", "c2"])
    assert [c.name for c in left.constraints] == ["c3"]
    assert left.expect == {}
    assert dofkit.classify(left).dof == 2
    with pytest.raises(ArgumentError, match=r"there is no constraint 'fom' \(did you mean 'form'\?\)"):
        without(scene, ["fom"])
