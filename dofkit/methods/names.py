"""The names of the methods, and of the questions that they are held against each other in."""

from __future__ import annotations

from typing import Literal

MethodName = Literal["auto", "count", "graph", "field", "balls", "exact", "numeric", "symbolic"]
Question = Literal["dof", "integrability", "redundancy", "equivalence"]
QUESTIONS: tuple[Question, ...] = ("dof", "integrability", "redundancy", "equivalence")
