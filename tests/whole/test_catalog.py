"""Every scene of the catalog and of the tests says what its report must hold; every bad one what a person is told."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from contextlib import redirect_stderr, redirect_stdout
from functools import cache
from itertools import combinations, count, islice
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import CATALOG, EVERY, ROOT, SCENES, report_of, scene_of, stem

import dofkit
import dofkit.base.documents
import dofkit.scene.lowering
from dofkit.base.errors import SceneError
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.ring.program import gradient, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import Expr, parameter
from dofkit.interface import cli
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.constraints import TYPES
from dofkit.scene.scene import Scene

BAD = ROOT / "tests/scenes/bad"
#: Keys of `expect` whose lists are sets of names.
NAMES = ("redundant", "conflicting", "infeasible", "generalized_coordinates")
ENTRY_NAMES = ("circuit",)
#: Points at which two integrals are compared.
POINTS = 3


@cache
def document(path: Path) -> dict[str, Any]:
    """The scene's mapping as written, through the same reader as ever."""
    return dict(scene_of(path).model_dump(mode="json", exclude_unset=True))


# What is expected against what is told


def differences(scene: Scene, expect: Mapping[str, Any], report: Report) -> list[str]:
    """Every field of ``expect`` that the report does not hold, as a line."""
    told = report.model_dump(mode="json")
    lines = []
    for key, wanted in expect.items():
        if key == "constraints":
            lines += entry_differences(scene, wanted, report)
        elif not agrees(key, wanted, told[key]):
            lines.append(f"{key}: {wanted} expected, {told[key]} told")
    return lines


def agrees(key: str, wanted: Any, found: Any) -> bool:
    if wanted is None or found is None:
        return wanted is found
    if key in NAMES:
        return sorted(wanted) == sorted(found)
    if key == "count":
        return all(found[part] == value for part, value in wanted.items())
    if key == "redundancies":
        return nullities(wanted) == nullities(found) and all(group_is_told(group, found) for group in wanted)
    if key == "forces":
        return sorted(names_of(wanted)) == sorted(names_of(found))
    return bool(wanted == found)


def nullities(groups: list[dict[str, Any]]) -> list[int]:
    return sorted(group["nullity"] for group in groups)


def group_is_told(group: Mapping[str, Any], found: list[dict[str, Any]]) -> bool:
    """Where a group's members are expected, they are those of some group."""
    return "members" not in group or any(sorted(group["members"]) == sorted(other["members"]) for other in found)


def names_of(forces: list[Any]) -> list[str]:
    return [force if isinstance(force, str) else force["name"] for force in forces]


def entry_differences(scene: Scene, expect: Mapping[str, Mapping[str, Any]], report: Report) -> list[str]:
    entries = {entry.name: entry for entry in report.constraints}
    lines = [f"there is no constraint {name}" for name in expect if name not in entries]
    for name, fields in expect.items():
        if name in entries:
            lines += [
                f"{name}: {key}: {wanted} expected, {getattr(entries[name], key)} told"
                for key, wanted in fields.items()
                if not entry_agrees(scene, key, wanted, entries[name])
            ]
    return lines


def entry_agrees(scene: Scene, key: str, wanted: Any, entry: ConstraintEntry) -> bool:
    found = getattr(entry, key)
    if wanted is None or found is None:
        return wanted is found
    if key == "integral":
        return same_family(scene, wanted, found)
    if key in ENTRY_NAMES:
        return sorted(wanted) == sorted(found)
    return bool(wanted == found)


# Integrals: f = C and g = C are one family of surfaces where df and dg are proportional


def same_family(scene: Scene, one: str, other: str) -> bool:
    names = names_in(scene)
    functions = [level(text, names) for text in (one, other)]
    ring = Ring(functions)
    nodes = [ring.node(f) for f in functions]
    points = list(islice(points_of(ring), POINTS))
    return all(proportional(*(slopes(ring, node, point) for node in nodes)) for point in points)


def names_in(scene: Scene) -> Names:
    """What an integral may mention; a parameter with a value is that value."""
    system = dofkit.scene.lowering.lower(scene)
    known: dict[str, Expr] = {}
    for name, value in scene.parameters.items():
        held = name in system.parameters
        known[name] = parameter(name) if held else parse_expression(str(value), Names(parameters=dict(known)))
    return Names(
        coordinates=frozenset(q.name for q in system.coordinates),
        parameters=known,
        functions=dict(system.functions),
        arguments=dict(scene.functions),
    )


def level(text: str, names: Names) -> Expr:
    """f of the text ``f = C``."""
    left, equals, right = text.partition("=")
    assert equals, text
    assert right.strip() not in names.coordinates, text
    return parse_expression(left, names)


def points_of(ring: Ring) -> Any:
    """Random points where everything has a value."""
    for seed in count():
        point = field_point([ring], seed)
        try:
            values(ring, point)
        except NoValueError:
            continue
        yield point


def slopes(ring: Ring, node: int, point: FieldPoint) -> dict[int, Any]:
    """The gradient by coordinates and time."""
    at = values(ring, point)
    moving = {var.index for var in ring.vars if var.kind == "symbol" and var.key.args[0] in ("coordinate", "time")}
    found = gradient(ring, at, point, [(node, at[node] * 0 + 1)])
    return {index: value for index, value in found.items() if index in moving and value != 0}


