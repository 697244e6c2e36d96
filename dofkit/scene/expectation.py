"""The values that a scene expects (`expect`), compared with those of a report."""

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


def unmet(scene: Scene, report: Mapping[str, Any]) -> list[str]:
    """Return ``KEY: ... expected, but ...`` for every expected field that differs in ``report``, written as JSON."""
    entries = {entry["name"]: entry for entry in report["constraints"]}
    return [
        f"{key}: {wanted} expected, but the report has {value}"
        for key, wanted, value in _pairs(scene.expect, report, entries)
        if not _agrees(scene, key.rpartition(".")[2], wanted, value)
    ]


def _pairs(
    expect: Mapping[str, Any], report: Mapping[str, Any], entries: Mapping[str, Any]
) -> Iterator[tuple[str, Any, Any]]:
    """Yield (name, expected value, reported value) of every expected field; a constraint's is named ``NAME.FIELD``."""
    for key, wanted in expect.items():
        if key != "constraints" or not isinstance(wanted, Mapping):
            yield key, wanted, report.get(key)
            continue
        for name, fields in wanted.items():
            if name not in entries or not isinstance(fields, Mapping):
                yield f"{name}.name", name, None
            else:
                yield from ((f"{name}.{field}", value, entries[name].get(field)) for field, value in fields.items())


def _agrees(scene: Scene, key: str, wanted: Any, value: Any) -> bool:
    """Return whether a report's value is the expected one; order, and equivalent integrals, do not matter."""
    if wanted is None or value is None:
        return wanted is value
    if key in _SETS and isinstance(wanted, Sequence):
        return sorted(map(str, wanted)) == sorted(map(str, value))
    if key in ("count", "mobility") and isinstance(wanted, Mapping):
        return all(value.get(part) == number for part, number in wanted.items())
    if key == "redundancies" and isinstance(wanted, Sequence):
        return _groups(wanted) == _groups(value) and _members(wanted) <= _members(value)
    if key == "forces" and isinstance(wanted, Sequence):
        return _force_names(wanted) == _force_names(value)
    if key == "integral":
        return str(wanted) == value or _one_family(scene, str(wanted), value)
    return bool(wanted == value)


def _groups(groups: Sequence[Any]) -> list[Any]:
    return sorted(group.get("nullity", 0) for group in groups if isinstance(group, Mapping))


def _members(groups: Sequence[Any]) -> set[frozenset[str]]:
    """Return the set of members of every group that lists its members."""
    return {frozenset(map(str, g["members"])) for g in groups if isinstance(g, Mapping) and g.get("members")}


def _force_names(forces: Sequence[Any]) -> list[str]:
    return sorted(str(force.get("name") if isinstance(force, Mapping) else force) for force in forces)


def _one_family(scene: Scene, first: str, second: str) -> bool:
    """Return whether f = C and g = C have the same level surfaces, because df and dg are proportional."""
    vocabulary = vocabulary_of(scene)
    try:
        f, g = (_level(text, vocabulary.names) for text in (first, second))
        moving = [ex.TIME, *(ex.coordinate(c.name) for c in vocabulary.table.coordinates)]
        used = [s for s in moving if s in f.symbols | g.symbols]
        minors = (diff(f, a) * diff(g, b) - diff(f, b) * diff(g, a) for a, b in combinations(used, 2))
        return f.symbols & set(used) == g.symbols & set(used) and all(is_identically_zero(m) for m in minors)
    except (TextError, NoValueError):
        return False


def _level(text: str, names: Names) -> Expr:
    """Return f of the text ``f = C``."""
    return parse_expression(text.partition("=")[0], names)
