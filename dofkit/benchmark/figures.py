"""The figures of a run, by one function each, which returns None if there is nothing to show. Needs matplotlib."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib.resources import as_file, files
from pathlib import Path
from statistics import median
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import EngFormatter, LogLocator, NullLocator, ScalarFormatter

from dofkit.benchmark.figure_style import GREY, OUTCOME_COLOURS, OUTCOME_HATCHES, WRONG, colours, outcome_keys, sheet
from dofkit.benchmark.record import AUTO, OUTCOMES, Data, TrialLine
from dofkit.benchmark.sentences import caption, percent
from dofkit.benchmark.statistics import Score, front, grouped, scores
from dofkit.benchmark.tasks import SWEEPS, Sweep
from dofkit.benchmark.trials import GLOSSES, HEADINGS


def write(data: Data, out: Path) -> Iterator[Path]:
    """Write all figures into the folder ``out``, as SVG and PNG, and yield the PNG paths. Raises OSError."""
    with as_file(files(__package__).joinpath("chart.mplstyle")) as style:
        for name, draw in FIGURES.items():
            with mpl.rc_context(fname=style):
                figure = draw(data)
                if figure is None:
                    continue
                figure.savefig(out / f"{name}.svg", metadata={"Date": None})
                figure.savefig(out / f"{name}.png", dpi=144, metadata={"Software": None})
            yield out / f"{name}.png"


# Speed against accuracy

QUESTIONS: Mapping[str, str] = {
    "dof": "How many degrees of freedom?",
    "integrability": "Which constraints are holonomic?",
    "redundancy": "Which constraints are redundant?",
    "equivalence": "Is the submitted equation the same constraint?",
}
#: The shortest time in seconds that is shown; shorter ones cannot be measured.
SHORTEST = 1e-6
#: The place of "none" on the logarithmic axis of per cent, and its other ticks.
NONE, TICKS = 0.1, (0.3, 1.0, 3.0, 10.0, 30.0, 100.0)


def fronts(data: Data) -> Figure | None:
    """Return the figure of accuracy against time: a panel for each question, with a table of its methods."""
    by_question = grouped(data.lines, lambda line: line.question)
    able = [line for line in data.lines if line.outcome != "cannot"]
    asked = [question for question in QUESTIONS if any(line.question == question for line in able)]
    if not asked:
        return None
    across = min(2, len(asked))
    down = math.ceil(len(asked) / across)
    title = "Speed against accuracy: share of trials without the right answer, and time"
    figure = sheet(6.3 * across, 3.5 * down, title, caption("fronts", data), _front_keys())
    grid = figure.subplots(down, 2 * across, squeeze=False, gridspec_kw={"width_ratios": [1, 0.4] * across})
    panels, tables = grid[:, ::2].ravel(), grid[:, 1::2].ravel()
    by_method = colours(data.lines)
    members = {q: [score for score in scores(by_question[q]).values() if score.median is not None] for q in asked}
    for panel, table, question in zip(panels, tables, asked, strict=False):
        panel.set_title(f"{QUESTIONS[question]}   ({max(score.trials for score in members[question])} trials)")
        _front_axes(panel, [score for rows in members.values() for score in rows])
        _front_panel(panel, members[question], by_method)
        _front_table(table, members[question], by_method)
    for axes in (*tables, *panels[len(asked) :]):
        axes.set_axis_off()
    return figure


def _front_axes(axes: Axes, members: Sequence[Score]) -> None:
    """Set limits, ticks and labels, which are the same for all panels; ``members`` are the scores of all panels."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(min(_seconds(s.low) for s in members) / 2, max(_seconds(s.high) for s in members) * 1.6)
    axes.set_ylim(NONE / 1.7, 150)
    axes.set_yticks([NONE, *TICKS], ["none", *(f"{tick:g} %" for tick in TICKS)])
    axes.xaxis.set_major_formatter(EngFormatter("s"))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("processor time per trial")
    axes.set_ylabel("not right (% of trials)")


