"""Forms are looked at where a point of the set is known for certain, and nowhere else."""

from __future__ import annotations

from dataclasses import replace

import pytest

import dofkit
from dofkit.classification.freedom import block
from dofkit.configuration.variety import Variety
from dofkit.integrability.pfaffian_system import Codistribution
from dofkit.relations.setting import Setting


@pytest.mark.parametrize("there", [True, False])
def test_a_real_point_that_is_not_certified_decides_nothing(there: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    points = block._points

    def uncertain(forms: Codistribution, setting: Setting) -> Variety:
        found = points(forms, setting)
        assert found.real is not None
        return replace(found, samples=[], real=replace(found.real, certified=False) if there else None)

    monkeypatch.setattr(block, "_points", uncertain)
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": ["x^2 + y^2 = 1", "zdot = y xdot"]})
    assert (report.dof, report.verdict) == (None, "undecided")


@pytest.mark.parametrize(
    ("constraints", "dof"),
    [
        (["x^2 + y^2 = 1", "dz = x dw"], 3),
        (["x^2 + y^2 = 1", "dz = x dx + w dw"], 2),
        (["x^3 + y^3 + x y = 1", "dz = x dw", "du = y dy"], 3),
    ],
)
def test_beside_a_curve_the_freedom_of_forms_is_proved(constraints: list[str], dof: int) -> None:
    """What no form takes away, and no curve, the brackets span: the curve's differential counts with them."""
    names = [name for name in "xyzwu" if any(name in text for text in constraints)]
    report = dofkit.classify({"coordinates": names, "constraints": constraints})
    assert (report.dof, report.verdicts["dof"].verdict) == (dof, "proved")
