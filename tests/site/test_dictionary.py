"""The texts and names of the package, compared with the dictionary of the glossary: one word for one thing.

A phrase that is legitimate English somewhere is let through by a row of ``ALLOWED``, with the reason.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple, get_args

import pytest
from shared.documented import DOCUMENTS, SITE, name_of
from shared.sources import PACKAGE, SOURCES, nodes_of, one_process, trees

from dofkit.base.verdicts import ArgumentKey

pytestmark = one_process
GLOSSARY = SITE / "reference" / "glossary.md"
#: The packages, whose texts are all written by the dictionary.
ROOMS = sorted(path.parent.name for path in PACKAGE.glob("*/__init__.py"))
_ROW = re.compile(r"^\| (?P<write>[^|]+) \| (?P<instead>`[^|]+) \|$", re.MULTILINE)
_COMMENT = re.compile(r"^ *#:? (.*)$", re.MULTILINE)
_CODE = re.compile(r"^```.*?^```$|`[^`]*`", re.MULTILINE | re.DOTALL)


class Allowed(NamedTuple):
    """A phrase that may stand in a package."""

    phrase: str
    room: str
    reason: str


_ANSWER = "the words of students, which are read"
_TRIAL = "the name of a trial, by which recorded runs are compared"
ALLOWED: tuple[Allowed, ...] = (
    Allowed("as drawn", "benchmark", _TRIAL),
    Allowed("can be dropped", "homework", _ANSWER),
    Allowed("finite relation", "homework", _ANSWER),
)
#: The keys of arguments are codes.
KEYS = frozenset(get_args(ArgumentKey))


def dictionary() -> dict[str, str]:
    """Return what to write, by each phrase that is to be avoided."""
    table = GLOSSARY.read_text(encoding="utf-8").partition("## How dofkit writes")[2]
    return {phrase: row["write"] for row in _ROW.finditer(table) for phrase in re.findall(r"`([^`]+)`", row["instead"])}


def documents() -> Iterator[tuple[str, str]]:
    """Yield (name, prose) of the README and every page, without code; of the glossary what precedes the dictionary."""
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        yield name_of(document), _CODE.sub("``", text.partition("## How dofkit writes")[0])


@cache
def literals() -> dict[str, list[tuple[str, str]]]:
    """Return (file, text) of every string of several words, docstring, comment and assigned name, by room."""
    texts = defaultdict[str, list[tuple[str, str]]](list)
    for name, node in nodes_of(ast.Constant):
        if isinstance(node.value, str) and " " in node.value.strip() and node.value not in KEYS:
            texts[name.partition("/")[0]].append((name, _CODE.sub("``", node.value)))
    for name, tree in trees().items():
        comments = _COMMENT.findall(SOURCES[name].read_text(encoding="utf-8"))
        names = (word.strip("_").replace("_", " ") for word in assigned(tree))
        texts[name.partition("/")[0]] += ((name, text) for text in (*comments, *names))
    return texts


def broken(texts: Iterator[tuple[str, str]]) -> Iterator[str]:
    """Yield a line for every phrase of the dictionary that occurs in the texts and is not allowed there."""
    phrases = dictionary()
    pattern = re.compile(rf"\b({'|'.join(map(re.escape, sorted(phrases, key=len, reverse=True)))})s?\b", re.IGNORECASE)
    let_through = {(allowed.phrase, allowed.room) for allowed in ALLOWED}
    for place, text in texts:
        for match in pattern.finditer(" ".join(text.split())):
            phrase = match[1].lower()
            if (phrase, place.partition("/")[0]) not in let_through:
                yield f"{place}: `{phrase}`: write `{phrases[phrase]}` ({text.strip()[:60]!r})"


def test_the_dictionary_is_read() -> None:
    phrases = dictionary()
    assert len(phrases) > 30
    assert phrases["to first order"].startswith("instantaneous freedom")
    assert not list(broken(iter([("a", "What comes\nfrom b")])))
    assert list(broken(iter([("a", "It follows\nfrom b")])))


def test_documents_are_written_by_the_dictionary() -> None:
    assert not list(broken(documents())), "\n".join(["", *broken(documents())])


@pytest.mark.parametrize("room", ROOMS)
def test_texts_of_the_package_are_written_by_the_dictionary(room: str) -> None:
    found = list(broken(iter(literals()[room])))
    assert not found, "\n".join(["", *found])


def test_exceptions_are_few_and_have_reasons() -> None:
    assert 0 < len([allowed for allowed in ALLOWED if allowed.reason]) == len(ALLOWED) <= 20


#: Words that name nothing. Two are right: the ``left`` side of a comparison, and the ``parts`` of a label question.
WORDS = "found told one own rest known given parts left shown beside again look made way thing spot"
VAGUE = frozenset(re.findall(r"\w+", WORDS))


def assigned(tree: ast.AST) -> Iterator[str]:
    """Yield every name that a module assigns: variables, loop variables, parameters, functions, classes."""
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name) | ast.FunctionDef(name=name):
                yield name
            case ast.Attribute(attr=name, ctx=ast.Store()) | ast.ClassDef(name=name):
                yield name


def test_names_that_name_nothing_become_fewer() -> None:
    vague = [name for tree in trees().values() for name in assigned(tree) if name.strip("_") in VAGUE]
    assert len(vague) <= 2, f"{len(vague)} names in {sorted(VAGUE)}: write the noun of the field instead"
