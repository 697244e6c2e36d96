"""Unknown functions at real points: one smooth function of a name, drawn at random, with all its derivatives.

h(u) = a . u + a_0 + sum_j b_j sin(c_j . u + d_j). A rank that is found for one function is at least reached by almost
all, so what is non-zero for it is non-zero for a generic one; and equal arguments have equal values.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple

#: Sines in a function.
WAVES = 3


class SmoothFunction(NamedTuple):
    """The dyadic numbers of one function of some arguments."""

    start: Fraction
    slopes: tuple[Fraction, ...]
    waves: tuple[tuple[Fraction, tuple[Fraction, ...], Fraction], ...]

    def value(self, args: Sequence[Any], orders: Sequence[int], numbers: Any, sine: Any, half_pi: Any) -> Any:
        """The function differentiated ``orders[i]`` times by its i-th argument.

        ``numbers`` turns a fraction into the numbers of the arguments; ``sine``, ``half_pi``: theirs.
        """
        total = sum(orders)
        found = numbers(Fraction(0))
        if total == 0:
            found = found + numbers(self.start)
            for slope, u in zip(self.slopes, args, strict=True):
                found = found + numbers(slope) * u
        elif total == 1:
            found = found + numbers(self.slopes[list(orders).index(1)])
        for height, widths, phase in self.waves:
            factor, angle = height, numbers(phase) + half_pi * total
            for width, order, u in zip(widths, orders, args, strict=True):
                factor *= width**order
                angle = angle + numbers(width) * u
            found = found + numbers(factor) * sine(angle)
        return found


@lru_cache(maxsize=256)
def smooth_function(name: str, arguments: int, seed: int) -> SmoothFunction:
    """The function of a name: the same in every run, another for another seed."""
    rng = random.Random(f"dofkit function {name} {arguments} {seed}")

    def draw(low: int, high: int) -> Fraction:
        return Fraction(rng.choice((-1, 1)) * rng.randrange(low, high), 512)

    slopes = tuple(draw(256, 1024) for _ in range(arguments))
    waves = tuple(
        (draw(64, 512), tuple(draw(256, 1024) for _ in range(arguments)), draw(1, 1600)) for _ in range(WAVES)
    )
    return SmoothFunction(draw(1, 1024), slopes, waves)
