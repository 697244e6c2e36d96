"""Sweeps near singular poses, over sizes, places, names and digits: no answer is wrong, and few are left open."""

from __future__ import annotations

from fractions import Fraction
from itertools import islice

import pytest
from shared.known_scenes import swept
from shared.trials import differences

import dofkit
from dofkit.benchmark.trials.sweeps import DIGITS, JOINTED, NEAR, SWEEPS, Case, Near

#: (sweep, mechanism) -> (how many are left open, why).
OPEN: dict[tuple[str, str], tuple[int, str]] = {
    ("rounded, with tolerance", "three on a rod, space"): (
        len(DIGITS),
        "measured lengths do not tell a straight rod from one that is bent by a little less than their root",
    ),
    ("rounded, with tolerance", "third crank"): (
        2,
        "cranks that move within a thousandth are not followed far enough to tell that from shaking",
    ),
}


def told(case: Case) -> tuple[list[str], list[str]]:
    return differences(case.known, dofkit.classify(dofkit.load(dict(case.known.scene))))


#: Here much is left open: floating point tells little of a drawing far from the origin.
COARSE = "scaled and moved, with tolerance"


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("sweep", "step"), [case for name in SWEEPS if name != COARSE for case in [pytest.param(name, 6), swept(name, 1)]]
)
def test_nothing_is_wrong_and_little_is_left_open(sweep: str, step: int) -> None:
    wrong, opened = [], []
    for case in islice(SWEEPS[sweep](), None, None, step):
        not_true, left_open = told(case)
        wrong += [f"{case.known.name}: {line}" for line in not_true]
        if left_open:
            opened.append(case.known.name)
    assert wrong == []
    for (where, mechanism), (number, _) in OPEN.items():
        some = [name for name in opened if name.startswith(mechanism) and where == sweep]
        assert len(some) <= number
        opened = [name for name in opened if name not in some]
    assert opened == []


@pytest.mark.sweep
def test_measured_drawings_of_any_size_and_anywhere() -> None:
    """None is wrong; where they are drawn, and at any size there, nearly all are answered."""
    cases = [(case.known.name, *told(case)) for case in SWEEPS[COARSE]()]
    assert [(name, wrong) for name, wrong, _ in cases if wrong] == []
    opened = [name for name, _, left_open in cases if left_open]
    assert [name for name in opened if "away" not in name and not name.startswith("three on a rod, space")] == []
    assert len(opened) < len(cases) / 3


@pytest.mark.parametrize("near", NEAR, ids=lambda near: near.name)
def test_the_velocities_by_hand_are_those_of_the_matrix(near: Near) -> None:
    """The rank over the rationals, at the singular pose and beside it."""
    for step, (dof, first) in ((Fraction(0), near.there), (Fraction(1, 1000), near.beside)):
        assert near.at(step).by_rank() == first
        assert dof is None or dof <= first


def test_there_are_many() -> None:
    assert len(NEAR) + len(JOINTED) >= 17
    assert sum(1 for sweep in SWEEPS.values() for _ in sweep()) >= 450
