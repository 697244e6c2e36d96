"""A sketch put on paper: its scale, its marks, names that do not overlap, title, answer, legend and notes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from dofkit.pictures.looks import GREY, INK, WHITE, Ink, ink_of, keys_of
from dofkit.pictures.outlines import outline
from dofkit.pictures.paper import HIGH, Mark, Page, ordered, width_of, wrapped
from dofkit.pictures.shapes import Array, Poses, Shape, Sketch
from dofkit.pictures.views import View, view_of

#: The sheet in points, its margin, room for names around the picture, and sizes of texts.
WIDTH, HEIGHT, MARGIN, ROOM = 460.0, 400.0, 14.0, 26.0
TITLE, ANSWER, NOTE, NAME = 12.5, 10.0, 8.0, 9.0
#: Distances (in sizes of its text) and directions in which a name is tried.
FARS, WAYS = (0.0, 1.3, 2.2, 3.4), 12
FAINT = Ink("#444444", layer=9)


class Fit(NamedTuple):
    """How the sketch stands on the sheet: points by a unit of length, and where the origin is."""

    scale: float
    shift: Array

    def put(self, seen: Array) -> Array:
        """Where on the sheet a point is."""
        return np.asarray(self.scale * seen[..., :2] + self.shift)


class Margins(NamedTuple):
    """What stands above and below the picture."""

    above: tuple[Mark, ...]
    below: tuple[Mark, ...]
    high: float
    low: float


def page_of(sketch: Sketch, poses: Poses | None = None, view: View | None = None, fit: Fit | None = None) -> Page:
    """A sketch on paper, with everything where ``poses`` put it (by default where it is drawn)."""
    here = sketch.poses if poses is None else poses
    seen_from = view or view_of(sketch)
    margins = margins_of(sketch)
    put = fit or fit_of(sketch, seen_from, [here])
    drawn = [(s, mark_of(sketch, s, here, seen_from, put)) for s in sketch.shapes if s.kind != "words"]
    if sketch.dimension == 3:
        drawn.sort(key=lambda pair: _nearness(sketch, pair[0], here, seen_from))
    names = [mark for mark, _ in names_of(sketch, here, seen_from, put)]
    axes = axes_marks(sketch, seen_from, margins)
    marks = [*ordered([mark for _, mark in drawn]), *axes, *names, *margins.above, *margins.below]
    return Page(WIDTH, HEIGHT, tuple(marks), sketch.title, sketch.alternative)


def _nearness(sketch: Sketch, shape: Shape, poses: Poses, view: View) -> float:
    return float(np.mean([view.seen(sketch.at(v, poses))[2] for v in shape.vertices]))


def margins_of(sketch: Sketch) -> Margins:
    """Title and answer above; legend and notes below."""
    above, y = [], HEIGHT - MARGIN
    for line in wrapped(sketch.title, TITLE, WIDTH - 2 * MARGIN):
        y -= TITLE
        above.append(Mark(((MARGIN, y),), FAINT._replace(line=INK), text=line, size=TITLE, align="start", bold=True))
        y -= TITLE * (HIGH - 1)
    for line in wrapped(sketch.answer, ANSWER, WIDTH - 2 * MARGIN):
        y -= ANSWER
        above.append(Mark(((MARGIN, y),), FAINT, text=line, size=ANSWER, align="start"))
        y -= ANSWER * (HIGH - 1)
    below, low = [], MARGIN
    lines = [line for note in sketch.notes for line in wrapped(note, NOTE, WIDTH - 2 * MARGIN)]
    for line in reversed(lines):
        below.append(Mark(((MARGIN, low),), FAINT, text=line, size=NOTE, align="start"))
        low += NOTE * HIGH
    rows = _legend(sketch)
    for row in reversed(rows):
        below += [_raised(mark, low) for mark in row]
        low += NOTE * HIGH * 1.15
    return Margins(tuple(above), tuple(below), y - 2.0, low + 2.0)


def _raised(mark: Mark, by: float) -> Mark:
    return mark._replace(spots=tuple((x, y + by) for x, y in mark.spots))


def _legend(sketch: Sketch) -> list[list[Mark]]:
    """A sample and a word for each state that occurs, in rows."""
    rows: list[list[Mark]] = [[]]
    x = MARGIN
    for ink, text in keys_of(sketch.shapes):
        wide = 22 + width_of(text, NOTE) + 14
        if x + wide > WIDTH - MARGIN and rows[-1]:
            rows.append([])
            x = MARGIN
        if ink.fill:
            spots = ((x, 0.0), (x + 16, 0.0), (x + 16, 7.0), (x, 7.0))
        else:
            spots = ((x, 3.5), (x + 16, 3.5))
        rows[-1].append(Mark(spots, ink, closed=bool(ink.fill)))
        rows[-1].append(Mark(((x + 21, 0.5),), FAINT, text=text, size=NOTE, align="start"))
        x += wide
    return [row for row in rows if row]


def fit_of(sketch: Sketch, view: View, every: Iterable[Poses]) -> Fit:
    """The largest scale at which the sketch, wherever it moves, stays on the sheet."""
    margins = margins_of(sketch)
    shapes = [s for s in sketch.shapes if s.kind != "words"]
    seen = [outline(sketch, s, poses, view)[:, :2] for poses in every for s in shapes]
    points = np.vstack(seen) if seen else np.zeros((1, 2))
    points = points[np.all(np.isfinite(points), axis=1)]
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    sides = np.maximum(high - low, 0.15 * max(sketch.size, float(np.max(high - low)), 1e-9))
    wide, tall = WIDTH - 2 * (MARGIN + ROOM), margins.high - margins.low - 2 * ROOM * 0.7
    scale = float(min(wide / sides[0], tall / sides[1]))
    middle = np.array([WIDTH / 2, (margins.high + margins.low) / 2])
    return Fit(scale, middle - scale * (low + high) / 2)


def mark_of(sketch: Sketch, shape: Shape, poses: Poses, view: View, fit: Fit) -> Mark:
    """A shape on the sheet."""
    spots = fit.put(outline(sketch, shape, poses, view))
    told = tuple((float(x), float(y)) for x, y in spots)
    closed = shape.kind in ("area", "hull", "ball")
    ink = ink_of(shape)
    if not closed:
        ink = ink._replace(fill=None)
    return Mark(told, ink, closed=closed, owner=shape.owner)


def axes_marks(sketch: Sketch, view: View, margins: Margins) -> Iterator[Mark]:
    """The directions of the world, in a corner."""
    if not sketch.axes:
        return
    long = 20.0
    ways = np.eye(3)[: sketch.dimension]
    seen = [view.seen(way)[:2] for way in ways]
    root = np.array([MARGIN + 8, margins.low + 8]) - np.minimum(0.0, np.min([*seen, np.zeros(2)], axis=0)) * long
    ink = Ink(GREY, 1.0, layer=8)
    for name, way in zip(sketch.axes, seen, strict=False):
        tip = root + long * way
        size = float(np.linalg.norm(way))
        yield Mark(((root[0], root[1]), (tip[0], tip[1])), ink)
        if size > 0.15:
            ahead, side = way / size * 4.0, np.array([-way[1], way[0]]) / size * 2.0
            barbs = (tip - ahead + side, tip, tip - ahead - side)
            yield Mark(tuple((float(x), float(y)) for x, y in barbs), ink)
            at = tip + way / size * 7.0
            yield Mark(((at[0], at[1] - 2.8),), Ink(GREY, layer=9), text=name, size=NOTE)


def names_of(sketch: Sketch, poses: Poses, view: View, fit: Fit) -> list[tuple[Mark, Array]]:
    """The names, each beside what it names where it covers least; and how far each is from there."""
    margins = margins_of(sketch)
    words = [s for s in sketch.shapes if s.kind == "words"]
    busy = _busy(sketch, poses, view, fit)
    taken: list[tuple[float, float, float, float]] = []
    found = []
    for shape in words:
        spots = [fit.put(view.seen(sketch.at(v, poses))) for v in shape.vertices]
        anchor = np.mean(spots, axis=0)
        size = NAME if len(words) < 26 else NAME - 2
        offset = _best_offset(shape, anchor, size, (busy, taken, margins))
        at = anchor + offset
        wide = width_of(shape.text, size) / 2
        taken.append((at[0] - wide, at[0] + wide, at[1] - size / 2, at[1] + size / 2))
        ink = ink_of(shape)
        mark = Mark(
            ((float(at[0]), float(at[1]) - 0.35 * size),), ink, text=shape.text, size=size, owner=shape.owner, bold=False
        )
        found.append((mark, offset))
    return found


def _busy(sketch: Sketch, poses: Poses, view: View, fit: Fit) -> Array:
    """Points of all that is drawn, a few points of length apart."""
    found = [np.zeros((0, 2))]
    for shape in sketch.shapes:
        if shape.kind == "words" or shape.role in ("hatch",):
            continue
        spots = fit.put(outline(sketch, shape, poses, view))
        ends = np.vstack([spots[1:], spots[:1]]) if shape.kind in ("area", "hull", "ball") else spots[1:]
        for a, b in zip(spots, ends, strict=False):
            count = 1 + int(min(60.0, math.hypot(*(b - a)) / 5.0))
            found.append(a + np.outer(np.arange(count) / count, b - a))
    return np.vstack(found)


def _best_offset(
    shape: Shape,
    anchor: Array,
    size: float,
    around: tuple[Array, Sequence[tuple[float, float, float, float]], Margins],
) -> Array:
    """Where beside its anchor a name covers least."""
    busy, taken, margins = around
    wide, high = width_of(shape.text, size) / 2 + 1.5, size / 2 + 1.0
    best, least = np.zeros(2), math.inf
    for far in FARS:
        for k in range(WAYS if far else 1):
            angle = 2 * math.pi * (k + 1.5) / WAYS
            way = np.array([math.cos(angle), math.sin(angle)])
            at = anchor + way * (far * size) + way * np.array([wide, high]) * (1 if far else 0)
            inside = (np.abs(busy[:, 0] - at[0]) < wide) & (np.abs(busy[:, 1] - at[1]) < high)
            cost = float(np.sum(inside)) + 0.7 * far + (2.5 if not far and len(shape.vertices) < 3 else 0.0)
            for x0, x1, y0, y1 in taken:
                if at[0] - wide < x1 and at[0] + wide > x0 and at[1] - high < y1 and at[1] + high > y0:
                    cost += 40.0
            if not (wide < at[0] < WIDTH - wide and margins.low + high < at[1] < margins.high - high):
                cost += 60.0
            if cost < least:
                best, least = at - anchor, cost
    return best


#: What a name is written on, so that lines below do not disturb it.
HALO = WHITE
