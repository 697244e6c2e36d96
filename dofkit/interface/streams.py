"""The standard streams: their columns, and their colours where a person sees them or asks for them."""

from __future__ import annotations

import os
import sys
from typing import Literal, TextIO

#: How many colours there are, in the words of rich.
Colours = Literal["standard", "256", "truecolor"]
_NARROW = 80


def colours_of(stream: TextIO | None) -> Colours | None:
    """The colours of a stream; None for none.

    ``NO_COLOR`` forbids them, ``FORCE_COLOR`` wants them in a pipe too; else a terminal has them.
    """
    if os.environ.get("NO_COLOR"):
        return None
    terminal = os.environ.get("TERM", "").lower()
    if os.environ.get("FORCE_COLOR", "0") == "0" and not (is_terminal(stream) and terminal not in ("dumb", "unknown")):
        return None
    if os.environ.get("COLORTERM", "").strip().lower() in ("truecolor", "24bit"):
        return "truecolor"
    return "256" if "256" in terminal else "standard"


def is_terminal(stream: TextIO | None) -> bool:
    """Does a person look at a stream?"""
    try:
        return stream is not None and stream.isatty()
    except ValueError:
        return False


def columns() -> int:
    """The columns of the terminal, or 80; ``COLUMNS`` says otherwise."""
    asked = os.environ.get("COLUMNS", "")
    if asked.isdigit() and int(asked) > 0:
        return int(asked)
    for number in range(3):
        try:
            return os.get_terminal_size(number).columns or _NARROW
        except OSError:
            continue
    return _NARROW


def ascii_only() -> bool:
    """Is standard output unable to show other characters?"""
    return (sys.stdout.encoding or "").lower().replace("-", "") != "utf8"
