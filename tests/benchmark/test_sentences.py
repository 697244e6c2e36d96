"""What charts state and show: sentences worked out by hand, headings and hardness."""

from __future__ import annotations

from dataclasses import replace

from benchmark.test_chart import DATA, line

from dofkit.benchmark.figures import ALL, row_labels
from dofkit.benchmark.sentences import sentences
from dofkit.benchmark.trials import FAMILIES, GLOSSES, HEADINGS


def test_the_sentence_of_the_trials_by_hand() -> None:
    assert sentences(DATA)[0].endswith("of the answers of `auto` none is wrong and 0 % are undecided.")


def test_every_family_has_its_heading_and_says_what_it_is() -> None:
    assert set(HEADINGS) == set(FAMILIES) == set(GLOSSES)
    assert len(set(HEADINGS.values())) == 5
    assert all(GLOSSES.values())


def test_families_stand_under_their_headings_the_hardest_last() -> None:
    lines = [
        *(replace(line("a", "count", "right", 0.1), family=family) for family in ("trailers", "time", "scales")),
        *(replace(line("b", "count", "wrong", 0.1), family=family) for family in ("time", "time")),
        *(replace(line("b", "count", "wrong", 0.1), family=family) for family in ("trailers",)),
    ]
    differential, equations = HEADINGS["time"], HEADINGS["scales"]
    assert row_labels(lines) == [ALL, differential, "trailers", "time", equations, "scales"]
