"""Products of functions among which integrals are looked for: those that are one function on the finite relations."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.classification.study import study
from dofkit.integrability.integrals.ansatz import IntegralSearch
from dofkit.scene.lowering import lower

ALONG = {
    "parameters": {"R": "positive", "alpha": "real"},
    "coordinates": ["y", "theta", "phi"],
    "constraints": ["dy = R cos(theta) dphi", "theta = alpha"],
}
ROOT = {"coordinates": ["x", "u", "z", "w"], "constraints": ["x^2 = u", "dz = sqrt(u) dw"]}


def search_of(scene: dict[str, Any], seed: int) -> IntegralSearch:
    """The search among the functions of a scene of one block."""
    found = study(lower(dofkit.load(scene)))
    (block,) = found.outcome.blocks
    return IntegralSearch(found.company.parts.forms(block, ()), seed)


@pytest.mark.parametrize(("degree", "every", "left"), [(1, 3, 2), (2, 21, 13), (3, 82, 47)])
def test_what_equals_a_constant_moves_nothing(degree: int, every: int, left: int) -> None:
    """theta is alpha: y and phi move, beside R, alpha, cos(alpha) and sin(alpha), of which sines occur once.

    Of degree 1: y, theta, phi. Of degree 2 also theirs with the four constants (3 * 4) and with each other (6). Of
    degree 3 three of them (10), two with a constant (6 * 4), one with two constants but sin^2 (3 * 9): 61 more. Without
    theta 2; 2 * 4 + 3 more; 4 + 3 * 4 + 2 * 9 more.
    """
    search = search_of(ALONG, 0)
    monomials = search.monomials(degree)
    assert len(monomials) == every
    assert search.sample() is not None
    assert len(search._distinct(monomials)) == left


@pytest.mark.parametrize("seed", range(6))
def test_what_is_equal_at_one_point_only_stays_apart(seed: int) -> None:
    """On x^2 = u the root of u is x or -x, by the point."""
    search = search_of(ROOT, seed)
    monomials = search.monomials(2)
    assert search.sample() is not None
    assert search._distinct(monomials) == monomials


def test_the_integral_with_what_stands_still() -> None:
    report = dofkit.classify(ALONG)
    assert report.constraints[0].integral == "R*phi*cos(alpha) - y = C"
