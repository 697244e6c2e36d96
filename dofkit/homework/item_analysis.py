"""How each question did: how many got it, does it tell those who know more from the others, and what went wrong.

Gathered submission by submission, in memory that does not grow with their number. Discrimination is the point-biserial
correlation, for partial points Pearson's, of a question's share of its points with that of the rest of the sheet,

    r = (n sum(x y) - sum(x) sum(y)) / sqrt((n sum(x^2) - sum(x)^2) (n sum(y^2) - sum(y)^2)),

over all submissions, as far as their answers are decided. From 0.3 on a question is good; about 0 it tells
nothing; below 0 those who know more get it less: the key or the text should be looked at.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from dofkit.homework.key.codes import CODES
from dofkit.homework.own_sheets import structure_told
from dofkit.homework.result import Item, Result

#: Texts and groups that are kept for a question, and of texts and codes those that are shown.
MOST_TEXTS, MOST_GROUPS, SHOWN = 1000, 60, 3
#: Fewer submissions tell nothing of a question's discrimination.
FEWEST = 5
#: Below this the key or the text should be looked at; less than this from 0 it tells nothing.
POOR = 0.1


class GroupFigures(NamedTuple):
    """One class, or one variant: how many answers are decided, and the share of the points that they got."""

    name: str
    answers: int
    share: float


class QuestionFigures(NamedTuple):
    """``right``: the share of the ``decided`` answers that are wholly right; ``points``: that of the points they got;
    ``discrimination``: as above, None where too few are decided or all are alike. ``codes``: (count, code, meaning).
    """

    decided: int
    right: float | None
    points: float | None
    discrimination: float | None
    codes: list[tuple[int, str, str]]
    unread: list[tuple[int, str]]
    classes: list[GroupFigures]
    variants: list[GroupFigures]

    @property
    def doubtful(self) -> bool:
        """Does it not tell those who know more from the others?"""
        return self.discrimination is not None and self.discrimination < POOR


@dataclass
class Moments:
    """Sums of pairs of numbers."""

    n: int = 0
    sums: list[float] = field(default_factory=lambda: [0.0] * 5)

    def add(self, x: float, y: float) -> None:
        """One more pair."""
        self.n += 1
        for k, more in enumerate((x, y, x * x, y * y, x * y)):
            self.sums[k] += more

    def correlation(self) -> float | None:
        """Pearson's r; None of few pairs, and where one number is always the same."""
        x, y, xx, yy, xy = self.sums
        spread = (self.n * xx - x * x) * (self.n * yy - y * y)
        if self.n < FEWEST or spread <= 1e-9:
            return None
        return max(-1.0, min(1.0, (self.n * xy - x * y) / math.sqrt(spread)))


@dataclass
class _Tally:
    """What is kept of one question."""

    count: int = 0
    right: int = 0
    share: float = 0.0
    moments: Moments = field(default_factory=Moments)
    codes: Counter[str] = field(default_factory=Counter)
    unread: Counter[str] = field(default_factory=Counter)
    groups: dict[str, dict[str, list[float]]] = field(default_factory=lambda: {"class": {}, "variant": {}})

    def into(self, kind: str, name: str, share: float) -> None:
        """One more answer of a class or a variant."""
        groups = self.groups[kind]
        if name in groups or len(groups) < MOST_GROUPS:
            pair = groups.setdefault(name, [0, 0.0])
            pair[0] += 1
            pair[1] += share


class ItemAnalysis:
    """``add`` every result, then look at the ``figures`` of each question."""

    def __init__(self) -> None:
        self._tallies: defaultdict[tuple[str, str], _Tally] = defaultdict(_Tally)

    def add(self, result: Result, section: str = "") -> None:
        """One more submission; ``section``: the class of the student, where it is known."""
        known = [(item.score, item.max_score) for item in result.items if item.score is not None]
        whole, most = (sum(part) for part in zip(*known, strict=True)) if known else (0.0, 0.0)
        for item in result.items:
            if item.max_score:
                tally = self._tallies[item.problem, item.question]
                self._item(tally, item, section)
                if item.score is not None and most > item.max_score:
                    rest = (whole - item.score) / (most - item.max_score)
                    tally.moments.add(item.score / item.max_score, rest)

    def _item(self, tally: _Tally, item: Item, section: str) -> None:
        tally.codes.update(set(item.codes))
        text = item.answer or ""
        if item.status == "unreadable" and (text in tally.unread or len(tally.unread) < MOST_TEXTS):
            tally.unread[text] += 1
        if item.score is None:
            return
        share = item.score / item.max_score
        tally.count += 1
        tally.right += share >= 1.0
        tally.share += share
        if section:
            tally.into("class", section, share)
        if item.variant is not None:
            tally.into("variant", structure_told(item.variant), share)

    def figures(self, problem: str, question: str) -> QuestionFigures:
        """What is known of a question."""
        tally = self._tallies[problem, question]
        known = tally.count or None
        return QuestionFigures(
            tally.count,
            known and tally.right / known,
            known and tally.share / known,
            tally.moments.correlation(),
            [(count, code, CODES.get(code, "")) for code, count in tally.codes.most_common(SHOWN)],
            [(count, text) for text, count in tally.unread.most_common(SHOWN)],
            _groups(tally.groups["class"]),
            _groups(tally.groups["variant"]),
        )


def _groups(found: Mapping[str, Sequence[float]]) -> list[GroupFigures]:
    """Groups by name; one alone tells nothing."""
    groups = [GroupFigures(name, int(count), share / count) for name, (count, share) in sorted(found.items())]
    return groups if len(groups) > 1 else []
