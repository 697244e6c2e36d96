"""Claims near points at which a relation is stationary: isolated zeros, crossings; false ones must fail."""

from __future__ import annotations

from typing import Any

import pytest
from checker.certified import accepted, faults

#: Two circles that touch: the second relation has the second derivative 2*(1 + 1) along the first circle.
TOUCHING: dict[str, Any] = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1", "(x - 2)^2 + y^2 = 1"]}
AT_TOUCH = {
    "points": [{"id": "P", "values": {"x": "1", "y": "0"}}],
    "minors": [
        {"id": "m", "at": "P", "rows": ["c1"], "columns": ["x"]},
        {"id": "n", "at": "P", "rows": ["c2"], "columns": ["x"]},
    ],
    "fields": [{"id": "turn", "components": {"x": "-y", "y": "x"}}],
}
ALONE = {"rule": "isolated", "minor": "m", "fields": [], "pins": [], "free": "y", "zero": "c2", "order": 2}
STILL = {"rule": "span", "at": "P", "fields": [], "rows": ["c1", "c2"], "words": [], "columns": []}
DOF = {"path": "/dof", "value": 0, "rule": "squeeze", "about": "component", "most": ALONE, "least": STILL}


@pytest.mark.parametrize(
    ("change", "good"),
    [
        ({}, True),
        ({"order": 1}, False),
        ({"order": 3}, False),
        ({"order": 0}, False),
        ({"order": 99}, False),
        ({"order": True}, False),
        ({"zero": "c1"}, False),
        ({"zero": "c9"}, False),
        ({"free": "x"}, False),
        ({"free": "z"}, False),
        ({"pins": ["y"]}, False),
        ({"fields": ["turn"], "pins": ["y"]}, False),
        ({"minor": "n", "zero": "c1"}, True),
    ],
)
def test_an_isolated_zero(change: dict[str, Any], good: bool) -> None:
    assert accepted(TOUCHING, [{**DOF, "most": {**ALONE, **change}}], **AT_TOUCH) is good


def test_an_isolated_zero_has_no_other_dof() -> None:
    assert not accepted(TOUCHING, [{**DOF, "value": 1}], **AT_TOUCH)
    same = {**TOUCHING, "constraints": ["x^2 + y^2 = 1", "3*x^2 + 3*y^2 = 3"]}
    for order in range(1, 9):
        assert not accepted(same, [{**DOF, "most": {**ALONE, "order": order}}], **AT_TOUCH)
    moving = {**TOUCHING, "constraints": ["x^2 + y^2 = 1", "(x - 2)^2 + y^2 = 1 + t"]}
    timed = {**AT_TOUCH, "points": [{"id": "P", "values": {"x": "1", "y": "0", "t": "0"}}]}
    assert not accepted(moving, [DOF], **timed)
    free = {**TOUCHING, "coordinates": ["x", "y", "z"]}
    farther = {**AT_TOUCH, "points": [{"id": "P", "values": {"x": "1", "y": "0", "z": "0"}}]}
    assert not accepted(free, [DOF], **farther)


def test_the_order_is_that_of_the_touch() -> None:
    """y = x^k and y = 0 touch to order k."""
    for k in (2, 3, 4):
        scene = {"coordinates": ["x", "y"], "constraints": ["y = 0", f"y = x^{k}"]}
        parts = {
            "points": [{"id": "P", "values": {"x": "0", "y": "0"}}],
            "minors": [{"id": "m", "at": "P", "rows": ["c1"], "columns": ["y"]}],
        }
        for order in (2, 3, 4):
            claim = {**DOF, "most": {**ALONE, "free": "x", "order": order}}
            assert accepted(scene, [claim], **parts) is (order == k)


def test_a_parameter_does_not_pass_for_a_derivative() -> None:
    scene = {
        "coordinates": ["x", "y"],
        "parameters": {"ydotdot": "real"},
        "constraints": ["x = 0", "x + 0*ydotdot = 0"],
    }
    parts = {
        "points": [{"id": "P", "values": {"x": "0", "y": "0", "ydotdot": "1"}}],
        "minors": [{"id": "m", "at": "P", "rows": ["c1"], "columns": ["x"]}],
    }
    assert "a parameter has the name" in faults(scene, [DOF], **parts)["/dof"]


