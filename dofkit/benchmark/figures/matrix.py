"""Method against family: who is right where, and how the others fail; under five headings, the hardest last."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from dofkit.benchmark.figures.style import OUTCOME_COLOURS, OUTCOME_HATCHES, WRONG, sheet
from dofkit.benchmark.record import ALL, AUTO, OUTCOMES, ChartRun, Score
from dofkit.benchmark.trials import GLOSSES, HEADINGS

#: Inches of a row, of a column, and of the names; characters of what a family is.
ROW, COLUMN, NAMES, GLOSS = 0.2, 0.86, 5.0, 50
#: The part of a cell that its bar fills, across and down; the number stands beside it.
WIDE, BAR = 0.6, 0.62
_COUNTS = ("trials", "right", "wrong", "undecided", "timed_out", "cannot")
Cells = Mapping[tuple[str, str], Score]


def draw(chart: ChartRun) -> Figure | None:
    """A row for each family, all its questions together; a column for each method; the totals on top."""
    cells = together([score for score in chart.scores if score.family != ALL])
    if not cells:
        return None
    methods = list(dict.fromkeys(method for _, method in cells))
    rows = in_order(cells)
    title = "Where each method is right, wrong, undecided or too slow"
    height = ROW * (len(rows) + 2.2)
    figure = sheet(NAMES + COLUMN * len(methods), height, title, chart.captions["matrix"], _legend())
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


def in_order(cells: Cells) -> list[str]:
    """The totals, then each heading with its families, the hardest last: by what all methods do not get right."""
    shares = {family: _not_right([s for (f, _), s in cells.items() if f == family]) for family, _ in cells}
    families = sorted((f for f in shares if f != ALL), key=lambda family: shares[family])
    found = [ALL]
    for heading in dict.fromkeys(HEADINGS.values()):
        members = [family for family in families if HEADINGS.get(family) == heading]
        found += [heading, *members] if members else []
    return found + [family for family in families if family not in HEADINGS]


def _not_right(scores: Iterable[Score]) -> float:
    counts = [(s.trials - s.right, s.trials) for s in scores]
    return sum(bad for bad, _ in counts) / max(1, sum(all_ for _, all_ in counts))


def together(scores: Iterable[Score]) -> dict[tuple[str, str], Score]:
    """By family and method, the counts of all questions; with the totals of each method as those of `ALL`."""
    found: dict[tuple[str, str], Score] = {}
    for score in scores:
        for family in (ALL, score.family):
            other = found.get((family, score.method))
            counts = {name: getattr(score, name) + (getattr(other, name) if other else 0) for name in _COUNTS}
            found[family, score.method] = score.model_copy(update={"question": ALL, "family": family, **counts})
    return found


def _row(axes: Axes, y: int, row: str, methods: Sequence[str], cells: Cells) -> None:
    """A heading, or a family with its cells."""
    here = [(x, cells[row, method]) for x, method in enumerate(methods) if (row, method) in cells]
    about: dict[str, Any] = {"va": "center"}
    left = -NAMES / COLUMN
    if not here:
        axes.text(left + 0.1, y + 0.55, row, fontsize=9.5, fontweight="bold", **about)
        axes.plot([left + 0.1, len(methods)], [y + 0.98] * 2, color="#CCCCCC", linewidth=0.7)
        return
    total = row == ALL
    name = "all of them" if total else row
    axes.text(left + 0.2, y + 0.5, name, fontsize=8.5, fontweight="bold" if total else "normal", **about)
    trials = max(score.trials for _, score in here)
    axes.text(left + 2.5, y + 0.5, f"{trials}", fontsize=8, color="#444444", ha="right", **about)
    axes.text(left + 2.6, y + 0.5, "" if total else _gloss(row), fontsize=7, color="#777777", **about)
    for x, score in here:
        _cell(axes, x, y, score)


def _gloss(family: str) -> str:
    """What a family is, in a few words."""
    told = re.split(r"[:;\[]", GLOSSES.get(family, ""))[0].strip()
    return told if len(told) <= GLOSS else told[: GLOSS - 3].rsplit(" ", 1)[0] + " ..."


def _cell(axes: Axes, x: int, y: int, score: Score) -> None:
    """A bar of shares; beside it what is wrong, or else what is undecided."""
    counts = [score.right, score.wrong, score.undecided, score.timed_out, score.cannot]
    left, top = float(x), y + (1 - BAR) / 2
    for outcome, count in zip(OUTCOMES, counts, strict=True):
        if count:
            look: dict[str, Any] = {"facecolor": OUTCOME_COLOURS[outcome], "edgecolor": "#FFFFFF", "linewidth": 0.0}
            look["hatch"] = OUTCOME_HATCHES.get(outcome)
            wide = WIDE * count / score.trials
            axes.add_patch(Rectangle((left, top), wide, BAR, **look))
            left += wide
    frame = ("#000000", 1.0) if score.method == AUTO else ("#9A9A9A", 0.5)
    axes.add_patch(Rectangle((x, top), WIDE, BAR, facecolor="none", edgecolor=frame[0], linewidth=frame[1]))
    text, colour = _number(score)
    weight = "bold" if score.wrong else "normal"
    axes.text(x + WIDE + 0.04, y + 0.52, text, va="center", fontsize=7.2, color=colour, fontweight=weight)


def _number(score: Score) -> tuple[str, str]:
    """What stands beside a bar, and its colour; nothing where all is right, or nothing can be answered."""
    if score.right == score.trials or score.cannot == score.trials:
        return "", WRONG
    if score.wrong:
        return _share(score.wrong, score), WRONG
    return _share(score.trials - score.right, score), "#777777"


def _share(count: int, score: Score) -> str:
    value = 100 * count / score.trials
    return "<1 %" if value < 1 else ">99 %" if 99 < value < 100 else f"{value:.0f} %"


def _legend() -> list[Patch]:
    names = {"cannot": "not applicable"}
    return [
        Patch(facecolor=OUTCOME_COLOURS[o], edgecolor="#888888", hatch=OUTCOME_HATCHES.get(o), label=names.get(o, o))
        for o in OUTCOMES
    ]
