"""Small dense matrices on lists and FLINT's numbers agree with numpy's; an ordinary scene needs no numpy."""

import os
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shared.documented import ROOT

from dofkit.base.errors import NoValueError
from dofkit.exact.matrices import dense

#: Above the noise of a matrix of rank r, below all that its r factors give.
LEAST = 1e-9


@st.composite
def matrices(draw: st.DrawFn) -> np.ndarray:
    """Products of factors with small whole entries, many of them rank-deficient; the largest are numpy's."""
    rows, columns = draw(st.integers(1, 6)), draw(st.integers(1, 6))
    size = draw(st.sampled_from([1, 1, 1, 5]))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    rank = draw(st.integers(0, min(rows, columns)))
    return rng.integers(-2, 3, (rows * size, rank)) @ rng.integers(-2, 3, (rank, columns * size)) / 3


@given(matrices())
def test_singular_values_and_the_rank_are_those_of_numpy(matrix: np.ndarray) -> None:
    singular = np.linalg.svd(matrix, compute_uv=False)
    assert np.allclose(dense.singular_values(matrix.tolist()), singular, atol=1e-12 * (1 + singular.max()))
    assert dense.rank(matrix.tolist(), LEAST) == np.linalg.matrix_rank(matrix, LEAST)


@given(matrices())
def test_pivots_and_their_complement_are_an_orthonormal_basis_of_everything(matrix: np.ndarray) -> None:
    chosen = dense.pivoted(matrix.tolist(), LEAST)
    assert chosen.sizes == sorted(chosen.sizes, reverse=True) or np.allclose(chosen.sizes, sorted(chosen.sizes)[::-1])
    others = dense.complement(chosen.basis, matrix.shape[1])
    assert np.allclose(matrix @ np.array(others).reshape(-1, matrix.shape[1]).T, 0, atol=1e-9)
    basis = np.array([*chosen.basis, *others])
    assert np.allclose(basis @ basis.T, np.eye(matrix.shape[1]), atol=1e-9)


@given(matrices(), st.integers(0, 10**6))
def test_a_step_is_the_least_solution_of_numpy(matrix: np.ndarray, seed: int) -> None:
    right = np.random.default_rng(seed).uniform(-1, 1, len(matrix))
    expected = np.linalg.lstsq(matrix, -right, rcond=1e-10)[0]
    assert np.allclose(dense.step(matrix.tolist(), right.tolist()), expected, atol=1e-7)
    gram = matrix @ matrix.T + np.linalg.norm(right) * np.eye(len(matrix))
    assert np.allclose(
        dense.damped(matrix.tolist(), right.tolist()), -matrix.T @ np.linalg.solve(gram, right), atol=1e-7
    )


@given(matrices())
def test_the_least_eigenvector_is_one(matrix: np.ndarray) -> None:
    form = matrix @ matrix.T - np.eye(len(matrix))
    value, vector = dense.least_eigenvector(form.tolist())
    assert value == pytest.approx(np.linalg.eigvalsh(form)[0], abs=1e-9)
    assert np.allclose(form @ vector, value * np.array(vector), atol=1e-7)
    assert dense.length(vector) == pytest.approx(1)


def test_what_is_not_finite_is_no_number() -> None:
    assert not dense.largest([1.0, float("nan")]) < 2
    assert not dense.largest([1.0, float("inf")]) < 2
    with pytest.raises(NoValueError):
        dense.unit_rows([[1.0, float("inf")]])


def test_no_scene_of_the_catalog_imports_numpy() -> None:
    """Nor workers, which are for a budget. `numpy` itself is listed as soon as somebody may import it."""
    code = (
        "import sys, dofkit; [dofkit.classify(name) for name in list(dofkit.catalog_names())[::3]]; "
        "print({'numpy.linalg', 'dofkit.base.workers', 'dofkit.methods.certificates'} & sys.modules.keys())"
    )
    command = [sys.executable, "-c", code]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    assert (
        subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.strip() == "set()"
    )
