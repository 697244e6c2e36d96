"""Every scene of the catalog and of the tests says what its report must hold; every bad one what a person is told."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from contextlib import redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import CATALOG, EXPECTED, ROOT, SCENES, report_of, scene_of, stem, strict_report_of
from shared.report_laws import CERTAINTY, certainty_of

import dofkit
import dofkit.base.documents
import dofkit.scene.lowering
from dofkit.base.errors import SceneError
from dofkit.interface import cli
from dofkit.scene.constraints import TYPES
from dofkit.scene.expectation import unmet

BAD = ROOT / "tests/scenes/bad"


@cache
def document(path: Path) -> dict[str, Any]:
    """The scene's mapping as written, through the same reader as ever."""
    return dict(scene_of(path).model_dump(mode="json", exclude_unset=True))


# The scenes


@pytest.mark.parametrize("path", EXPECTED, ids=stem)
def test_the_report_holds_what_the_scene_expects(path: Path) -> None:
    scene, report = scene_of(path), strict_report_of(path) if path in CATALOG else report_of(path)
    assert scene.expect
    assert unmet(scene, report.model_dump(mode="json")) == []
    # What is surer than the table says needs an argument first, and what is less sure has lost its own.
    assert certainty_of(report_of(path)) == CERTAINTY.get(path.stem, {})


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


# What is no scene

TOLD: dict[str, Any] = dofkit.base.documents.read_document((BAD / "expected.yaml").read_bytes(), "expected").value


def test_every_bad_file_says_what_is_reported() -> None:
    assert sorted(TOLD) == sorted(path.name for path in BAD.iterdir() if path.name != "expected.yaml")


@pytest.mark.parametrize("name", TOLD)
def test_a_bad_file_is_reported_where_and_why(name: str) -> None:
    with pytest.raises(SceneError) as caught:
        dofkit.load(BAD / name)
    wanted, faults = TOLD[name], caught.value.faults
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
        cli.app(["classify", "--json", *(str(BAD / name) for name in TOLD)])
    return stop.value.code, err.getvalue(), dict(zip(TOLD, out.getvalue().splitlines(), strict=True))


@pytest.mark.xdist_group("bad")
@pytest.mark.parametrize("name", TOLD)
def test_a_bad_file_is_one_line_of_json(name: str) -> None:
    status, err, lines = printed()
    line = lines[name]
    document = json.loads(line)
    assert (status, err, document["scene"]) == (2, "", Path(name).stem)
    error = document["error"]
    assert "Traceback" not in line
    assert error["message"]
    wanted = TOLD[name]
    every = [error, *error.get("faults", [])]
    assert any(holds(wanted, e["line"], e["column"], f"{e['message']} {e['hint'] or ''}") for e in every), error


def holds(wanted: Mapping[str, Any], line: int | None, column: int | None, text: str) -> bool:
    """Is this the place (where one is wanted) and are all pieces in the text, whatever the letter case?"""
    places = [(wanted["line"], line), (wanted["column"], column)]
    pieces = [piece if isinstance(piece, list) else [piece] for piece in wanted["message_contains"]]
    return all(want is None or want == found for want, found in places) and all(
        any(choice.lower() in text.lower() for choice in piece) for piece in pieces
    )
