"""The picture of a problem: a file beside the assignment, or drawn from its scene without what it would tell."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from dofkit.base.errors import DofkitError
from dofkit.base.wording import no_such
from dofkit.homework.problem import DRAWN, UNDRAWN, Problem
from dofkit.report import Report
from dofkit.scene.scene import Scene

#: Draws a scene, under a title, as SVG; None for a scene that has no places. Its report is known.
Draw = Callable[[Scene, Report, str], str | None]
#: Endings of files -> what they are called on a page.
KINDS = {".svg": "image/svg+xml", ".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}
#: No picture of a problem is larger.
MOST_BYTES = 10_000_000


class FigureError(DofkitError):
    """A figure's file that cannot be shown."""


class SheetFigure(NamedTuple):
    """A picture: its path within the sheet's folder, and what is in it."""

    path: str
    data: bytes

    @property
    def kind(self) -> str:
        """What a page calls it."""
        return KINDS[Path(self.path).suffix.lower()]


def figure_of(problem: Problem, drawn: Callable[[], str | None], base: Path, name: str) -> SheetFigure | None:
    """The picture of a problem; ``drawn`` draws its scene, ``name`` is its path in the sheet without the ending.

    Raises FigureError, and OSError for what cannot be read.
    """
    if problem.figure == UNDRAWN:
        return None
    if problem.figure in (None, DRAWN):
        found = drawn()
        return None if found is None else SheetFigure(f"{name}.svg", found.encode())
    return file_of(str(problem.figure), base, name)


def file_of(source: str, base: Path, name: str) -> SheetFigure:
    """A picture's file; its path in the sheet begins with ``name``. Raises FigureError and OSError."""
    path = base / source
    if path.suffix.lower() not in KINDS:
        raise FigureError(f"the figure '{source}': {no_such(path.suffix or source, list(KINDS), 'ending')}")
    if not path.is_file():
        raise FigureError(f"there is no figure '{source}' in {base}; name a file beside the assignment, scene or none")
    if path.stat().st_size > MOST_BYTES:
        raise FigureError(f"the figure '{source}' has more than {MOST_BYTES} bytes")
    return SheetFigure(f"{name}{path.suffix.lower()}", path.read_bytes())
