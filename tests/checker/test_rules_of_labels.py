"""Claims about labels, and broken ones that must fail."""

from __future__ import annotations

from typing import Any

import pytest
from checker.certified import accepted, branch, faults


def about(name: str, field: str, value: Any, rule: str, **evidence: Any) -> dict[str, Any]:
    return {"path": f"/constraints/{name}/{field}", "value": value, "rule": rule, **evidence}


SKATE: dict[str, Any] = {
    "coordinates": ["x", "y", "theta"],
    "parameters": {"a": "real"},
    "constraints": [{"name": "edge", "text": "sin(theta) dx - cos(theta) dy = 0"}],
}
ICE: dict[str, Any] = {
    "points": [{"id": "P", "values": {"x": "0", "y": "0", "theta": "0"}}],
    "fields": [
        {"id": "go", "components": {"x": "cos(theta)", "y": "sin(theta)"}},
        {"id": "turn", "components": {"theta": "1"}},
        {"id": "slip", "components": {"x": "1"}},
    ],
}
BRACKET = {"at": "P", "fields": ["go", "turn"], "rows": ["edge"], "pairs": "edge"}
WORD = {**BRACKET, "word": ["go", "turn"]}
TOLD = [
    about("edge", "holonomic", False, "bracket", **WORD),
    about("edge", "holonomic_alone", False, "bracket", **WORD),
    about("edge", "holonomic_alone", False, "wedge", at="P", triple=["x", "y", "theta"]),
    about("edge", "exact", False, "not exact", at="P", pair=["y", "theta"]),
    about("edge", "exact", False, "not exact", at="Q", pair=["y", "theta"]),
    about("edge", "scleronomic", True, "timeless"),
    about("edge", "catastatic", True, "timeless"),
]


@pytest.mark.parametrize("place", [0, 1, 2, 5, 6])
def test_a_skate(place: int):
    claim = TOLD[place]
    assert faults(SKATE, [claim], **ICE) == {}
    for other in (not claim["value"], None, int(claim["value"])):
        assert not accepted(SKATE, [{**claim, "value": other}], **ICE)


def test_a_curl_is_asked_at_a_point_where_it_is_not_0():
    assert not accepted(SKATE, [TOLD[3]], **ICE)
    turned = {"points": [{"id": "Q", "values": {"x": "0", "y": "0", "theta": "pi/2"}}]}
    assert accepted(SKATE, [TOLD[4]], **turned)
    assert not accepted(SKATE, [{**TOLD[4], "pair": ["x", "y"]}], **turned)


@pytest.mark.parametrize(
    "change",
    [
        {"word": "go"},
        {"word": ["go"]},
        {"word": ["go", "go"]},
        {"word": ["slip"]},
        {"word": []},
        {"fields": ["go", "turn", "slip"], "word": ["slip", "turn"]},
        {"rows": []},
        {"pairs": "c1"},
        {"at": "Q"},
    ],
)
def test_a_broken_bracket_is_refused(change: dict[str, Any]):
    assert not accepted(SKATE, [about("edge", "holonomic", False, "bracket", **{**WORD, **change})], **ICE)


def test_a_form_is_not_called_integrable_when_it_is_not():
    assert not accepted(SKATE, [about("edge", "holonomic_alone", True, "wedge")], **ICE)
    assert not accepted(SKATE, [about("edge", "exact", True, "exact")], **ICE)
    free = {"coordinates": ["x", "y", "z"], "constraints": ["x dy - y dx + 0*z = 0", "z dx + dy = 0"]}
    assert accepted(free, [about("c1", "holonomic_alone", True, "wedge")])
    assert not accepted(free, [about("c1", "holonomic", True, "wedge")])


POTENTIAL: dict[str, Any] = {"coordinates": ["x", "y", "z"], "constraints": ["2 y dx + x dy = 0", "dz = (x-1) x y dx"]}
AT = {"id": "P", "values": {"x": "1", "y": "2", "z": "0"}}
STEPS = [
    {"id": "f", "by": "integral", "function": "x^2*y", "c": {"c1": "x"}},
    {"id": "r", "by": "rate", "of": "f"},
    {"id": "i", "by": "implied", "of": "c1", "h": "x", "c": {"r": "1"}},
]
GOOD = [
    about("c1", "integral", "x^2*y = C", "integral", at="P", step="f"),
    about("c1", "holonomic", True, "integral", at="P", integrals=["f"]),
    about("c1", "holonomic_alone", True, "integral", at="P", integrals=["f"]),
]


