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
    """Return the members by key, in the order of first occurrence."""
    groups: dict[K, list[T]] = {}
    for member in members:
        groups.setdefault(key(member), []).append(member)
    return groups


class Score(NamedTuple):
    """How a method did on some trials: its outcomes, and percentiles of its seconds on all but ``cannot``.

    ``low``, ``median`` and ``high`` are the tenth, the fiftieth and the ninetieth; None where it can answer no trial.
    """

    method: str
    counts: Mapping[Outcome, int]
    trials: int
    low: float | None
    median: float | None
    high: float | None

    def share(self, outcome: Outcome) -> float:
        """Return the share of an outcome among all trials."""
        return self.counts.get(outcome, 0) / self.trials

    @property
    def share_unanswered(self) -> float:
        """Neither right nor wrong answers, among all trials."""
        return (self.trials - self.counts.get("right", 0) - self.counts.get("wrong", 0)) / self.trials


def scores(lines: Iterable[TrialLine]) -> dict[str, Score]:
    """Return the score of each method on these trials."""
    return {method: _score(method, rows) for method, rows in grouped(lines, lambda line: line.method).items()}


def _score(method: str, lines: Sequence[TrialLine]) -> Score:
    seconds = [line.seconds for line in lines if line.outcome != "cannot"]
    percentiles = np.quantile(seconds, (0.1, 0.5, 0.9)).tolist() if seconds else (None, None, None)
    return Score(method, Counter(line.outcome for line in lines), len(lines), *percentiles)


def front(members: Iterable[Score]) -> list[Score]:
    """Return the scores that none beats in median seconds, share of right and share of wrong answers; fastest first.

    A method that is never right is no choice at all.
    """
    able = [score for score in members if score.median is not None and score.share("right")]
    best = [score for score in able if not any(beats(other, score) for other in able)]
    return sorted(best, key=lambda score: score.median or 0.0)


def beats(score: Score, other: Score) -> bool:
    """Return whether a score is at least as good in everything, and better in something (Pareto dominance)."""
    a, b = ((-(s.median or 0.0), s.share("right"), -s.share("wrong")) for s in (score, other))
    return a != b and all(x >= y for x, y in zip(a, b, strict=True))


class Against(NamedTuple):
    """``auto`` against the fastest method that is right on all trials of a family.

    ``ratio`` is the median over trials of the ratio of their seconds; ``sound``: the fastest of them that is never
    wrong on the question, with the same ratio for that one.
    """

    question: str
    family: str
    fastest: str
    ratio: float
    sound: str | None
    sound_ratio: float | None


def against(lines: Sequence[TrialLine]) -> list[Against]:
    """Return `auto` against the fastest method that is right on all trials of a family, trial by trial.

    A method that is wrong on another family is right on this one by luck: to know that it is, is the work.
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
