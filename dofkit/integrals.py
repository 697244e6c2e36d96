"""placeholder"""
from __future__ import annotations

from dataclasses import dataclass

from dofkit.expr import Expr
from dofkit.normal import Pfaffian


@dataclass(frozen=True)
class Found:
    factor: str | None
    integral: str
def integrate(form: Pfaffian, positive: frozenset[Expr]) -> Found | None:
    return None
