"""Claims about freedom: points, minors, bounds from above and below, and broken ones that must fail."""

from __future__ import annotations

import copy
from typing import Any

import pytest
from checker.certified import accepted, faults

PENDULUM: dict[str, Any] = {
    "dimension": 2,
    "parameters": {"l": "positive"},
    "particles": ["A"],
    "constraints": ["x_A^2 + y_A^2 = l^2"],
}
DOWN = {"id": "P", "values": {"l": "1", "x_A": "0", "y_A": "-1"}}
LOWEST = {"id": "m", "at": "P", "rows": ["c1"], "columns": ["y_A"]}
SWING = {"points": [DOWN], "minors": [LOWEST]}
REGULAR = {"path": "/dof", "value": 1, "rule": "regular", "minor": "m", "about": "component"}
SWINGS = [
    {"path": "/consistent", "value": True, "rule": "point", "at": "P", "minor": "m"},
    REGULAR,
    {"path": "/velocity_dof", "value": 1, "rule": "count"},
    {"path": "/constraints/c1/holonomic", "value": True, "rule": "finite"},
    {"path": "/constraints/c1/holonomic_alone", "value": True, "rule": "finite"},
    {"path": "/constraints/c1/scleronomic", "value": True, "rule": "timeless"},
    {"path": "/constraints/c1/independent", "value": 1, "rule": "independent", "minor": "m"},
    {"path": "/redundant_equations", "value": 0, "rule": "count"},
    {"path": "/redundant", "value": [], "rule": "cofactors", "minor": "m"},
    {"path": "/generalized_coordinates", "value": ["x_A"], "rule": "minor", "minor": "m"},
    {"path": "/holonomic", "value": True, "rule": "count"},
    {"path": "/scleronomic", "value": True, "rule": "count"},
]


def test_a_pendulum_is_verified_whole():
    assert faults(PENDULUM, SWINGS, **SWING) == {}


@pytest.mark.parametrize("place", range(len(SWINGS)))
def test_no_other_value_is_verified(place: int):
    claims = copy.deepcopy(SWINGS)
    value = claims[place]["value"]
    others: list[Any] = [not value, None, 1, 0]
    if isinstance(value, list):
        others = [["y_A"], ["c1"], None, "", 0] + [[]] * bool(value)
    elif value is not True:
        others = [value + 1, value - 1, bool(value), str(value)]
    for other in others:
        claims[place]["value"] = other
        assert claims[place]["path"] in faults(PENDULUM, claims, **SWING), other


@pytest.mark.parametrize(
    ("part", "change"),
    [
        ("points", {"values": {"l": "1", "x_A": "0", "y_A": "1/2"}}),
        ("points", {"values": {"l": "-1", "x_A": "0", "y_A": "-1"}}),
        ("points", {"values": {"l": "1", "x_A": "0"}}),
        ("points", {"values": {"l": "1", "x_A": "0", "y_A": "-1", "q": "0"}}),
        ("points", {"values": {"l": "0", "x_A": "0", "y_A": "0"}}),
        ("minors", {"columns": ["x_A"]}),
        ("minors", {"columns": ["y_A", "x_A"]}),
        ("minors", {"columns": ["l"]}),
        ("minors", {"rows": ["c2"]}),
        ("minors", {"rows": [], "columns": []}),
        ("minors", {"at": "Q"}),
    ],
)
def test_broken_evidence_is_refused(part: str, change: dict[str, Any]):
    parts = copy.deepcopy(SWING)
    parts[part][0].update(change)
    assert not accepted(PENDULUM, [REGULAR], **parts)


def test_a_configuration_that_is_given_is_what_a_claim_is_about():
    scene = {**PENDULUM, "parameters": {"l": 1}, "particles": [{"name": "A", "at": [0, -1]}]}
    point = {"id": "P", "values": {"x_A": "0", "y_A": "-1"}}
    away = {"id": "P", "values": {"x_A": "3/5", "y_A": "-4/5"}}
    assert accepted(scene, [{**REGULAR, "about": "reference"}], points=[point], minors=[LOWEST])
    assert not accepted(scene, [{**REGULAR, "about": "component"}], points=[point], minors=[LOWEST])
    assert not accepted(scene, [{**REGULAR, "about": "reference"}], points=[away], minors=[LOWEST])
    assert not accepted(scene, [{**REGULAR, "about": "component"}], points=[away], minors=[LOWEST])
    assert not accepted(scene, [{**REGULAR, "about": "everywhere"}], points=[point], minors=[LOWEST])


def box(radius: str, centre: str = "1.25992104989487316476721060728") -> dict[str, Any]:
    return {"id": "P", "values": {"x": centre}, "rows": ["c1"], "columns": ["x"], "radius": radius}


