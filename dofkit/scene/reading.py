"""Reading a `Scene` from a file, a catalog name, a text or a mapping, with the location of every fault."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from dofkit.base.deadline import gc_rarely
from dofkit.base.documents import DEEPEST, Document, read_document
from dofkit.base.errors import ArgumentError, Fault, SceneError
from dofkit.base.wording import description_of
from dofkit.models.formats import is_model, read_model
from dofkit.models.model_document import ModelFile
from dofkit.scene.catalog import find
from dofkit.scene.fields import faults_of
from dofkit.scene.hints import UNKNOWN_TYPE, with_hint, without_echoes
from dofkit.scene.lowering import check
from dofkit.scene.mending import faults_hidden_by
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import StandardWords, standard_words
from dofkit.system import System

__all__ = ["SceneFile", "SceneLike", "load", "loads", "scene_or_system"]

#: Further faults are counted, not listed.
MOST_FAULTS = 200
_TAKEN = "a Scene, a path, a catalog name or a mapping"


#: What functions accept as a scene: a Scene, a path, a catalog name or a mapping.
SceneLike = Scene | str | os.PathLike[str] | Mapping[str, Any]


@gc_rarely()
def load(source: SceneLike, *, name: str | None = None, limits: bool = False) -> Scene:
    """Return the scene of a YAML or JSON file, of the catalog, of a model or of a mapping.

    Parameters
    ----------
    source
        A path, a catalog name, a mapping with the keys of a scene, or a Scene, which is returned unchanged. A path may
        lead to a model: MJCF, URDF or a SolveSpace sketch.
    name
        The scene's name if it gives none; by default the file's stem.
    limits
        Whether the joint limits of a model become inequalities.

    Returns
    -------
    Scene
        Its texts and its geometry are checked.

    Raises
    ------
    SceneError
        If ``source`` is not a valid scene: with every fault at once, each with its location.
    ArgumentError
        If ``source`` is of another kind.

    Examples
    --------
    >>> import dofkit
    >>> dofkit.load({"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1"]}).dimension
    3
    >>> dofkit.load("four-bar-linkage").constraints[0].kind()
    'revolute'
    """
    if isinstance(source, Scene):
        return source
    if isinstance(source, Mapping):
        deep = _too_deep(source)
        if deep is not None:
            hint = "write the scene with fewer levels"
            raise SceneError((Fault(f"nested deeper than {DEEPEST} levels", deep, hint=hint),), name)
        return SceneFile(Document(name or "", "", source, ()), located=False).scene()
    if not isinstance(source, str | os.PathLike):
        raise ArgumentError(f"a scene is given as {_TAKEN}, not {description_of(source)}")
    file = find(source)
    if file.path is None:
        return SceneFile(read_document(file.data, name or file.name)).scene()
    return SceneFile.read(file.data, name or file.name, file.path, limits).scene()


@gc_rarely()
def loads(data: bytes | str, name: str = "scene") -> Scene:
    """Return the scene of a YAML or JSON text, or of its bytes in UTF-8.

    Parameters
    ----------
    data
        The text of a scene or of a model.
    name
        The scene's name if it gives none.

    Returns
    -------
    Scene
        Its texts and its geometry are checked.

    Raises
    ------
    SceneError
        If the text is not a valid scene: with every fault at once, each with line and column.
    ArgumentError
        If ``data`` is no text.

    Examples
    --------
    >>> import dofkit
    >>> dofkit.loads("coordinates: [x, y]", "plane").name
    'plane'
    """
    if not isinstance(data, bytes | str):
        raise ArgumentError(
            f"the text of a scene is a str or bytes, not {description_of(data)}; dofkit.load takes the rest"
        )
    return SceneFile.read(data, name).scene()


def scene_or_system(source: SceneLike | System) -> Scene | System:
    """Return a System unchanged, and the Scene that any other source stands for. Raises as `load` does."""
    return source if isinstance(source, System) else load(source)


@dataclass(frozen=True)
class SceneFile:
    """A document to be read as a scene; its faults have line and column if it is ``located`` in a text."""

    document: Document
    located: bool = True

    @classmethod
    def read(cls, data: bytes | str, name: str, path: Path | None = None, limits: bool = False) -> SceneFile:
        """Return the document of a scene or a model; its faults are raised later, by `scene`.

        ``path``: the file, for what a model includes; ``limits``: ranges of a model's joints become inequalities.
        """
        if not is_model(data):
            return cls(read_document(data, name))
        return cls(_model_document(ModelFile(data, name, path, limits)))

    def scene(self, *, checked: bool = True) -> Scene:
        """Return the scene. Raises SceneError with all faults; texts and geometry are checked only if ``checked``."""
        faults = list(self.document.faults)
        if not isinstance(self.document.value, Mapping):
            if not faults:
                hint = "begin with 'coordinates: [x, y]' or the like"
                faults.append(Fault("a scene is a mapping of keys to values", hint=hint))
            raise self.error(faults)
        value = self._words.value
        if value.get("name") is None and self.document.name:
            value = {**value, "name": self.document.name}
        try:
            scene = Scene.model_validate(value)
        except ValidationError as error:
            structural = faults_of(error)
            raise self.error([*faults, *structural, *faults_hidden_by(structural, value)]) from None
        if checked or faults:
            faults += check(scene)
        if faults:
            raise self.error(faults)
        return scene

    @cached_property
    def _words(self) -> StandardWords:
        value = self.document.value
        return standard_words(value if isinstance(value, Mapping) else {})

    def error(self, faults: Iterable[Fault]) -> SceneError:
        """Return the error with these faults, located and with hints, without faults that another one explains."""
        taken = {(fault.line, fault.column) for fault in self.document.faults}
        located = []
        for fault in without_echoes(faults, self._words.value):
            placed = self._with_place(fault)
            if fault.line is not None or not self.located or (placed.line, placed.column) not in taken:
                located.append(placed)
        located = list({(f.message, f.line, f.column, f.line is None and f.where): f for f in located}.values())
        located.sort(key=self._order_in_document)
        if len(located) > MOST_FAULTS:
            message = f"and {len(located) - MOST_FAULTS} further faults from here on"
            located[MOST_FAULTS:] = [replace(located[MOST_FAULTS], message=message, hint="correct these first")]
        return SceneError(tuple(located), self.document.name or None)

    def _order_in_document(self, fault: Fault) -> tuple[int, ...]:
        """Return the sort key (line, column) of a located fault, else (0, section, entry, column in the text)."""
        if fault.line is not None:
            return (fault.line, fault.column or 0)
        sections = list(self.document.value) if isinstance(self.document.value, Mapping) else []
        section = sections.index(fault.where[0]) if fault.where and fault.where[0] in sections else -1
        entry = next((key for key in fault.where if isinstance(key, int)), -1)
        return (0, section, entry, fault.column or 0)

    def _with_place(self, fault: Fault) -> Fault:
        """Return the fault with its hint, and with its line and column if the document is located."""
        if fault.line is not None:
            return fault
        hinted = replace(with_hint(fault, self._words.value), where=self._words.written(fault.where))
        if not self.located:
            return hinted
        quoted = fault.message.replace("`", "'")
        key = fault.column is None and any(f"'{part}'" in quoted for part in fault.where[-1:])
        where = (*fault.where, "type") if fault.message.startswith(UNKNOWN_TYPE) else fault.where
        line, column = self.document.place(self._words.written(where), key=key, column=fault.column)
        return replace(hinted, line=line, column=column)


def _model_document(file: ModelFile) -> Document:
    """Return the scene's document that a model describes; its parts have the lines of the model as locations."""
    starts = [0, *(match.end() for match in re.finditer("\n", file.text))]
    try:
        model = read_model(file)
    except SceneError as error:
        return Document(file.name, file.text, None, error.faults)
    places = {path: (starts[line - 1], -1) for path, line in model.lines.items() if line <= len(starts)}
    return Document(file.name, file.text, {"name": file.name, **model.value}, (), lambda: places)


def _too_deep(source: object) -> tuple[str | int, ...] | None:
    """Return the path of a value that is nested deeper than `DEEPEST` levels (or contains itself), or None."""
    level: list[tuple[tuple[str | int, ...], object]] = [((), source)]
    for _ in range(DEEPEST):
        below: list[tuple[tuple[str | int, ...], object]] = []
        for path, value in level:
            if isinstance(value, (dict, Mapping)):
                below += [((*path, str(key)), part) for key, part in value.items() if _is_collection(part)]
            elif isinstance(value, (list, tuple)):
                below += [((*path, i), part) for i, part in enumerate(value) if _is_collection(part)]
        if not below:
            return None
        level = below
    return level[0][0]


def _is_collection(value: object) -> bool:
    return isinstance(value, (dict, list, tuple, Mapping))
