"""Steps that put in what a relation gives, and relations of their own; broken ones, and what is not so, are refused."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from checker.certified import accepted, faults

from dofkit.checker import CheckError

ORIGIN = {"id": "P", "values": {"x": "0", "y": "0"}}
ON_X = {"id": "m", "at": "P", "rows": ["c1"], "columns": ["x"]}
SINES: dict[str, Any] = {"coordinates": ["x", "y"], "constraints": ["x = y", "sin(x) = sin(y)"]}
PUT = {"id": "k", "by": "implied", "of": "c2", "c": {}, "put": [["c1", "x"]]}
ONE = {"path": "/dof", "value": 1, "about": "component", "rule": "regular", "minor": "m"}


def plane(*constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": ["x", "y"], "constraints": list(constraints), **more}


def test_a_relation_follows_where_a_coordinate_is_put_in() -> None:
    # sin(x) - sin(y) is no multiple of x - y that a text of the grammar writes, and is 0 at x = y
    assert faults(SINES, [ONE], points=[ORIGIN], minors=[ON_X], relations=[PUT]) == {}


def test_coordinates_are_put_in_one_after_another() -> None:
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["x = y", "y = z", "exp(x) = exp(z)"]}
    step = {**PUT, "of": "c3", "put": [["c1", "x"], ["c2", "y"]]}
    point = {"id": "P", "values": {"x": "0", "y": "0", "z": "0"}}
    minor = {**ON_X, "rows": ["c1", "c2"], "columns": ["x", "y"]}
    assert accepted(scene, [ONE], points=[point], minors=[minor], relations=[step])
    for put in ([["c1", "x"]], [["c2", "y"]], []):
        assert not accepted(scene, [ONE], points=[point], minors=[minor], relations=[{**step, "put": put}])


@pytest.mark.parametrize(
    ("parameters", "shown"), [({"a": "nonzero"}, True), ({"a": "positive"}, True), ({"a": "real"}, False)]
)
def test_a_factor_of_what_is_given_is_nowhere_zero(parameters: dict[str, str], shown: bool) -> None:
    # with a = 0 the first relation says nothing of x
    scene = plane("a x = a y", "sin(x) = sin(y)", parameters=parameters)
    point = {"id": "P", "values": {"x": "0", "y": "0", "a": "1"}}
    assert accepted(scene, [ONE], points=[point], minors=[ON_X], relations=[PUT]) is shown


@pytest.mark.parametrize(
    "put",
    [
        [["c1", "t"]],
        [["c1", "xdot"]],
        [["c2", "x"]],
        [["c3", "x"]],
        [["c1"]],
        [["c1", "x", "y"]],
        ["c1"],
        "c1",
        [["k", "x"]],
        {"c1": "x"},
    ],
)
def test_a_broken_substitution_is_refused(put: Any) -> None:
    assert not accepted(SINES, [ONE], points=[ORIGIN], minors=[ON_X], relations=[{**PUT, "put": put}])


def test_the_integral_of_a_form_beside_a_relation() -> None:
    # with s = a the form dx - sin(s) dy integrates to x - sin(a) y
    scene = {
        **{"coordinates": ["x", "y", "s"], "parameters": ["a"]},
        "constraints": [{"name": "w", "text": "dx = sin(s) dy"}, {"name": "g", "text": "s = a"}],
    }
    put = {"put": [["g", "s"]]}
    steps = [
        {"id": "f", "by": "integral", "function": "x - sin(a)*y", "c": {"w": "1"}, **put},
        {"id": "r", "by": "rate", "of": "f"},
        {"id": "i", "by": "implied", "of": "w", "c": {"r": "1"}, **put},
    ]
    point = {"id": "P", "values": {"x": "0", "y": "0", "s": "1", "a": "1"}}
    claim = {"path": "/constraints/w/integral", "value": "x - sin(a)*y = C", "rule": "integral", "at": "P", "step": "f"}
    assert faults(scene, [claim], points=[point], relations=steps) == {}
    alone = {"path": "/constraints/w/holonomic_alone", "value": True, "rule": "integral", "at": "P", "integrals": ["f"]}
    assert not accepted(scene, [alone], points=[point], relations=steps)
    for place, change in ((0, {"function": "x - sin(s)*y"}), (0, {"put": []}), (2, {"put": []}), (0, {"c": {}})):
        broken = [{**one, **change} if i == place else one for i, one in enumerate(steps)]
        assert not accepted(scene, [claim], points=[point], relations=broken)
    still = {**scene, "constraints": [scene["constraints"][0], {"name": "g", "text": "s = a + t"}]}
    assert not accepted(still, [claim], points=[{**point, "values": {**point["values"], "t": "0"}}], relations=steps)


def test_a_relation_of_its_own_follows_from_others() -> None:
    # y (1 + z^2) = (y + z x) + z (y z - x), and the same for x: both are 0
    scene = {"coordinates": ["x", "y", "z"], "constraints": ["y + z*x = 0", "y*z - x = 0", "sin(x)*exp(y) = 0"]}
    own = {"by": "implied", "h": "1 + z^2"}
    steps = [
        {"id": "x0", **own, "function": "x", "c": {"c1": "z", "c2": "-1"}},
        {"id": "y0", **own, "function": "y", "c": {"c1": "1", "c2": "z"}},
        {"id": "k", "by": "implied", "of": "c3", "c": {}, "put": [["x0", "x"], ["y0", "y"]]},
    ]
    parts: dict[str, Any] = {
        "points": [{"id": "P", "values": {"x": "0", "y": "0", "z": "0"}}],
        "minors": [{**ON_X, "rows": ["c1", "c2"], "columns": ["x", "y"]}],
    }
    assert faults(scene, [ONE], relations=steps, **parts) == {}
    for place, change in (
        (0, {"function": "y"}),
        (0, {"h": "1"}),
        (0, {"h": "0", "c": {}}),
        (0, {"id": "c1"}),
        (0, {"c": {"c1": "z"}}),
        (2, {"put": [["y0", "y"]]}),
        (2, {"of": "x0"}),
    ):
        broken = [{**one, **change} if i == place else one for i, one in enumerate(steps)]
        assert not accepted(scene, [ONE], relations=broken, **parts)


def _dof(value: int, *rows: str) -> dict[str, Any]:
    return {**ONE, "value": value, "minor": {"at": "P", "rows": list(rows), "columns": ["x", "y"][: len(rows)]}}


#: What is not so: the truth of each is by hand.
ATTACKS: Mapping[str, tuple[dict[str, Any], list[dict[str, Any]], dict[str, Any]]] = {
    # x = 0 leaves y free; the factor x is 0 there
    "a relation of its own with a factor 0": (
        plane("x = 0", "x*y = 0"),
        [_dof(0, "c1", "k")],
        {"relations": [{"id": "k", "by": "implied", "function": "y", "h": "x", "c": {"c2": "1"}}]},
    ),
    # the second relation has no value at x = 0: nothing meets both
    "a logarithm that is put away": (
        plane("x = 0", "x*log(x) = 0"),
        [{**ONE, "path": "/consistent", "value": True}],
        {"relations": [PUT]},
    ),
    # x y = 0 gives x only where y is not 0
    "a factor that may be 0": (plane("y*x = 0", "x = 0"), [{**ONE, "value": 1}], {"relations": [PUT]}),
    # two values of x meet the first
    "a square": (plane("x^2 = y^2 + x - y", "sin(x) = sin(y)"), [ONE], {"relations": [PUT]}),
    # x = 1 is allowed: the inequality does not give x
    "an inequality": (
        plane("x >= 0", "x = 1"),
        [
            {
                "path": "/consistent",
                "value": False,
                "rule": "nullstellensatz",
                "number": "1",
                "c": {"c2": "1", "k": "-1"},
            }
        ],
        {"relations": [{"id": "k", "by": "implied", "function": "x", "c": {}, "put": [["c1", "x"]]}]},
    ),
    # y keeps its value, which is 1
    "an integral": (
        plane("dy = 0", "y = 1"),
        [
            {
                "path": "/consistent",
                "value": False,
                "rule": "nullstellensatz",
                "number": "1",
                "c": {"c2": "1", "k": "-1"},
            }
        ],
        {
            "relations": [
                {"id": "f", "by": "integral", "function": "y", "c": {"c1": "1"}},
                {"id": "k", "by": "implied", "function": "y", "c": {}, "put": [["f", "y"]]},
            ]
        },
    ),
    # both x = 0 and y = 0 may go: the third says it all
    "what depends where the others are put in": (
        plane("x = 0", "y = 0", "x^2 + y^2 = 0"),
        [{"path": "/redundant", "value": ["c3"], "rule": "cofactors", "minor": _dof(0, "c1", "c2")["minor"]}],
        {"relations": [{**PUT, "of": "c3", "put": [["c1", "x"], ["c2", "y"]]}]},
    ),
    # a function keeps its value; that it is 0 is another matter
    "an integral of a relation": (
        plane("dx = dy", "x = y"),
        [{**ONE, "path": "/velocity_dof", "value": 1, "minor": {"at": "P", "rows": ["c1"], "columns": ["x"]}}],
        {"relations": [{"id": "k", "by": "integral", "of": "c2", "c": {"c1": "1"}}]},
    ),
}


@pytest.mark.parametrize("name", ATTACKS)
def test_what_is_not_so_is_not_shown(name: str) -> None:
    document, claims, parts = ATTACKS[name]
    try:
        assert claims[-1]["path"] in faults(document, claims, **{"points": [ORIGIN], "minors": [ON_X], **parts})
    except CheckError:
        pytest.fail("the certificate is of the right form")


SEVEN: dict[str, Any] = {
    "coordinates": ["a", "b", "c", "d", "e", "f", "g"],
    "constraints": ["a = b = c = 0", "d = e = f = 0", "g = a + d = b + e = 0"],
}


def _without(scene: Mapping[str, Any], surplus: int, *more: dict[str, Any]) -> dict[str, str]:
    """Seven rows are independent, of nine: any two of the constraints have six rows, which are independent."""
    six = {"c1": "degabf", "c2": "abcgde", "c3": "abcdef"}
    rows = {name: [f"{other}.{i}" for other in six if other != name for i in (1, 2, 3)] for name in six}
    point = {"id": "P", "values": dict.fromkeys(scene["coordinates"], "0")}
    minors = [{"id": name, "at": "P", "rows": rows[name], "columns": list(six[name])} for name in six]
    whole = {"id": "m", "at": "P", "rows": [*rows["c3"], "c3.1"], "columns": list("abcdefg")}
    steps = [
        {"id": "k", "by": "implied", "of": "c3.3", "c": {"c1.2": "1", "c1.3": "1", "c2.2": "1", "c2.3": "1"}},
        {"id": "l", "by": "implied", "of": "c3.2", "c": {"c1.1": "1", "c2.1": "1"}},
    ]
    claims = [
        {**ONE, "value": 0},
        {"path": "/velocity_dof", "value": 0, "rule": "count"},
        *more,
        {"path": "/redundant_equations", "value": surplus, "rule": "count"},
        {"path": "/redundancies", "value": [{"nullity": surplus, "members": ["c1", "c2", "c3"]}], "rule": "count"},
    ]
    return faults(scene, claims, points=[point], minors=[*minors, whole], relations=steps)


NONE_CAN_GO = {"path": "/redundant", "value": [], "rule": "cofactors", "without": {f"c{i}": f"c{i}" for i in (1, 2, 3)}}


def test_all_depend_on_each_other_where_without_any_one_nothing_does() -> None:
    assert _without(SEVEN, 2, NONE_CAN_GO) == {}
    assert _without(SEVEN, 2).keys() == {"/redundancies"}
    assert "/redundancies" in _without(SEVEN, 2, {**NONE_CAN_GO, "without": {"c1": "c1", "c2": "c2"}})
    assert "/redundancies" in _without(SEVEN, 1, NONE_CAN_GO)


def test_two_groups_are_not_one() -> None:
    # x is told twice, and y
    scene = {"coordinates": ["x", "y"], "constraints": ["x = 0", "2 x = 0", "y = 0", "2 y = 0"]}
    names = ["c1", "c2", "c3", "c4"]
    minors = {
        name: {"at": "P", "rows": [other for other in names if other != name][:2], "columns": ["x", "y"]}
        for name in names
    }
    steps = [{"id": f"k{i}", "by": "implied", "of": f"c{i}", "c": {f"c{i - 1}": "2"}} for i in (2, 4)]
    claims = [
        {**_dof(0, "c1", "c3")},
        {"path": "/velocity_dof", "value": 0, "rule": "count"},
        {"path": "/redundant", "value": [], "rule": "cofactors", "without": minors},
        {"path": "/redundant_equations", "value": 2, "rule": "count"},
        {"path": "/redundancies", "value": [{"nullity": 2, "members": names}], "rule": "count"},
    ]
    assert faults(scene, claims, points=[ORIGIN], relations=steps).keys() == {"/redundant", "/redundancies"}
