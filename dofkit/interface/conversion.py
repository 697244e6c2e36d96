"""The commands `new` and `convert`: a first scene, or the scene of a model, as a file to edit."""

from __future__ import annotations

import json
from pathlib import Path

from dofkit.base import __version__
from dofkit.base.documents import yaml_text
from dofkit.base.errors import DofkitError, SceneError
from dofkit.models.formats import is_model, read_model
from dofkit.models.model_document import ModelFile
from dofkit.scene.catalog import find
from dofkit.scene.reading import SceneFile
from dofkit.scene.schema import scene_schema

#: The sections of a scene that are written with an entry on each line.
SECTIONS = ("particles", "bodies", "constraints", "forces", "left_out", "configuration")
#: The schema beside a scene; its name is hidden, so that it is not read as a scene of the folder.
SCHEMA = ".dofkit-schema.json"
FIRST_SCENE = """\
title: A pendulum on a cart
dimension: 2
parameters: {l: positive}
particles: [cart, bob]
constraints:
- {name: rail, type: equation, text: "y_cart = 0"}
- {name: rod, type: link, between: [cart, bob], length: l}
"""


def converted(file: str, limits: bool = False) -> str:
    """Return the scene of a model as YAML. Raises DofkitError for a file that is not a model or has faults."""
    file_data = find(file)
    if not is_model(file_data.data):
        raise DofkitError(f"'{file}' is not a model: only MJCF, URDF and SolveSpace files are converted")
    scene = SceneFile.read(file_data.data, file_data.name, file_data.path, limits)
    try:
        scene.scene()
    except SceneError as error:
        raise SceneError(error.faults, file) from None
    model = read_model(ModelFile(file_data.data, file_data.name, file_data.path, limits))
    remarks = [f"Made from {Path(file).name} by dofkit {__version__}."]
    if model.tolerance is not None and "tolerance" not in model.value:
        remarks.append(f"The joints form a tree. If you close a loop, add `tolerance: {model.tolerance:g}`.")
    return yaml_text({"name": file_data.name, **model.value}, SECTIONS, tuple(remarks))


def write_converted(file: str, out: Path | None, limits: bool) -> str:
    """Write the scene of a model to a path, or return its text where there is none; return what to print."""
    return _written(converted(file, limits), out)


def write_new(out: Path | None) -> str:
    """Write a first scene to a path, or return its text where there is none; return what to print.

    Raises DofkitError where the file exists.
    """
    if out is not None and out.exists():
        raise DofkitError(f"'{out}' exists: name a new file")
    return _written(FIRST_SCENE, out)


def _written(text: str, out: Path | None) -> str:
    """Write a scene, and beside it the schema by which editors complete and check it."""
    if out is None:
        return text
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.with_name(SCHEMA).write_text(json.dumps(scene_schema(), indent=1) + "\n", encoding="utf-8")
        out.write_text(f"# yaml-language-server: $schema={SCHEMA}\n{text}", encoding="utf-8")
    except OSError as error:
        raise DofkitError(f"the scene cannot be written to '{out}': {error.strerror or error}") from None
    return f"{out}\n"
