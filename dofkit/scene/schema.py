"""The JSON Schema of a scene, for editors: that of Pydantic, with the synonyms of types and keys added."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import TypeAdapter

from dofkit.scene.constraints import TYPES
from dofkit.scene.picture import PictureShape, shape_kinds
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import other_keys, synonyms

DIALECT = "https://json-schema.org/draft/2020-12/schema"
_TEXT: dict[str, Any] = TypeAdapter(str).json_schema()
_AXIS = {**_TEXT, "pattern": "^[-+]?[xyz]$"}


def identified(schema: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Return ``schema`` with the dialect of JSON Schema, and with an identifier for ``name``."""
    return {"$schema": DIALECT, "$id": f"urn:dofkit:schema:{name}", **schema}


def scene_schema() -> dict[str, Any]:
    """Return the JSON Schema of a scene's file, with synonyms."""
    schema = Scene.model_json_schema()
    definitions = schema["$defs"]
    for cls in TYPES.values():
        definitions[cls.__name__] = _with_other_words(definitions[cls.__name__], cls.kind())
    axes = definitions["Universal"]["properties"]["axes"]["anyOf"][0]
    axes["prefixItems"] = [{"anyOf": [vector, _AXIS]} for vector in axes["prefixItems"]]
    definitions["Force"]["properties"]["direction"] = _with_letters(definitions["Force"]["properties"]["direction"])
    definitions[PictureShape.__name__] = _any_shape(definitions[PictureShape.__name__])
    constraints = schema["properties"]["constraints"]
    schema["properties"]["joints"] = {**constraints, "description": "another section of constraints"}
    return identified(schema, "scene")


def _any_shape(schema: Mapping[str, Any]) -> dict[str, Any]:
    """Return the schema of a shape: a mapping with one kind of shape as a key, which determines the other keys."""
    properties = {key: part for key, part in schema["properties"].items() if key not in ("shape", "name")}
    properties["axis"] = _with_letters(properties["axis"])
    by_shape: list[dict[str, Any]] = []
    for kind, row in shape_kinds().items():
        properties[kind] = {"type": [_TEXT["type"], "number", "null"], "description": row.meaning}
        by_shape += [
            {"if": {"required": [kind]}, "then": {"propertyNames": {"enum": [kind, *row.needs, *row.may, "show"]}}},
            {"if": {"required": [kind], "not": {"required": ["show"]}}, "then": {"required": list(row.needs)}},
        ]
    no_shape = {"if": {"propertyNames": {"not": {"enum": list(shape_kinds())}}}, "then": False}
    return {**schema, "properties": properties, "required": [], "allOf": [no_shape, *by_shape]}


def _with_other_words(schema: dict[str, Any], kind: str) -> dict[str, Any]:
    """Return the schema of the constraint type ``kind`` with the synonyms of the type and of its keys."""
    properties = dict(schema["properties"])
    words = [kind, *(word for word, meant in synonyms().items() if meant == kind)]
    properties["type"] = {key: part for key, part in properties["type"].items() if key != "const"} | {"enum": words}
    if "axis" in properties:
        properties["axis"] = _with_letters(properties["axis"])
    extended = {**schema, "properties": properties}
    moved = dict(_moved(schema, other_keys(kind)))
    if moved:
        extended["required"] = [key for key in schema.get("required", ()) if key not in moved.values()]
        extended["allOf"] = [
            {"if": {"not": {"required": [other]}}, "then": {"required": [key]}} for other, key in moved.items()
        ]
    for other, key in other_keys(kind).items():
        if key in properties:
            properties.setdefault(other, {**properties[key], "description": f"synonym of `{key}`"})
    return extended


def _moved(schema: Mapping[str, Any], others: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield (synonym, key) for the synonyms of required keys."""
    for other, key in others.items():
        if key in schema.get("required", ()):
            yield other, key


def _with_letters(vector: Mapping[str, Any]) -> dict[str, Any]:
    """Return the schema of a direction that may also be a letter with a sign, such as ``-z``."""
    return {**vector, "anyOf": [*vector["anyOf"], _AXIS]}
