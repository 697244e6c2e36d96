"""What can be met all at once, and what cannot: inequalities beside equations, of places and of velocities."""

from __future__ import annotations

from typing import Any

import pytest
from checker.certified import accepted, faults

AT = {"id": "P", "values": {"x": "1", "y": "0", "xdot": "0", "ydot": "1"}}
ROW = {"id": "m", "at": "P", "rows": ["c1"], "columns": ["x"]}


def scene(*constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": ["x", "y"], "constraints": list(constraints), **more}


def never(inequality: dict[str, Any], number: str = "0", **more: Any) -> dict[str, Any]:
    given = {"rule": "nullstellensatz", "number": number, "inequality": inequality, **more}
    return {"path": "/feasible", "value": False, **given}


#: (x - y)^2 > 0 where x = y, shown by (x - y)^2 - (x - y) (x - y) = 0.
APART = scene("x = y", "(x - y)^2 > 0")
REFUTED = never({"c2": [["1", "1"]]}, c={"c1": "-(x - y)"})


def test_what_holds_everywhere_leaves_nothing_for_its_opposite() -> None:
    assert faults(APART, [REFUTED]) == {}
    assert not accepted(APART, [{**REFUTED, "path": "/consistent"}])
    assert not accepted(APART, [{**REFUTED, "value": True}])


@pytest.mark.parametrize(
    "change",
    [
        {"inequality": {"c2": [["-1", "1"]]}, "c": {"c1": "x - y"}},
        {"inequality": {"c2": [["1", "x"]]}, "c": {"c1": "-x^2*(x - y)"}},
        {"inequality": {"c2": []}, "c": {}},
        {"inequality": {}, "c": {"c1": "0"}},
        {"inequality": {}, "c": {}},
        {"c": {"c1": "x - y"}},
        {"c": {"c1": "-(x - y)", "c2": "0"}},
        {"number": "-1"},
        {"number": "x"},
    ],
)
def test_a_broken_refutation_is_refused(change: dict[str, Any]) -> None:
    assert not accepted(APART, [{**REFUTED, **change}])


@pytest.mark.parametrize(
    ("text", "claim"),
    [
        # x = y is allowed where the inequality is not strict
        ("(x - y)^2 >= 0", REFUTED),
        # both signs of x - 1 are allowed
        ("x - 1 > 0", never({"c2": [["1", "1"]]}, c={"c1": "-1"})),
        # an inequality is no equation, which any factor may stand before
        ("x + 1 > 0", never({"c2": [["1", "1"]]}, c={"c2": "-1"})),
    ],
)
def test_what_is_feasible_is_not_refuted(text: str, claim: dict[str, Any]) -> None:
    assert not accepted(scene("x = y", text), [claim])


def test_two_inequalities_exclude_each_other() -> None:
    # (x - 1) + (-x) + 1 = 0
    walls = scene("x >= 1", "x <= 0")
    both = never({"c1": [["1", "1"]], "c2": [["1", "1"]]}, number="1")
    assert faults(walls, [both]) == {}
    assert not accepted(walls, [{**both, "path": "/consistent"}])
    assert not accepted(walls, [{**both, "number": "0"}])
    # at x = 0 both of these hold
    assert not accepted(scene("x >= 0", "x <= 0"), [{**both, "number": "0"}])
    strict = scene("x > 0", "x <= 0")
    assert accepted(strict, [{**both, "number": "0"}])
    assert not accepted(scene("x >= 0", "x < 1"), [{**both, "number": "0"}])
    only = {"inequality": {"c2": [["1", "1"]], "c1": [["1", "x"]]}, "number": "0"}
    assert not accepted(strict, [{**both, **only}])


def test_a_conflict_does_not_pass_for_what_is_not_feasible() -> None:
    conflict = {"path": "/conflicting", "value": ["c1", "c2"], "rule": "conflict", "refutation": REFUTED, "minimal": {}}
    assert not accepted(APART, [conflict])


def test_a_velocity_that_is_not_forbidden() -> None:
    # on the circle (0, 1) is a velocity at (1, 0), and ydot^2 > 0
    ring = scene("x^2 + y^2 = 1", "dy^2 > 0")
    claim = {"path": "/feasible", "value": True, "rule": "regular", "minor": "m"}
    assert faults(ring, [claim], points=[AT], minors=[ROW]) == {}
    for values in ({"xdot": "1"}, {"ydot": "0"}, {"x": "2"}):
        point = {**AT, "values": {**AT["values"], **values}}
        assert not accepted(ring, [claim], points=[point], minors=[ROW]), values
    bare = {**AT, "values": {"x": "1", "y": "0"}}
    assert not accepted(ring, [claim], points=[bare], minors=[ROW])
    assert not accepted(ring, [{**claim, "rule": "point", "at": "P"}], points=[AT], minors=[ROW])
    assert not accepted(scene("x^2 + y^2 = 1", "dx^2 > 0"), [claim], points=[AT], minors=[ROW])
    # the skate forbids the velocity
    skate = scene("x^2 + y^2 = 1", "dy^2 > 0", "x dy = y dx")
    rows = {**ROW, "rows": ["c1", "c3"], "columns": ["x", "y"]}
    assert not accepted(skate, [claim], points=[AT], minors=[rows])
    assert not accepted(skate, [claim], points=[AT], minors=[ROW])
