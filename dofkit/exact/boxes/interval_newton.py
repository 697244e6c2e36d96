"""Interval Newton steps on combinations of equations that are each nearly solved for one variable."""

from __future__ import annotations

import math
from collections.abc import Sequence

from dofkit.base.libraries import np
from dofkit.exact.boxes import intervals as iv
from dofkit.exact.boxes.box_program import Box, BoxProgram
from dofkit.exact.boxes.intervals import Interval

#: Jacobian entries smaller than this are no pivots.
TINY = 1e-9


def newton(relations: BoxProgram, box: Box, slopes: list[list[Interval]]) -> Box:
    """f(c) + f'(box) (box - c) holds 0 [Moore1966], the equations combined to be nearly solved for a variable each."""
    center = [(m, m) for m in map(iv.middle, box)]
    at = relations.forward(center)
    values = [at[e] for e in relations.equations]
    for weights in _combinations(relations, at):
        value, slope = _weighted(weights, values), [_weighted(weights, column) for column in zip(*slopes, strict=True)]
        box = _linear_step(value, slope, box, center)
    return box


def _weighted(weights: Sequence[float], parts: Sequence[Interval]) -> Interval:
    total: Interval = (0.0, 0.0)
    for w, part in zip(weights, parts, strict=True):
        if w:
            total = iv.add(total, iv.mul((w, w), part))
    return total


def _combinations(relations: BoxProgram, at: list[Interval]) -> list[list[float]]:
    """Each equation itself, and combinations that Gauss's elimination of the midpoint Jacobian takes."""
    count = len(relations.equations)
    alone = [[float(i == j) for j in range(count)] for i in range(count)]
    if count == 1:
        return alone
    rows = [[(a + b) / 2 for a, b in relations.gradient(e, at)] for e in relations.equations]
    work = np.array([row + one for row, one in zip(rows, alone, strict=True)])
    if not np.isfinite(work).all():
        return alone
    n = len(rows[0])
    for r in range(min(count, n)):
        sizes = np.abs(work[r:, :n])
        i, c = divmod(int(np.argmax(sizes)), n)
        if sizes[i, c] < TINY:
            break
        work[[r, r + i]] = work[[r + i, r]]
        work[r] /= work[r, c]
        for k in range(count):
            if k != r:
                work[k] -= work[k, c] * work[r]
    return alone + [[float(v) for v in row[n:]] for row in work]


def _linear_step(value: Interval, slope: list[Interval], box: Box, center: Box) -> Box:
    """Every variable from value + slope (x - c) = 0 and the bounds of the others."""
    if any(math.isinf(v) for s in slope for v in s):
        return box
    parts = [iv.mul(s, iv.minus(x, c)) for s, x, c in zip(slope, box, center, strict=True)]
    after = [(0.0, 0.0)]
    for p in reversed(parts):
        after.append(iv.add(after[-1], p))
    iv.meet(iv.add(value, after[-1]), (0.0, 0.0))
    before, narrowed = value, []
    for k, (s, x) in enumerate(zip(slope, box, strict=True)):
        others = iv.add(before, after[len(parts) - 1 - k])
        if iv.contains_zero(s):
            narrowed.append(x)
        else:
            moved = iv.mul(iv.negative(others), iv.inverse(s)[0])
            narrowed.append(iv.meet(x, iv.add(center[k], moved)))
        before = iv.add(before, parts[k])
    return narrowed
