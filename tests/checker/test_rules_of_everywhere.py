"""Claims about the whole set, about generic lengths, and what follows by a constant rank; broken ones must fail."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import pytest
from checker.certified import accepted, faults

SCENE: dict[str, Any] = {
    "coordinates": ["x", "y", "z", "u", "v"],
    "parameters": {"s": "positive"},
    "constraints": ["x = y^2 + 1", "u^2 + v^2 = 25", "z^2 + y = s"],
}
POINT = {"id": "P", "values": {"x": "2", "y": "1", "z": "1", "u": "3", "v": "4", "s": "2"}}
PARTS = {"points": [POINT], "minors": [{"id": "m", "at": "P", "rows": ["c1", "c2", "c3"], "columns": ["x", "u", "z"]}]}
EVERYWHERE = {
    **{"path": "/dof", "value": 2, "rule": "everywhere", "about": "everywhere", "minor": "m"},
    **{"order": [["c1", "x"]], "blocks": ["c2"], "generic": [["c3", "s"]]},
}


@pytest.mark.parametrize(
    ("change", "good"),
    [
        ({}, True),
        ({"blocks": ["c2", "c3"], "generic": []}, True),
        ({"value": 3}, False),
        ({"about": "component"}, False),
        ({"minor": {"at": "P", "rows": ["c1", "c2"], "columns": ["x", "u"]}}, False),
        ({"blocks": ["c2"], "generic": []}, False),
        ({"blocks": ["c2", "c2"]}, False),
        ({"order": [["c1", "y"]]}, False),
        ({"order": [["c1", "x"], ["c2", "u"]], "blocks": []}, False),
        ({"generic": [["c3", "z"]]}, False),
        ({"generic": [["c3", "r"]]}, False),
        ({"generic": [["c3", "s"], ["c2", "s"]], "blocks": []}, False),
    ],
)
def test_a_whole_set(change: dict[str, Any], good: bool):
    assert accepted(SCENE, [{**EVERYWHERE, **change}], **PARTS) is good


def test_blocks_that_share_a_coordinate_are_no_blocks():
    shared = {**SCENE, "constraints": ["x = y^2 + 1", "u^2 + v^2 + x = 27", "z^2 + y = s"]}
    assert not accepted(shared, [EVERYWHERE], **PARTS)
    cusp = {"coordinates": ["x", "y", "u"], "constraints": ["x*y = 0", "x*u = 0"]}
    parts = {
        "points": [{"id": "P", "values": {"x": "0", "y": "1", "u": "1"}}],
        "minors": [{"id": "m", "at": "P", "rows": ["c1", "c2"], "columns": ["x", "y"]}],
    }
    claim = {**EVERYWHERE, "value": 1, "order": [], "blocks": ["c1", "c2"], "generic": []}
    assert not accepted(cusp, [claim], **parts)


def test_a_function_that_is_0_on_half_a_line_is_not_analytic():
    scene = {"coordinates": ["x", "y"], "constraints": ["abs(x) - x = y*0 + abs(y) - y - 2"]}
    parts = {
        "points": [{"id": "P", "values": {"x": "1", "y": "-1"}}],
        "minors": [{"id": "m", "at": "P", "rows": ["c1"], "columns": ["y"]}],
    }
    claim = {"path": "/dof", "value": 1, "rule": "everywhere", "blocks": ["c1"], "about": "everywhere", "minor": "m"}
    assert not accepted(scene, [claim], **parts)
    circle = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 2"]}
    assert faults(circle, [claim], **parts) == {}


CORNERS = {"A": (0, 0), "B": (3, 0), "C": (1, 2), "D": (5, 7)}
PAIRS = list(combinations("ABCD", 2))
WHOLE: dict[str, Any] = {
    "dimension": 2,
    "particles": list(CORNERS),
    "constraints": [{"type": "link", "between": list(pair)} for pair in PAIRS],
}
LINKS = [f"c{i}" for i in range(1, 7)]
SQUARES = {
    f"square_c{i}": str(sum((p - q) ** 2 for p, q in zip(CORNERS[a], CORNERS[b], strict=True)))
    for i, (a, b) in enumerate(PAIRS, 1)
}
DRAWN = {f"{axis}_{name}": str(value) for name, at in CORNERS.items() for axis, value in zip("xy", at, strict=True)}
RIGID = [
    {"id": "east", "components": {f"x_{name}": "1" for name in CORNERS}},
    {"id": "north", "components": {f"y_{name}": "1" for name in CORNERS}},
    {
        "id": "turn",
        "components": {f"{a}_{n}": f"{s}{b}_{n}" for n in CORNERS for a, b, s in (("x", "y", "-"), ("y", "x", ""))},
    },
]
BLOCK = {"rows": LINKS, "fields": ["east", "north", "turn"], "columns": ["x_A", "y_A", "y_B"]}
FRAME: dict[str, Any] = {
    "points": [{"id": "P", "values": {**DRAWN, **SQUARES}}],
    "minors": [{"id": "m", "at": "P", "rows": LINKS[:5], "columns": ["x_B", "x_C", "y_C", "x_D", "y_D"]}],
    "fields": RIGID,
    "covers": [{"id": "k", "minor": "m", "blocks": [BLOCK]}],
}
OWN = {"order": [], "generic": [[link, f"square_{link}"] for link in LINKS]}
CLAIMS = [
    {"path": "/dof", "value": 3, "rule": "everywhere", "about": "everywhere", "minor": "m", "covers": ["k"], **OWN},
    {"path": "/velocity_dof", "value": 3, "rule": "count"},
    {"path": "/redundant_equations", "value": 1, "rule": "count"},
    {"path": "/constraints/c6/independent", "value": 0, "rule": "independent", "minor": "m", "covers": ["k"]},
    {"path": "/constraints/c5/independent", "value": 1, "rule": "independent", "minor": "m", "covers": ["k"]},
    {"path": "/redundant", "value": ["c6"], "rule": "cofactors", "minor": "m", "covers": ["k"]},
]


def test_a_framework_with_one_link_too_many():
    assert faults(WHOLE, CLAIMS, **FRAME) == {}
    plain = {"path": "/dof", "value": 3, "rule": "regular", "minor": "m", "covers": ["k"], "about": "component"}
    assert faults(WHOLE, [plain], **FRAME) == {}
    assert not accepted(WHOLE, [{key: value for key, value in plain.items() if key != "covers"}], **FRAME)
    assert not accepted(WHOLE, [{**CLAIMS[-1], "value": []}], **FRAME)
    assert not accepted(WHOLE, [{**CLAIMS[3], "value": 1}], **FRAME)


def test_the_circuit_of_a_framework():
    fails = {
        link: {
            "minor": {
                "at": "P",
                "rows": [*(one for one in LINKS[:5] if one != link), "c6"],
                "columns": FRAME["minors"][0]["columns"],
            }
        }
        for link in LINKS[:5]
    }
    claim = {
        "path": "/constraints/c6/circuit",
        "value": LINKS[:5],
        "rule": "cofactors",
        "at": "P",
        "minimal": fails,
        "covers": ["k"],
    }
    assert faults(WHOLE, [claim], **FRAME) == {}
    assert not accepted(WHOLE, [{**claim, "value": LINKS[:4]}], **FRAME)
    assert not accepted(WHOLE, [{**claim, "covers": []}], **FRAME)
    assert not accepted(WHOLE, [{**claim, "minimal": {**fails, "c1": fails["c2"]}}], **FRAME)
    group = {"path": "/redundancies", "value": [{"nullity": 1, "members": LINKS}], "rule": "count"}
    assert faults(WHOLE, [*CLAIMS, claim, group], **FRAME) == {}
    assert faults(WHOLE, [*CLAIMS, group], **FRAME).keys() == {"/redundancies"}
    assert faults(WHOLE, [*CLAIMS[:-1], claim, group], **FRAME).keys() == {"/redundancies"}
    for value in ([], [{"nullity": 2, "members": LINKS}], [{"nullity": 1, "members": LINKS[:5]}]):
        assert faults(WHOLE, [*CLAIMS, claim, {**group, "value": value}], **FRAME).keys() == {"/redundancies"}


@pytest.mark.parametrize(
    "block",
    [
        {**BLOCK, "fields": ["east", "north"], "columns": ["x_A", "y_A"]},
        {**BLOCK, "fields": ["east", "north", "north"]},
        {**BLOCK, "columns": ["x_A", "y_A", "x_A"]},
        {**BLOCK, "rows": LINKS[:5]},
        {**BLOCK, "rows": [*LINKS, "c1"]},
        {**BLOCK, "fields": ["east", "north", "grow"]},
    ],
)
def test_a_broken_cover_is_refused(block: dict[str, Any]):
    grow = {"id": "grow", "components": dict(zip(DRAWN, DRAWN, strict=True))}
    parts = {**FRAME, "fields": [*RIGID, grow], "covers": [{"id": "k", "minor": "m", "blocks": [block]}]}
    assert not accepted(WHOLE, [CLAIMS[0]], **parts)


def test_what_is_feasible_together():
    scene = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1", "x >= 0", "y > 0"]}
    points = [
        {"id": name, "values": {"x": x, "y": y}}
        for name, x, y in (("P", "3/5", "4/5"), ("Q", "1", "0"), ("R", "0", "1"))
    ]
    good = {"path": "/feasible", "value": True, "rule": "point", "at": "P"}
    assert accepted(scene, [good], points=points)
    assert accepted(scene, [{**good, "at": "R"}], points=points)
    assert not accepted(scene, [{**good, "at": "Q"}], points=points)
    each = {"path": "/consistent", "value": True, "rule": "point", "at": "Q", "inequalities": {"c2": "Q", "c3": "R"}}
    assert accepted(scene, [each], points=points)
    assert not accepted(scene, [{**each, "inequalities": {}}], points=points)
    assert not accepted(scene, [{**good, "value": False}], points=points)
    assert not accepted({**scene, "constraints": scene["constraints"][:1]}, [good], points=points)


def test_motions_through_time():
    scene = {"coordinates": ["x", "y"], "constraints": ["x = sin(t)", "xdot = cos(t) + y*0"]}
    at = [{"id": "P", "values": {"x": "0", "y": "0", "t": "0"}}]
    assert not accepted(scene, [{"path": "/consistent", "value": True, "rule": "point", "at": "P"}], points=at)
    moment = {"coordinates": ["x"], "constraints": ["x*t = 0", "x = 0", "t = 0"]}
    start = [{"id": "P", "values": {"x": "0", "t": "0"}}]
    assert not accepted(moment, [{"path": "/consistent", "value": True, "rule": "point", "at": "P"}], points=start)
    never = {"path": "/consistent", "value": False, "rule": "nullstellensatz", "number": "1", "c": {"r": "-1"}}
    assert faults(moment, [never], relations=[{"id": "r", "by": "rate", "of": "c3"}]) == {}


def test_what_is_integrable():
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["x dx + y dy = 0", "dz = x dy"]}
    parts = {
        "points": [{"id": "P", "values": {"x": "1", "y": "0", "z": "0"}}],
        "relations": [
            {"id": "f", "by": "integral", "function": "x^2+y^2", "c": {"c1": "2"}},
            {"id": "r", "by": "rate", "of": "f"},
            {"id": "i", "by": "implied", "of": "c1", "h": "2", "c": {"r": "1"}},
        ],
        "minors": [
            {"id": "f", "at": "P", "rows": ["f"], "columns": ["x"]},
            {"id": "m", "at": "P", "rows": ["c1", "c2"], "columns": ["x", "z"]},
        ],
        "fields": [{"id": "X", "components": {"x": "-y", "y": "x", "z": "x^2"}}],
    }
    most = {"rule": "frobenius", "minor": "m", "fields": ["X"], "columns": ["y"]}
    dof = {
        "path": "/dof",
        "value": 1,
        "rule": "squeeze",
        "most": most,
        "least": {"rule": "regular", "minor": "m"},
        "about": "component",
    }
    part = {"path": "/integrable_part", "value": {"rank": 2, "basis": None}, "rule": "integrals"}
    assert faults(scene, [dof, part], **parts) == {}
    assert not accepted(scene, [part], **parts)
    assert not accepted(scene, [dof, {**part, "value": {"rank": 1, "basis": None}}], **parts)
    told = {**part, "value": {"rank": 1, "basis": ["x^2 + y^2 = C"]}, "minor": "f", "steps": ["f"]}
    assert not accepted(scene, [dof, told], **parts)
    alone = {**scene, "constraints": scene["constraints"][:1]}
    one = {**parts, "minors": parts["minors"][:1]}
    free = {"path": "/dof", "value": 2, "rule": "regular", "minor": "f", "about": "component"}
    assert faults(alone, [free, told], **one) == {}
    for basis in (["x^2 + y^2 = 0"], ["x^2 + y^2 = x"], ["x^2 - y^2 = C"], [], ["x^2 + y^2 = C"] * 2):
        assert not accepted(alone, [free, {**told, "value": {"rank": 1, "basis": basis}}], **one)


def test_a_chart_of_poses_says_nothing_of_all():
    line = {"type": "equation", "text": "x_B = 0"}
    scene = {"bodies": ["B"], "constraints": [line, {"type": "equation", "text": "x_B = 1"}]}
    never = {
        "path": "/consistent",
        "value": False,
        "rule": "nullstellensatz",
        "number": "1",
        "c": {"c1": "-1", "c2": "1"},
    }
    assert accepted(scene, [never])
    assert not accepted(scene, [{**never, "cayley": True}], cayley=["B"])
    graph = {"path": "/dof", "value": 5, "rule": "everywhere", "order": [["c1", "x_B"]], "about": "everywhere"}
    one = {**scene, "constraints": [line]}
    assert accepted(one, [graph])
    assert not accepted(one, [{**graph, "cayley": True}], cayley=["B"])
    assert not accepted(one, [{**graph, "about": "component"}])
    free = {"path": "/velocity_dof", "value": 5, "rule": "count", "about": "everywhere"}
    assert accepted(one, [graph, free])
    assert not accepted(one, [graph, {**free, "about": "reference"}])
    assert not accepted(one, [free])


@pytest.mark.parametrize("more", ["t", "a", "h(0)", "t*x", "a*x"])
def test_a_cover_knows_nothing_of_time_and_parameters(more: str):
    scene = {"coordinates": ["x", "y"], "parameters": {"a": "real"}, "functions": {"h": ["s"]}}
    values = {"x": "0", "y": "0", "t": "0", "a": "0"}
    parts = {
        "points": [{"id": "P", "values": values, "functions": {"h": {"arguments": ["s"], "text": "s"}}}],
        "minors": [{"id": "m", "at": "P", "rows": ["c1"], "columns": ["x"]}],
        "covers": [{"id": "k", "minor": "m", "blocks": [{"rows": ["c1", "c2"], "fields": [], "columns": []}]}],
    }
    claim = {"path": "/dof", "value": 1, "rule": "regular", "minor": "m", "about": "component", "covers": ["k"]}
    assert accepted({**scene, "constraints": ["x = 0", "x + x^2 = 0"]}, [claim], **parts)
    assert not accepted({**scene, "constraints": ["x = 0", f"x + x^2 + {more} = 0"]}, [claim], **parts)


def test_at_a_single_moment_there_is_no_freedom():
    scene = {"coordinates": ["x"], "constraints": ["t = 0"]}
    parts = {
        "points": [{"id": "P", "values": {"x": "0", "t": "0"}}],
        "minors": [{"id": "0", "at": "P", "rows": [], "columns": []}],
        "fields": [{"id": "X", "components": {"x": "1"}}],
    }
    span = {"rule": "span", "at": "P", "fields": ["X"], "rows": ["c1"], "words": [["X"]], "columns": ["x"]}
    for least in (span, {"rule": "regular", "minor": "0"}):
        most = {"rule": "minor", "minor": "0"}
        claim = {"path": "/dof", "value": 1, "rule": "squeeze", "most": most, "least": least, "about": "component"}
        assert not accepted(scene, [claim], **parts)
        still = {**claim, "least": {**least, "rows": []}}
        assert accepted({**scene, "constraints": []}, [still], **parts)
