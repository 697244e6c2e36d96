"""The table of speed on the site: it and its sentences follow from the data of one run."""

from __future__ import annotations

import sys

import pytest
from shared.speed_table import DATA, PAGE, Goal, Measured, Ran, SpeedRow, SpeedRun, shown, with_table

RAN = Ran("python bench.py", "2026-01-02", "a machine", 2, "3.11", 4.2)
ROWS = (
    SpeedRow("a", "a tree", "", Goal("seconds", 0.3), Measured(0.25)),
    SpeedRow("b", "forms", "SymPy", Goal("times", 50), Measured(0.02, 0.5)),
    SpeedRow("c", "a start", "`import sympy`", Goal("share", 1.0), Measured(0.9, 1.0)),
    SpeedRow("d", "shuffles", "", Goal("fold", 2), Measured(0.1, fold=3.0)),
    SpeedRow("e", "links", "PyRigi", Goal("times", 100), Measured(0.02)),
    SpeedRow("f", "a dog", "", Goal("seconds", 1), None, "not installed"),
    SpeedRow("g", "a trap", "", Goal("seconds", 1), Measured(0.1, right=False)),
)


def test_what_is_reached_is_worked_out_from_what_was_measured() -> None:
    assert [row.figure for row in ROWS] == [0.25, 25.0, 0.9, 3.0, None, None, 0.1]
    assert [row.met for row in ROWS] == [True, False, True, False, None, None, False]


def test_the_table_by_hand() -> None:
    lines = shown(SpeedRun(RAN, ROWS)).splitlines()
    assert lines[0] == "| work | dofkit | rival in the same run | ratio | goal | reached |"
    assert lines[2:9] == [
        "| a tree | 0.25 s | - | - | 0.3 s | yes |",
        "| forms | 20 ms | SymPy: 0.5 s | 25 x | 50 x | no |",
        "| a start | 0.9 s | `import sympy`: 1 s | 0.9 x | at most 1 x | yes |",
        "| shuffles | 0.1 s | - | 3-fold | at most 2-fold | no |",
        "| links | 20 ms | PyRigi: not finished | - x | 100 x | - |",
        "| a dog | - | - | - | 1 s | not installed |",
        "| a trap | 0.1 s | - | - | 1 s | no: a wrong answer |",
    ]
    assert "2 of 5 rows reach their goal; not yet: forms; shuffles; a trap; not measured: links; a dog." in lines[-1]
    assert lines[-1].endswith("In the same run 1 answers were not the right one.*")


def test_the_page_shows_the_run_that_is_kept() -> None:
    run = SpeedRun.read(DATA)
    page = PAGE.read_text(encoding="utf-8")
    assert with_table(page, run) == page


@pytest.mark.sweep
def test_the_run_that_is_kept_has_every_row() -> None:
    sys.path.insert(0, str(DATA.parents[1]))
    import bench_speed

    run = SpeedRun.read(DATA)
    assert [(row.key, row.work, row.goal) for row in run.rows] == [
        (key, row.work, row.goal) for key, row in bench_speed.ROWS.items()
    ]
    assert all(row.measured is None or row.measured.right for row in run.rows)
