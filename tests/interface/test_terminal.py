"""The report at a terminal: what it says, how it wraps, and that nothing in it is obeyed."""

from __future__ import annotations

import re
from typing import Any

import pytest

import dofkit
from dofkit.base.verdicts import ArgumentKey, Verdict
from dofkit.interface.show.assurance import checked_claims
from dofkit.interface.show.decimals import as_the_scene
from dofkit.interface.show.report import MOST_ROWS, labels, sheet_of_report
from dofkit.interface.show.terminal import as_text
from dofkit.report import ConstraintEntry, Count, FieldVerdict, ForceEntry, Redundancy, Report


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
    return as_text(sheet_of_report(told, title, how), width, "standard" if coloured else None)


def test_arguments_are_shown_where_they_are_asked_for() -> None:
    sure = {"dof": FieldVerdict(verdict="proved", argument="graph")}
    text = shown(report(verdicts=sure), how=True, width=120)
    assert "How\n  model: everything\n  method: rank\n" in text
    assert "proved: derived by exact arithmetic" in text
    assert "degrees of freedom: 'graph': the configuration space is a graph" in text
    assert "How\n" not in shown(report(verdict="probable", verdicts=sure))


@pytest.mark.parametrize(
    ("verdict", "bound", "line"),
    [
        ("probable", "2^-30", "chance of error below 1e-9 (details: --how)"),  # 2^-30 = 9.3e-10
        (
            "numeric",
            "4.7e+15",
            "the rank is unambiguous: no value that is kept is below 10^12 times one that is taken as zero",
        ),
        (
            "numeric",
            "2.3e+04",
            "the smallest value that is kept is about 23000 times the largest that is taken as zero",
        ),
        ("numeric", "inf", "no value is taken as zero (details: --how)"),
        ("undecided", None, "undecided  degrees of freedom (details: --how)"),
    ],
)
def test_what_is_not_proved_has_one_line_with_the_reason(verdict: Verdict, bound: str | None, line: str) -> None:
    argument: ArgumentKey | None = None if bound is None else "graph"
    found = {"dof": FieldVerdict(verdict=verdict, argument=argument, bound=bound)}
    assert line in shown(report(verdict=verdict, verdicts=found), width=200)


def test_time_is_counted_in_a_growth_vector_that_begins_above_the_velocities() -> None:
    assert re.search(
        r"growth vector +\(10, 11\)  in \(q, t\): time is counted\n", shown(report(growth_vector=[10, 11]))
    )
    assert re.search(r"growth vector +\(9, 10\)\n", shown(report(growth_vector=[9, 10])))


def test_the_way_is_reported_without_the_words_of_the_engines() -> None:
    text = shown(report(method="rank over GF(p) and balls; count of rows over GF(p)"), how=True, width=400)
    assert "the rank of the equations, computed twice" in text
    assert "GF(p)" not in text
    assert "balls" not in text


def test_a_singular_configuration_is_reported() -> None:
    text = shown(report(instantaneous_dof=11, singular=True))
    assert re.search(r"instantaneous freedom +11  at the reference configuration; exceeds", text)
    assert "singular configuration" in text
    assert "instantaneous freedom" not in shown(report())


def test_what_contradicts_is_named() -> None:
    text = shown(report(consistent=False, dof=None, velocity_dof=None, conflicting=["c1", "c2"], verdict="probable"))
    assert "Inconsistent: no motion satisfies all of c1, c2." in text
    assert "degrees of freedom" not in text
    assert "f = N d - k" not in text


@pytest.mark.parametrize(
    ("fields", "line"),
    [
        (
            {"feasible": True, "feasible_at": {"x": "1", "y": "-0.138493964115629"}},
            "consistent, for example near x = 1, y = -0.138",
        ),
        ({"feasible": False, "infeasible": ["c1", "wall"]}, "inconsistent: no motion satisfies all of c1, wall"),
        ({"feasible": None}, "undecided whether they are consistent"),
    ],
)
def test_inequalities_have_one_line_where_there_are_some(fields: dict[str, Any], line: str) -> None:
    wall = entry(name="wall", form="inequality", bilateral=False)
    assert f"inequalities             {line}\n" in shown(report(constraints=[entry(), wall], **fields))
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
        "maximal redundant set: c2", "Overconstrained by 1: the equations of c1, c2 are dependent.",
        "c2: implied by c1", "0 of 1",
        "spring: It only pulls.", "! Look out.", "c1, c2: Each is closed.",
    ):  # fmt: skip
        assert piece in text


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({}, "holonomic, scleronomic, bilateral"),
        ({"holonomic": False, "holonomic_alone": False}, "non-holonomic, scleronomic, bilateral"),
        ({"holonomic_alone": False}, "holonomic (on its own: non-holonomic), scleronomic, bilateral"),
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
    assert f"... and {5000 - MOST_ROWS} more (--json lists all)" in text
    assert len(text.splitlines()) < 80


def test_markup_and_escapes_in_a_scene_are_only_text() -> None:
    text = shown(report(scene="[red]a[/red]", constraints=[entry(text="[bold]x\x1b[2J", reason="[/]")]), "[link=x]t")
    for piece in ("[red]a[/red]", "[link=x]t", "[bold]x?[2J", "c1: [/]"):
        assert piece in text


def test_decimals_come_back_as_decimals_where_the_scene_has_decimals() -> None:
    """y dx + x dy = 0.5 dx has the integral x y - x/2 = C."""
    scene = {"coordinates": ["x", "y"], "constraints": ["y dx + x dy = 0.5 dx"]}
    fractions = {"coordinates": ["x", "y"], "constraints": ["y dx + x dy = 1/2 dx"]}
    told = [as_the_scene(dofkit.classify(given), dofkit.load(given)) for given in (scene, fractions)]
    decimal, fraction = (one.constraints[0].integral or "" for one in told)
    assert ("0.5" in decimal, "/2" in decimal, "/2" in fraction) == (True, False, True)
    assert decimal in str(dofkit.classify(scene))


def test_a_report_says_how_many_claims_are_checked() -> None:
    assert checked_claims(dofkit.classify("bolt")) == []
    first, second = checked_claims(dofkit.classify("universal-joint-alone", certificate=True))
    confirmed, _, proved = str(first.label).split()
    assert int(proved) - int(confirmed) == 1
    assert (second.label, second.text) == ("without evidence", "generalized coordinates")
