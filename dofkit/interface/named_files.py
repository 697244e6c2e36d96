"""The files that arguments name: a folder or a pattern stands for the scenes and models in it, in order."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable, Iterator

from dofkit.models.formats import LOOKED_AT, is_known_model
from dofkit.scene.catalog import catalog_names

#: How the files of scenes and models end; of those that end as the last do a folder holds many others.
ENDINGS, OF_MANY_KINDS = (".json", ".mjcf", ".slvs", ".urdf", ".yaml", ".yml"), (".xml",)


def named_files(arguments: Iterable[str]) -> list[str]:
    """Every file that is named, in the order given; those of a folder or a pattern by their names.

    What names nothing stands as it is: whoever reads it says what is wrong.
    """
    return [file for argument in arguments for file in _named(argument)]


def _named(argument: str) -> list[str]:
    if os.path.isdir(argument) and not _is_catalogued(argument):
        return list(_below(argument)) or [argument]
    if glob.has_magic(argument) and not os.path.exists(argument):
        matched = sorted(glob.iglob(argument, recursive=True))
        return [file for path in matched for file in (_below(path) if os.path.isdir(path) else [path])] or [argument]
    return [argument]


def _is_catalogued(name: str) -> bool:
    """Is it a scene of the catalog, which has the same name as a folder here?"""
    return name in catalog_names()


def _below(folder: str) -> Iterator[str]:
    """The scenes and models in a folder and those in it; nothing that is hidden, and no link is followed."""
    for place, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(files):
            path = os.path.join(place, name)
            if not name.startswith(".") and (name.lower().endswith(ENDINGS) or _is_model(path)):
                yield path


def _is_model(path: str) -> bool:
    """Is it XML of a kind that is read?"""
    if not path.lower().endswith(OF_MANY_KINDS):
        return False
    try:
        with open(path, "rb") as file:
            return is_known_model(file.read(LOOKED_AT))
    except OSError:
        return False
