"""Statistics of a run: scores, Pareto fronts, how cost grows, sweeps, and `auto` against the other methods."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from statistics import median
from typing import TypeVar

import numpy as np

from dofkit.benchmark.record import ALL, AUTO, Against, Fit, Front, MedianTime, Score, Step, TrialLine

T = TypeVar("T")
K = TypeVar("K")
#: A fit is made over so many sizes at least, and over the sizes down to this part of the largest.
SIZES, DECADE = 3, 10


def grouped(members: Iterable[T], key: Callable[[T], K]) -> dict[K, list[T]]:
    """Return the members by key, in the order of first occurrence."""
    groups: dict[K, list[T]] = {}
    for member in members:
        groups.setdefault(key(member), []).append(member)
    return groups


def scores(lines: Sequence[TrialLine]) -> list[Score]:
    """Return the scores of every question and method, over all families and for each."""
    overall = grouped(lines, lambda line: (line.question, ALL, line.method))
    by_family = grouped(lines, lambda line: (line.question, line.family, line.method))
    return [_score(*key, members) for key, members in {**overall, **by_family}.items()]


def _score(question: str, family: str, method: str, lines: Sequence[TrialLine]) -> Score:
    counts = Counter(line.outcome for line in lines)
    seconds = [line.seconds for line in lines if line.outcome != "cannot"]
    low, middle, high = np.quantile(seconds, (0.1, 0.5, 0.9)).tolist() if seconds else (None, None, None)
    return Score(
        question=question,
        family=family,
        method=method,
        trials=len(lines),
        right=counts["right"],
        wrong=counts["wrong"],
        undecided=counts["undecided"],
        timed_out=counts["timed out"],
        cannot=counts["cannot"],
        median_seconds=middle,
        low_seconds=low,
        high_seconds=high,
    )


def fronts(every: Iterable[Score]) -> list[Front]:
    """Return the Pareto front of each question, over all families."""
    questions = grouped([score for score in every if score.family == ALL], lambda score: score.question)
    return [
        Front(question=question, methods=front(rows), never_wrong=front([row for row in rows if not row.wrong]))
        for question, rows in questions.items()
    ]


def front(members: Sequence[Score]) -> list[str]:
    """Return the methods that none beats in median seconds, share of right and share of wrong answers; fastest first.

    A method that is never right is no choice at all.
    """
    able = [score for score in members if score.median_seconds is not None and score.right]
    best = [score for score in able if not any(beats(other, score) for other in able)]
    return [score.method for score in sorted(best, key=lambda score: score.median_seconds or 0.0)]


def beats(score: Score, other: Score) -> bool:
    """Return whether a score is at least as good in everything, and better in something (Pareto dominance)."""
    a, b = ((-(s.median_seconds or 0.0), s.share_right, -s.share_wrong) for s in (score, other))
    return a != b and all(x >= y for x, y in zip(a, b, strict=True))


def points(lines: Sequence[TrialLine]) -> list[MedianTime]:
    """Return the median time of each method at each size, of families with at least `SIZES` sizes."""
    sized = [line for line in lines if line.outcome != "cannot" and line.size > 0]
    times = []
    for (question, family), members in grouped(sized, lambda line: (line.question, line.family)).items():
        if len({line.size for line in members}) < SIZES:
            continue
        for (method, size), same in sorted(grouped(members, lambda line: (line.method, line.size)).items()):
            late = sum(line.outcome == "timed out" for line in same)
            seconds = median(line.seconds for line in same)
            about = {"question": question, "family": family, "method": method}
            times.append(MedianTime(**about, size=size, seconds=seconds, trials=len(same), timed_out=late))
    return times


def fits(times: Sequence[MedianTime]) -> list[Fit]:
    """Return a power law for every curve of at least three sizes, without those that timed out."""
    fitted = []
    curves = grouped(times, lambda point: (point.question, point.family, point.method))
    for (question, family, method), curve in curves.items():
        timed = [(p.size, p.seconds) for p in curve if not p.timed_out and p.size > 0 and p.seconds > 0]
        largest = max((size for size, _ in timed), default=0)
        upper = [(size, seconds) for size, seconds in timed if size * DECADE >= largest]
        law = power_law(upper)
        if law is not None:
            exponent, error, factor = law
            about = {"question": question, "family": family, "method": method}
            fitted.append(Fit(**about, exponent=exponent, error=error, factor=factor, points=len(upper)))
    return fitted


def power_law(pairs: Sequence[tuple[float, float]]) -> tuple[float, float, float] | None:
    """Return (a, its standard error, c) of y = c x^a by least squares on logarithms; None for fewer than three x.

    >>> a, error, c = power_law([(1, 3.0), (2, 12.0), (4, 48.0)])
    >>> round(a, 9), round(error, 9), round(c, 9)
    (2.0, 0.0, 3.0)
    """
    if len({x for x, _ in pairs}) < SIZES:
        return None
    u, v = np.log(np.array(pairs, dtype=float).T)
    (exponent, constant), covariance = np.polyfit(u, v, 1, full=False, cov=True)
    return float(exponent), float(np.sqrt(covariance[0, 0])), float(np.exp(constant))


def steps(lines: Sequence[TrialLine]) -> list[Step]:
    """Return every sweep, step by step; what a method cannot answer at all is left out."""
    able = [line for line in lines if line.outcome != "cannot"]
    rows = []
    for key, members in grouped(able, lambda line: (line.knob, line.method, line.group, line.value)).items():
        sweep, method, group, value = key
        counts = Counter(line.outcome for line in members)
        about = {"trials": len(members), "right": counts["right"], "wrong": counts["wrong"]}
        undecided = counts["undecided"] + counts["timed out"]
        rows.append(Step(sweep=sweep, method=method, group=group, value=value, undecided=undecided, **about))
    return rows


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
        rows.append(
            Against(
                question=question,
                family=family,
                fastest=fastest,
                ratio=ratios[fastest],
                sound=sound,
                sound_ratio=None if sound is None else ratios[sound],
            )
        )
    return rows


def _ratio(auto: Mapping[str, float], row: Sequence[TrialLine]) -> float:
    """Return the median over trials of the time of `auto` divided by that of another method."""
    return float(median(auto[line.trial] / max(line.seconds, 1e-9) for line in row if line.trial in auto))
