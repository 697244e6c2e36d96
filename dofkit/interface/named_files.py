"""The files that arguments name, and the files that `new` and `convert` write.

A folder or a pattern stands for the scenes and models in it, in order.
"""

from __future__ import annotations

import glob
import json
import os
from collections.abc import Iterable, Iterator
from importlib import resources
from pathlib import Path

from dofkit.base import __version__
from dofkit.base.documents import yaml_text
from dofkit.base.errors import DofkitError, SceneError
from dofkit.models.formats import LOOKED_AT, is_known_model, is_model, read_model
from dofkit.models.model_document import ModelFile
from dofkit.scene.catalog import catalog_names, find
from dofkit.scene.reading import SceneFile
from dofkit.scene.schema import scene_schema

#: The extensions of scenes and models; an .xml file is a model only if its text begins like one.
ENDINGS, OF_MANY_KINDS = (".json", ".mjcf", ".slvs", ".urdf", ".yaml", ".yml"), (".xml",)


def named_files(arguments: Iterable[str]) -> list[str]:
    """Return all named files in the given order, those of a folder or pattern sorted by name.

    An argument without such files is returned unchanged: the error comes when it is read.
    """
    return [file for argument in arguments for file in _named(argument)]


def _named(argument: str) -> list[str]:
    if os.path.isdir(argument) and argument not in catalog_names():  # a folder here may have the name of a scene
        return list(_below(argument)) or [argument]
    if glob.has_magic(argument) and not os.path.exists(argument):
        matched = sorted(glob.iglob(argument, recursive=True))
        return [file for path in matched for file in (_below(path) if os.path.isdir(path) else [path])] or [argument]
    return [argument]


def _below(folder: str) -> Iterator[str]:
    """Yield the scenes and models in a folder and its subfolders, without hidden ones and linked folders."""
    for place, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(files):
            path = os.path.join(place, name)
            if not name.startswith(".") and (name.lower().endswith(ENDINGS) or _is_model(path)):
                yield path


def _is_model(path: str) -> bool:
    """Return whether a file is an XML model of a known kind (MJCF, URDF)."""
    if not path.lower().endswith(OF_MANY_KINDS):
        return False
    try:
        with open(path, "rb") as file:
            return is_known_model(file.read(LOOKED_AT))
    except OSError:
        return False


#: The sections of a scene that are written with one entry per line.
SECTIONS = ("particles", "bodies", "constraints", "forces", "left_out", "configuration", "picture")
#: The schema beside a scene; its name is hidden, so that it is not read as a scene of the folder.
SCHEMA = ".dofkit-schema.json"


def write_converted(file: str, out: Path | None, limits: bool) -> str:
    """Return the scene of a model as text; with ``out`` write it there and return the path to print.

    Raises DofkitError for a file that is not a model or has faults.
    """
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
    return _written(yaml_text({"name": file_data.name, **model.value}, SECTIONS, tuple(remarks)), out)


def write_new(out: Path | None) -> str:
    """Return a first scene as text; with ``out`` write it there and return the path to print.

    Raises DofkitError if the file exists.
    """
    if out is not None and out.exists():
        raise DofkitError(f"'{out}' exists: name a new file")
    return _written(resources.files(__package__).joinpath("first_scene.yaml").read_text(encoding="utf-8"), out)


def _written(text: str, out: Path | None) -> str:
    """Return the text; with ``out`` write it there, with the schema for editors beside it, and return the path."""
    if out is None:
        return text
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.with_name(SCHEMA).write_text(json.dumps(scene_schema(), indent=1) + "\n", encoding="utf-8")
        out.write_text(f"# yaml-language-server: $schema={SCHEMA}\n{text}", encoding="utf-8")
    except OSError as error:
        raise DofkitError(f"the scene cannot be written to '{out}': {error.strerror or error}") from None
    return f"{out}\n"
