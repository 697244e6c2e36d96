"""Modelling no more than needed: what each reduction saves, seen by switching it off."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from statistics import median

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from dofkit.benchmark.figures.style import sheet
from dofkit.benchmark.record import ChartRun, ReductionCost
from dofkit.relations.reductions import REDUCTIONS

MADE_FOR, OTHERS = "#0072B2", "#B5B5B5"


def draw(chart: ChartRun) -> Figure | None:
    """Without against with, for each reduction: seconds, and what shrinks most of the model."""
    whole = {row.scene: row for row in chart.reductions if not row.off}
    pairs = [(row, whole[row.scene]) for row in chart.reductions if row.off and row.scene in whole]
    if not pairs:
        return None
    names = list(dict.fromkeys(row.off for row, _ in pairs))
    height = 0.42 * len(names) + 1.0
    figure = sheet(11.4, height, "What each reduction of the model saves", chart.captions["reductions"])
    left, right = figure.subplots(1, 2, sharey=True)
    _panel(left, names, pairs, lambda off, on: off.seconds / on.seconds, "seconds without the reduction / with it")
    _panel(right, names, pairs, _size, "size of the model without / with: that which shrinks most")
    left.set_yticks(range(len(names)), [_title(name) for name in names])
    left.set_ylim(len(names) - 0.5, -0.5)
    return figure


def _panel(
    axes: Axes,
    names: Sequence[str],
    pairs: Sequence[tuple[ReductionCost, ReductionCost]],
    of: Callable[[ReductionCost, ReductionCost], float],
    heading: str,
) -> None:
    axes.set_xscale("log")
    axes.axvline(1, color="#666666", linewidth=1.0, zorder=1)
    for y, name in enumerate(names):
        rows = [(off, on) for off, on in pairs if off.off == name and on.seconds > 0 and off.seconds > 0]
        for ours, colour, size in ((False, OTHERS, 16), (True, MADE_FOR, 26)):
            dots = [of(off, on) for off, on in rows if (off.family == name) == ours]
            axes.scatter(dots, [y] * len(dots), s=size, color=colour, alpha=0.75, linewidths=0, zorder=3)
        own = [of(off, on) for off, on in rows if off.family == name] or [of(off, on) for off, on in rows]
        if own:
            middle, most = median(own), max(own)
            axes.plot([middle, middle], [y - 0.3, y + 0.3], color="#000000", linewidth=2.2, zorder=4)
            words = f"median {_times(middle)}, most {_times(most)}"
            axes.annotate(words, (max(most, middle), y), (7, 0), textcoords="offset points", va="center", fontsize=7.4)
    low, high = axes.get_xlim()
    axes.set_xlim(min(low, 0.6), max(high, 2.0) * (high / low) ** 0.55)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}×"))
    axes.set_xlabel(heading)


def _size(off: ReductionCost, on: ReductionCost) -> float:
    """Coordinates, relations, forms, the largest block, or the coordinates that are followed: what shrinks most."""
    parts = ("coordinates", "relations", "forms", "largest", "followed")
    ratios = [getattr(off, part) / max(1, getattr(on, part)) for part in parts if getattr(off, part)]
    return float(max(ratios, default=1.0))


def _title(name: str) -> str:
    return next((reduction.title for key, reduction in REDUCTIONS.items() if key == name), name)


def _times(ratio: float) -> str:
    return f"{ratio:.2g}×" if ratio < 100 else f"{ratio:.0f}×"
