"""Files of scenes as they are handed to workers: their bytes, and what tells a changed one from what it was."""

from __future__ import annotations

import hashlib
import os
import re
import stat
import uuid
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from dofkit.base.documents import MOST_BYTES
from dofkit.interface.supervised import data_of, places_of
from dofkit.models.formats import is_model

#: An attribute of a model that names another file.
_INCLUDES = re.compile(rb"\bfile\s*=")


class SceneGiven(NamedTuple):
    """A file as it was named, and its bytes; None where there is none, as for a name of the catalog.

    ``mark``: where it includes other files, a text that no other run has, so that no earlier result is taken for it.
    ``certificate``: where its certificate is written.
    """

    file: str
    data: bytes | None
    mark: str = ""
    certificate: str | None = None

    @property
    def size(self) -> int:
        """About how many bytes it holds."""
        return len(self.data or b"") + 200

    @property
    def key(self) -> str:
        """What tells it from another, and from itself when it was otherwise."""
        named = f"{self.file}\0{self.mark}\0".encode("utf-8", "surrogateescape")
        return hashlib.blake2b(named + (b"-" if self.data is None else b"+" + self.data), digest_size=16).hexdigest()


def scenes_given(files: Iterable[str], certificate: str | None) -> Iterator[SceneGiven]:
    """Every file with its bytes, as they are asked for. ``certificate``: the folder of certificates."""
    known = list(files)
    for file, place in zip(known, places_of(known, certificate), strict=True):
        data = _bytes(file)
        includes = data is not None and is_model(data) and _INCLUDES.search(data)
        yield SceneGiven(file, data, uuid.uuid4().hex if includes else "", place)


def _bytes(file: str) -> bytes | None:
    try:
        if file != "-" and stat.S_ISREG(os.stat(file).st_mode):
            with open(file, "rb") as source:
                return source.read(MOST_BYTES + 1)
    except (OSError, ValueError):
        return None
    return data_of(file)
