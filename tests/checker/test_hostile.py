"""Certificates and documents made to break the checker: a fault is told, in seconds and without much memory."""

from __future__ import annotations

import json
import random
import time
from collections.abc import Iterable, Iterator
from typing import Any

import pytest
from checker.certified import certificate, document_of, faults
from shared.known_scenes import CATALOG, few, scene_of, spread, stem, strict_report_of, swept
from shared.tampering import put

from dofkit.checker import CheckError, verify
from dofkit.checker.problem import canonical, sha256_of
from dofkit.checker.ring import CheckedRing
from dofkit.checker.trees import Effort
from dofkit.methods.certificates.lowering import document_of_scene

CIRCLE = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1"]}
POINT = {"id": "P", "values": {"x": "1", "y": "0"}}
AT_REST = {"path": "/consistent", "value": True, "rule": "point", "at": "P"}
#: Seconds of processor time for one verification, on a slow machine.
SECONDS = 20.0
PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53)


def fate(scene: Any, given: Any) -> str:
    """``refused``, ``failed`` or ``verified``, in time."""
    start = time.process_time()
    try:
        found = "failed" if verify(scene, given).failed else "verified"
    except CheckError:
        found = "refused"
    assert time.process_time() - start < SECONDS
    return found


#: Texts that cost much, or are none.
TEXTS = {
    "a tower": "9^9^9^9",
    "parentheses": "(" * 5000 + "x" + ")" * 5000,
    "digits": "1" * 10**6,
    "power of ten": "1e999999",
    "a long sum": "+".join(["x*y"] * 5000),
    "a large power": "(x + y + 1)^64",
    "a power of powers": "((x + y + 1)^8)^9",
    "a tower of a root": "(((sqrt(2)^64)^64)^64)^64 + x",
    "a product of large numbers": "1e999*" * 3000 + "x",
    "a sum of fractions": "+".join(f"1/(1e390 + {i})" for i in range(1000)),
    "a long product": "*".join(f"(x + {i}*y + 1)" for i in range(1, 60)),
    "nested roots": "sqrt(" * 50 + "x" + ")" * 50,
    "nested sines": "sin(" * 50 + "x" + ")" * 50,
    "nested exponentials": "exp(exp(exp(exp(9))))",
    "many angles": "sin(64*x)*cos(63*x)*sin(62*x)*cos(61*x)",
    "many quotients": "+".join(f"1/(x + {i}*y)" for i in range(1, 60)),
    "many roots": "*".join(f"(sqrt({p}) + x)" for p in PRIMES),
    "a root of two large primes": f"sqrt({(2**61 - 1) * (2**89 - 1)})",
    "one over roots": "1/(" + "+".join(f"sqrt({p})" for p in PRIMES[:8]) + ")",
    "small parts of an angle": "+".join(f"sin(x/{i})" for i in range(2, 24)),
    "roots of powers": "x^(1/64)*y^(1/63)*(x + y)^(1/61)",
    "one over nothing": "1/0",
    "0 to the 0": "0^0 + 0^x",
    "no number": "nan",
    "no text": "\x00",
    "a letter that looks like x": "\u0445",
}


def places_for(text: str) -> Iterator[Any]:
    """Certificates with a text in every place where one is read."""
    row = {"path": "/dof", "value": 1, "about": "component", "rule": "regular"}
    row |= {"minor": {"at": "P", "rows": ["k"], "columns": ["x"]}}
    refuted = {"path": "/consistent", "value": False, "rule": "nullstellensatz", "step": "k"}
    chosen = {"id": "P", "values": {"x": text.replace("x", "2").replace("y", "3"), "y": "0"}}
    yield certificate(CIRCLE, [AT_REST], points=[chosen])
    squares = {"id": "k", "by": "implied", "function": "1", "c": {"c1": text}, "sos": [["1", text]] * 5}
    yield certificate(CIRCLE, [refuted], relations=[squares])
    for by in ("implied", "integral"):
        step = {"id": "k", "by": by, "text": text, "function": text, "h": text, "c": {"c1": text}}
        yield certificate(CIRCLE, [row], points=[POINT], relations=[step])
    field = {"id": "B", "components": {"x": f"-y*({text})", "y": f"x*({text})"}}
    words = [["A", *["B"] * 11]]
    least = {"rule": "span", "at": "P", "fields": ["A", "B"], "rows": ["c1"], "words": words, "columns": ["x"]}
    most = {"rule": "minor", "minor": {"at": "P", "rows": ["c1"], "columns": ["x"]}}
    squeezed = {**row, "rule": "squeeze", "least": least, "most": most}
    turning = {"id": "A", "components": {"x": "-y", "y": "x"}}
    yield certificate(CIRCLE, [squeezed], points=[POINT], fields=[turning, field])


