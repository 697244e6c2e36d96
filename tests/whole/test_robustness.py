"""Robustness: no text makes a command fail, and asking for evidence takes no answer away."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from shared.equation_texts import scenes
from shared.known_scenes import VARIED, few, report_of, scene_of, stem, verdicts_of

import dofkit
from dofkit.methods.certificates.lowering import with_certificate
from dofkit.methods.classify import classified

#: Seconds for one scene of any texts.
SECONDS = 2.0


def scene(*texts: str) -> dict[str, Any]:
    return {
        "coordinates": ["s", "x", "y"],
        "parameters": {"a": "positive", "m": "real"},
        "functions": {"g": ["s"], "h": ["s", "t"]},
        "constraints": [*texts],
    }


@settings(max_examples=20)
@example(scene("sin(s)/s = 1"))
@example(scene("abs(g(s)) = g(s)"))
@example(scene("(1 - m)/g'(s) <= 0"))
@example(scene("sec(pi) = sec(x)"))
@example(scene("sqrt(asin(pi)) = atan2(0, t)"))
@example(scene("y*ydot = 2 (0^y)^3"))
@example(scene("h(sdot, y + 0.6) = y + 0.6", "0.9 ds = 0"))
@example(scene("s = g(s)", "sdot^(s - 1) = s"))
@example({**scene("t = a"), "configuration": {"s": "pi/2", "x": "1", "y": "pi/2"}})
@given(scenes())
def test_no_text_makes_classify_fail(document: dict[str, Any]) -> None:
    is_answered_or_refused(document)


@pytest.mark.sweep
@settings(max_examples=400)
@given(scenes())
def test_no_text_of_many_makes_classify_fail(document: dict[str, Any]) -> None:
    is_answered_or_refused(document)


def is_answered_or_refused(document: dict[str, Any]) -> None:
    """Check that a scene is answered, or refused with its faults."""
    try:
        given = dofkit.load(document)
        report = classified(given, SECONDS)
    except dofkit.SceneError:
        return
    assert len(report.constraints) == len(document["constraints"])


@pytest.mark.parametrize("path", few("evidence", VARIED, 48), ids=stem)
def test_asking_for_evidence_takes_no_answer_away(path: Path) -> None:
    """A claim may become weaker only where the checker contradicts it, which happens in none of these scenes."""
    report = report_of(path)
    asked = with_certificate(scene_of(path), report)
    kept = (
        (place, value, verdict.model_copy(update={"checked": None})) for place, value, verdict in verdicts_of(asked)
    )
    assert [*kept] == [*verdicts_of(report)]
    assert asked.warnings == report.warnings


def test_evidence_counts_geometric_equations_before_their_rates() -> None:
    """A tackle, its lengths written after its speeds: 2 xdot + ydot = 0 follows from 2 x + y = L."""
    report = dofkit.classify(
        {
            "coordinates": ["x", "y"],
            "parameters": {"L": "positive"},
            "constraints": ["2 xdot + ydot = 0", "2 x + y = L"],
        },
        certificate=True,
    )
    assert report.redundant == ["c1"]
    assert [entry.independent for entry in report.constraints] == [0, 1]
    assert {report.verdicts[field].verdict for field in ("redundant", "redundancies")} == {"proved"}
    assert {entry.verdicts["independent"].verdict for entry in report.constraints} == {"proved"}
    assert report.warnings == []
    assert report.certificate is not None
    assert not any(path.endswith("independent") for path in report.certificate["uncovered"])
