"""Workplanes of a sketch that turn freely or lie on two lines, and the points that stay in one."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.expressions.text import to_text
from dofkit.models.model_document import SceneDraft, vector
from dofkit.models.sketch_file import Record
from dofkit.models.sketch_space import (
    PlaneFrame,
    SpacePlane,
    SpacePoint,
    SpaceVector,
    fixed_frame,
    fixed_vector,
    inner,
    moving_vector,
    squared,
)


def turning_frame(draft: SceneDraft, normal: Record, origin: SpacePoint | None, name: str) -> PlaneFrame:
    """Axes that turn freely, told by two points at distance 1 from the origin, across from each other."""
    drawn = fixed_frame(normal.turn("actNormal"))
    start = fixed_vector((0.0, 0.0, 0.0)) if origin is None else origin.place
    base = vector(start.drawn) if origin is None else origin.written
    axes = []
    for letter, axis in (("u", drawn.u), ("v", drawn.v)):
        at = start.plus(axis).drawn
        tip = draft.particle(f"{name}_{letter}", normal.line, at)
        axes.append(moving_vector([f"{c}_{tip}" for c in "xyz"], at).minus(start))
        if base is None:
            text = f"{to_text(squared(axes[-1]))} = 1"
            draft.constraint(f"{name}-turn-{letter}", "equation", normal.line, text=text)
        else:
            draft.constraint(f"{name}-turn-{letter}", "link", normal.line, between=[base, tip], length=1)
    draft.constraint(f"{name}-turn-uv", "equation", normal.line, text=f"{to_text(inner(*axes))} = 0")
    return PlaneFrame(axes[0], axes[1], axes[0].cross(axes[1]))


def frame_of_lines(draft: SceneDraft, group: Record, name: str, lines: tuple[SpaceVector, SpaceVector]) -> PlaneFrame:
    """The directions of a workplane through two lines: u along one, n = u x the other one, and v = n x u."""
    u = _vector(draft, group, f"{name}-u", lines[0].near_unit())
    n = _vector(draft, group, f"{name}-n", u.cross(lines[1]).near_unit())
    v = _vector(draft, group, f"{name}-v", n.cross(u))
    first, second = (v, u) if group.whole("predef.swapUV") else (u, v)
    signs = [-1 if group.whole(f"predef.negate{letter}") else 1 for letter in "UV"]
    side = signs[0] * signs[1] * (-1 if first is v else 1)
    return PlaneFrame(first.times(signs[0]), second.times(signs[1]), n.times(side), unit=False)


def _vector(draft: SceneDraft, group: Record, name: str, told: SpaceVector) -> SpaceVector:
    """A vector as three coordinates, which equations tell."""
    names = [f"{name[-1]}{c}_{name.partition('-')[0]}" for c in "xyz"]
    for one, value, part in zip(names, told.drawn, told.parts, strict=True):
        text = f"{draft.coordinate(one, value)} = {to_text(part)}"
        draft.constraint(f"{name}{one[1]}", "equation", group.line, text=text)
    return moving_vector(names, told.drawn)


def keep_in_plane(draft: SceneDraft, plane: SpacePlane, names: Sequence[str], name: str, line: int) -> None:
    """The particles of a workplane stay in it: n . (p - o) = 0."""
    fixed = plane.frame.constant and plane.origin.constant
    for one in ("",) if fixed else names:
        letters = [f"{c}_{one}" if one else c for c in "xyz"]
        here = moving_vector(letters, (0.0, 0.0, 0.0)).minus(plane.origin)
        text = f"{to_text(inner(plane.frame.n, here))} = 0"
        if one:
            draft.constraint(f"in-{name}-{one}", "equation", line, text=text)
        else:
            draft.constraint(f"in-{name}", "on", line, members=[*names], surface=text)
