"""What the lines of a run say together: scores, Pareto fronts, how cost grows, sweeps, and `auto` against the rest."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from statistics import fmean, median
from typing import TypeVar

from dofkit.benchmark.record import ALL, AUTO, Against, Fit, Front, MedianTime, Score, Step, TrialLine

T = TypeVar("T")
K = TypeVar("K")
#: A fit is made over so many sizes at least, and over the sizes down to this part of the largest.
SIZES, DECADE = 3, 10


def scores(lines: Sequence[TrialLine]) -> list[Score]:
    """Of every question and method, over all families and for each."""
    whole = _grouped(lines, lambda line: (line.question, ALL, line.method))
    parts = _grouped(lines, lambda line: (line.question, line.family, line.method))
    return [_score(*key, members) for key, members in {**whole, **parts}.items()]


def _score(question: str, family: str, method: str, lines: Sequence[TrialLine]) -> Score:
    counts = {name: sum(line.outcome == name for line in lines) for name in {line.outcome for line in lines}}
    seconds = sorted(line.seconds for line in lines if line.outcome != "cannot")
    return Score(
        question=question,
        family=family,
        method=method,
        trials=len(lines),
        right=counts.get("right", 0),
        wrong=counts.get("wrong", 0),
        undecided=counts.get("undecided", 0),
        timed_out=counts.get("timed out", 0),
        cannot=counts.get("cannot", 0),
        median_seconds=median(seconds) if seconds else None,
        low_seconds=seconds[len(seconds) // 10] if seconds else None,
        high_seconds=seconds[-1 - len(seconds) // 10] if seconds else None,
        total_seconds=sum(seconds),
    )


def fronts(found: Iterable[Score]) -> list[Front]:
    """The Pareto front of each question, over all families."""
    whole = _grouped([score for score in found if score.family == ALL], lambda score: score.question)
    return [
        Front(question=question, methods=front(rows), never_wrong=front([row for row in rows if not row.wrong]))
        for question, rows in whole.items()
    ]


def front(members: Sequence[Score]) -> list[str]:
    """The methods that none beats in median seconds, share of right and share of wrong answers; the fastest first.

    A method that is never right is no choice at all.
    """
    able = [score for score in members if score.median_seconds is not None and score.right]
    best = [score for score in able if not any(beats(other, score) for other in able)]
    return [score.method for score in sorted(best, key=lambda score: score.median_seconds or 0.0)]


def beats(one: Score, other: Score) -> bool:
    """Is one at least as good in everything, and better in something? (Pareto dominance.)"""
    a, b = _goodness(one), _goodness(other)
    return a != b and all(x >= y for x, y in zip(a, b, strict=True))


def _goodness(score: Score) -> tuple[float, float, float]:
    return -(score.median_seconds or 0.0), score.share_right, -score.share_wrong


def points(lines: Sequence[TrialLine]) -> list[MedianTime]:
    """The cost at each size, where a family has at least three."""
    sized = [line for line in lines if line.outcome != "cannot" and line.size > 0]
    families = _grouped(sized, lambda line: (line.question, line.family))
    found = []
    for (question, family), members in families.items():
        if len({line.size for line in members}) < SIZES:
            continue
        for (method, size), same in sorted(_grouped(members, lambda line: (line.method, line.size)).items()):
            late = sum(line.outcome == "timed out" for line in same)
            seconds = median(line.seconds for line in same)
            about = {"question": question, "family": family, "method": method}
            found.append(MedianTime(**about, size=size, seconds=seconds, trials=len(same), timed_out=late))
    return found


def fits(found: Sequence[MedianTime]) -> list[Fit]:
    """A power law for every curve of at least three sizes, without those that timed out."""
    curves = _grouped(found, lambda point: (point.question, point.family, point.method))
    fitted = []
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
    """(a, its standard error, c) of y = c x^a by least squares on logarithms; None for fewer than three places x.

    >>> a, error, c = power_law([(1, 3.0), (2, 12.0), (4, 48.0)])
    >>> round(a, 9), round(error, 9), round(c, 9)
    (2.0, 0.0, 3.0)
    """
    if len({x for x, _ in pairs}) < SIZES:
        return None
    u, v = [math.log(x) for x, _ in pairs], [math.log(y) for _, y in pairs]
    mu, mv = fmean(u), fmean(v)
    spread = math.fsum((x - mu) ** 2 for x in u)
    a = math.fsum((x - mu) * (y - mv) for x, y in zip(u, v, strict=True)) / spread
    left = math.fsum((y - mv - a * (x - mu)) ** 2 for x, y in zip(u, v, strict=True))
    return a, math.sqrt(left / (len(pairs) - 2) / spread), math.exp(mv - a * mu)


def steps(lines: Sequence[TrialLine]) -> list[Step]:
    """Every sweep, step by step; what a method cannot answer at all is left out."""
    able = [line for line in lines if line.outcome != "cannot"]
    groups = _grouped(able, lambda line: (line.knob, line.method, line.group, line.value))
    return [
        Step(
            sweep=sweep,
            method=method,
            group=group,
            value=value,
            trials=len(members),
            right=sum(line.outcome == "right" for line in members),
            wrong=sum(line.outcome == "wrong" for line in members),
            undecided=sum(line.outcome in ("undecided", "timed out") for line in members),
        )
        for (sweep, method, group, value), members in groups.items()
    ]


def against(lines: Sequence[TrialLine]) -> list[Against]:
    """`auto` against the fastest method that is right on all trials of a family, trial by trial.

    A method that is wrong on another family is right on this one by luck: to know that it is, is the work.
    """
    found = []
    erring = {(line.question, line.method) for line in lines if line.outcome == "wrong"}
    for (question, family), members in _grouped(lines, lambda line: (line.question, line.family)).items():
        methods = _grouped(members, lambda line: line.method)
        if AUTO not in methods:
            continue
        auto = {line.trial: line.seconds for line in methods.pop(AUTO)}
        right = {m: row for m, row in methods.items() if all(line.outcome == "right" for line in row)}
        if not right:
            continue
        ratios = {m: _ratio(auto, row) for m, row in right.items()}
        ranked = sorted(right, key=lambda m: median(line.seconds for line in right[m]))
        sound = next((m for m in ranked if (question, m) not in erring), None)
        found.append(
            Against(
                question=question,
                family=family,
                fastest=ranked[0],
                fastest_seconds=median(line.seconds for line in right[ranked[0]]),
                auto_seconds=median(auto.values()),
                ratio=ratios[ranked[0]],
                lucky=(question, ranked[0]) in erring,
                sound=sound,
                sound_ratio=None if sound is None else ratios[sound],
            )
        )
    return found


def _ratio(auto: Mapping[str, float], row: Sequence[TrialLine]) -> float:
    """The median over trials of the time of `auto` by that of another method."""
    return float(median(auto[line.trial] / max(line.seconds, 1e-9) for line in row if line.trial in auto))


def _grouped(members: Iterable[T], key: Callable[[T], K]) -> dict[K, list[T]]:
    """By key, in the order of first occurrence."""
    found: dict[K, list[T]] = {}
    for member in members:
        found.setdefault(key(member), []).append(member)
    return found
