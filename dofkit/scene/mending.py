"""Faults that faults of shape hide: a document is mended where its shape is wrong, and its texts are checked then.

What was meant takes the place of a misspelt key or type; a neutral entry that of any other faulty one. Faults that only
the mending brings about are left out.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from numbers import Number
from typing import Any

from pydantic import ValidationError

from dofkit.base.errors import Fault
from dofkit.scene.constraints import TYPES
from dofkit.scene.constraints.base import Equation
from dofkit.scene.fields import faults_of
from dofkit.scene.hints import SUGGESTED, UNKNOWN_KEY, UNKNOWN_TYPE
from dofkit.scene.lowering import check
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import Path, StandardWords, standard_words

#: What a scene is mended so often: a mended key may have a faulty value, and that another one in it.
MOST_ROUNDS = 5
#: What stands in place of an entry that cannot be mended; a name is added to those that declare one.
_NEUTRAL: Mapping[str, Any] = {
    "constraints": {"type": Equation.kind(), "text": "0 = 0"},
    "forces": {"type": "gravity"},
    "picture": {"axes": None},
    "parameters": "real",
    "tolerance": 0.999,
}
_DECLARING = ("particles", "bodies", "coordinates", "parameters", "functions")
#: Keys of a particle or a body that no text of a constraint depends on.
_OF_NO_TEXT = ("at", "mass", "inertia")
#: That a name is not declared, or is that of another kind of thing.
_UNDECLARED = re.compile(
    r"(?:`\w+`: )?(?:there is no \w+ ['`]|`.*` is not declared|"
    r"'(?P<joint>.*)' is not an angle or a displacement of a joint)"
)


def faults_hidden_by(faults: Sequence[Fault], value: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield the faults that appear without the entries of these faults of structure; none without a dimension."""
    mended = _MendedScene(value)
    for _ in range(MOST_ROUNDS):
        if not mended.mend(faults):
            return
        try:
            remaining = check(Scene.model_validate(mended.words.value))
            yield from mended.original_faults(remaining)
            return
        except ValidationError as error:
            faults = faults_of(error)
            yield from mended.original_faults(faults)


class _MendedScene:
    """A document in standard words that is being mended.

    ``_lost``: names that are not declared any more, in quotes; ``_undeclared``: there are others, which are not known;
    ``_guessed``: constraints and shapes whose kind was guessed; ``_altered``: the names of constraints whose kind may
    be another one now, and with it what they measure.
    """

    def __init__(self, value: Mapping[str, Any]) -> None:
        self.words = StandardWords(copy.deepcopy(dict(value)), {})
        self._lost: set[str] = set()
        self._undeclared = False
        self._guessed: set[Path] = set()
        self._altered: set[str] = set()

    def mend(self, faults: Sequence[Fault]) -> bool:
        """Mend what is faulty; return whether it makes sense then."""
        for fault in sorted(faults, key=lambda fault: not fault.message.startswith(UNKNOWN_KEY)):
            placed = self.words.value.get("particles") or self.words.value.get("bodies")
            if not fault.where or (fault.where[0] == "dimension" and placed):
                return False
            self._mend(fault, fault.where)
        mended = standard_words(self.words.value)
        places = {path: self.words.written(origin) for path, origin in mended.places.items()}
        self.words = StandardWords(mended.value, {**self.words.places, **places})
        return True

    def original_faults(self, faults: Sequence[Fault]) -> Iterator[Fault]:
        """Yield the faults that the mending did not bring about, at the places as they were written."""
        for fault in faults:
            undeclared = _UNDECLARED.match(fault.message)
            if undeclared and (self._undeclared or any(name in fault.message for name in self._lost)):
                continue
            joint = undeclared["joint"] if undeclared else None
            if joint is not None and not self._altered.isdisjoint((joint, joint.rpartition(".")[0])):
                continue
            if undeclared or fault.where[:2] not in self._guessed:
                yield replace(fault, where=self.words.written(fault.where))

    def _mend(self, fault: Fault, where: Path) -> None:
        """Repair, replace or remove the entry at fault, so that the faults of others can be found."""
        owner = self._at(where[:-1])
        suggested = SUGGESTED.match(fault.hint or "")
        meant = suggested[1] if suggested else ""
        if owner is None or ("needs" in fault.message and where[-1] in owner):
            return
        if fault.message.startswith(UNKNOWN_KEY):
            part = owner.pop(where[-1], None)
            self._guessed |= {where[:2]} if where[0] == "picture" else set()
            may_declare = not meant and not isinstance(part, Number) and (len(where) == 1 or where[0] in _DECLARING)
            self._undeclared |= may_declare
            if meant and meant not in owner:
                owner[meant] = part
                places = {(*where[:-1], meant): self.words.written(where)}
                self.words = self.words._replace(places={**self.words.places, **places})
        elif fault.message.startswith(UNKNOWN_TYPE) and meant in TYPES and where[:2] not in self._guessed:
            owner["type"] = meant
            self._guessed.add(where[:2])
            self._altered.add(_name_of(owner, where[1]))
        elif where[0] in ("particles", "bodies") and where[2:] and where[2] in _OF_NO_TEXT:
            self._at(where[:2]).pop(where[2])
        else:
            self._replace(where)

    def _replace(self, where: Path) -> None:
        """Put a neutral entry in the place of a faulty one, or leave out what is none."""
        section, key = str(where[0]), where[1] if where[1:] else None
        entries = self.words.value.get(section)
        self._undeclared |= section in _DECLARING and not isinstance(key, str)
        if isinstance(entries, list) and isinstance(key, int):
            if section == "constraints":
                name = _name_of(entries[key], key)
                self._lost.add(f"'{name}'")
                self._altered.add(name)
            entries[key] = _NEUTRAL.get(section, f"lost_{key}")
        elif isinstance(entries, dict) and section == "parameters":
            entries[key] = _NEUTRAL[section]
        elif section == "tolerance":
            self.words.value[section] = _NEUTRAL[section]
        elif isinstance(entries, dict) and key is not None:
            entries.pop(key, None)
            self._lost |= {f"`{key}`"} if section in _DECLARING else set()
        else:
            self.words.value.pop(section, None)

    def _at(self, path: Path) -> Any:
        """Return what is at a path; None where there is nothing."""
        part: Any = self.words.value
        for key in path:
            is_there = (isinstance(part, dict) and key in part) or (isinstance(part, list) and isinstance(key, int))
            part = part[key] if is_there else None
        return part


def _name_of(constraint: object, place: int | str) -> str:
    """Return the name of a constraint, which is that of its place where it has none."""
    name = constraint.get("name") if isinstance(constraint, dict) else None
    return str(name or (f"c{place + 1}" if isinstance(place, int) else place))
