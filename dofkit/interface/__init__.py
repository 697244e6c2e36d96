"""The command line: files in, lines and an exit status out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import lazy_loader as lazy

if TYPE_CHECKING:
    from dofkit.interface.cli import main

__all__ = ["main"]


__getattr__, __dir__, _ = lazy.attach(__name__, submod_attrs={"cli": ["main"]})
