"""Other constraints in a problem: one dropped or added, supports at rest or in motion, bodies that roll or slide."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

from dofkit.base.errors import SceneError
from dofkit.homework.key.key import Key
from dofkit.homework.problem import ASPECTS, Aspect, Problem, Varying
from dofkit.homework.questions.equations import EquationQuestion
from dofkit.homework.statement import ALL, named, places
from dofkit.homework.variants.difficulty import Difficulty, difficulty_of, fit
from dofkit.homework.variants.renaming import declared, fresh_name
from dofkit.scene.constraints import TYPES, ConstraintBase
from dofkit.scene.constraints.equations import Equation
from dofkit.scene.names import coordinate_table
from dofkit.scene.reading import load
from dofkit.scene.scene import Scene
from dofkit.scene.variation import NamesAtHand

#: Ways to change a problem that are looked at.
MOST_WAYS = 24


@dataclass(frozen=True)
class Structure:
    """A problem with constraints changed: the scene as it is written, its key, and what was ``changed`` in words."""

    written: Mapping[str, Any]
    key: Key
    difficulty: Difficulty
    aspect: Aspect | None = None
    changed: str = ""


def written_scene(scene: Scene) -> dict[str, Any]:
    """A scene as it may be written, less what is only told of it."""
    told = scene.model_dump(mode="json", exclude_none=True)
    return {key: value for key, value in told.items() if value not in ([], {}) and key not in _TOLD}


_TOLD = ("title", "source", "notes", "expect")


def aspects_of(problem: Problem) -> tuple[Aspect, ...]:
    """What of a problem may differ: what it says; without, as much as its own text and figure leave open."""
    if problem.vary is not None:
        return problem.vary.what
    if problem.figure not in (None, "scene", "none"):
        return ()
    if problem.text is None or (ALL, None) in places(problem.text):
        return ASPECTS
    return ("names",)


def structures(problem: Problem, key: Key) -> list[Structure]:
    """The problem as it is, then every other structure that is fit to hand out, in an order that never changes."""
    as_it_is = written_scene(key.scene) | {"name": problem.id}
    found = [Structure(as_it_is, key, difficulty_of(problem, key))]
    if key.scene.energies is not None or fit(key, key) is not None:
        return found
    for aspect, written, told in islice(_ways(problem, key, as_it_is), MOST_WAYS):
        try:
            scene = load(written, name=problem.id)
            other = Key(scene, key.convention, key.also, key.others)
            if any(any(q.faults(other)) for q in problem.questions) or fit(other, key) is not None:
                continue
        except SceneError:
            continue
        found.append(Structure(written, other, difficulty_of(problem, other), aspect, told))
    return found


Way = tuple[Aspect, dict[str, Any], str]


def _ways(problem: Problem, key: Key, written: Mapping[str, Any]) -> Iterator[Way]:
    aspects = aspects_of(problem)
    varying = problem.vary or Varying.model_validate({})
    if "supports" in aspects or "rolling" in aspects:
        yield from (way for way in _replaced(problem, key, written) if way[0] in aspects)
    if "constraints" in aspects:
        yield from _dropped(problem, key, written, varying.drop)
        yield from _added(key, written, varying.add)


def _replaced(problem: Problem, key: Key, written: Mapping[str, Any]) -> Iterator[Way]:
    """Each constraint in another guise; one whose equation is asked for never as a mere equation."""
    asked = {name for q in problem.questions if isinstance(q, EquationQuestion) for name in q.constraint}
    hand = names_at_hand(key.scene)
    for n, (name, constraint) in enumerate(named(key.scene).items()):
        for other in constraint.replacements(hand):
            if name in asked and TYPES[other.fields.get("type", Equation.kind())].facts.written:
                continue
            constraints = list(written["constraints"])
            constraints[n] = {**other.fields, **({} if constraint.name is None else {"name": name})}
            parameters = {**written.get("parameters", {}), **other.parameters}
            changed = {**written, "constraints": constraints, "parameters": parameters}
            yield other.aspect, _without_idle(changed), f"{name}: {other.told}"


def names_at_hand(scene: Scene) -> NamesAtHand:
    """The names of a scene, for constraints that may be replaced."""
    table = coordinate_table(scene)
    taken = {*declared(scene), "t", "e", "E", "pi"}
    owned = {**table.particles, **table.bodies}
    return NamesAtHand(scene.dimension, owned, scene.parameters, lambda wished: fresh_name(wished, taken))


def _without_idle(written: Mapping[str, Any]) -> dict[str, Any]:
    """Without parameters that nothing mentions any more."""
    rest = json.dumps({key: value for key, value in written.items() if key != "parameters"}, ensure_ascii=False)
    values = " ".join(str(value) for value in written.get("parameters", {}).values())
    kept = {
        name: value
        for name, value in written.get("parameters", {}).items()
        if re.search(rf"(?<![^\W\d]){re.escape(name)}(?!\w)", f"{rest} {values}")
    }
    return {**written, "parameters": kept}


def _dropped(problem: Problem, key: Key, written: Mapping[str, Any], chosen: Sequence[str]) -> Iterator[Way]:
    """One constraint less: of those that are named, else of all that nobody asks about."""
    constraints = named(key.scene)
    asked = {name for q in problem.questions for name in q.about}
    for n, name in enumerate(constraints):
        if name in asked or (chosen and name not in chosen) or len(constraints) < 2:
            continue
        rest = _with_names(written["constraints"], list(constraints))
        yield "constraints", {**written, "constraints": rest[:n] + rest[n + 1 :]}, f"without {name}"


def _with_names(constraints: Sequence[Mapping[str, Any]], names: Sequence[str]) -> list[dict[str, Any]]:
    """All constraints under the names that they go by, so that none changes its name where one is dropped."""
    return [{**one, "name": name} for one, name in zip(constraints, names, strict=True)]


def _added(key: Key, written: Mapping[str, Any], chosen: Sequence[ConstraintBase]) -> Iterator[Way]:
    """One constraint more: of those that are given, else of what types offer."""
    known = _with_names(written.get("constraints", ()), list(named(key.scene)))
    hand = names_at_hand(key.scene)
    given = [one.written() for one in chosen]
    offers = given or [dict(offer) for cls in TYPES.values() for offer in cls.offers(hand, known)]
    for offer in offers:
        free = (f"c{n}" for n in range(len(known) + 1, 2 * len(known) + 3))
        name = offer.get("name") or next(n for n in free if n not in {one["name"] for one in known})
        shown = TYPES[offer.get("type", Equation.kind())].model_validate(offer).in_words
        yield "constraints", {**written, "constraints": [*known, {**offer, "name": name}]}, f"with {name}: {shown}"
