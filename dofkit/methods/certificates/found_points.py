"""Points as a certificate writes them, with floats to look with."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

#: The radius of every box.
RADIUS = "1e-30"


@dataclass
class FoundPoint:
    """A point of a certificate: ``values`` as texts, ``floats`` to look with, ``rows`` and ``columns`` of its box."""

    name: str
    values: dict[str, str]
    floats: dict[str, float]
    functions: dict[str, dict[str, Any]]
    rows: list[str] = field(default_factory=list)
    columns: list[str] = field(default_factory=list)
    rank: int = 0

    def entry(self) -> dict[str, Any]:
        """The point as a certificate writes it."""
        found: dict[str, Any] = {"id": self.name, "values": self.values}
        if self.functions:
            found["functions"] = self.functions
        if self.columns:
            found |= {"rows": self.rows, "columns": self.columns, "radius": RADIUS}
        return found
