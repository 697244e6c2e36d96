"""Who is joined to whom: ranks in general position, by the graph for links, else at random places modulo a prime."""

from __future__ import annotations

from dofkit.base.verdicts import weakest
from dofkit.base.wording import many
from dofkit.classification.dependence.circuits import OwnedRows, analyse
from dofkit.classification.freedom.preparation import prepared
from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows
from dofkit.exact.points.field import prime_for
from dofkit.methods.shared.reply import Knobs, MethodFindings, MethodReply, cannot
from dofkit.mobility.frameworks import framework_answer
from dofkit.mobility.graph.linkage import Linkage, linkage
from dofkit.mobility.placement import general_placement
from dofkit.mobility.twists import rows_of
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Row, split
from dofkit.relations.normal.pieces import Finite
from dofkit.report import Generic
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
    found = []
    for c in system.connections:
        names = [point.carrier for point in c.points]
        found += [(c.constraint, (a, b)) for i, a in enumerate(names) for b in names[i + 1 :]]
    return found


def framework(system: System, pairs: list[tuple[int, tuple[str, str]]]) -> Linkage:
    """The graph of links."""
    return linkage([pair for _, pair in pairs], system.dimension)


def generic_rows(system: System, seed: int) -> tuple[list[SparseRow], list[int], int]:
    """(rows, the constraint of each, p): every connection at random places modulo p."""
    p = prime_for(1, (), seed)
    placement = general_placement(system, p, seed)
    rows: list[SparseRow] = []
    owners: list[int] = []
    for c, found in zip(system.connections, placement.located, strict=True):
        own = [{k: int(v % p) for k, v in row.items() if v % p} for row in rows_of(found) or []]
        rows += own
        owners += [c.constraint] * len(own)
    return rows, owners, p


def rank(system: System, seed: int) -> int:
    """The rank in general position."""
    pairs = links(system)
    if pairs is not None:
        return len(pairs) - len(framework(system, pairs).redundant_places)
    rows, _, p = generic_rows(system, seed)
    return rank_of_rows(rows, p)


def dof(scene: Scene, knobs: Knobs) -> MethodReply:
    """Coordinates less the rank in general position."""
    system = lower(scene)
    why = outside(system)
    return MethodReply(len(system.coordinates) - rank(system, knobs.seed)) if why is None else cannot(why)


def integrability(scene: Scene, knobs: Knobs) -> MethodReply:
    """Links and joints are finite."""
    del knobs
    system = lower(scene)
    why = outside(system)
    return MethodReply({c.name: True for c in system.constraints}) if why is None else cannot(why)


def redundancy(scene: Scene, knobs: Knobs) -> MethodReply:
    """By the rank in general position with and without each."""
    system = lower(scene)
    why = outside(system)
    if why is not None:
        return cannot(why)
    names = [c.name for c in system.constraints]
    return MethodReply(sorted(names[i] for i in redundant(system, knobs.seed)))


def redundant(system: System, seed: int) -> list[int]:
    """The constraints that can be dropped together in general position, the last written first."""
    pairs = links(system)
    if pairs is not None and len({i for i, _ in pairs}) == len(pairs):
        return sorted(pairs[k][0] for k in framework(system, pairs).redundant_places)
    rows, owners, p = generic_rows(system, seed)
    return analyse([OwnedRows(rows, owners, [True] * len(rows), p)]).redundant


def findings(system: System) -> MethodFindings:
    """The count in general position; it is the scene's own where all lengths were left out."""
    why = outside(system)
    if why is not None:
        return MethodFindings({}, {}, [f"No answer: {why}."])
    pairs = links(system)
    gone = redundant(system, 0) if pairs is not None else []
    equations = sum(len(c.relations) for c in system.constraints)
    own = rank(system, 0)
    sure = framework(system, pairs).proof("redundant").verdict if pairs is not None else "probable"
    dof, too_many = len(system.coordinates) - own, equations - own
    names = [system.constraints[i].name for i in gone]
    said = f"In general position there are {many(dof, 'degree')} of freedom, and {many(too_many, 'equation')} too many"
    said += f" (redundant: {', '.join(names)})" if names else ""
    generic = Generic(dof=dof, redundant_equations=too_many, differs=None, verdict=sure)
    answers = general_position(system)
    if answers is None:
        more = "a graph does not show whether the given geometry is special (parallel, concurrent, collinear)."
        return MethodFindings({"generic": generic}, {}, [f"{said}; {more}"])
    verdict = weakest(*(a.verdict for a in answers))
    fields = {
        "consistent": True,
        "dof": dof,
        "velocity_dof": dof,
        "redundant_equations": too_many,
        "redundant": names,
    }
    return MethodFindings(
        fields, {}, [f"{said}; all lengths are generic, so this is the scene's own."], not too_many, verdict
    )


def general_position(system: System) -> list[Answer] | None:
    """The answers to a scene that is nothing but links of generic lengths, block by block; None for any other."""
    reduced, setting = prepared(system)
    if any(r.inequalities or len(n.branches) != 1 for r in reduced for n in r.normals):
        return None
    pieces = [(i, p) for i, r in enumerate(reduced) for n in r.normals for p in n.pieces]
    rows = [Row(i, p) for i, p in pieces if isinstance(p, Finite)]
    blocks, _ = split([c.name for c in system.coordinates], rows)
    answers = [framework_answer(b, setting) for b in blocks]
    return None if None in answers else [a for a in answers if a is not None]
