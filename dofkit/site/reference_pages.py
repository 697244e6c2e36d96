"""Pages generated from the package: constraint types, the first page, glossary, theorems and commands."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Sequence
from importlib import resources
from inspect import cleandoc
from pathlib import Path
from typing import Any

import typer.main

from dofkit.base.wording import series
from dofkit.classification.arguments import arguments
from dofkit.expressions.text.printing import to_text
from dofkit.homework.sentences import meanings
from dofkit.interface.cli import app
from dofkit.interface.explanations import all_explanations
from dofkit.interface.show.assurance import assurance
from dofkit.report import ConstraintEntry, Report
from dofkit.scene.constraints import TYPES, ConstraintBase
from dofkit.scene.lowering import lower
from dofkit.scene.reading import loads
from dofkit.site.gallery import ShownScene, shown_scene
from dofkit.site.markdown import SitePage, anchor, code, prose, rendered

FOLDER = "reference/types"
#: {section: names that an example may mention and that this section then declares}.
DECLARED = {"particles": ("A", "B", "C"), "bodies": ("crank", "rod", "wheel"), "coordinates": ("x", "y")}
#: The most characters of an equation that is shown; longer ones are only counted.
LONGEST = 240
#: The most scenes of the catalog that a page names.
MOST_NAMED = 12
#: The words for each dimension.
SPACES = {1: "on a line", 2: "in the plane", 3: "in space"}


def constraint_pages(catalog: Sequence[ShownScene]) -> Iterator[SitePage]:
    """Yield the page and the picture of every constraint type, and the index of all types."""
    for kind, cls in TYPES.items():
        yield from _pages_of(kind, cls, [scene for scene in catalog if kind in scene.types])
    rows = [(f"[{code(kind)}]({kind}.md)", prose(_meaning(cls)), _dimensions_of(cls)) for kind, cls in TYPES.items()]
    yield SitePage(f"{FOLDER}/index.md", rendered("types.md", rows=rows))


def _pages_of(kind: str, cls: type[ConstraintBase], scenes: Sequence[ShownScene]) -> Iterator[SitePage]:
    """Yield the picture and the page of one constraint type; ``scenes``: those of the catalog that contain it."""
    scene = shown_scene(kind, FOLDER, scene_of(cls))
    yield SitePage(f"{FOLDER}/{kind}.svg", scene.svg)
    meaning = _meaning(cls)
    nearest = sorted(scenes, key=lambda scene: (len(scene.types), len(scene.written)))[:1]
    text = rendered(
        "type.md",
        kind=kind,
        meaning=meaning[:1].upper() + meaning[1:],
        spaces=_dimensions_of(cls),
        paragraphs=re.split(r"\n\s*\n", cleandoc(cls.__doc__ or "")),
        scene=scene,
        equations=equations_of(scene.written),
        fields=_constraint_fields(cls),
        synonyms=list(_other_words(cls)),
        examples=list(dict.fromkeys([*nearest, *scenes]))[:MOST_NAMED],
    )
    yield SitePage(f"{FOLDER}/{kind}.md", text)


def scene_of(cls: type[ConstraintBase]) -> str:
    """Return a whole scene with the type's example, in the plane if possible, which declares the names that occur.

    >>> print(scene_of(TYPES["coincident"]))
    dimension: 2
    particles: [A, B]
    constraints:
    - {type: coincident, between: [A, B]}
    """
    spaces = [d for d in cls.words().examples if d] or [d for d in cls.dimensions if d > 1]
    dimension = 2 if 2 in spaces else max(spaces)
    lines = cls.example(dimension)
    words = {word for line in lines for word in re.findall(r"[A-Za-z]+", line)}
    sections = {key: [name for name in names if name in words] for key, names in DECLARED.items()}
    if sections["particles"] or sections["bodies"]:
        sections["coordinates"] = []
    declared = [f"{key}: [{', '.join(names)}]" for key, names in sections.items() if names]
    return "\n".join([f"dimension: {dimension}", *declared, "constraints:", *(f"- {line}" for line in lines)])


def equations_of(written: str) -> Iterator[str]:
    """Yield the scalar equations of a scene as text, then the number of those longer than `LONGEST`."""
    system = lower(loads(written))
    relations = [relation for constraint in system.constraints for relation in constraint.relations]
    texts = [f"{to_text(relation.expr)} {relation.sense} 0" for relation in relations]
    yield from (text for text in texts if len(text) <= LONGEST)
    left_out = sum(len(text) > LONGEST for text in texts)
    if left_out:
        yield f"({left_out} more, in the parameters of rotations; longer than {LONGEST} characters)"


def _meaning(cls: type[ConstraintBase]) -> str:
    return cls.model_fields["type"].description or ""


def _dimensions_of(cls: type[ConstraintBase]) -> str:
    return series([SPACES[d] for d in cls.dimensions])


def _constraint_fields(cls: type[ConstraintBase]) -> Iterator[tuple[str, str, str]]:
    ordered = sorted(cls.model_fields.items(), key=lambda item: (item[0] != "type", not item[1].is_required()))
    for key, field in ordered:
        if key == "type":
            yield code(key), "yes", code(cls.kind())
        else:
            yield code(key), "yes" if field.is_required() else "no", prose(field.description or "")


def _other_words(cls: type[ConstraintBase]) -> Iterator[str]:
    words = cls.words()
    if words.synonyms:
        yield f"{', '.join(map(code, words.synonyms))} can be written instead of `{cls.kind()}`."
    yield from (f"{code(word)} can be written instead of {code(key)}." for word, key in words.keys.items())
    if words.understood:
        yield f"For {', '.join(map(code, words.understood))} the error message suggests this type."


THEOREMS, GLOSSARY, ROOMS = "about/theorems.md", "reference/glossary.md", "about/rooms.md"
PACKAGE = Path(__file__).parents[1]
#: The placeholder for the generated tables in the hand-written glossary.
TABLES_HERE = "<!-- the tables of the package -->"
#: The lines of the tables in THEOREMS.md: the two lines of a head, and the line of a theorem.
_HEAD = re.compile(r"^\| key .*\n\|[-| ]+\|\n", re.MULTILINE)
_ROW = re.compile(r"^\| `(\w+)` \|([^|]+)\|([^|]+)\|(.+)\|([^|]+)\|$", re.MULTILINE)


_PICTURE_OF_BENCH = re.compile(r"!\[[^\]]*\]\(dofkit/site/pages/bench\.png\)\n\n")


def readme_page(readme: str, has_bench: bool = False) -> SitePage:
    """Return the first page: the README with the site's links, and with an embedded bench if ``has_bench``.

    >>> readme_page("[how](dofkit/site/pages/tutorial.md) and [why](dofkit/THEOREMS.md)").text
    '[how](tutorial.md) and [why](about/theorems.md)'
    """
    if has_bench:
        title, lead, others = readme.split("\n\n", 2)
        readme = "\n\n".join((title, lead, rendered("bench.html").strip(), _PICTURE_OF_BENCH.sub("", others)))
    return SitePage(
        "index.md", readme.replace("](dofkit/site/pages/", "](").replace("](dofkit/THEOREMS.md)", f"]({THEOREMS})")
    )


def rooms_page() -> SitePage:
    """Return the page of the packages, made of the docstrings of their ``__init__`` modules."""
    rooms = []
    for path in sorted(PACKAGE.glob("*/__init__.py")):
        docstring = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        rooms.append((path.parent.name, *docstring.partition("\n")[::2]))
    return SitePage(ROOMS, rendered("rooms.md", rooms=rooms))


def report_pages(written: str) -> Iterator[SitePage]:
    """Yield the glossary, which is ``written`` with generated tables filled in, and the page of theorems."""
    before, after = written.split(TABLES_HERE)
    yield SitePage(GLOSSARY, before + _tables() + after)
    yield SitePage(THEOREMS, theorems((resources.files("dofkit") / "THEOREMS.md").read_text(encoding="utf-8")))


def _tables() -> str:
    words = sorted(((w.word, w.meaning) for w in all_explanations() if w.kind == "term"), key=lambda row: row[0])
    return rendered(
        "glossary.md",
        terms=[(prose(word), prose(meaning)) for word, meaning in words],
        report=_rows((name, field.description or "") for name, field in Report.model_fields.items()),
        constraint=_rows((name, field.description or "") for name, field in ConstraintEntry.model_fields.items()),
        verdicts=_rows(assurance("verdicts").items()),
        arguments=_arguments(),
        codes=_rows(meanings().items()),
    ).rstrip("\n")


def _rows(meant: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
    return [(code(name), prose(meaning)) for name, meaning in meant]


def _arguments() -> Iterator[tuple[str, ...]]:
    for key, row in arguments().items():
        theorem = f"[{row.theorem}](../{THEOREMS}#{anchor(row.theorem)})" if row.theorem else ""
        yield prose(key), prose(row.claims), prose(row.hypotheses), theorem


def theorems(text: str) -> str:
    """Return the text of `THEOREMS.md` with each row of its tables as an entry with an anchor.

    >>> print(theorems("| `Dini1878` | Dini | 1878 | A graph. | `a.py` |"))
    ### Dini1878 {#dini1878}
    <BLANKLINE>
    **Dini, 1878.** A graph.
    <BLANKLINE>
    <small>Used in `a.py`</small>
    <BLANKLINE>
    """
    return _ROW.sub(_theorem, _HEAD.sub("", text))


def _theorem(row: re.Match[str]) -> str:
    key, author, year, says, where = (cell.strip() for cell in row.groups())
    return f"### {key} {{#{anchor(key)}}}\n\n**{author}, {year}.** {prose(says)}\n\n<small>Used in {where}</small>\n"


def command_pages() -> Iterator[SitePage]:
    """Yield the page of all commands, with their arguments and options."""
    blocks = [_command(path, command) for path, command in commands()]
    yield SitePage("reference/commands.md", rendered("commands.md", commands=blocks))


def commands() -> Iterator[tuple[str, Any]]:
    """Yield (words, command) for every command, such as ``dofkit assignment vary``."""
    yield from _below("dofkit", typer.main.get_command(app))


def _below(path: str, command: Any) -> Iterator[tuple[str, Any]]:
    for name, inner in getattr(command, "commands", {}).items():
        if getattr(inner, "commands", None) is None or inner.invoke_without_command:
            yield f"{path} {name}", inner
        yield from _below(f"{path} {name}", inner)


def _command(path: str, command: Any) -> tuple[str, str, str, list[tuple[str, str]]]:
    """Return (words, help, usage line, rows of arguments and options) of a command."""
    arguments = [p for p in command.params if p.param_type_name == "argument"]
    choices = [p for p in command.params if p.param_type_name == "option"]
    usage = " ".join([path, *(metavar_of(p) for p in arguments), *(["[OPTIONS]"] if choices else [])])
    rows = [(code(metavar_of(p)), prose(p.help or "")) for p in arguments]
    rows += [(_option(p), prose(p.help or "") + _default(p)) for p in choices]
    return path, command.help or "", usage, rows


def _option(parameter: Any) -> str:
    words = ", ".join((*parameter.opts, *parameter.secondary_opts))
    flag = parameter.is_flag or parameter.count
    return code(words if flag else f"{words} {parameter.metavar or parameter.name.upper()}")


def _default(parameter: Any) -> str:
    default = parameter.default
    return "" if default in (None, False, (), []) or callable(default) else f" Default: {code(str(default))}."


def metavar_of(parameter: Any) -> str:
    """Return the name of an argument as a usage line shows it, such as ``FILE...``."""
    name = str(parameter.metavar or parameter.name.upper())
    return f"{name}..." if parameter.nargs == -1 and not name.endswith(("...", "]")) else name
