"""Claims about contradictions, circuits and what is redundant, and broken ones that must fail."""

from __future__ import annotations

from typing import Any

import pytest
from checker.certified import accepted, branch, certificate, faults, squares

from dofkit.checker.trees import CheckError
from dofkit.checker.verification import verify

APART: dict[str, Any] = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1", "y = 2"]}
FAR = {"rule": "nullstellensatz", "c": {"c1": "-1", "c2": "y+2"}, "number": "3", "sos": [["1", "x"]]}
NEVER = {"path": "/consistent", "value": False, **FAR}
EACH = [{"id": "P", "values": {"x": "1", "y": "0"}}, {"id": "Q", "values": {"x": "1", "y": "2"}}]
CONFLICT = {
    **{"path": "/conflicting", "value": ["c1", "c2"], "rule": "conflict", "refutation": FAR},
    "minimal": {"c1": {"rule": "point", "at": "Q"}, "c2": {"rule": "point", "at": "P"}},
}


def test_a_circle_and_a_line_that_do_not_meet():
    assert faults(APART, [NEVER, CONFLICT], points=EACH) == {}


@pytest.mark.parametrize(
    "change",
    [
        {"number": "2"},
        {"number": "-3"},
        {"number": "0", "c": {}, "sos": []},
        {"sos": [["-1", "x"]]},
        {"sos": []},
        {"c": {"c1": "-1", "c2": "y-2"}},
        {"c": {"c1": "-1/x", "c2": "y+2"}},
        {"c": {"c3": "1"}},
        {"value": True},
        {"c": {}, "number": "-x^2 - 1", "sos": [["1", "x"]]},
    ],
)
def test_a_broken_contradiction_is_refused(change: dict[str, Any]):
    assert not accepted(APART, [{**NEVER, **change}], points=EACH)


@pytest.mark.parametrize(
    "change",
    [
        {"value": ["c1"]},
        {"value": ["c1", "c2", "c3"]},
        {"value": ["c1", "c1", "c2"]},
        {"value": []},
        {"minimal": {"c1": {"rule": "point", "at": "P"}, "c2": {"rule": "point", "at": "Q"}}},
        {"minimal": {"c1": {"rule": "point", "at": "Q"}}},
        {"refutation": {**FAR, "number": "1"}},
    ],
)
def test_a_broken_conflict_is_refused(change: dict[str, Any]):
    assert not accepted(APART, [{**CONFLICT, **change}], points=EACH)


def test_a_conflict_holds_no_bystanders():
    scene = {**APART, "constraints": [*APART["constraints"], "x = x^3"]}
    points = [*EACH, {"id": "R", "values": {"x": "0", "y": "0"}}]
    assert accepted(scene, [CONFLICT], points=points)
    more = {
        **CONFLICT,
        "value": ["c1", "c2", "c3"],
        "minimal": {**CONFLICT["minimal"], "c3": {"rule": "point", "at": "R"}},
    }
    assert not accepted(scene, [more], points=points)


def test_lengths_that_do_not_close():
    link = {"type": "link"}
    scene = {
        "dimension": 2,
        "particles": ["A", "B", "C"],
        "constraints": [
            {**link, "between": ["A", "B"], "length": "1"},
            {**link, "between": ["B", "C"], "length": "1"},
            {**link, "between": ["A", "C"], "length": "sqrt(5)"},
        ],
    }
    claim = {
        **{"path": "/consistent", "value": False, "rule": "nullstellensatz", "number": "1"},
        **{"c": {"c3": "1", "c1": "-2", "c2": "-2"}, "sos": [["1", f"{q}_A - 2*{q}_B + {q}_C"] for q in "xy"]},
    }
    assert faults(scene, [claim]) == {}
    for broken in (
        {"number": "2"},
        {"c": {"c3": "1", "c1": "-2"}},
        {"c": {"c3": "-1", "c1": "2", "c2": "2"}},
        {"sos": claim["sos"][:1]},
        {"sos": [["1", f"{q}_A + 2*{q}_B + {q}_C"] for q in "xy"]},
        {"sos": []},
    ):
        assert not accepted(scene, [{**claim, **broken}])
    closes = {**scene, "constraints": [*scene["constraints"][:2], {**link, "between": ["A", "C"], "length": "2"}]}
    assert not accepted(closes, [claim])
    assert not accepted(closes, [{**claim, "number": "0"}])


