"""A page for every constraint type, from its class: its equations, fields, other words, picture and one scene."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from inspect import cleandoc

from dofkit.base.wording import series
from dofkit.expressions.text.printing import to_text
from dofkit.scene.constraints import TYPES, ConstraintBase
from dofkit.scene.lowering import lower
from dofkit.scene.reading import loads
from dofkit.site.gallery import ShownScene, shown
from dofkit.site.markdown import SitePage, code, fence, folded, page, picture, prose, table

FOLDER = "reference/types"
#: The names that an example may mention, by the section that declares them.
DECLARED = {"particles": ("A", "B", "C"), "bodies": ("crank", "rod", "wheel"), "coordinates": ("x", "y")}
#: A longer equation is counted and not shown.
LONGEST = 240
#: Scenes of the catalog that are named.
MOST_NAMED = 12
SPACES = {1: "on a line", 2: "in the plane", 3: "in space"}


def constraint_pages(catalog: Sequence[ShownScene]) -> Iterator[SitePage]:
    """A page for every type, with its pictures, and one that lists them."""
    rows = []
    for kind, cls in TYPES.items():
        rows.append((f"[{code(kind)}]({kind}.md)", prose(_meaning(cls)), _spaces(cls)))
        yield from _pages_of(kind, cls, [scene for scene in catalog if kind in scene.types])
    yield SitePage(
        f"{FOLDER}/index.md",
        page(
            "Constraint types",
            "A plain text is an equation. Any other constraint is a mapping with a `type`, an optional `name`, and the "
            "fields of its type. Each page shows the equations, the fields, and a complete scene.",
            table(("type", "meaning", "defined"), rows),
        ),
    )


def _pages_of(kind: str, cls: type[ConstraintBase], scenes: Sequence[ShownScene]) -> Iterator[SitePage]:
    written = scene_of(cls)
    scene = shown(kind, FOLDER, written)
    yield SitePage(f"{FOLDER}/{kind}.svg", scene.svg)
    first, *paragraphs = re.split(r"\n\s*\n", cleandoc(cls.__doc__ or ""))
    yield SitePage(
        f"{FOLDER}/{kind}.md",
        page(
            kind,
            f"{prose(_sentence(_meaning(cls)))}. It is defined {_spaces(cls)}.",
            "## Equations",
            f"{prose(first)}\n{{ .equation }}",
            *(prose(part) for part in paragraphs),
            "## A scene",
            fence("yaml", written, f"{kind}.yaml"),
            picture(f"{kind}.svg", scene.alternative),
            f"Answer: {prose(scene.answer)}.",
            folded("The full report", fence("text", scene.report)),
            folded("Its scalar equations", fence("text", "\n".join(equations_of(written)))),
            "## Fields",
            table(("field", "required", "meaning"), _fields(cls)),
            *_other_words(cls),
            *_in_the_catalog(scenes),
        ),
    )


def scene_of(cls: type[ConstraintBase]) -> str:
    """A whole scene around the type's example, in the first space that it names or is defined in.

    >>> print(scene_of(TYPES["coincident"]))
    dimension: 2
    particles: [A, B]
    constraints:
    - {type: coincident, between: [A, B]}
    """
    spaces = [d for d in cls.examples if d] or [d for d in cls.dimensions if d > 1]
    dimension = 2 if 2 in spaces else max(spaces)
    lines = (cls.example(dimension), *cls.beside.get(dimension, ()))
    words = {word for line in lines for word in re.findall(r"[A-Za-z]+", line)}
    sections = {key: [name for name in names if name in words] for key, names in DECLARED.items()}
    if sections["particles"] or sections["bodies"]:
        sections["coordinates"] = []
    declared = [f"{key}: [{', '.join(names)}]" for key, names in sections.items() if names]
    return "\n".join([f"dimension: {dimension}", *declared, "constraints:", *(f"- {line}" for line in lines)])


def equations_of(written: str) -> Iterator[str]:
    """The scalar equations of a scene, as text; those that are too long to read are counted."""
    system = lower(loads(written))
    relations = [relation for constraint in system.constraints for relation in constraint.relations]
    texts = [f"{to_text(relation.expr)} {relation.sense} 0" for relation in relations]
    yield from (text for text in texts if len(text) <= LONGEST)
    left_out = sum(len(text) > LONGEST for text in texts)
    if left_out:
        yield f"({left_out} more, in the parameters of rotations; longer than {LONGEST} characters)"


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]


def _meaning(cls: type[ConstraintBase]) -> str:
    return cls.model_fields["type"].description or ""


def _spaces(cls: type[ConstraintBase]) -> str:
    return series([SPACES[d] for d in cls.dimensions])


def _fields(cls: type[ConstraintBase]) -> Iterator[tuple[str, str, str]]:
    ordered = sorted(cls.model_fields.items(), key=lambda item: (item[0] != "type", not item[1].is_required()))
    for key, field in ordered:
        if key == "type":
            yield code(key), "yes", code(cls.kind())
        else:
            yield code(key), "yes" if field.is_required() else "no", prose(field.description or "")


def _other_words(cls: type[ConstraintBase]) -> Iterator[str]:
    sentences = []
    if cls.synonyms:
        sentences.append(f"{', '.join(map(code, cls.synonyms))} can be written instead of `{cls.kind()}`.")
    sentences += [f"{code(word)} can be written instead of {code(key)}." for word, key in cls.other_keys.items()]
    if cls.understood:
        sentences.append(f"For {', '.join(map(code, cls.understood))} the error message suggests this type.")
    if sentences:
        yield "## Synonyms"
        yield " ".join(sentences)


def _in_the_catalog(scenes: Sequence[ShownScene]) -> Iterator[str]:
    if not scenes:
        return
    yield "## In the catalog"
    nearest = min(scenes, key=lambda scene: (len(scene.types), len(scene.written)))
    yield picture(f"../../gallery/{nearest.name}.svg", nearest.alternative)
    links = [f"[{prose(s.title)}](../../gallery/{s.folder}.md#{s.name})" for s in (nearest, *scenes)]
    yield "\n".join(f"* {link}" for link in list(dict.fromkeys(links))[:MOST_NAMED])
