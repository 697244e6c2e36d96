"""Time against what is not right: one mark a method, all panels on the same axes, wrong answers told in red."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from dofkit.benchmark.figures.labels import Label, Piece, place
from dofkit.benchmark.figures.style import QUESTIONS, WRONG, Look, looks, seconds_text, settle, sheet
from dofkit.benchmark.record import ALL, AUTO, ChartRun, Front, Score
from dofkit.benchmark.sentences import percent

#: Points of a mark's radius.
RADIUS = 4.5
#: Seconds that no clock here tells from 0.
SHORTEST = 1e-6
#: Where "none" stands on the logarithmic axis of per cent, and its other marks.
NONE, TICKS = 0.1, (0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
GREY = "#6E6E6E"


def draw(chart: ChartRun) -> Figure | None:
    """A panel for each question."""
    whole = [score for score in chart.scores if score.family == ALL and score.median_seconds is not None]
    asked = [question for question in QUESTIONS if any(score.question == question for score in whole)]
    if not asked:
        return None
    across = min(2, len(asked))
    down = math.ceil(len(asked) / across)
    title = "Speed against accuracy: share of trials without the right answer, and time"
    look = looks(dict.fromkeys(score.method for score in whole))
    figure = sheet(6.3 * across, 3.5 * down, title, chart.captions["fronts"], _legend())
    grid = figure.subplots(down, 2 * across, squeeze=False, gridspec_kw={"width_ratios": [1, 0.4] * across})
    panels, tables = grid[:, ::2].ravel(), grid[:, 1::2].ravel()
    kept = []
    for panel, beside, question in zip(panels, tables, asked, strict=False):
        members = [score for score in whole if score.question == question]
        front = next((front for front in chart.fronts if front.question == question), None)
        _axes(panel, whole)
        kept.append((panel, members, _panel(panel, question, members, front, look)))
        _table(beside, members, look)
    for axes in (*tables, *panels[len(asked) :]):
        axes.set_axis_off()
    settle(figure)
    for panel, members, stair in kept:
        labels = [_label(score, look[score.method]) for score in sorted(members, key=lambda s: s.method != AUTO)]
        lines = [((_low(s), _not_right(s)), (_high(s), _not_right(s))) for s in members]
        place(panel, labels, RADIUS, [*lines, *pairwise(stair)])
    return figure


def _axes(axes: Axes, members: Sequence[Score]) -> None:
    """The axes that all panels share."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(min(map(_low, members)) / 2, max(map(_high, members)) * 1.6)
    axes.set_ylim(NONE / 1.7, 150)
    axes.set_yticks([NONE, *TICKS], ["none", *(f"{tick:g} %" for tick in TICKS)])
    axes.xaxis.set_major_formatter(FuncFormatter(lambda seconds, _: seconds_text(seconds)))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_locator(NullLocator())


def _panel(
    axes: Axes, question: str, members: Sequence[Score], front: Front | None, look: dict[str, Look]
) -> list[tuple[float, float]]:
    """Draw it; the corners of the stair."""
    axes.set_title(f"{QUESTIONS[question]}   ({max(score.trials for score in members)} trials)")
    axes.set_xlabel("processor time per trial")
    axes.set_ylabel("not right (% of trials)")
    by_name = {score.method: score for score in members}
    on = [by_name[m] for m in front.never_wrong if m in by_name] if front else []
    stair = _stair(axes, on)
    for score in members:
        one, y = look[score.method], _not_right(score)
        axes.plot([_low(score), _high(score)], [y, y], color=one.colour, linewidth=1.2, alpha=0.75, zorder=3)
        for end in (_low(score), _high(score)):
            axes.plot(end, y, marker="|", markersize=5, color=one.colour, zorder=3)
        size = 2 * RADIUS * (1.25 if score.method == AUTO else 1)
        edge: dict[str, Any] = {"markeredgecolor": "#FFFFFF", "markeredgewidth": 0.7}
        axes.plot(_time(score), y, marker="s", markersize=size, color=one.colour, zorder=4, clip_on=False, **edge)
    arrow: dict[str, Any] = {"arrowstyle": "-|>", "color": GREY, "linewidth": 1.6}
    ends: dict[str, Any] = {
        "xy": (0.015, 0.03),
        "xytext": (0.085, 0.13),
        "xycoords": "axes fraction",
        "textcoords": "axes fraction",
    }
    axes.annotate("", arrowprops=arrow, **ends)
    axes.text(0.09, 0.125, "better", transform=axes.transAxes, color=GREY, fontsize=9, style="italic", va="bottom")
    return stair


def _stair(axes: Axes, on: Sequence[Score]) -> list[tuple[float, float]]:
    """The front of those that are never wrong: as a stair, since nothing lies between two methods. Its corners."""
    corners = [(_time(score), _not_right(score)) for score in on[:1]]
    for score in on[1:]:
        corners += [(_time(score), corners[-1][1]), (_time(score), _not_right(score))]
    corners += [(axes.get_xlim()[1], y) for _, y in corners[-1:]]
    axes.plot([x for x, _ in corners], [y for _, y in corners], color="#BBBBBB", linewidth=1.6, zorder=1)
    return corners


def _label(score: Score, look: Look) -> Label:
    return Label(
        (_time(score), _not_right(score)),
        ([Piece(score.method, look.colour, "bold" if score.method == AUTO else "normal")],),
    )


def _table(axes: Axes, members: Sequence[Score], look: dict[str, Look]) -> None:
    """Beside the panel, the best first: each method's wrong answers in red, and the undecided ones separately."""
    axes.set_xlim(0, 1)
    axes.set_ylim(-max(9, len(members)), 0)
    about: dict[str, Any] = {"fontsize": 8, "va": "center"}
    for x, text, colour in ((0.68, "wrong", WRONG), (1.0, "no\nanswer", GREY)):
        axes.text(x, -0.3, text, ha="right", color=colour, **about)
    for row, score in enumerate(sorted(members, key=lambda s: (1 - s.share_right, s.median_seconds or 0.0))):
        y, open_ = -1.2 - 0.95 * row, score.trials - score.right - score.wrong
        weight = "bold" if score.method == AUTO else "normal"
        axes.plot([0.03], [y], marker="s", markersize=6, color=look[score.method].colour)
        axes.text(0.09, y, score.method, ha="left", color="#222222", fontweight=weight, **about)
        wrong = (percent(score.share_wrong), WRONG, "bold") if score.wrong else ("0", GREY, "normal")
        axes.text(0.68, y, wrong[0], ha="right", color=wrong[1], fontweight=wrong[2], **about)
        axes.text(1.0, y, percent(open_ / score.trials) if open_ else "0", ha="right", color=GREY, **about)


def _time(score: Score) -> float:
    return max(score.median_seconds or 0.0, SHORTEST)


def _low(score: Score) -> float:
    return max(score.low_seconds or 0.0, SHORTEST)


def _high(score: Score) -> float:
    return max(score.high_seconds or 0.0, SHORTEST)


def _not_right(score: Score) -> float:
    """Per cent of the trials; at the mark for none where there are none."""
    return max(NONE, 100 * (1 - score.share_right))


def _legend() -> list[Line2D]:
    mark: dict[str, Any] = {"marker": "s", "markersize": 7, "color": "#444444"}
    return [
        Line2D([], [], linestyle="none", label="median time of a method", **mark),
        Line2D(
            [],
            [],
            linewidth=1.4,
            marker="|",
            markersize=7,
            color="#444444",
            label="10th to 90th percentile of its times",
        ),
        Line2D([], [], linewidth=1.8, color="#BBBBBB", label="Pareto front of the methods that were never wrong"),
    ]
