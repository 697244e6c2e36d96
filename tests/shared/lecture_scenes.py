"""Many lecture scenes: those of the catalog, each copy with a name and a note of its own."""

from __future__ import annotations

from itertools import cycle
from pathlib import Path

import dofkit

#: The folders of the catalog that are lectures and their exercises, by what a scene says of its source.
_LECTURES = ("l6", "f12", "pb3")


def lecture_names() -> list[str]:
    """The scenes of the lectures."""
    shelves = Path(__file__).parents[2] / "catalog"
    return [path.stem for shelf in _LECTURES for path in sorted((shelves / shelf).glob("*.yaml"))]


def written_copies(folder: Path, number: int) -> None:
    """Write so many scenes, each into a file of its own; no two are the same text."""
    folder.mkdir(parents=True)
    for k, name in zip(range(number), cycle(lecture_names()), strict=False):
        (folder / f"{k:06}-{name}.yaml").write_text(f"{dofkit.catalog_text(name)}# copy {k}\n", encoding="utf-8")
