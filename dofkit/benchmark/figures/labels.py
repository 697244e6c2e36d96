"""Labels beside marks: in several colours, covering no mark and no other label, their leaders crossing none."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.offsetbox import AnnotationBbox, HPacker, TextArea, VPacker
from matplotlib.transforms import Bbox

Pixel = tuple[float, float]
Place = tuple[float, float]
#: Where a label may stand beside its mark: in which directions, and how many radii away; the best first.
_TURNS, _AWAY = (0, 8, 4, 12, 2, 6, 14, 10, 1, 7, 15, 9, 3, 5, 13, 11), (1.5, 2.6, 4.2, 6.0, 8.0)
SIZE = 8.0


class Piece(NamedTuple):
    """A part of a line of text."""

    text: str
    colour: str
    weight: str = "normal"


class Label(NamedTuple):
    """Lines of text for the mark at a place in data."""

    at: Place
    lines: tuple[list[Piece], ...]


class _Spot(NamedTuple):
    """Where a label would lie, its middle away from the mark by so much, and how far it is."""

    box: Bbox
    away: Pixel
    rank: int

    @property
    def far(self) -> bool:
        """Is a leader needed?"""
        return self.rank >= len(_TURNS)


@dataclass
class _Room:
    """What is taken of a panel, in pixels: marks, lines and labels; ``leaders`` join labels to far marks."""

    inside: Bbox
    taken: list[Bbox]
    leaders: list[tuple[Pixel, Pixel]] = field(default_factory=list)

    def cost(self, spot: _Spot, middle: Pixel) -> float:
        """How much would be covered or cut off or crossed, weighed heavily, and how far away it is."""
        box = spot.box
        area = box.width * box.height
        common = [Bbox.intersection(box, other) for other in self.taken]
        covered = sum(one.width * one.height for one in common if one is not None)
        kept = Bbox.intersection(box, self.inside)
        cost = 100 * (covered + area - (0 if kept is None else kept.width * kept.height)) / area + 0.05 * spot.rank
        cost += 60 * sum(_meets(box, *leader) for leader in self.leaders)
        if spot.far:
            end = _nearest(box, middle)
            others = [other for other in self.taken if not other.contains(*middle)]
            cost += 3 + 60 * sum(_meets(other, middle, end) for other in others)
        return float(cost)

    def take(self, spot: _Spot, middle: Pixel) -> None:
        """Put a label there."""
        self.taken.append(spot.box)
        if spot.far:
            self.leaders.append((middle, _nearest(spot.box, middle)))


def place(axes: Axes, labels: Sequence[Label], radius: float, lines: Sequence[tuple[Place, Place]] = ()) -> None:
    """Draw each label where it covers nothing and stays inside, off ``lines`` (in data). On a settled figure."""
    figure = axes.get_figure(root=True)
    if figure is None:
        return
    pixel = figure.dpi / 72
    reach = radius * pixel
    middles = [_pixels(axes, label.at) for label in labels]
    marks = [_hull(middle, middle, reach) for middle in middles]
    drawn = [_hull(_pixels(axes, one), _pixels(axes, other), pixel) for one, other in lines]
    room = _Room(axes.get_window_extent(), marks + drawn)
    for label, middle in zip(labels, middles, strict=True):
        box = _drawn(axes, label)
        size = box.get_window_extent()
        best = min(_spots(middle, size, reach), key=lambda spot: room.cost(spot, middle))
        box.xybox = (best.away[0] / pixel, best.away[1] / pixel)
        if box.arrow_patch is not None:
            box.arrow_patch.set_visible(best.far)
        room.take(best, middle)


def _drawn(axes: Axes, label: Label) -> AnnotationBbox:
    rows: list[Artist] = [
        HPacker(children=[_area(piece) for piece in line], align="baseline", pad=0, sep=0) for line in label.lines
    ]
    packed = VPacker(children=rows, align="left", pad=0, sep=1.5)
    about: dict[str, Any] = {"xycoords": "data", "boxcoords": "offset points", "frameon": False, "pad": 0}
    arrow = {"arrowstyle": "-", "linewidth": 0.6, "color": "#888888", "shrinkA": 0, "shrinkB": 3}
    box = AnnotationBbox(packed, label.at, (0.0, 0.0), arrowprops=arrow, annotation_clip=False, zorder=9, **about)
    axes.add_artist(box)
    return box


def _area(piece: Piece) -> TextArea:
    return TextArea(piece.text, textprops={"color": piece.colour, "fontsize": SIZE, "fontweight": piece.weight})


def _spots(middle: Pixel, size: Bbox, reach: float) -> Iterator[_Spot]:
    """Where a label of that size may lie: its nearest edge so many radii away in each direction."""
    rank = 0
    for away in _AWAY:
        for turn in _TURNS:
            x, y = math.cos(math.pi * turn / 8), math.sin(math.pi * turn / 8)
            across = away * reach * x + size.width / 2 * (1 if x > 0.3 else -1 if x < -0.3 else 0)
            up = away * reach * y + size.height / 2 * (1 if y > 0.3 else -1 if y < -0.3 else 0)
            left, low = middle[0] + across - size.width / 2, middle[1] + up - size.height / 2
            yield _Spot(Bbox.from_bounds(left, low, size.width, size.height), (across, up), rank)
            rank += 1


def _nearest(box: Bbox, middle: Pixel) -> Pixel:
    """The point of a box that is nearest to a place."""
    return min(max(middle[0], box.x0), box.x1), min(max(middle[1], box.y0), box.y1)


def _meets(box: Bbox, start: Pixel, end: Pixel) -> bool:
    """Does a straight line run over a box?"""
    steps = 40
    return any(
        box.contains(start[0] + (end[0] - start[0]) * k / steps, start[1] + (end[1] - start[1]) * k / steps)
        for k in range(steps)
    )


def _hull(one: Pixel, other: Pixel, margin: float) -> Bbox:
    (a, b), (c, d) = one, other
    return Bbox.from_extents(min(a, c) - margin, min(b, d) - margin, max(a, c) + margin, max(b, d) + margin)


def _pixels(axes: Axes, at: Place) -> Pixel:
    x, y = axes.transData.transform(at)
    return float(x), float(y)