def proportional(a: dict[int, Any], b: dict[int, Any]) -> bool:
    return bool(a) and a.keys() == b.keys() and all(a[i] * b[j] == a[j] * b[i] for i, j in combinations(a, 2))


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("x*y = C", "2 x y + 3 = C", True),
        ("x*y = C", "log(x) + log(y) = C", True),
        ("y/x = C", "x/y = C", True),
        ("y/x = C", "atan(y/x) = C", True),
        ("x - v t = C", "(v t - x)^3 = C", True),
        ("x - v t = C", "x = C", False),
        ("x*y = C", "x + y = C", False),
        ("x*y = C", "3 = C", False),
        ("x = C", "y = C", False),
    ],
)
def test_integrals_are_compared_as_families(one: str, other: str, same: bool) -> None:
    scene = dofkit.load({"coordinates": ["x", "y"], "parameters": {"v": "positive"}})
    assert same_family(scene, one, other) is same


# The scenes


@pytest.mark.parametrize("path", EVERY, ids=stem)
def test_the_report_holds_what_the_scene_expects(path: Path) -> None:
    scene = scene_of(path)
    assert scene.expect
    assert differences(scene, scene.expect, report_of(path)) == []


def test_names_are_files_and_unique() -> None:
    names = [path.stem for path in CATALOG]
    assert len(set(names)) == len(names)
    assert sorted(dofkit.catalog_names()) == sorted(names)
    assert [path for path in SCENES if scene_of(path).name != path.stem] == []


@pytest.mark.parametrize("key", ["title", "source", "expect"])
def test_every_catalog_scene_tells_where_it_is_from(key: str) -> None:
    assert [path.stem for path in CATALOG if not document(path).get(key)] == []


def test_every_constraint_type_has_a_scene_whose_answers_are_known() -> None:
    """Of the catalog or of textbooks."""
    seen = {constraint.type for path in SCENES for constraint in scene_of(path).constraints}
    assert sorted(TYPES.keys() - seen) == []


@pytest.mark.parametrize(
    "wrong",
    [
        {"dof": 2},
        {"dof": None},
        {"redundant": ["c1"]},
        {"redundancies": [{"nullity": 1}]},
        {"count": {"coordinates": 3}},
        {"forces": ["spring"]},
        {"constraints": {"c1": {"exact": True}}},
        {"constraints": {"c1": {"integral": "x y = C"}}},
        {"constraints": {"c1": {"integral": None}}},
        {"constraints": {"c2": {}}},
    ],
)
def test_a_wrong_expectation_is_noticed(wrong: dict[str, Any]) -> None:
    scene = dofkit.load(ROOT / "tests/scenes/textbook/form-x-dy-minus-y-dx.yaml")
    report = dofkit.classify(scene)
    assert differences(scene, wrong, report)
    assert not differences(scene, {"dof": 1, "redundant": [], "constraints": {"c1": {"integral": "x/y = C"}}}, report)


# What is no scene

EXPECTED: dict[str, Any] = dofkit.base.documents.read_document((BAD / "expected.yaml").read_bytes(), "expected").value


def test_every_bad_file_says_what_is_told() -> None:
    assert sorted(EXPECTED) == sorted(path.name for path in BAD.iterdir() if path.name != "expected.yaml")


@pytest.mark.parametrize("name", EXPECTED)
def test_a_bad_file_is_told_where_and_why(name: str) -> None:
    with pytest.raises(SceneError) as caught:
        dofkit.load(BAD / name)
    wanted, faults = EXPECTED[name], caught.value.faults
    assert all(fault.message for fault in faults)
    matching = [
        fault for fault in faults if holds(wanted, fault.line, fault.column, f"{fault.message} {fault.hint or ''}")
    ]
    assert matching, [str(fault) for fault in faults]


@cache
def printed() -> tuple[object, str, dict[str, str]]:
    """The status, the standard error and the line of each bad file, all of them in one run."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as stop:
        cli.app(["classify", "--json", *(str(BAD / name) for name in EXPECTED)])
    return stop.value.code, err.getvalue(), dict(zip(EXPECTED, out.getvalue().splitlines(), strict=True))


@pytest.mark.xdist_group("bad")
@pytest.mark.parametrize("name", EXPECTED)
def test_a_bad_file_is_one_line_of_json(name: str) -> None:
    status, err, lines = printed()
    line = lines[name]
    found = json.loads(line)
    assert (status, err, found["scene"]) == (2, "", Path(name).stem)
    error = found["error"]
    assert "Traceback" not in line
    assert error["message"]
    wanted = EXPECTED[name]
    every = [error, *error.get("faults", [])]
    assert any(holds(wanted, e["line"], e["column"], f"{e['message']} {e['hint'] or ''}") for e in every), error


def holds(wanted: Mapping[str, Any], line: int | None, column: int | None, text: str) -> bool:
    """Is this the place (where one is wanted) and are all pieces in the text, whatever the letter case?"""
    places = [(wanted["line"], line), (wanted["column"], column)]
    pieces = [piece if isinstance(piece, list) else [piece] for piece in wanted["message_contains"]]
    return all(want is None or want == found for want, found in places) and all(
        any(choice.lower() in text.lower() for choice in piece) for piece in pieces
    )
