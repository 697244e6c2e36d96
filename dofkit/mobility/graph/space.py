"""Links in space: no count decides which are independent (the double banana passes Maxwell's), so ranks do.

Joints of three links or fewer are taken off, the rest is cut at single joints and its rigidity matrix eliminated at
random positions modulo a random prime. What is independent there is independent in general position: a minor that is
not 0 at a point is not 0. What depends there is proved by counting where that is possible, else tried again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from dofkit.mobility.graph.answer import Proof, Question
from dofkit.mobility.graph.core import Core, core_of
from dofkit.mobility.graph.decompose import Ends, PeeledGraph, decompose
from dofkit.mobility.graph.grouping import components
from dofkit.mobility.graph.hinged_bodies import bodies_of_core, hinged_bound, rigid_by_count
from dofkit.mobility.graph.rigid_bodies import RigidBodies
from dofkit.mobility.graph.sparse_core import Large, too_large

#: Positions that are tried for dependences that no count proves, and before a run of bad luck is given up.
TRIES = 5
_INDEPENDENT = "links are independent in general position where they are at one point modulo a prime"
_PEELED = "every joint can be taken off with at most three links, so all links are independent"


class CorePart(Protocol):
    """A core: the links that depend on those before them, in order, and what is told of them."""

    @property
    def dependent(self) -> Sequence[int]:
        """The links that those before them make superfluous."""

    @property
    def circuits(self) -> Mapping[int, list[int]]:
        """Those with the links that each depends on."""

    @property
    def chance(self) -> float:
        """A bound on the chance that one of the dependences is none; 0 where all are proved."""

    def bodies(self) -> tuple[list[list[int]], bool]:
        """Maximal sets of joints that keep all their distances, and whether each is proved to."""


class SpaceGraph:
    """A graph of links in three dimensions; see `dofkit.mobility.graph.answer.GraphAnswer`."""

    def __init__(self, joints: int, ends: Sequence[int]) -> None:
        self._joints = joints
        plain = list(map(int, ends))
        self._ends = list(zip(plain[::2], plain[1::2], strict=True))
        first: dict[frozenset[int], int] = {}
        self._original = {}
        for i, pair in enumerate(self._ends):
            original = first.setdefault(frozenset(pair), i)
            if original != i:
                self._original[i] = original
        self._piece = decompose(list(first.values()), self._ends)
        self._cores = {tuple(links): _part(links, self._ends) for links in self._piece.cores()}

    @cached_property
    def _circuits(self) -> dict[int, list[int]]:
        found = {i: circuit for part in self._cores.values() for i, circuit in part.circuits.items()}
        for i, original in self._original.items():
            found[i] = found.get(original, [original])
        return found

    @cached_property
    def redundant(self) -> list[int]:
        return sorted([*self._original, *(i for part in self._cores.values() for i in part.dependent)])

    def circuits(self, links: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
        return ((i, self._circuits[i]) for i in links)

    def groups(self) -> list[list[int]]:
        return components([i, *circuit] for i, circuit in self._circuits.items())

    @cached_property
    def _bodies(self) -> tuple[RigidBodies, bool]:
        """Rigid clusters, and whether each of them is rigid by the count of its own independent links."""
        bodies = RigidBodies()
        return bodies, self._built(self._piece, bodies)

    def _built(self, piece: PeeledGraph, bodies: RigidBodies) -> bool:
        proved = sum(not self._built(part, bodies) for part in piece.parts) == 0
        if piece.core:
            found, sure = self._cores[tuple(piece.core)].bodies()
            for body in found:
                bodies.add(body)
            proved &= sure
        for v, links in reversed(piece.peeled):
            bodies.attach(v, [sum(self._ends[i]) - v for i in links])
        return proved

    def clusters(self) -> list[list[int]]:
        return self._bodies[0].sets(self._joints)

    def proof(self, question: Question) -> Proof:
        if not self._cores:
            return Proof("proved", _PEELED)
        doubtful = [part.chance for part in self._cores.values() if part.chance]
        if doubtful:
            return Proof("probable", f"{_INDEPENDENT}; some dependences are probable, with a chance of error below "
                                     f"{sum(doubtful):.1e}")  # fmt: skip
        if question == "clusters" and not self._bodies[1]:
            return Proof(
                "probable",
                "some clusters keep their distances in random infinitesimal motions, but not because of their "
                "own links alone",
            )
        return Proof("proved", f"{_INDEPENDENT}, and more than 3n - 6 links on n joints, or hinged bodies, depend")


@dataclass(frozen=True)
class Small:
    """A core whose matrix was eliminated; see `CorePart`."""

    core: Core
    chance: float
    ends: Ends

    @property
    def dependent(self) -> Sequence[int]:
        return list(self.core.circuits)

    @property
    def circuits(self) -> Mapping[int, list[int]]:
        return self.core.circuits

    def bodies(self) -> tuple[list[list[int]], bool]:
        found = bodies_of_core(self.core)
        return found, len(found) == 1 or rigid_by_count(found, [self.ends[i] for i in self.core.links])


def _part(links: Sequence[int], ends: Ends) -> CorePart:
    if too_large(links, ends):
        return Large(links, ends)
    return Small(*_sure(links, ends), ends)


def _sure(links: Sequence[int], ends: Ends) -> tuple[Core, float]:
    """The core, and a bound on the chance that one of its dependences is none (0: all are proved)."""
    for attempt in range(TRIES):
        core = core_of(links, ends, f"core {attempt}")
        chances = [_doubt([*circuit, i], ends) for i, circuit in core.circuits.items()]
        if None not in chances:
            return core, sum(c for c in chances if c is not None)
    raise ArithmeticError("repeated random positions were not generic")


def _doubt(circuit: Sequence[int], ends: Ends) -> float | None:
    """A bound on the chance that links that depended at one random point are independent; None where they are."""
    n = len({v for i in circuit for v in ends[i]})
    if len(circuit) > 3 * n - 6:  # [Maxwell1864]
        return 0.0
    core = core_of(sorted(circuit), ends, "circuit 0")
    if not core.circuits:
        return None
    if core.rank >= hinged_bound(bodies_of_core(core)):
        return 0.0
    if any(not core_of(sorted(circuit), ends, f"circuit {k}").circuits for k in range(1, TRIES - 1)):
        return None
    return chance(len(circuit)) ** TRIES


def chance(rank: int) -> float:
    """Bound on the chance that independent links, ``rank`` of them, depend at random positions modulo a random prime.

    A minor is a polynomial of that degree [SchwartzZippel], with coefficients below 12^rank, which few of the
    268 000 primes of 23 bits divide.
    """
    return rank / 2**22 + rank * 3.6 / 22 / 268_000
