"""Time against right, wrong and undecided answers: one mark a method, the Pareto front, ``auto`` on it."""

from __future__ import annotations

import math
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.path import Path
from matplotlib.ticker import FuncFormatter, NullLocator

from dofkit.benchmark.figures.style import OUTCOME_COLOURS, QUESTIONS, label_marks, seconds_text, settle, sheet
from dofkit.benchmark.record import ALL, AUTO, OUTCOMES, ChartRun, Front, Score

#: Points of a mark's radius; that of ``auto`` is larger.
RADIUS, RADIUS_AUTO = 6.5, 9.5
#: Seconds that no clock here tells from 0.
SHORTEST = 1e-6


def draw(chart: ChartRun) -> Figure | None:
    """A panel for each question."""
    whole = [score for score in chart.scores if score.family == ALL and score.median_seconds is not None]
    asked = [question for question in QUESTIONS if any(score.question == question for score in whole)]
    if not asked:
        return None
    across = min(2, len(asked))
    down = math.ceil(len(asked) / across)
    title = "Which method to use: how often it is right, and how long it takes"
    figure = sheet(
        5.6 * across + (1.0 if across == 1 else 0), 4.0 * down + 0.4, title, chart.captions["fronts"], _legend()
    )
    panels = figure.subplots(down, across, squeeze=False).ravel()
    labels = []
    for panel, question in zip(panels, asked, strict=False):
        members = [score for score in whole if score.question == question]
        front = next((front for front in chart.fronts if front.question == question), None)
        labels.append((panel, _panel(panel, question, members, front)))
    for panel in panels[len(asked) :]:
        panel.set_axis_off()
    settle(figure)
    for panel, (marks, stair) in labels:
        label_marks(panel, marks, RADIUS_AUTO, stair)
    return figure


def _panel(axes: Axes, question: str, members: list[Score], front: Front | None) -> tuple[list[Any], list[Any]]:
    """Draw it; the labels that are to be placed, and the corners of the front."""
    axes.set_xscale("log")
    times = [_time(score) for score in members]
    axes.set_xlim(min(times) / 3, max(times) * 3)
    axes.xaxis.set_minor_locator(NullLocator())
    least = min(100 * score.share_right for score in members)
    axes.set_ylim(max(-9, least - 14), 128)
    axes.set_yticks([tick for tick in range(0, 101, 20) if tick >= least - 14])
    axes.set_title(f"{QUESTIONS[question]}   ({max(score.trials for score in members)} trials)")
    axes.xaxis.set_major_formatter(FuncFormatter(lambda seconds, _: seconds_text(seconds)))
    axes.set_xlabel("median processor time of a trial")
    axes.set_ylabel("right answers (% of trials)")
    by_name = {score.method: score for score in members}
    on = [by_name[m] for m in front.never_wrong if m in by_name] if front else []
    stair = _stair(axes, on) if on else []
    marks = []
    for score in sorted(members, key=lambda score: score.method == AUTO):
        _pie(axes, score, bool(front and score.method in front.methods))
        wrong = f"{_percent(score.share_wrong)} wrong" if score.wrong else "never wrong"
        style: dict[str, Any] = {"fontsize": 9.5 if score.method == AUTO else 8, "linespacing": 1.05}
        style |= {"fontweight": "bold"} if score.method == AUTO else {}
        style |= {"color": "#A33B00"} if score.wrong else {}
        text = f"{score.method}\n{_percent(score.share_right)} right, {wrong}"
        marks.append((_time(score), 100 * score.share_right, text, style))
    return marks[::-1], stair


def _stair(axes: Axes, on: list[Score]) -> list[tuple[float, float]]:
    """The front of those that are never wrong: as a stair, since nothing lies between two methods."""
    corners = [(on[0].median_seconds or 0.0, 100 * on[0].share_right)]
    for score in on[1:]:
        corners += [
            (_time(score), corners[-1][1]),
            (_time(score), 100 * score.share_right),
        ]
    corners.append((axes.get_xlim()[1], corners[-1][1]))
    axes.plot([x for x, _ in corners], [y for _, y in corners], color="#000000", linewidth=1.3, zorder=2)
    return corners


def _pie(axes: Axes, score: Score, ringed: bool) -> None:
    """Shares of the outcomes as wedges, the same size wherever it stands."""
    radius = RADIUS_AUTO if score.method == AUTO else RADIUS
    counts = [score.right, score.wrong, score.undecided, score.timed_out, score.cannot]
    at, turn = (_time(score), 100 * score.share_right), 0.25
    for outcome, count in zip(OUTCOMES, counts, strict=True):
        if not count:
            continue
        share = count / score.trials
        steps = max(2, round(64 * share) + 1)
        angles = [2 * math.pi * (turn - share * k / (steps - 1)) for k in range(steps)]
        turn -= share
        corners = [(math.cos(a), math.sin(a)) for a in angles]
        wedge = corners if share == 1 else [(0.0, 0.0), *corners]
        size = (2 * radius * max(max(abs(x), abs(y)) for x, y in wedge)) ** 2
        axes.scatter(*at, marker=Path(wedge), s=size, color=OUTCOME_COLOURS[outcome], zorder=4, lw=0, clip_on=False)
    edge, width = ("#000000", 2.0) if score.method == AUTO else ("#000000", 1.4) if ringed else ("#888888", 0.6)
    axes.scatter(
        *at, s=(2 * radius) ** 2, facecolors="none", edgecolors=edge, linewidths=width, zorder=5, clip_on=False
    )


def _time(score: Score) -> float:
    return max(score.median_seconds or 0.0, SHORTEST)


def _percent(share: float) -> str:
    """Never rounded to 0 or 100 where it is not."""
    value = 100 * share
    if 0 < value < 0.1:
        return "<0.1%"
    if 99.9 < value < 100:
        return ">99.9%"
    return f"{value:.1f}%" if (0 < value < 10 or 90 < value < 100) else f"{value:.0f}%"


def _legend() -> list[Patch]:
    names = {"cannot": "cannot answer such a scene"}
    return [
        Patch(facecolor=OUTCOME_COLOURS[o], edgecolor="#666666", linewidth=0.6, label=names.get(o, o)) for o in OUTCOMES
    ]
