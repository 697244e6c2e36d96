"""A model's file compiled by MuJoCo: in a process of its own that can be killed, faults by their lines."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from dofkit.base.errors import Fault, SceneError
from dofkit.base.workers import Job
from dofkit.base.workers.pool import shared
from dofkit.models.markup import Element, read_markup
from dofkit.models.model_document import ModelFile

#: Seconds that the compiler may take.
SECONDS = 60.0
#: What works in a process of its own, which is kept for the models that follow.
COMPILER = "dofkit.models.mujoco_model"
#: Files that a model may include, one in another.
MOST_INCLUDED = 300

#: Attributes that place or weigh something.
_MEASURES = (
    *("pos", "quat", "axisangle", "xyaxes", "zaxis", "euler", "axis", "fromto", "anchor", "relpose", "ref"),
    *("mass", "diaginertia", "fullinertia", "density", "polycoef", "size", "gravity"),
)
_NO_NUMBER = re.compile(r"[+-]?(?:nan|inf|infinity)", re.IGNORECASE)
_LINE = re.compile(r"line (\d+)")
_NOISE = re.compile(r"^(?:XML )?Error: (?:Error: )?|,? ?line \d+\s*$|\bElement name '', id -?\d+")


class CompiledModel(NamedTuple):
    """What the compiler told, the model's elements in the order of its lines, and those of the files it includes."""

    told: dict[str, Any]
    root: Element
    included: tuple[Element, ...]


def compiled(file: ModelFile) -> CompiledModel:
    """The model compiled. Raises SceneError for what the compiler does not take."""
    root = read_markup(file.data, file.name)
    included = tuple(_included(root, file))
    faults = [*_not_finite(root), *(fault for part in included for fault in _not_finite(part))]
    if faults:
        raise SceneError(tuple(faults), file.name)
    payload = {"path": None if file.path is None else str(file.path), "text": file.text}
    outcome = shared(COMPILER).run(Job(f"{COMPILER}:described_model", payload, SECONDS))
    if not outcome.finished:
        raise SceneError((_fault(outcome.reason, outcome.error),), file.name)
    return CompiledModel(outcome.value, root, included)


def _not_finite(root: Element) -> Iterator[Fault]:
    """Numbers that are none, of which the compiler makes places that are none."""
    for part in root.every():
        for key in _MEASURES:
            odd = [word for word in part.get(key).split() if _NO_NUMBER.fullmatch(word)]
            if odd:
                hint = "write a finite number"
                yield Fault(f"`{key}` of <{part.tag}> holds '{odd[0]}'", line=part.line, column=1, hint=hint)


def _fault(reason: str, error: str) -> Fault:
    """What the compiler says, in its line."""
    if not error:
        return Fault(f"MuJoCo's compiler was stopped: {reason}", hint="make the model smaller, or split it")
    said = reason.removeprefix(f"{error}: ")
    lines = _LINE.findall(said)
    while (shorter := _NOISE.sub("", said).strip()) != said:
        said = shorter
    line = int(lines[-1]) if lines and int(lines[-1]) > 0 else None
    hint = "correct the model; `python -m mujoco.viewer --mjcf=FILE` shows it"
    return Fault(f"MuJoCo's compiler: {said}", line=line, column=None if line is None else 1, hint=hint)


def _included(root: Element, file: ModelFile) -> Iterator[Element]:
    """The roots of the files that are included; those that cannot be read the compiler tells of."""
    if file.path is None:
        return
    top, seen = file.path.parent, {file.path.resolve()}
    left = [(root, top)]
    while left:
        element, folder = left.pop()
        for part in element.every():
            if part.tag != "include" or not part.get("file"):
                continue
            places = [(at / part.get("file")) for at in (folder, top)]
            place = next((p for p in places if p.is_file()), None)
            if place is None or place.resolve() in seen:
                continue
            seen.add(place.resolve())
            if len(seen) > MOST_INCLUDED:
                hint = "split the model"
                raise SceneError(
                    (Fault(f"more than {MOST_INCLUDED} files are included", line=part.line, column=1, hint=hint),)
                )
            found = _read_part(place, part)
            yield found
            left.append((found, place.parent))


def _read_part(place: Path, part: Element) -> Element:
    try:
        return read_markup(place.read_bytes(), place.name)
    except SceneError as error:
        told = "; ".join(fault.message for fault in error.faults)
        message = f"the file '{part.get('file')}' cannot be included: {told}"
        raise SceneError((Fault(message, line=part.line, column=1, hint=error.faults[0].hint),)) from None
    except OSError as error:
        message = f"the file '{part.get('file')}' cannot be read: {error.strerror}"
        raise SceneError((Fault(message, line=part.line, column=1, hint="check the path"),)) from None
