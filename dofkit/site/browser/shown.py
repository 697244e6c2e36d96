"""A printed sheet as JSON: texts, and formulas as `{"text", "math"}`; a page uses only known elements of the MathML."""

from __future__ import annotations

from typing import Any

from dofkit.interface.show.page import mathematics_of
from dofkit.interface.show.sheet import Content, Grid, Sheet, SheetSection


def json_of_sheet(sheet: Sheet) -> dict[str, Any]:
    """Return a printed sheet as JSON, formulas with their MathML."""
    return {
        "name": sheet.name,
        "title": json_of_content(sheet.title),
        "alarm": sheet.alarm,
        "facts": [[fact.label, json_of_content(fact.value), fact.note, fact.tone] for fact in sheet.facts],
        "sections": [_section(section) for section in sheet.sections],
    }


def _section(section: SheetSection) -> dict[str, Any]:
    lines: list[dict[str, Any]] = []
    for part in section.content:
        if isinstance(part, Grid):
            heads = [[column.head, column.numbers] for column in part.columns]
            lines.append({"heads": heads, "rows": [[json_of_content(cell) for cell in row] for row in part.rows]})
        else:
            lines.append({"label": json_of_content(part.label), "text": json_of_content(part.text), "note": part.note})
    return {"heading": section.heading, "parts": lines, "more": section.more}


def json_of_content(content: Content) -> str | dict[str, str]:
    """Return a text, or a formula with its MathML."""
    math = None if isinstance(content, str) else mathematics_of(content)
    return str(content) if math is None else {"text": str(content), "math": math}
