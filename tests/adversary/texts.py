"""Equations of a scene as text, and names within a text, replaced all at once."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

WORD = re.compile(r"[A-Za-z_]\w*")


def texts(scene: Mapping[str, Any]) -> list[str]:
    """The equations of a scene in which nothing else stands."""
    return [c if isinstance(c, str) else c["text"] for c in scene["constraints"]]


def substituted(text: str, table: Mapping[str, str]) -> str:
    """With other words for those of the table."""
    return WORD.sub(lambda found: table.get(found[0], found[0]), text)


def words(text: str) -> set[str]:
    return set(WORD.findall(text))