@pytest.mark.parametrize(
    ("point", "good"),
    [
        (box("1e-25"), True),
        (box("1e-3"), True),
        (box("1e-25", "1.26"), False),
        (box("-1e-25"), False),
        (box("2"), False),
        ({**box("1e-25"), "rows": ["c1", "c1"]}, False),
        ({"id": "P", "values": {"x": "1.25992104989487316476721060728"}}, False),
    ],
)
def test_a_box_is_certified_by_interval_newton(point: dict[str, Any], good: bool):
    scene = {"coordinates": ["x"], "constraints": ["x^3 = 2"]}
    claim = {"path": "/dof", "value": 0, "rule": "regular", "minor": "m", "about": "component"}
    minor = {"id": "m", "at": "P", "rows": ["c1"], "columns": ["x"]}
    assert accepted(scene, [claim], points=[point], minors=[minor]) is good


FOUR_BAR: dict[str, Any] = {
    "dimension": 2,
    "bodies": ["crank", "coupler", "rocker"],
    "constraints": [
        {"name": "A", "type": "revolute", "between": ["ground", "crank"], "at": [0, 0]},
        {"name": "B", "type": "revolute", "between": ["crank", "coupler"], "at": [0, 2]},
        {"name": "C", "type": "revolute", "between": ["coupler", "rocker"], "at": [4, 3]},
        {"name": "D", "type": "revolute", "between": ["rocker", "ground"], "at": [5, 0]},
    ],
}
POSES = [f"{q}_{body}" for body in FOUR_BAR["bodies"] for q in ("x", "y", "theta")]
HOME = {"id": "P", "values": dict.fromkeys(POSES, "0")}
HINGES = [f"{name}.{i}" for name in "ABCD" for i in (1, 2)]
LINKAGE = {
    "points": [HOME],
    "minors": [{"id": "m", "at": "P", "rows": HINGES, "columns": [q for q in POSES if q != "theta_crank"]}],
}


def test_a_four_bar_linkage():
    claims = [
        {"path": "/dof", "value": 1, "rule": "regular", "minor": "m", "about": "reference"},
        {"path": "/velocity_dof", "value": 1, "rule": "regular", "minor": "m", "about": "reference"},
        {"path": "/instantaneous_dof", "value": 1, "rule": "rank", "at": "P"},
        {"path": "/singular", "value": False, "rule": "count"},
        {"path": "/redundant", "value": [], "rule": "cofactors", "minor": "m"},
        *({"path": f"/constraints/{c}/independent", "value": 2, "rule": "independent", "minor": "m"} for c in "ABCD"),
        {"path": "/generalized_coordinates", "value": ["theta_crank"], "rule": "minor", "minor": "m"},
    ]
    assert faults(FOUR_BAR, claims, **LINKAGE) == {}
    wrong = [
        {**claim, "value": True} if claim["path"] == "/singular" else {**claim, "value": 2} for claim in claims[:4]
    ]
    assert len(faults(FOUR_BAR, wrong, **LINKAGE)) == 4


CRANKS: dict[str, Any] = {
    "dimension": 2,
    "particles": [
        {"name": name, "at": at}
        for name, at in {
            **{"A": [0, 0], "B": [1, 0], "C": [2, 0]},
            **{"D": ["3/5", "4/5"], "E": ["8/5", "4/5"], "F": ["13/5", "4/5"]},
        }.items()
    ],
    "constraints": [
        *({"type": "fixed", "point": name} for name in "ABC"),
        *({"type": "link", "between": list(pair)} for pair in ("AD", "BE", "CF", "DE", "EF", "DF")),
    ],
}
PLACES = {
    **{"x_A": "0", "y_A": "0", "x_B": "1", "y_B": "0", "x_C": "2", "y_C": "0"},
    **{"x_D": "3/5", "y_D": "4/5", "x_E": "8/5", "y_E": "4/5", "x_F": "13/5", "y_F": "4/5"},
}
GROUNDED = [f"c{i}.{k}" for i in (1, 2, 3) for k in (1, 2)]
CRANKED = {
    "points": [{"id": "P", "values": PLACES}],
    "minors": [
        {
            **{"id": "m", "at": "P", "rows": [*GROUNDED, "c4", "c5", "c6", "c7", "c8"]},
            "columns": [q for q in PLACES if q != "x_D"],
        }
    ],
}


def cranked(least: dict[str, Any], value: int = 1) -> dict[str, Any]:
    most = {"rule": "minor", "minor": "m"}
    return {"path": "/dof", "value": value, "rule": "squeeze", "most": most, "least": least, "about": "reference"}


