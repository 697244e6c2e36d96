"""The catalog, and answers to compare with a constraint: equivalent to it, or weaker, stronger or different."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from dofkit.base.documents import read_document
from dofkit.benchmark.trials.construction import KnownScene, Row, constraint_names, known_scene, scene_of, tables
from dofkit.scene.catalog import catalog_names, catalog_text


def scenes() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield (name, mapping as written) of every scene of the catalog."""
    for name in catalog_names():
        yield name, dict(read_document(catalog_text(name).encode(), name).value)


def catalog() -> Iterator[KnownScene]:
    """Every scene of the catalog: its freedom, its labels, its redundant constraints."""
    for name, scene in scenes():
        expect = scene["expect"]
        yield known_scene(
            name,
            {key: value for key, value in scene.items() if key != "expect"},
            "derived by hand: see the scene's notes",
            size=len(scene.get("constraints", ())),
            dof=-1 if expect.get("consistent") is False else expect.get("dof"),
            integrability=_labels(scene),
            redundancy=expect.get("redundant"),
        )


def _labels(scene: Mapping[str, Any]) -> dict[str, bool] | None:
    """Return {constraint: whether it is holonomic}, None unless the scene states this for all constraints."""
    names, expect = constraint_names(scene), scene["expect"]
    if expect.get("holonomic") is True:
        return dict.fromkeys(names, True)
    entries = expect.get("constraints", {})
    holonomic = {name: entries.get(name, {}).get("holonomic") for name in names}
    return None if None in holonomic.values() else holonomic


# Answers

TABLES = tables("answers.yaml")
#: The notations that make sense for differential constraints too.
FOR_FORMS = TABLES["ways"][:7]


def _asked(text: str) -> dict[str, str]:
    return {"name": "asked", "type": "equation", "text": text}


def _scene(row: Row) -> dict[str, Any]:
    """Return the scene of the row's constraint u = 0, called ``asked``, and of the row's other constraints."""
    rows = (*row.get("others", ()), _asked(f"{row['u']} = 0"))
    return scene_of(row["coordinates"], *rows, parameters=row.get("parameters", {}))


def answers() -> Iterator[KnownScene]:
    """Every constraint in many notations, and the answers listed for it."""
    for number, row in enumerate(TABLES["finite"]):
        for turn, notation in enumerate(TABLES["ways"]):
            if (number + turn) % 2 == 0 and (notation["name"] != "in a cubic" or number < 2):
                yield _rewritten(row, notation)
    for row in TABLES["moving"]:
        yield from (_rewritten(row, notation) for notation in FOR_FORMS)
    for row in (*TABLES["finite"], *TABLES["moving"]):
        for answer in row["answers"]:
            about = f"{row['name']}: {answer['text']}", _scene(row), answer["because"]
            yield known_scene(*about, equivalence=("asked", answer["text"], answer["same"]))


def _rewritten(row: Row, notation: Row) -> KnownScene:
    answer = ("asked", notation["text"].format(u=row["u"], q=row["q"]), notation["same"])
    about = f"{row['name']}, {notation['name']}", _scene(row), notation["because"]
    return known_scene(*about, equivalence=answer)


def inequalities() -> Iterator[KnownScene]:
    """Inequalities: the same side of the same surface, or not."""
    for row in TABLES["sides"]:
        disc = scene_of("x y", _asked("x^2 + y^2 <= R^2"), parameters={"R": "positive"})
        answer = ("asked", row["text"], row["same"])
        yield known_scene(row["text"], disc, "a disc", equivalence=answer)


FAMILIES = {
    "catalog": catalog,
    "answers": answers,
    "sides": inequalities,
}
