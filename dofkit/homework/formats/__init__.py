"""The forms in which results are written. A new one is a `Format` in a module of its own and a place in `FORMATS`."""

from __future__ import annotations

from dofkit.homework.formats.base import Format, FormatError, Target, opened
from dofkit.homework.formats.canvas import CANVAS
from dofkit.homework.formats.coursera import COURSERA
from dofkit.homework.formats.gradescope import GRADESCOPE
from dofkit.homework.formats.html import HTML
from dofkit.homework.formats.lti import LTI
from dofkit.homework.formats.moodle import MOODLE
from dofkit.homework.formats.native import NATIVE
from dofkit.homework.formats.prairielearn import PRAIRIELEARN

__all__ = ["FORMATS", "Format", "FormatError", "Target", "opened"]

#: What ``--format`` may name.
_ALL = (NATIVE, GRADESCOPE, PRAIRIELEARN, COURSERA, CANVAS, MOODLE, LTI, HTML)
FORMATS: dict[str, Format] = {f.name: f for f in _ALL}
