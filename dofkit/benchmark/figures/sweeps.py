"""Sweeps: tolerances on rounded coordinates, and the precision of balls."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import NullLocator

from dofkit.benchmark.figures.labels import Label, Piece, Place, place
from dofkit.benchmark.figures.style import OUTCOME_COLOURS, OUTCOME_HATCHES, settle, sheet
from dofkit.benchmark.record import ChartRun, Step

#: Of the curves of a sweep so many are drawn, at most: the first, the last, and some between.
CURVES = 7
TOLERANCES = {
    "tolerance": "numeric: ranks by singular values",
    "scene tolerance": "dofkit: the tolerance written in the scene",
}
_DRAWN = ("right", "wrong", "undecided")
#: The part of a cell that its bar fills, across and upwards.
WIDE, HIGH = 0.9, 0.8


def tolerance(chart: ChartRun) -> Figure | None:
    """A row for each rounding, a cell for each tolerance: what is right, wrong and undecided of what was rounded."""
    shown = [name for name in TOLERANCES if any(step.sweep == name for step in chart.steps)]
    if not shown:
        return None
    groups = chosen(list(dict.fromkeys(step.group for step in chart.steps if step.sweep in shown)))
    title = "Rounded coordinates: which tolerance recovers the unrounded geometry"
    size = (5.4 * len(shown) + (1.4 if len(shown) == 1 else 0), 0.42 * len(groups) + 0.9)
    figure = sheet(*size, title, chart.captions["tolerance"], _legend())
    grid = figure.subplots(1, len(shown), squeeze=False, sharey=True).ravel()
    for axes, name in zip(grid, shown, strict=True):
        _strips(axes, TOLERANCES[name], [step for step in chart.steps if step.sweep == name], groups)
    grid[0].set_yticks(range(len(groups)), [f"{group} digits" for group in groups])
    grid[0].set_ylim(len(groups) - 0.4, -0.6)
    return figure


def _strips(axes: Axes, heading: str, steps: Sequence[Step], groups: Sequence[str]) -> None:
    powers = sorted({round(math.log10(step.value)) for step in steps})
    for step in steps:
        if step.group in groups:
            _bar(axes, round(math.log10(step.value)), groups.index(step.group), step)
    for y, group in enumerate(groups):
        axes.plot([-int(group)], [y + HIGH / 2 + 0.09], marker="^", markersize=5.5, color="#000000", clip_on=False)
    axes.set_xlim(powers[0] - 0.6, powers[-1] + 0.6)
    ticks = powers[:: max(1, math.ceil(len(powers) / 8))]
    axes.set_xticks(ticks, [f"$10^{{{k}}}$" for k in ticks])
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)
    axes.set_title(heading, fontsize=9.5)
    axes.set_xlabel("tolerance")


def _bar(axes: Axes, x: int, y: int, step: Step) -> None:
    """Shares of the outcomes, one above the other."""
    low = y + HIGH / 2
    for outcome, count in zip(_DRAWN, (step.right, step.wrong, step.undecided), strict=True):
        if count:
            high = HIGH * count / step.trials
            look: dict[str, Any] = {"facecolor": OUTCOME_COLOURS[outcome], "edgecolor": "#FFFFFF", "linewidth": 0.0}
            look["hatch"] = OUTCOME_HATCHES.get(outcome)
            axes.add_patch(Rectangle((x - WIDE / 2, low - high), WIDE, high, **look))
            low -= high


def _legend() -> list[Any]:
    mark: dict[str, Any] = {"marker": "^", "color": "#000000", "linestyle": "none"}
    bars = [
        Patch(facecolor=OUTCOME_COLOURS[o], edgecolor="#888888", hatch=OUTCOME_HATCHES.get(o), label=o) for o in _DRAWN
    ]
    return [*bars, Line2D([], [], label="tolerance equal to the rounding", **mark)]


def bits(chart: ChartRun) -> Figure | None:
    """Share of wrong answers against the bits of balls, a curve for each gap."""
    steps = [step for step in chart.steps if step.sweep == "bits"]
    if not steps:
        return None
    title = "Balls: bits needed to recognize a gap"
    figure = sheet(7.4, 3.6, title, chart.captions["bits"])
    axes = figure.subplots()
    labels, lines = _curves(axes, steps)
    settle(figure)
    place(axes, labels, 3.5, lines)
    return figure


def _curves(axes: Axes, steps: Sequence[Step]) -> tuple[list[Label], list[tuple[Place, Place]]]:
    """Draw them; the name of each gap where its curve leaves for zero, and the lines that names keep off."""
    groups = chosen(list(dict.fromkeys(step.group for step in steps)))
    values = sorted({step.value for step in steps})
    axes.set_xscale("log", base=2)
    axes.set_xlim(values[0] * 0.9, values[-1] * 1.1)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(values, [f"{value:g}" for value in values])
    axes.set_ylim(-3, 75)
    axes.set_xlabel("precision (bits)")
    axes.set_ylabel(f"wrong answers (% of up to {max(step.trials for step in steps)} trials)")
    labels, lines = list[Label](), list[tuple[Place, Place]]()
    for i, group in enumerate(groups):
        curve = sorted((step for step in steps if step.group == group), key=lambda step: step.value)
        corners = [(step.value, 100 * step.wrong / step.trials) for step in curve]
        colour = to_hex(colormaps["viridis"](0.88 * i / max(1, len(groups) - 1)))
        x, y = zip(*corners, strict=True)
        axes.plot(x, y, marker="osD^vPX"[i % 7], markersize=4.5, color=colour, linewidth=1.5)
        last = max((k for k, (_, share) in enumerate(corners) if share), default=0)
        labels.append(Label(corners[last], ([Piece(_gap(group), colour, "bold")],)))
        lines += [piece for one, other in pairwise(corners) for piece in _pieces(one, other)]
    return labels, lines


def _pieces(one: Place, other: Place) -> Iterator[tuple[Place, Place]]:
    """A straight line of this plot in short pieces."""
    ratio, rise = other[0] / one[0], other[1] - one[1]
    corners = [(one[0] * ratio ** (k / 8), one[1] + rise * k / 8) for k in range(9)]
    yield from pairwise(corners)


def _gap(group: str) -> str:
    return f"gap $10^{{{round(math.log10(_number(group)[0]))}}}$"


def chosen(groups: list[str]) -> list[str]:
    """At most so many, in the order of their numbers."""
    order = sorted(groups, key=_number)
    if len(order) <= CURVES:
        return order
    return [order[round(i * (len(order) - 1) / (CURVES - 1))] for i in range(CURVES)]


def _number(group: str) -> tuple[float, str]:
    top, _, bottom = group.partition("/")
    try:
        return float(top) / float(bottom or 1), group
    except (ValueError, ZeroDivisionError):
        return math.inf, group
