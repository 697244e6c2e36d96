"""The forms in which results are written. A new one is a `Format` in a module of its own and a place in `FORMATS`."""

from __future__ import annotations

from dofkit.homework.formats.base import Format, FormatError, Target, opened
from dofkit.homework.formats.native import NATIVE

__all__ = ["FORMATS", "Format", "FormatError", "Target", "opened"]

#: What ``--format`` may name.
FORMATS: dict[str, Format] = {f.name: f for f in (NATIVE,)}
