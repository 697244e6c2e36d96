"""The symbol of each constraint type, as in a textbook: strokes as data, which `dofkit.pictures` draws."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

#: A point of a symbol: coordinates along its axis and perpendicular to it (two of these in space), in symbol sizes.
Spot = tuple[float, ...]

#: What is drawn for a type besides strokes. ``bar``: a line between its points, ``bars``: between every two; ``rope``:
#: along its points, over pulleys; ``teeth``: two toothed wheels; ``wheel``: a disc or ball on the ground; ``profile``:
#: the curve of its relation, which moves with its second member; ``locus``: curves and surfaces of its relations, and
#: lines between the coupled parts.
Run = Literal["", "bar", "bars", "rope", "teeth", "wheel", "profile", "locus"]


class Stroke(NamedTuple):
    """A line through ``positions`` (a ball of ``radius`` if there is one), which moves with the joint's ``member``."""

    positions: tuple[Spot, ...]
    member: int = 0
    closed: bool = False
    filled: bool = False
    radius: float = 0.5


class Symbol(NamedTuple):
    """A type's symbol in the plane (``plane``) and in ``space``, and its ``run``.

    ``rails``: half the length of rails, hatched on the ground; with 0, a member on the ground has a stand instead.
    ``size``: the field with a wheel's radius.
    """

    plane: tuple[Stroke, ...] = ()
    space: tuple[Stroke, ...] = ()
    run: Run = ""
    rails: float = 0.0
    size: str = ""


def arc(radius: float, start: float = 0.0, end: float = 360.0, x: float = 0.0) -> tuple[Spot, ...]:
    """Return a circular arc about the axis of space, at ``x`` along the axis, from ``start`` to ``end`` in degrees."""
    count = max(2, round(abs(end - start) / 15))
    angles = [math.radians(start + (end - start) * k / count) for k in range(count + 1)]
    return tuple((x, radius * math.cos(a), radius * math.sin(a)) for a in angles)


def box(half: float, high: float) -> tuple[Spot, ...]:
    """Return the corners of a rectangle about the origin: ``half`` each way along the axis, ``high`` across."""
    return ((-half, -high), (half, -high), (half, high), (-half, high))


def rail(half: float, offset: float, member: int = 0) -> Stroke:
    """Return a line parallel to the axis, at ``offset`` across, ``half`` its length each way."""
    return Stroke(((-half, offset), (half, offset)), member)


def cylinder(radius: float, half: float, member: int = 0) -> tuple[Stroke, ...]:
    """Return the outline of a cylinder about the axis: two circles and four lines, ``half`` its length each way."""
    ends = tuple(Stroke(arc(radius, x=x), member, closed=True, filled=True) for x in (-half, half))
    sides = (0.0, 90.0, 180.0, 270.0)
    lines = tuple(Stroke((arc(radius, a, a + 1, -half)[0], arc(radius, a, a + 1, half)[0]), member) for a in sides)
    return (*ends, *lines)


def prism(side: float, half: float, member: int = 0) -> tuple[Stroke, ...]:
    """Return the edges of a square prism along the axis of space, with sides 2 ``side`` and length 2 ``half``."""
    ends = plate(-half, side, member), plate(half, side, member)
    return (*ends, *(Stroke(edge, member) for edge in zip(*(end.positions for end in ends), strict=True)))


def helix(radius: float, half: float, turns: int, member: int = 0) -> Stroke:
    """Return a right-handed thread about the axis of space, of length 2 ``half``."""
    count = 10 * turns
    angle = 2 * math.pi * turns / count
    positions = (
        (half * (2 * k / count - 1), radius * math.cos(angle * k), radius * math.sin(angle * k))
        for k in range(count + 1)
    )
    return Stroke(tuple(positions), member)


def plate(x: float, side: float, member: int = 0) -> Stroke:
    """Return a square perpendicular to the axis of space, at ``x`` along the axis, with sides 2 ``side``."""
    corners = ((-side, -side), (side, -side), (side, side), (-side, side))
    return Stroke(tuple((x, *c) for c in corners), member, closed=True, filled=True)


def axle(half: float, member: int = 1) -> Stroke:
    """Return a line on the axis of space, of length 2 ``half``."""
    return Stroke(((-half, 0.0, 0.0), (half, 0.0, 0.0)), member)


#: A pin or a ball: a small ring.
RING = Stroke(((0.0, 0.0, 0.0),), filled=True)
#: A point that is fixed.
POINT = Stroke(((0.0, 0.0, 0.0),), filled=True, radius=0.32)
