"""The text of a problem: `[[rod]]`, `[[rod.length]]`, `[[l]]` and `[[constraints]]` stand for what the scene says."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import Any

from dofkit.base.errors import Fault
from dofkit.expressions.text.typesetting import typeset
from dofkit.homework.sentences.translations import Language, described
from dofkit.scene.constraints import ConstraintBase
from dofkit.scene.fields import as_written, suggestion
from dofkit.scene.names import coordinate_table
from dofkit.scene.parts import BodyPoint, show_point, show_vector
from dofkit.scene.scene import Scene

_PLACE = re.compile(r"\[\[\s*([^\W\d][\w -]*?)(?:\.(\w+))?\s*\]\]")
#: Stands for all constraints, a line each.
ALL = "constraints"


def named(scene: Scene) -> dict[str, ConstraintBase]:
    """The constraints of a scene by their names, given or by position."""
    return {c.name or f"c{n}": c for n, c in enumerate(scene.constraints, 1)}


def places(text: str) -> list[tuple[str, str | None]]:
    """What a text leaves to the scene: a name, and a field of it."""
    return [(match[1], match[2]) for match in _PLACE.finditer(text)]


def words_of(text: str) -> set[str]:
    """The words that a text has of itself, and their parts between `_`."""
    found = re.findall(r"\w+", _PLACE.sub(" ", text))
    return {*found, *(part for word in found for part in word.split("_"))} - {""}


def filled(text: str, scene: Scene, hidden: Collection[str] = (), language: Language = "en") -> str:
    """The text with what the scene says in its places; a place that stands for nothing stays.

    ``hidden``: constraints whose equations are not told.
    """

    def place(match: re.Match[str]) -> str:
        told = _told(match[1], match[2], scene, hidden, language) or match[0]
        return f"\n\n{told}\n\n" if (match[1], match[2]) == (ALL, None) else told  # a list begins on its own line

    return _PLACE.sub(place, text)


def _told(
    name: str, field: str | None, scene: Scene, hidden: Collection[str] = (), language: Language = "en"
) -> str | None:
    constraints = named(scene)
    secret = {each for each in hidden if each in constraints and constraints[each].facts.written}
    if name == ALL and field is None:
        listed = [(each, "" if each in secret else f": {shown(one, language)}") for each, one in constraints.items()]
        return "\n".join(f"- `{each}`{told}" for each, told in listed)
    if name in secret:
        return f"`{name}`"
    if name in constraints and field is None:
        return shown(constraints[name], language)
    if field is not None:
        value = getattr(constraints.get(name), field, None)
        return None if value is None else _value(value)
    table = coordinate_table(scene)
    known = {*scene.parameters, *scene.functions, *table.particles, *table.bodies, *(c.name for c in table.coordinates)}
    return f"${name}$" if name in known else None


def _value(value: Any) -> str:
    if isinstance(value, tuple):
        numbers = all(not isinstance(part, (tuple, BodyPoint)) for part in value)
        return f"${show_vector(value)}$" if numbers else ", ".join(_value(part) for part in value)
    if isinstance(value, BodyPoint):
        return show_point(value)
    return f"${as_written(value)}$" if not isinstance(value, str) or typeset(value) else f"`{value}`"


def shown(constraint: ConstraintBase, language: Language = "en") -> str:
    """A constraint as a sheet tells it: its equations as formulas, else its words."""
    texts = list(constraint.texts()) if constraint.facts.written and not constraint.facts.lettered else []
    if texts and all(typeset(text) for text in texts):
        return ", ".join(f"${text}$" for text in texts)
    return marked(described(constraint.in_words, language))


def marked(text: str) -> str:
    """A text on one line that Markdown shows as it stands.

    >>> print(marked("x_A * 2"))
    x\\_A \\* 2
    """
    return re.sub(r"([\\`*_{}\[\]<>#|$~])", r"\\\1", " ".join(text.split()))


def faults_of_places(text: str, scene: Scene) -> Iterator[Fault]:
    """Places that stand for nothing in the scene."""
    known = [ALL, *named(scene), *scene.parameters, *scene.functions]
    known += [*coordinate_table(scene).particles, *coordinate_table(scene).bodies]
    for name, field in places(text):
        if _told(name, field, scene) is None:
            what = name if field is None else f"{name}.{field}"
            yield Fault(f"[[{what}]] is not a name in the scene", (), hint=suggestion(name, known, "names"))
