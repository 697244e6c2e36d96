"""The command `convert`: a model of others as the file of a scene that a person can go on from."""

from __future__ import annotations

from pathlib import Path

from dofkit.base.errors import DofkitError, SceneError
from dofkit.base.version import __version__
from dofkit.models import ModelFile, read_model
from dofkit.models.formats import is_model
from dofkit.models.scene_text import scene_text
from dofkit.scene.found_files import find
from dofkit.scene.reading import SceneFile


def converted(file: str, limits: bool = False) -> str:
    """The scene of a model as YAML. Raises SceneError for what is no model or at fault."""
    found = find(file)
    if not is_model(found.data):
        raise DofkitError(f"'{file}' is no model of others: it is read as a scene as it is")
    scene = SceneFile.read(found.data, found.name, found.path, limits)
    try:
        scene.scene()
    except SceneError as error:
        raise SceneError(error.faults, file) from None
    model = read_model(ModelFile(found.data, found.name, found.path, limits))
    remarks = [f"Made from {Path(file).name} by dofkit {__version__}."]
    if model.tolerance is not None and "tolerance" not in model.value:
        remarks.append(
            f"A tree of joints: no place in it is special. Where you close a loop add `tolerance: {model.tolerance:g}`."
        )
    return scene_text({"name": found.name, **model.value}, tuple(remarks))


def write_converted(file: str, out: Path | None, limits: bool) -> str:
    """Write the scene of a model to a path, or give its text; what to print."""
    text = converted(file, limits)
    if out is None:
        return text
    try:
        out.write_text(text, encoding="utf-8")
    except OSError as error:
        raise DofkitError(f"the scene cannot be written to '{out}': {error.strerror or error}") from None
    return f"{out}\n"
