"""Claims about the whole set beside forms, and of graphs over parameters and time; false ones must fail."""

from __future__ import annotations

from typing import Any

import pytest
from checker.certified import accepted, faults

WHOLE = {"rule": "everywhere", "about": "everywhere"}


def _at(rows: list[str], columns: list[str], **values: str) -> dict[str, Any]:
    """The parts with one point and one minor there."""
    return {
        "points": [{"id": "P", "values": values}],
        "minors": [{"id": "m", "at": "P", "rows": rows, "columns": columns}],
    }


def _velocities(value: int, **told: Any) -> dict[str, Any]:
    return {**WHOLE, "path": "/velocity_dof", "value": value, **told}


CONTACT: dict[str, Any] = {"coordinates": ["x", "y", "z"], "constraints": ["zdot = y*xdot"]}
OF_CONTACT = _at(["c1"], ["z"], x="0", y="1", z="0") | {
    "fields": [{"id": "X", "components": {"x": "1", "z": "y"}}, {"id": "Y", "components": {"y": "1"}}]
}
REACHED = {
    **{"rule": "span", "at": "P", "fields": ["X", "Y"], "rows": ["c1"]},
    **{"words": [["X"], ["Y"], ["X", "Y"]], "columns": ["x", "y", "z"]},
}


@pytest.mark.parametrize(
    ("claim", "good"),
    [
        (_velocities(2, order=[["c1", "z"]]), True),
        (_velocities(2, order=[["c1", "z"]], minor="m"), True),
        (_velocities(2, blocks=["c1"], minor="m"), True),
        (_velocities(1, order=[["c1", "z"]]), False),
        (_velocities(3, order=[]), False),
        (_velocities(2, blocks=["c1"]), False),
        (_velocities(2, order=[["c1", "x"]], minor="m"), False),
        (_velocities(2, order=[["c1", "t"]], minor="m"), False),
        (_velocities(2, generic=[["c1", "y"]], minor="m"), False),
    ],
)
def test_velocities_of_one_form(claim: dict[str, Any], good: bool) -> None:
    assert accepted(CONTACT, [claim], **OF_CONTACT) is good


def test_what_brackets_reach_and_no_more_is_reached_everywhere() -> None:
    none = {"id": "0", "at": "P", "rows": [], "columns": []}
    parts = {**OF_CONTACT, "minors": [*OF_CONTACT["minors"], none]}
    most = {"rule": "minor", "minor": "0"}
    dof = {**WHOLE, "path": "/dof", "value": 3, "most": most, "least": REACHED}
    assert faults(CONTACT, [dof], **parts) == {}
    assert faults(CONTACT, [{**dof, "order": [["c1", "z"]]}], **parts) == {}
    assert not accepted(CONTACT, [{**dof, "value": 2}], **parts)
    fewer = {**REACHED, "words": [["X"], ["Y"]], "columns": ["x", "y"]}
    assert not accepted(CONTACT, [{**dof, "value": 2, "least": fewer}], **parts)
    assert not accepted(CONTACT, [{**dof, "most": {"rule": "minor", "minor": "m"}}], **parts)


def test_two_forms_that_vanish_together_may_leave_more_where_they_do() -> None:
    """On x = 0 the motions fill a plane, beside it only a line: neither is an order, nor are they one block."""
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["x*ydot = 0", "x*zdot = 0"]}
    parts = _at(["c1", "c2"], ["y", "z"], x="1", y="0", z="0")
    for told in ({"order": [["c1", "y"], ["c2", "z"]]}, {"blocks": ["c1", "c2"]}):
        assert not accepted(scene, [_velocities(1, minor="m", **told)], **parts)
    mixed = {"order": [["c1", "y"]], "blocks": ["c2"], "minor": "m"}
    assert not accepted(scene, [_velocities(1, **mixed)], **parts)
    plain = {**scene, "constraints": ["ydot = 0", "x*zdot = 0"]}
    assert not accepted(plain, [_velocities(1, **mixed)], **parts)


def test_rows_that_turn_into_each_other_are_no_order() -> None:
    """At y = 1 the two rows are one."""
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["zdot = y*xdot", "xdot = zdot"]}
    parts = _at(["c1", "c2"], ["x", "z"], x="0", y="2", z="0")
    for order in ([["c1", "z"], ["c2", "x"]], [["c2", "x"], ["c1", "z"]], [["c2", "z"], ["c1", "z"]]):
        assert not accepted(scene, [_velocities(1, order=order, minor="m")], **parts)


