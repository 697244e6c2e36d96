"""Statistics of a run: scores, Pareto fronts, and `auto` against the other methods."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from statistics import median
from typing import NamedTuple, TypeVar

import numpy as np

from dofkit.benchmark.record import AUTO, Outcome, TrialLine

T = TypeVar("T")
K = TypeVar("K")


def grouped(members: Iterable[T], key: Callable[[T], K]) -> dict[K, list[T]]:
    """Return {key: members with this key}, in the order of first occurrence."""
    groups: dict[K, list[T]] = {}
    for member in members:
        groups.setdefault(key(member), []).append(member)
    return groups


class Score(NamedTuple):
    """The result of a method on some trials: number of each outcome, and percentiles of seconds without ``cannot``.

    ``low``, ``median``, ``high`` are the 10th, 50th and 90th percentile; None if the outcome is always ``cannot``.
    """

    method: str
    counts: Mapping[Outcome, int]
    trials: int
    low: float | None
    median: float | None
    high: float | None

    def share(self, outcome: Outcome) -> float:
        """Return the share of the trials with an outcome, from 0 to 1."""
        return self.counts.get(outcome, 0) / self.trials

    @property
    def share_unanswered(self) -> float:
        """The share of the trials without an answer, from 0 to 1."""
        return (self.trials - self.counts.get("right", 0) - self.counts.get("wrong", 0)) / self.trials


def scores(lines: Iterable[TrialLine]) -> dict[str, Score]:
    """Return {method: its score on these trials}."""
    return {method: _score(method, rows) for method, rows in grouped(lines, lambda line: line.method).items()}


def _score(method: str, lines: Sequence[TrialLine]) -> Score:
    seconds = [line.seconds for line in lines if line.outcome != "cannot"]
    percentiles = np.quantile(seconds, (0.1, 0.5, 0.9)).tolist() if seconds else (None, None, None)
    return Score(method, Counter(line.outcome for line in lines), len(lines), *percentiles)


def front(members: Iterable[Score]) -> list[Score]:
    """Return the Pareto front for median seconds, share of right and share of wrong answers, the fastest method first.

    Methods that are never right are left out.
    """
    able = [score for score in members if score.median is not None and score.share("right")]
    best = [score for score in able if not any(beats(other, score) for other in able)]
    return sorted(best, key=lambda score: score.median or 0.0)


def beats(score: Score, other: Score) -> bool:
    """Return whether ``score`` is at least as good as ``other`` in every respect and better in one (dominance)."""
    a, b = ((-(s.median or 0.0), s.share("right"), -s.share("wrong")) for s in (score, other))
    return a != b and all(x >= y for x, y in zip(a, b, strict=True))


class Against(NamedTuple):
    """``auto`` compared with the fastest other method that is right on all trials of a question and family.

    ``ratio``: the median over trials of the time of ``auto`` divided by that of ``fastest``. ``sound``: the fastest of
    the methods that are never wrong on the question (None: there is none), with ``sound_ratio``.
    """

    question: str
    family: str
    fastest: str
    ratio: float
    sound: str | None
    sound_ratio: float | None


def against(lines: Sequence[TrialLine]) -> list[Against]:
    """Return the comparison of `auto` with the fastest methods for each question and family where one is right.

    A method that is wrong on another family is right on this one by luck; hence `sound` excludes such methods.
    """
    rows = []
    erring = {(line.question, line.method) for line in lines if line.outcome == "wrong"}
    for (question, family), members in grouped(lines, lambda line: (line.question, line.family)).items():
        methods = grouped(members, lambda line: line.method)
        auto = {line.trial: line.seconds for line in methods.pop(AUTO, ())}
        right = {m: row for m, row in methods.items() if all(line.outcome == "right" for line in row)}
        if not auto or not right:
            continue
        ratios = {m: _ratio(auto, row) for m, row in right.items()}
        seconds = {m: median(line.seconds for line in row) for m, row in right.items()}
        fastest = min(seconds, key=seconds.__getitem__)
        sound = min((m for m in seconds if (question, m) not in erring), key=seconds.__getitem__, default=None)
        sound_ratio = None if sound is None else ratios[sound]
        rows.append(Against(question, family, fastest, ratios[fastest], sound, sound_ratio))
    return rows


def _ratio(auto: Mapping[str, float], row: Sequence[TrialLine]) -> float:
    """Return the median over trials of the time of `auto` divided by that of another method."""
    return float(median(auto[line.trial] / max(line.seconds, 1e-9) for line in row if line.trial in auto))
