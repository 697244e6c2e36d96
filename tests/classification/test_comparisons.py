"""How an answer compares with what was asked for, and leaves of forms, on systems that are decided by hand."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.base.documents import read_document
from dofkit.classification.dependence.equivalence import compare, leaves
from dofkit.scene.lowering import lower

TABLES = read_document((Path(__file__).parent / "comparisons.yaml").read_bytes(), "comparisons").value


def told(kind: str, beside: Sequence[str], asked: Sequence[str], answer: Sequence[str]) -> list[Any]:
    coordinates = ["x", "y", "z", "theta", *(["b", "c"] if kind == "leaves" else [])]
    scene = {"coordinates": coordinates, "parameters": ["C", "D"], "constraints": [*beside, *asked, *answer]}
    first, last = len(beside), len(beside) + len(asked)
    numbers = lower(dofkit.load(scene)), range(first, last), range(last, last + len(answer))
    if kind == "leaves":
        return [leaves(*numbers, frozenset("bc")).value]
    compared = compare(*numbers, frozenset("CD"))
    return [compared.sameness.value, *compared.met]


@pytest.mark.parametrize(("kind", "row"), [(kind, row) for kind, rows in TABLES.items() for row in rows], ids=str)
def test_an_answer_compares_as_by_hand(kind: str, row: Sequence[Any]) -> None:
    assert told(kind, *row[:3])[: len(row) - 3] == row[3:]
