"""GF(p) on limbs of 64 bits and of 32: the same numbers, matrices and polynomials."""

import sys
from importlib.util import module_from_spec, spec_from_file_location
from types import ModuleType

import pytest
from flint import fmpz_mod
from hypothesis import given
from hypothesis import strategies as st

from dofkit.exact import residues as words

P = 2**61 - 1
ENTRIES = st.lists(
    st.lists(st.sampled_from([0, 0, 1, 2, P - 1, 2**60]), min_size=4, max_size=4), min_size=1, max_size=4
)


def of_narrow_limbs() -> ModuleType:
    """Return the module as it is where a limb has 32 bits."""
    spec = spec_from_file_location("residues_of_narrow_limbs", words.__file__)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "maxsize", 2**31 - 1)
        spec.loader.exec_module(module)
    return module


NARROW = of_narrow_limbs()


def test_another_type_holds_the_same_prime() -> None:
    assert NARROW.Residue is fmpz_mod
    for kind in (words, NARROW):
        three = kind.residue(3, P)
        assert isinstance(three, kind.Residue)
        assert int(1 / three) * 3 % P == 1
        assert kind.modulus(three) == kind.modulus(three - three) == P
        line = kind.residue_polynomial([-3, 1], P)
        assert kind.modulus(line) == P
        assert [int(root) for root, _ in line.roots()] == [3]
        assert int(line.inverse_series_trunc(2)[1]) * -9 % P == 1  # 1/(s - 3) = -1/3 - s/9 - ...


@given(ENTRIES)
def test_null_vectors_are_as_many_as_columns_depend_on_others(rows: list[list[int]]) -> None:
    bases = []
    for kind in (words, NARROW):
        matrix = kind.residue_matrix(rows, P)
        assert kind.modulus(matrix) == P
        vectors = [[int(v) for v in vector] for vector in kind.null_vectors(matrix)]
        assert len(vectors) == 4 - matrix.rank()
        assert all(sum(a * v for a, v in zip(row, vector, strict=True)) % P == 0 for row in rows for vector in vectors)
        assert not vectors or kind.residue_matrix(vectors, P).rank() == len(vectors)
        bases.append(vectors)
    assert bases[0] == bases[1]
