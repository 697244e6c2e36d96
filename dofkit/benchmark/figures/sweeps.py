"""Sweeps: tolerances on rounded coordinates, the precision of balls, the size of a field's primes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from dofkit.benchmark.figures.style import settle, sheet, spread
from dofkit.benchmark.record import ChartRun, Step

#: Of the curves of a sweep so many are drawn, at most: the first, the last, and some between.
CURVES = 7


class Panel(NamedTuple):
    """A sweep, its heading, the names of its axes, and what is counted; ``binary``: powers of 2 along x."""

    sweep: str
    heading: str
    x: str
    y: str
    counted: Callable[[Step], int]
    group: Callable[[str], str]
    binary: bool = False


def _right(step: Step) -> int:
    return step.right


def _wrong(step: Step) -> int:
    return step.wrong


def _undecided(step: Step) -> int:
    return step.undecided


def _digits(group: str) -> str:
    return f"{group} digits" if group.isdigit() else group


def _gap(group: str) -> str:
    return f"gap $10^{{{round(math.log10(_number(group)[0]))}}}$"


_TOLERANCE = "tolerance"
NUMERIC = Panel("tolerance", "numeric: ranks by singular values", _TOLERANCE, "right answers", _right, _digits)
SCENE = Panel("scene tolerance", "dofkit: tolerance written in the scene", _TOLERANCE, "right answers", _right, _digits)
BITS = (
    Panel("bits", "balls: wrong, taking for 0 what is not", "precision (bits)", "wrong answers", _wrong, _gap, True),
    Panel("bits", "balls: undecided", "precision (bits)", "undecided", _undecided, _gap, True),
)
PRIMES = (
    Panel("prime bits", "field: wrong", "bits of its primes", "wrong answers", _wrong, str, True),
    Panel("prime bits", "field: undecided", "bits of its primes", "undecided", _undecided, str, True),
)


def tolerance(chart: ChartRun) -> Figure | None:
    """Share right against tolerance, a curve for each rounding."""
    return _draw(chart, (NUMERIC, SCENE), "Rounded coordinates: which tolerance finds the truth", "tolerance")


def bits(chart: ChartRun) -> Figure | None:
    """Shares wrong and undecided against the bits of balls, a curve for each gap."""
    return _draw(chart, BITS, "Balls: how many bits a gap needs", "bits")


def primes(chart: ChartRun) -> Figure | None:
    """Shares wrong and undecided against the bits of the primes, a curve for each question."""
    return _draw(chart, PRIMES, "Field: how large its primes must be", "primes")


def _draw(chart: ChartRun, panels: Sequence[Panel], title: str, name: str) -> Figure | None:
    shown = [panel for panel in panels if any(step.sweep == panel.sweep for step in chart.steps)]
    if not shown:
        return None
    figure = sheet(5.2 * len(shown) + (1.2 if len(shown) == 1 else 0), 3.6, title, chart.captions[name])
    grid = figure.subplots(1, len(shown), squeeze=False).ravel()
    ends = []
    for axes, panel in zip(grid, shown, strict=True):
        steps = [step for step in chart.steps if step.sweep == panel.sweep]
        ends.append(_panel(axes, panel, steps))
    settle(figure)
    for axes, names in zip(grid, ends, strict=True):
        _name(axes, names)
    return figure


def _panel(axes: Axes, panel: Panel, steps: Sequence[Step]) -> list[tuple[float, float, str, Any]]:
    """Draw it; of each curve the end (x, y), its name and its colour."""
    groups = _chosen(list(dict.fromkeys(step.group for step in steps)))
    values = sorted({step.value for step in steps})
    axes.set_xscale("log", base=2 if panel.binary else 10)
    span = max(2.0, values[-1] / values[0])
    axes.set_xlim(values[0] / span**0.03, values[-1] * span**0.27)
    axes.xaxis.set_minor_locator(NullLocator())
    ticks = values[:: max(1, math.ceil(len(values) / (12 if panel.binary else 6)))]
    axes.set_xticks(ticks, [f"{v:g}" if panel.binary else f"$10^{{{round(math.log10(v))}}}$" for v in ticks])
    most = max(100 * panel.counted(step) / step.trials for step in steps)
    top = 100.0 if most > 50 else max(10.0, 1.2 * most)
    axes.set_ylim(-0.04 * top, 1.04 * top)
    trials = max(step.trials for step in steps)
    axes.set_title(panel.heading, fontsize=9)
    axes.set_xlabel(panel.x)
    axes.set_ylabel(f"{panel.y} (% of up to {trials} trials)")
    ends = []
    for i, group in enumerate(groups):
        curve = sorted((step for step in steps if step.group == group), key=lambda step: step.value)
        y = [100 * panel.counted(step) / step.trials for step in curve]
        colour = colormaps["viridis"](0.88 * i / max(1, len(groups) - 1))
        mark = "osD^vPX"[i % 7]
        axes.plot([step.value for step in curve], y, marker=mark, markersize=4.5, color=colour, linewidth=1.5)
        ends.append((curve[-1].value, y[-1], panel.group(group), colour))
    return ends


def _name(axes: Axes, ends: Sequence[tuple[float, float, str, Any]]) -> None:
    figure = axes.get_figure(root=True)
    pixels = 1.0 if figure is None else figure.dpi / 72
    places = [axes.transData.transform((x, y)) for x, y, _, _ in ends]
    moved = spread([float(y) for _, y in places], 10 * pixels)
    low = axes.get_window_extent().y0 + 4 * pixels
    shift = max(0.0, low - min(moved))
    for (x, _, name, colour), height in zip(ends, moved, strict=True):
        right, up = axes.transData.transform((x, 0))[0] + 7 * pixels, height + shift
        at = axes.transData.inverted().transform((right, up))
        axes.text(float(at[0]), float(at[1]), name, color=colour, fontsize=8, va="center", fontweight="bold")


def _chosen(groups: list[str]) -> list[str]:
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
