"""Numbers, matrices and polynomials over GF(p), with primes of 61 bits on every platform.

FLINT's `nmod` types are used where a machine word has 64 bits; where it has 32 (WebAssembly), its `fmpz_mod` types.
"""

from __future__ import annotations

import sys
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import flint

if TYPE_CHECKING or sys.maxsize > 1 << 32:
    Residue = flint.nmod
    ResidueMatrix = flint.nmod_mat
    ResiduePolynomial = flint.nmod_poly
    residue, residue_matrix, residue_polynomial = Residue, ResidueMatrix, ResiduePolynomial
else:
    Residue, ResidueMatrix, ResiduePolynomial = flint.fmpz_mod, flint.fmpz_mod_mat, flint.fmpz_mod_poly
    _context = lru_cache(maxsize=256)(flint.fmpz_mod_ctx)
    _polynomials = lru_cache(maxsize=256)(flint.fmpz_mod_poly_ctx)

    def residue(value: Any, p: int) -> Any:
        """Return an integer modulo p."""
        return Residue(value, _context(p))

    def residue_matrix(*entries_and_modulus: Any) -> Any:
        """Return a matrix modulo p; call with (rows, p) or (number of rows, number of columns, entries, p)."""
        *entries, p = entries_and_modulus
        return ResidueMatrix(*entries, _context(p))

    def residue_polynomial(coefficients: list[Any], p: int) -> Any:
        """Return the polynomial modulo p with these coefficients, the constant one first."""
        return ResiduePolynomial(coefficients, _polynomials(_context(p)))


def modulus(value: Any) -> int:
    """Return p for a number, a matrix or a polynomial modulo p."""
    return int(value.modulus()) if hasattr(value, "modulus") else int(0 * value - 1) + 1  # minus one, plus one


def null_vectors(matrix: Any) -> list[list[Any]]:
    """Return a basis of the kernel of a matrix modulo p: one vector for each column that depends on earlier columns.

    >>> null_vectors(residue_matrix([[1, 2, 0], [0, 0, 1]], 7))
    [[5, 1, 0]]
    """
    reduced, rank = matrix.rref()
    rows, columns = reduced.table()[:rank], matrix.ncols()
    kept, vectors = list[int](), list[list[Any]]()
    for column in range(columns):
        if len(kept) < rank and rows[len(kept)][column]:
            kept.append(column)
            continue
        vector: list[Any] = [int(column == c) for c in range(columns)]
        for row, pivot in zip(rows, kept, strict=False):
            vector[pivot] = -row[column]
        vectors.append(vector)
    return vectors
