"""Faults of a file for a person: file, line, column, the line itself with a mark below, and what to do."""

from __future__ import annotations

import re

from dofkit.base.documents import Document
from dofkit.base.errors import Fault

#: More faults of a file than this are counted, not shown.
MOST_SHOWN = 20
_WIDEST = 100
_BEFORE = 60
_UNPRINTABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")


def complaint(file: str, faults: tuple[Fault, ...], document: Document | None) -> str:
    """Every fault of ``file``, with the line that it is on where ``document`` knows it."""
    blocks = [_block(file, fault, document) for fault in faults[:MOST_SHOWN]]
    more = len(faults) - MOST_SHOWN
    if more > 0:
        blocks.append(f"... and {more} more in {safe(file)}")
    return "\n".join(blocks)


def _block(file: str, fault: Fault, document: Document | None) -> str:
    place = safe(file) + (f":{fault.line}:{fault.column}" if fault.line is not None else "")
    lines = [f"{place}: error: {safe(fault.message)}"]
    if document is not None and fault.line is not None:
        lines += _marked_line(document.line(fault.line), fault.line, fault.column or 1)
    if fault.hint:
        lines.append(f"    hint: {safe(fault.hint)}")
    return "\n".join(lines)


def _marked_line(text: str, number: int, column: int) -> list[str]:
    start = max(0, column - 1 - _BEFORE) if len(text) > _WIDEST else 0
    piece = safe(text[start : start + _WIDEST])
    margin = f"{number:>5} | "
    if not piece.strip():
        return []
    caret = " " * len(str(margin[:-2])) + "| " + " " * (column - 1 - start) + "^"
    return [margin + piece, caret]


def safe(text: str) -> str:
    """``text`` on one line, without characters that a terminal would obey."""
    return _UNPRINTABLE.sub(lambda match: " " if match[0] in "\t\n\r" else "?", text)
