"""Time against what is not right, a mark for each method; and cost against size, a curve for each method."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from dofkit.benchmark.figures.style import GREY, WRONG, Look, looks, seconds_text, sheet
from dofkit.benchmark.record import ALL, AUTO, ChartRun, Fit, Front, MedianTime, Score
from dofkit.benchmark.sentences import percent
from dofkit.benchmark.statistics import grouped

QUESTIONS: Mapping[str, str] = {
    "dof": "How many degrees of freedom?",
    "integrability": "Which constraints are holonomic?",
    "redundancy": "Which constraints are redundant?",
    "equivalence": "Is the submitted equation the same constraint?",
}
#: Seconds that no clock here distinguishes from 0.
SHORTEST = 1e-6
#: Where "none" stands on the logarithmic axis of per cent, and its other marks.
NONE, TICKS = 0.1, (0.3, 1.0, 3.0, 10.0, 30.0, 100.0)


def fronts(chart: ChartRun) -> Figure | None:
    """Draw a panel for each question, with a table of its methods."""
    totals = [score for score in chart.scores if score.family == ALL and score.median_seconds is not None]
    asked = [question for question in QUESTIONS if any(score.question == question for score in totals)]
    if not asked:
        return None
    across = min(2, len(asked))
    down = math.ceil(len(asked) / across)
    title = "Speed against accuracy: share of trials without the right answer, and time"
    looks_of_methods = looks(dict.fromkeys(score.method for score in totals))
    figure = sheet(6.3 * across, 3.5 * down, title, chart.captions["fronts"], _front_keys())
    grid = figure.subplots(down, 2 * across, squeeze=False, gridspec_kw={"width_ratios": [1, 0.4] * across})
    panels, tables = grid[:, ::2].ravel(), grid[:, 1::2].ravel()
    for panel, table, question in zip(panels, tables, asked, strict=False):
        members = [score for score in totals if score.question == question]
        front = next((front for front in chart.fronts if front.question == question), None)
        panel.set_title(f"{QUESTIONS[question]}   ({max(score.trials for score in members)} trials)")
        _front_axes(panel, totals)
        _front_panel(panel, members, front, looks_of_methods)
        _front_table(table, members, looks_of_methods)
    for axes in (*tables, *panels[len(asked) :]):
        axes.set_axis_off()
    return figure


def _front_axes(axes: Axes, members: Sequence[Score]) -> None:
    """Set the axes that all panels share."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(
        min(_seconds(s.low_seconds) for s in members) / 2, max(_seconds(s.high_seconds) for s in members) * 1.6
    )
    axes.set_ylim(NONE / 1.7, 150)
    axes.set_yticks([NONE, *TICKS], ["none", *(f"{tick:g} %" for tick in TICKS)])
    axes.xaxis.set_major_formatter(FuncFormatter(lambda seconds, _: seconds_text(seconds)))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("processor time per trial")
    axes.set_ylabel("not right (% of trials)")


def _front_panel(
    axes: Axes, members: Sequence[Score], front: Front | None, looks_of_methods: Mapping[str, Look]
) -> None:
    """Draw the marks, and the front of the methods that are never wrong: a stair, since nothing lies between two."""
    by_name = {score.method: score for score in members}
    stair = [by_name[m] for m in front.never_wrong if m in by_name] if front else []
    x = [*(_seconds(score.median_seconds) for score in stair), axes.get_xlim()[1]]
    y = [*(_not_right(score) for score in stair), *(_not_right(score) for score in stair[-1:])]
    if stair:
        axes.step(x, y, where="post", color="#BBBBBB", linewidth=1.6, zorder=1)
    for score in members:
        colour, height = looks_of_methods[score.method].colour, _not_right(score)
        ends = [_seconds(score.low_seconds), _seconds(score.high_seconds)]
        axes.plot(ends, [height, height], marker="|", markersize=5, color=colour, linewidth=1.2, alpha=0.75, zorder=3)
        style: dict[str, Any] = {"marker": "s", "markersize": 11 if score.method == AUTO else 9, "clip_on": False}
        style |= {"markeredgecolor": "#FFFFFF", "markeredgewidth": 0.7, "zorder": 4}
        axes.plot(_seconds(score.median_seconds), height, color=colour, **style)
    arrow: dict[str, Any] = {"arrowstyle": "-|>", "color": GREY, "linewidth": 1.6}
    place: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "axes fraction", "va": "bottom"}
    axes.annotate("better", (0.015, 0.03), (0.09, 0.125), arrowprops=arrow, color=GREY, style="italic", **place)


