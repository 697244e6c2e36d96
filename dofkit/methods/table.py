"""The methods, as a table (`methods.yaml`): each sound for something, none for everything but ``auto``.

``auto``, ``field`` and ``balls`` share what is exact: reading, and rewriting a relation to its real zero set in the
canonical ring; they differ in who decides ranks, zeros and integrability. All others take the equations as written.
A method is a row of the table; one that is no engine of dofkit has a module of its name, with a function for each
question.
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

    n: coordinates, m: scalar equations, k: differential ones, each by itself where parts share no coordinate.
    """

    sound: str
    costs: str


class Method(NamedTuple):
    """One way to answer: its best verdict, what it cannot answer, and its use by question."""

    best: Verdict
    cannot: str
    uses: Mapping[Question, Use]


#: The engines that a method of dofkit asks; every other method has a module of its own.
ENGINES: Mapping[MethodName, Engines] = {"auto": BOTH, "field": FIELD, "balls": BALLS}


@cache
def methods() -> Mapping[MethodName, Method]:
    """Return the methods by their names."""
    return {
        name: Method(row["best"], row["cannot"], {question: Use(**use) for question, use in row["uses"].items()})
        for name, row in package_table(__package__, "methods.yaml").items()
    }


def function_of(method: MethodName, question: Question) -> Callable[..., Reply]:
    """Return the function of a method's module for a question of its row: (scene), for equivalence the answer too.

    The module is imported where it is first asked for: some need SymPy or numpy.
    """
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
        How certain the value is; of a method on its own, by its own argument, and of labels, those that are true.
    reason
        Why there is no value.
    cannot
        Whether a method never answers such a question, or one about such a scene.
    """

    value: Any | None
    verdict: Verdict = "undecided"
    reason: str = ""
    cannot: bool = False


#: The freedom of constraints that contradict each other.
CONTRADICTORY = -1


def cannot(reason: str) -> Reply:
    """Return a reply without a value."""
    return Reply(None, reason=reason, cannot=True)
