"""Method against family: who is right where, and how the others fail."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from dofkit.benchmark.figures.style import OUTCOME_COLOURS, OUTCOME_HATCHES, sheet
from dofkit.benchmark.record import ALL, AUTO, OUTCOMES, ChartRun, Score

#: Inches of a row, and of a column.
ROW, COLUMN, NAMES = 0.235, 1.02, 2.3
#: The part of a cell that its bar fills.
BAR, WIDE = 0.86, 0.95
_COUNTS = ("trials", "right", "wrong", "undecided", "timed_out", "cannot")


def draw(chart: ChartRun) -> Figure | None:
    """A row for each family, all its questions together; a column for each method."""
    cells = together([score for score in chart.scores if score.family != ALL])
    if not cells:
        return None
    families = list(dict.fromkeys(family for family, _ in cells))
    methods = list(dict.fromkeys(method for _, method in cells))
    title = "Where each method is right, wrong, undecided or too slow"
    width = NAMES + COLUMN * len(methods)
    figure = sheet(width, ROW * (len(families) + 1) + 0.3, title, chart.captions["matrix"], _legend())
    axes = figure.subplots()
    axes.set_xlim(0, len(methods))
    axes.set_ylim(len(families), -0.1)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.xaxis.tick_top()
    axes.set_xticks([k + 0.5 for k in range(len(methods))], methods)
    for tick, method in zip(axes.get_xticklabels(), methods, strict=True):
        tick.set_fontweight("bold" if method == AUTO else "normal")
        tick.set_fontsize(10)
    trials = {family: max(s.trials for (f, _), s in cells.items() if f == family) for family in families}
    axes.set_yticks([k + 0.5 for k in range(len(families))], [f"{family} ({trials[family]})" for family in families])
    axes.tick_params(length=0)
    for y, family in enumerate(families):
        for x, method in enumerate(methods):
            if (score := cells.get((family, method))) is not None:
                _cell(axes, x, y, score)
    return figure


def together(scores: Iterable[Score]) -> dict[tuple[str, str], Score]:
    """By family and method, the counts of all questions."""
    found: dict[tuple[str, str], Score] = {}
    for score in scores:
        other = found.get((score.family, score.method))
        if other is not None:
            counts = {name: getattr(score, name) + getattr(other, name) for name in _COUNTS}
            score = score.model_copy(update={"question": ALL, **counts})
        found[score.family, score.method] = score
    return found


def _cell(axes: Axes, x: int, y: int, score: Score) -> None:
    """A bar of shares, and in words what matters most."""
    counts = [score.right, score.wrong, score.undecided, score.timed_out, score.cannot]
    left, top = x + (1 - WIDE) / 2, y + (1 - BAR) / 2
    for outcome, count in zip(OUTCOMES, counts, strict=True):
        if count:
            wide = WIDE * count / score.trials
            hatch = OUTCOME_HATCHES.get(outcome)
            look: dict[str, Any] = {
                "facecolor": OUTCOME_COLOURS[outcome],
                "edgecolor": "#FFFFFF",
                "linewidth": 0.0,
                "hatch": hatch,
            }
            axes.add_patch(Rectangle((left, top), wide, BAR, **look))
            left += wide
    frame = ("#000000", 1.2) if score.method == AUTO else ("#9A9A9A", 0.5)
    edges: dict[str, Any] = {"facecolor": "none", "edgecolor": frame[0], "linewidth": frame[1]}
    axes.add_patch(Rectangle((x + (1 - WIDE) / 2, top), WIDE, BAR, **edges))
    text, colour, back = _words(score)
    box = {"boxstyle": "round,pad=0.12", "facecolor": back, "edgecolor": "none", "alpha": 0.92} if back else None
    weight = "bold" if score.wrong else "normal"
    axes.text(x + 0.5, y + 0.52, text, ha="center", va="center", fontsize=7.4, color=colour, bbox=box, weight=weight)


def _words(score: Score) -> tuple[str, str, str]:
    """What is said in a cell, in which colour, on which ground (empty: that of the bar)."""
    if score.right == score.trials:
        return "right", "#FFFFFF", ""
    if score.cannot == score.trials:
        return "cannot", "#777777", ""
    if score.wrong == score.trials:
        return "wrong", "#A33B00", "#FFFFFF"
    if score.wrong:
        return f"{_share(score.wrong, score)} wrong", "#A33B00", "#FFFFFF"
    if score.timed_out == score.trials:
        return "timed out", "#000000", "#FFFFFF"
    if score.undecided == score.trials:
        return "undecided", "#000000", ""
    return f"{_share(score.right, score)} right", "#000000", "#FFFFFF"


def _share(count: int, score: Score) -> str:
    value = 100 * count / score.trials
    return "<1%" if value < 1 else ">99%" if value > 99 else f"{value:.0f}%"


def _legend() -> list[Patch]:
    names = {"cannot": "cannot answer such a scene"}
    return [
        Patch(facecolor=OUTCOME_COLOURS[o], edgecolor="#888888", hatch=OUTCOME_HATCHES.get(o), label=names.get(o, o))
        for o in OUTCOMES
    ]
