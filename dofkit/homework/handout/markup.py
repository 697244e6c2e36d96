"""Markdown with formulas, and its HTML page: formulas are MathML, and pictures are embedded."""

from __future__ import annotations

import json
import re
from base64 import b64encode
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from hashlib import sha256
from html import escape
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

from latex2mathml import exceptions
from markdown_it import MarkdownIt
from markdown_it.token import Token
from mdit_py_plugins.dollarmath import dollarmath_plugin

from dofkit.base.errors import DofkitError
from dofkit.base.wording import no_such
from dofkit.expressions.text.typesetting import mathml, typeset
from dofkit.homework.formats.wording import line
from dofkit.homework.problem import DRAWN, UNDRAWN, Problem
from dofkit.report import Report
from dofkit.scene.scene import Scene

_TEMPLATES = Path(__file__).parent / "templates"
#: Literal text in backquotes, which is unchanged, or a formula.
_FORMULA = re.compile(r"```.*?```|`[^`\n]*`|\\\$|(\$\$?)([^$]+)\1", re.DOTALL)
#: The errors of the converter for invalid LaTeX, and of the parser for invalid MathML.
_REFUSALS: tuple[type[Exception], ...] = (
    *(kind for kind in vars(exceptions).values() if isinstance(kind, type) and issubclass(kind, Exception)),
    ValueError, LookupError, TypeError, AttributeError, RuntimeError, ElementTree.ParseError,
)  # fmt: skip


class SetFormula(NamedTuple):
    """A formula in LaTeX, and the MathML within ``<math>``, or None if it cannot be typeset."""

    latex: str
    mathml: str | None


@lru_cache(maxsize=4096)
def formula(text: str) -> SetFormula:
    """Typeset a formula in the grammar of scenes, or in LaTeX if it contains a backslash or cannot be parsed.

    >>> formula("l^2 thetadot").latex
    'l^{2} \\\\dot{\\\\theta}'
    """
    latex = (None if "\\" in text else typeset(text)) or text
    try:
        return SetFormula(latex, _whole(mathml(latex)))
    except _REFUSALS:
        return SetFormula(text, None)


def _whole(inside: str) -> str:
    """Return MathML unchanged. Raises ValueError if a part of a fraction, a root or an index is missing."""
    for part in ElementTree.fromstring(f"<math>{inside}</math>").iter():
        if part.tag in ("mfrac", "mroot", "msub", "msup") and len(part) != 2:
            raise ValueError(inside)
    return inside


@cache
def reader() -> MarkdownIt:
    """Return the parser of CommonMark, tables and $formulas$; HTML is shown literally, links as address and text."""
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    markdown.use(dollarmath_plugin, allow_space=True, renderer=_math)
    markdown.add_render_rule("image", _image)
    markdown.add_render_rule("link_open", _link)
    markdown.add_render_rule("link_close", lambda *_: "")
    return markdown


def _math(content: str, options: Mapping[str, Any]) -> str:
    inside = formula(content.strip()).mathml
    if inside is None:
        return f"<code>{escape(content)}</code>"
    kind = "block" if options["display_mode"] else "inline"
    return f'<math display="{kind}" aria-label="{escape(line(content))}">{inside}</math>'


def _image(_: object, tokens: Sequence[Token], place: int, __: object, figures: Mapping[str, SheetFigure]) -> str:
    token = tokens[place]
    figure = figures.get(str(token.attrs["src"]))
    if figure is None:
        return escape(token.content)
    data = b64encode(figure.data).decode("ascii")
    described = re.search(rb'<desc>([^<"]+)</desc>', figure.data)  # in an SVG; what has quotes can be no attribute
    alternative = f": {described[1].decode()}" if described else ""
    return f'<img src="data:{figure.kind};base64,{data}" alt="{escape(token.content)}{alternative}">'


def _link(_: object, tokens: Sequence[Token], place: int, *__: object) -> str:
    return escape(f"{tokens[place].attrs['href']} ")


