"""Conflicting sets: they conflict, and without any one of their members they do not."""

from __future__ import annotations

from typing import Any

import pytest
from shared.known_scenes import spread
from shared.work import counted

import dofkit


def classified(coordinates: list[str], constraints: list[Any]) -> dofkit.Report:
    return dofkit.classify(dofkit.load({"coordinates": coordinates, "constraints": constraints}))


#: (coordinates, constraints, the only minimal set, why)
TABLE: list[tuple[str, list[str], list[str], str]] = [
    ("x y z", ["x = 1", "y = 2", "x = 3", "z = x"], ["c1", "c3"], "1 is not 3"),
    ("x y", ["x y = 0", "x = 1", "y = 1"], ["c1", "c2", "c3"], "any two hold together"),
    ("x y", ["x (x - 1) = 0", "x = 2", "y = 1"], ["c1", "c2"], "on both branches"),
    ("x y z", ["x^2 + y^2 = 1", "z = 4", "(x - 5)^2 + y^2 = 1"], ["c1", "c3"], "two circles apart"),
    ("x y z", ["z = x + y", "x^2 + y^2 + z^2 = 1", "x = 2"], ["c2", "c3"], "outside the sphere"),
    ("x y z", ["x + y = 1", "y + z = 1", "x - z = 1"], ["c1", "c2", "c3"], "the third less the difference is 1 = 0"),
    ("x y z", ["x = t", "z = 0", "xdot = 2"], ["c1", "c3"], "1 is not 2"),
    ("x y z", ["xdot = y", "z = 0", "ydot = 1", "x = 0"], ["c1", "c3", "c4"], "x = 0, so y = 0, so 1 = 0"),
    ("x y", ["sqrt(x) y = 0", "x = -1"], ["c1", "c2"], "no root of -1"),
    ("x y", ["x + abs(x) = 0", "y = 0", "x = 1"], ["c1", "c3"], "x <= 0"),
    ("x y z", ["z = 1", "x^2 + 1 = 0", "y = 2"], ["c2"], "alone"),
]


@pytest.mark.parametrize(("coordinates", "constraints", "expected", "why"), TABLE, ids=["; ".join(r[1]) for r in TABLE])
def test_conflicting_sets(coordinates: str, constraints: list[str], expected: list[str], why: str) -> None:
    assert why
    report = classified(coordinates.split(), list(constraints))
    assert (report.consistent, report.conflicting) == (False, expected)


@pytest.mark.parametrize(("coordinates", "constraints", "expected", "why"), TABLE, ids=["; ".join(r[1]) for r in TABLE])
def test_without_any_member_the_set_holds(
    coordinates: str, constraints: list[str], expected: list[str], why: str
) -> None:
    assert why
    members = [constraints[int(name[1:]) - 1] for name in expected]
    for left_out in members:
        rest = [text for text in members if text != left_out]
        assert classified(coordinates.split(), list(rest)).consistent is True


def test_a_set_that_may_not_be_minimal_is_no_sure_answer() -> None:
    """Two unit vectors with x + w > 2: the second constraint is not needed, which no engine proves."""
    texts = ["x^2 + y^2 = 1", "x z + y w = 0", "z^2 + w^2 = 1", "x + w = 2 + 1e-9"]
    report = classified(list("xyzw"), texts)
    assert report.consistent is False
    assert {"c1", "c3", "c4"} <= {*report.conflicting}
    assert report.verdicts["conflicting"].verdict == "undecided" or report.conflicting == ["c1", "c3", "c4"]
    walled = classified(list("xyzw"), [*texts, "y >= 0"])
    assert (walled.feasible, walled.infeasible) == (False, walled.conflicting)
    assert walled.verdicts["infeasible"].verdict == walled.verdicts["conflicting"].verdict


def test_unrelated_constraints_are_left_alone() -> None:
    """Forty pairs that have nothing to do with the two circles between them."""
    others = [f"p{i}^2 + q{i}^2 = {i + 1}" for i in range(40)]
    names = ["x", "y", *(f"{c}{i}" for i in range(40) for c in "pq")]
    texts = [*others[:20], "x^2 + y^2 = 1", *others[20:], "(x - 5)^2 + y^2 = 1"]
    report, calls = counted(lambda: classified(names, texts))
    assert report.conflicting == ["c21", "c42"]
    assert calls < 3_000_000


def test_a_long_chain_is_cut_down_to_its_conflict() -> None:
    """x0 = 0, x1 = x0 + 1, ..., x80 = x79 + 1 with x40 = 0: only the first forty-one steps are in conflict."""
    steps = ["x0 = 0", *(f"x{i} = x{i - 1} + 1" for i in range(1, 81))]
    report = classified([f"x{i}" for i in range(81)], [*steps, "x40 = 0"])
    assert report.consistent is False
    assert report.conflicting == [*(f"c{i}" for i in range(1, 42)), "c82"]


