"""A sheet as one page of its own: formulas as MathML, pictures within it, light and dark, for a phone and for paper."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Mapping
from html import escape
from pathlib import Path

from dofkit.homework.formats.wording import line
from dofkit.homework.handout.figures import SheetFigure
from dofkit.homework.handout.formulas import formula
from dofkit.homework.handout.markup import written

_TEMPLATE = Path(__file__).parent / "templates" / "sheet.html"


class _Html:
    def __init__(self, figures: Mapping[str, SheetFigure]) -> None:
        self._figures = figures

    marks: Mapping[str, str] = {
        "paragraph_open": "<p>", "paragraph_close": "</p>\n", "softbreak": "\n", "hardbreak": "<br>\n", "hr": "<hr>\n",
        "em_open": "<em>", "em_close": "</em>", "strong_open": "<strong>", "strong_close": "</strong>",
        "bullet_list_open": "<ul>\n", "bullet_list_close": "</ul>\n", "ordered_list_open": "<ol>\n",
        "ordered_list_close": "</ol>\n", "list_item_open": "<li>", "list_item_close": "</li>\n",
        "blockquote_open": "<blockquote>", "blockquote_close": "</blockquote>\n", "table_open": "<table>\n",
        "table_close": "</table>\n", "thead_open": "<thead>", "thead_close": "</thead>\n", "tbody_open": "<tbody>",
        "tbody_close": "</tbody>\n", "tr_open": "<tr>", "tr_close": "</tr>\n", "th_open": "<th>", "th_close": "</th>",
        "td_open": "<td>", "td_close": "</td>",
    }  # fmt: skip

    def text(self, content: str) -> str:
        return escape(content)

    def code(self, content: str, block: bool) -> str:
        told = f"<code>{escape(content.rstrip())}</code>"
        return f"<pre>{told}</pre>\n" if block else told

    def formula(self, content: str, block: bool) -> str:
        found = formula(content)
        if found.mathml is None:
            return self.code(content, block)
        kind = "block" if block else "inline"
        return f'<math display="{kind}" aria-label="{escape(line(content))}">{found.mathml}</math>'

    def picture(self, source: str, alternative: str) -> str:
        figure = self._figures.get(source)
        if figure is None:
            return escape(alternative)
        data = b64encode(figure.data).decode("ascii")
        return f'<img src="data:{figure.kind};base64,{data}" alt="{escape(alternative)}">'

    def heading(self, level: int, opens: bool) -> str:
        return f"<{'' if opens else '/'}h{level}>" + ("" if opens else "\n")


def page_of(markdown: str, title: str, language: str, figures: Mapping[str, SheetFigure]) -> str:
    """The page; ``figures`` by their paths in the text. It loads nothing and runs nothing."""
    page = _TEMPLATE.read_text(encoding="utf-8")
    parts = {"language": language, "title": escape(line(title)), "body": written(markdown, _Html(figures))}
    return re.sub(r"\{\{(language|title|body)\}\}", lambda found: parts[found[1]], page)
