"""Sparse elimination over GF(p) against dense elimination, row by row."""

from __future__ import annotations

import random

import pytest

from dofkit.exact.matrices.sparse import echelon, last_columns, rank_of_rows, sparse
from dofkit.exact.residues import residue_matrix

P = (1 << 61) - 1


def rank(rows: list[list[int]]) -> int:
    return int(residue_matrix(rows, P).rank()) if rows and rows[0] else 0


def random_matrix(seed: int) -> list[list[int]]:
    """Few entries, and rows that are sums of others."""
    rng = random.Random(seed)
    columns = rng.randint(1, 9)
    rows = [[rng.choice([0, 0, 0, 1, 2, rng.randrange(P)]) for _ in range(columns)] for _ in range(rng.randint(1, 9))]
    for _ in range(rng.randint(0, 3)):
        a, b = rng.choice(rows), rng.choice(rows)
        rows.insert(rng.randrange(len(rows) + 1), [(3 * x + 5 * y) % P for x, y in zip(a, b, strict=True)])
    return rows


@pytest.mark.parametrize("seed", range(150))
def test_the_first_independent_rows_and_what_the_others_depend_on(seed: int) -> None:
    matrix = random_matrix(seed)
    found = echelon(sparse(matrix), P, supports=True)
    kept: list[int] = []
    for i, row in enumerate(matrix):
        if rank([*(matrix[k] for k in kept), row]) > len(kept):
            kept.append(i)
    assert found.independent == tuple(kept)
    assert rank_of_rows(sparse(matrix), P) == rank(matrix)
    assert set(found.supports) == set(range(len(matrix))) - set(kept)
    for i, support in found.supports.items():
        rows = [matrix[k] for k in support]
        assert all(k < i for k in support)
        assert rank([*rows, matrix[i]]) == len(rows)
        for k in support:
            assert rank([matrix[j] for j in (*support, i) if j != k]) == len(rows)


@pytest.mark.parametrize("seed", range(60))
def test_the_last_columns_that_are_independent(seed: int) -> None:
    matrix = random_matrix(seed)
    columns = len(matrix[0])
    kept: list[int] = []
    for c in reversed(range(columns)):
        if rank([[row[j] for j in (*kept, c)] for row in matrix]) > len(kept):
            kept.append(c)
    assert last_columns(sparse(matrix), columns, P) == tuple(sorted(kept))


def test_a_long_chain_fills_in_nothing() -> None:
    """Each row shares one column with the next: 20 000 rows in a blink."""
    rows = [{i: 1, i + 1: 2} for i in range(20_000)]
    assert echelon(rows, P).rank == 20_000
    assert len(last_columns(rows, 20_001, P)) == 20_000
