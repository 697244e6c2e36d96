"""How a constraint type is drawn: strokes of a textbook's symbol, as data. `pictures/` draws them."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

#: A point of a symbol: along its axis, across it, and in space across both; in units of the symbol's size.
Spot = tuple[float, ...]

#: What a type draws besides strokes. ``bar``: a line between its points, ``bars``: between every two of them; ``rope``:
#: along its points, over pulleys; ``teeth``: two toothed wheels; ``wheel``: a disc or ball on the ground; ``profile``:
#: the curve that its relation describes, carried by its second member; ``locus``: curves and surfaces of its relations,
#: and ties between what they couple.
Run = Literal["", "bar", "bars", "rope", "teeth", "wheel", "profile", "locus"]


class Stroke(NamedTuple):
    """A line through positions (a ball of ``radius`` at a single one), carried by the member of that number."""

    positions: tuple[Spot, ...]
    member: int = 0
    closed: bool = False
    filled: bool = False
    radius: float = 0.5


class Symbol(NamedTuple):
    """A type's symbol in the plane (``plane``) and in ``space``, and its ``run``.

    ``rails``: half the length of rails, of which the ground's is hatched; without, what is fixed to the ground has a
    stand. ``size``: the field that holds a wheel's radius.
    """

    plane: tuple[Stroke, ...] = ()
    space: tuple[Stroke, ...] = ()
    run: Run = ""
    rails: float = 0.0
    size: str = ""


def arc(radius: float, start: float = 0.0, end: float = 360.0, x: float = 0.0) -> tuple[Spot, ...]:
    """Return an arc across the axis of space at ``x`` along it, from one angle to another in degrees."""
    count = max(2, round(abs(end - start) / 15))
    angles = [math.radians(start + (end - start) * k / count) for k in range(count + 1)]
    return tuple((x, radius * math.cos(a), radius * math.sin(a)) for a in angles)


def box(half: float, high: float) -> tuple[Spot, ...]:
    """Return the corners of a rectangle about the origin, along and across the axis."""
    return ((-half, -high), (half, -high), (half, high), (-half, high))


def rail(half: float, offset: float, member: int = 0) -> Stroke:
    """Return a line along the axis."""
    return Stroke(((-half, offset), (half, offset)), member)


def cylinder(radius: float, half: float, member: int = 0) -> tuple[Stroke, ...]:
    """Return the outline of a cylinder about the joint's axis, ``half`` its length each way, on one of its members."""
    ends = tuple(Stroke(arc(radius, x=x), member, closed=True, filled=True) for x in (-half, half))
    sides = (0.0, 90.0, 180.0, 270.0)
    lines = tuple(Stroke((arc(radius, a, a + 1, -half)[0], arc(radius, a, a + 1, half)[0]), member) for a in sides)
    return (*ends, *lines)


def prism(side: float, half: float, member: int = 0) -> tuple[Stroke, ...]:
    """Return the edges of a square prism along the axis of space."""
    corners = ((-side, -side), (side, -side), (side, side), (-side, side))
    ends = tuple(Stroke(tuple((x, *c) for c in corners), member, closed=True, filled=True) for x in (-half, half))
    return (*ends, *(Stroke(((-half, *c), (half, *c)), member) for c in corners))


def helix(radius: float, half: float, turns: int, member: int = 0) -> Stroke:
    """Return a right-handed thread about the axis of space."""
    count = 10 * turns
    angle = 2 * math.pi * turns / count
    positions = (
        (half * (2 * k / count - 1), radius * math.cos(angle * k), radius * math.sin(angle * k))
        for k in range(count + 1)
    )
    return Stroke(tuple(positions), member)


def plate(x: float, side: float, member: int = 0) -> Stroke:
    """Return a square across the axis of space."""
    corners = ((-side, -side), (side, -side), (side, side), (-side, side))
    return Stroke(tuple((x, *c) for c in corners), member, closed=True, filled=True)


def axle(half: float, member: int = 1) -> Stroke:
    """Return the axis itself."""
    return Stroke(((-half, 0.0, 0.0), (half, 0.0, 0.0)), member)


#: A pin or a ball: a small ring.
RING = Stroke(((0.0, 0.0, 0.0),), filled=True)
#: A point that is fixed.
POINT = Stroke(((0.0, 0.0, 0.0),), filled=True, radius=0.32)