COPIES: dict[str, Any] = {"coordinates": ["x", "y", "z"], "constraints": ["x = y", "y = z", "x + y = 2 z", "z = x^2"]}
ORIGIN = {"id": "O", "values": {"x": "0", "y": "0", "z": "0"}}
TWICE = {"id": "i", "by": "implied", "of": "c3", "c": {"c1": "1", "c2": "2"}}
ROWS = {"id": "m", "at": "O", "rows": ["c1", "c2", "c4"], "columns": ["x", "y", "z"]}
PARTS: dict[str, Any] = {
    "points": [
        ORIGIN,
        {"id": "A", "values": {"x": "1", "y": "0", "z": "0"}},
        {"id": "B", "values": {"x": "1", "y": "1", "z": "0"}},
    ],
    "relations": [TWICE],
    "minors": [ROWS],
}
CIRCUIT = {
    **{"path": "/constraints/c3/circuit", "value": ["c1", "c2"], "rule": "cofactors", "at": "O"},
    "minimal": {
        "c1": {"minor": {"at": "O", "rows": ["c2", "c3"], "columns": ["y", "z"]}},
        "c2": {"minor": {"at": "O", "rows": ["c1", "c3"], "columns": ["x", "y"]}},
    },
}


def test_a_circuit():
    assert faults(COPIES, [CIRCUIT], **PARTS) == {}


@pytest.mark.parametrize(
    "change",
    [
        {"value": ["c1"]},
        {"value": ["c1", "c4"]},
        {"value": ["c1", "c2", "c4"]},
        {"value": []},
        {"path": "/constraints/c2/circuit"},
        {"path": "/constraints/c4/circuit"},
        {"at": "A"},
        {"minimal": {"c1": CIRCUIT["minimal"]["c2"], "c2": CIRCUIT["minimal"]["c1"]}},
        {"minimal": {"c1": CIRCUIT["minimal"]["c1"]}},
        {"minimal": {**CIRCUIT["minimal"], "c1": {"at": "A"}}},
        {"minimal": {**CIRCUIT["minimal"], "c1": {"minor": {"at": "O", "rows": ["c2"], "columns": ["y"]}}}},
        {"minimal": {**CIRCUIT["minimal"], "c1": {"minor": {"at": "O", "rows": ["c3"], "columns": ["z"]}}}},
    ],
)
def test_a_broken_circuit_is_refused(change: dict[str, Any]):
    assert not accepted(COPIES, [{**CIRCUIT, **change}], **PARTS)


def test_what_is_redundant():
    claim = {"path": "/redundant", "value": ["c3"], "rule": "cofactors", "minor": "m"}
    rows = [
        {"path": f"/constraints/c{i}/independent", "value": k, "rule": "independent", "minor": "m"}
        for i, k in ((1, 1), (2, 1), (3, 0), (4, 1))
    ]
    assert faults(COPIES, [claim, *rows], **PARTS) == {}
    for value in ([], ["c1"], ["c4"], ["c3", "c4"], ["c3", "c3"], ["c5"]):
        assert not accepted(COPIES, [{**claim, "value": value}], **PARTS)
    assert len(faults(COPIES, [{**one, "value": 1 - one["value"]} for one in rows], **PARTS)) == 4
    assert not accepted(COPIES, [claim], **{**PARTS, "relations": []})
    wrong = {**TWICE, "c": {"c1": "1", "c2": "1"}}
    assert not accepted(COPIES, [claim], **{**PARTS, "relations": [wrong]})


