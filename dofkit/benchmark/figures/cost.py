"""Cost against size, log-log: a small panel for each family, with the fitted exponents."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from dofkit.benchmark.figures.style import Look, looks, seconds_text, settle, sheet, spread
from dofkit.benchmark.record import AUTO, ChartRun, Fit, MedianTime

#: So many panels, and so many of them in a row.
PANELS, ACROSS = 12, 3
#: Points between the lines of the labels.
APART = 9.0


def draw(chart: ChartRun) -> Figure | None:
    """The families that grow most."""
    panels = chosen(chart)
    if not panels:
        return None
    look = looks(dict.fromkeys(score.method for score in chart.scores))
    across = min(ACROSS, len(panels))
    down = math.ceil(len(panels) / across)
    title = "What size costs: processor time against size, with the exponent of each method"
    figure = sheet(4.3 * across + 0.2, 2.9 * down, title, chart.captions["cost"])
    grid = figure.subplots(down, across, squeeze=False).ravel()
    low = min(point.seconds for point in chart.points)
    for axes, (family, question) in zip(grid, panels, strict=False):
        points = [point for point in chart.points if (point.family, point.question) == (family, question)]
        fits = {fit.method: fit for fit in chart.fits if (fit.family, fit.question) == (family, question)}
        _panel(axes, f"{family}: {question}", points, fits, look, (low / 2, 3 * chart.ran.limit), chart.ran.limit)
    for axes in grid[len(panels) :]:
        axes.set_axis_off()
    settle(figure)
    for axes, (family, question) in zip(grid, panels, strict=False):
        points = [point for point in chart.points if (point.family, point.question) == (family, question)]
        fits = {fit.method: fit for fit in chart.fits if (fit.family, fit.question) == (family, question)}
        _names(axes, points, fits, look)
    return figure


def chosen(chart: ChartRun) -> list[tuple[str, str]]:
    """Families and one question of each: those whose largest member is the most times the smallest."""
    sizes: dict[tuple[str, str], list[int]] = {}
    for point in chart.points:
        sizes.setdefault((point.family, point.question), []).append(point.size)
    growth = {key: (max(row) / min(row), len(set(row))) for key, row in sizes.items()}
    best = [max((k for k in growth if k[0] == f), key=lambda k: growth[k]) for f in dict.fromkeys(f for f, _ in growth)]
    most = sorted(best, key=lambda key: growth[key], reverse=True)[:PANELS]
    return [key for key in best if key in most]


def _panel(
    axes: Axes,
    title: str,
    points: Sequence[MedianTime],
    fits: Mapping[str, Fit],
    look: Mapping[str, Look],
    y: tuple[float, float],
    limit: float,
) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    sizes = sorted({point.size for point in points})
    axes.set_xlim(sizes[0] / 1.15, sizes[-1] * (sizes[-1] / sizes[0]) ** 0.62 * 1.3)
    axes.set_ylim(*y)
    axes.set_title(title)
    axes.set_xlabel("size")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda seconds, _: seconds_text(seconds)))
    ticks = [m * 10**k for k in range(9) for m in (1, 2, 5) if sizes[0] <= m * 10**k <= sizes[-1]]
    ticks = ticks if len(ticks) > 2 else sizes
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_locator(NullLocator())
    axes.plot([sizes[0], sizes[-1]], [limit, limit], color="#999999", linewidth=0.8, linestyle=(0, (2, 2)), zorder=1)
    for method in dict.fromkeys(point.method for point in points):
        curve = sorted((p for p in points if p.method == method), key=lambda p: p.size)
        done = [p for p in curve if p.timed_out < p.trials]
        late = [p for p in curve if p.timed_out == p.trials][:1]
        one = look[method]
        above = 6 if method == AUTO else 3
        shown = sorted(done + late, key=lambda p: p.size)
        axes.plot(
            [p.size for p in shown], [p.seconds for p in shown], color=one.colour, linewidth=one.width, zorder=above
        )
        marks = 9 if one.mark == "*" else 4.5
        axes.plot(
            [p.size for p in done],
            [p.seconds for p in done],
            one.mark,
            color=one.colour,
            markersize=marks,
            zorder=above,
        )
        if late:
            axes.plot(
                [late[0].size], [limit], marker="x", markersize=7, markeredgewidth=1.8, color=one.colour, zorder=7
            )


def _names(axes: Axes, points: Sequence[MedianTime], fits: Mapping[str, Fit], look: Mapping[str, Look]) -> None:
    """The methods at the right, each at the height of its curve's end; the fitted exponents with them."""
    methods = list(dict.fromkeys(point.method for point in points))
    largest = max(point.size for point in points)
    ends = [max((p for p in points if p.method == m), key=lambda p: p.size) for m in methods]
    figure = axes.get_figure(root=True)
    pixels = 1.0 if figure is None else figure.dpi / 72
    heights = [float(axes.transData.transform((p.size, p.seconds))[1]) for p in ends]
    bottom, top = axes.get_window_extent().intervaly
    moved = spread(heights, APART * pixels)
    shift = min(0.0, top - 2 - max(moved)) or max(0.0, bottom + 2 - min(moved))
    for method, height in zip(methods, moved, strict=True):
        fit = fits.get(method)
        power = f"  $n^{{{fit.exponent:.2f}}}$ ± {fit.error:.2f}" if fit else ""
        y = float(axes.transData.inverted().transform((0, height + shift))[1])
        style: dict[str, Any] = {"color": look[method].colour, "fontweight": "bold" if method == AUTO else "normal"}
        axes.text(largest * 1.12, y, f"{method}{power}", fontsize=7.2, va="center", ha="left", **style)
