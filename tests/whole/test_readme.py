"""The README is short, and the continuous integration runs its two commands; `tests/site/` runs all that it shows."""

from __future__ import annotations

import re
from pathlib import Path

from shared.documented import INSTALLS, README, ROOT, SITE, blocks_of, written_to

import dofkit

TEXT = README.read_text(encoding="utf-8")
#: Lines that a newcomer reads.
LONGEST = 120


def test_the_two_commands_are_one_line_each_and_are_what_is_run() -> None:
    ci = (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
    lines = [block.text.strip() for block in blocks_of(README) if block.text.startswith(INSTALLS)]
    assert len(lines) == 2
    assert all("\n" not in line and line in ci for line in lines)


def test_it_is_short_and_shows_a_motion_and_the_bench() -> None:
    assert len(TEXT.splitlines()) <= LONGEST
    motion, bench = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", TEXT)
    assert (ROOT / motion).stat().st_size < 60_000
    assert (ROOT / bench).stat().st_size < 120_000


def test_it_leads_to_every_written_page() -> None:
    pages = {str(path.relative_to(ROOT)) for path in SITE.rglob("*.md")}
    assert pages <= set(re.findall(r"\]\(([^)]+\.md)\)", TEXT))


def test_the_homework_is_graded_as_it_says(tmp_path: Path) -> None:
    folder = written_to(tmp_path)
    result = dofkit.grade(folder / "sheet.yaml", folder / "ada.yaml")
    assert (result.score, result.max_score) == (7, 9)
    told = (SITE / "guide" / "homework.md").read_text(encoding="utf-8")
    assert "Ada gets 7 of 9: 2 is the number of independent generalized velocities of the disc" in told
    assert result.items[0].codes[0] == "OTHER_CONVENTION"
