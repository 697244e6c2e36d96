"""Markdown with formulas, read into tokens and told again in the notation of a format."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import Protocol

from markdown_it import MarkdownIt
from markdown_it.token import Token
from mdit_py_plugins.dollarmath import dollarmath_plugin

from dofkit.homework.handout.formulas import formula

#: Typed text, which is left alone, or a formula.
_FORMULA = re.compile(r"```.*?```|`[^`\n]*`|\\\$|(\$\$?)([^$]+)\1", re.DOTALL)


@cache
def reader() -> MarkdownIt:
    """Reads CommonMark with tables and formulas between dollars; HTML in it is text."""
    return MarkdownIt("commonmark", {"html": False}).enable("table").use(dollarmath_plugin, allow_space=True)


def tokens_of(markdown: str) -> list[Token]:
    """The tokens of a text."""
    return reader().parse(markdown)


def within(tokens: Sequence[Token]) -> Iterator[Token]:
    """All tokens, those inside of lines too."""
    for token in tokens:
        yield token
        yield from within(token.children or [])


def unset_formulas(markdown: str) -> list[str]:
    """The formulas of a text that cannot be set."""
    found = [t.content for t in within(tokens_of(markdown)) if t.type.startswith("math_")]
    return [text.strip() for text in found if formula(text.strip()).mathml is None]


def pictures_of(markdown: str) -> list[str]:
    """The pictures that a text names."""
    return [str(t.attrs["src"]) for t in within(tokens_of(markdown)) if t.type == "image"]


def with_latex(markdown: str) -> str:
    """The same text with its formulas as LaTeX, for other readers of Markdown.

    >>> print(with_latex("the angle $theta$, typed `$theta$`"))
    the angle $\\theta$, typed `$theta$`
    """
    return _FORMULA.sub(lambda m: m[0] if m[2] is None else f"{m[1]}{formula(m[2].strip()).latex}{m[1]}", markdown)


class Notation(Protocol):
    """How a format writes what a text is made of."""

    @property
    def marks(self) -> Mapping[str, str]:
        """What stands for a token that only opens, closes or breaks."""

    def text(self, content: str) -> str:
        """Plain text."""

    def code(self, content: str, block: bool) -> str:
        """Text as it is typed."""

    def formula(self, content: str, block: bool) -> str:
        """Mathematics."""

    def picture(self, source: str, alternative: str) -> str:
        """A picture."""

    def heading(self, level: int, opens: bool) -> str:
        """The beginning or the end of a heading."""


def written(markdown: str, notation: Notation) -> str:
    """A text in a notation; links are told by their text and address."""
    return "".join(_written(tokens_of(markdown), notation))


def _written(tokens: Sequence[Token], notation: Notation) -> Iterator[str]:
    for token in tokens:
        told = _LEAVES.get(token.type)
        if token.type == "inline":
            yield from _written(token.children or [], notation)
        elif told is not None:
            yield told(token, notation)
        elif token.type in ("heading_open", "heading_close"):
            yield notation.heading(int(token.tag[1:]), token.type == "heading_open")
        elif token.type == "link_close":
            continue
        elif token.type == "link_open":
            yield notation.text(f"{token.attrs['href']} ")
        elif not (token.hidden and token.type == "paragraph_open"):
            yield notation.marks.get("line" if token.hidden else token.type, "")


_LEAVES: Mapping[str, Callable[[Token, Notation], str]] = {
    "text": lambda t, n: n.text(t.content),
    "code_inline": lambda t, n: n.code(t.content, False),
    "fence": lambda t, n: n.code(t.content, True),
    "code_block": lambda t, n: n.code(t.content, True),
    "math_inline": lambda t, n: n.formula(t.content.strip(), False),
    "math_inline_double": lambda t, n: n.formula(t.content.strip(), True),
    "math_block": lambda t, n: n.formula(t.content.strip(), True),
    "image": lambda t, n: n.picture(str(t.attrs["src"]), t.content),
}