#: Cases of seconds.
SLOW = ("small parts of an angle", "constraints", "coordinates")


def slow_swept(names: Iterable[str]) -> list[Any]:
    """The names, of which the slow ones wait for the sweep."""
    return [swept(name) if name in SLOW else name for name in names]


@pytest.mark.parametrize("name", spread(slow_swept(TEXTS)))
def test_a_text_costs_little_wherever_it_stands(name: str) -> None:
    for given in places_for(TEXTS[name]):
        assert fate(CIRCLE, given) != "verified"


def nested(depth: int) -> Any:
    found: Any = 0
    for _ in range(depth):
        found = [found]
    return found


STEPS = [{"id": f"k{i}", "by": "implied", "of": f"k{i - 1}" if i else "c1", "c": {"c1": "1"}} for i in range(20_000)]
CYCLE = [{"id": a, "by": "implied", "of": b, "c": {b: "1"}} for a, b in (("a", "b"), ("b", "a"))]
ROW_A = {"path": "/dof", "value": 1, "about": "component", "rule": "regular", "minor": {"at": "P"}}
WIDE = {"at": "P", "rows": ["c1"] * 10**5, "columns": ["x"] * 10**5}
LARGE = {
    "a million claims": ([AT_REST] * 10**6, {"points": [POINT]}),
    "many claims": ([{**AT_REST, "path": f"/constraints/c{i}/exact"} for i in range(20_000)], {"points": [POINT]}),
    "many steps": ([{**ROW_A, "minor": {"at": "P", "rows": ["k0"], "columns": ["z"]}}], {"relations": STEPS}),
    "steps in a circle": ([{**ROW_A, "minor": {"at": "P", "rows": ["a"], "columns": ["x"]}}], {"relations": CYCLE}),
    "points in a circle": ([AT_REST], {"points": [{"id": "P", "values": {"x": "y", "y": "x"}}]}),
    "a minor of 10^5 rows": ([{**ROW_A, "minor": WIDE}], {"points": [POINT]}),
    "a nested value": ([{"path": "/redundant", "value": nested(900), "rule": "cofactors"}], {}),
    "a nested tree": (
        [{"path": "/consistent", "value": False, "rule": "boxes", "variables": {"x": "angle"}, "tree": nested(900)}],
        {},
    ),
    "infinite": ([{"path": "/dof", "value": float("inf"), "rule": "nothing"}], {}),
    "no number": ([{"path": "/dof", "value": float("nan"), "rule": "nothing"}], {}),
}


@pytest.mark.parametrize("name", LARGE)
def test_what_is_large_or_leads_nowhere_is_not_verified(name: str) -> None:
    claims, parts = LARGE[name]
    assert fate(CIRCLE, certificate(CIRCLE, claims, **parts)) != "verified"


NO_CERTIFICATES = {
    "nested lists": '{"certificate": 1, "claims": ' + "[" * 10**5 + "]" * 10**5 + "}",
    "no end": "[" * 10**6,
    "not a number": '{"certificate": NaN}',
    "infinity": '{"certificate": 1, "scene": {"sha256": Infinity}}',
    "a long number": '{"certificate": ' + "9" * 10**5 + "}",
    "no letters": b"\xff\xfe\x00",
    "a list": "[]",
    "true": "true",
    "a number that is too long to be written": {"certificate": 1, "scene": {}, "claims": [{"path": 10**5000}]},
    "what JSON does not know": {"certificate": 1, "scene": {}, "claims": [{"path": {1, 2}}]},
    "another version": '{"certificate": 2, "scene": {}}',
}


