"""The files of scenes: the bytes at a path or of a catalog name, and what is near where there is none."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from dofkit.base.documents import MOST_BYTES
from dofkit.base.errors import Fault, SceneError
from dofkit.base.wording import nearest_title
from dofkit.scene.catalog import catalog_names, catalog_text, nearest_hint


class FoundFile(NamedTuple):
    """What was found under a path or a catalog name; ``path`` is None for what is of the catalog."""

    name: str
    data: bytes | str
    path: Path | None = None


def find(source: str | os.PathLike[str]) -> FoundFile:
    """The bytes of the file at a path, or of the catalog scene of that name."""
    shown = os.fsdecode(source)
    path = Path(shown)
    try:
        if path.exists() and not path.is_dir():
            with path.open("rb") as file:
                return FoundFile(_printable(path.stem), file.read(MOST_BYTES + 1), path)
        if shown in catalog_names():
            return FoundFile(shown, catalog_text(shown))
        folder = path.is_dir()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        message = f"'{_brief(shown)}' cannot be read: {reason[:1].lower()}{reason[1:]}"
        raise SceneError((Fault(message, hint="check the path and the permissions"),), shown) from None
    if folder:
        fault = Fault(f"'{shown}' is a folder, not a scene", hint=f"write '{path / '*.yaml'}' for the files in it")
        raise SceneError((fault,), shown)
    raise SceneError((_missing(shown, path),), shown)


def _missing(shown: str, path: Path) -> Fault:
    if "\n" in shown:
        message = "this is the text of a scene, not a path or a name"
        return Fault(message, hint="read a text with dofkit.loads(text)")
    in_folder = path.parent != Path(".") or path.suffix in (".yaml", ".yml", ".json")
    beside = _beside(path)
    near = nearest_title(path.name, beside)
    message = f"there is no file '{_brief(shown)}'"
    if not in_folder:
        message += ", and no scene of that name in the catalog"
    if near:
        return Fault(message, hint=f"did you mean '{path.parent / near}'?")
    if in_folder and not path.parent.is_dir():
        return Fault(message, hint=f"there is no folder '{path.parent}' either")
    return Fault(message, hint=nearest_hint(path.stem if in_folder else shown))


def _beside(path: Path) -> list[str]:
    try:
        with os.scandir(path.parent) as entries:
            return [entry.name for entry, _ in zip(entries, range(2000), strict=False) if entry.is_file()]
    except OSError:
        return []


def _printable(name: str) -> str:
    """A file's name without the half characters that stand for bytes of another encoding."""
    return name.encode("utf-8", "replace").decode("utf-8")


def _brief(text: str) -> str:
    return text if len(text) <= 80 else text[:60] + "..."
