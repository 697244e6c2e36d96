"""All of YAML, by ruamel's parser, for what the fast readers leave; imported when it is first needed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.base.documents.yaml.events import Composer

__all__ = ["Composer"]


def __getattr__(name: str) -> Any:
    return handed_on(__name__, {"Composer": "dofkit.base.documents.yaml.events"}, name)
