"""Values of exponentials at a point: what their arguments' relations give."""

from __future__ import annotations

import random

import pytest
from flint import nmod

from dofkit.exact.errors import NoPointError
from dofkit.exact.points.characters import Character

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
        assert Character(p)._root(value**degree, degree) ** degree == value**degree
        if powers is not None and int(value) not in powers:
            with pytest.raises(NoPointError):
                Character(p)._root(value, degree)


def test_the_same_value_comes_of_arguments_in_either_order() -> None:
    """exp(-200 x) = v gives exp(-201 x)^200 = v^201."""
    x, p = 12345, 2**61 - 1
    rng = random.Random(7)
    for first, second in ((200, 201), (201, 200)):
        found = []
        for _ in range(20):
            exp = Character(p)
            v = exp.at(first * x % p, lambda: nmod(rng.randrange(1, p), p))
            try:
                found.append(exp.at(second * x % p, lambda: nmod(3, p)) ** first == v**second)
            except NoPointError:
                continue
        assert found
        assert all(found)


def test_the_logarithm_of_a_product_of_powers_is_the_sum_of_the_arguments() -> None:
    p = 2**61 - 1
    rng = random.Random(11)
    for powers, root in (([7], 1), ([200, -9], 1), ([3, -16], 2), ([2, -3, 16], 1), ([1, 5, -4, 2, 3], 3), ([], 1)):
        exp = Character(p)
        args = [rng.randrange(1, p) for _ in powers]
        values = [exp.at(u, lambda: nmod(rng.randrange(1, p), p) ** 6) for u in args]
        product = nmod(1, p)
        for v, k in zip(values, powers, strict=True):
            product *= v**k
        value = Character(p)._root(product, root)
        assert (
            exp.argument_of(value)
            == sum((nmod(u, p) * k for u, k in zip(args, powers, strict=True)), nmod(0, p)) / root
        )
        assert exp.argument_of(value * 12345) is None


@pytest.mark.parametrize("power", [-512, -511, -23, -1, 1, 2, 22, 23, 45, 68, 300, 512])
def test_a_large_power_of_one_value(power: int) -> None:
    """Small steps and large ones reach every power: 512 = 11 * 45 + 17."""
    p = 2**61 - 1
    exp = Character(p, {5: nmod(1234567, p)})
    assert exp.argument_of(nmod(1234567, p) ** power) == 5 * power


@pytest.mark.parametrize("powers", [(16, -16, 16), (-16, 5, 4), (0, 0, 13), (3, -2, -16)])
def test_powers_of_three_values(powers: tuple[int, ...]) -> None:
    p = 2**61 - 1
    known = {3: nmod(987654321, p), 10: nmod(1111111, p), 77: nmod(424242, p)}
    value, argument = nmod(1, p), 0
    for (u, v), k in zip(known.items(), powers, strict=True):
        value, argument = value * v**k, argument + u * k
    assert Character(p, known).argument_of(value) == argument % p
