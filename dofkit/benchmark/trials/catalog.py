"""The catalog: what each scene says must be told of it, derived by hand."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from dofkit.base.documents import read_document
from dofkit.benchmark.trials.construction import KnownScene, known_scene
from dofkit.scene.catalog import catalog_names, catalog_text

#: What is done to an equation ``left = right``; is it the same constraint then?
REWRITTEN: tuple[tuple[str, str, bool, str], ...] = (
    ("other side", "2*({right}) = 2*({left})", True, "rewritten"),
    ("with a factor", "(1 + {q}^2)*({left}) = (1 + {q}^2)*({right})", True, "rewritten"),
    ("a tiny difference", "{left} = {right} + 1e-9*{q}", False, "tiny-difference"),
    ("squared", "(({left}) - ({right}))^2 = 0", False, "irregular"),
)


def scenes() -> Iterator[tuple[str, dict[str, Any]]]:
    """Every scene of the catalog as it is written."""
    for name in catalog_names():
        found = read_document(catalog_text(name).encode(), name).value
        yield name, dict(found)


def catalog(quick: bool) -> Iterator[KnownScene]:
    """Every scene of the catalog: its freedom, its labels, what is redundant in it."""
    for number, (name, scene) in enumerate(scenes()):
        if quick and number % 12:
            continue
        expect = scene["expect"]
        yield known_scene(
            name,
            {key: value for key, value in scene.items() if key != "expect"},
            "derived by hand: see the scene's notes",
            (_trait(scene),),
            size=len(scene.get("constraints", ())),
            dof=-1 if expect.get("consistent") is False else expect.get("dof"),
            integrability=_labels(scene),
            redundancy=expect.get("redundant"),
        )


def catalog_rewritten(quick: bool) -> Iterator[KnownScene]:
    """Equations of the catalog, rewritten: the same, or not quite."""
    for number, (name, scene) in enumerate(scenes()):
        if quick and number % 30:
            continue
        plain = {key: value for key, value in scene.items() if key != "expect"}
        q = next(iter(scene.get("coordinates") or ()), None)
        for constraint in scene.get("constraints", ()) if q is not None else ():
            if not isinstance(constraint, Mapping) or constraint.get("type") != "equation" or "name" not in constraint:
                continue
            left, equals, right = str(constraint["text"]).partition("=")
            if not equals or left.endswith(("<", ">")) or "=" in right:
                continue
            told = scene["expect"].get("constraints", {}).get(constraint["name"], {})
            for how, text, truth, trait in REWRITTEN:
                if told.get("form", "finite") != "finite" and trait == "tiny-difference":
                    continue
                answer = (constraint["name"], text.format(left=left.strip(), right=right.strip(), q=q))
                label = f"{name}, {constraint['name']}, {how}"
                yield known_scene(label, plain, how, (trait,), equivalence=(*answer, truth))


def _labels(scene: Mapping[str, Any]) -> dict[str, bool] | None:
    """Whether each constraint is holonomic, where it is told of each."""
    names = [
        c["name"] if isinstance(c, Mapping) and "name" in c else f"c{i + 1}"
        for i, c in enumerate(scene.get("constraints", ()))
    ]
    expect = scene["expect"]
    if expect.get("holonomic") is True:
        return dict.fromkeys(names, True)
    told = expect.get("constraints", {})
    found = {name: told.get(name, {}).get("holonomic") for name in names}
    return None if None in found.values() else found


def _trait(scene: Mapping[str, Any]) -> str:
    """What the scene is mostly about."""
    expect = scene["expect"]
    types = {c.get("type", "equation") for c in scene.get("constraints", ()) if isinstance(c, Mapping)}
    if expect.get("holonomic") is False:
        forms = [entry.get("form") for entry in expect.get("constraints", {}).values()]
        return "inequality" if "inequality" in forms else "non-holonomic"
    if expect.get("redundant_equations"):
        return "redundant"
    if expect.get("scleronomic") is False:
        return "rheonomic"
    return "joints" if scene.get("bodies") and types - {"equation"} else "plain"


FAMILIES = {"catalog": catalog, "catalog rewritten": catalog_rewritten}
