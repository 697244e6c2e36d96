"""The picture and the motion of a scene, which need numpy."""

from __future__ import annotations

from typing import Any

from dofkit.pictures.animation import animate
from dofkit.pictures.player import player_data
from dofkit.pictures.still import draw
from dofkit.scene.reading import loads


def picture(text: str) -> dict[str, str]:
    """Return the picture of a scene as ``svg``, with its alternative text."""
    drawn = draw(loads(text))
    return {"svg": drawn.svg(), "alternative": drawn.alternative}


def motion(text: str) -> dict[str, Any]:
    """Return the player's ``data`` for the motion of a scene, with alternative text and notes."""
    moving = animate(loads(text))
    sketch = moving.sketch
    data = player_data(sketch, moving.clips, moving.program, moving.switches)
    return {"data": data, "alternative": sketch.alternative, "notes": list(sketch.notes)}