def test_no_more_is_called_redundant_than_a_degenerate_relation_allows():
    scene = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 0", "x = 0", "y = 0"]}
    parts = {
        "points": [{"id": "O", "values": {"x": "0", "y": "0"}}],
        "minors": [{"id": "m", "at": "O", "rows": ["c2", "c3"], "columns": ["x", "y"]}],
        "relations": [{"id": "i", "by": "implied", "of": "c1", "c": {"c2": "x", "c3": "y"}}],
    }
    claim = {"path": "/redundant", "value": ["c1"], "rule": "cofactors", "minor": "m"}
    assert not accepted(scene, [claim], **parts)


def test_squares_products_and_powers():
    scene = {"coordinates": ["x", "y"], "constraints": ["(x-y)^2 + 2*(x-1)^2 = 0", "(x-1)*(y+5) = 0", "(y-1)^3 = 0"]}
    terms = [["1", "x-y"], ["2", "x-1"]]
    good = [
        squares("s", "c1", terms),
        branch("b", "c2", ["x-1", "y+5"], 0),
        branch("p", "c3", ["y-1"], 0, power=3),
        [{"id": "i", "by": "implied", "of": "p", "c": {"s.1": "-1", "s.2": "1"}}],
        [{"id": "j", "by": "implied", "of": "b", "c": {"s.2": "1"}}],
    ]
    parts = {
        "points": [{"id": "P", "values": {"x": "1", "y": "1"}}],
        "minors": [{"id": "m", "at": "P", "rows": ["s.1", "s.2"], "columns": ["x", "y"]}],
    }
    claim = {"path": "/dof", "value": 0, "rule": "regular", "minor": "m", "about": "component"}
    steps = [one for part in good for one in part]
    assert faults(scene, [claim], **parts, relations=steps) == {}
    for i in range(len(steps)):
        assert not accepted(scene, [claim], **parts, relations=steps[:i] + steps[i + 1 :]), steps[i]
    for i, broken in (
        (0, squares("s", "c1", [["1", "x-y"], ["1", "x-1"]])),
        (0, squares("s", "c1", [["1", "x-y"], ["-2", "x-1"]])),
        (0, [{**one, "power": 1} for one in good[0]]),
        (0, [{**one, "sos": []} for one in good[0]]),
        (1, branch("b", "c2", ["x-1", "y+5"], 1)),
        (1, branch("b", "c2", ["x-1", "y-5"], 0)),
        (2, branch("p", "c3", ["y-1"], 0, power=2)),
        (2, branch("p", "c3", ["y+1"], 0, power=3)),
        *((2, [{**good[2][0], "power": power}, good[2][1]]) for power in (0, -1, 65, "3", 3.0, True, None)),
        (3, [{**good[3][0], "c": {"s.1": "1", "s.2": "1"}}]),
    ):
        steps = [one for j, part in enumerate(good) for one in (broken if j == i else part)]
        assert not accepted(scene, [claim], **parts, relations=steps), broken


@pytest.mark.parametrize(
    ("function", "change", "shown"),
    [
        ("x", {"sos": [["1", "y"]]}, True),
        ("x", {"sos": [["1", "y"]], "power": 1}, False),
        ("x", {"sos": [["1", "y"]], "power": 3}, False),
        ("x", {"sos": [["1", "y"]], "h": "-1"}, False),
        ("x", {"sos": [["1", "y"]], "h": "x^2 + 1"}, False),
        ("x", {"sos": [["-1", "y"]]}, False),
        ("x", {"sos": [["1", "sqrt(x)"]]}, False),
        ("y", {"sos": [["1", "y"]]}, False),
        ("x", {}, False),
    ],
)
def test_a_term_of_a_sum_of_squares(function: str, change: dict[str, Any], shown: bool):
    scene = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 0"]}
    step = {"id": "k", "by": "implied", "function": function, "power": 2, "c": {"c1": "1"}, **change}
    never = {
        "path": "/consistent",
        "value": False,
        "rule": "nullstellensatz",
        "number": "1",
        "c": {"k": "1", "c2": "-1"},
    }
    apart = {**scene, "constraints": [*scene["constraints"], "x = -1"]}
    assert accepted(apart, [never], relations=[step]) is shown


