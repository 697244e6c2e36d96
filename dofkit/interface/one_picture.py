"""One picture of the command line, from a scene's bytes to the file that is written; this runs in a worker."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from dofkit.base.errors import DofkitError
from dofkit.base.workers import Json
from dofkit.interface.one_file import answer_lines, streams
from dofkit.interface.supervised import Given
from dofkit.pictures.animation import Animation, animate
from dofkit.pictures.still import Picture, draw, graph, phase
from dofkit.scene.scene import Scene

_KINDS: Mapping[str, Callable[[Scene], Picture | Animation]] = {
    "mechanism": draw,
    "graph": graph,
    "directions": phase,
    "motion": animate,
}


def picture_lines(given: Given) -> Iterator[Json]:
    """What is printed of the picture of a file: where it was written."""
    return answer_lines(given, _written)


def _written(scene: Scene, given: Given) -> Iterator[Json]:
    if given.picture is None:
        raise DofkitError("no picture was asked for")
    place = Path(given.picture.path)
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        _KINDS[given.picture.kind](scene).save(place)
    except OSError as error:
        raise DofkitError(f"the picture cannot be written to '{place}': {error.strerror or error}") from None
    yield streams(f"{place}\n")
