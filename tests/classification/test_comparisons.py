"""How an answer compares with what was asked for, and leaves of forms, on systems that are decided by hand."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.base.documents import read_document
from dofkit.classification.equivalence import compare, leaves
from dofkit.scene.lowering import lower

TABLES = read_document((Path(__file__).parent / "comparisons.yaml").read_bytes(), "comparisons").value


@pytest.mark.parametrize(("kind", "row"), [(kind, row) for kind, rows in TABLES.items() for row in rows], ids=str)
def test_an_answer_compares_as_by_hand(kind: str, row: Sequence[Any]) -> None:
    beside, asked, answer, *expected = row
    scene = {"coordinates": [*"xyzbc", "theta"], "parameters": [*"CD"], "constraints": [*beside, *asked, *answer]}
    first, last = len(beside), len(beside) + len(asked)
    numbers = lower(dofkit.load(scene)), range(first, last), range(last, last + len(answer))
    compared = compare(*numbers, frozenset("CD")) if kind == "compared" else None
    marks = [compared.sameness, *compared.met] if compared else [leaves(*numbers, frozenset("bc"))]
    assert [marks[0].value, *marks[1:]][: len(expected)] == expected