def _front_panel(axes: Axes, members: Sequence[Score], by_method: Mapping[str, str]) -> None:
    """Draw a mark for each method, and as a step curve the Pareto front of the methods that are never wrong."""
    best = front([score for score in members if not score.share("wrong")])
    if best:
        x = [*(_seconds(score.median) for score in best), axes.get_xlim()[1]]
        y = [_not_right(score) for score in (*best, best[-1])]
        axes.step(x, y, where="post", color="#BBBBBB", linewidth=1.6, zorder=1)
    for score in members:
        colour, height = by_method[score.method], _not_right(score)
        ends = [_seconds(score.low), _seconds(score.high)]
        axes.plot(ends, [height, height], marker="|", markersize=5, color=colour, linewidth=1.2, alpha=0.75, zorder=3)
        style: dict[str, Any] = {"marker": "s", "markersize": 11 if score.method == AUTO else 9, "clip_on": False}
        style |= {"markeredgecolor": "#FFFFFF", "markeredgewidth": 0.7, "zorder": 4}
        axes.plot(_seconds(score.median), height, color=colour, **style)
    arrow: dict[str, Any] = {"arrowstyle": "-|>", "color": GREY, "linewidth": 1.6}
    place: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "axes fraction", "va": "bottom"}
    axes.annotate("better", (0.015, 0.03), (0.09, 0.125), arrowprops=arrow, color=GREY, style="italic", **place)


def _front_table(axes: Axes, members: Sequence[Score], by_method: Mapping[str, str]) -> None:
    """Draw the legend of a panel, the best method first, with shares of wrong answers (in red) and of no answer."""
    axes.set_xlim(0, 1)
    axes.set_ylim(-max(9, len(members)), 0)
    about: dict[str, Any] = {"fontsize": 8, "va": "center"}
    for x, text, colour in ((0.68, "wrong", WRONG), (1.0, "no\nanswer", GREY)):
        axes.text(x, -0.3, text, ha="right", color=colour, **about)
    for row, score in enumerate(sorted(members, key=lambda s: (1 - s.share("right"), s.median or 0.0))):
        y, wrong = -1.2 - 0.95 * row, score.share("wrong")
        weight = "bold" if score.method == AUTO else "normal"
        axes.plot([0.03], [y], marker="s", markersize=6, color=by_method[score.method])
        axes.text(0.09, y, score.method, ha="left", color="#222222", fontweight=weight, **about)
        colour, weight = (WRONG, "bold") if wrong else (GREY, "normal")
        axes.text(0.68, y, percent(wrong) if wrong else "0", ha="right", color=colour, fontweight=weight, **about)
        unanswered = score.share_unanswered
        axes.text(1.0, y, percent(unanswered) if unanswered else "0", ha="right", color=GREY, **about)


def _seconds(seconds: float | None) -> float:
    return max(seconds or 0.0, SHORTEST)


def _not_right(score: Score) -> float:
    """Return the percentage of trials without the right answer, at least `NONE` because the axis is logarithmic."""
    return max(NONE, 100 * (1 - score.share("right")))


def _front_keys() -> list[Line2D]:
    bar: dict[str, Any] = {"linewidth": 1.4, "marker": "|", "markersize": 7, "color": "#444444"}
    return [
        Line2D([], [], linestyle="none", marker="s", markersize=7, color="#444444", label="median time of a method"),
        Line2D([], [], label="10th to 90th percentile of its times", **bar),
        Line2D([], [], linewidth=1.8, color="#BBBBBB", label="Pareto front of the methods that were never wrong"),
    ]


# Method against family: outcomes of each method on each family, under five headings, the hardest family last

#: The height of a row, the width of a column and the width of the labels, in inches; characters of a description.
ROW, COLUMN, LABEL_WIDTH, DESCRIPTION_WIDTH = 0.2, 0.86, 5.0, 50
#: The shares of a cell's width and height that its bar fills; the number is to the right of the bar.
WIDE, BAR = 0.6, 0.62
#: The label of the row for all families together.
ALL = "all of them"


def matrix(data: Data) -> Figure | None:
    """Return the table of outcomes: a row for each family, with all its questions, and a column for each method."""
    if not data.lines:
        return None
    by_family = {ALL: data.lines} | grouped(data.lines, lambda line: line.family)
    rows, methods = row_labels(data.lines), list(scores(data.lines))
    title = "Where each method is right, wrong, undecided or too slow"
    size = LABEL_WIDTH + COLUMN * len(methods), ROW * (len(rows) + 2.2)
    figure = sheet(*size, title, caption("matrix", data), outcome_keys())
    axes = figure.subplots()
    axes.set_axis_off()
    axes.set_xlim(-LABEL_WIDTH / COLUMN, len(methods))
    axes.set_ylim(len(rows), -1.6)
    for x, method in enumerate(methods):
        weight = "bold" if method == AUTO else "normal"
        axes.text(x + WIDE / 2, -1.0, method, ha="center", va="center", fontsize=9.5, fontweight=weight)
    cells: list[tuple[int, int, Score]] = []
    for y, row in enumerate(rows):
        by_method = scores(by_family.get(row, ()))
        _row_label(axes, y, row, max((score.trials for score in by_method.values()), default=0))
        cells += [(methods.index(method), y, score) for method, score in by_method.items()]
    _cells(axes, cells)
    return figure


