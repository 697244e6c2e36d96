"""The JSON Schema of a scene, for editors: values are recognized by their type, so that a fault is one line.

Pydantic's ``anyOf`` answers "is not valid under any of the given schemas". Here the kinds of JSON values that are taken
are a list under ``type``, and the branch of each follows by ``if`` and ``then``; a constraint's by its own ``type``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import TypeAdapter

from dofkit.scene.constraints import TYPES
from dofkit.scene.constraints.base import Equation
from dofkit.scene.picture import SHAPES, PictureShape
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import other_keys, synonyms

DIALECT = "https://json-schema.org/draft/2020-12/schema"
_TEXT: dict[str, Any] = TypeAdapter(str).json_schema()
_AXIS = {**_TEXT, "pattern": "^[-+]?[xyz]$"}
_CONSTRAINT = "Constraint"


def identified(schema: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Return a schema that says which dialect of JSON Schema it is in, and which schema it is."""
    return {"$schema": DIALECT, "$id": f"urn:dofkit:schema:{name}", **schema}


def scene_schema() -> dict[str, Any]:
    """Return the schema of a scene's file, with the other words that are read."""
    schema = Scene.model_json_schema()
    definitions = schema["$defs"]
    for cls in TYPES.values():
        definitions[cls.__name__] = _with_other_words(definitions[cls.__name__], cls.kind())
    definitions["Force"]["properties"]["direction"] = _with_letters(definitions["Force"]["properties"]["direction"])
    definitions[PictureShape.__name__] = _any_shape(definitions[PictureShape.__name__])
    constraints = {**schema["properties"]["constraints"], "items": {"$ref": f"#/$defs/{_CONSTRAINT}"}}
    schema["properties"]["constraints"] = constraints
    schema["properties"]["joints"] = {**constraints, "description": "another section of constraints"}
    schema_by_type: dict[str, Any] = by_kind_of_value(schema)
    schema_by_type["$defs"][_CONSTRAINT] = _any_constraint()
    return identified(schema_by_type, "scene")


def by_kind_of_value(schema: Any) -> Any:
    """Return a schema in which the kind of JSON value decides between the members of every union."""
    if isinstance(schema, list):
        return [by_kind_of_value(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    union = next((key for key in ("anyOf", "oneOf") if key in schema), None)
    plain = {key: by_kind_of_value(part) for key, part in schema.items() if key != union}
    return plain if union is None else {**plain, **_union([by_kind_of_value(branch) for branch in schema[union]])}


def _union(branches: list[dict[str, Any]]) -> dict[str, Any]:
    """Return one schema for several, of which each takes another kind of JSON values."""
    kinds = [_kinds(branch) for branch in branches]
    if len({kind for group in kinds for kind in group}) < sum(map(len, kinds)):
        return {"anyOf": branches}
    branches_by_type = [
        {"if": {"type": group if len(group) > 1 else group[0]}, "then": branch}
        for group, branch in zip(kinds, branches, strict=True)
        if branch.keys() - {"type"}
    ]
    return {
        "type": [kind for group in kinds for kind in group],
        **({"allOf": branches_by_type} if branches_by_type else {}),
    }


def _kinds(branch: Mapping[str, Any]) -> list[str]:
    """Return the kinds of JSON values that a schema takes; what it refers to is an object."""
    kinds = branch.get("type", "object" if "$ref" in branch else "any")
    return [kinds] if isinstance(kinds, str) else list(kinds)


def _any_constraint() -> dict[str, Any]:
    """Return a text, or a mapping of which its `type` says the keys."""
    words: dict[str, list[str]] = {kind: [kind] for kind in TYPES}
    for word, kind in synonyms().items():
        words[kind].append(word)
    by_type = [
        {
            "if": {"properties": {"type": {"enum": words[kind]}}, "required": ["type"]},
            "then": {"$ref": f"#/$defs/{cls.__name__}"},
        }
        for kind, cls in TYPES.items()
    ]
    untyped = {"not": {"required": ["type"]}}
    equation = {
        "if": {"required": ["text"], **untyped},
        "then": {"$ref": f"#/$defs/{Equation.__name__}"},
        "else": {"required": ["type"]},
    }
    mapping = {
        "properties": {"type": {"enum": [word for group in words.values() for word in group]}},
        "allOf": [{"if": untyped, "then": equation}, *by_type],
    }
    return {
        "description": "a text is an equation; a mapping gives its `type`",
        "type": [_TEXT["type"], "object"],
        "if": {"type": "object"},
        "then": mapping,
    }


def _any_shape(schema: Mapping[str, Any]) -> dict[str, Any]:
    """Return a mapping with one of the shapes as a key, which says the others."""
    properties = {key: part for key, part in schema["properties"].items() if key not in ("shape", "name")}
    properties["axis"] = _with_letters(properties["axis"])
    by_shape: list[dict[str, Any]] = []
    for kind, row in SHAPES.items():
        properties[kind] = {"type": [_TEXT["type"], "number", "null"], "description": row.meaning}
        by_shape += [
            {
                "if": {"required": [kind]},
                "then": {"propertyNames": {"enum": [kind, *row.needs, *row.may, "show"]}},
            },
            {"if": {"required": [kind], "not": {"required": ["show"]}}, "then": {"required": list(row.needs)}},
        ]
    no_shape = {"if": {"propertyNames": {"not": {"enum": list(SHAPES)}}}, "then": False}
    return {**schema, "properties": properties, "required": [], "allOf": [no_shape, *by_shape]}


def _with_other_words(schema: dict[str, Any], kind: str) -> dict[str, Any]:
    """Return the schema of a type with the other words for it and for its keys."""
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
    """Other words for keys that are required."""
    for other, key in others.items():
        if key in schema.get("required", ()):
            yield other, key


def _with_letters(vector: Mapping[str, Any]) -> dict[str, Any]:
    """Return the schema of a direction that may also be a letter, such as ``-z``."""
    return {**vector, "anyOf": [*vector["anyOf"], _AXIS]}
