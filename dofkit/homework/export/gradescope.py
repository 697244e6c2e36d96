"""The autograder of an assignment for Gradescope: one zip, which needs no network to be installed."""

from __future__ import annotations

import json
import os
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

from dofkit.base.documents import read_document
from dofkit.base.errors import DofkitError
from dofkit.homework.assignment import load_assignment
from dofkit.homework.autograder import undecided
from dofkit.homework.export.wheels import download, own_wheel, requirements
from dofkit.homework.formats.base import text
from dofkit.homework.formats.gradescope import document, visibility_of
from dofkit.homework.formats.review import TABLE, RunReview
from dofkit.scene.catalog import find

#: The Pythons of the images that Gradescope offers, that of Ubuntu 24.04 first.
PYTHONS = ("3.12", "3.11", "3.13")
SCRIPTS = Path(__file__).parent / "scripts"
_EXECUTABLE = frozenset({"setup.sh", "run_autograder"})
_TIME = (1980, 1, 1, 0, 0, 0)


class ExportError(DofkitError):
    """An autograder that cannot be written."""


def export_gradescope(
    assignment: str | os.PathLike[str],
    out: Path,
    pythons: Sequence[str] = PYTHONS,
    *,
    wheels: bool = True,
    reviewed: Path | None = None,
) -> list[str]:
    """Write the zip to upload; what its user has to know.

    It holds ``setup.sh`` and ``run_autograder``, the assignment with its scenes in place, the result that stands until
    there is another, ``reviewed``, the points that a person gave, and, with ``wheels``, dofkit and all it needs for the
    versions of Python in ``pythons``. Raises AssignmentError for what is no assignment, ReviewError for what is no such
    table, ExportError where the zip cannot be written.
    """
    prepared = load_assignment(assignment)
    RunReview.read(prepared, reviewed, None)
    files = {path.name: path.read_bytes() for path in sorted(SCRIPTS.iterdir()) if path.is_file()}
    files["assignment.json"] = f"{exact_json(inlined(assignment))}\n".encode()
    interrupted = undecided(prepared, "", "grading was interrupted.")
    files["fallback.json"] = text(document(interrupted, visibility_of(prepared), prepared.assignment.language)).encode()
    if reviewed is not None:
        files[TABLE] = reviewed.read_bytes()
    files["pythons"] = "".join(f"{python}\n" for python in pythons).encode()
    with tempfile.TemporaryDirectory() as folder:
        notes = (
            _wheels(Path(folder), pythons)
            if wheels
            else ["the zip contains no wheels: setup.sh installs dofkit with pip, which needs a network"]
        )
        files |= {f"wheels/{path.name}": path.read_bytes() for path in sorted(Path(folder).iterdir())}
    try:
        _zip(files, out)
    except OSError as error:
        raise ExportError(f"{out} cannot be written: {error.strerror or error}") from None
    return notes


def _wheels(folder: Path, pythons: Sequence[str]) -> list[str]:
    """Put the wheels into a folder."""
    own_wheel(folder)
    needed = requirements()
    notes = [] if needed else ["dofkit is not installed, so its requirements are unknown"]
    for python in pythons:
        why = download(folder, python, [*needed, "pip"])
        if why is not None:
            notes.append(f"wheels for Python {python} could not be downloaded ({why}): setup.sh will need a network")
    return notes


def _zip(files: dict[str, bytes], out: Path) -> None:
    """Write the zip whole: the same files give the same zip."""
    out.parent.mkdir(parents=True, exist_ok=True)
    beside = out.with_name(f".{out.name}.new")
    with zipfile.ZipFile(beside, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            info = zipfile.ZipInfo(name, _TIME)
            info.external_attr = (0o755 if name in _EXECUTABLE else 0o644) << 16
            packed = zipfile.ZIP_STORED if name.endswith(".whl") else zipfile.ZIP_DEFLATED
            archive.writestr(info, data, packed)
    os.replace(beside, out)


def inlined(source: str | os.PathLike[str]) -> dict[str, Any]:
    """The assignment of a file, every scene in place. Raises AssignmentError, as `load_assignment` does."""
    load_assignment(source)
    shown = os.fspath(source)
    found = find(shown)
    value: Any = read_document(found.data, found.name).value
    problems = [{**problem, "scene": _scene(problem["scene"], Path(shown).parent)} for problem in value["problems"]]
    return {**value, "problems": problems}


def _scene(scene: Any, base: Path) -> Any:
    if isinstance(scene, Mapping):
        return scene
    found = find(base / scene if (base / scene).is_file() else scene)
    value: Any = read_document(found.data, found.name).value
    return {"name": found.name, **value}


def exact_json(value: Any) -> str:
    """JSON with every number as it was written: 0.1 is one tenth there, too.

    >>> exact_json({"a": [Decimal("0.10"), 1, True, None, "é"], "b": {}})
    '{"a": [0.10, 1, true, null, "\\\\u00e9"], "b": {}}'
    """
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(str(key))}: {exact_json(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(exact_json, value)) + "]"
    if isinstance(value, Decimal):
        return str(value)
    if isinstance(value, Fraction):
        return json.dumps(str(value))
    return json.dumps(value)
