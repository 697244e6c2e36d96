"""A sheet as a piece of a page: tables for light and dark, formulas as MathML, nothing fetched from a network."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape
from importlib.resources import files

from dofkit.base.display import schemes
from dofkit.expressions.text.typesetting import mathml, typeset
from dofkit.interface.show.faults import safe
from dofkit.interface.show.sheet import Content, Fact, Formula, Grid, Matrix, Remark, Sheet, SheetSection

#: What only the words of a joint or a link hold: two names with a line between them, or one of these.
_WORDS = re.compile(
    r"\b(?:on|at|driven by|length|radius|ratio|pitch|through|carried by|along)\b|^[a-z]{3,} \w+([-,]|$)"
)


def as_html(sheet: Sheet) -> str:
    """Return the whole sheet, with a picture of its scene if pictures are installed."""
    css = (files("dofkit.interface.show") / "page.css").read_text(encoding="utf-8")
    style = f"<style>{schemes('.dofkit')}\n{css}</style>"
    return "\n".join([style, '<div class="dofkit">', *_pieces(sheet), "</div>"])


def _pieces(sheet: Sheet) -> Iterator[str]:
    title = f' <span class="s">{_set(sheet.title)}</span>' if sheet.title else ""
    yield f"<p><strong>{_plain(sheet.name)}</strong>{title}</p>"
    if sheet.alarm is not None:
        text, tone = sheet.alarm
        yield f'<p class="{tone}"><strong>{_plain(text)}</strong></p>'
    picture = None if sheet.picture is None else sheet.picture()
    if picture:
        yield picture
    if sheet.facts:
        yield f"<table><tbody>{''.join(map(_fact, sheet.facts))}</tbody></table>"
    for section in sheet.sections:
        yield from _section(section)


def _fact(fact: Fact) -> str:
    value = _set(fact.value)
    if fact.note:
        value = f'<strong>{value}</strong> <span class="s">{_plain(fact.note)}</span>'
    return f'<tr><th class="q" scope="row">{_plain(fact.label)}</th><td class="{fact.tone}">{value}</td></tr>'


def _section(section: SheetSection) -> Iterator[str]:
    yield f'<b class="h">{_plain(section.heading)}</b>'
    for part in section.content:
        yield _grid(part) if isinstance(part, Grid) else _remark(part)
    if section.more:
        yield f'<p class="s">{_plain(section.more)}</p>'


def _remark(remark: Remark) -> str:
    note = f' <span class="s">({_plain(remark.note)})</span>' if remark.note else ""
    label = f"<strong>{_set(remark.label)}</strong>" if str(remark.label) else ""
    between = "" if not label else " " if remark.label == "!" else ": "
    return f"<p>{label}{between}{_set(remark.text)}{note}</p>"


def _grid(grid: Grid) -> str:
    kinds = [' class="n"' if column.numbers else "" for column in grid.columns]
    heads = (f'<th scope="col"{kind}>{_plain(c.head)}</th>' for c, kind in zip(grid.columns, kinds, strict=True))
    rows = []
    for name, *cells in grid.rows:
        text = (f"<td{kind}>{_set(cell)}</td>" for cell, kind in zip(cells, kinds[1:], strict=True))
        rows.append(f'<tr><th scope="row">{_set(name)}</th>{"".join(text)}</tr>')
    return f"<table><thead><tr>{''.join(heads)}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _set(text: Content) -> str:
    """Return a formula as mathematics, if it is one; everything else as text."""
    if isinstance(text, str):
        return _plain(text)
    formula = mathematics_of(text)
    if formula is None:
        return _plain(str(text))
    return f'<math displaystyle="true" aria-label="{_plain(str(text))}">{formula}</math>'


def mathematics_of(content: Formula | Matrix) -> str | None:
    """Return a formula or a matrix in MathML; None for words."""
    return _matrix(content) if isinstance(content, Matrix) else _formula(content.text)


def _formula(text: str) -> str | None:
    """What is written as mathematics, in MathML; None for words, such as those of a joint."""
    latex = None if _WORDS.search(text) else typeset(text)
    return None if latex is None else mathml(latex)


def _matrix(matrix: Matrix) -> str | None:
    """Rows and columns in brackets, in MathML; None where an entry is no formula."""
    rows = [[_formula(text) for text in row] for row in matrix.rows]
    if any(None in row for row in rows):
        return None
    table = "".join(f"<mtr>{''.join(f'<mtd>{cell}</mtd>' for cell in row)}</mtr>" for row in rows)
    name = f"<mi>{_plain(matrix.name)}</mi><mo>=</mo>"
    return f"{name}<mrow><mo>[</mo><mtable>{table}</mtable><mo>]</mo></mrow>"


def _plain(text: str) -> str:
    return escape(safe(text))
