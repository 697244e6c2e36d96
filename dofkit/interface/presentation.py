"""How what was found is told: as JSON or as text, briefly or in full, on which screen."""

from __future__ import annotations

import sys
from typing import NamedTuple

from dofkit.interface.streams import Colours, colours_of, columns


class Telling(NamedTuple):
    """How a report is told: as JSON (``ascii_only``: no other characters), in ``brief`` or in full, ``how`` sure.

    ``only``: these fields and no others; ``without``: constraints that are dropped before; ``limits``: ranges of the
    joints of models are inequalities.
    ``columns`` and ``colours`` of standard output, ``loud``: are there colours on standard error?
    """

    as_json: bool = False
    ascii_only: bool = False
    brief: bool = False
    how: bool = False
    only: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    limits: bool = False
    columns: int = 80
    colours: Colours | None = None
    loud: bool = False

    @classmethod
    def here(cls, as_json: bool, brief: bool = False, how: bool = False) -> Telling:
        """On the standard streams of this process."""
        loud = colours_of(sys.stderr) is not None
        return cls(as_json, brief=brief, how=how, columns=columns(), colours=colours_of(sys.stdout), loud=loud)
