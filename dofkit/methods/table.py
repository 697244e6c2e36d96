"""The ways to answer how a system can move, as a table: each sound for something, none for everything but ``auto``.

``auto``, ``field`` and ``balls`` share what is exact: reading, and rewriting a relation to its real zero set in the
canonical ring; they differ in who decides ranks, zeros and integrability. All others take the equations as written.
A method is a row here; one that is no engine of dofkit has a module of its name, with a function for each question.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Literal

from dofkit.base.verdicts import Verdict
from dofkit.exact.zero import BALLS, BOTH, FIELD, Engines

MethodName = Literal["auto", "count", "graph", "field", "balls", "exact", "numeric", "symbolic"]
Question = Literal["dof", "integrability", "redundancy", "equivalence"]
QUESTIONS: tuple[Question, ...] = ("dof", "integrability", "redundancy", "equivalence")


@dataclass(frozen=True)
class Use:
    """How a method answers one question: what it is ``sound`` for, and what it ``costs``.

    n: coordinates, m: scalar equations, k: differential ones, each by itself where parts share no coordinate.
    """

    sound: str
    costs: str


@dataclass(frozen=True)
class Method:
    """One way to answer: by question; what it cannot answer; its best verdict; the engines it may ask."""

    uses: Mapping[Question, Use]
    cannot: str
    best: Verdict
    engines: Engines = frozenset()


def function_of(method: MethodName, question: Question) -> Callable[..., Reply]:
    """Return the function of a method's module for a question of its row: (scene), for equivalence the answer too.

    The module is imported where it is first asked for: some need SymPy or numpy.
    """
    function: Callable[..., Reply] = getattr(import_module(f"dofkit.methods.{method}"), question)
    return function


_BY_BLOCKS = "O(n^3) at random points, for each part that shares no coordinate with the others; trees in O(n)"

METHODS: Mapping[MethodName, Method] = {
    "auto": Method(
        {
            "dof": Use("everything that it does not call undecided", _BY_BLOCKS + "; the graph alone where it decides"),
            "integrability": Use(
                "everything that it does not call undecided", "the Lie algebra along one curve: O(n^3 k) for each part"
            ),
            "redundancy": Use("everything that it does not call undecided", _BY_BLOCKS),
            "equivalence": Use(
                "everything that it does not call undecided", "two implications, each at a few random states"
            ),
        },
        "what neither engine nor a proof decides is undecided, with the reason",
        "proved",
        BOTH,
    ),
    "count": Method(
        {
            "dof": Use(
                "independent, regular holonomic equations without differential constraints",
                "O(m): counting",
            ),
            "integrability": Use(
                "closed forms, which integrate, and holonomic equations; a form that is not closed proves nothing",
                "O(k n^2) partial derivatives",
            ),
            "redundancy": Use("that something is redundant, where the count falls short of what is free", "O(m)"),
            "equivalence": Use("texts that are the same", "O(1): comparing texts"),
        },
        "it assumes that every equation is independent and removes one freedom, does not see which equations "
        "differential constraints imply, and does not identify redundant constraints",
        "proved",
    ),
    "graph": Method(
        {
            "dof": Use("links and joints whose geometry is in general position", "almost O(n) for links in the plane"),
            "integrability": Use("links and joints, which are holonomic", "O(m)"),
            "redundancy": Use("links and joints whose geometry is in general position", "almost O(n) for links"),
        },
        "it sees which bodies are joined and not where: it does not distinguish parallel, concurrent or collinear "
        "geometry from generic geometry, and ignores written equations",
        "proved",
    ),
    "field": Method(
        {
            "dof": Use("zero, and so dependence, with a chance of an error below 10^-15 a point", _BY_BLOCKS),
            "integrability": Use(
                "zero, and so integrability; non-zero where the functions are algebraically independent",
                "the Lie algebra along one curve: O(n^3 k) for each part",
            ),
            "redundancy": Use("dependence at a generic point", _BY_BLOCKS),
            "equivalence": Use(
                "equations that are satisfied at every complex solution",
                "two implications, each at a few random states",
            ),
        },
        "it does not decide whether a real configuration exists (its numbers are those of the complex solutions) or "
        "what second-order terms imply, and does not treat measured geometry; integrals are not sought",
        "probable",
        FIELD,
    ),
    "balls": Method(
        {
            "dof": Use("independence and full rank, which are proofs", "O(n^3) at real points, in 256 bits"),
            "integrability": Use("non-holonomy, which is a proof", "O(n^3 k) in 256 bits"),
            "redundancy": Use("independence", "O(n^3) in 256 bits"),
            "equivalence": Use("that an answer is a different equation", "two implications, each at a few real states"),
        },
        "it does not recognize that equations contradict each other unless they do so as written, gives no growth "
        "vector, and takes a difference below its precision for 0; integrals are not sought",
        "proved",
        BALLS,
    ),
    "exact": Method(
        {
            "dof": Use(
                "velocities at the reference configuration; the freedom where all equations are independent there",
                "O(n^3)",
            ),
            "integrability": Use("that a form fails Frobenius' test at a regular point", "O(n^3 k) at one point"),
            "redundancy": Use("that nothing is, where all equations are independent at that point", "O(m n^2)"),
        },
        "it looks at one point, which may be special, knows rational numbers only, and neither follows a motion nor "
        "sees holonomic equations that differential ones imply",
        "proved",
    ),
    "numeric": Method(
        {
            "dof": Use("velocities at a configuration, where a clear gap separates the singular values", "O(n^3)"),
            "integrability": Use("nothing for sure: small is taken for 0", "O(n^3 k) at a few points"),
            "redundancy": Use("nothing for sure: small is taken for 0", "O(m n^3): a rank for each constraint"),
        },
        "it does not distinguish a small number from 0, an infinitesimal motion from a finite one, or the absence of a "
        "solution from a failed search",
        "numeric",
    ),
    "symbolic": Method(
        {
            "dof": Use("matrices whose zeros SymPy sees, away from the constraints' own set", "grows exponentially"),
            "integrability": Use("what SymPy simplifies to 0 for one system of forms", "grows exponentially in k"),
            "redundancy": Use("matrices whose zeros SymPy sees", "grows exponentially, once for each constraint"),
        },
        "it looks at the whole space and not at where the constraints hold, takes for non-zero what it cannot "
        "simplify, and may not end",
        "undecided",
    ),
}


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
