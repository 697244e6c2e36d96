"""Synonyms: a scene in other words is rewritten into the standard words if those have one meaning only.

``joints`` is a section like ``constraints``; a hinge is a ``revolute`` joint; ``direction`` may stand for ``axis``, and
``axis: x`` for its vector; a mapping with a ``text`` and no ``type`` is an equation; ``x₁`` is ``x_1``, ``ℓ`` is ``l``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

from dofkit.expressions.text.characters import GREEK_LETTERS, SUBSCRIPTS
from dofkit.expressions.text.tokens import without_latex
from dofkit.scene.constraints import TYPES
from dofkit.scene.constraints.base import Equation

Path = tuple[str | int, ...]

#: Keys that distinguish types: a synonym of a type is not replaced if such a key occurs that the type does not have.
_TELLING = ("point", "body", "members")
_SECTIONS = ("constraints", "joints")
_AXIS = re.compile(r"\s*([-+−]?)\s*([xyz])\s*")
#: Keys with prose about a scene, in which nothing is replaced.
SAID = frozenset({"title", "source", "notes", "left_out"})
_NAME = re.compile(
    rf"[A-Za-z{GREEK_LETTERS}][A-Za-z0-9_{GREEK_LETTERS}]*[{''.join(SUBSCRIPTS)}][A-Za-z0-9_{GREEK_LETTERS}{''.join(SUBSCRIPTS)}]*"
)
_PLAIN_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)
#: Characters by which a name may need rewriting.
_DECORATION = re.compile(rf"[\\{{$\x00-\x1f{''.join(SUBSCRIPTS)}ℓ\U0001d400-\U0001d7ff]")
_BELOW = re.compile(f"_?([{''.join(SUBSCRIPTS)}]+)")


class StandardWords(NamedTuple):
    """A scene's document in standard words; ``places``: {path in this document: path as written}, if different."""

    value: dict[str, Any]
    places: Mapping[Path, Path]

    def written(self, where: Path) -> Path:
        """Return a path in the standard words as a path of the document as it was written."""
        for size in range(len(where), 0, -1) if self.places else ():
            origin = self.places.get(where[:size])
            if origin is not None:
                return (*origin, *where[size:])
        return where


def standard_words(value: Mapping[str, Any]) -> StandardWords:
    """Return a copy of a scene's document with synonyms replaced by the standard words.

    >>> standard_words({"joints": [{"type": "pin", "between": ["ground", "a"], "axis": "z"}]}).value
    {'constraints': [{'type': 'revolute', 'between': ['ground', 'a'], 'axis': [0, 0, 1]}]}
    """
    places: dict[Path, Path] = {}
    standard = {key: part if key in SAID else _named(part, (key,), places) for key, part in value.items()}
    if "joints" in standard:
        standard = _one_section(standard, places)
    d = dimension_of(standard)
    for key, rewrite in (("constraints", _constraint), ("forces", _force)):
        if isinstance(standard.get(key), (list, tuple)):
            standard[key] = [
                rewrite(entry, (key, i), d, places) if isinstance(entry, Mapping) else entry
                for i, entry in enumerate(standard[key])
            ]
    return StandardWords(standard, places)


def dimension_of(value: Mapping[str, Any]) -> int:
    """Return the dimension in a scene's document; 3 if it is missing or invalid."""
    dimension = value.get("dimension", 3)
    return int(dimension) if not isinstance(dimension, str) and dimension in (1, 2, 3) else 3


def _one_section(value: dict[str, Any], places: dict[Path, Path]) -> dict[str, Any]:
    """Return the document with `constraints` and `joints` as one list, in the order in which they are written."""
    sections = [key for key in value if key in _SECTIONS and value[key] is not None]
    odd = [key for key in sections if not isinstance(value[key], (list, tuple))]
    if odd:
        places[("constraints",)] = (odd[0],)
        merged: Any = value[odd[0]]
    else:
        written = [(key, i) for key in sections for i in range(len(value[key]))]
        moved: dict[Path, Path] = {("constraints", n): p for n, p in enumerate(written) if p != ("constraints", n)}
        names = [(path, places.pop(path)) for path in list(places) if path[0] in _SECTIONS]
        moved_to: dict[Path, Path] = {path: ("constraints", n) for n, path in enumerate(written)}
        places.update(moved)
        places.update({(*moved_to[path[:2]], *path[2:]): origin for path, origin in names if path[:2] in moved_to})
        merged = [value[key][i] for key, i in written]
    first = next(key for key in value if key in _SECTIONS)
    kept = {
        ("constraints" if key == first else key): part
        for key, part in value.items()
        if key == first or key not in _SECTIONS
    }
    return {**kept, "constraints": merged}


