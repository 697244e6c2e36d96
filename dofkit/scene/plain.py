"""A scene in plain notation: standard words, and texts rewritten for a simpler grammar if that cannot read them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from itertools import chain
from typing import Any, NamedTuple

from dofkit.base.errors import TextError
from dofkit.expressions.real_values import DomainSense, Requirement, of_function, of_power
from dofkit.expressions.text import Names, parse_expression, parse_relations, to_text
from dofkit.expressions.tree import Expr, nodes
from dofkit.scene.lowering import survey_of
from dofkit.scene.names import SIGNS
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import SAID

#: A derivative of a declared function of one name, as `to_text` prints it.
_DERIVATIVE = re.compile(r"diff\((\w+)(\(\w+\)), \w+(?:, (\d+))?\)")
#: Returns whether the simpler grammar reads a text with these names.
Reads = Callable[[str, Names], bool]


class PlainScene(NamedTuple):
    """A scene's ``document``; ``readings``: {text that was rewritten: its plain form}."""

    document: dict[str, Any]
    readings: dict[str, str]


def plain_scene(scene: Scene, reads: Reads) -> PlainScene:
    """Return a scene in standard words, with plain notation for the texts that ``reads`` does not accept."""
    names, readings = survey_of(scene).names, dict[str, str]()
    owners = {"ground", *SIGNS, *(named.name for named in (*scene.particles, *scene.bodies, *scene.constraints))}

    def rewritten(value: Any, names: Names) -> Any:
        if isinstance(value, str):
            if value in owners:
                return value
            plain = None if reads(value, names) else plain_text(value, names)
            readings.update({} if plain is None else {value: plain})
            return value if plain is None else plain
        if isinstance(value, dict):
            inner = _within(value, names)
            return {key: part if key in _REFERENCES else rewritten(part, inner) for key, part in value.items()}
        return [rewritten(part, names) for part in value] if isinstance(value, list) else value

    document = scene.model_dump(mode="json", by_alias=True, exclude_unset=True)
    return PlainScene({"name": scene.name, **rewritten(document, names)}, readings)


#: Keys whose values contain no formulas.
_REFERENCES = SAID | {"name", "type", "functions", "expect", "picture"}


def _within(entry: Mapping[str, Any], names: Names) -> Names:
    """Return the names for the texts of a mapping: with x, y, z for a surface or curve, and the letters of joints."""
    letters = {"x", "y", "z"} if entry.keys() & {"surface", "curve"} else set(entry.get("joints", ()))
    return replace(names, coordinates=names.coordinates.union(letters)) if letters else names


def plain_text(text: str, names: Names) -> str | None:
    """Return a text as `to_text` prints it, with primes for `diff`; None if unreadable or if its domain changes."""
    try:
        relations = parse_relations(text, names)
        signs = [f" {relation.relation} " for relation in relations]
        sides = [relations[0].left, *(relation.right for relation in relations)]
        with suppress(TextError):
            sides, signs = [parse_expression(text, names)], []
    except TextError:
        return None
    printed = {base for side in sides for required in _required(side) for base in _bases(*required)}
    if not {base for required in relations[0].domain for base in _bases(*required)} <= printed:
        return None
    printed_text = "".join(chain.from_iterable(zip(["", *signs], map(to_text, sides), strict=True)))
    return _DERIVATIVE.sub(lambda match: match[1] + "'" * int(match[3] or 1) + match[2], printed_text)


def _bases(e: Expr, sense: DomainSense) -> Iterator[Requirement]:
    """Yield (e, sense) against 0, and for a product or power that is not 0 the same of its factors or base."""
    factors = e.args if e.op == "mul" else e.args[:1] if e.op == "pow" else ()
    if (sense != "!=" or not factors) and not (e.op == "num" and e.args[0] > 0):
        yield e, sense
    for factor in factors if sense == "!=" else ():
        yield from _bases(factor, sense) if factor.op != "num" else ()


def _required(e: Expr) -> Iterator[Requirement]:
    """Yield the requirements under which an expression, as printed, has a real value."""
    for node in nodes(e):
        if node.op == "pow":
            yield from of_power(*node.args)
        elif node.op == "fn":
            yield from of_function(*node.args)
