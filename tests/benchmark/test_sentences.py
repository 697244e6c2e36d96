"""What charts state and show: sentences worked out by hand, headings and hardness."""

from __future__ import annotations

from dataclasses import replace

from benchmark.test_chart import DATA, line

from dofkit.benchmark.record import AUTO, Fit
from dofkit.benchmark.sentences import sentences, summary
from dofkit.benchmark.trials import FAMILIES, GLOSSES, HEADINGS


def test_the_sentence_of_the_trials_by_hand() -> None:
    assert sentences(summary(DATA))[0].endswith("of the answers of `auto` none is wrong and 0 % are undecided.")


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
    assert outcomes.row_labels(cells) == ["all", differential, "trailers", "time", equations, "scales"]
    assert (cells["all", "count"].trials, cells["all", "count"].wrong) == (6, 3)


def test_an_exponent_stands_where_a_power_law_fits() -> None:
    from dofkit.benchmark.figures import speed

    fit = Fit(question="dof", family="trailers", method=AUTO, exponent=2, error=0.1, factor=1, points=5)
    assert speed.holds(fit)
    assert not speed.holds(fit._replace(error=0.3))
    assert not speed.holds(fit._replace(points=3))
    assert not speed.holds(fit._replace(exponent=-0.15, error=0.07))
