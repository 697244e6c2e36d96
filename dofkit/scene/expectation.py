"""What a scene expects of its report, held against what is told."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any

from dofkit.base.errors import NoValueError, TextError
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import Expr
from dofkit.scene.names import vocabulary_of
from dofkit.scene.scene import Scene

#: Keys whose lists are sets of names.
_SETS = frozenset({"redundant", "conflicting", "infeasible", "generalized_coordinates", "circuit"})


def unmet(scene: Scene, told: Mapping[str, Any]) -> list[str]:
    """Every field that the scene expects and a report does not have, as ``KEY: ... expected, but the report has ...``.

    ``told``: the report as it is written in JSON.
    """
    entries = {entry["name"]: entry for entry in told["constraints"]}
    return [
        f"{key}: {wanted} expected, but the report has {found}"
        for key, wanted, found in _pairs(scene.expect, told, entries)
        if not _agrees(scene, key.rpartition(".")[2], wanted, found)
    ]


def _pairs(
    expect: Mapping[str, Any], told: Mapping[str, Any], entries: Mapping[str, Any]
) -> Iterator[tuple[str, Any, Any]]:
    """(field, expected, told); fields of a constraint are ``NAME.FIELD``."""
    for key, wanted in expect.items():
        if key != "constraints" or not isinstance(wanted, Mapping):
            yield key, wanted, told.get(key)
            continue
        for name, fields in wanted.items():
            if name not in entries or not isinstance(fields, Mapping):
                yield f"{name}.name", name, None
            else:
                yield from ((f"{name}.{field}", value, entries[name].get(field)) for field, value in fields.items())


def _agrees(scene: Scene, key: str, wanted: Any, found: Any) -> bool:
    if wanted is None or found is None:
        return wanted is found
    if key in _SETS and isinstance(wanted, Sequence):
        return sorted(map(str, wanted)) == sorted(map(str, found))
    if key == "count" and isinstance(wanted, Mapping):
        return all(found.get(part) == value for part, value in wanted.items())
    if key == "redundancies" and isinstance(wanted, Sequence):
        return _groups(wanted) == _groups(found)
    if key == "forces" and isinstance(wanted, Sequence):
        return _force_names(wanted) == _force_names(found)
    if key == "integral":
        return str(wanted) == found or _one_family(scene, str(wanted), found)
    return bool(wanted == found)


def _groups(groups: Sequence[Any]) -> list[Any]:
    return sorted(group.get("nullity", 0) for group in groups if isinstance(group, Mapping))


def _force_names(forces: Sequence[Any]) -> list[str]:
    return sorted(str(force.get("name") if isinstance(force, Mapping) else force) for force in forces)


def _one_family(scene: Scene, one: str, other: str) -> bool:
    """Are f = C and g = C the same surfaces: are df and dg proportional?"""
    vocabulary = vocabulary_of(scene)
    try:
        f, g = (_level(text, vocabulary.names) for text in (one, other))
        moving = [ex.TIME, *(ex.coordinate(c.name) for c in vocabulary.table.coordinates)]
        used = [s for s in moving if s in f.symbols | g.symbols]
        minors = (diff(f, a) * diff(g, b) - diff(f, b) * diff(g, a) for a, b in combinations(used, 2))
        return f.symbols & set(used) == g.symbols & set(used) and all(is_identically_zero(m) for m in minors)
    except (TextError, NoValueError):
        return False


def _level(text: str, names: Names) -> Expr:
    """f of ``f = C``."""
    return parse_expression(text.partition("=")[0], names)
