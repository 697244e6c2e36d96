"""From a file, a catalog name, a text or a mapping to a `Scene`, with every fault in its place."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import ValidationError

from dofkit.base.arguments import description_of
from dofkit.base.deadline import gc_rarely
from dofkit.base.documents import DEEPEST, Document, read_document
from dofkit.base.errors import ArgumentError, Fault, SceneError
from dofkit.models.formats import is_model, read_model
from dofkit.models.model_document import ModelFile
from dofkit.scene.catalog import find
from dofkit.scene.constraints.equations import as_equation
from dofkit.scene.fields import faults_of
from dofkit.scene.hints import UNKNOWN_KEY, UNKNOWN_TYPE, meant_section, with_hint, without_echoes
from dofkit.scene.lowering import check
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import StandardWords, standard_words
from dofkit.system import System

__all__ = ["SceneFile", "SceneLike", "load", "loads", "scene_or_system"]

#: More faults than this are counted, not listed.
MOST_FAULTS = 200
#: Parts of a scene without which its other parts can still be checked.
_DROPPED_WHOLE = frozenset({"name", "title", "source", "notes", "left_out", "expect", "energies", "configuration"})
_DROPPED_BY_ENTRY = ("constraints", "forces")
_TAKEN = "a Scene, a path, a catalog name or a mapping"


#: What stands for a scene wherever one is asked for: a path or a catalog name as text among them.
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
        If it is not a scene: with every fault at once, each with its location.
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
        return _from_mapping(source, name)
    if not isinstance(source, str | os.PathLike):
        raise ArgumentError(f"a scene is given as {_TAKEN}, not {description_of(source)}")
    found = find(source)
    return SceneFile.read(found.data, name or found.name, found.path, limits).scene()


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
        If it is not a scene: with every fault at once, each with line and column.
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


def scene_or_system(given: SceneLike | System) -> Scene | System:
    """What a door is given: a System as it is, and the Scene that anything else stands for. Raises as `load` does."""
    return given if isinstance(given, System) else load(given)


@dataclass(frozen=True)
class SceneFile:
    """A document that should be a scene; knows the line and column of what is wrong with it."""

    document: Document

    @classmethod
    def read(cls, data: bytes | str, name: str, path: Path | None = None, limits: bool = False) -> SceneFile:
        """Take the text of a scene, or a model, apart; nothing is raised yet.

        ``path``: where it stands, for what a model includes; ``limits``: ranges of a model's joints are inequalities.
        """
        if not is_model(data):
            return cls(read_document(data, name))
        return cls(_model_document(ModelFile(data, name, path, limits)))

    def scene(self, *, checked: bool = True) -> Scene:
        """The scene. Raises SceneError with all faults; texts and geometry are looked at only if ``checked``."""
        value = self.document.value
        faults = list(self.document.faults)
        if not isinstance(value, dict):
            if not faults:
                hint = "begin with 'coordinates: [x, y]' or the like"
                faults.append(Fault("a scene is a mapping of keys to values", hint=hint))
            raise self._error(faults)
        value = self._words.value
        if value.get("name") is None:
            value = {**value, "name": self.document.name}
        scene, found = _scene_and_faults(value, checked or bool(faults))
        if faults or found or scene is None:
            raise self._error([*faults, *found])
        return scene

    @cached_property
    def _words(self) -> StandardWords:
        value = self.document.value
        return standard_words(value if isinstance(value, dict) else {})

    def with_places(self, error: SceneError) -> SceneError:
        """The same faults with their lines and columns."""
        return self._error(error.faults)

    def _error(self, faults: Iterable[Fault]) -> SceneError:
        taken = {(fault.line, fault.column) for fault in self.document.faults}
        told = []
        for fault in without_echoes(faults, self._words.value):
            found = self._with_place(fault)
            if fault.line is not None or (found.line, found.column) not in taken:
                told.append(found)
        told.sort(key=lambda fault: (fault.line or 0, fault.column or 0))
        return SceneError(_first_faults(told), self.document.name)

    def _with_place(self, fault: Fault) -> Fault:
        if fault.line is not None:
            return fault
        key = fault.message.startswith(UNKNOWN_KEY)
        where = (*fault.where, "type") if fault.message.startswith(UNKNOWN_TYPE) else fault.where
        line, column = self.document.place(self._words.written(where), key=key, column=fault.column)
        told = with_hint(fault, self._words.value)
        return replace(told, where=self._words.written(fault.where), line=line, column=column)


def _model_document(file: ModelFile) -> Document:
    """The document that a model stands for, its parts placed by the lines of the model."""
    starts = [0, *(match.end() for match in re.finditer("\n", file.text))]
    try:
        model = read_model(file)
    except SceneError as error:
        return Document(file.name, file.text, None, error.faults)
    found = {path: (starts[line - 1], -1) for path, line in model.lines.items() if line <= len(starts)}
    value = {"name": file.name, **model.value}
    return Document(file.name, file.text, value, (), lambda: found)


def _from_mapping(source: Mapping[str, Any], name: str | None) -> Scene:
    deep = _too_deep(source)
    if deep is not None:
        raise SceneError(
            (Fault(f"nested deeper than {DEEPEST} levels", deep, hint="write the scene with fewer levels"),), name
        )
    words = standard_words(source)
    value = words.value
    if name is not None and value.get("name") is None:
        value["name"] = name
    scene, faults = _scene_and_faults(value, True)
    if scene is None or faults:
        told = [with_hint(fault, value) for fault in without_echoes(faults, value)]
        raise SceneError(_first_faults([replace(f, where=words.written(f.where)) for f in told]), name)
    return scene


def _too_deep(source: object) -> tuple[str | int, ...] | None:
    """The path of a value nested too deep (or within itself), or None."""
    level: list[tuple[tuple[str | int, ...], object]] = [((), source)]
    for _ in range(DEEPEST):
        below: list[tuple[tuple[str | int, ...], object]] = []
        for path, value in level:
            if isinstance(value, (dict, Mapping)):
                below += [((*path, str(key)), part) for key, part in value.items() if _holds(part)]
            elif isinstance(value, (list, tuple)):
                below += [((*path, i), part) for i, part in enumerate(value) if _holds(part)]
        if not below:
            return None
        level = below
    return level[0][0]


def _holds(value: object) -> bool:
    return not isinstance(value, str) and isinstance(value, (dict, list, tuple, Mapping))


def _scene_and_faults(value: Mapping[str, Any], checked: bool) -> tuple[Scene | None, tuple[Fault, ...]]:
    """The scene and its faults; where its structure is at fault, those of the rest of it as well."""
    try:
        scene = Scene.model_validate(value)
    except ValidationError as error:
        faults = faults_of(error)
    else:
        return scene, check(scene) if checked else ()
    rest = SoundPart.without(value, faults)
    if rest is None:
        return None, faults
    try:
        found = check(Scene.model_validate(rest.value))
    except ValidationError:
        return None, faults
    missed = {f"there is no joint '{name}'" for name in rest.names}
    later = (replace(fault, where=rest.written(fault.where)) for fault in found if fault.message not in missed)
    return None, (*faults, *later)


class SoundPart(NamedTuple):
    """A scene without its faulty parts, and with its misspelt sections under their names.

    ``kept``: which entries of its lists are left; ``names``: those of the entries that are not; ``sections``: what was
    written for a section.
    """

    value: dict[str, Any]
    kept: dict[str, list[int]]
    names: frozenset[str]
    sections: dict[str, str]

    @classmethod
    def without(cls, value: Mapping[str, Any], faults: Sequence[Fault]) -> SoundPart | None:
        """Take out what is at fault; None where the rest would not make sense without it."""
        rest: Any = dict(value)
        dropped: dict[str, set[int]] = {key: set() for key in _DROPPED_BY_ENTRY}
        sections: dict[str, str] = {}
        for fault in faults:
            first, second = (*fault.where, None, None)[:2]
            meant = meant_section(fault)
            if first in dropped and isinstance(second, int):
                dropped[str(first)].add(second)
            elif first in _DROPPED_WHOLE:
                rest.pop(first, None)
            elif meant is not None and meant not in rest:
                sections[meant] = str(first)
                rest[meant] = rest.pop(first)
            elif fault.message.startswith(UNKNOWN_KEY):
                rest = _cut(rest, fault.where)
            else:
                return None
        kept: dict[str, list[int]] = {}
        names: set[str] = set()
        for key, gone in dropped.items():
            if gone:
                kept[key] = [i for i in range(len(rest[key])) if i not in gone]
                entries = [rest[key][i] for i in gone]
                names |= {str(entry["name"]) for entry in entries if isinstance(entry, Mapping) and "name" in entry}
                rest[key] = [_with_name(key, i, rest[key][i]) for i in kept[key]]
        return cls(standard_words(rest).value if sections else rest, kept, frozenset(names), sections)

    def written(self, where: tuple[str | int, ...]) -> tuple[str | int, ...]:
        """A path of the rest as a path of the whole."""
        if len(where) >= 2 and where[0] in self.kept and isinstance(where[1], int):
            return (where[0], self.kept[str(where[0])][where[1]], *where[2:])
        return (self.sections.get(str(where[0]), where[0]), *where[1:]) if where else where


def _with_name(key: str, index: int, entry: Any) -> Any:
    """An entry that goes by its position, named by the position that it had."""
    entry = as_equation(entry)
    return {**entry, "name": entry.get("name") or f"{key[0]}{index + 1}"} if isinstance(entry, dict) else entry


def _cut(value: Any, path: tuple[str | int, ...]) -> Any:
    """``value`` without what is at ``path``; nothing that is shared is changed."""
    if not path or (isinstance(value, dict) and path[0] not in value):
        return value
    if len(path) == 1 and isinstance(value, dict):
        return {key: part for key, part in value.items() if key != path[0]}
    if isinstance(value, dict):
        return {**value, str(path[0]): _cut(value[path[0]], path[1:])}
    if isinstance(value, list) and isinstance(path[0], int):
        return [_cut(part, path[1:]) if i == path[0] else part for i, part in enumerate(value)]
    return value


def _first_faults(faults: list[Fault]) -> tuple[Fault, ...]:
    if len(faults) <= MOST_FAULTS:
        return tuple(faults)
    more = len(faults) - MOST_FAULTS
    last = replace(faults[MOST_FAULTS], message=f"and {more} further faults from here on", hint="correct these first")
    return (*faults[:MOST_FAULTS], last)