def test_roots_of_products_of_large_primes_have_their_price():
    """Each is factored: a tenth of a second."""
    ring, left = CheckedRing(Effort()), Effort().remaining
    ring.root(ring.constant((2**61 - 1) * (2**61 + 15)), 2)
    assert left - ring.effort.remaining > 50_000


@pytest.mark.parametrize("name", NO_CERTIFICATES)
def test_what_is_no_certificate_is_refused(name: str) -> None:
    assert fate(CIRCLE, NO_CERTIFICATES[name]) == "refused"


def _named(text: str, count: int) -> str:
    return ", ".join(text.format(i) for i in range(count))


def _nested(levels: int) -> Any:
    return [_nested(levels - 1)] if levels else []


NO_DOCUMENTS = {
    "lists in lists": {"coordinates": _nested(500)},
    "infinity": {"coordinates": ["x"], "configuration": {"x": float("inf")}},
    "not a number": {"coordinates": ["x"], "configuration": {"x": float("nan")}},
    "a power of ten": {"coordinates": ["x"], "configuration": {"x": "1e999999"}},
    "digits": {"coordinates": ["x"], "configuration": {"x": "9" * 10**6}},
    "a text": "coordinates: [x]",
    "a number": 7,
}


@pytest.mark.parametrize("name", NO_DOCUMENTS)
def test_what_is_no_document_is_refused(name: str) -> None:
    assert fate(NO_DOCUMENTS[name], {"certificate": 1, "scene": {"sha256": "0"}, "claims": []}) == "refused"


LARGE_SCENES = {
    "powers of powers": "parameters: {a0: positive, "
    + ", ".join(f"a{i}: a{i - 1}^64" for i in range(1, 40))
    + "}\ncoordinates: [x]\nconstraints: [x = a39]",
    "powers of large numbers": "parameters: {a0: 1e99, "
    + ", ".join(f"a{i}: a{i - 1}^64" for i in range(1, 40))
    + "}\ncoordinates: [x]\nconstraints: [x = a39]",
    "coordinates": "coordinates: [" + _named("x{}", 50_000) + "]\nconstraints: [x0 = 1]",
    "constraints": "coordinates: [x]\nconstraints: [" + ", ".join(["x = 1"] * 50_000) + "]",
    "distances": "dimension: 2\nparticles: [{0}]\nconstraints: [{{type: rigid, members: [{0}]}}]".format(
        _named("p{}", 1000)
    ),
    "a long name": f"coordinates: [{'a' * 10**5}]\nconstraints: [{'a' * 10**5} = 1]",
    "a word in many ways": f"coordinates: [a, aa, aaa]\nconstraints: [{'a' * 60} = 1]",
    "many dimensions": "dimension: 999999\ncoordinates: [x]\nconstraints: [x = 1]",
    "squares of squares": "parameters: {a0: 3, "
    + ", ".join(f"a{i}: a{i - 1}*a{i - 1}" for i in range(1, 40))
    + "}\ncoordinates: [x]\nconstraints: [x = a39]",
    "sines of sines": "parameters: {a0: real, "
    + ", ".join(f"a{i}: sin(a{i - 1})*a{i - 1}" for i in range(1, 40))
    + "}\ncoordinates: [x]\nconstraints: [x*sin(a39) = a38]",
}


@pytest.mark.parametrize("name", slow_swept(LARGE_SCENES))
def test_a_large_scene_is_read_or_refused_in_time(name: str) -> None:
    claims = [{"path": "/consistent", "value": False, "rule": "nullstellensatz", "step": "k"}]
    try:
        document = document_of(LARGE_SCENES[name])
        given = certificate(
            document, claims, relations=[{"id": "k", "by": "implied", "function": "1", "c": {"c1": "1"}}]
        )
    except CheckError:
        return
    assert fate(document, given) != "verified"


