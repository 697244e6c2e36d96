"""What is asked of a graph of links in any dimension, and how sure an answer is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple, Protocol

if TYPE_CHECKING:
    from dofkit.base.verdicts import Verdict

Question = Literal["rank", "redundant", "circuits", "redundancies", "clusters"]


class Proof(NamedTuple):
    """How sure an answer is, and the theorem or computation that makes it so."""

    verdict: Verdict
    reason: str


class GraphAnswer(Protocol):
    """A graph of links in general position. Joints and links are numbers from 0, links in the order given."""

    def __init__(self, joints: int, ends: Sequence[int]) -> None:
        """``joints`` of them; link i lies between ``ends[2 i]`` and ``ends[2 i + 1]``."""

    @property
    def redundant(self) -> list[int]:
        """The links that those before them make superfluous, ascending."""

    def circuits(self, links: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
        """Redundant links, in any order, each with the links before it that it forms a minimal dependent set with."""

    def groups(self) -> list[list[int]]:
        """Links that some minimal dependent set holds both, in order."""

    def clusters(self) -> list[list[int]]:
        """Maximal sets of joints that keep all their distances, in order; every joint is in one at least."""

    def proof(self, question: Question) -> Proof:
        """How sure an answer is."""
