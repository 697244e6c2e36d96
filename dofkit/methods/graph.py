"""Ranks in general position from connections only: of links by their graph, else at random places modulo a prime."""

from __future__ import annotations

from dofkit.base.verdicts import Verdict
from dofkit.classification.dependence.circuits import OwnedRows, analyse
from dofkit.exact.matrices.sparse import SparseRow
from dofkit.exact.points.field import prime_for
from dofkit.methods.table import Reply, cannot
from dofkit.mobility.general_position import in_general_position, linked_particles, unprescribed_links
from dofkit.mobility.graph.linkage import linkage
from dofkit.mobility.placement import general_placement, rows_of
from dofkit.relations.setting import Setting
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene
from dofkit.system import System

WRITTEN = "'{}' is no link and no joint: a graph says nothing of what was written as an equation, or rolls"


def _joined(scene: Scene | System) -> System | Reply:
    """Return the system, or the reply that names a constraint which is neither a link nor a joint."""
    system = scene if isinstance(scene, System) else lower(scene)
    joined = {c.constraint for c in system.connections if c.facts.placed}
    other = next((c.name for i, c in enumerate(system.constraints) if i not in joined), None)
    return system if other is None else cannot(WRITTEN.format(other))


def dof(scene: Scene | System) -> Reply:
    """Return the number of coordinates less the rank in general position."""
    system = _joined(scene)
    if isinstance(system, Reply):
        return system
    rank = in_general_position(system, (), Setting(frozenset())).rank or 0
    return Reply(len(system.coordinates) - rank, verdict=_verdict(system))


def integrability(scene: Scene | System) -> Reply:
    """Return True for all constraints, since links and joints are geometric; for others the reply that names one."""
    system = _joined(scene)
    if isinstance(system, Reply):
        return system
    return Reply({c.name: True for c in system.constraints}, verdict="proved")


def redundancy(scene: Scene | System) -> Reply:
    """Return the names of a maximal redundant set in general position."""
    system = _joined(scene)
    if isinstance(system, Reply):
        return system
    names = [c.name for c in system.constraints]
    return Reply(sorted(names[i] for i in _redundant(system)), verdict=_verdict(system))


def _verdict(system: System) -> Verdict:
    """Return the verdict; it is decided only for links with generic lengths, which are in general position."""
    pairs = unprescribed_links(system)
    return "undecided" if pairs is None else linkage([pair for _, pair in pairs], system.dimension).verdict


def _redundant(system: System) -> list[int]:
    """Return the numbers of a maximal redundant set in general position, preferring constraints written last."""
    pairs = linked_particles(system)
    if pairs is not None and len({i for i, _ in pairs}) == len(pairs):
        return [pairs[k][0] for k in linkage([pair for _, pair in pairs], system.dimension).redundant_places]
    p = prime_for()
    placement = general_placement(system, p, 0)
    rows: list[SparseRow] = []
    owners: list[int] = []
    for c, placed in zip(system.connections, placement.located, strict=True):
        reduced = [{k: int(v % p) for k, v in row.items() if v % p} for row in rows_of(placed) or []]
        rows += reduced
        owners += [c.constraint] * len(reduced)
    return analyse([OwnedRows(rows, owners, [True] * len(rows), p)]).redundant