def _front_table(axes: Axes, members: Sequence[Score], looks_of_methods: Mapping[str, Look]) -> None:
    """Draw the legend of the panel, the best first, with each method's wrong answers in red and the undecided ones."""
    axes.set_xlim(0, 1)
    axes.set_ylim(-max(9, len(members)), 0)
    about: dict[str, Any] = {"fontsize": 8, "va": "center"}
    for x, text, colour in ((0.68, "wrong", WRONG), (1.0, "no\nanswer", GREY)):
        axes.text(x, -0.3, text, ha="right", color=colour, **about)
    for row, score in enumerate(sorted(members, key=lambda s: (1 - s.share_right, s.median_seconds or 0.0))):
        y, undecided = -1.2 - 0.95 * row, score.trials - score.right - score.wrong
        weight = "bold" if score.method == AUTO else "normal"
        axes.plot([0.03], [y], marker="s", markersize=6, color=looks_of_methods[score.method].colour)
        axes.text(0.09, y, score.method, ha="left", color="#222222", fontweight=weight, **about)
        wrong = (percent(score.share_wrong), WRONG, "bold") if score.wrong else ("0", GREY, "normal")
        axes.text(0.68, y, wrong[0], ha="right", color=wrong[1], fontweight=wrong[2], **about)
        axes.text(1.0, y, percent(undecided / score.trials) if undecided else "0", ha="right", color=GREY, **about)


def _seconds(seconds: float | None) -> float:
    return max(seconds or 0.0, SHORTEST)


def _not_right(score: Score) -> float:
    """Return the per cent of the trials that are not right; the mark for none where there are none."""
    return max(NONE, 100 * (1 - score.share_right))


def _front_keys() -> list[Line2D]:
    bar: dict[str, Any] = {"linewidth": 1.4, "marker": "|", "markersize": 7, "color": "#444444"}
    return [
        Line2D([], [], linestyle="none", marker="s", markersize=7, color="#444444", label="median time of a method"),
        Line2D([], [], label="10th to 90th percentile of its times", **bar),
        Line2D([], [], linewidth=1.8, color="#BBBBBB", label="Pareto front of the methods that were never wrong"),
    ]


# Cost against size

#: So many panels, and so many of them in a row.
PANELS, ACROSS = 4, 2
#: Drawn in colour beside `auto`: the methods with floating point and with a computer algebra system.
COLOURED = (AUTO, "numeric", "symbolic")
#: A power law fits where the standard error of its exponent is less than this part of it, over so many sizes at least.
ERROR, POINTS = 0.1, 4
#: What is counted as the size, in the families whose size is a plain number of things; these are drawn first.
COUNTED: Mapping[str, str] = {
    "Henneberg": "joints", "links on a line": "links", "chains of bodies": "bodies", "trailers": "trailers",
    "chains of links": "links", "cliques": "joints", "double bananas": "spindles",
    "trees of bodies": "bodies",
}  # fmt: skip


