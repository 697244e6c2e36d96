"""The autograder of an assignment for Gradescope: one zip with the assignment, its scenes and dofkit itself."""

from __future__ import annotations

import json
import os
import zipfile
from collections.abc import Iterator
from importlib import metadata, resources
from importlib.resources.abc import Traversable
from pathlib import Path

from dofkit.homework.assignment import load_assignment
from dofkit.homework.autograder import undecided
from dofkit.homework.formats.base import text
from dofkit.homework.formats.gradescope import document
from dofkit.homework.formats.review import TABLE
from dofkit.homework.handout.portable import standing_alone
from dofkit.homework.review import read_table
from dofkit.homework.variants import assigned
from dofkit.scene.catalog import catalog_folder

SCRIPTS = Path(__file__).parent / "scripts"
_EXECUTABLE = frozenset({"setup.sh", "run_autograder"})
#: Folders of dofkit that an autograder does not need.
_LEFT_OUT = (".", "__pycache__", "site")
_TIME = (1980, 1, 1, 0, 0, 0)


def export_gradescope(assignment: str | os.PathLike[str], out: Path, reviewed: Path | None = None) -> None:
    """Write the zip to upload.

    The zip contains ``setup.sh`` and ``run_autograder``, the assignment with its scenes, the result for interrupted
    grading, the points that a person gave (``reviewed``), dofkit, and the list of packages that dofkit requires. Raises
    AssignmentError, NobodysVariantError if the assignment varies but has no students, ReviewError, and OSError.
    """
    prepared = load_assignment(assignment)
    assigned(prepared)
    files = {path.name: path.read_bytes() for path in sorted(SCRIPTS.iterdir()) if path.is_file()}
    files["assignment.json"] = json.dumps(standing_alone(prepared, Path())).encode()
    interrupted = undecided(prepared, "", "grading was interrupted.")
    files["fallback.json"] = text(document(interrupted, prepared)).encode()
    if reviewed is not None:
        read_table(reviewed, prepared.most_points())
        files[TABLE] = reviewed.read_bytes()
    required = [line for line in metadata.requires("dofkit") or [] if "extra ==" not in line]
    files["requirements.txt"] = "".join(f"{line}\n" for line in required).encode()
    files |= _below(resources.files("dofkit"), "code/dofkit")
    files |= _below(catalog_folder(), "code/dofkit/_catalog")
    _zip(files, out)


def _below(folder: Traversable, path: str) -> Iterator[tuple[str, bytes]]:
    """Yield (path in the zip, content) for the files below an installed folder."""
    for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
        if entry.is_dir() and not entry.name.startswith(_LEFT_OUT):
            yield from _below(entry, f"{path}/{entry.name}")
        elif entry.is_file():
            yield f"{path}/{entry.name}", entry.read_bytes()


def _zip(files: dict[str, bytes], out: Path) -> None:
    """Write a zip atomically, with fixed times: the same files give the same zip."""
    out.parent.mkdir(parents=True, exist_ok=True)
    temporary = out.with_name(f".{out.name}.new")
    with zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            info = zipfile.ZipInfo(name, _TIME)
            info.external_attr = (0o755 if name in _EXECUTABLE else 0o644) << 16
            archive.writestr(info, data, zipfile.ZIP_DEFLATED)
    os.replace(temporary, out)
