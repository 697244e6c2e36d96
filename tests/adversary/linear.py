"""Linear equations with rational coefficients, in coordinates, velocities and time: elimination by fractions."""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction

from dofkit.benchmark.trials.construction import IMPOSSIBLE, KnownScene, scene_of, truths
from dofkit.benchmark.trials.frameworks import exact_rank

from .draws import names

Row = list[Fraction]


def _drawn(rng: random.Random, n: int, many: int) -> list[Row]:
    """Rows of which some are combinations of those before: a_1, ..., a_n, then what they are equal to."""
    rows: list[Row] = []
    for _ in range(many):
        if rows and rng.random() < 0.35:
            first, second = rng.choice(rows), rng.choice(rows)
            k, m = Fraction(rng.randint(1, 4), rng.randint(1, 3)), Fraction(rng.randint(-3, 3))
            row = [k * a + m * b for a, b in zip(first, second, strict=True)]
            row[-1] += 1 if rng.random() < 0.15 else 0
        else:
            row = [Fraction(rng.choice((0, 0, 1, 1, -1, 2, -3)), rng.choice((1, 1, 2))) for _ in range(n)]
            row.append(Fraction(rng.randint(-5, 5)))
        if any(row[:-1]):
            rows.append(row)
    return rows


def _text(row: Row, words: Sequence[str], right: str = "1") -> str:
    left = " + ".join(f"({a})*{word}" for a, word in zip(row, words, strict=False) if a)
    return f"{left} = ({row[-1]})*{right}"


def _dependent(rows: Sequence[Row]) -> list[str]:
    """Names of the rows that depend on those before."""
    return [f"c{k + 1}" for k in range(len(rows)) if exact_rank(rows[:k]) == exact_rank(rows[: k + 1])]


def speeds(rng: random.Random, size: int) -> KnownScene:
    """a dq = 0 with constant coefficients, beside finite relations written before: all integrate, and the rank
    counts."""
    n = rng.randint(2, 3 + 2 * size)
    q = names("q", n)
    rows = [[*row[:-1], Fraction(0)] for row in _drawn(rng, n, rng.randint(2, n + 2))] or [
        [Fraction(1)] * n + [Fraction(0)]
    ]
    finite = rng.randint(0, len(rows) - 1)
    values = [Fraction(rng.randint(-3, 3)) for _ in range(n)]
    texts = [_text([*row[:-1], _dot(row, values)], q) for row in rows[:finite]]
    texts += [_text(row, [f"{c}dot" for c in q]) for row in rows[finite:]]
    rank = exact_rank(rows)
    known = truths(n - rank, redundant=_dependent(rows), redundant_equations=len(rows) - rank, holonomic=True)
    return KnownScene(scene_of(q, *texts), known)


def _dot(row: Row, values: Sequence[Fraction]) -> Fraction:
    return sum((a * v for a, v in zip(row, values, strict=False)), Fraction(0))


def driven(rng: random.Random, size: int) -> KnownScene:
    """a q = b t: no motion where a combination of the rows says t = 0; else of dimension n - rank."""
    n = rng.randint(1, 3 + 2 * size)
    q = names("q", n)
    rows = _drawn(rng, n, rng.randint(1, n + 2)) or [[Fraction(1)] * (n + 1)]
    moving = rng.random() < 0.5
    words = [f"{c}dot" for c in q] if moving else q
    scene = scene_of(q, *([_text(row, words, "1" if moving else "t") for row in rows]))
    rank = exact_rank([row[:-1] for row in rows])
    if exact_rank(rows) > rank:
        return KnownScene(scene, IMPOSSIBLE)
    known = truths(n - rank, redundant=_dependent(rows), redundant_equations=len(rows) - rank, holonomic=True)
    return KnownScene(scene, known | {"scleronomic": not any(row[-1] for row in rows)})