def test_a_form_with_an_unknown_factor_may_vanish_on_a_whole_part() -> None:
    scene = {"coordinates": ["x", "y"], "functions": {"h": ["s"]}, "constraints": ["h(x)*ydot = 0"]}
    parts = _at(["c1"], ["y"], x="1", y="0")
    parts["points"][0]["functions"] = {"h": {"arguments": ["s"], "text": "s"}}
    assert not accepted(scene, [_velocities(1, blocks=["c1"], minor="m")], **parts)
    known = {**scene, "constraints": ["x*ydot = 0"]}
    assert faults(known, [_velocities(1, blocks=["c1"], minor="m")], **parts) == {}


@pytest.mark.parametrize(("slope", "good"), [("x", True), ("h(x)", False), ("exp(x)", True), ("abs(x)", False)])
def test_what_integrates_near_a_point_does_so_everywhere_if_it_is_analytic(slope: str, good: bool) -> None:
    scene = {"coordinates": ["x", "y", "z"], "functions": {"h": ["s"]}, "constraints": [f"zdot = {slope}*xdot"]}
    parts = _at(["c1"], ["z"], x="1", y="0", z="0")
    parts["points"][0]["functions"] = {"h": {"arguments": ["s"], "text": "s"}}
    parts["fields"] = [{"id": "X", "components": {"x": "1", "z": slope}}, {"id": "Y", "components": {"y": "1"}}]
    most = {"rule": "frobenius", "minor": "m", "fields": ["X", "Y"], "columns": ["x", "y"]}
    near = {"path": "/dof", "value": 2, "rule": "squeeze", "most": most, "least": {"rule": "regular", "minor": "m"}}
    assert faults(scene, [{**near, "about": "component"}], **parts) == {}
    assert accepted(scene, [{**near, **WHOLE, "order": [["c1", "z"]], "minor": "m"}], **parts) is good
    assert not accepted(scene, [{**near, **WHOLE, "order": [], "minor": "m"}], **parts)


def test_a_graph_for_almost_all_parameters_and_times() -> None:
    plane = {"coordinates": ["x", "y"], "parameters": {"a": "real"}, "constraints": ["x*sin(a) = y*cos(a)"]}
    parts = _at(["c1"], ["x"], x="0", y="0", a="1")
    claim = {**WHOLE, "path": "/dof", "value": 1, "order": [["c1", "x"]], "minor": "m"}
    assert faults(plane, [claim], **parts) == {}
    assert not accepted(plane, [{key: one for key, one in claim.items() if key != "minor"}], **parts)
    assert not accepted({**plane, "constraints": ["x*abs(a) = y"]}, [claim], **parts)
    assert not accepted({**plane, "constraints": ["x*a*y = y"]}, [claim], **parts)
    rope = {"coordinates": ["x", "y"], "constraints": ["sqrt(x^2 + y^2) = 9 - t"]}
    shorter = _at(["c1"], ["x"], x="5", y="0", t="4")
    timely = {**claim, "order": [["c1", "t"]]}
    assert faults(rope, [timely], **shorter) == {}
    assert not accepted({**rope, "constraints": [*rope["constraints"], "y = 0"]}, [timely], **shorter)
    still = {key: one for key, one in timely.items() if key != "minor"}
    assert not accepted({"coordinates": ["x"], "constraints": ["t = 0"]}, [{**still, "value": 0}])


def test_what_follows_everywhere_need_not_be_told() -> None:
    scene = {"coordinates": ["x", "y"], "constraints": ["x = y^2", "2*x = 2*y^2"]}
    parts = {"relations": [{"id": "k", "by": "implied", "of": "c2", "c": {"c1": "2"}}]}
    claim = {**WHOLE, "path": "/dof", "value": 1, "order": [["c1", "x"]]}
    assert faults(scene, [claim], **parts) == {}
    assert not accepted(scene, [claim])
    assert not accepted({**scene, "constraints": ["x = y^2", "2*x = 2*y^2 + t"]}, [claim], **parts)
    near = {"relations": [{"id": "k", "by": "implied", "of": "c2", "h": "x", "c": {"c1": "2*x"}}]}
    assert not accepted(scene, [claim], **near)
    both = {**claim, "value": 0, "order": [["c1", "x"], ["c2", "x"]]}
    assert not accepted(scene, [both], **parts)
    twice = {**claim, "value": 0, "order": [["c1", "x"], ["c1", "y"]]}
    assert not accepted(scene, [twice], **parts)
    form = {"coordinates": ["x", "y", "z"], "constraints": ["zdot = y*xdot", "x*zdot = x*y*xdot"]}
    steps = {"relations": [{"id": "k", "by": "implied", "of": "c2", "c": {"c1": "x"}}]}
    assert faults(form, [_velocities(2, order=[["c1", "z"]])], **steps) == {}
    assert not accepted(form, [_velocities(2, order=[["c1", "z"]])])
