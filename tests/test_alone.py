"""Each method by itself on small cases worked out by hand: where it is right, where it is wrong, what it cannot."""

from __future__ import annotations

from pathlib import Path
from typing import Any, get_args

import pytest

import dofkit
import dofkit.alone
from dofkit.alone import answered, answering
from dofkit.methods import METHODS, QUESTIONS, MethodName, Question

HOME = Path(dofkit.alone.__file__).parent
SHARED = frozenset({"__init__", "told", "written", "pointwise", "reporting"})


def scene(*constraints: Any, coordinates: tuple[str, ...] = ("x", "y", "z"), **more: Any) -> dict[str, Any]:
    return {"coordinates": list(coordinates), "constraints": list(constraints), **more}


def test_every_row_has_a_module_and_every_module_a_row() -> None:
    assert {p.stem for p in HOME.glob("*.py")} - SHARED == set(METHODS) == set(get_args(MethodName))
    assert set(QUESTIONS) == set(get_args(Question))


@pytest.mark.parametrize("method", METHODS)
def test_a_method_answers_what_its_row_says(method: MethodName) -> None:
    for question in QUESTIONS:
        work = answering(method, question)
        assert (work is not None) == (question in METHODS[method].uses)
        assert work is None or work.__module__ == f"dofkit.alone.{method}"
    told = answered(scene("x = 0"), "equivalence", method, answer={"constraint": "c1", "text": "x = 0"})
    assert told.cannot == ("equivalence" not in METHODS[method].uses)
    assert told.value is True or told.cannot