# Lengths that cannot be met


def link(ends: str, length: str | int | None = None, name: str | None = None) -> dict[str, Any]:
    """A link between two particles of one letter each."""
    given = {} if length is None else {"length": length}
    return {"name": name or ends, "type": "link", "between": list(ends), **given}


def links(text: str) -> list[dict[str, Any]]:
    """``AB 3, BC 4``: links with their lengths."""
    return [link(*part.split()) for part in text.split(", ")]


def linked(dimension: int, constraints: list[dict[str, Any]], **more: Any) -> dofkit.Report:
    names = sorted({end for c in constraints for end in c.get("between", c.get("along", ())) if isinstance(end, str)})
    made = {"dimension": dimension, "particles": names, "constraints": constraints, **more}
    return dofkit.classify(dofkit.load(made))


UNIT_K4 = "AB 1, BC 1, CA 1, AD 1, BD 1, CD "
#: (dimension, links, the only minimal set, why)
UNMET: list[tuple[int, str, str, str]] = [
    (2, "AB 3, BC 4, CA 8", "AB BC CA", "3 + 4 < 8"),
    (3, "DE 1, AB 3, AD 2, BC 4, CE 9, CA 8", "AB BC CA", "the same among others"),
    (2, "AB 1, BC 1, CD 1, DA 4", "AB BC CD DA", "1 + 1 + 1 < 4"),
    (3, "AB 1, BC 1, CD 1, DE 1, EF 1, FA 11/2", "AB BC CD DE EF FA", "5 < 5.5"),
    (2, "AB sqrt(2), BC sqrt(3), CA sqrt(2)+sqrt(3)+1/10^40", "AB BC CA", "by 10^-40"),
]  # fmt: skip


@pytest.mark.parametrize(("dimension", "text", "expected", "why"), UNMET, ids=[row[1] for row in UNMET])
def test_lengths_that_cannot_be_met(dimension: int, text: str, expected: str, why: str) -> None:
    assert why
    report = linked(dimension, links(text))
    assert (report.consistent, report.dof, report.verdict) == (False, None, "proved")
    assert set(report.conflicting) == set(expected.split())
    members = [part for part in links(text) if part["name"] in report.conflicting]
    for left_out in members[:2]:
        assert linked(dimension, [part for part in members if part is not left_out]).consistent is True


#: Lengths that every polygon allows, and no points have: they may be undecided.
TOO_FEW_DIMENSIONS: list[tuple[int, str, str, str]] = [
    (1, "AB 3, BC 4, CA 5", "AB BC CA", "on a line 3 + 4 = 7 or 4 - 3 = 1"),
    (2, UNIT_K4 + "17/10", "AB BC CA AD BD CD", "two unit triangles: 0 or sqrt(3) = 1.732"),
    (3, UNIT_K4 + "9/5", "AB BC CA AD BD CD", "at most sqrt(3), with both triangles in one plane"),
    (3, "AB 1, BC 1, CA 1, AD 3/5, BD 3/5, CD 1/2", "AB BC CA AD BD CD", "too close to the plane: 0.6 > 1/sqrt(3)"),
    (3, UNIT_K4 + "1, AE 1, BE 1, CE 1, DE 1", "AB BC CA AD BD CD AE BE CE DE", "a regular simplex needs 4 dimensions"),
    (1, "AB 2, BC 3, CD 2, DA 3, AC 5, BD 5", "AB BC CD DA AC BD", "every three are on a line, all four are not"),
]  # fmt: skip


@pytest.mark.parametrize(("dimension", "text", "expected", "why"), TOO_FEW_DIMENSIONS)
def test_too_few_dimensions_are_not_called_enough(dimension: int, text: str, expected: str, why: str) -> None:
    assert why
    report = linked(dimension, links(text))
    assert report.consistent is not True
    assert report.consistent is None or set(report.conflicting) == set(expected.split())


#: Lengths that are just met: (dimension, links)
MET = [
    (2, "AB 3, BC 4, CA 7"),
    (1, "AB 3, BC 4, CA 7"),
    (2, "AB sqrt(2), BC sqrt(3), CA sqrt(5+2*sqrt(6))"),
    (3, "AB 1, BC 2, CD 3, DE 4, EA 10"),
    (2, UNIT_K4 + "sqrt(3)"),
    (3, UNIT_K4 + "sqrt(3)"),
    (2, "AB 1/10, BC 2/10, CA 3/10"),
]


@pytest.mark.parametrize(("dimension", "text"), MET)
def test_lengths_that_are_just_met_are_no_conflict(dimension: int, text: str) -> None:
    assert linked(dimension, links(text)).consistent is True


