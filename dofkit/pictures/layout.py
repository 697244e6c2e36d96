"""A sketch put on paper: its scale, its marks, names that do not overlap, title, answer, legend and notes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from dofkit.pictures.paper import HIGH, Mark, Page, Spot, View, outline, view_of, width_of, wrapped
from dofkit.pictures.shapes import GREY, INK, Array, Ink, Poses, Shape, Sketch, ink_of, keys_of

#: The sheet in points, its margin, the space for names around the picture, and sizes of texts.
WIDTH, HEIGHT, MARGIN, ROOM = 460.0, 400.0, 14.0, 26.0
TITLE, ANSWER, NOTE, NAME = 12.5, 10.0, 8.0, 9.0
#: The greatest length of a ruler, in points.
RULER = 90.0
#: Distances (in text sizes) and number of directions at which a name is tried.
FARS, WAYS = (0.0, 1.3, 2.2, 3.4), 12
#: The least extent that fills the sheet, by the size of the sketch, so that a single dot is not magnified.
LEAST = 0.55
FAINT = Ink("#444444", layer=9)


class PaperScale(NamedTuple):
    """The map to the sheet: points per unit of length (``scale``), and the position of the origin (``shift``)."""

    scale: float
    shift: Array

    def put(self, seen: Array) -> Array:
        """Return the position on the sheet of a point in the view."""
        return np.asarray(self.scale * seen[..., :2] + self.shift)


class Standpoint(NamedTuple):
    """The view of a sketch, its map to the sheet, and the offset of each name from its anchor."""

    view: View
    fit: PaperScale
    offsets: tuple[Array, ...]


class Margins(NamedTuple):
    """The marks above and below the picture, and the heights ``high`` and ``low`` between which the picture is."""

    above: tuple[Mark, ...]
    below: tuple[Mark, ...]
    high: float
    low: float


def standpoint_of(sketch: Sketch, every: Sequence[Poses] = ()) -> Standpoint:
    """Return the view and scale with which a sketch stays on the sheet in its own and ``every`` pose."""
    view = view_of(sketch)
    fit = fit_of(sketch, view, [sketch.poses, *every])
    return Standpoint(view, fit, tuple(_offsets(sketch, view, fit)))


def page_of(
    sketch: Sketch, poses: Poses | None = None, standpoint: Standpoint | None = None, margins: Margins | None = None
) -> Page:
    """Return a sketch as a page, in ``poses`` (by default the sketch's own).

    With ``margins``, which are otherwise computed, the sheet ends at the lower edge of the marks above the picture.
    """
    here = sketch.poses if poses is None else poses
    view, fit, offsets = standpoint or standpoint_of(sketch)
    margins, height = (margins_of(sketch), HEIGHT) if margins is None else (margins, margins.high)
    drawn = [(s, mark_of(sketch, s, here, view, fit)) for s in sketch.shapes if s.kind != "words"]
    if sketch.dimension == 3:
        nearness = {id(s): float(np.mean([view.seen(sketch.at(v, here))[2] for v in s.vertices])) for s, _ in drawn}
        drawn.sort(key=lambda pair: nearness[id(pair[0])])
    names = _name_marks(sketch, here, view, fit, offsets)
    axes = [*axes_marks(sketch, view, margins), *_ruler_marks(sketch, fit, margins)]
    layers = sorted((mark for _, mark in drawn), key=lambda mark: mark.ink.layer)
    marks = [*layers, *axes, *names, *margins.above, *margins.below]
    return Page(WIDTH, height, tuple(marks), sketch.title, sketch.alternative)


def margins_of(sketch: Sketch) -> Margins:
    """Return the marks of title and answer above the picture, and of legend and notes below."""
    above, y = [], HEIGHT - MARGIN
    heads = [(line, TITLE, INK) for line in wrapped(sketch.title, TITLE, 0.88 * (WIDTH - 2 * MARGIN))]
    heads += [(line, ANSWER, FAINT.line) for line in wrapped(sketch.answer, ANSWER, WIDTH - 2 * MARGIN)]
    for line, size, colour in heads:
        ink = FAINT._replace(line=colour)
        above.append(_text_mark((MARGIN, y - size), line, size, ink)._replace(bold=size == TITLE))
        y -= size * HIGH
    below, low = [], MARGIN
    for line in reversed([line for note in sketch.notes for line in wrapped(note, NOTE, WIDTH - 2 * MARGIN)]):
        below.append(_text_mark((MARGIN, low), line, NOTE))
        low += NOTE * HIGH
    for row in reversed(_legend(sketch)):
        below += [mark._replace(positions=tuple((x, y + low) for x, y in mark.positions)) for mark in row]
        low += NOTE * HIGH * 1.15
    return Margins(tuple(above), tuple(below), y - 2.0, low + 2.0)


def _text_mark(position: Spot, text: str, size: float, ink: Ink = FAINT) -> Mark:
    return Mark((position,), ink, text=text, size=size, align="start")


def _legend(sketch: Sketch) -> list[list[Mark]]:
    """Return the legend as rows of marks, a sample and a text for each entry."""
    rows: list[list[Mark]] = [[]]
    x = MARGIN
    for ink, text in keys_of(sketch.shapes, sketch.meanings):
        wide = 22 + width_of(text, NOTE) + 14
        if x + wide > WIDTH - MARGIN and rows[-1]:
            rows.append([])
            x = MARGIN
        box = ((x, 0.0), (x + 16, 0.0), (x + 16, 7.0), (x, 7.0))
        positions = box if ink.fill else ((x, 3.5), (x + 16, 3.5))
        rows[-1] += [Mark(positions, ink, closed=bool(ink.fill)), _text_mark((x + 21, 0.5), text, NOTE)]
        x += wide
    return [row for row in rows if row]


def fit_of(sketch: Sketch, view: View, every: Iterable[Poses]) -> PaperScale:
    """Return the map to the sheet with the largest scale at which the sketch stays on it in all poses."""
    margins = margins_of(sketch)
    shapes = [s for s in sketch.shapes if s.kind != "words"]
    seen = [_box(sketch, s, poses, view) for poses in every for s in shapes]
    points = np.vstack(seen) if seen else np.zeros((1, 2))
    points = points[np.all(np.isfinite(points), axis=1)]
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    largest = float(np.max(high - low))
    low, high = _at_least(low, high, LEAST * sketch.size if largest < LEAST * sketch.size else 0.15 * largest)
    sides = high - low
    wide, tall = WIDTH - 2 * (MARGIN + ROOM), margins.high - margins.low - 2 * ROOM * 0.7
    scale = float(min(wide / sides[0], tall / sides[1]))
    middle = np.array([WIDTH / 2, (margins.high + margins.low) / 2])
    return PaperScale(scale, middle - scale * (low + high) / 2)


def _box(sketch: Sketch, shape: Shape, poses: Poses, view: View) -> Array:
    """Return points whose bounding box contains the shape in the view."""
    if shape.kind not in ("hull", "ball"):
        return outline(sketch, shape, poses, view)[:, :2]
    seen = np.array([view.seen(sketch.at(v, poses))[:2] for v in shape.vertices])
    return np.vstack([seen - shape.size, seen + shape.size])


def _at_least(low: Array, high: Array, least: float) -> tuple[Array, Array]:
    """Return the same box, with sides no shorter than ``least``."""
    more = np.maximum(0.0, least - (high - low)) / 2
    return low - more, high + more


def mark_of(sketch: Sketch, shape: Shape, poses: Poses, view: View, fit: PaperScale) -> Mark:
    """Return the mark of a shape on the sheet."""
    positions = fit.put(outline(sketch, shape, poses, view))
    closed = shape.kind in ("area", "hull", "ball")
    ink = ink_of(shape)
    return Mark(_spots(positions), ink if closed else ink._replace(fill=None), closed=closed, owner=shape.owner)


def _spots(points: Iterable[Array]) -> tuple[Spot, ...]:
    return tuple((float(x), float(y)) for x, y in points)


def axes_marks(sketch: Sketch, view: View, margins: Margins) -> Iterator[Mark]:
    """Yield the marks of the world's axes, in a corner."""
    if not sketch.axes:
        return
    long = 20.0
    directions = np.eye(3)[: sketch.dimension]
    seen = [view.seen(direction)[:2] for direction in directions]
    longest = max((width_of(name, NOTE) for name in sketch.axes[: sketch.dimension]), default=0.0)
    root = (
        np.array([MARGIN + max(8.0, longest / 2), margins.low + 8])
        - np.minimum(0.0, np.min([*seen, np.zeros(2)], axis=0)) * long
    )
    ink = Ink(GREY, 1.0, layer=8)
    for name, direction in zip(sketch.axes, seen, strict=False):
        tip = root + long * direction
        size = float(np.linalg.norm(direction))
        yield Mark(((root[0], root[1]), (tip[0], tip[1])), ink)
        if size > 0.15:
            ahead, side = direction / size * 4.0, np.array([-direction[1], direction[0]]) / size * 2.0
            barbs = (tip - ahead + side, tip, tip - ahead - side)
            yield Mark(_spots(barbs), ink)
            at = tip + direction / size * 7.0
            yield Mark(((at[0], at[1] - 2.8),), Ink(GREY, layer=9), text=name, size=NOTE)


def ruler_of(sketch: Sketch, fit: PaperScale) -> tuple[float, str] | None:
    """Return (round length of the ruler, its text); None if lengths in the picture mean nothing."""
    if not sketch.measurable:
        return None
    wanted = RULER / fit.scale
    power = 10.0 ** math.floor(math.log10(wanted))
    length = next(power * k for k in (5.0, 2.0, 1.0) if power * k <= wanted * (1 + 1e-9))
    return length, f"{length:g} unit{'' if length == 1 else 's'}"


def _ruler_marks(sketch: Sketch, fit: PaperScale, margins: Margins) -> Iterator[Mark]:
    """Yield the marks of a ruler, at the lower right."""
    ruler = ruler_of(sketch, fit)
    if ruler is None:
        return
    length, text = ruler
    right, y = WIDTH - MARGIN, margins.low + 12.0
    start = right - length * fit.scale
    ink = Ink(GREY, 1.0, layer=8)
    for positions in (((start, y), (right, y)), ((start, y - 3), (start, y + 3)), ((right, y - 3), (right, y + 3))):
        yield Mark(positions, ink)
    yield Mark(((right, y - 11.0),), Ink(GREY, layer=9), text=text, size=NOTE - 1, align="end")


def _offsets(sketch: Sketch, view: View, fit: PaperScale) -> Iterator[Array]:
    """Yield the offset of each name from its anchor at which it covers least."""
    margins = margins_of(sketch)
    words = [s for s in sketch.shapes if s.kind == "words"]
    busy = _busy(sketch, sketch.poses, view, fit)
    taken: list[tuple[float, float, float, float]] = []
    for shape in words:
        anchor, size = _anchor(sketch, shape, sketch.poses, view, fit), name_size(sketch)
        offset = _best_offset(shape, anchor, size, (busy, taken, margins))
        at, wide = anchor + offset, width_of(shape.text, size) / 2
        taken.append((at[0] - wide, at[0] + wide, at[1] - size / 2, at[1] + size / 2))
        yield offset


def name_size(sketch: Sketch) -> float:
    """Return the size of names, smaller if there are many."""
    return NAME if sum(s.kind == "words" for s in sketch.shapes) < 26 else NAME - 2


def _anchor(sketch: Sketch, shape: Shape, poses: Poses, view: View, fit: PaperScale) -> Array:
    return np.asarray(np.mean([fit.put(view.seen(sketch.at(v, poses))) for v in shape.vertices], axis=0))


def _name_marks(sketch: Sketch, poses: Poses, view: View, fit: PaperScale, offsets: Sequence[Array]) -> Iterator[Mark]:
    size = name_size(sketch)
    for shape, offset in zip((s for s in sketch.shapes if s.kind == "words"), offsets, strict=True):
        x, y = _anchor(sketch, shape, poses, view, fit) + offset
        position = (float(x), float(y) - 0.35 * size)
        yield Mark((position,), ink_of(shape), text=shape.text, size=size, owner=shape.owner)


def _busy(sketch: Sketch, poses: Poses, view: View, fit: PaperScale) -> Array:
    """Return positions on all marks but names, spaced by about five points."""
    points = [np.zeros((0, 2))]
    for shape in sketch.shapes:
        if shape.kind == "words":
            continue
        positions = fit.put(outline(sketch, shape, poses, view))
        ends = np.vstack([positions[1:], positions[:1]]) if shape.kind in ("area", "hull", "ball") else positions[1:]
        for a, b in zip(positions, ends, strict=False):
            count = 1 + int(min(60.0, math.hypot(*(b - a)) / 5.0))
            points.append(a + np.outer(np.arange(count) / count, b - a))
    return np.vstack(points)


def _best_offset(
    shape: Shape,
    anchor: Array,
    size: float,
    around: tuple[Array, Sequence[tuple[float, float, float, float]], Margins],
) -> Array:
    """Return the offset from its anchor at which a name covers least."""
    busy, taken, margins = around
    wide, high = width_of(shape.text, size) / 2 + 1.5, size / 2 + 1.0
    best, least = np.zeros(2), math.inf
    for far in FARS:
        for k in range(WAYS if far else 1):
            angle = 2 * math.pi * (k + 1.5) / WAYS
            direction = np.array([math.cos(angle), math.sin(angle)])
            at = anchor + direction * (far * size) + direction * np.array([wide, high]) * (1 if far else 0)
            inside = (np.abs(busy[:, 0] - at[0]) < wide) & (np.abs(busy[:, 1] - at[1]) < high)
            cost = float(np.sum(inside)) + 0.7 * far + (12.0 if not far and len(shape.vertices) < 3 else 0.0)
            for x0, x1, y0, y1 in taken:
                if at[0] - wide < x1 and at[0] + wide > x0 and at[1] - high < y1 and at[1] + high > y0:
                    cost += 40.0
            if not (wide < at[0] < WIDTH - wide and margins.low + high < at[1] < margins.high - high):
                cost += 60.0
            if cost < least:
                best, least = at - anchor, cost
    return best
