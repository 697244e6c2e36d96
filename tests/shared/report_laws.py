"""What every report says of itself, and how certain the fields of a report are."""

from __future__ import annotations

from pathlib import Path

import yaml

from dofkit.base.verdicts import weakest
from dofkit.report import Report

#: The fields of known reports that are not proved, or not of all configurations, by how certain they are.
CERTAINTY = yaml.safe_load((Path(__file__).parents[1] / "whole/certainty.yaml").read_text(encoding="utf-8"))
SURE = ("proved", False)


def certainty_of(report: Report) -> dict[str, list[str]]:
    """Return the fields that are not proved, or of one component only, by how certain they are."""
    claims = report.verdicts | {f"{e.name}.{key}": c for e in report.constraints for key, c in e.verdicts.items()}
    weaker = {key: f"{c.verdict} {c.about}" for key, c in claims.items() if (c.verdict, c.about == "component") != SURE}
    return {v: sorted(key for key in weaker if weaker[key] == v) for v in weaker.values()}


def agrees_with_itself(report: Report) -> None:
    numbers_of_a_report_agree(report)
    singular_is_where_first_order_freedom_differs(report)
    independent_equations_add_up(report)
    the_whole_is_what_its_constraints_are(report)
    every_entry_is_of_one_piece(report)


def surplus(report: Report) -> int:
    """Bilateral equations less what they take away; negative where one equation says several things."""
    assert report.velocity_dof is not None
    return sum(e.equations for e in report.constraints if e.bilateral) - report.count.coordinates + report.velocity_dof


def is_finite(report: Report) -> bool:
    return all(entry.form in ("finite", "inequality") for entry in report.constraints)


def numbers_of_a_report_agree(report: Report) -> None:
    n = report.count.coordinates
    if report.consistent is False:
        assert (report.dof, report.velocity_dof) == (None, None)
        assert report.conflicting
        return
    assert report.dof is not None
    assert report.velocity_dof is not None
    assert 0 <= report.velocity_dof <= report.dof <= n
    assert report.count.independent == n - report.dof
    assert report.count.naive_dof == n - report.count.constraints
    assert report.redundant_equations == max(0, surplus(report))
    assert not is_finite(report) or report.dof == report.velocity_dof
    assert report.generalized_coordinates is not None
    assert len(set(report.generalized_coordinates)) == report.dof
    assert report.conflicting == []


def singular_is_where_first_order_freedom_differs(report: Report) -> None:
    first, here = report.instantaneous_dof, report.velocity_dof
    assert report.singular is (None if first is None else first != here)
    here = here if first is None else first
    if here is not None and report.generic is not None and report.generic.dof is not None:
        why = report.generic.differs or ""
        assert (why == "") is (here == report.generic.dof)
        assert here < report.generic.dof or not why or f" {here - report.generic.dof} more equation" in why


def independent_equations_add_up(report: Report) -> None:
    """Where the configuration space is regular and no equation is a sum of squares, each takes one freedom or none."""
    nullity = sum(group.nullity for group in report.redundancies)
    if report.consistent and not report.singular and surplus(report) >= nullity and is_regular(report):
        independent = [entry.independent for entry in report.constraints if entry.bilateral]
        assert report.velocity_dof is not None
        assert sum(n or 0 for n in independent) == report.count.coordinates - report.velocity_dof


def is_regular(report: Report) -> bool:
    return not any("singular" in line or "tangent" in line for line in report.warnings)


def the_whole_is_what_its_constraints_are(report: Report) -> None:
    entries = report.constraints
    assert report.holonomic is all(entry.holonomic for entry in entries)
    still = [entry.scleronomic for entry in entries]
    assert report.scleronomic is (False if False in still else None if None in still else True)
    fields = [v.verdict for v in report.verdicts.values()]
    assert report.verdict == weakest(*fields, *(entry.verdict for entry in entries))
    implied = {entry.name for entry in entries if entry.circuit is not None}
    assert not report.consistent or implied <= {e.name for e in entries if not e.independent} & {
        *(report.redundant or ())
    }
    assert {name for group in report.redundancies for name in group.members} >= set(report.redundant or ())
    unsettled = bool(report.conflicting) and report.verdicts["conflicting"].verdict == "undecided"
    assert unsettled is any("named as conflicting is needed" in line for line in report.warnings)
    places = {entry.name: k for k, entry in enumerate(entries)}
    assert all(places[other] < places[entry.name] for entry in entries for other in entry.circuit or ())


def every_entry_is_of_one_piece(report: Report) -> None:
    for entry in report.constraints:
        assert entry.reason
        assert entry.bilateral is (entry.form != "inequality")
        assert entry.form != "finite" or (entry.holonomic and entry.holonomic_alone)
        assert entry.form != "inequality" or entry.holonomic is False
        assert (entry.catastatic is None) is (entry.form not in ("pfaffian", "nonlinear"))
        assert entry.holonomic or not entry.holonomic_alone
        assert not entry.exact or (entry.holonomic_alone and entry.integrating_factor is None)
        assert entry.integral is None or entry.holonomic
        assert entry.independent is None or 0 <= entry.independent <= entry.equations
