"""The report at a terminal: what it says, how it wraps, and that nothing in it is obeyed."""

from __future__ import annotations

from typing import Any

import pytest

from dofkit.interface.show.report import MOST_ROWS, labels, sheet_of_report
from dofkit.interface.show.terminal import Screen, as_text
from dofkit.report import ConstraintEntry, Count, FieldVerdict, ForceEntry, Redundancy, Report, SpecialCase


def entry(**fields: Any) -> ConstraintEntry:
    given: dict[str, Any] = {
        "name": "c1", "type": "equation", "text": "x dy + y dx = 0", "form": "pfaffian", "holonomic": True,
        "holonomic_alone": True, "scleronomic": True, "catastatic": True, "bilateral": True, "exact": True,
        "integrating_factor": None, "integral": "x*y = C", "circuit": None, "equations": 1, "independent": 1,
        "verdict": "proved", "reason": "It is closed.",
    }  # fmt: skip
    return ConstraintEntry(**{**given, **fields})


def report(**fields: Any) -> Report:
    count = Count(
        particles=2, bodies=1, dimension=3, coordinates=12, constraints=3, independent=2, naive_dof=9,
        formula="f = N d - k = 9", errs=None,
    )  # fmt: skip
    given: dict[str, Any] = {
        "scene": "example", "consistent": True, "dof": 10, "velocity_dof": 9, "instantaneous_dof": None,
        "singular": None, "holonomic": False, "scleronomic": True, "count": count, "redundant_equations": 0,
        "redundant": [], "redundancies": [], "conflicting": [], "generalized_coordinates": ["x", "y"],
        "growth_vector": None, "constraints": [entry()], "forces": [], "special_cases": [],
        "verdict": "proved", "method": "rank",
        "modelled": "everything", "warnings": [],
    }  # fmt: skip
    return Report(**{**given, **fields})


def shown(
    told: Report, title: str | None = "A title", width: int = 80, how: bool = False, coloured: bool = False
) -> str:
    return as_text(sheet_of_report(told, title, how), Screen(width, "standard" if coloured else None))


def test_it_says_what_is_asked_first() -> None:
    text = shown(report())
    assert text.startswith("example  A title\n")
    for piece in (
        "f = N d - k = 9", "2 particles, 1 body, 12 coordinates, 3\n", "degrees of freedom  10",
        "velocities          9", "non-holonomic, scleronomic", "x, y (independent", "c1: x*y = C   (exact as written)",
        "c1: It is closed.",
    ):  # fmt: skip
        assert piece in text


def test_how_is_told_where_it_is_asked_for_or_where_something_is_not_proved() -> None:
    assert "How" not in shown(report())
    sure = {"dof": FieldVerdict(verdict="proved", argument="graph")}
    for text in (shown(report(verdicts=sure), how=True), shown(report(verdict="probable"))):
        assert "How\n  the model: everything\n  the way: rank\n" in text
    assert "proved: follows by exact arithmetic" in shown(report(), how=True)
    assert "degrees of freedom: 'graph': the set is a graph" in shown(report(verdicts=sure), how=True, width=120)
    assert "'graph'" not in shown(report(verdict="probable", verdicts=sure))


def test_the_way_is_told_without_the_words_of_the_engines() -> None:
    text = shown(report(method="rank over GF(p) and balls; count of rows over GF(p)"), how=True, width=400)
    assert "the rank of the equations, found twice" in text
    assert "GF(p)" not in text
    assert "balls" not in text


def test_where_the_count_errs_it_says_so() -> None:
    wrong = report().count.model_copy(update={"errs": "one link too many"})
    assert "where it errs       one link too many" in shown(report(count=wrong))


def test_special_cases_stand_apart() -> None:
    cases = [
        SpecialCase(where="R = 0", kind="parameters", what="dof 2 instead of 4", constraints=["c1"], verdict="proved"),
        SpecialCase(where="y = 0", kind="locus", what="it is flat", constraints=["c1", "c2"], verdict="probable"),
    ]
    text = shown(report(special_cases=cases))
    assert "Special cases\n  R = 0: dof 2 instead of 4 (c1)\n  y = 0: it is flat (c1, c2) [probable]\n" in text
    assert "probable: exact arithmetic at random points" in text
    assert "Special cases" not in shown(report())


