"""The files that a model is made of besides its own: which there are, and in what state."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterator
from pathlib import Path

from dofkit.models.formats import is_model

#: Of so many files that are included, and of so many bytes of each, further parts are looked for.
MOST_LOOKED_INTO, MOST_BYTES = 300, 4_000_000
_FILE = re.compile(rb"""\bfile\s*=\s*["']([^"'<>]{1,500})["']""")
_FOLDER = re.compile(rb"""\b(?:meshdir|assetdir|texturedir)\s*=\s*["']([^"'<>]{0,500})["']""")


def state_of_parts(data: bytes, path: Path) -> str:
    """A digest of the files that a model names, by when they were changed and how long they are; empty for none.

    It changes where one of them does; what only the contents of a folder decide is not looked for.
    """
    found = sorted({f"{place}\0{_state(place)}" for place in _parts(data, path.parent)})
    if not found:
        return ""
    return hashlib.blake2b("\0".join(found).encode("utf-8", "surrogateescape"), digest_size=16).hexdigest()


def _parts(data: bytes, top: Path) -> Iterator[str]:
    """The places where a model's parts may stand, in files that it includes too."""
    left, seen = [(data, top)], set[str]()
    while left:
        text, folder = left.pop()
        below = {_text(name) for name in _FOLDER.findall(text)} | {""}
        for name in map(_text, _FILE.findall(text)):
            for place in {os.path.normpath(start / under / name) for start in (folder, top) for under in below}:
                if place not in seen:
                    seen.add(place)
                    yield place
                    if len(seen) < MOST_LOOKED_INTO and (more := _markup(place)):
                        left.append((more, Path(place).parent))


def _text(name: bytes) -> str:
    return name.decode("utf-8", "surrogateescape")


def _markup(place: str) -> bytes:
    """The beginning of a file that may name others."""
    try:
        if os.path.isfile(place) and place.lower().endswith((".xml", ".mjcf")):
            with open(place, "rb") as file:
                data = file.read(MOST_BYTES)
            return data if is_model(data) else b""
    except (OSError, ValueError):
        return b""
    return b""


def _state(place: str) -> str:
    try:
        told = os.stat(place)
    except (OSError, ValueError):
        return "absent"
    return f"{told.st_size} {told.st_mtime_ns}"
