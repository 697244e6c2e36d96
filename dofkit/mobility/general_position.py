"""The freedom in general position: the same connections at random places, beside those of the drawing.

Links between particles are counted by their graph. Everything else is a rank modulo p at random places and
directions; relations written as texts keep what they say up to a constant. A rank at a random point is at most the
generic one, and equal to it but for a chance of degree/p [SchwartzZippel].
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from dofkit.base.deadline import check
from dofkit.base.verdicts import Verdict
from dofkit.exact.errors import NoValueError, raising_no_value
from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows
from dofkit.exact.points.field import FieldPoint, field_point, prime_for
from dofkit.exact.ring.program import gradient, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.mobility.graph.linkage import redundant_links
from dofkit.mobility.placement import Placement, general_placement
from dofkit.mobility.twists import rows_of
from dofkit.relations.blocks import Row
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import Setting
from dofkit.system import System

#: Random points that are tried.
DRAWS = 40
DIFFERENTIAL = "differential constraints have no general position, so no generic count is given"
ANGLES = "equations use the Euler angles of spatial bodies, which have no general position when joints are present"
NOWHERE = "the equations have no value at the random positions that were tried"


@dataclass(frozen=True)
class General:
    """``rank``: of the finite relations in general position; None where it was not counted, and ``why``."""

    rank: int | None
    verdict: Verdict = "undecided"
    why: str = ""


def has_geometry(system: System) -> bool:
    """Is a drawing given, and anything connected in it?"""
    return system.reference is not None and any(c.members for c in system.connections)


def in_general_position(system: System, rows: Sequence[Row], setting: Setting) -> General:
    """The rank of the finite relations ``rows`` with all given geometry random."""
    if any(not isinstance(row.piece, Finite) for row in rows):
        return General(None, why=DIFFERENTIAL)
    particles = set(system.particles)
    by_graph = "cheapest" in setting.reductions
    if by_graph and all(c.facts.bars and particles.issuperset(c.members) for c in system.connections):
        return _of_links(system)
    return _of_rows(system, rows, setting)


def _of_links(system: System) -> General:
    """Rigid links between particles, by their graph."""
    pairs = []
    for c in system.connections:
        names = [point.carrier for point in c.points]
        pairs += [(a, b) for i, a in enumerate(names) for b in names[i + 1 :]]
    verdict: Verdict = "proved" if system.dimension < 3 else "probable"
    return General(len(pairs) - len(redundant_links(pairs, system.dimension)), verdict)


def _of_rows(system: System, given: Sequence[Row], setting: Setting) -> General:
    written = _as_texts(system, given)
    if written and any(r.chart == "euler" for r in system.rotations):
        return General(None, why=ANGLES)
    for seed in range(DRAWS):
        drawn = _random_drawing(system, written, setting, seed)
        if drawn is None:
            continue
        placement, rows = drawn
        for found in placement.located:
            check()
            own = rows_of(found) or [] if found.facts.placed else []
            rows += [{c: int(v % placement.p) for c, v in row.items() if v % placement.p} for row in own]
        rank = rank_of_rows(rows, placement.p)
        return General(rank, "proved" if rank == len(rows) and not written else "probable")
    return General(None, why=NOWHERE)


def _as_texts(system: System, rows: Sequence[Row]) -> list[Row]:
    """The rows that no connection's geometry says: equations, surfaces, profiles, strings."""
    placed = {c.constraint for c in system.connections if c.facts.placed}
    return [row for row in rows if row.constraint not in placed]


def _random_drawing(
    system: System, written: Sequence[Row], setting: Setting, seed: int
) -> tuple[Placement, list[SparseRow]] | None:
    """Random places, and the rows of what is written as texts there; None where those have no value."""
    if not written:
        return general_placement(system, prime_for(1, (), seed), seed), []
    ring = Ring([row.piece.expr for row in written if isinstance(row.piece, Finite)], setting.positive)
    nodes = [ring.node(row.piece.expr) for row in written if isinstance(row.piece, Finite)]
    point = field_point([ring], seed)
    placement = general_placement(system, point.p, seed)
    for symbol, value in _values(system, placement).items():
        index = ring.var_index(symbol)
        if index is not None:
            point.set(ring.vars[index], point.number(ex.ONE.args[0]) * value)
    try:
        return placement, _slopes(system, ring, nodes, point)
    except NoValueError:
        return None


def _values(system: System, placement: Placement) -> Mapping[Expr, int]:
    """Where everything stands; spatial bodies are turned by nothing (g = 0)."""
    stands = dict(placement.places)
    stands |= {name: placement.members[name].start or () for name in system.bodies}
    found = {ex.coordinate(n): 0 for r in system.rotations for n in r.names}
    taken: dict[str, int] = {}
    for c in system.coordinates:
        if c.owner is not None and c.role in ("x", "y", "z"):
            k = taken[c.owner] = taken.get(c.owner, -1) + 1
            found[ex.coordinate(c.name)] = stands[c.owner][k]
    return found


@raising_no_value
def _slopes(system: System, ring: Ring, nodes: Sequence[int], point: FieldPoint) -> list[SparseRow]:
    """The rows by the coordinates; the rate of a body's Gibbs vector at 0 is half of its angular velocity."""
    at = values(ring, point)
    one = point.number(ex.ONE.args[0])
    gibbs = {n for r in system.rotations for n in r.names}
    columns = {
        index: (k, one / 2 if c.name in gibbs else one)
        for k, c in enumerate(system.coordinates)
        if (index := ring.var_index(ex.coordinate(c.name))) is not None
    }
    rows = []
    for node in nodes:
        check()
        slope = gradient(ring, at, point, [(node, one)])
        row = {columns[i][0]: int(v * columns[i][1]) for i, v in slope.items() if i in columns}
        rows.append({c: v for c, v in row.items() if v})
    return rows
