"""A formula of a sheet's text in the notations of the formats: LaTeX, MathML and Typst."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple
from xml.etree import ElementTree

from latex2mathml import exceptions

from dofkit.expressions.text.typesetting import mathml, typeset

_ACCENTS = {
    "˙": "dot",
    "¨": "dot.double",
    "→": "arrow",
    "^": "hat",
    "¯": "macron",
    "‾": "overline",
    "~": "tilde",
    "∼": "tilde",
}
#: What means something to Typst and stands for itself in a formula.
_SPECIAL = frozenset("#$\\/_^&~\"'`()[]{},;|*@<>:=-.+!")

#: What the converter raises for what is no LaTeX, and the parser for what is no MathML.
_REFUSALS: tuple[type[Exception], ...] = (
    *(kind for kind in vars(exceptions).values() if isinstance(kind, type) and issubclass(kind, Exception)),
    ValueError, LookupError, TypeError, AttributeError, RuntimeError, ElementTree.ParseError,
)  # fmt: skip


class SetFormula(NamedTuple):
    """A formula: ``mathml`` within ``<math>``, ``typst`` within ``$ $``; both are None where it cannot be set."""

    latex: str
    mathml: str | None
    typst: str | None


@lru_cache(maxsize=4096)
def formula(text: str) -> SetFormula:
    """A formula in the grammar of scenes, or in LaTeX where it has a backslash or is none of the grammar.

    >>> formula("l^2 thetadot").latex, formula("l^2 thetadot").typst
    ('l^{2} \\\\dot{\\\\theta}', 'attach(l, t: 2) thin dot(θ)')
    """
    latex = (None if "\\" in text else typeset(text)) or text
    try:
        inside = mathml(latex)
        return SetFormula(latex, inside, _typst(inside))
    except _REFUSALS:
        return SetFormula(text, None, None)


def _typst(inside: str) -> str:
    return _row(list(ElementTree.fromstring(f"<math>{inside}</math>")))


def _set(element: ElementTree.Element) -> str:
    """One element of MathML in Typst's mathematics."""
    parts = list(element)
    tag = element.tag
    if tag in ("mi", "mn", "mo", "mtext", "ms"):
        return _leaf(tag, element.text or "", element.get("mathvariant") == "normal")
    if tag == "mspace":
        return "thin"
    if tag == "mfrac":
        return f"frac({_set(parts[0])}, {_set(parts[1])})"
    if tag == "msqrt":
        return f"sqrt({_row(parts)})"
    if tag == "mroot":
        return f"root({_set(parts[1])}, {_set(parts[0])})"
    if tag in ("mover", "munder", "munderover", "msub", "msup", "msubsup"):
        return _attached(tag, parts)
    if tag == "mtable":
        rows = "; ".join(", ".join(_row(list(cell)) for cell in row) for row in parts)
        return f"mat(delim: #none, {rows})"
    return _row(parts)


def _row(parts: list[ElementTree.Element]) -> str:
    return " ".join(filter(None, map(_set, parts))) or '""'


def _attached(tag: str, parts: list[ElementTree.Element]) -> str:
    told = [_set(part) for part in parts]
    above = (parts[-1].text or "").strip()
    if tag == "mover" and above in _ACCENTS:
        return f"{_ACCENTS[above]}({told[0]})"
    places = {"msub": "b", "munder": "b", "msup": "t", "mover": "t", "msubsup": "bt", "munderover": "bt"}[tag]
    return f"attach({told[0]}, {', '.join(f'{p}: {t}' for p, t in zip(places, told[1:], strict=True))})"


def _leaf(tag: str, text: str, upright: bool) -> str:
    text = text.strip("\u2061") if tag != "mtext" else text.replace("\u00a0", " ")
    if not text:
        return ""
    if len(text) > 1 and tag != "mn":
        quoted = text.replace("\\", "\\\\").replace('"', '\\"')
        return f'op("{quoted}")' if tag == "mi" and text.isalpha() else f'"{quoted}"'
    if len(text) == 1 and text in _SPECIAL:
        return f"\\{text}"
    return f"upright({text})" if upright else text
