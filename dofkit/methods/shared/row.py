"""A row of the table of methods."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from dofkit.base.verdicts import Verdict
from dofkit.exact.zero import Engines
from dofkit.methods.names import Question
from dofkit.methods.shared.reply import MethodFindings, MethodReply

if TYPE_CHECKING:
    from dofkit.system import System


@dataclass(frozen=True)
class Use:
    """How a method answers one question: what it is ``sound`` for, and what it ``costs``.

    n: coordinates, m: scalar equations, k: differential ones, each by itself where parts share no coordinate.
    """

    sound: str
    costs: str


@dataclass(frozen=True)
class Method:
    """One way to answer: in one line; by question; what it cannot answer; its best verdict; the engines it may ask.

    ``source()`` has a function for each question of ``uses``, which takes (scene, knobs) and for ``equivalence`` the
    answer; where there are no ``engines`` also ``findings(system)``, what it tells of a whole system.
    """

    summary: str
    uses: Mapping[Question, Use]
    cannot: str
    best: Verdict
    source: Callable[[], Any]
    engines: Engines = frozenset()

    def answering(self, question: Question) -> Callable[..., MethodReply] | None:
        """The function that answers a question; None where the method has none."""
        return getattr(self.source(), question) if question in self.uses else None

    def findings(self, system: System) -> MethodFindings:
        """What a method that is no engine tells of a whole system."""
        found: MethodFindings = self.source().findings(system)
        return found
