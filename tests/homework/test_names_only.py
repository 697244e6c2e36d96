"""Answers read by the names of a scene alone, as students' tests do, and by all of it: the same can be read."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from dofkit.base.documents import read_document
from dofkit.homework.answers.submission import of_value
from dofkit.homework.assignment import load_assignment
from dofkit.homework.echo import echo
from dofkit.homework.export.names_only import names_only
from dofkit.homework.readings import reading_of

FOLDER = Path(__file__).parent / "natural"


@pytest.mark.sweep
@pytest.mark.parametrize("name", sorted(path.stem for path in FOLDER.glob("*.yaml")))
def test_natural_answers_read_as_they_do_with_the_key(name: str, tmp_path: Path) -> None:
    document: Any = read_document((FOLDER / f"{name}.yaml").read_bytes(), name).value
    prepared = load_assignment(document.pop("assignment"))
    names = tmp_path / "names.json"
    names.write_text(json.dumps(names_only(prepared)))
    count = 0
    for part in document.values():
        for place, by_verdict in part.items():
            problem, question = place.split(".")
            for answer in [one for answers in by_verdict.values() for one in answers]:
                known = echo(prepared, of_value({"answers": {problem: {question: answer}}}, "s"))
                (whole,) = [i for i in known.items if (i.problem, i.question) == (problem, question)]
                found = reading_of(names, problem, question, answer)
                opened = "A person will review this answer" in found.told
                assert found.readable is (whole.status == "read") or opened, (place, answer, found.told)
                count += not opened
    assert count >= 60
