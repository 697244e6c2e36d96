"""Who is joined to whom: ranks in general position, by the graph for links, else at random places modulo a prime."""

from __future__ import annotations

from dofkit.base.verdicts import Verdict
from dofkit.classification.dependence.circuits import OwnedRows, analyse
from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows
from dofkit.exact.points.field import prime_for
from dofkit.methods.table import Knobs, MethodReply, cannot
from dofkit.mobility.general_position import unprescribed_links
from dofkit.mobility.graph.linkage import Linkage, linkage
from dofkit.mobility.placement import general_placement, rows_of
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene
from dofkit.system import System

WRITTEN = "'{}' is no link and no joint: a graph says nothing of what was written as an equation, or rolls"


def outside(system: System) -> str | None:
    """Why the graph does not tell of a system: what is neither a link nor a joint."""
    joined = {c.constraint for c in system.connections if c.facts.placed}
    other = next((c.name for i, c in enumerate(system.constraints) if i not in joined), None)
    return None if other is None else WRITTEN.format(other)


def links(system: System) -> list[tuple[int, tuple[str, str]]] | None:
    """The ends of every link, with its constraint, where there are only links between particles."""
    particles = set(system.particles)
    if not all(c.facts.bars and particles.issuperset(c.members) for c in system.connections):
        return None
    pairs = []
    for c in system.connections:
        names = [point.carrier for point in c.points]
        pairs += [(c.constraint, (a, b)) for i, a in enumerate(names) for b in names[i + 1 :]]
    return pairs


def framework(system: System, pairs: list[tuple[int, tuple[str, str]]]) -> Linkage:
    """The graph of links."""
    return linkage([pair for _, pair in pairs], system.dimension)


def generic_rows(system: System) -> tuple[list[SparseRow], list[int], int]:
    """(rows, the constraint of each, p): every connection at random places modulo p."""
    p = prime_for(1, (), 0)
    placement = general_placement(system, p, 0)
    rows: list[SparseRow] = []
    owners: list[int] = []
    for c, placed in zip(system.connections, placement.located, strict=True):
        reduced = [{k: int(v % p) for k, v in row.items() if v % p} for row in rows_of(placed) or []]
        rows += reduced
        owners += [c.constraint] * len(reduced)
    return rows, owners, p


def rank(system: System) -> int:
    """The rank in general position."""
    pairs = links(system)
    if pairs is not None:
        return len(pairs) - len(framework(system, pairs).redundant_places)
    rows, _, p = generic_rows(system)
    return rank_of_rows(rows, p)


def dof(scene: Scene | System, knobs: Knobs) -> MethodReply:
    """Coordinates less the rank in general position."""
    del knobs
    system = scene if isinstance(scene, System) else lower(scene)
    why = outside(system)
    if why is not None:
        return cannot(why)
    return MethodReply(len(system.coordinates) - rank(system), verdict=generic_verdict(system))


def integrability(scene: Scene | System, knobs: Knobs) -> MethodReply:
    """Links and joints are finite."""
    del knobs
    system = scene if isinstance(scene, System) else lower(scene)
    why = outside(system)
    return MethodReply({c.name: True for c in system.constraints}, verdict="proved") if why is None else cannot(why)


def redundancy(scene: Scene | System, knobs: Knobs) -> MethodReply:
    """By the rank in general position with and without each."""
    del knobs
    system = scene if isinstance(scene, System) else lower(scene)
    why = outside(system)
    if why is not None:
        return cannot(why)
    names = [c.name for c in system.constraints]
    return MethodReply(sorted(names[i] for i in redundant(system)), verdict=generic_verdict(system))


def generic_verdict(system: System) -> Verdict:
    """Return how certain the count is: it is the scene's own where all lengths were left out."""
    pairs = unprescribed_links(system)
    return "undecided" if pairs is None else framework(system, pairs).proof("redundant").verdict


def redundant(system: System) -> list[int]:
    """The constraints that can be dropped together in general position, the last written first."""
    pairs = links(system)
    if pairs is not None and len({i for i, _ in pairs}) == len(pairs):
        return sorted(pairs[k][0] for k in framework(system, pairs).redundant_places)
    rows, owners, p = generic_rows(system)
    return analyse([OwnedRows(rows, owners, [True] * len(rows), p)]).redundant
