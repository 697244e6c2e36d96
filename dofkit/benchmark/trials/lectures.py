"""The catalog, and answers beside the constraint that they should be: the same, or a little less, more or other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from dofkit.base.documents import read_document
from dofkit.benchmark.trials.construction import (
    KnownScene,
    Row,
    constraint_names,
    known_scene,
    scene_of,
    tables,
)
from dofkit.scene.catalog import catalog_names, catalog_text

#: What is done to an equation ``left = right``; is it the same constraint then?
REWRITTEN: tuple[tuple[str, str, bool, str], ...] = (
    ("other side", "2*({right}) = 2*({left})", True, "rewritten"),
    ("with a factor", "(1 + {q}^2)*({left}) = (1 + {q}^2)*({right})", True, "rewritten"),
    ("a tiny difference", "{left} = {right} + 1e-9*{q}", False, "tiny-difference"),
    ("squared", "(({left}) - ({right}))^2 = 0", False, "irregular"),
)


def scenes() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield every scene of the catalog as it is written."""
    for name in catalog_names():
        yield name, dict(read_document(catalog_text(name).encode(), name).value)


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
            entry = scene["expect"].get("constraints", {}).get(constraint["name"], {})
            for how, text, truth, trait in REWRITTEN:
                if entry.get("form", "finite") != "finite" and trait == "tiny-difference":
                    continue
                answer = (constraint["name"], text.format(left=left.strip(), right=right.strip(), q=q))
                label = f"{name}, {constraint['name']}, {how}"
                yield known_scene(label, plain, how, (trait,), equivalence=(*answer, truth))


def _labels(scene: Mapping[str, Any]) -> dict[str, bool] | None:
    """Return whether each constraint is holonomic, where the scene states it of each."""
    names, expect = constraint_names(scene), scene["expect"]
    if expect.get("holonomic") is True:
        return dict.fromkeys(names, True)
    entries = expect.get("constraints", {})
    holonomic = {name: entries.get(name, {}).get("holonomic") for name in names}
    return None if None in holonomic.values() else holonomic


def _trait(scene: Mapping[str, Any]) -> str:
    """Return what the scene is mostly about."""
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


# Answers

TABLES = tables("answers.yaml")
#: The first of the ways make sense of differential constraints too.
FOR_FORMS = TABLES["ways"][:7]


def _asked(text: str) -> dict[str, str]:
    return {"name": "asked", "type": "equation", "text": text}


def _scene(row: Row) -> dict[str, Any]:
    """Return the scene of a constraint u = 0 called ``asked`` among others."""
    rows = (*row.get("others", ()), _asked(f"{row['u']} = 0"))
    return scene_of(row["coordinates"], *rows, parameters=row.get("parameters", {}))


def answers(quick: bool) -> Iterator[KnownScene]:
    """Every constraint in every way of writing it, and in the ways of its own."""
    for number, row in enumerate(TABLES["finite"]):
        for turn, way in enumerate(TABLES["ways"]):
            if (number + turn) % (16 if quick else 2) == 0 and (way["name"] != "in a cubic" or number < 2):
                yield _rewritten(row, way)
    for row in () if quick else TABLES["moving"]:
        yield from (_rewritten(row, way) for way in FOR_FORMS)
    for row in (*TABLES["finite"], *TABLES["moving"]):
        for answer in row["answers"][:: 5 if quick else 1]:
            about = f"{row['name']}: {answer['text']}", _scene(row), answer["because"], (answer["trait"],)
            yield known_scene(*about, equivalence=("asked", answer["text"], answer["same"]))


def _rewritten(row: Row, way: Row) -> KnownScene:
    answer = ("asked", way["text"].format(u=row["u"], q=row["q"]), way["same"])
    about = f"{row['name']}, {way['name']}", _scene(row), way["because"], (way["trait"],)
    return known_scene(*about, equivalence=answer)