@pytest.mark.parametrize("claim", GOOD)
def test_an_integral(claim: dict[str, Any]):
    parts = {"points": [AT], "relations": STEPS}
    assert faults(POTENTIAL, [claim], **parts) == {}
    assert not accepted(POTENTIAL, [claim], **{**parts, "points": [{**AT, "values": {"x": "0", "y": "2", "z": "0"}}]})
    for wrong in ("x^2", "x^2*y = y", "x*y = C", "x^3*y = C", False, None, "0"):
        assert not accepted(POTENTIAL, [{**claim, "value": wrong}], **parts)


def test_integrals_that_do_only_together():
    """dx + dy = 0 and dx - dy = 0 keep x and y; of dx = 0 and dy = 0 each keeps its own alone."""
    point = [{"id": "P", "values": {"x": "0", "y": "0"}}]
    claim = about("c1", "integral", "x = C", "integral", at="P", step="x", integrals=["y"], minor="m")
    for first, second, cofactors, good in (
        ("dx + dy = 0", "dx - dy = 0", ({"c1": "1/2", "c2": "1/2"}, {"c1": "1/2", "c2": "-1/2"}), True),
        ("dy = 0", "dx = 0", ({"c2": "1"}, {"c1": "1"}), False),
    ):
        scene = {"coordinates": ["x", "y"], "constraints": [first, second]}
        steps = [
            {"id": "x", "by": "integral", "function": "x", "c": cofactors[0]},
            {"id": "y", "by": "integral", "function": "y", "c": cofactors[1]},
            {"id": "dx", "by": "rate", "of": "x"},
            {"id": "dy", "by": "rate", "of": "y"},
            {"id": "k", "by": "implied", "of": "c1", "c": {"dy": "1", **({"dx": "1"} if good else {})}},
        ]
        parts = {
            "points": point,
            "relations": steps,
            "minors": [
                {"id": "m", "at": "P", "rows": ["y", "c1"], "columns": ["x", "y"]},
                {"id": "n", "at": "P", "rows": ["y"], "columns": ["y"]},
                {"id": "o", "at": "P", "rows": ["c1"], "columns": ["y"]},
            ],
        }
        assert accepted(scene, [claim], **parts) is good
        for wrong in ({"minor": "n"}, {"minor": "o"}, {"integrals": []}, {"integrals": ["c2"]}, {"step": "y"}):
            assert not accepted(scene, [{**claim, **wrong}], **parts)


@pytest.mark.parametrize(
    "steps",
    [
        STEPS[:2],
        [{**STEPS[0], "function": "x*y"}, *STEPS[1:]],
        [{**STEPS[0], "c": {"c2": "x"}}, *STEPS[1:]],
        [{**STEPS[0], "h": "0", "c": {}}, *STEPS[1:]],
        [{**STEPS[0], "function": "1", "c": {}}, *STEPS[1:]],
        [*STEPS[:2], {**STEPS[2], "h": "1"}],
        [*STEPS[:2], {**STEPS[2], "h": "0", "c": {}}],
        [*STEPS[:2], {**STEPS[2], "of": "c2"}],
    ],
)
def test_broken_steps_are_refused(steps: list[dict[str, Any]]):
    assert not accepted(POTENTIAL, [GOOD[1]], points=[AT], relations=steps)


def test_a_form_that_only_the_others_make_integrable():
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["dz = y dx", "y = x^2"]}
    steps = [
        {"id": "d", "by": "rate", "of": "c2"},
        {"id": "f", "by": "integral", "function": "z - x^3/3", "c": {"c1": "1", "c2": "xdot"}},
        {"id": "r", "by": "rate", "of": "f"},
        {"id": "i", "by": "implied", "of": "c1", "c": {"r": "1", "c2": "-xdot"}},
    ]
    parts = {"points": [{"id": "P", "values": {"x": "0", "y": "0", "z": "0"}}], "relations": steps}
    claim = about("c1", "holonomic", True, "integral", at="P", integrals=["f"])
    assert faults(scene, [claim], **parts) == {}
    assert not accepted(scene, [{**claim, "path": "/constraints/c1/holonomic_alone"}], **parts)
    off = {**parts, "points": [{"id": "P", "values": {"x": "0", "y": "1", "z": "0"}}]}
    assert not accepted(scene, [claim], **off)


