"""Values of exponentials at a point: what their arguments' relations give."""

from __future__ import annotations

import random

from dofkit.exact.points.field import Character
from dofkit.exact.residues import residue
from dofkit.exact.ring.program import NoPointError


def test_the_same_value_comes_of_arguments_in_either_order() -> None:
    """exp(-200 x) = v gives exp(-201 x)^200 = v^201."""
    x, p = 12345, 2**61 - 1
    rng = random.Random(7)
    for first, second in ((200, 201), (201, 200)):
        found = []
        for _ in range(20):
            exp = Character(p, set())
            v = exp.at(first * x % p, lambda: residue(rng.randrange(1, p), p))
            try:
                found.append(exp.at(second * x % p, lambda: residue(3, p)) ** first == v**second)
            except NoPointError:
                continue
        assert found
        assert all(found)