def row_labels(lines: Sequence[TrialLine]) -> list[str]:
    """Return the labels of the rows: `ALL`, then each heading followed by its families.

    Families are sorted by the share of trials, over all methods, without the right answer.
    """
    families = grouped(lines, lambda line: line.family)
    shares = {family: sum(line.outcome != "right" for line in row) / len(row) for family, row in families.items()}
    ranked = sorted(shares, key=lambda family: shares[family])
    rows = [ALL]
    for heading in dict.fromkeys(HEADINGS.values()):
        members = [family for family in ranked if HEADINGS.get(family) == heading]
        rows += [heading, *members] if members else []
    return rows + [family for family in ranked if family not in HEADINGS]


def _row_label(axes: Axes, y: int, row: str, trials: int) -> None:
    """Draw the label of row ``y``: a heading with a line if ``trials`` is 0, else name, trials and description."""
    edge = -LABEL_WIDTH / COLUMN  # a unit of the x axis is the width of a column
    if not trials:
        axes.text(edge + 0.1, y + 0.05, row, fontsize=9.5, fontweight="bold", va="center")
        axes.plot([edge + 0.1, axes.get_xlim()[1]], [y + 0.48] * 2, color="#CCCCCC", linewidth=0.7)
        return
    gloss = re.split(r"[:;\[]", GLOSSES.get(row, ""))[0].strip()
    gloss = textwrap.shorten(gloss, DESCRIPTION_WIDTH, placeholder=" ...")
    axes.text(edge + 0.2, y, row, fontsize=8.5, fontweight="bold" if row == ALL else "normal", va="center")
    axes.text(edge + 2.5, y, f"{trials}", fontsize=8, color="#444444", ha="right", va="center")
    axes.text(edge + 2.6, y, gloss, fontsize=7, color="#777777", va="center")


def _cells(axes: Axes, cells: Sequence[tuple[int, int, Score]]) -> None:
    """Draw a bar of outcomes for each cell (column, row, score), with the share of wrong answers or of none."""
    heights = [y for _, y, _ in cells]
    lefts = [float(x) for x, _, _ in cells]
    for outcome in OUTCOMES:
        widths = [WIDE * score.share(outcome) for _, _, score in cells]
        style: dict[str, Any] = {"color": OUTCOME_COLOURS[outcome], "hatch": OUTCOME_HATCHES.get(outcome)}
        axes.barh(heights, widths, BAR, lefts, edgecolor="#FFFFFF", linewidth=0, **style)
        lefts = [start + width for start, width in zip(lefts, widths, strict=True)]
    for x, y, score in cells:
        frame = ("#000000", 1.0) if score.method == AUTO else ("#9A9A9A", 0.5)
        axes.barh(y, WIDE, BAR, x, fill=False, edgecolor=frame[0], linewidth=frame[1])
        if score.share("right") < 1 and score.share("cannot") < 1:
            value = 100 * (score.share("wrong") or 1 - score.share("right"))
            text = "<1 %" if value < 1 else ">99 %" if 99 < value < 100 else f"{value:.0f} %"
            colour, weight = (WRONG, "bold") if score.share("wrong") else ("#777777", "normal")
            axes.text(x + WIDE + 0.04, y, text, va="center", fontsize=7.2, color=colour, fontweight=weight)


# Cost against size

#: {family that is drawn: the unit of its size}.
COUNTED: Mapping[str, str] = {
    "Henneberg": "joints",
    "links on a line": "links",
    "chains of bodies": "bodies",
    "trailers": "trailers",
}


def cost(data: Data) -> Figure | None:
    """Return the figure of time against size for the question ``dof`` on some families, with logarithmic axes."""
    by_family = grouped([line for line in data.lines if line.question == "dof"], lambda line: line.family)
    chosen = [family for family in COUNTED if family in by_family]
    if not chosen:
        return None
    across = min(2, len(chosen))
    down = math.ceil(len(chosen) / across)
    figure = sheet(5.6 * across + 0.2, 3.3 * down, "Processor time against size", caption("cost", data))
    grid = figure.subplots(down, across, squeeze=False, sharey=True).ravel()
    for axes, family in zip(grid, chosen, strict=False):
        _cost_curves(axes, by_family[family], colours(data.lines), data.ran.limit)
        axes.set_title(f"{family}: degrees of freedom")
        axes.set_xlabel(f"size: {COUNTED[family]}")
        axes.set_ylabel("processor time")
        axes.yaxis.set_major_formatter(EngFormatter("s"))
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter(ScalarFormatter())
        axes.xaxis.set_minor_locator(NullLocator())
    grid[0].legend(fontsize=7.5, framealpha=0.85, borderpad=0.3)
    for axes in grid[len(chosen) :]:
        axes.set_axis_off()
    return figure


