"""What a room hands on, imported when it is first asked for: a room's own ``__init__`` imports nothing heavy."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any


def handed_on(package: str, homes: Mapping[str, str], name: str) -> Any:
    """The value of a name of a package, from the module where it lives. Raises AttributeError for any other name."""
    if name not in homes:
        raise AttributeError(f"module '{package}' has no attribute '{name}'")
    return getattr(import_module(homes[name]), name)