def test_an_orbit_is_all_where_fields_keep_the_set() -> None:
    """A circle and a line through the centre turn with each other: only the turn is left."""
    scene = {
        "coordinates": ["x", "y", "u", "v"],
        "constraints": ["x^2 + y^2 = 1", "u^2 + v^2 = 4", "(x - u)^2 + (y - v)^2 = 1"],
    }
    parts = {
        "points": [{"id": "P", "values": {"x": "1", "y": "0", "u": "2", "v": "0"}}],
        "minors": [{"id": "m", "at": "P", "rows": ["c1", "c2"], "columns": ["x", "u"]}],
        "fields": [
            {"id": "turn", "components": {"x": "-y", "y": "x", "u": "-v", "v": "u"}},
            {"id": "half", "components": {"x": "-y", "y": "x"}},
        ],
    }
    alone = {**ALONE, "fields": ["turn"], "pins": ["v"], "free": "y", "zero": "c3"}
    still = {**STILL, "fields": ["turn"], "rows": ["c1", "c2", "c3"], "words": [["turn"]], "columns": ["v"]}
    claim = {**DOF, "value": 1, "most": alone, "least": still}
    assert faults(scene, [claim], **parts) == {}
    chart = {"path": "/generalized_coordinates", "value": ["v"], **alone}
    assert faults(scene, [claim, chart], **parts) == {}
    assert not accepted(scene, [claim, {**chart, "value": ["y"]}], **parts)
    assert not accepted(scene, [chart], **parts)
    assert not accepted(scene, [{**claim, "most": {**alone, "fields": ["half"]}}], **parts)
    assert not accepted(scene, [{**claim, "most": {**alone, "pins": ["u"]}}], **parts)
    assert not accepted(scene, [{**claim, "value": 0, "most": {**alone, "fields": [], "pins": []}}], **parts)


CROSS = {"rule": "crossing", "minor": "m", "zero": "c2", "speeds": [{"x": "1", "y": "1"}, {"x": "1", "y": "-1"}]}


@pytest.mark.parametrize(
    ("second", "change", "good"),
    [
        ("x*y + z^2 = 0", {}, True),
        ("x*y = z", {}, True),
        ("x*y + z^2 = 0", {"speeds": [{"x": "1"}, {"x": "1", "y": "-1"}]}, False),
        ("x*y + z^2 = 0", {"speeds": [{"x": "1", "y": "-1"}, {"x": "1", "y": "1"}]}, False),
        ("x*y + z^2 = 0", {"speeds": [{"x": "1", "y": "1"}]}, False),
        ("x*y + z^2 = 0", {"speeds": [{"x": "1", "y": "1"}, {"z": "1"}]}, False),
        ("x^2 + y^2 = z", {}, False),
        ("x^2 = z", {}, False),
        ("z = 0*x", {}, False),
        ("x*y = z*t", {}, False),
    ],
)
def test_a_crossing(second: str, change: dict[str, Any], good: bool) -> None:
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["z = 0", second]}
    parts = {
        "points": [{"id": "P", "values": {"x": "0", "y": "0", "z": "0", "t": "0"}}],
        "minors": [{"id": "m", "at": "P", "rows": ["c1"], "columns": ["z"]}],
    }
    way = {**CROSS, **change}
    assert accepted(scene, [{**DOF, "value": 1, "most": way, "least": way}], **parts) is good
    assert not accepted(scene, [{**DOF, "value": 2, "most": way, "least": way}], **parts)
    # a crossing is one less than its rows leave, whatever bounds from above: z = 0 = x y is no plane
    assert not accepted(scene, [{**DOF, "value": 2, "most": {"rule": "minor", "minor": "m"}, "least": way}], **parts)
    more = {**scene, "constraints": [*scene["constraints"], "x = y"]}
    assert not accepted(more, [{**DOF, "value": 1, "most": way, "least": way}], **parts)


def test_what_the_last_constraint_takes_away_and_that_all_are_needed() -> None:
    last = {"path": "/constraints/c2/independent", "value": 1, "rule": "independent", "minor": "m", "last": True}
    none = {"path": "/redundant", "value": [], "rule": "cofactors", "without": {"c1": "n", "c2": "m"}}
    assert faults(TOUCHING, [DOF, last, none], **AT_TOUCH) == {}
    assert not accepted(TOUCHING, [last], **AT_TOUCH)
    assert not accepted(TOUCHING, [none], **AT_TOUCH)
    for wrong in ({"value": 2}, {"value": 0}):
        assert not accepted(TOUCHING, [DOF, {**last, **wrong}], **AT_TOUCH)
    for without in ({"c1": "m", "c2": "m"}, {"c1": "n"}, {"c2": "m"}, {}):
        assert not accepted(TOUCHING, [DOF, {**none, "without": without}], **AT_TOUCH)
    assert not accepted(TOUCHING, [DOF, {**none, "value": ["c1"]}], **AT_TOUCH)
    spare = {**TOUCHING, "constraints": [*TOUCHING["constraints"], "y = 0"]}
    known = {**DOF, "least": {**STILL, "rows": ["c1", "c2", "c3"]}}
    assert accepted(spare, [known], **AT_TOUCH)
    assert not accepted(spare, [known, {**none, "without": {"c1": "n", "c2": "m", "c3": "m"}}], **AT_TOUCH)
    assert not accepted(spare, [known, last], **AT_TOUCH)
