"""A sheet as HTML: tables in light and dark colours, formulas as MathML, nothing loaded from a network."""

from __future__ import annotations

import re
from functools import cache
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING

from dofkit.base.display import schemes
from dofkit.expressions.text.typesetting import mathml, typeset
from dofkit.interface.show.faults import safe
from dofkit.interface.show.sheet import Content, Formula, Matrix, Sheet

if TYPE_CHECKING:
    from jinja2 import Template

#: Words that only descriptions of joints or links contain, or two names with a hyphen: such a text is no formula.
_WORDS = re.compile(
    r"\b(?:on|at|driven by|length|radius|ratio|pitch|through|carried by|along)\b|^[a-z]{3,} \w+([-,]|$)"
)


def as_html(sheet: Sheet) -> str:
    """Return the sheet as HTML with its style, and with a picture of the scene if pictures are installed."""
    css = (files(__package__) / "page.css").read_text(encoding="utf-8")
    picture = None if sheet.picture is None else sheet.picture()
    return _template().render(sheet=sheet, picture=picture, css=css, schemes=schemes(".dofkit"))


@cache
def _template() -> Template:
    from jinja2 import Environment, StrictUndefined  # only a notebook and the tests show pages

    environment = Environment(undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(plain=_plain, set=_set)
    return environment.from_string((files(__package__) / "page.html").read_text(encoding="utf-8"))


def _set(text: Content) -> str:
    """Return a cell as HTML: a formula in MathML if it can be typeset, otherwise as text."""
    if isinstance(text, str):
        return _plain(text)
    formula = mathematics_of(text)
    if formula is None:
        return _plain(str(text))
    return f'<math displaystyle="true" aria-label="{_plain(str(text))}">{formula}</math>'


def mathematics_of(content: Formula | Matrix) -> str | None:
    """Return a formula or a matrix in MathML, or None for words."""
    return _matrix(content) if isinstance(content, Matrix) else _formula(content.text)


def _formula(text: str) -> str | None:
    """Return a formula in MathML, or None for words such as the description of a joint."""
    latex = None if _WORDS.search(text) else typeset(text)
    return None if latex is None else mathml(latex)


def _matrix(matrix: Matrix) -> str | None:
    """Return ``name = [rows]`` in MathML, or None if an entry is not a formula."""
    rows = [[_formula(text) for text in row] for row in matrix.rows]
    if any(None in row for row in rows):
        return None
    table = "".join(f"<mtr>{''.join(f'<mtd>{cell}</mtd>' for cell in row)}</mtr>" for row in rows)
    name = f"<mi>{_plain(matrix.name)}</mi><mo>=</mo>"
    return f"{name}<mrow><mo>[</mo><mtable>{table}</mtable><mo>]</mo></mrow>"


def _plain(text: str) -> str:
    return escape(safe(text))
