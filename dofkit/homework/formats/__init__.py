"""The formats of results. A new one is a `Format` in a module of its own and an entry in `FORMATS`."""

from __future__ import annotations

from dofkit.homework.formats.base import NATIVE, Format, FormatError
from dofkit.homework.formats.coursera import COURSERA
from dofkit.homework.formats.gradebooks import CANVAS, MOODLE
from dofkit.homework.formats.gradescope import GRADESCOPE
from dofkit.homework.formats.html import HTML
from dofkit.homework.formats.prairielearn import PRAIRIELEARN

__all__ = ["FORMATS", "Format", "FormatError"]

#: The values of ``--format``.
FORMATS: dict[str, Format] = {f.name: f for f in (NATIVE, GRADESCOPE, PRAIRIELEARN, COURSERA, CANVAS, MOODLE, HTML)}
