"""Every answer that is sure names its argument, and each argument says what it needs and who checks it."""

from __future__ import annotations

import importlib
import logging
import re
from pathlib import Path
from typing import Any, get_args

import pytest
from pydantic import ValidationError
from shared.known_scenes import SCENES, few

import dofkit
from dofkit.base.verdicts import VERDICTS, ArgumentKey, Claim, together, weakest
from dofkit.classification.arguments import arguments
from dofkit.relations.answer import Answer
from dofkit.report import FieldVerdict

THEOREMS = (Path(dofkit.__file__).parent / "THEOREMS.md").read_text(encoding="utf-8")


def test_the_table_has_a_row_for_every_key() -> None:
    assert set(arguments()) == set(get_args(ArgumentKey))


@pytest.mark.parametrize("key", sorted(arguments()))
def test_a_row_names_its_theorem_and_what_checks_it(key: ArgumentKey) -> None:
    row = arguments()[key]
    module, name = row.checked_by.rsplit(".", 1)
    assert callable(getattr(importlib.import_module(module), name))
    assert not row.theorem or f"| `{row.theorem}` |" in THEOREMS
    assert row.claims
    assert row.hypotheses


@pytest.mark.parametrize(
    "given",
    [
        {"verdict": "proved"},
        {"verdict": "proved", "argument": "because"},
        {"verdict": "probable", "argument": "generic points"},
        {"verdict": "numeric", "argument": "singular values"},
        {"verdict": "probable", "bits": 30},
    ],
)
def test_what_is_sure_cannot_be_said_without_an_argument_and_a_bound(given: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"no argument|bound|gap"):
        Claim(**given)


@pytest.mark.parametrize(
    "given",
    [{"verdict": "proved"}, {"verdict": "proved", "argument": "because"}, {"verdict": "probable", "argument": "cases"}],
)
def test_nor_can_it_be_told(given: dict[str, str]) -> None:
    with pytest.raises(ValidationError):
        FieldVerdict.model_validate(given)


def test_an_answer_without_an_argument_is_open_and_logged(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.ERROR, "dofkit.defects"):
        assert Answer(dof=1, verdict="proved").claim.verdict == "undecided"
    assert "no argument" in caplog.text


def test_errors_add_up() -> None:
    one = Claim("probable", "generic points", bits=30)
    assert together(one, one, one, one).bound == "2^-28"
    assert together(one, Claim("numeric", "singular values", gap=1e4)).bound == "1.0e+04"


@pytest.mark.parametrize("path", few("verdicts", SCENES, 12), ids=lambda path: path.stem)
def test_every_field_of_a_report_says_how_sure_it_is(path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """The verdict of the whole is the weakest; chances are powers of 2; what speaks of the witness has one."""
    with caplog.at_level(logging.ERROR, "dofkit.defects"):
        report = dofkit.classify(path)
    assert not caplog.records
    told = [*report.verdicts.values(), *(v for e in report.constraints for v in e.verdicts.values())]
    assert report.verdict == weakest(*(v.verdict for v in told), *(e.verdict for e in report.constraints))
    assert all(re.fullmatch(r"2\^-\d+", v.bound or "") for v in told if v.verdict == "probable")
    assert all(v.verdict in VERDICTS for v in told)
    for name in ("consistent", "dof", "velocity_dof", "holonomic", "scleronomic", "growth_vector"):
        value = getattr(report, name)
        assert value is None or name in report.verdicts
    about = report.verdicts["dof"].about if "dof" in report.verdicts else None
    assert (report.instantaneous_dof is not None) or about != "reference"


def test_the_argument_that_is_reported_is_the_one_that_decided() -> None:
    """Two circles that touch: no rank says that they meet in a point only, their difference does."""
    scene = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1", "(x - 3)^2 + y^2 = 4"]}
    report = dofkit.classify(scene)
    assert (report.dof, report.verdicts["dof"].argument) == (0, "cases")


@pytest.mark.parametrize(
    ("constraints", "dof"),
    [
        (["x^2 + y^2 + z^2 = 1", "z = 1/2"], 1),  # a circle
        (["xdot = y", "y = 2", "z = 0"], 0),  # x = 2 t + C
    ],
)
def test_everyday_answers_are_proved(constraints: list[str], dof: int) -> None:
    report = dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": constraints})
    assert (report.dof, report.verdict) == (dof, "proved")