def _within(tokens: Sequence[Token]) -> Iterator[Token]:
    """Yield all tokens, also the children of tokens."""
    for token in tokens:
        yield token
        yield from _within(token.children or [])


def unset_formulas(markdown: str) -> list[str]:
    """Return the formulas of a text that cannot be typeset."""
    formulas = [t.content.strip() for t in _within(reader().parse(markdown)) if t.type.startswith("math_")]
    return [text for text in formulas if formula(text).mathml is None]


def pictures_of(markdown: str) -> list[str]:
    """Return the paths of the pictures in a text."""
    return [str(t.attrs["src"]) for t in _within(reader().parse(markdown)) if t.type == "image"]


def with_latex(markdown: str) -> str:
    """Return a text with its formulas as LaTeX, for other Markdown programs.

    >>> print(with_latex("the angle $theta$, typed `$theta$`"))
    the angle $\\theta$, typed `$theta$`
    """
    return _FORMULA.sub(lambda m: m[0] if m[2] is None else f"{m[1]}{formula(m[2].strip()).latex}{m[1]}", markdown)


def page_of(
    markdown: str, title: str, language: str, figures: Mapping[str, SheetFigure], data: Mapping[str, Any] | None = None
) -> str:
    """Return the HTML page of a text. ``figures``: {path: picture}; ``data``: for the script of a page with fields."""
    page, style, script = (
        (_TEMPLATES / name).read_text(encoding="utf-8")
        for name in ("sheet.html" if data is None else "page.html", "sheet.css", "page.js")
    )
    fields = {
        "language": language,
        "title": escape(line(title)),
        "body": reader().render(markdown, dict(figures)),
        "style": style,
        "script": script,
        "digest": f"sha256-{b64encode(sha256(script.encode()).digest()).decode()}",
        "data": json.dumps(data, ensure_ascii=False).replace("<", "\\u003c"),
    }
    return re.sub(rf"\{{\{{({'|'.join(fields)})\}}\}}", lambda place: fields[place[1]], page)


#: Draws a scene with its report and a title as SVG; None for a scene without positions.
Draw = Callable[[Scene, Report, str], str | None]
#: {file extension: media type}.
KINDS = {".svg": "image/svg+xml", ".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg"}
#: The most bytes of a picture.
MOST_BYTES = 10_000_000


class FigureError(DofkitError):
    """A file of a figure that cannot be shown."""


class SheetFigure(NamedTuple):
    """A picture: its path within the sheet's folder, and its content."""

    path: str
    data: bytes

    @property
    def kind(self) -> str:
        """The media type of the picture."""
        return KINDS[Path(self.path).suffix.lower()]


def figure_of(problem: Problem, draw_scene: Callable[[], str | None], base: Path, name: str) -> SheetFigure | None:
    """Return the picture of a problem, or None if it has none.

    ``draw_scene``: draws the scene; ``name``: the path in the sheet without extension. Raises FigureError and OSError.
    """
    if problem.figure == UNDRAWN:
        return None
    if problem.figure in (None, DRAWN):
        svg = draw_scene()
        return None if svg is None else SheetFigure(f"{name}.svg", svg.encode())
    return file_of(str(problem.figure), base, name)


def file_of(source: str, base: Path, name: str) -> SheetFigure:
    """Return the picture of a file, whose path in the sheet begins with ``name``. Raises FigureError and OSError."""
    path = base / source
    if path.suffix.lower() not in KINDS:
        raise FigureError(f"the figure '{source}': {no_such(path.suffix or source, list(KINDS), 'ending')}")
    if not path.is_file():
        raise FigureError(f"there is no figure '{source}' in {base}; name a file beside the assignment, scene or none")
    if path.stat().st_size > MOST_BYTES:
        raise FigureError(f"the figure '{source}' has more than {MOST_BYTES} bytes")
    return SheetFigure(f"{name}{path.suffix.lower()}", path.read_bytes())
