"""Relations over boxes: what no point of a box satisfies is cut away, with a proof.

`BoxProgram` is one shared program of several expressions. `contract` narrows a box by running it forward and backward
(hull consistency) and by interval Newton steps on combinations of the relations that are nearly solved for a variable.
"""

from __future__ import annotations

import math

from dofkit.exact.boxes.box_program import Box, BoxProgram
from dofkit.exact.boxes.interval_newton import newton
from dofkit.exact.boxes.intervals import EmptyError, Interval
from dofkit.exact.errors import raising_no_value

#: Sweeps over one box, and the part of some width that a sweep has to cut away for another to follow.
SWEEPS, WORTH = 12, 0.05


@raising_no_value
def contract(relations: BoxProgram, box: Box) -> Box:
    """The box less what no solution is in. Raises EmptyError where nothing is left: proved."""
    for _ in range(SWEEPS):
        at = relations.forward(box)
        relations.backward(at)
        narrower = [at[i] for i in relations.var_nodes]
        if not _worth(box, narrower):
            break
        box = narrower
    return _by_slopes(relations, narrower)


def _by_slopes(relations: BoxProgram, box: Box) -> Box:
    """What derivatives exclude, where everything is defined on the whole box (else no mean value theorem holds)."""
    over = relations.forward(box)
    if not relations.equations or not relations.total(over):
        return box
    slopes = [relations.gradient(e, over) for e in relations.equations]
    relations.work += len(slopes) * len(relations.nodes)
    for e, slope in zip(relations.equations, slopes, strict=True):
        _monotone(relations, e, slope, box)
    if any(math.isinf(v) for x in box for v in x):
        return box
    return newton(relations, box, slopes)


def _monotone(relations: BoxProgram, equation: int, slope: list[Interval], box: Box) -> None:
    """Raise EmptyError where a bound at the ends of monotone variables has a sign."""
    signs = [0 if s == (0.0, 0.0) else 1 if s[0] >= 0.0 else -1 if s[1] <= 0.0 else 0 for s in slope]
    if not any(signs):
        return
    for low in (True, False):
        corner = [
            x if not s else (x[0], x[0]) if (s > 0) == low else (x[1], x[1]) for s, x in zip(signs, box, strict=True)
        ]
        if any(math.isinf(a) and a == b for a, b in corner):
            continue
        found = relations.forward(corner)[equation]
        if found[0] > 0.0 if low else found[1] < 0.0:
            raise EmptyError


def _worth(old: Box, new: Box) -> bool:
    """Did some interval lose a share of its width, or become finite?"""
    for (a, b), (c, d) in zip(old, new, strict=True):
        if (a == -math.inf and c > a) or (b == math.inf and d < b):
            return True
        if b - a < math.inf and d - c < (1 - WORTH) * (b - a):
            return True
    return False