def cost(chart: ChartRun) -> Figure | None:
    """Draw the families that grow most, log-log."""
    chosen = steepest(chart)
    if not chosen:
        return None
    looks_of_methods = looks(dict.fromkeys(score.method for score in chart.scores))
    across = min(ACROSS, len(chosen))
    figure = sheet(
        5.6 * across + 0.2, 3.3 * math.ceil(len(chosen) / across), "Processor time against size", chart.captions["cost"]
    )
    grid = figure.subplots(math.ceil(len(chosen) / across), across, squeeze=False, sharey=True).ravel()
    for axes, key in zip(grid, chosen, strict=False):
        points = [point for point in chart.points if (point.family, point.question) == key]
        fits = {fit.method: fit for fit in chart.fits if (fit.family, fit.question) == key and holds(fit)}
        axes.set_title(f"{key[0]}: {key[1]}")
        axes.set_xlabel(f"size: {COUNTED[key[0]]}" if key[0] in COUNTED else "size")
        _cost_curves(axes, points, looks_of_methods, chart.ran.limit, fits)
        _cost_axes(axes, sorted({point.size for point in points}))
        axes.set_ylim(top=3 * chart.ran.limit)
    for axes in grid[len(chosen) :]:
        axes.set_axis_off()
    return figure


def holds(fit: Fit) -> bool:
    """Return whether the curve is a power law."""
    return fit.error < ERROR * fit.exponent and fit.points >= POINTS


def steepest(chart: ChartRun) -> list[tuple[str, str]]:
    """Return four families and one question of each: the counted ones, in their order, then those that grow most."""
    sizes = grouped(chart.points, lambda point: (point.family, point.question))
    growth = {
        key: (max(p.size for p in row) / min(p.size for p in row), len({p.size for p in row}))
        for key, row in sizes.items()
    }
    best = [max(keys, key=lambda key: growth[key]) for keys in grouped(growth, lambda key: key[0]).values()]
    order = {family: i for i, family in enumerate(COUNTED)}
    return sorted(best, key=lambda key: (order.get(key[0], len(order)), -growth[key][0]))[:PANELS]


def _cost_axes(axes: Axes, sizes: Sequence[int]) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylabel("processor time")
    axes.tick_params(labelleft=True)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda seconds, _: seconds_text(seconds)))
    ticks = [m * 10**k for k in range(9) for m in (1, 2, 5) if sizes[0] <= m * 10**k <= sizes[-1]]
    ticks = ticks if len(ticks) > 2 else [*sizes]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_locator(NullLocator())


def _cost_curves(
    axes: Axes,
    points: Sequence[MedianTime],
    looks_of_methods: Mapping[str, Look],
    limit: float,
    fits: Mapping[str, Fit],
) -> None:
    """Draw a curve for every method, up to the first size that was not done within the limit: a cross on its line."""
    ends = min(point.size for point in points), max(point.size for point in points)
    axes.plot(ends, [limit, limit], color="#999999", linewidth=0.8, linestyle=(0, (2, 2)), zorder=1)
    for method, members in grouped(points, lambda point: point.method).items():
        curve = sorted(members, key=lambda p: p.size)
        done = [p for p in curve if p.timed_out < p.trials]
        late = [p for p in curve if p.timed_out == p.trials][:1]
        coloured = method in COLOURED
        colour, width = (
            (looks_of_methods[method].colour, looks_of_methods[method].width) if coloured else ("#C4C4C4", 1.0)
        )
        above = 6 if method == AUTO else 4 if coloured else 2
        power = f"  $n^{{{fits[method].exponent:.1f}}}$" if method in fits else ""
        label = f"{method}{power}" if coloured else None
        drawn = sorted(done + late, key=lambda p: p.size)
        style: dict[str, Any] = {"color": colour, "linewidth": width, "zorder": above, "label": label}
        if coloured:
            size = 9 if method == AUTO else 4.5
            style |= {
                "marker": looks_of_methods[method].mark,
                "markersize": size,
                "markevery": [p in done for p in drawn],
            }
        axes.plot([p.size for p in drawn], [p.seconds for p in drawn], **style)
        if late:
            cross: dict[str, Any] = {"marker": "x", "markersize": 7, "markeredgewidth": 1.8, "zorder": above}
            axes.plot([late[0].size], [limit], color=colour, **cross)
    axes.plot([], [], color="#C4C4C4", label="other methods")
    axes.legend(fontsize=7.5, loc="lower right", framealpha=0.85, borderpad=0.3)
