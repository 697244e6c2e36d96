"""What charts state and show: sentences worked out by hand, headings and hardness."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from benchmark.test_chart import DATA, line

from dofkit.benchmark.record import AUTO, Fit, Outcome, TrialLine
from dofkit.benchmark.sentences import sentences, summary
from dofkit.benchmark.trials import FAMILIES, GLOSSES, HEADINGS


def step(knob: str, value: float, group: str, outcomes: Sequence[Outcome]) -> list[TrialLine]:
    """Trials at one value of a knob."""
    method = {"scene tolerance": AUTO, "tolerance": "numeric", "bits": "balls"}.get(knob, "field")
    told = [line(f"t{i}", method, outcome, 0.001) for i, outcome in enumerate(outcomes)]
    return [replace(one, knob=knob, value=value, group=group) for one in told]


SWEEPS = [
    *step("scene tolerance", 1e-3, "3", ["right", "right", "undecided", "right"]),
    *step("scene tolerance", 1e-6, "3", ["wrong", "right", "wrong", "right"]),
    *step("tolerance", 1e-3, "3", ["wrong", "right", "wrong", "wrong"]),
    *step("tolerance", 1e-6, "3", ["right", "right", "wrong", "wrong"]),
    *step("bits", 16, "0.001", ["wrong", "right"]),
    *step("bits", 32, "0.001", ["right", "right"]),
    *step("bits", 16, "1e-06", ["wrong", "right"]),
    *step("bits", 32, "1e-06", ["wrong", "right"]),
    *step("bits", 64, "1e-06", ["right", "right"]),
]


def test_sentences_by_hand() -> None:
    texts = sentences(summary(replace(DATA, sweeps=SWEEPS)))
    assert texts["trials"].endswith("of the answers of `auto` none is wrong and 0 % are undecided.")
    assert texts["count"] == "`count` is wrong on 25 % and undecided on 50 %."
    assert texts["tolerance"] == (
        "With the tolerance equal to the rounding dofkit finds what was rounded in 75 % of the trials and is wrong in "
        "0 %; singular values with that tolerance find it in 25 %, and with the best one for all scenes in 50 %."
    )
    assert texts["bits"] == (
        "`balls` on its own is never wrong from 32 bits for a gap of 10^-3 and from 64 bits for a gap of 10^-6 on."
    )
    assert "cost" not in texts


def test_every_family_has_its_heading_and_says_what_it_is() -> None:
    assert set(HEADINGS) == set(FAMILIES) == set(GLOSSES)
    assert len(set(HEADINGS.values())) == 5
    assert all(GLOSSES.values())


def test_families_stand_under_their_headings_the_hardest_last() -> None:
    from dofkit.benchmark.figures import outcomes

    lines = [
        *(replace(line("a", "count", "right", 0.1), family=family) for family in ("trailers", "time", "scales")),
        *(replace(line("b", "count", "wrong", 0.1), family=family) for family in ("time", "time")),
        *(replace(line("b", "count", "wrong", 0.1), family=family) for family in ("trailers",)),
    ]
    cells = outcomes.together(score for score in summary(replace(DATA, lines=lines)).scores if score.family != "all")
    differential, equations = HEADINGS["time"], HEADINGS["scales"]
    assert outcomes.in_order(cells) == ["all", differential, "trailers", "time", equations, "scales"]
    assert (cells["all", "count"].trials, cells["all", "count"].wrong) == (6, 3)


def test_an_exponent_stands_where_a_power_law_fits() -> None:
    from dofkit.benchmark.figures import speed

    fit = Fit(question="dof", family="trailers", method=AUTO, exponent=2, error=0.1, factor=1, points=5)
    assert speed.holds(fit)
    assert not speed.holds(fit.model_copy(update={"error": 0.3}))
    assert not speed.holds(fit.model_copy(update={"points": 3}))
    assert not speed.holds(fit.model_copy(update={"exponent": -0.15, "error": 0.07}))