def test_a_length_left_out_is_no_conflict() -> None:
    assert linked(2, [link("AB"), *links("BC 1, CA 8")]).consistent is True
    assert linked(2, [link("AB"), link("BC"), link("CA"), link("AD"), link("BD"), link("CD")]).consistent is True


def test_lengths_in_terms_of_parameters() -> None:
    """3 a > a + a for every a > 0; a, b and c may be anything."""
    sides = [link("AB", "a"), link("BC", "a"), link("CA", "3 a")]
    assert linked(2, sides, parameters={"a": "positive"}).conflicting == ["AB", "BC", "CA"]
    free = [link("AB", "a"), link("BC", "b"), link("CA", "a + b")]
    assert linked(2, free, parameters={"a": "positive", "b": "positive"}).consistent is not False


def test_two_lengths_for_one_pair() -> None:
    report = linked(2, [*links("AB 1, BC 5"), link("AB", 2, "again")])
    assert (report.consistent, report.conflicting, report.verdict) == (False, ["AB", "again"], "proved")


def test_points_of_the_ground_and_of_bodies_keep_their_distances() -> None:
    """From (0, 0) to (4, 0) by way of three unit rods; from a body's corner to another, 5 apart, by way of 1 + 2."""
    ground = [
        {"name": "left", "type": "link", "between": [[0, 0], "A"], "length": 1},
        {"name": "rod", "type": "link", "between": ["A", "B"], "length": 1},
        {"name": "right", "type": "link", "between": [[4, 0], "B"], "length": 1},
    ]
    assert linked(2, ground).conflicting == ["left", "rod", "right"]
    body = [
        {"name": "one", "type": "link", "between": [{"on": "plate", "at": [0, 0]}, "A"], "length": 1},
        {"name": "two", "type": "link", "between": ["A", {"on": "plate", "at": [3, 4]}], "length": 2},
    ]
    assert linked(2, body, bodies=["plate"]).conflicting == ["one", "two"]


def test_a_string_is_no_shorter_than_its_ends_are_apart() -> None:
    string = {"name": "string", "type": "string", "along": ["A", "B", "C"], "length": 1}
    assert linked(2, [string, link("AC", 2)]).conflicting == ["string", "AC"]
    assert linked(2, [string, link("AC", "1/2")]).consistent is True


# Drives that fight each other


def four_bar(first: str, last: str, **more: Any) -> dofkit.Report:
    """A parallelogram, both of whose cranks are driven; on it the two cranks turn alike."""
    joints: list[dict[str, Any]] = [
        {"name": "A", "type": "revolute", "between": ["ground", "crank"], "at": [0, 0], "drive": first},
        {"name": "B", "type": "revolute", "between": ["crank", "rod"], "at": [0, 1]},
        {"name": "C", "type": "revolute", "between": ["rod", "rocker"], "at": [2, 1]},
        {"name": "D", "type": "revolute", "between": ["ground", "rocker"], "at": [2, 0], "drive": last},
    ]
    scene = {"dimension": 2, "bodies": ["crank", "rod", "rocker"], "constraints": joints, **more}
    return dofkit.classify(dofkit.load(scene))


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
def test_two_cranks_of_a_measured_parallelogram(tolerance: float) -> None:
    """Turning by t and by 2 t they part at once, far beyond the tolerance, which may be undecided."""
    apart = four_bar("t", "2 t", tolerance=tolerance)
    sure = apart.consistent is False
    assert (apart.consistent in (False, None), apart.dof) == (True, None)
    assert (apart.conflicting, apart.verdicts["consistent"].verdict) == (
        (["A", "B", "C", "D"], "numeric") if sure else ([], "undecided")
    )
    assert four_bar("t", "t", tolerance=tolerance).consistent is True


def test_two_cranks_that_are_driven_apart() -> None:
    report = four_bar("t", "2 t")
    assert (report.consistent, report.conflicting) == (False, ["A", "B", "C", "D"])
    assert four_bar("t", "t").consistent is not False


DRIVES = [("t", "2 t"), ("t", "t^2 / 2"), ("t + t^3", "-t"), ("0", "t")]


@pytest.mark.parametrize(("first", "second"), spread(DRIVES, several=True))
def test_two_drives_of_one_door(first: str, second: str) -> None:
    hinges = [
        {
            "name": name,
            "type": "revolute",
            "between": ["ground", "door"],
            "at": [0, 0, z],
            "axis": [0, 0, 1],
            "drive": w,
        }
        for name, w, z in (("low", first, 0), ("high", second, 2))
    ]
    report = dofkit.classify(dofkit.load({"bodies": ["door"], "constraints": hinges}))
    assert (report.consistent, report.conflicting) == (False, ["low", "high"])
    for hinge in hinges:
        assert dofkit.classify(dofkit.load({"bodies": ["door"], "constraints": [hinge]})).consistent is True
