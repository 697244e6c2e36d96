"""A whole course: four sheets with variants, review, grading again, every platform; ``course.py`` runs it for fifty."""

from __future__ import annotations

from pathlib import Path

import course
import pytest

STUDENTS = 8


@pytest.mark.sweep
@pytest.mark.timeout(1500)
def test_a_course_runs_from_the_sheets_to_the_gradebooks(tmp_path: Path) -> None:
    counted = dict(course.run(tmp_path, STUDENTS))
    assert list(counted) == list(course.SHEETS)
    for told in counted.values():
        assert told["students"] == STUDENTS
        assert told["decided"] > 0
        assert told["open after"] < told["open before"] + told["decided"]
        assert told["right"] > 0.5 * told["answers"]
    if course.CHROMIUM is None:
        pytest.skip("there is no Chromium to look at the pages with")
    assert course.too_wide(course.pages_of(tmp_path), tmp_path) == []
