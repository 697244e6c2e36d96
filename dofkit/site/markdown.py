"""Pieces of Markdown: escaped prose, tables, code, collapsible blocks; and the templates of pages."""

from __future__ import annotations

import base64
import re
import zlib
from collections.abc import Iterable, Sequence
from functools import cache, partial
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined

_SPECIAL = re.compile(r"([\\*_\[\]|#])")
_CODE = re.compile(r"(`+[^`]+`+)")
#: A code block in YAML that contains constraints, and so is a scene.
_SCENE = re.compile(r"^```yaml[^\n]*\n((?:(?!```)[^\n]*\n)*?constraints:(?:(?!```)[^\n]*\n)*)```$", re.MULTILINE)


class SitePage(NamedTuple):
    """A generated page or picture: its path in the folder of pages, and its text."""

    path: str
    text: str


def prose(text: str) -> str:
    """Return a text on one line, escaped for Markdown; text in backticks becomes code.

    >>> prose("``x_1`` is |a_1|")
    '`x_1` is \\\\|a\\\\_1\\\\|'
    """
    pieces = _CODE.split(" ".join(text.split()))
    return "".join(code(p.strip("`")) if p.startswith("`") else _escaped(p) for p in pieces)


def _escaped(text: str) -> str:
    return _SPECIAL.sub(r"\\\1", text).replace("<", "&lt;").replace(">", "&gt;")


def code(text: str) -> str:
    """Return a text as code within a line.

    >>> code("|A - B|")
    '`|A - B|`'
    """
    return f"`{text}`"


def fence(kind: str, text: str, title: str = "") -> str:
    """Return lines of code of a language ``kind`` as a block."""
    named = f' title="{title}"' if title else ""
    return f"```{kind}{named}\n{text.strip()}\n```"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table of cells in Markdown; a bar within code is escaped, so that it does not end the cell."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(_cell(cell) for cell in line) + " |" for line in lines)


def _cell(text: str) -> str:
    pieces = _CODE.split(text.replace("\n", " "))
    return "".join(p.replace("|", "\\|") if p.startswith("`") else p for p in pieces)


def folded(title: str, text: str) -> str:
    """Return a block that is collapsed until its title is clicked."""
    inner = "\n".join(f"    {line}" if line else "" for line in text.splitlines())
    return f'??? note "{title}"\n\n{inner}'


def picture(path: str, alternative: str) -> str:
    """Return the HTML of a picture, which is loaded when the reader scrolls to it."""
    return f'<img class="paper" src="{escape(path)}" alt="{escape(alternative)}" loading="lazy">'


def fragment(scene: str) -> str:
    """Return the URL fragment of a scene for the bench: its text, compressed.

    >>> fragment("coordinates: [x]")
    '#scene=S87PL0rJzEssSS22UoiuiAUA'
    """
    packed = zlib.compress(scene.encode(), 9, wbits=-15)
    return f"#scene={base64.urlsafe_b64encode(packed).decode().rstrip('=')}"


def bench_link(bench: str, address: str) -> str:
    """Return a link to a scene in the bench; ``bench``: its folder's relative path; ``address``: see `fragment`."""
    return f'<p><a href="{bench}/index.html{address}">Open in the bench</a></p>'


def with_bench_links(text: str, bench: str) -> str:
    """Return a page with a link to the bench below each of its scenes."""
    return _SCENE.sub(lambda block: f"{block[0]}\n\n{bench_link(bench, fragment(block[1]))}", text)


def anchor(text: str) -> str:
    """Return the anchor name of a title.

    >>> anchor("Points over GF(p)")
    'points-over-gf-p'
    """
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")


@cache
def _environment() -> Environment:
    templates = FileSystemLoader(Path(__file__).parent / "templates")
    environment = Environment(
        loader=templates, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True
    )
    environment.filters.update(prose=prose, code=code, html=partial(escape, quote=False))
    environment.globals.update(fence=fence, folded=folded, picture=picture, table=table, bench_link=bench_link)
    return environment


def rendered(template: str, **values: Any) -> str:
    """Return the text of a template, filled in with ``values``."""
    return _environment().get_template(template).render(**values)
