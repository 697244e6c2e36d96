"""Claims near points at which a relation is stationary: isolated zeros, families; false ones must fail."""

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
ALONE = {"rule": "isolated", "minor": "m", "speeds": {"y": "1"}, "zero": "c2", "order": 2}
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
        ({"speeds": {"x": "1"}}, False),
        ({"speeds": {"z": "1"}}, False),
        ({"speeds": {}}, False),
        ({"speeds": {"y": "0"}}, False),
        ({"speeds": {"y": "y"}}, False),
        ({"speeds": {"y": "-3/2"}}, True),
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
            claim = {**DOF, "most": {**ALONE, "speeds": {"x": "1"}, "order": order}}
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
    assert "not shown to be isolated" in faults(scene, [DOF], **parts)["/dof"]


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
    alone = {**ALONE, "zero": "c3"}
    still = {**STILL, "fields": ["turn"], "rows": ["c1", "c2", "c3"], "words": [["turn"]], "columns": ["v"]}
    claim = {**DOF, "value": 1, "most": alone, "least": still}
    assert faults(scene, [claim], **parts) == {}
    assert faults(scene, [claim], **parts) == {}
    assert not accepted(scene, [{**claim, "value": 0}], **parts)
    assert not accepted(scene, [{**claim, "least": {**still, "fields": ["half"], "words": [["half"]]}}], **parts)


#: The axis of y, and that of x: along (x, y) = (s, s) the second relation grows.
AXES = {"rule": "isolated", "minor": "m", "zero": "c2", "speeds": {"x": "1", "y": "1"}, "order": 2}
ON_Y = [{"id": "a", "by": "assumed", "function": "x"}]
ALONG = {"rule": "family", "minor": {"at": "P", "rows": ["a", "c1"], "columns": ["x", "z"]}}


def _crossing(second: str, *more: str) -> dict[str, Any]:
    return {"coordinates": ["x", "y", "z"], "constraints": ["z = 0", second, *more], "parameters": ["k"]}


def _follows(of: str, **c: str) -> dict[str, Any]:
    return {"id": f"{of} follows", "by": "implied", "of": of, "c": c}


CROSSED: dict[str, Any] = {
    "points": [{"id": "P", "values": {"x": "0", "y": "0", "z": "0", "t": "0", "k": "0"}}],
    "minors": [{"id": "m", "at": "P", "rows": ["c1"], "columns": ["z"]}],
    "relations": [*ON_Y, _follows("c2", a="y", c1="z")],
}
ONE = {**DOF, "value": 1, "most": AXES, "least": ALONG}


def test_a_family_at_a_crossing() -> None:
    scene = _crossing("x*y + z^2 = 0")
    assert faults(scene, [ONE], **CROSSED) == {}
    for value in (0, 2):
        assert not accepted(scene, [{**ONE, "value": value}], **CROSSED)
    assert not accepted(scene, [{**ONE, "most": {"rule": "minor", "minor": "m"}}], **CROSSED)
    for change in ({"speeds": {"x": "1"}}, {"speeds": {"y": "1"}}, {"order": 3}, {"zero": "c1"}):
        assert not accepted(scene, [{**ONE, "most": {**AXES, **change}}], **CROSSED), change


@pytest.mark.parametrize(
    ("second", "relations"),
    [
        ("x*y + z^2 = 0", []),
        ("x*y + z^2 = 0", ON_Y),
        ("x*y + z^2 = 0", [_follows("c2", c1="z")]),
        ("x*y + z^2 = 0", [{"id": "a", "by": "assumed", "function": "x + xdot"}, _follows("c2", a="y", c1="z")]),
        ("x*y + z^2 = 0", [{"id": "a", "by": "assumed", "function": "x + 1"}, _follows("c2", a="y", c1="z")]),
        ("x*y + z^2 = 0", [{"id": "a", "by": "assumed", "function": "x^2"}, _follows("c2", a="y/x", c1="z")]),
        # x = k y is no motion of x^2 = y^2 but for k = 1 or k = -1, and of x y = 0 but for k = 0
        ("x*y + z^2 = 0", [{"id": "a", "by": "assumed", "function": "x - k*y"}, _follows("c2", a="y", c1="z")]),
        ("x*y = k", [*ON_Y, _follows("c2", a="y")]),
        ("x^2 + y^2 = z", [*ON_Y, _follows("c2", a="x")]),
    ],
)
def test_a_broken_family_is_refused(second: str, relations: list[dict[str, Any]]) -> None:
    assert not accepted(_crossing(second), [ONE], **{**CROSSED, "relations": relations})


def test_a_family_meets_every_relation_and_shows_nothing_else() -> None:
    # with x = y there is only the origin, and with y = k that is not 0 no point
    for more in ("x = y", "y = k", "y = t", "dy = 0"):
        assert not accepted(_crossing("x*y + z^2 = 0", more), [ONE], **CROSSED), more
    scene = _crossing("x*y + z^2 = 0")
    shown = {"path": "/constraints/c1/holonomic", "value": True, "rule": "finite"}
    assert accepted(scene, [shown], **CROSSED)
    never = {"path": "/consistent", "value": False, "rule": "nullstellensatz", "number": "1", "c": {"a": "1"}}
    steps = [{"id": "a", "by": "assumed", "function": "-1"}]
    assert not accepted(scene, [never], **{**CROSSED, "relations": steps})
    rows = {"at": "P", "rows": ["a", "c1"], "columns": ["x", "z"]}
    for claim in (
        {**DOF, "value": 1, "rule": "regular", "minor": rows},
        {**ONE, "most": {"rule": "minor", "minor": rows}},
        {"path": "/consistent", "value": True, "rule": "regular", "minor": rows},
        {**ONE, "least": {"rule": "regular", "minor": rows}},
    ):
        assert not accepted(scene, [claim], **CROSSED), claim


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
