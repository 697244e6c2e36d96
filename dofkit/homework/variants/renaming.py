"""Other names for what a scene declares: letters of the same kind, in everything that is written about it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from dofkit.expressions.text import spelled
from dofkit.homework.problem import Problem
from dofkit.homework.statement import words_of
from dofkit.homework.variants.stream import Stream
from dofkit.scene.names import coordinate_table
from dofkit.scene.scene import Scene

#: Letters of which one stands for another; what is in none of them keeps its name.
KINDS: tuple[tuple[str, ...], ...] = (
    ("l", "L", "a", "b", "c", "h", "s"),
    ("R", "r", "rho"),
    ("m", "M", "mu"),
    ("theta", "phi", "psi", "alpha", "beta", "gamma", "chi"),
    ("omega", "Omega", "nu"),
    ("k", "kappa"),
    ("v", "w"),
    ("A", "B", "C", "D", "G", "H", "P", "Q", "S", "T"),
)
_INDEXED = re.compile(r"(?P<stem>[^\W\d_]+)(?P<index>_?\w*)")
_WORD = re.compile(r"[^\W\d]\w*")
#: Fields whose texts are no names of the scene.
_FOREIGN = frozenset({"type", "title", "source", "notes", "ask", "id"})
_SIGNS = frozenset({"real", "positive", "nonzero"})


def fresh_name(wished: str, taken: Collection[str]) -> str:
    """A name like the one that is wished for, and none that is taken."""
    kind = next((kind for kind in KINDS if wished in kind), (wished,))
    options = [wished, *(name for name in kind if name != wished), *(f"{wished}_{n}" for n in range(1, 100))]
    return next(name for name in options if name not in taken)


def declared(scene: Scene) -> list[str]:
    """Every name that a scene declares, but those of its constraints; one that is declared twice occurs twice."""
    table = coordinate_table(scene)
    owned = [name for names in (*table.particles.values(), *table.bodies.values()) for name in names]
    return [*scene.parameters, *scene.functions, *table.particles, *table.bodies, *scene.coordinates, *owned]


def new_names(scene: Scene, problem: Problem, stream: Stream) -> dict[str, str]:
    """Name -> another name, of what may be renamed: never what the problem's own words mention."""
    known = declared(scene)
    counts = Counter(map(spelled, known))
    said = words_of(f"{problem.title or ''} {problem.text or ''}")
    fixed = set(map(spelled, said)) | set(problem.other_names)
    arguments = {argument for given in scene.functions.values() for argument in given}
    taken = {*map(spelled, known), "t", "e", "E", "pi", *problem.other_names, *problem.also}
    taken |= {c.name for c in scene.constraints if c.name is not None}
    found: dict[str, str] = {}
    for name in _renameable(scene):
        if counts[spelled(name)] > 1 or name in arguments or fixed & set(map(spelled, words(scene, {name: name}))):
            continue
        match = _INDEXED.fullmatch(spelled(name))
        kind = next((k for k in KINDS if match and match["stem"] in k), None)
        if match is None or kind is None:
            continue
        options = [new for stem in kind if (new := stem + match["index"]) not in taken or new == spelled(name)]
        chosen = stream.choice(options)
        if chosen != spelled(name):
            found[name] = chosen
            taken.add(chosen)
    return found


def _renameable(scene: Scene) -> Iterator[str]:
    """What has a name that is a choice: symbols, points, and further coordinates."""
    yield from (name for name, value in scene.parameters.items() if value in _SIGNS)
    table = coordinate_table(scene)
    yield from (owner for owner in (*table.particles, *table.bodies) if len(owner) == 1)
    yield from scene.coordinates


def words(scene: Scene, names: Mapping[str, str]) -> dict[str, str]:
    """Every word that changes with the names: the coordinates of what is renamed, derivatives, differentials."""
    found = dict(names)
    table = coordinate_table(scene)
    for owner, coordinates in (*table.particles.items(), *table.bodies.items()):
        for coordinate in coordinates if owner in names else ():
            if coordinate.endswith(f"_{owner}"):
                found[coordinate] = coordinate.removesuffix(owner) + names[owner]
    moving = {c.name for c in table.coordinates} & set(found)
    more: dict[str, str] = {}
    for old in moving:
        new = found[old]
        more |= {f"d{old}": f"d{new}", **{f"{old}{dot}": f"{new}{dot}" for dot in ("dot", "ddot", "_dot", "_ddot")}}
        (stem, _, index), (other, _, place) = old.partition("_"), new.partition("_")
        if index:
            more |= {f"{stem}{dot}_{index}": f"{other}{dot}_{place}" for dot in ("dot", "ddot")}
    return {**more, **found}


def renamed(value: Any, changes: Mapping[str, str]) -> Any:
    """What is written, with other words: in keys and texts, wherever they stand; Greek letters are their names."""
    if not changes:
        return value
    if isinstance(value, Mapping):
        kept = ("name", *_FOREIGN) if "type" in value or "text" in value else _FOREIGN
        return {
            _text(key, changes): part if key in kept or part in _signs(part) else renamed(part, changes)
            for key, part in value.items()
        }
    if isinstance(value, (list, tuple)):
        return [renamed(part, changes) for part in value]
    return _text(value, changes) if isinstance(value, str) else value


def _signs(part: Any) -> Collection[Any]:
    return _SIGNS if isinstance(part, str) else ()


def _text(text: str, changes: Mapping[str, str]) -> str:
    return _WORD.sub(lambda m: changes.get(m[0], changes.get(spelled(m[0]), m[0])), text)