def _constraint(entry: Mapping[str, Any], here: Path, dimension: int, places: dict[Path, Path]) -> Mapping[str, Any]:
    """Return a constraint with standard words for its type, keys and axes; changed paths are added to ``places``."""
    kind = entry.get("type")
    if kind is None and isinstance(entry.get("text"), str):
        kind = Equation.kind()
    elif isinstance(kind, str) and kind not in TYPES and kind in synonyms():
        meant = synonyms()[kind]
        fields = TYPES[meant].model_fields
        kind = kind if any(key in entry and key not in fields for key in _TELLING) else meant
    if kind != entry.get("type"):
        entry = {**entry, "type": kind}
    if isinstance(kind, str) and kind in TYPES and not entry.keys() <= TYPES[kind].model_fields.keys():
        others = other_keys(kind)
        standard = {key: others[key] for key in entry if key in others and others[key] not in entry}
        origin = places.get(here, here)
        places.update({(*here, key): (*origin, written) for written, key in standard.items()})
        entry = {standard.get(key, key): part for key, part in entry.items()}
    if isinstance(entry.get("axis"), str):
        entry = {**entry, "axis": _vector(entry["axis"], dimension)}
    if isinstance(entry.get("axes"), (list, tuple)):
        entry = {**entry, "axes": [_vector(axis, dimension) for axis in entry["axes"]]}
    return entry


@cache
def synonyms() -> Mapping[str, str]:
    """Return {synonym: constraint type}; no synonym is itself a type."""
    return {word: kind for kind, cls in TYPES.items() for word in cls.words().synonyms}


@cache
def other_keys(kind: str) -> Mapping[str, str]:
    """Return {synonym: field} for the fields of the constraint type ``kind``."""
    cls = TYPES.get(kind)
    if cls is None:
        return {}
    return {**({"direction": "axis"} if "axis" in cls.model_fields else {}), **cls.words().keys}


def _force(entry: Mapping[str, Any], here: Path, dimension: int, places: dict[Path, Path]) -> Mapping[str, Any]:
    del here, places
    if isinstance(entry.get("direction"), str):
        return {**entry, "direction": _vector(entry["direction"], dimension)}
    return entry


def _vector(axis: Any, dimension: int) -> Any:
    """Return ``x``, ``-z`` and the like as a vector, any other value unchanged."""
    match = _AXIS.fullmatch(axis) if isinstance(axis, str) else None
    if match is None or match[2] not in "xyz"[:dimension]:
        return axis
    sign = -1 if match[1] in ("-", "−") else 1
    return [sign if letter == match[2] else 0 for letter in "xyz"[:dimension]]


def _named(value: Any, here: Path, places: dict[Path, Path]) -> Any:
    """Return the value with texts and keys that are just a name, such as ``x₁`` or ``\\theta``, in plain letters.

    If nothing changes, the same object is returned; changed paths are added to ``places``.
    """
    if isinstance(value, str):
        return standard_name(value)
    if isinstance(value, Mapping):
        standard = {}
        for key, part in value.items():
            name = standard_name(key) if isinstance(key, str) else key
            if name != key and name in value:
                name = key
            if name != key:
                places[(*here, name)] = (*places.get(here, here), key)
            standard[name] = _named(part, (*here, name), places)
        same = all(a is b for a, b in zip(standard, value, strict=True)) and all(standard[k] is value[k] for k in value)
        return value if same else standard
    if isinstance(value, (list, tuple)):
        listed = [_named(part, (*here, i), places) for i, part in enumerate(value)]
        return value if all(a is b for a, b in zip(listed, value, strict=True)) else listed
    return value


def standard_name(name: str) -> str:
    r"""Return a name with its subscripts as ``_1`` and LaTeX or script letters as plain ones; any other text as it is.

    >>> standard_name("θ₁₂"), standard_name(r"\theta_{1}"), standard_name("ℓ"), standard_name("x₁ + 1")
    ('θ_12', 'theta_1', 'l', 'x₁ + 1')
    """
    if not _DECORATION.search(name):
        return name
    if not name.isascii() and _NAME.fullmatch(name):
        return _BELOW.sub(lambda match: "_" + "".join(SUBSCRIPTS[digit] for digit in match[1]), name)
    plain = without_latex(name)
    return plain if plain is not None and _PLAIN_NAME.fullmatch(plain) else name
