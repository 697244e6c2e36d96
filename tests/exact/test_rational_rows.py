"""Rows over the rationals: which are sums of those before them, exactly."""

from __future__ import annotations

import random

from flint import fmpq, fmpq_mat

from dofkit.exact.matrices.sparse import RECONSTRUCTION_PRIMES, dependences


def rows_of(table: list[list[int]]) -> list[dict[int, fmpq]]:
    return [{c: fmpq(v) for c, v in enumerate(row) if v} for row in table]


def test_every_dependent_row_is_the_sum_it_is_told_to_be() -> None:
    rng = random.Random(5)
    for _ in range(120):
        n, m = rng.randrange(1, 7), rng.randrange(1, 9)
        table = [[rng.choice((0, 0, 1, -1, 2, 5)) for _ in range(n)] for _ in range(m)]
        rows, found = rows_of(table), dependences(rows_of(table))
        assert found is not None
        ranks = [0] + [fmpq_mat([[fmpq(v) for v in row] for row in table[: k + 1]]).rank() for k in range(m)]
        assert set(found) == {k for k in range(m) if ranks[k + 1] == ranks[k]}
        for i, factors in found.items():
            assert max(factors, default=-1) < i
            assert set(factors).isdisjoint(found), "a sum of independent rows"
            total = {c: sum((f * rows[k].get(c, fmpq(0)) for k, f in factors.items()), fmpq(0)) for c in range(n)}
            assert {c: v for c, v in total.items() if v != 0} == rows[i]


def test_a_number_that_a_prime_divides_is_not_zero() -> None:
    p = RECONSTRUCTION_PRIMES[0]
    assert dependences(rows_of([[1, 1], [1, 1 + p]])) == {}
    assert dependences(rows_of([[1, 1], [1 + p, 1 + p]])) == {1: {0: fmpq(1 + p)}}
    assert dependences([{0: fmpq(1, p)}, {0: fmpq(1)}]) == {1: {0: fmpq(p)}}


def test_a_long_cycle() -> None:
    n = 3000
    table = [{k: fmpq(1), (k + 1) % n: fmpq(-1)} for k in range(n)]
    found = dependences(table)
    assert found is not None
    assert list(found) == [n - 1]
    assert set(found[n - 1].values()) == {fmpq(-1)}
    assert len(found[n - 1]) == n - 1
