"""Outcomes by family, by tolerance and by precision."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import NullLocator

from dofkit.benchmark.figures.style import WRONG, outcome_box, outcome_keys, sheet
from dofkit.benchmark.record import ALL, AUTO, OUTCOMES, ChartRun, Score, Step
from dofkit.benchmark.statistics import grouped
from dofkit.benchmark.trials import GLOSSES, HEADINGS

# Method against family: who is right where, and how the others fail; under five headings, the hardest last

#: Inches of a row, of a column, and of the names; characters of what a family is.
ROW, COLUMN, NAMES, GLOSS = 0.2, 0.86, 5.0, 50
#: The part of a cell that its bar fills, across and down; the number stands beside it.
WIDE, BAR = 0.6, 0.62
_COUNTS = ("trials", "right", "wrong", "undecided", "timed_out", "cannot")
Cells = Mapping[tuple[str, str], Score]


def matrix(chart: ChartRun) -> Figure | None:
    """Draw a row for each family, all its questions together; a column for each method; the totals on top."""
    cells = together([score for score in chart.scores if score.family != ALL])
    if not cells:
        return None
    methods = list(dict.fromkeys(method for _, method in cells))
    rows = row_labels(cells)
    title = "Where each method is right, wrong, undecided or too slow"
    size = NAMES + COLUMN * len(methods), ROW * (len(rows) + 2.2)
    figure = sheet(*size, title, chart.captions["matrix"], outcome_keys(OUTCOMES))
    axes = figure.subplots()
    axes.set_xlim(-NAMES / COLUMN, len(methods))
    axes.set_ylim(len(rows) + 0.2, -1.6)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.set_xticks([])
    axes.set_yticks([])
    for x, method in enumerate(methods):
        weight = "bold" if method == AUTO else "normal"
        axes.text(x + WIDE / 2, -1.0, method, ha="center", va="center", fontsize=9.5, fontweight=weight)
    for y, row in enumerate(rows):
        _row(axes, y, row, methods, cells)
    return figure


def row_labels(cells: Cells) -> list[str]:
    """Return the labels of the rows: all families together, then each heading with its families.

    Families stand by rising share of trials, over all methods, that were not answered rightly.
    """
    families = grouped(cells.values(), lambda score: score.family)
    shares = {f: sum(s.trials - s.right for s in row) / sum(s.trials for s in row) for f, row in families.items()}
    ranked = sorted((f for f in shares if f != ALL), key=lambda family: shares[family])
    rows = [ALL]
    for heading in dict.fromkeys(HEADINGS.values()):
        members = [family for family in ranked if HEADINGS.get(family) == heading]
        rows += [heading, *members] if members else []
    return rows + [family for family in ranked if family not in HEADINGS]


def together(scores: Sequence[Score]) -> dict[tuple[str, str], Score]:
    """Return the counts of all questions, by family and method; the totals of each method are those of `ALL`."""
    cells: dict[tuple[str, str], Score] = {}
    for score in scores:
        for family in (ALL, score.family):
            other = cells.get((family, score.method))
            counts = {name: getattr(score, name) + (getattr(other, name) if other else 0) for name in _COUNTS}
            cells[family, score.method] = replace(score, question=ALL, family=family, **counts)
    return cells


def _row(axes: Axes, y: int, row: str, methods: Sequence[str], cells: Cells) -> None:
    """Draw a heading, or a family with its cells."""
    scores = [(x, cells[row, method]) for x, method in enumerate(methods) if (row, method) in cells]
    about: dict[str, Any] = {"va": "center"}
    edge = -NAMES / COLUMN
    if not scores:
        axes.text(edge + 0.1, y + 0.55, row, fontsize=9.5, fontweight="bold", **about)
        axes.plot([edge + 0.1, len(methods)], [y + 0.98] * 2, color="#CCCCCC", linewidth=0.7)
        return
    name, weight = ("all of them", "bold") if row == ALL else (row, "normal")
    trials = max(score.trials for _, score in scores)
    gloss = re.split(r"[:;\[]", GLOSSES.get(row, ""))[0].strip()
    gloss = gloss if len(gloss) <= GLOSS else gloss[: GLOSS - 3].rsplit(" ", 1)[0] + " ..."
    axes.text(edge + 0.2, y + 0.5, name, fontsize=8.5, fontweight=weight, **about)
    axes.text(edge + 2.5, y + 0.5, f"{trials}", fontsize=8, color="#444444", ha="right", **about)
    axes.text(edge + 2.6, y + 0.5, gloss, fontsize=7, color="#777777", **about)
    for x, score in scores:
        _cell(axes, x, y, score)


def _cell(axes: Axes, x: int, y: int, score: Score) -> None:
    """Draw a bar of shares; next to it the share that is wrong, or else that is undecided."""
    corner, top = float(x), y + (1 - BAR) / 2
    for outcome, name in zip(OUTCOMES, _COUNTS[1:], strict=True):
        width = WIDE * getattr(score, name) / score.trials
        if width:
            outcome_box(axes, outcome, (corner, top), (width, BAR))
            corner += width
    frame = ("#000000", 1.0) if score.method == AUTO else ("#9A9A9A", 0.5)
    axes.add_patch(Rectangle((x, top), WIDE, BAR, facecolor="none", edgecolor=frame[0], linewidth=frame[1]))
    if score.right != score.trials and score.cannot != score.trials:
        value = 100 * (score.wrong or score.trials - score.right) / score.trials
        text = "<1 %" if value < 1 else ">99 %" if 99 < value < 100 else f"{value:.0f} %"
        style: dict[str, Any] = {"color": WRONG, "fontweight": "bold"} if score.wrong else {"color": "#777777"}
        axes.text(x + WIDE + 0.04, y + 0.52, text, va="center", fontsize=7.2, **style)


# Sweeps: tolerances on rounded coordinates, and the precision of balls

#: Of the curves of a sweep so many are drawn, at most: the first, the last, and some between.
CURVES = 7
TOLERANCES = {
    "tolerance": "numeric: ranks by singular values",
    "scene tolerance": "dofkit: the tolerance written in the scene",
}
_DRAWN = ("right", "wrong", "undecided")
#: The part of a cell that its bar fills, across and upwards.
ACROSS, HIGH = 0.9, 0.8


def tolerance(chart: ChartRun) -> Figure | None:
    """Draw a row for each rounding, a cell for each tolerance: what is right, wrong and undecided."""
    names = [name for name in TOLERANCES if any(step.sweep == name for step in chart.steps)]
    if not names:
        return None
    groups = chosen(list(dict.fromkeys(step.group for step in chart.steps if step.sweep in names)))
    title = "Rounded coordinates: which tolerance recovers the unrounded geometry"
    mark: dict[str, Any] = {"marker": "^", "color": "#000000", "linestyle": "none"}
    keys = [*outcome_keys(_DRAWN), Line2D([], [], label="tolerance equal to the rounding", **mark)]
    size = (5.4 * len(names) + (1.4 if len(names) == 1 else 0), 0.42 * len(groups) + 0.9)
    figure = sheet(*size, title, chart.captions["tolerance"], keys)
    grid = figure.subplots(1, len(names), squeeze=False, sharey=True).ravel()
    for axes, name in zip(grid, names, strict=True):
        _strips(axes, [step for step in chart.steps if step.sweep == name and step.group in groups], groups)
        axes.set_title(TOLERANCES[name], fontsize=9.5)
    grid[0].set_yticks(range(len(groups)), [f"{group} digits" for group in groups])
    grid[0].set_ylim(len(groups) - 0.4, -0.6)
    return figure


def _strips(axes: Axes, steps: Sequence[Step], groups: Sequence[str]) -> None:
    """Draw shares of the outcomes, one above the other."""
    powers = sorted({round(math.log10(step.value)) for step in steps})
    for step in steps:
        x, y = round(math.log10(step.value)), groups.index(step.group)
        low = y + HIGH / 2
        for outcome in _DRAWN:
            high = HIGH * getattr(step, outcome) / step.trials
            if high:
                outcome_box(axes, outcome, (x - ACROSS / 2, low - high), (ACROSS, high))
                low -= high
    for y, group in enumerate(groups):
        axes.plot([-int(group)], [y + HIGH / 2 + 0.09], marker="^", markersize=5.5, color="#000000", clip_on=False)
    axes.set_xlim(powers[0] - 0.6, powers[-1] + 0.6)
    ticks = powers[:: max(1, math.ceil(len(powers) / 8))]
    axes.set_xticks(ticks, [f"$10^{{{k}}}$" for k in ticks])
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)
    axes.set_xlabel("tolerance")


def bits(chart: ChartRun) -> Figure | None:
    """Draw the share of wrong answers against the bits of balls, a curve for each gap."""
    curves = grouped([step for step in chart.steps if step.sweep == "bits"], lambda step: step.group)
    if not curves:
        return None
    figure = sheet(7.4, 3.6, "Balls: bits needed to recognize a gap", chart.captions["bits"])
    axes = figure.subplots()
    groups = chosen(list(curves))
    for i, group in enumerate(groups):
        curve = sorted(curves[group], key=lambda step: step.value)
        style: dict[str, Any] = {"marker": "osD^vPX"[i % 7], "markersize": 4.5, "linewidth": 1.5}
        style["color"] = to_hex(colormaps["viridis"](0.88 * i / max(1, len(groups) - 1)))
        style["label"] = f"gap $10^{{{round(math.log10(_number(group)[0]))}}}$"
        axes.plot([step.value for step in curve], [100 * step.wrong / step.trials for step in curve], **style)
    values = sorted({step.value for curve in curves.values() for step in curve})
    axes.set_xscale("log", base=2)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(values, [f"{value:g}" for value in values])
    axes.set_ylim(-3, 75)
    axes.set_xlabel("precision (bits)")
    trials = max(step.trials for curve in curves.values() for step in curve)
    axes.set_ylabel(f"wrong answers (% of up to {trials} trials)")
    axes.legend(fontsize=8, ncols=2, frameon=False)
    return figure


def chosen(groups: list[str]) -> list[str]:
    """Return at most so many groups, in the order of their numbers."""
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
