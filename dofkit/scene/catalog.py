"""The files of scenes: the content at a path or of a catalog name, and the nearest name if there is neither.

The catalog has one scene in each file, named by the file's stem, in an installed package and in a checkout.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import NamedTuple

from dofkit.base.documents import MOST_BYTES
from dofkit.base.errors import Fault, SceneError
from dofkit.base.wording import nearest_title

_TITLE = re.compile(r"^title:[ \t]*(?:\"(?P<double>[^\"\\\n]*)\"|'(?P<single>[^'\n]*)'|(?P<plain>[^\"'\n#]+))", re.M)


def catalog_names() -> list[str]:
    """Return the names of the catalog's scenes, folder by folder.

    Raises
    ------
    SceneError
        If the catalog is not installed.

    Examples
    --------
    >>> import dofkit
    >>> "four-bar-linkage" in dofkit.catalog_names()
    True
    """
    return list(catalog_files())


def catalog_text(name: str) -> str:
    """Return the YAML text of a catalog scene.

    Parameters
    ----------
    name
        One of `catalog_names`.

    Raises
    ------
    SceneError
        If there is no such scene; the hint is the nearest name.

    Examples
    --------
    >>> import dofkit
    >>> dofkit.loads(dofkit.catalog_text("four-bar-linkage")).dimension
    2
    """
    file = catalog_files().get(name)
    if file is None:
        raise SceneError((Fault(f"there is no scene '{name}' in the catalog", hint=nearest_hint(name)),), name)
    return file.read_text(encoding="utf-8")


def catalog_titles() -> dict[str, str]:
    """Return {name: title} of every scene in the catalog."""
    return {name: _title(file.read_text(encoding="utf-8")) for name, file in catalog_files().items()}


def catalog_search(words: Sequence[str]) -> dict[str, str]:
    """Return {name: title} of the scenes that contain all words: first those with the words in name or title.

    Raises SceneError if no scene contains them.

    >>> "disc-rolling-on-plane" in catalog_search(["rolling", "disc"])
    True
    """
    titles, wanted = catalog_titles(), [word.casefold() for word in words]
    in_title = [n for n, title in titles.items() if all(w in f"{n} {title}".casefold() for w in wanted)]
    in_text = [n for n in titles if all(w in catalog_text(n).casefold() for w in wanted)]
    matching = {name: titles[name] for name in (*in_title, *in_text)}
    if not matching:
        text = " ".join(words)
        raise SceneError((Fault(f"no scene of the catalog contains '{text}'", hint=nearest_hint(text)),), text)
    return matching


def nearest_hint(name: str) -> str:
    """Return a hint with the catalog's name that is most similar to ``name``."""
    near = nearest_title(name, catalog_names())
    return f"did you mean '{near}'?" if near else "'dofkit catalog' lists the names"


@cache
def catalog_files() -> dict[str, Traversable]:
    """Return {name: file} of every scene, folder by folder."""
    files: dict[str, Traversable] = {}
    root = catalog_folder()
    folders = sorted((entry for entry in root.iterdir() if entry.is_dir()), key=lambda entry: entry.name)
    for folder in folders:
        for file in sorted(folder.iterdir(), key=lambda entry: entry.name.split(".")):
            if file.name.endswith(".yaml"):
                files.setdefault(file.name.removesuffix(".yaml"), file)
    return files


def catalog_folder() -> Traversable:
    """Return the folder of the catalog's scenes. Raises SceneError if the catalog is not installed."""
    package = resources.files("dofkit")
    packaged = package / "_catalog"
    if packaged.is_dir():
        return packaged
    checkout = Path(str(package)).parent / "catalog"
    if checkout.is_dir():
        return checkout
    raise SceneError((Fault("the catalog is not installed", hint="install dofkit again"),), "catalog")


def _title(text: str) -> str:
    match = _TITLE.search(text)
    return (match["double"] or match["single"] or match["plain"] or "").strip() if match else ""


class FoundFile(NamedTuple):
    """The content of a scene's file; ``path`` is None for a scene of the catalog."""

    name: str
    data: bytes | str
    path: Path | None = None


def find(source: str | os.PathLike[str]) -> FoundFile:
    """Return the file at a path, or of the catalog scene of that name. Raises SceneError if there is neither."""
    name = os.fsdecode(source)
    path = Path(name)
    try:
        if path.exists() and not path.is_dir():
            with path.open("rb") as file:
                return FoundFile(_printable(path.stem), file.read(MOST_BYTES + 1), path)
        if name in catalog_names():
            return FoundFile(name, catalog_text(name))
        folder = path.is_dir()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        message = f"'{_brief(name)}' cannot be read: {reason[:1].lower()}{reason[1:]}"
        raise SceneError((Fault(message, hint="check the path and the permissions"),), name) from None
    if folder:
        hint = f"write '{path / '*.yaml'}' for the files in it" if any(path.glob("*.yaml")) else "no scene is in it"
        raise SceneError((Fault(f"'{name}' is a folder, not a scene", hint=hint),), name)
    raise SceneError((_missing(name, path),), name)


def _missing(name: str, path: Path) -> Fault:
    """Return the fault that there is no file or catalog scene ``name``, with a hint to the nearest name."""
    if "\n" in name:
        message = "this is the text of a scene, not a path or a name"
        return Fault(message, hint="read a text with dofkit.loads(text)")
    in_folder = path.parent != Path(".") or path.suffix != ""
    neighbours = _files_beside(path)
    near = nearest_title(path.name, neighbours if in_folder else [*catalog_names(), *neighbours])
    message = f"there is no file '{_brief(name)}'"
    if not in_folder:
        message += ", and no scene of that name in the catalog"
    if near:
        return Fault(message, hint=f"did you mean '{path.parent / near}'?")
    if in_folder and not path.parent.is_dir():
        return Fault(message, hint=f"there is no folder '{path.parent}' either")
    return Fault(message, hint=nearest_hint(path.stem if in_folder else name))


def _files_beside(path: Path) -> list[str]:
    """Return the names of at most 2000 files in the folder of ``path``."""
    try:
        with os.scandir(path.parent) as entries:
            return [entry.name for entry, _ in zip(entries, range(2000), strict=False) if entry.is_file()]
    except OSError:
        return []


def _printable(name: str) -> str:
    """Return a file's name with `?` for lone surrogates, which stand for bytes of another encoding."""
    return name.encode("utf-8", "replace").decode("utf-8")


def _brief(text: str) -> str:
    return text if len(text) <= 80 else text[:60] + "..."