ODD: list[Any] = [
    *(None, True, False, 0, -1, 10**30, 1.5, float("nan"), float("inf"), "", "0", "x", "P0", "c1", "1/0", "9^9^9^9"),
    *("(" * 2000, "1e999999", "\x00", "sqrt(-1)", "a" * 10**5, b"x", (1, 2), {1: 2}, [], {}, [[]], [None], {"": None}),
    *({"id": "P0"}, ["c1"] * 1000, {"c1": "1"}, [["1", "x"]], {"sos": []}, {"number": True}, nested(500), object()),
]


def _places(value: Any, place: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, part in parts:
        yield (*place, key)
        yield from _places(part, (*place, key))


@pytest.mark.parametrize("path", few("odd values", CATALOG, 24), ids=stem)
def test_an_odd_value_in_any_place_is_a_fault_and_no_crash(path: Any) -> None:
    scene, rng = scene_of(path), random.Random(path.stem)
    document = canonical(document_of_scene(scene))
    given = json.loads(json.dumps(strict_report_of(path).certificate))
    inside, outside = list(_places(given)), list(_places(document))
    for _ in range(40):
        fate(document, put(given, rng.choice(inside), rng.choice(ODD)))
    for _ in range(10):
        changed = put(document, rng.choice(outside), rng.choice(ODD))
        try:
            mark = sha256_of(changed)
        except CheckError:
            continue
        fate(changed, {**given, "scene": {"sha256": mark}})


#: A circle and a line that do not meet: 3 + x^2 - (x^2 + y^2 - 1) + (y + 2) (y - 2) = 0.
APART: dict[str, Any] = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1", "y = 2"]}
NEVER: dict[str, Any] = {"path": "/consistent", "value": False, "rule": "nullstellensatz", "step": "k"}
WHY: dict[str, Any] = {"id": "k", "by": "implied", "function": "1", "h": "3", "sos": [["1", "x"]]}
WHY |= {"c": {"c1": "1", "c2": "-(y+2)"}}


@pytest.mark.parametrize(
    "change",
    [
        {"c": {"c1": "(x+y+1)^200", "c2": "(x-y)^200"}},
        {"c": {"c1": "1+" * 5000 + "1"}},
        {"c": {"c1": "(" * 5000 + "1" + ")" * 5000}},
        {"c": {"c1": "sin(" * 500 + "x" + ")" * 500}},
        {"c": {"c1": "((((x+1)^9)^9)^9)^9"}},
        {"c": {"c1": "+".join(f"sin(x/{i})" for i in range(1, 400))}},
        swept({"c": {"c1": "*".join(f"(x+y+{i})" for i in range(1, 1000))}}),
        {"c": [["c1", "1"]]},
        {"c": {"c1": 1}},
        {"c": {"c1": None}},
        {"c": "c1"},
        {"sos": [[]]},
        {"sos": [["1", ["x"]]]},
        {"h": "1e99999"},
        {"h": "1/0"},
        {"h": "x"},
        {"rule": ["nullstellensatz"]},
        {"rule": None},
        {"path": ["/consistent"]},
        {"path": None},
    ],
)
def test_hostile_claims_fail_in_good_time(change: dict[str, Any]):
    claim, step = ({**whole, **{key: change[key] for key in change.keys() & {*whole}}} for whole in (NEVER, WHY))
    assert len(faults(APART, [claim], relations=[step])) == 1


@pytest.mark.sweep
def test_a_certificate_of_an_edited_scene_is_refused():
    good = certificate(APART, [NEVER], relations=[WHY])
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
    measured = {**APART, "tolerance": "1e-3"}
    assert "tolerance" in verify(measured, certificate(measured, [NEVER], relations=[WHY])).failed[0]["why"]
