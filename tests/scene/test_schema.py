"""The JSON Schema of a scene: it takes every scene, in any words, and refuses what is none."""

from __future__ import annotations

from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from shared.known_scenes import EVERY, stem

from dofkit.base.documents import read_document
from dofkit.homework.schemas import SCHEMAS
from dofkit.scene.schema import scene_schema

ROOT = Path(__file__).parents[2]
VALIDATOR = Draft202012Validator(scene_schema())


def plain(value: Any) -> Any:
    """A document as JSON has it."""
    if isinstance(value, dict):
        return {key: plain(part) for key, part in value.items()}
    if isinstance(value, list):
        return [plain(part) for part in value]
    return float(value) if isinstance(value, Decimal) else value


def complaints(text: str) -> list[str]:
    found = VALIDATOR.iter_errors(plain(read_document(text, "x").value))
    return [f"{error.json_path}: {error.message}" for error in found]


def test_the_schemas_are_schemas_and_say_which() -> None:
    Draft202012Validator.check_schema(scene_schema())
    for name, schema in {"scene": scene_schema, **SCHEMAS}.items():
        assert schema()["$id"] == f"urn:dofkit:schema:{name}"
        assert schema()["$schema"].endswith("2020-12/schema")


@pytest.mark.parametrize("path", EVERY, ids=stem)
def test_every_scene_is_valid(path: Path) -> None:
    assert complaints(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "line",
    [
        "{type: hinge, between: [ground, a], at: [0, 0, 0], axis: -z}",
        "{type: slider, between: [ground, a], direction: x}",
        "{type: universal, between: [ground, a], at: [0, 0, 0], axes: [x, -z]}",
        "{type: string, between: [A, [0, 0, 0], B]}",
        "{type: rod, between: [A, {on: a, at: [0, 0, 0]}], distance: 2}",
        '{name: spin, text: "x = 1"}',
        "x = 1",
    ],
)
def test_other_words_are_valid(line: str) -> None:
    for section in ("constraints", "joints"):
        assert complaints(f"bodies: [a]\n{section}:\n- {line}\n") == []


@pytest.mark.parametrize(
    "line",
    [
        "{type: link, between: [A]}",
        "{type: roll, body: a}",
        "{type: string, length: 2}",
        "{between: [A, B]}",
        "{type: revolute, between: [a, b], axis: 5}",
        "{type: revolute, between: [a, b], att: 5}",
        "{type: pivot}",
        "5",
    ],
)
def test_what_is_no_constraint_is_not_valid(line: str) -> None:
    (found,) = complaints(f"constraints:\n- {line}\n")
    assert found.startswith("$.constraints[0]:")
