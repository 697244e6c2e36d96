"""A sheet as a piece of a page: tables in light and dark, formulas as MathML, nothing fetched from a network."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape

from dofkit.base.display import schemes
from dofkit.expressions.text.typesetting import mathml, typeset
from dofkit.interface.show.faults import safe
from dofkit.interface.show.sheet import Fact, Grid, Matrix, Remark, Sheet, SheetSection, Told

#: What only the words of a joint or a link hold: two names with a line between them, or one of these.
_WORDS = re.compile(
    r"\b(?:on|at|driven by|length|radius|ratio|pitch|through|carried by|along)\b|^[a-z]{3,} \w+([-,]|$)"
)
#: Each colour is given for light and for dark.
_STYLE = (
    f"<style>{schemes('.dofkit')}"
    + """
.dofkit{--ink:light-dark(#1b1f24,#e6edf3);--quiet:light-dark(#59636e,#9198a1);--line:light-dark(#d1d9e0,#3d444d);
--good:light-dark(#116329,#56d364);--care:light-dark(#7d4e00,#e3b341);--bad:light-dark(#a40e26,#ff7b72);
--paper:light-dark(#fff,#151b23);
color:var(--ink);background:var(--paper);font:14px/1.5 system-ui,sans-serif;max-width:60em;padding:.6em .9em;
border:1px solid var(--line);border-radius:6px;overflow-x:auto}
.dofkit.dofkit table{border-collapse:collapse;border:0;margin:.2em 0 .4em;font:inherit;color:inherit;width:auto}
.dofkit.dofkit tr{background:none!important}
.dofkit.dofkit td,.dofkit.dofkit th{border:0;background:none;padding:.12em 1em .12em 0;text-align:left;
vertical-align:baseline;font-size:inherit;color:inherit;white-space:normal;max-width:none}
.dofkit.dofkit thead th{border-bottom:1px solid var(--line);color:var(--quiet);font-weight:400}
.dofkit.dofkit .n{text-align:right}.dofkit.dofkit tbody th{font-weight:600}
.dofkit .q,.dofkit.dofkit tbody th.q{color:var(--quiet);font-weight:400;white-space:nowrap}
.dofkit .s{color:var(--quiet)}.dofkit.dofkit .good{color:var(--good)}.dofkit.dofkit .care{color:var(--care)}
.dofkit.dofkit .bad{color:var(--bad)}.dofkit b.h{display:block;margin-top:.5em;color:var(--quiet);font-weight:600}
.dofkit p{margin:.15em 0}
.dofkit math{font:1.1em "Latin Modern Math","STIX Two Math","Cambria Math",math}
.dofkit svg{max-width:100%;height:auto;border-radius:4px}
</style>"""
)


def as_html(sheet: Sheet) -> str:
    """The whole sheet, with a picture of its scene where pictures are installed."""
    return "\n".join([_STYLE, '<div class="dofkit">', *_parts(sheet), "</div>"])


def _parts(sheet: Sheet) -> Iterator[str]:
    title = f' <span class="s">{_set(sheet.title)}</span>' if sheet.title else ""
    yield f"<p><strong>{_plain(sheet.name)}</strong>{title}</p>"
    if sheet.alarm is not None:
        told, tone = sheet.alarm
        yield f'<p class="{tone}"><strong>{_plain(told)}</strong></p>'
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
    for part in section.parts:
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
        told = (f"<td{kind}>{_set(cell)}</td>" for cell, kind in zip(cells, kinds[1:], strict=True))
        rows.append(f'<tr><th scope="row">{_set(name)}</th>{"".join(told)}</tr>')
    return f"<table><thead><tr>{''.join(heads)}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _set(told: Told) -> str:
    """A formula as mathematics where it is one; everything else as text."""
    if isinstance(told, str):
        return _plain(told)
    formula = _matrix(told) if isinstance(told, Matrix) else _formula(told.text)
    if formula is None:
        return _plain(str(told))
    return f'<math displaystyle="true" aria-label="{_plain(str(told))}">{formula}</math>'


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