def test_a_singular_configuration_is_told() -> None:
    assert "to first order      11" in shown(report(instantaneous_dof=11, singular=True))
    assert "singular" in shown(report(instantaneous_dof=11, singular=True))
    assert "to first order" not in shown(report())


def test_what_contradicts_is_named() -> None:
    text = shown(report(consistent=False, dof=None, velocity_dof=None, conflicting=["c1", "c2"], verdict="probable"))
    assert "Inconsistent: no motion satisfies all of c1, c2." in text
    assert "degrees of freedom" not in text
    assert "probable: exact arithmetic at random points" in text


@pytest.mark.parametrize(
    ("fields", "line"),
    [
        ({"feasible": True, "feasible_at": {"x": "1", "y": "0"}}, "can all be met, as at x = 1, y = 0"),
        ({"feasible": False, "infeasible": ["c1", "wall"]}, "cannot all be met: no motion satisfies all of c1, wall"),
        ({"feasible": None}, "undecided whether they can all be met"),
    ],
)
def test_inequalities_have_one_line_where_there_are_some(fields: dict[str, Any], line: str) -> None:
    wall = entry(name="wall", form="inequality", bilateral=False)
    assert f"inequalities        {line}\n" in shown(report(constraints=[entry(), wall], **fields))
    assert "inequalities" not in shown(report(**fields))
    assert "inequalities" not in shown(report(constraints=[wall], consistent=False, conflicting=["wall"], **fields))


def test_redundancy_forces_and_warnings() -> None:
    told = report(
        redundant_equations=1,
        redundant=["c2"],
        redundancies=[Redundancy(nullity=1, members=["c1", "c2"])],
        constraints=[entry(), entry(name="c2", circuit=["c1"], independent=0, integral=None)],
        forces=[ForceEntry(name="spring", reason="It only pulls.")],
        warnings=["look out"],
    )
    text = shown(told)
    for piece in (
        "can be dropped together: c2", "1 equation too many among: c1, c2", "c2: follows from c1", "0 of 1",
        "spring: It only pulls.", "! look out", "c1, c2: It is closed.",
    ):  # fmt: skip
        assert piece in text


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({}, "holonomic, scleronomic, bilateral"),
        ({"holonomic": False, "holonomic_alone": False}, "non-holonomic, scleronomic, bilateral"),
        ({"holonomic_alone": False}, "holonomic (alone: non-holonomic), scleronomic, bilateral"),
        ({"scleronomic": False, "bilateral": False}, "holonomic, rheonomic, unilateral"),
        ({"holonomic": None, "holonomic_alone": None}, "holonomic?, scleronomic, bilateral"),
    ],
)
def test_labels_in_words(fields: dict[str, Any], words: str) -> None:
    assert labels(entry(**fields)) == words


@pytest.mark.parametrize("width", [40, 80, 200])
def test_it_wraps_and_has_no_colour_when_piped(width: int) -> None:
    long = entry(text="x^2 + " * 60 + "y = 0", reason="because " * 60, name="a_long_name" * 4)
    text = shown(report(constraints=[long], warnings=["w " * 200]), width=width)
    assert max(map(len, text.splitlines())) <= width
    assert "\x1b" not in text
    assert not any(line != line.rstrip() for line in text.splitlines())
    assert "\x1b[" in shown(report(), coloured=True)


def test_thousands_of_constraints_are_counted() -> None:
    many = [entry(name=f"c{i}", reason=f"reason {i}") for i in range(5000)]
    text = shown(report(constraints=many, redundant=[one.name for one in many]))
    assert f"... and {5000 - MOST_ROWS} more: --json has them all" in text
    assert len(text.splitlines()) < 6 * MOST_ROWS


def test_markup_and_escapes_in_a_scene_are_only_text() -> None:
    text = shown(report(scene="[red]a[/red]", constraints=[entry(text="[bold]x\x1b[2J", reason="[/]")]), "[link=x]t")
    for piece in ("[red]a[/red]", "[link=x]t", "[bold]x?[2J", "c1: [/]"):
        assert piece in text
