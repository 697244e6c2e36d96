"""What the site shows of speed and accuracy is the output of its command, and holds what is said of it."""

from __future__ import annotations

import re
from functools import cache
from math import log2
from pathlib import Path

from dofkit.benchmark import record
from dofkit.benchmark.figures import FIGURES
from dofkit.benchmark.record import AUTO, Data
from dofkit.benchmark.sentences import caption, sentences
from dofkit.benchmark.statistics import against, scores
from dofkit.benchmark.tasks import SWEEPS
from dofkit.benchmark.trials import FAMILIES
from dofkit.methods.table import METHODS

ROOT = Path(__file__).parents[2]
CHARTS = ROOT / "tests" / "charts"
#: The page on which charts are shown and told of.
PAGE = (ROOT / "dofkit/site/pages/about/methods.md").read_text(encoding="utf-8")
LEAST = 2000
TWICE = 2


@cache
def data() -> Data:
    return record.read(CHARTS)


def test_of_more_than_two_thousand_trials_auto_answers_none_wrong() -> None:
    mine = [line for line in data().lines if line.method == AUTO]
    assert len(mine) >= LEAST
    assert not [line for line in mine if line.outcome == "wrong"]
    assert sum(line.outcome == "right" for line in mine) >= 0.97 * len(mine)


def test_every_method_met_every_trial_and_every_failure_is_explained() -> None:
    lines = data().lines
    trials = {(line.question, line.family, line.trial) for line in lines}
    assert {line.method for line in lines} == set(METHODS)
    assert len(lines) == len(trials) * len(METHODS)
    assert {family for _, family, _ in trials} == set(FAMILIES)
    assert all(len(line.why.split()) > 2 and line.why.endswith(".") for line in lines if line.outcome != "right")


def test_auto_is_on_the_front_and_hardly_slower_than_what_is_sound() -> None:
    """No method that is never wrong is right noticeably more often; and mostly at most twice as slow as the fastest."""
    lines = data().lines
    for question in {line.question for line in lines}:
        here = [line for line in lines if line.question == question]
        right = {m: sum(line.outcome == "right" for line in here if line.method == m) for m in METHODS}
        wrong = {m for m in METHODS if any(line.outcome == "wrong" for line in here if line.method == m)}
        assert all(right[AUTO] >= 0.99 * right[m] for m in METHODS if m not in wrong)
    sound = [row for row in against(lines) if row.sound_ratio is not None]
    assert sum(row.sound_ratio is not None and row.sound_ratio <= TWICE for row in sound) >= 0.9 * len(sound)


def test_no_tolerance_is_safe_and_enough_bits_are() -> None:
    """As the page says: a gap of 10^-d needs d log2(10) bits."""
    for sweep in SWEEPS:
        rows = sweep.by_digits([line for line in data().sweeps if line.method == sweep.method], lambda line: line.trial)
        wrong = {
            (digits, value): scores(line for line in lines if line.value == value)[sweep.method].share("wrong")
            for digits, lines in rows.items()
            for value in sweep.values
        }
        if sweep.setting == "tolerance":
            assert min(wrong.values()) > 1 / 3
        else:
            assert not any(share for (digits, bits), share in wrong.items() if bits > 1.5 * digits * log2(10))
            assert all(share for (digits, bits), share in wrong.items() if bits < digits * log2(10))


def test_every_sentence_about_a_chart_is_worked_out_from_its_data() -> None:
    told = " ".join(PAGE.split())
    assert [sentence for sentence in sentences(data()) if sentence not in told] == []


def test_the_figures_of_the_site_are_there_and_made_by_its_command() -> None:
    shown = re.findall(r"\]\(../charts/([^)]+)\)", PAGE)
    assert shown
    assert all((CHARTS / path).is_file() for path in shown)
    assert data().ran.complete
    assert data().ran.command == "dofkit chart"
    assert "`dofkit chart --out tests/charts`" in PAGE
    assert all(caption(name, data()).endswith("Made by: dofkit chart") for name in FIGURES)
