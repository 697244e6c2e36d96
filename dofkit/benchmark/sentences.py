"""The summary of a run: its statistics, a caption for each figure, what the figures show, and why methods fail.

Each sentence is worked out from the data of the run, and so may stand beside the figures.
"""

from __future__ import annotations

from dataclasses import replace
from importlib import resources

import yaml

from dofkit.benchmark import statistics
from dofkit.benchmark.record import ALL, AUTO, ChartRun, Data, Ran, Score
from dofkit.methods.table import METHODS

#: `auto` should take no more than so many times the fastest method that is right.
TWICE = 2


def summary(data: Data) -> ChartRun:
    """Return all that is drawn and printed."""
    captions = yaml.safe_load((resources.files(__package__) / "captions.yaml").read_text(encoding="utf-8"))
    scores, points = statistics.scores(data.lines), statistics.points(data.lines)
    return ChartRun(
        ran=data.ran,
        scores=scores,
        fronts=statistics.fronts(scores),
        points=points,
        fits=statistics.fits(points),
        steps=statistics.steps(data.sweeps),
        against=statistics.against(data.lines),
        captions={name: f"{text} {provenance(data.ran)}" for name, text in captions.items()},
    )


def provenance(ran: Ran) -> str:
    """Return what was run on what, and by which command."""
    return (
        f"{ran.trials} trials whose answers are known by construction, at most {ran.limit:g} s of processor time each; "
        f"dofkit {ran.version}, Python {ran.python}, {ran.machine}, {ran.cores} cores, {ran.date[:10]}. "
        f"Made by: {ran.command}"
    )


def sentences(chart: ChartRun) -> list[str]:
    """Return how often ``auto`` is right and how long it takes, as far as the run has data of them."""
    return [text for text in (_trials(chart), _time(chart)) if text]


def _trials(chart: ChartRun) -> str:
    mine = _total(chart, AUTO)
    if mine is None:
        return ""
    methods = len({score.method for score in chart.scores})
    undecided = mine.trials - mine.right - mine.wrong
    wrong = f"{mine.wrong} {'is' if mine.wrong == 1 else 'are'}" if mine.wrong else "none is"
    return (
        f"{_spaced(chart.ran.trials)} trials by {methods} methods, at most {chart.ran.limit:g} s each: of the "
        f"answers of `auto` {wrong} wrong and {_percent(undecided, mine.trials)} are undecided."
    )


def _time(chart: ChartRun) -> str:
    sound = [row.sound_ratio for row in chart.against if row.sound_ratio is not None]
    every = [row.ratio for row in chart.against]
    if not sound:
        return ""
    within, lucky = sum(ratio <= TWICE for ratio in sound), sum(ratio <= TWICE for ratio in every)
    where = "On every family" if within == len(sound) else f"On {within} of {len(sound)} families"
    return (
        f"{where} `auto` takes at most twice the time of the fastest method that is right there and wrong nowhere; "
        f"with those that are right there by luck it does on {lucky} of {len(every)}."
    )


def _total(chart: ChartRun, method: str) -> Score | None:
    """Return the score of a method on all questions together."""
    rows = [score for score in chart.scores if score.method == method and score.family == ALL]
    counts = {name: sum(getattr(row, name) for row in rows) for name in ("trials", "right", "wrong")}
    return replace(rows[0], **counts) if rows else None


def _percent(count: float, trials: float) -> str:
    return percent(count / trials, "less than ", "more than ")


def percent(share: float, below: str = "<", above: str = ">") -> str:
    """Return a share in per cent, never rounded to 0 or 100 where it is not.

    >>> percent(0.5), percent(0.0004), percent(0.9996), percent(1.0)
    ('50 %', '<0.1 %', '>99.9 %', '100 %')
    """
    value = 100 * share
    if 0 < value < 0.1:
        return f"{below}0.1 %"
    if 99.9 < value < 100:
        return f"{above}99.9 %"
    return f"{value:.1f} %" if 0 < value < 10 or 90 < value < 100 else f"{value:.0f} %"


def _spaced(number: int) -> str:
    return f"{number:,}".replace(",", " ")


# Why a method fails


def explained(method: str, question: str, outcome: str, reason: str = "") -> str:
    """Return why a method fails on a trial, in sentences: its own reason, or what it never answers; and its cost.

    ``outcome``: ``wrong``, ``undecided``, ``cannot`` or ``timed out``, where the cost is told.
    """
    row = next((row for name, row in METHODS.items() if name == method), None)
    cannot = f"{method} does not answer this" if row is None else row.cannot
    uses = row.uses.items() if row is not None and outcome == "timed out" else ()
    return " ".join(
        [_sentence(reason or cannot), *(f"Its cost: {use.costs}." for asked, use in uses if asked == question)]
    )


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}{'' if text.endswith('.') else '.'}"
