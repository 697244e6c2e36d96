"""Forms are looked at where a point of the set is known for certain, and nowhere else."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

import dofkit


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


@pytest.mark.parametrize(
    ("names", "constraints", "degenerate", "special", "generic"),
    [
        ("y z", ["sin(z) = 0", "z ydot = 0"], "z", 1, 0),
        ("x y z", ["sin(z) = 0", "(z - pi) ydot = 0"], "z - pi", 2, 1),
        ("x y z", ["tan(x) = 0", "x ydot = 0"], "x", 2, 1),
        ("x y z", ["sin(x y) = 0", "x y zdot = 0"], "x y", 2, 1),
        ("x y z", ["sin(x) = x y", "x zdot = 0"], "x", 2, 1),
        ("x y z u", ["sin(z) = 0", "udot = z x ydot"], "z", 2, 3),
    ],
)
def test_the_numbers_are_those_of_the_part_that_the_witness_is_on(
    names: str, constraints: list[str], degenerate: str, special: int, generic: int
) -> None:
    """Of z = 0, pi, 2 pi, ... the form z ydot leaves out the first; whichever part is told of, the witness is on it."""
    report = dofkit.classify({"coordinates": names.split(), "constraints": constraints})
    if report.dof is None:
        return
    assert report.witness is not None
    assert report.verdicts["dof"].about == "component"
    place = {name: float(Fraction(text)) for name, text in report.witness.items()}
    size = {
        "z": place.get("z", 0),
        "x": place.get("x", 0),
        "z - pi": place.get("z", 0) - math.pi,
        "x y": place.get("x", 0) * place.get("y", 0),
    }[degenerate]
    assert report.dof == (special if abs(size) < 1e-9 else generic)


def test_a_branch_of_which_a_larger_part_may_be_unseen_is_named() -> None:
    """x = 0 leaves one freedom, and so do sin(z) = 0 where z is not 0; z = 0 leaves two."""
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": ["z ydot = 0", "x sin(z) = 0"]})
    assert report.dof in (None, 2) or report.verdicts["dof"].about == "component"


@pytest.mark.sweep
def test_a_part_outside_the_domain_does_not_count() -> None:
    """Where x = 10, y = 0 the other relations leave u, v and w free; as written x is at most 9, so x and u are free."""
    relations = ["(x - 10) v = y w", "(x - 10) w = y u"]
    free = dofkit.classify({"coordinates": list("xyuvw"), "constraints": ["y = (x - 10) u^7", *relations]})
    bounded = ["(y - (x - 10) u^7) exp(sqrt(9 - x)) = 0", *relations]
    kept = dofkit.classify({"coordinates": list("xyuvw"), "constraints": bounded})
    assert free.dof == 3
    assert kept.dof in (None, 2)


def test_a_part_outside_the_domain_contradicts_nothing() -> None:
    """1/(x - 10) has no value where x = 10, y = 0; y = (x - 10) u^7, w = u^8, v = u^15 holds beside that part."""
    third = "((x - 10) w - y u) (2 + sin(1/(x - 10))) = 0"
    scene = {"coordinates": list("xyuvw"), "constraints": ["y = (x - 10) u^7", "(x - 10) v = y w", third]}
    report = dofkit.classify(scene)
    assert report.consistent is not False
    assert report.dof in (None, 2)


@pytest.mark.parametrize(
    ("constraints", "form", "zero_where"),
    [
        (["zdot = (acos(cos(x)) - x) ydot"], "c1", 1),
        (["zdot = (asin(sin(x)) + x) ydot"], "c1", None),
        (["zdot = (atan(x) + atan(1/x) - pi/2) x ydot"], "c1", 1),
        (["zdot = (sqrt(1 + cos(2 x)) + sqrt(2) cos(x)) x ydot"], "c1", None),
        (["u = x^2 - 1", "zdot = (sqrt(1 + u) - x) ydot"], "c2", 1),
        (["u = x^2 - 1", "zdot = (sqrt(1 + u) + x) ydot"], "c2", -1),
        (["u^2 = y^2 + 1", "zdot = (abs(u) - u) ydot", "x = u", "u <= 0"], "c2", 1),
        (["u = cos(x)", "zdot = (sqrt(1 - u) + sqrt(2) sin(x/2)) ydot"], "c2", -1),
    ],
)
def test_a_form_that_vanishes_in_one_region_is_not_labelled_everywhere(
    constraints: list[str], form: str, zero_where: int | None
) -> None:
    """acos(cos(x)) = x from 0 to pi and -x from -pi to 0: there the form is dz = 0, elsewhere it does not integrate."""
    names = [name for name in "xyzu" if any(name in text for text in constraints)]
    report = dofkit.classify({"coordinates": names, "constraints": constraints})
    entry = next(e for e in report.constraints if e.name == form)
    assert entry.holonomic is None or entry.verdicts["holonomic"].about != "everywhere"
    if report.dof is not None and zero_where is not None:
        is_zero = float(Fraction((report.witness or {})["x"])) * zero_where > 0
        assert entry.holonomic is is_zero


@pytest.mark.parametrize(("x", "holonomic"), [(1, False), (-1, True)])
def test_at_a_reference_a_form_has_the_label_of_its_region(x: int, holonomic: bool) -> None:
    """On u = x^2 - 1 the root of 1 + u is |x|: for x < 0 the form is dz = 0."""
    scene = {"coordinates": list("xyzu"), "constraints": ["u = x^2 - 1", "zdot = (sqrt(1 + u) + x) ydot"]}
    report = dofkit.classify({**scene, "configuration": {"x": x, "y": 0, "z": 0, "u": 0}})
    assert report.constraints[1].holonomic in (holonomic, None)
    assert report.dof in (2 if holonomic else 3, None)
