"""Where a command is among many files, on a line of standard error that goes again; nothing where nobody looks."""

from __future__ import annotations

import os
from typing import TextIO

from dofkit.interface.streams import columns, is_terminal

_ERASED = "\r\x1b[K"


class Progress:
    """One line, ``[3/147] four-bar-linkage``, for several files on a terminal."""

    def __init__(self, files: int, stream: TextIO | None) -> None:
        self._files, self._begun = files, 0
        seen = files > 1 and is_terminal(stream) and os.environ.get("TERM", "").lower() not in ("dumb", "unknown")
        self._stream = stream if seen else None

    def begin(self, file: str) -> None:
        """Show a file as the next one."""
        self._begun += 1
        if self._stream is not None:
            shown = "".join(c if c.isprintable() else "?" for c in f"[{self._begun}/{self._files}] {file}")
            self._stream.write(_ERASED + shown[: columns() - 1])
            self._stream.flush()

    def end(self) -> None:
        """Take the line away, so that what was found of the file can stand there."""
        if self._stream is not None:
            self._stream.write(_ERASED)
            self._stream.flush()
