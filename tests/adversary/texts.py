"""Names within a text, replaced all at once."""

from __future__ import annotations

import re
from collections.abc import Mapping

WORD = re.compile(r"[A-Za-z_]\w*")


def substituted(text: str, table: Mapping[str, str]) -> str:
    """With other words for those of the table."""
    return WORD.sub(lambda found: table.get(found[0], found[0]), text)


def words(text: str) -> set[str]:
    return set(WORD.findall(text))
