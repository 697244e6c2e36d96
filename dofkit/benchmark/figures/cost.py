"""Cost against size, log-log: four families, ``auto`` and two others in colour, an exponent where a power law fits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from dofkit.benchmark.figures.style import Look, looks, seconds_text, settle, sheet, spread
from dofkit.benchmark.record import AUTO, ChartRun, Fit, MedianTime

#: So many panels, and so many of them in a row.
PANELS, ACROSS = 4, 2
#: Beside `auto`: the rivals with floating point and with a computer algebra system.
RIVALS = ("numeric", "symbolic")
#: A power law fits where the standard error of its exponent is less than this part of it, over so many sizes at least.
ERROR, POINTS = 0.1, 4
#: What is counted as the size, in the families whose size is a plain number of things; these are drawn first.
COUNTED: Mapping[str, str] = {
    "Henneberg": "joints", "links on a line": "links", "chains of bodies": "bodies", "trailers": "trailers",
    "chains of links": "links", "clusters": "clusters", "cliques": "joints", "double bananas": "spindles",
    "trees of bodies": "bodies",
}  # fmt: skip
GREY = "#C4C4C4"
#: Points between the lines of the labels.
APART = 10.0


class CostPanel(NamedTuple):
    """One family and question: what its members cost, and the power laws that fit, by method."""

    title: str
    size: str
    points: list[MedianTime]
    fits: Mapping[str, Fit]

    @property
    def sizes(self) -> list[int]:
        """The sizes of its members."""
        return sorted({point.size for point in self.points})


def draw(chart: ChartRun) -> Figure | None:
    """The families that grow most."""
    panels = [_panel(chart, *key) for key in steepest(chart)]
    if not panels:
        return None
    look = looks(dict.fromkeys(score.method for score in chart.scores))
    across = min(ACROSS, len(panels))
    down = math.ceil(len(panels) / across)
    title = "Processor time against size"
    figure = sheet(5.6 * across + 0.2, 3.3 * down, title, chart.captions["cost"])
    grid = figure.subplots(down, across, squeeze=False, sharey=True).ravel()
    low = min(point.seconds for panel in panels for point in panel.points)
    for axes, panel in zip(grid, panels, strict=False):
        axes.set_ylim(low / 2, 3 * chart.ran.limit)
        _scales(axes, panel)
        _curves(axes, panel.points, look, chart.ran.limit)
    for axes in grid[len(panels) :]:
        axes.set_axis_off()
    settle(figure)
    for axes, panel in zip(grid, panels, strict=False):
        _names(axes, panel, look)
    return figure


def _panel(chart: ChartRun, family: str, question: str) -> CostPanel:
    points = [point for point in chart.points if (point.family, point.question) == (family, question)]
    fits = {fit.method: fit for fit in chart.fits if (fit.family, fit.question) == (family, question) and holds(fit)}
    return CostPanel(f"{family}: {question}", COUNTED.get(family, "size"), points, fits)


def holds(fit: Fit) -> bool:
    """Is the curve a power law?"""
    return fit.error < ERROR * fit.exponent and fit.points >= POINTS


def steepest(chart: ChartRun) -> list[tuple[str, str]]:
    """Four families and one question of each: those that are counted, in this order, then those that grow most."""
    sizes: dict[tuple[str, str], list[int]] = {}
    for point in chart.points:
        sizes.setdefault((point.family, point.question), []).append(point.size)
    growth = {key: (max(row) / min(row), len(set(row))) for key, row in sizes.items()}
    best = [max((k for k in growth if k[0] == f), key=lambda k: growth[k]) for f in dict.fromkeys(f for f, _ in growth)]
    order = {family: i for i, family in enumerate(COUNTED)}
    return sorted(best, key=lambda key: (order.get(key[0], len(order)), -growth[key][0]))[:PANELS]


def _scales(axes: Axes, panel: CostPanel) -> None:
    """Both logarithmic, with room for the names at the right."""
    sizes = panel.sizes
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(sizes[0] / 1.15, sizes[-1] * (sizes[-1] / sizes[0]) ** 0.42 * 1.2)
    axes.set_title(panel.title)
    axes.set_xlabel(f"size: {panel.size}" if panel.size != "size" else "size")
    axes.set_ylabel("processor time")
    axes.tick_params(labelleft=True)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda seconds, _: seconds_text(seconds)))
    ticks = [m * 10**k for k in range(9) for m in (1, 2, 5) if sizes[0] <= m * 10**k <= sizes[-1]]
    ticks = ticks if len(ticks) > 2 else sizes
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_locator(NullLocator())


def shown(method: str) -> bool:
    """Is it drawn in its colour, and named?"""
    return method == AUTO or method in RIVALS


def _curves(axes: Axes, points: Sequence[MedianTime], look: Mapping[str, Look], limit: float) -> None:
    """A curve for every method, up to the first size that was not done within the limit: a cross on its line."""
    ends = min(point.size for point in points), max(point.size for point in points)
    axes.plot(ends, [limit, limit], color="#999999", linewidth=0.8, linestyle=(0, (2, 2)), zorder=1)
    for method in dict.fromkeys(point.method for point in points):
        curve = sorted((p for p in points if p.method == method), key=lambda p: p.size)
        done = [p for p in curve if p.timed_out < p.trials]
        late = [p for p in curve if p.timed_out == p.trials][:1]
        one, above = look[method], 6 if method == AUTO else 4 if shown(method) else 2
        colour, width = (one.colour, one.width) if shown(method) else (GREY, 1.0)
        axes.plot(*_xy(sorted(done + late, key=lambda p: p.size)), color=colour, linewidth=width, zorder=above)
        if shown(method):
            axes.plot(*_xy(done), one.mark, color=colour, markersize=9 if one.mark == "*" else 4.5, zorder=above)
        if late:
            cross: dict[str, Any] = {"marker": "x", "markersize": 7, "markeredgewidth": 1.8, "zorder": above}
            axes.plot([late[0].size], [limit], color=colour, **cross)


def _xy(points: Sequence[MedianTime]) -> tuple[list[int], list[float]]:
    return [p.size for p in points], [p.seconds for p in points]


def _names(axes: Axes, panel: CostPanel, look: Mapping[str, Look]) -> None:
    """The methods at the right, each at the height of its curve's end; the fitted exponents with them."""
    methods = list(dict.fromkeys(point.method for point in panel.points))
    largest = panel.sizes[-1]
    ends = [max((p for p in panel.points if p.method == m), key=lambda p: p.size) for m in methods]
    figure = axes.get_figure(root=True)
    pixels = 1.0 if figure is None else figure.dpi / 72
    heights = [float(axes.transData.transform((p.size, p.seconds))[1]) for p in ends]
    bottom, top = axes.get_window_extent().intervaly
    moved = spread(heights, APART * pixels)
    shift = min(0.0, top - 2 - max(moved)) or max(0.0, bottom + 2 - min(moved))
    for method, height in zip(methods, moved, strict=True):
        fit = panel.fits.get(method) if shown(method) else None
        power = f"  $n^{{{fit.exponent:.1f}}}$" if fit else ""
        y = float(axes.transData.inverted().transform((0, height + shift))[1])
        style: dict[str, Any] = {"color": look[method].colour if shown(method) else "#8A8A8A"}
        style["fontweight"] = "bold" if method == AUTO else "normal"
        size = 8.5 if shown(method) else 7.2
        axes.text(largest * 1.1, y, f"{method}{power}", fontsize=size, va="center", ha="left", **style)
