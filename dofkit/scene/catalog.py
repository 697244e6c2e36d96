"""The catalog: one scene a file, found by its stem, from an installed package as from a checkout."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path

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
    return list(_files())


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
    file = _files().get(name)
    if file is None:
        raise SceneError((Fault(f"there is no scene '{name}' in the catalog", hint=nearest_hint(name)),), name)
    return file.read_text(encoding="utf-8")


def catalog_titles() -> dict[str, str]:
    """The title of every scene, by name."""
    return {name: _title(file.read_text(encoding="utf-8")) for name, file in _files().items()}


def catalog_search(words: Sequence[str]) -> dict[str, str]:
    """The titles of the scenes in which all words occur, by name: those with them in name or title first.

    Raises SceneError where there is none.

    >>> "disc-rolling-on-plane" in catalog_search(["rolling", "disc"])
    True
    """
    titles, wanted = catalog_titles(), [word.casefold() for word in words]
    in_title = [n for n, title in titles.items() if all(w in f"{n} {title}".casefold() for w in wanted)]
    in_text = [n for n, f in _files().items() if all(w in f.read_text(encoding="utf-8").casefold() for w in wanted)]
    found = {name: titles[name] for name in (*in_title, *in_text)}
    if not found:
        said = " ".join(words)
        raise SceneError((Fault(f"no scene of the catalog contains '{said}'", hint=nearest_hint(said)),), said)
    return found


def nearest_hint(name: str) -> str:
    """The catalog's name that looks most like ``name``, as a hint."""
    near = nearest_title(name, catalog_names())
    return f"did you mean '{near}'?" if near else "'dofkit catalog' lists the names"


@cache
def _files() -> dict[str, Traversable]:
    found: dict[str, Traversable] = {}
    root = catalog_folder()
    folders = sorted((entry for entry in root.iterdir() if entry.is_dir()), key=lambda entry: entry.name)
    for folder in folders:
        for file in sorted(folder.iterdir(), key=lambda entry: entry.name.split(".")):
            if file.name.endswith(".yaml"):
                found.setdefault(file.name.removesuffix(".yaml"), file)
    return found


def catalog_folder() -> Traversable:
    """Where the catalog's scenes are. Raises SceneError where they are not installed."""
    package = resources.files("dofkit")
    packaged = package / "_catalog"
    if packaged.is_dir():
        return packaged
    beside = Path(str(package)).parent / "catalog"
    if beside.is_dir():
        return beside
    raise SceneError((Fault("the catalog is not installed", hint="install dofkit again"),), "catalog")


def _title(text: str) -> str:
    match = _TITLE.search(text)
    return (match["double"] or match["single"] or match["plain"] or "").strip() if match else ""