def _cost_curves(axes: Axes, lines: Sequence[TrialLine], by_method: Mapping[str, str], limit: float) -> None:
    """Draw a curve for every method, with a cross on the line of the time limit at the first size that timed out."""
    axes.axhline(limit, color="#999999", linewidth=0.8, linestyle=(0, (2, 2)), zorder=1)
    axes.set_xscale("log")
    axes.set_yscale("log")
    for method, rows in grouped((line for line in lines if line.outcome != "cannot"), lambda line: line.method).items():
        by_size = sorted(grouped(rows, lambda line: line.size).items())
        late = [size for size, same in by_size if all(line.outcome == "timed out" for line in same)]
        done = [(size, median(line.seconds for line in same)) for size, same in by_size if size not in late]
        style: dict[str, Any] = {"color": by_method[method], "linewidth": 2.4 if method == AUTO else 1.2}
        axes.plot([size for size, _ in done], [s for _, s in done], marker=".", label=method, **style)
        axes.plot(late[:1], [limit] * len(late[:1]), marker="x", markersize=7, **style)


# Stability: outcomes for the values of a setting, a row for each distance from a special case

#: {setting: (title, label of the axis, label of a row)}.
SWEPT: Mapping[str, tuple[str, str, str]] = {
    "tolerance": ("numeric", "tolerance (share of the largest singular value)", "rounded to\n{} digits"),
    "bits": ("balls", "precision (bits)", "a gap of\n$10^{{-{}}}$"),
}


def stability(data: Data) -> Figure | None:
    """Return the figure of the sweeps: a panel for each setting that was varied."""
    drawn = [sweep for sweep in SWEEPS if any(line.setting == sweep.setting for line in data.sweeps)]
    if not drawn:
        return None
    title = "Stability: which value of a setting gives right answers near special cases"
    mark = Line2D([], [], marker="^", color="#000000", linestyle="none", label="value equal to the rounding or the gap")
    figure = sheet(6.4 * len(drawn), 3.6, title, caption("stability", data), [*outcome_keys(), mark])
    for axes, sweep in zip(figure.subplots(1, len(drawn), squeeze=False).ravel(), drawn, strict=True):
        _sweep_panel(axes, sweep, [line for line in data.sweeps if line.setting == sweep.setting])
    return figure


def _sweep_panel(axes: Axes, sweep: Sweep, lines: Sequence[TrialLine]) -> None:
    """Draw the outcomes for each distance (row) and value (column), and a mark where value and distance agree."""
    values = sorted({line.value or 0.0 for line in lines})
    rows = sweep.by_digits(lines, lambda line: line.trial)
    title, axis, label = SWEPT[sweep.setting]
    for y, (digits, members) in enumerate(rows.items()):
        cells = [scores(line for line in members if line.value == value)[sweep.method] for value in values]
        bottoms = np.full(len(cells), y - 0.4)
        for outcome in OUTCOMES:
            heights = [0.8 * cell.share(outcome) for cell in cells]
            style: dict[str, Any] = {"color": OUTCOME_COLOURS[outcome], "hatch": OUTCOME_HATCHES.get(outcome)}
            axes.bar(range(len(cells)), heights, 0.92, bottoms, edgecolor="#FFFFFF", linewidth=0, **style)
            bottoms += heights
        equal = digits * math.log2(10) if sweep.setting == "bits" else 10.0**-digits
        axes.plot(np.interp(math.log(equal), np.log(values), range(len(values))), y - 0.46, "k^", clip_on=False)
    axes.set_title(f"{title}: {len({line.trial for line in lines})} trials at each value")
    axes.set_xlabel(axis)
    axes.set_ylabel("share of trials (a bar is 0 to 100 %)")
    names = [f"{value:g}" if value >= 1 else f"$10^{{{math.log10(value):.0f}}}$" for value in values]
    step = math.ceil(len(values) / 12)
    axes.set_xticks(range(0, len(values), step), names[::step])
    axes.set_yticks(range(len(rows)), [label.format(digits) for digits in rows])
    axes.tick_params(length=0)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)


_DRAWING: tuple[Callable[[Data], Figure | None], ...] = (fronts, matrix, cost, stability)
FIGURES: Mapping[str, Callable[[Data], Figure | None]] = {draw.__name__: draw for draw in _DRAWING}
