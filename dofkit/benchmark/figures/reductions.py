"""Modelling no more than needed: what each reduction saves, seen by switching it off."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from statistics import median
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from dofkit.benchmark.figures.style import sheet
from dofkit.benchmark.record import ChartRun, ReductionCost
from dofkit.relations.setting import REDUCTIONS

MADE_FOR, OTHERS = "#0072B2", "#B5B5B5"
Pairs = Sequence[tuple[ReductionCost, ReductionCost]]


def draw(chart: ChartRun) -> Figure | None:
    """Without against with, for each reduction: seconds, and what shrinks most of the model."""
    pairs = compared(chart)
    if not pairs:
        return None
    names = list(dict.fromkeys(row.off for row, _ in pairs))
    title = "What each reduction of the model saves"
    figure = sheet(11.8, 0.4 * len(names) + 1.0, title, chart.captions["reductions"], _legend())
    left, right = figure.subplots(1, 2, sharey=True)
    _panel(left, names, pairs, slowed, "seconds without the reduction / with it")
    _panel(right, names, pairs, grown, "size of the model without / with, where it shrinks most")
    left.set_yticks(range(len(names)), [_title(name) for name in names])
    left.set_ylim(len(names) - 0.5, -0.75)
    return figure


def compared(chart: ChartRun) -> list[tuple[ReductionCost, ReductionCost]]:
    """Each scene without a reduction beside the same with all of them."""
    whole = {row.scene: row for row in chart.reductions if not row.off}
    return [(row, whole[row.scene]) for row in chart.reductions if row.off and row.scene in whole]


def slowed(off: ReductionCost, on: ReductionCost) -> float:
    """How many times longer it takes without the reduction."""
    return off.seconds / on.seconds


def grown(off: ReductionCost, on: ReductionCost) -> float:
    """Coordinates, relations, forms, the largest block, or the coordinates that are followed: what shrinks most."""
    parts = ("coordinates", "relations", "forms", "largest", "followed")
    ratios = [getattr(off, part) / max(1, getattr(on, part)) for part in parts if getattr(off, part)]
    return float(max(ratios, default=1.0))


def _panel(
    axes: Axes, names: Sequence[str], pairs: Pairs, of: Callable[[ReductionCost, ReductionCost], float], heading: str
) -> None:
    axes.set_xscale("log")
    axes.axvline(1, color="#666666", linewidth=1.0, zorder=1)
    every = [1.0]
    for y, name in enumerate(names):
        rows = [(off, on) for off, on in pairs if off.off == name and on.seconds > 0 and off.seconds > 0]
        for ours, colour, size in ((False, OTHERS, 16), (True, MADE_FOR, 26)):
            dots = [of(off, on) for off, on in rows if (off.family == name) == ours]
            axes.scatter(dots, [y] * len(dots), s=size, color=colour, alpha=0.75, linewidths=0, zorder=3)
            every += dots
        own = [of(off, on) for off, on in rows if off.family == name] or [of(off, on) for off, on in rows]
        if own:
            middle = median(own)
            axes.plot([middle, middle], [y - 0.3, y + 0.3], color="#000000", linewidth=2.2, zorder=4)
            about: dict[str, Any] = {"transform": axes.get_yaxis_transform(), "va": "center", "ha": "right"}
            for x, ratio in ((1.1, middle), (1.2, max(own))):
                axes.text(x, y, _times(ratio), fontsize=8, **about)
    heads: dict[str, Any] = {"transform": axes.get_yaxis_transform(), "va": "center", "ha": "right", "fontsize": 7.5}
    for x, word in ((1.1, "median"), (1.2, "most")):
        axes.text(x, -0.62, word, color="#666666", **heads)
    axes.set_xlim(min(every) / 1.25, max(every) * 1.25)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}×"))
    axes.set_xlabel(heading)


def _title(name: str) -> str:
    return next((reduction.title for key, reduction in REDUCTIONS.items() if key == name), name)


def _times(ratio: float) -> str:
    return f"{ratio:.2g}×" if ratio < 100 else f"{ratio:.0f}×"


def _legend() -> list[Line2D]:
    dots: dict[str, Any] = {"marker": "o", "linestyle": "none"}
    return [
        Line2D([], [], color=MADE_FOR, markersize=6, label="scenes made for the reduction", **dots),
        Line2D([], [], color=OTHERS, markersize=5, label="scenes of the catalog", **dots),
        Line2D([], [], color="#000000", linewidth=2.2, label="median of the blue ones"),
    ]
