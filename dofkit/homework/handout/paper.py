"""A sheet on paper: PDF, set by Typst, which comes with its fonts and needs nothing else."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path

from dofkit.base.errors import DofkitError
from dofkit.homework.handout.formulas import formula
from dofkit.homework.handout.markup import written

_HEAD = """#set page(paper: "a4", margin: 2.2cm, numbering: "1")
#set text(font: "New Computer Modern", size: 10.5pt, lang: "{language}")
#set par(justify: true)
#set document(title: {title}, author: (), keywords: ())
#show heading: set block(above: 1.3em, below: 0.8em)
#show raw: set text(font: "DejaVu Sans Mono", size: 9pt)
"""
_SPECIAL = frozenset("\\#$*_`<>@[]~\"'/=+-.")


class TypesetterMissingError(DofkitError):
    """A PDF was asked for, and what sets it is not installed; the message says what to install."""


def escaped(text: str) -> str:
    """A text as Typst reads it back."""
    return "".join(f"\\{c}" if c in _SPECIAL else c for c in text)


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


class _Typst:
    marks: Mapping[str, str] = {
        "paragraph_close": "\n\n", "softbreak": "\n", "hardbreak": " \\\n", "hr": "\n#line(length: 100%)\n\n",
        "em_open": "#emph[", "em_close": "]", "strong_open": "#strong[", "strong_close": "]",
        "bullet_list_open": "#list(", "bullet_list_close": ")\n\n",
        "ordered_list_open": "#enum(", "ordered_list_close": ")\n\n",
        "list_item_open": "[", "list_item_close": "], ",
        "blockquote_open": "#quote(block: true)[", "blockquote_close": "]\n\n",
        "tr_close": "\\\n", "th_close": "#h(1em)", "td_close": "#h(1em)",
    }  # fmt: skip

    def text(self, content: str) -> str:
        return escaped(content)

    def code(self, content: str, block: bool) -> str:
        return f"#raw({_quoted(content.rstrip())}, block: {'true' if block else 'false'}){'' if block else '#[]'}"

    def formula(self, content: str, block: bool) -> str:
        found = formula(content)
        if found.typst is None:
            return self.code(content, block)
        return f"$ {found.typst} $\n" if block else f"${found.typst}$"

    def picture(self, source: str, alternative: str) -> str:
        return f"#align(center, image({_quoted(source)}, width: 55%, alt: {_quoted(alternative)}))"

    def heading(self, level: int, opens: bool) -> str:
        return f"#heading(level: {level})[" if opens else "]\n\n"


def typst_of(markdown: str, title: str, language: str) -> str:
    """The document in Typst's own notation."""
    return _HEAD.replace("{language}", language).replace("{title}", _quoted(title)) + written(markdown, _Typst())


def pdf_of(typst: str, pictures: Mapping[str, bytes]) -> bytes:
    """The PDF of a document, with its pictures by their names. Raises TypesetterMissingError."""
    if find_spec("typst") is None:
        raise TypesetterMissingError("a PDF needs Typst: pip install 'dofkit[handout]'")
    from typst import compile as compiled

    with tempfile.TemporaryDirectory() as folder:
        for name, data in pictures.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        source = Path(folder) / "sheet.typ"
        source.write_text(typst, encoding="utf-8")
        return bytes(compiled(source, root=Path(folder), format="pdf"))