def test_rows_that_do_not_account_for_a_relation_are_no_regular_point():
    assert not accepted(CRANKS, [cranked({"rule": "regular", "minor": "m"})], **CRANKED)
    plain = {"path": "/dof", "value": 1, "rule": "regular", "minor": "m", "about": "reference"}
    assert not accepted(CRANKS, [plain], **CRANKED)


def test_values_that_are_chosen_for_parameters_are_not_special():
    scene = {"coordinates": ["x", "y"], "parameters": {"a": "real"}, "constraints": ["a*x = 0"]}
    parts = {
        "points": [{"id": "P", "values": {"x": "0", "y": "0", "a": "0"}}],
        "minors": [{"id": "0", "at": "P", "rows": [], "columns": []}],
        "fields": [{"id": q, "components": {q: "1"}} for q in ("x", "y")],
    }
    span = {"rule": "span", "at": "P", "fields": ["x", "y"], "words": [["x"], ["y"]], "columns": ["x", "y"]}
    most = {"rule": "minor", "minor": "0"}
    claim = {**cranked({**span, "rows": []}, 2), "about": "component", "most": most}
    assert not accepted(scene, [claim], **parts)
    assert not accepted(scene, [{**claim, "least": {**span, "rows": ["c1"]}}], **parts)
    assert accepted({**scene, "constraints": []}, [claim], **parts)
    twice = {**scene, "constraints": ["x = a", "x = 0"]}
    rest = {"path": "/consistent", "value": True, "rule": "point", "at": "P"}
    assert not accepted(twice, [rest], **parts)
    one = {**parts, "minors": [{"id": "m", "at": "P", "rows": ["c1"], "columns": ["x"]}]}
    assert not accepted(twice, [{**rest, "minor": "m"}], **one)
    assert accepted({**scene, "constraints": ["x = a"]}, [{**rest, "minor": "m"}], **one)
    assert not accepted({**scene, "constraints": ["xdot = a"]}, [rest], **parts)
    assert not accepted({**scene, "constraints": ["x^2 + a^2 <= 0"]}, [rest], **parts)
    timed = {**parts, "points": [{"id": "P", "values": {"a": "0", "t": "0"}}]}
    assert not accepted({**scene, "constraints": ["xdot = a"]}, [rest], **timed)


def test_an_isolated_configuration_is_no_place_for_a_claim_about_everywhere():
    curve = {"coordinates": ["x", "y"], "constraints": ["y^2 = x^2*(x - 1)"]}
    parts = {
        "points": [{"id": "P", "values": {"x": "2", "y": "2"}}],
        "minors": [{"id": "m", "at": "P", "rows": ["c1"], "columns": ["y"]}],
    }
    claim = {"path": "/dof", "value": 1, "rule": "everywhere", "blocks": ["c1"], "about": "everywhere", "minor": "m"}
    assert accepted(curve, [claim], **parts)
    assert not accepted({**curve, "configuration": {"x": 0, "y": 0}}, [claim], **parts)


HEISENBERG: dict[str, Any] = {"coordinates": ["x", "y", "z"], "constraints": ["dz = y dx"]}
CARRIED = {
    "points": [{"id": "P", "values": {"x": "0", "y": "1", "z": "0"}}],
    "minors": [
        {"id": "m", "at": "P", "rows": ["c1"], "columns": ["z"]},
        {"id": "0", "at": "P", "rows": [], "columns": []},
    ],
    "fields": [
        {"id": "A", "components": {"x": "1", "z": "y"}},
        {"id": "B", "components": {"y": "1"}},
        {"id": "D", "components": {"x": "1"}},
    ],
}
SPAN = {"rule": "span", "at": "P", "fields": ["A", "B"], "rows": ["c1"]}
ALL = {**SPAN, "words": [["A"], ["B"], ["A", "B"]], "columns": ["x", "y", "z"]}


def carried(least: dict[str, Any], value: int = 3) -> dict[str, Any]:
    most = {"rule": "minor", "minor": "0"}
    return {"path": "/dof", "value": value, "rule": "squeeze", "most": most, "least": least, "about": "component"}


def test_brackets_bound_dof_from_below():
    assert faults(HEISENBERG, [carried(ALL)], **CARRIED) == {}
    velocity = {"path": "/velocity_dof", "value": 2, "rule": "regular", "minor": "m", "about": "component"}
    assert faults(HEISENBERG, [velocity], **CARRIED) == {}