def inequalities(quick: bool) -> Iterator[KnownScene]:
    """A side of a surface: the same side of the same surface, or not."""
    for row in TABLES["sides"][:: 4 if quick else 1]:
        disc = scene_of("x y", _asked("x^2 + y^2 <= R^2"), parameters={"R": "positive"})
        answer = ("asked", row["text"], row["same"])
        yield known_scene(row["text"], disc, "a disc", (row["trait"], "inequality"), equivalence=answer)


def large_answers(quick: bool) -> Iterator[KnownScene]:
    """The same with many coordinates: spheres, sums of many rows, many forms."""
    for n in (3,) if quick else (3, 6, 12, 24):
        x = [f"x{k}" for k in range(n)]
        square = " + ".join(f"{q}^2" for q in x)
        sphere = scene_of(x, _asked(f"{square} = 1"))
        chain = scene_of([*x, "y"], *(f"x{k} = {k} x0" for k in range(1, n)), _asked("y = x0^2"))
        total = " + ".join(f"{k + 2}*(x{k} - {k} x0)" for k in range(1, n))
        names = [*x, *(f"y{k}" for k in range(1, n)), "z", "w"]
        moving = scene_of(names, *(f"dx{k} = y{k} dx0" for k in range(1, n)), _asked("dz = w dx0"))
        left, right = (" + ".join(f"w*{text}".format(k=k) for k in range(1, n)) for text in ("dx{k}", "y{k}*dx0"))
        members = (
            (f"sphere in {n}, in exp", sphere, f"exp({square}) = E", "rewritten"),
            (f"sphere in {n}, squared", sphere, f"({square} - 1)^2 = 0", "irregular"),
            (f"sphere in {n}, another", sphere, f"{square} + 1e-9*x0*x1 = 1", "tiny-difference"),
            (f"{n} rows, their sum", chain, f"y + {total} = x0^2", "combined"),
            (f"{n} rows, not quite", chain, f"y + {total} = x0^2 + 1e-9*x0", "tiny-difference"),
            (f"{n} rows, but this", chain, f"{total} = 0", "weaker"),
            (f"{n} forms, their sum", moving, f"dz + {left} = w dx0 + {right}", "combined"),
            (f"{n} forms, not quite", moving, f"dz + {left} = w dx0 + {right} + 1e-9*dw", "tiny-difference"),
        )
        for name, made, text, trait in members:
            answer = ("asked", text, trait in ("rewritten", "combined"))
            yield known_scene(name, made, "by its making", (trait, "large"), n, equivalence=answer)


def tiny_answers(quick: bool) -> Iterator[KnownScene]:
    """A difference of 10^-k, in a finite relation and in a form, beside a factor of the same size."""
    circle = scene_of("x y", _asked("x^2 + y^2 = 4"))
    form = scene_of("x y z", _asked("dz = y dx"))
    rows = (
        ("radius", circle, "x^2 + y^2 = 4 + {e}"),
        ("ellipse", circle, "x^2 + (1 + {e}) y^2 = 4"),
        ("centre", circle, "(x - {e})^2 + y^2 = 4"),
        ("factor", circle, "{e}*(x^2 + y^2 - 4) = 0"),
        ("factor of each", circle, "(1 + {e} x^2)*(x^2 + y^2) = 4 + 4*{e} x^2"),
        ("form", form, "dz = y dx + {e} dy"),
        ("factor of a form", form, "{e}*dz = {e}*y dx"),
    )
    for k in (6, 30) if quick else (3, 6, 9, 12, 15, 18, 24, 30, 60):
        for name, made, text in rows:
            same, e = name.startswith("factor"), f"1e-{k}"
            because, trait = ("a factor without zeros", "rewritten") if same else ("another set", "tiny-difference")
            answer = ("asked", text.format(e=e), same)
            about = f"{name}, {e}", made, because, (trait,)
            yield known_scene(*about, swept={"gap": float(e)}, equivalence=answer)


FAMILIES = {
    "catalog": catalog,
    "catalog rewritten": catalog_rewritten,
    "answers": answers,
    "sides": inequalities,
    "large answers": large_answers,
    "tiny differences": tiny_answers,
}
