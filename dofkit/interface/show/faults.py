"""Faults of a file as lines: file, line, column, message, the line itself with a mark below, and a hint."""

from __future__ import annotations

import re
import sysconfig
import traceback
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from dofkit.base.errors import Fault

if TYPE_CHECKING:
    from dofkit.base.documents import Document

#: The most faults of a file that are shown; further ones are counted.
MOST_SHOWN = 20
_WIDEST = 100
Style = Literal["place", "error", "hint", "quiet"]
#: Terminal codes for bold, bold red, bold cyan and dim, the styles of printed reports.
_CODES: dict[Style, str] = {"place": "1", "error": "1;31", "hint": "1;36", "quiet": "2"}
_BEFORE = 60
#: The folders of code that the user did not write: dofkit, the standard library and installed packages.
_LIBRARIES = (str(Path(__file__).parents[2]), sysconfig.get_path("stdlib"), sysconfig.get_path("purelib"))
_UNPRINTABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")


def complaint(file: str, faults: tuple[Fault, ...], document: Document | None, coloured: bool = False) -> str:
    """Return the faults of ``file`` as lines, with the faulty lines of ``document`` if it is given.

    Of more than `MOST_SHOWN` faults those with the same message and hint are shown once.
    """
    paint = _painted if coloured else lambda text, style: text
    blocks, seen = [], set[str | None]()
    first = {(fault.message, fault.hint): fault for fault in reversed(faults)}
    distinct = [fault for fault in faults if len(faults) <= MOST_SHOWN or fault is first[fault.message, fault.hint]]
    for fault in distinct[:MOST_SHOWN]:
        blocks.append(_block(file, fault if fault.see not in seen else replace(fault, see=None), document, paint))
        seen.add(fault.see)
    more = len(faults) - len(distinct[:MOST_SHOWN])
    if more > 0:
        blocks.append(f"... and {more} more in {safe(file)}")
    return "\n".join(blocks)


def panel_of(error: BaseException) -> list[str]:
    """Return the lines of an error for a notebook: the user's last line in the traceback, faults and hints."""
    frames = traceback.extract_tb(error.__traceback__)
    user_lines = [frame.line for frame in frames if frame.line and not frame.filename.startswith(_LIBRARIES)]
    lines = [f"in  {user_lines[-1]}"] if user_lines else []
    faults: tuple[Fault, ...] = getattr(error, "faults", ())
    lines += [line for fault in faults[:MOST_SHOWN] for line in _fault_lines(fault)] or str(error).splitlines()
    if len(faults) > MOST_SHOWN:
        lines.append(f"... and {len(faults) - MOST_SHOWN} more")
    return [f"╭─ {type(error).__name__}", *(f"│ {line}" for line in lines), "╰─"]


def _fault_lines(fault: Fault) -> Iterator[str]:
    yield safe(f"{fault.location}: {fault.message}" if fault.location else fault.message)
    if fault.hint:
        yield f"    hint: {safe(fault.hint)}"
    if fault.see:
        yield f"    see: dofkit explain {fault.see}"


def _painted(text: str, style: Style) -> str:
    return f"\x1b[{_CODES[style]}m{text}\x1b[0m"


def _block(file: str, fault: Fault, document: Document | None, paint: Callable[[str, Style], str]) -> str:
    place = safe(file) + (f":{fault.line}:{fault.column}" if fault.line is not None else "")
    lines = [f"{paint(place, 'place')}: {paint('error', 'error')}: {safe(fault.message)}"]
    if document is not None and fault.line is not None:
        lines += _marked_line(document.line(fault.line), fault.line, fault.column or 1, paint)
    if fault.hint:
        lines.append(f"    {paint('hint', 'hint')}: {safe(fault.hint)}")
    if fault.see:
        lines.append(f"    {paint('see', 'hint')}: dofkit explain {fault.see}")
    return "\n".join(lines)


def _marked_line(text: str, number: int, column: int, paint: Callable[[str, Style], str]) -> list[str]:
    start = max(0, column - 1 - _BEFORE) if len(text) > _WIDEST else 0
    excerpt = safe(text[start : start + _WIDEST])
    margin = f"{number:>5} | "
    if not excerpt.strip():
        return []
    before = " " * (len(margin) - 2) + "| "
    caret = " " * (column - 1 - start) + paint("^", "error")
    return [paint(margin, "quiet") + excerpt, paint(before, "quiet") + caret]


def safe(text: str) -> str:
    """Return ``text`` on one line, with control characters replaced."""
    return _UNPRINTABLE.sub(lambda match: " " if match[0] in "\t\n\r" else "?", text)