@pytest.mark.parametrize(
    "least",
    [
        {**ALL, "fields": ["D", "B"], "words": [["D"], ["B"], ["D", "B"]]},
        {**ALL, "words": [["A"], ["B"], ["B", "B"]]},
        {**ALL, "words": [["A"], ["B"], ["A"]]},
        {**ALL, "words": [["A"], ["B"], ["D"]]},
        {**ALL, "words": [["A"], ["B"]], "columns": ["x", "y"]},
        {**ALL, "rows": []},
        {**ALL, "fields": ["A"], "words": [["A"]], "columns": ["x"]},
        {"rule": "regular", "minor": "m"},
    ],
)
def test_broken_brackets_are_refused(least: dict[str, Any]):
    assert not accepted(HEISENBERG, [carried(least)], **CARRIED)


def test_a_row_of_velocities_is_no_upper_bound_of_dof():
    two = carried({**ALL, "words": [["A"], ["B"]], "columns": ["x", "y"]}, 2)
    assert not accepted(HEISENBERG, [{**two, "most": {"rule": "minor", "minor": "m"}}], **CARRIED)
    short = {"path": "/dof", "value": 2, "rule": "regular", "minor": "m", "about": "component"}
    assert not accepted(HEISENBERG, [short], **CARRIED)
    span = {**ALL, "words": [["A"], ["B"], ["A", "B"]]}
    fast = {**carried(span), "path": "/velocity_dof"}
    assert not accepted(HEISENBERG, [fast], **CARRIED)


def test_a_growth_vector():
    spans = [{"words": [["A"], ["B"]], "columns": ["x", "y"]}, {"words": ALL["words"], "columns": ALL["columns"]}]
    claim = {**SPAN, "path": "/growth_vector", "value": [2, 3], "minor": "m", "spans": spans}
    assert faults(HEISENBERG, [carried(ALL), claim], **CARRIED) == {}
    for value, given in (
        ([2], spans[:1]),
        ([2, 2], [spans[0]] * 2),
        ([3], spans[1:]),
        ([2, 3, 3], spans),
        ([2, 4], spans),
    ):
        assert not accepted(HEISENBERG, [carried(ALL), {**claim, "value": value, "spans": given}], **CARRIED)
    assert not accepted(HEISENBERG, [claim], **CARRIED)


def test_time_takes_one_from_the_span():
    scene = {"coordinates": ["x", "y"], "constraints": ["dx = y dt"]}
    parts = {
        "points": [{"id": "P", "values": {"x": "0", "y": "1", "t": "0"}}],
        "fields": [{"id": "A", "components": {"x": "y", "t": "1"}}, {"id": "B", "components": {"y": "1"}}],
        "minors": [{"id": "0", "at": "P", "rows": [], "columns": []}],
    }
    words = {"rows": ["c1"], "words": [["A"], ["B"], ["A", "B"]], "columns": ["x", "y", "t"]}
    assert faults(scene, [carried({**SPAN, **words}, 2)], **parts) == {}
    short = {**words, "words": [["A"], ["B"]], "columns": ["t", "y"]}
    assert not accepted(scene, [carried({**SPAN, **short}, 2)], **parts)


def test_rows_that_integrate_bound_dof_from_above():
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["y dx + x dy + dz = 0"]}
    parts = {
        "points": [{"id": "P", "values": {"x": "0", "y": "1", "z": "0"}}],
        "minors": [{"id": "m", "at": "P", "rows": ["c1"], "columns": ["z"]}],
        "fields": [{"id": q, "components": {q: "1", "z": f"-{other}"}} for q, other in ("xy", "yx")],
    }
    most = {"rule": "frobenius", "minor": "m", "fields": ["x", "y"], "columns": ["x", "y"]}
    claim = {**carried({"rule": "regular", "minor": "m"}, 2), "most": most}
    assert faults(scene, [claim], **parts) == {}
    assert not accepted(scene, [{**claim, "most": {**most, "fields": ["x"], "columns": ["x"]}}], **parts)
    assert not accepted(scene, [{**claim, "most": {**most, "columns": ["x", "z"]}}], **parts)
    assert not accepted({**scene, "constraints": ["y dx - x dy + dz = 0"]}, [claim], **parts)
    step = {"id": "f", "by": "integral", "function": "x*y+z", "c": {"c1": "1"}}
    minor = {"id": "f", "at": "P", "rows": ["f"], "columns": ["z"]}
    whole = {"path": "/dof", "value": 2, "rule": "regular", "minor": "f", "about": "component"}
    back = [step, {"id": "r", "by": "rate", "of": "f"}, {"id": "i", "by": "implied", "of": "c1", "c": {"r": "1"}}]
    assert faults(scene, [whole], **{**parts, "minors": [minor], "relations": back}) == {}
    assert not accepted(scene, [whole], **{**parts, "minors": [minor], "relations": back[:1]})
    back[0] = {**step, "function": "x*y-z"}
    assert not accepted(scene, [whole], **{**parts, "minors": [minor], "relations": back})