def test_two_forms_that_integrate_together():
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["dy = z dx", "dz = y dx"]}
    parts = {
        "points": [{"id": "P", "values": {"x": "0", "y": "0", "z": "0"}}],
        "minors": [{"id": "m", "at": "P", "rows": ["c1", "c2"], "columns": ["y", "z"]}],
        "fields": [{"id": "X", "components": {"x": "1", "y": "z", "z": "y"}}],
    }
    claim = about("c1", "holonomic", True, "frobenius", minor="m", fields=["X"], columns=["x"])
    assert faults(scene, [claim, {**claim, "path": "/constraints/c2/holonomic"}], **parts) == {}
    assert not accepted(scene, [{**claim, "path": "/constraints/c1/holonomic_alone"}], **parts)
    assert not accepted(scene, [{**claim, "fields": [], "columns": []}], **parts)
    assert not accepted(scene, [{**claim, "columns": ["x", "x"]}], **parts)


def test_time():
    scene = {
        "coordinates": ["x", "y", "z"],
        "parameters": {"v": "positive"},
        "constraints": [
            "x = t*y",
            "xdot = v",
            "(1+t^2)*(dx + dy) = 0",
            "xdot^7 + ydot^7 = zdot^7",
            "xdot^2 + ydot^2 = v^2",
            "dx + t dy = 0",
            "x > t",
            "(2 + x^2 + t^2)*(x - y) = 0",
        ],
    }
    state = {"xdot": "0", "ydot": "1", "zdot": "1"}
    parts = {
        "points": [{"id": "P", "values": {"x": "2", "y": "3", "z": "0", "t": "1", "v": "1", **state}}],
        "relations": branch("g", "c3", ["1+t^2", "xdot+ydot"], 1),
    }
    on = {**parts, "points": [{"id": "P", "values": {**parts["points"][0]["values"], "x": "1", "y": "1"}}]}
    # f (1 + t^2) f = f^2 + (t f)^2 for f = xdot + ydot
    made = {**parts["relations"][0], "h": "1", "power": 2, "c": {"c3": "xdot+ydot"}}
    dropped = about("c3", "scleronomic", True, "timeless", steps=["g"])
    for change, good in (
        ({"sos": [["1", "t*(xdot+ydot)"]]}, True),
        ({"sos": [["1", "t*(xdot+ydot)"]], "h": "2"}, False),
        ({"sos": [["-1", "t*(xdot+ydot)"]], "h": "1+2*t^2"}, False),
        ({"sos": [], "h": "1+t^2"}, False),
    ):
        steps = [{**made, **change}, parts["relations"][1]]
        assert accepted(scene, [dropped], **{**on, "relations": steps}) is good
        assert not accepted(scene, [{**dropped, "path": "/constraints/c6/scleronomic"}], **{**on, "relations": steps})
    good = [
        about("c4", "scleronomic", True, "timeless"),
        about("c2", "catastatic", False, "turns", relation="c2", at="P"),
        about("c6", "scleronomic", False, "turns", relation="c6", at="P", pair=["x", "y"]),
        about("c6", "catastatic", True, "timeless"),
        about("c1", "scleronomic", False, "turns", relation="c1", at="P"),
        about("c7", "scleronomic", False, "turns", relation="c7", at="P"),
    ]
    assert all(accepted(scene, [claim], **on) for claim in good)
    moved = about("c2", "scleronomic", False, "turns", relation="c2", at="P")
    assert accepted(scene, [about("c2", "holonomic_alone", True, "wedge"), moved], **on)  # x = v t + C
    bad = [
        moved,
        about("c2", "scleronomic", True, "timeless"),
        about("c3", "scleronomic", True, "timeless", steps=["g"]),
        about("c3", "scleronomic", True, "timeless"),
        about("c3", "scleronomic", False, "turns", relation="c3", at="P", pair=["x", "y"]),
        about("c8", "scleronomic", False, "turns", relation="c8", at="P"),
        about("c5", "scleronomic", True, "timeless"),
        about("c4", "scleronomic", False, "turns", relation="c4", at="P"),
        about("c2", "scleronomic", True, "timeless"),
        about("c2", "catastatic", True, "timeless"),
        about("c6", "catastatic", False, "turns", relation="c6", at="P", pair=["x", "y"]),
        about("c6", "scleronomic", True, "timeless"),
        about("c6", "scleronomic", False, "turns", relation="c2", at="P"),
        about("c1", "scleronomic", True, "timeless"),
        about("c7", "scleronomic", True, "timeless"),
        about("c1", "catastatic", False, "turns", relation="c1", at="P"),
    ]
    assert not any(accepted(scene, [claim], **on) for claim in bad)
    assert not accepted(scene, [good[-2]], **parts)
    assert not accepted(scene, [good[-1]], **parts)


