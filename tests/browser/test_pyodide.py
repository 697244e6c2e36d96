"""Python compiled for browsers answers as Python here does: 32-bit limbs, no processes, no numpy."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest
from shared.served import Served

import dofkit

pytestmark = pytest.mark.browser
SCRIPT = Path(__file__).with_name("classify.mjs")
#: What rounding may change: the places that were looked at, and how far apart numbers were there.
ROUNDED = {"witness", "bound"}


@pytest.fixture(scope="module")
def answered(served: Served, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The answers of Pyodide, under node, by the files that the bench loads."""
    scenes = tmp_path_factory.mktemp("pyodide") / "scenes.json"
    scenes.write_text(json.dumps({name: dofkit.catalog_text(name) for name in dofkit.catalog_names()}))
    command = ["node", str(SCRIPT), str(served.folder / "bench" / "runtime"), str(scenes)]
    ran = subprocess.run(command, capture_output=True, text=True, check=False, timeout=500)
    assert not ran.returncode, ran.stderr[-2000:]
    answers: dict[str, Any] = json.loads(ran.stdout)
    return answers


def unrounded(value: Any) -> Any:
    """Return a report without what rounding may change."""
    if isinstance(value, dict):
        return {key: unrounded(part) for key, part in value.items() if key not in ROUNDED}
    return [unrounded(part) for part in value] if isinstance(value, list) else value


def test_every_scene_of_the_catalog_has_the_same_report(answered: dict[str, Any]) -> None:
    for name in dofkit.catalog_names():
        here = dofkit.classify(dofkit.loads(dofkit.catalog_text(name), name=name)).model_dump(mode="json")
        assert unrounded(answered["reports"][name]) == unrounded(here), name


def test_nothing_is_imported_that_a_browser_lacks_and_a_budget_is_watched_from_within(answered: dict[str, Any]) -> None:
    assert answered["platform"] == "emscripten"
    assert answered["imported"] == []
    assert [text for text in answered["warnings"] if "the time was watched" in text]
