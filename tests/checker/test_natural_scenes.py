"""Scenes as people write them, in many notations: nearly all that is proved of them has evidence that is accepted."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml
from checker.test_second_checker import needs_node, second
from shared.known_scenes import spread, verdicts_of
from shared.report_laws import agrees_with_itself

import dofkit
from dofkit.checker import verify

LINES = Path(__file__).with_name("natural_scenes.yaml").read_text(encoding="utf-8").splitlines()
SCENES = [line for line in LINES if line.startswith("- ")]
#: The least share of what is proved that is checked.
LEAST = 0.99


def checked(line: str) -> list[bool]:
    """Whether each proved field of a scene is checked; the certificate verifies, alone and with its scene.

    The checker contradicts nothing, and the fields of the report fit together.
    """
    (written,) = yaml.safe_load(line)
    report = dofkit.classify(written, certificate=True)
    assert not any("a second program" in warning for warning in report.warnings)
    if report.verdict != "undecided":
        agrees_with_itself(report)
    certificate = json.loads(json.dumps(report.certificate))
    for verification in (verify(None, certificate), dofkit.verify(written, certificate)):
        assert verification.claims == verification.verified > 0
        assert verification.trusted == certificate["scene"].get("readings", {})
    return [bool(told.checked) for _, _, told in verdicts_of(report) if told.verdict == "proved"]


@pytest.mark.parametrize("line", spread(SCENES, 3), ids=lambda line: f"line-{LINES.index(line) + 1}")
def test_a_scene_as_people_write_it_has_evidence(line: str) -> None:
    assert sum(checked(line)) > 0


@pytest.mark.sweep
def test_nearly_all_that_is_proved_is_checked() -> None:
    fields = [one for line in SCENES for one in checked(line)]
    assert sum(fields) >= LEAST * len(fields)


@needs_node
def test_the_second_checker_refuses_none_of_it() -> None:
    reports = [dofkit.classify(yaml.safe_load(line)[0], certificate=True) for line in SCENES[::7]]
    certificates = [json.loads(json.dumps(report.certificate)) for report in reports]
    verdicts = second([(certificate["scene"]["document"], certificate) for certificate in certificates])
    assert "refused" not in {verdict for of_scene in verdicts for verdict in of_scene}


READINGS = [
    (r"\frac{x^2}{4} = 1 - y", "x^2/4 = 1 - y"),
    ("0 ≤ |x| ≤ 3", "0 <= abs(x) <= 3"),
    (r"dx = \sin y dy", "dx = sin(y)*dy"),
    ("x = y cos(60°) + ½", "x = y/2 + 1/2"),
    ("x = √2 y", "x = sqrt(2)*y"),
]


@pytest.mark.parametrize(("written", "plain"), READINGS)
def test_what_stands_for_a_text_is_reported(written: str, plain: str) -> None:
    scene = {"coordinates": ["x", "y"], "constraints": [written]}
    certificate = dofkit.classify(scene, certificate=True).certificate
    assert certificate is not None
    assert certificate["scene"]["readings"] == {written: plain}
    assert dofkit.verify(scene, certificate).trusted == {written: plain}


def test_a_text_that_has_fewer_values_than_its_simpler_form_is_not_rewritten() -> None:
    """x y / y is x but for y = 0, where it has no value: no text without the quotient may stand for it."""
    written = {"coordinates": ["x", "y"], "constraints": [r"y = \frac{x y}{y}"]}
    certificate = dofkit.classify(written, certificate=True).certificate
    assert certificate is not None
    assert "readings" not in certificate["scene"]
    assert not certificate["claims"]