def test_a_form_that_does_not_integrate_is_scleronomic_without_t():
    """dz - y dx - dt: its wedge with its derivative, dy ^ dx, has the part dt dx dy, that is not 0."""
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["zdot = y xdot + 1", "zdot = y xdot + t"]}
    point = {"id": "P", "values": {"x": "0", "y": "0", "z": "0", "t": "1"}}
    fields = [
        {"id": "A", "components": {"x": "1", "z": "y"}},
        {"id": "B", "components": {"y": "1"}},
        {"id": "T", "components": {"t": "1", "z": "1"}},
    ]
    apart = about("c1", "holonomic", False, "bracket", at="P", fields=["A", "B", "T"], rows=["c1"], pairs="c1")
    still = about("c1", "scleronomic", True, "timeless")
    alone = {**scene, "constraints": scene["constraints"][:1]}
    parts = {"points": [point], "fields": fields}
    assert accepted(alone, [{**apart, "word": ["A", "B"]}, still], **parts)
    assert not accepted(alone, [still], **parts)
    enters = about("c2", "scleronomic", False, "turns", relation="c2", at="P", pair=["z", "t"])
    assert accepted(scene, [enters], **parts)
    assert not accepted(alone, [{**enters, "path": "/constraints/c1/scleronomic", "relation": "c1"}], **parts)


def test_a_circle_of_velocities_is_not_catastatic():
    scene = {
        "coordinates": ["x", "y"],
        "constraints": ["xdot^2 + ydot^2 = 1", "xdot^2 = ydot^2", "(t - 1) (x - y) = 0"],
    }
    values = {"x": "0", "y": "1", "t": "1", "xdot": "1", "ydot": "0"}
    claim = about("c1", "catastatic", False, "turns", relation="c1", at="P")
    assert accepted(scene, [claim], points=[{"id": "P", "values": values}])
    assert not accepted(scene, [claim], points=[{"id": "P", "values": {**values, "ydot": "1"}}])
    other = about("c2", "catastatic", False, "turns", relation="c2", at="P")
    assert not accepted(scene, [other], points=[{"id": "P", "values": {**values, "ydot": "1"}}])
    assert accepted(scene, [about("c2", "catastatic", True, "timeless")])
    instant = about("c3", "scleronomic", False, "turns", relation="c3", at="P")
    assert not accepted(scene, [instant], points=[{"id": "P", "values": values}])


def test_inequalities_are_not_holonomic():
    scene = {"coordinates": ["x"], "constraints": ["x >= 1", "x = 2"]}
    assert accepted(scene, [about("c1", "holonomic", False, "inequality")])
    assert not accepted(scene, [about("c2", "holonomic", False, "inequality")])
    assert not accepted(scene, [about("c1", "holonomic", True, "finite")])
    assert not accepted(scene, [about("c1", "holonomic", True, "inequality")])


def test_paths_that_no_rule_is_for_and_paths_claimed_twice_fail():
    claim = about("edge", "catastatic", True, "timeless")
    assert len(faults(SKATE, [claim, claim], **ICE)) == 1
    for path in ("/verdict", "/constraints/edge/reason", "/constraints/ghost/catastatic", "/dof/0", "", 7):
        assert not accepted(SKATE, [{**claim, "path": path}], **ICE)
    assert not accepted(SKATE, [{**claim, "rule": "as written"}], **ICE)
