"""Values of exponentials at a point: what their arguments' relations give."""

from __future__ import annotations

import random

import pytest
from flint import nmod

from dofkit.exact.errors import NoPointError
from dofkit.exact.points.field import Character, _root

#: p - 1 = 2^2 3^2 5 7 11 13 (and so on): many degrees share factors with it.
SMOOTH = 180181
#: p - 1 = 2 times a prime.
SAFE = 10007


@pytest.mark.parametrize("p", [SMOOTH, SAFE])
@pytest.mark.parametrize("degree", [1, 2, 3, 4, 8, 60, 97, 200, 401])
def test_a_root_is_one_and_none_is_told_where_there_is_none(p: int, degree: int) -> None:
    rng = random.Random(f"roots {p} {degree}")
    powers = {pow(x, degree, p) for x in range(1, p)} if p == SAFE else None
    for _ in range(20):
        value = nmod(rng.randrange(1, p), p)
        assert _root(value**degree, degree, p) ** degree == value**degree
        if powers is not None and int(value) not in powers:
            with pytest.raises(NoPointError):
                _root(value, degree, p)


def test_the_same_value_comes_of_arguments_in_either_order() -> None:
    """exp(-200 x) = v gives exp(-201 x)^200 = v^201."""
    x, p = 12345, 2**61 - 1
    rng = random.Random(7)
    for first, second in ((200, 201), (201, 200)):
        found = []
        for _ in range(20):
            exp = Character(p, set())
            v = exp.at(first * x % p, lambda: nmod(rng.randrange(1, p), p))
            try:
                found.append(exp.at(second * x % p, lambda: nmod(3, p)) ** first == v**second)
            except NoPointError:
                continue
        assert found
        assert all(found)
