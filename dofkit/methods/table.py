"""The table of the methods (`methods.yaml`), with what each is sound for.

``auto``, ``field`` and ``balls`` share the exact steps (reading, and rewriting a relation to its real zero set in the
canonical ring) and differ in the arithmetic that decides ranks, zeros and integrability. Each other method takes the
equations as written, and has a module of its name with a function for each question.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Any, Literal, NamedTuple, get_args

from dofkit.base.documents import package_table
from dofkit.base.verdicts import Verdict
from dofkit.exact.zero import BALLS, BOTH, FIELD, Engines

MethodName = Literal["auto", "count", "graph", "field", "balls", "exact", "numeric", "symbolic"]
Question = Literal["dof", "integrability", "redundancy", "equivalence"]
METHODS: tuple[MethodName, ...] = get_args(MethodName)
QUESTIONS: tuple[Question, ...] = get_args(Question)


class Use(NamedTuple):
    """How a method answers one question: what it is ``sound`` for, and what it ``costs``.

    In the costs, n is the number of coordinates, m of scalar equations, k of differential equations.
    """

    sound: str
    costs: str


class Method(NamedTuple):
    """A method: its best verdict, a sentence about what it cannot answer, and its use by question."""

    best: Verdict
    cannot: str
    uses: Mapping[Question, Use]


#: The methods that are dofkit's engines; every other method has a module of its own.
ENGINES: Mapping[MethodName, Engines] = {"auto": BOTH, "field": FIELD, "balls": BALLS}


@cache
def methods() -> Mapping[MethodName, Method]:
    """Return {name: method}."""
    return {
        name: Method(row["best"], row["cannot"], {question: Use(**use) for question, use in row["uses"].items()})
        for name, row in package_table(__package__, "methods.yaml").items()
    }


def function_of(method: MethodName, question: Question) -> Callable[..., Reply]:
    """Return the method's function for a question; its arguments are (scene), for equivalence (scene, answer)."""
    function: Callable[..., Reply] = getattr(import_module(f"dofkit.methods.{method}"), question)
    return function


@dataclass(frozen=True)
class Reply:
    """The answer to one question about a scene.

    Attributes
    ----------
    value
        For ``dof`` a number (-1 if the constraints contradict each other); for ``integrability`` a mapping from each
        constraint to whether it is holonomic in the system (None: undecided); for ``redundancy`` the names of a maximal
        redundant set, in the scene's order; for ``equivalence`` whether the two are equivalent. None: undecided.
    verdict
        How certain the value is; for a method on its own by its own argument, and for labels only of those True.
    reason
        Why there is no value.
    cannot
        Whether a method never answers such a question, or one about such a scene.
    """

    value: Any | None
    verdict: Verdict = "undecided"
    reason: str = ""
    cannot: bool = False


#: The value of dof for constraints that contradict each other.
CONTRADICTORY = -1


def cannot(reason: str) -> Reply:
    """Return a reply without a value to a question that the method never answers for such a scene."""
    return Reply(None, reason=reason, cannot=True)
