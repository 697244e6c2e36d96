"""All of YAML, by ruamel's parser, for what the fast readers leave; imported when it is first needed."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dofkit.base.documents.yaml.events import Composer

__all__ = ["Composer"]


def __getattr__(name: str) -> Any:
    if name != "Composer":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return import_module("dofkit.base.documents.yaml.events").Composer
