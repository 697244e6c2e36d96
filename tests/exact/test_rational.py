"""Quotients of polynomials in one unknown over GF(p) do not grow without end."""

from __future__ import annotations

import pytest
from flint import nmod_poly

from dofkit.exact.errors import NoValueError
from dofkit.exact.unknowns import LARGEST, LOW, Rational

P = 2**61 - 1


def over(k: int) -> Rational:
    """1/(x + k)."""
    return Rational(nmod_poly([1], P), nmod_poly([k, 1], P))


def test_a_sum_over_common_denominators_stays_small() -> None:
    """200 (1/(x + 1) + 1/(x + 2)) = 200 (2 x + 3)/((x + 1) (x + 2))."""
    total = over(1) + over(2)
    for _ in range(199):
        total = (total + over(1)) + over(2)
        assert total.bottom.degree() <= LOW
    top = total.numerator()
    assert top * 2 == nmod_poly([3, 2], P) * top.leading_coefficient()


def test_what_stays_large_is_given_up() -> None:
    product = over(0) * over(1)
    while product.bottom.degree() <= LARGEST // 2:
        product = product * product
    with pytest.raises(NoValueError):
        product * product * product