def test_an_indefinite_sum_of_squares_is_none():
    scene = {"coordinates": ["x", "y"], "constraints": ["x^2 - y^2 = 0"]}
    steps = squares("s", "c1", [["1", "x"], ["-1", "y"]])
    minor = {"id": "m", "at": "P", "rows": ["s.1", "s.2"], "columns": ["x", "y"]}
    claim = {"path": "/dof", "value": 0, "rule": "regular", "minor": "m", "about": "component"}
    points = [{"id": "P", "values": {"x": "0", "y": "0"}}]
    assert not accepted(scene, [claim], points=points, minors=[minor], relations=steps)


@pytest.mark.parametrize(
    ("text", "change", "shown"),
    [
        ("2 x^2 + y^2 = 0", {"h": "2"}, True),
        ("x^4 + y^2 = 0", {"power": 4}, True),
        ("a x^2 + y^2 = 0", {"h": "a"}, False),
        ("x^3 + y^2 = 0", {"power": 3}, False),
        ("x + y^2 = 0", {"power": 1}, False),
        ("y^2 - x^2 = 0", {"h": "-1"}, False),
        ("(y^2 + 2 x)*x^2 + y^2 = 0", {"h": "y^2 + 2*x"}, False),
    ],
)
def test_a_sum_is_zero_with_its_terms_where_none_is_negative(text: str, change: dict[str, Any], shown: bool):
    # x = -1 meets the second relation beside each of the last five, with a = -1
    scene = {"coordinates": ["x", "y"], "parameters": {"a": "nonzero"}, "constraints": [text, "x = -1"]}
    step = {"id": "k", "by": "implied", "function": "x", "power": 2, "sos": [["1", "y"]], "c": {"c1": "1"}, **change}
    never = {
        "path": "/consistent",
        "value": False,
        "rule": "nullstellensatz",
        "number": "1",
        "c": {"k": "1", "c2": "-1"},
    }
    assert accepted(scene, [never], relations=[step]) is shown


@pytest.mark.sweep
def test_a_certificate_of_an_edited_scene_is_refused():
    good = certificate(APART, [NEVER])
    assert verify(APART, good).verified == 1
    with pytest.raises(CheckError):
        verify({**APART, "constraints": ["x^2 + y^2 = 1", "y = 1"]}, good)
    for broken in (
        {**good, "certificate": 2},
        {**good, "more": 1},
        {**good, "claims": {}},
        {**good, "scene": {}},
        "[",
        "[" * 10**6,
        "1",
    ):
        with pytest.raises(CheckError):
            verify(APART, broken)
    with pytest.raises(CheckError):
        verify(APART, {**good, "claims": [NEVER] * 10**6})
    with pytest.raises(CheckError):
        verify({**APART, "tolerance": "1e-3"}, certificate({**APART, "tolerance": "1e-3"}, [NEVER]))


@pytest.mark.parametrize(
    "claim",
    [
        {"c": {"c1": "(x+y+1)^200", "c2": "(x-y)^200"}},
        {"c": {"c1": "1+" * 5000 + "1"}},
        {"c": {"c1": "(" * 5000 + "1" + ")" * 5000}},
        {"c": {"c1": "sin(" * 500 + "x" + ")" * 500}},
        {"c": {"c1": "((((x+1)^9)^9)^9)^9"}},
        {"c": {"c1": "+".join(f"sin(x/{i})" for i in range(1, 400))}},
        {"c": {"c1": "*".join(f"(x+y+{i})" for i in range(1, 1000))}},
        {"c": [["c1", "1"]]},
        {"c": {"c1": 1}},
        {"c": {"c1": None}},
        {"c": "c1"},
        {"sos": [[]]},
        {"sos": [["1", ["x"]]]},
        {"number": "1e99999"},
        {"number": "1/0"},
        {"number": "x"},
        {"rule": ["nullstellensatz"]},
        {"rule": None},
        {"path": ["/consistent"]},
        {"path": None},
    ],
)
def test_hostile_claims_fail_in_good_time(claim: dict[str, Any]):
    assert len(faults(APART, [{**NEVER, **claim}, CONFLICT], points=EACH)) == 1
