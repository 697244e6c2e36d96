"""The freedom in general position: of the same connections at random places instead of those of the reference.

Links between particles are counted by their graph. Everything else is a rank modulo p at random places and directions;
of relations given as formulas only a constant changes. A rank at a random point is at most the generic one, and equal
to it except with a probability of at most degree/p [SchwartzZippel].

Blocks that are graphs of links between particles are analysed by the graph. Every row is |A - B|^2 = L with its own L:
either a length that was not given, which is determined by the particles in general position, or the square of a
parameter. If the links with parameters are independent, an open set of lengths occurs in general position. The lengths
are then a regular value [Sard1942], and all configurations with them are a manifold whose dimension is the number of
coordinates minus the generic rank.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from dofkit.base.deadline import check
from dofkit.base.verdicts import Verdict
from dofkit.exact.matrices.sparse import SparseRow, last_columns, rank_of_rows
from dofkit.exact.points.field import FieldPoint, field_point, prime_for
from dofkit.exact.ring.program import gradient, none_without_value, raising_no_value, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.renaming import coordinates_in, shape_of
from dofkit.expressions.tree import Expr
from dofkit.mobility.graph.linkage import linkage
from dofkit.mobility.placement import Placement, general_placement, rows_of
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import Setting
from dofkit.system import System

#: Attempts at random points.
DRAWS = 40
Pair = tuple[str, str]
DIFFERENTIAL = "differential constraints have no general position, so no generic count is given"
ANGLES = "equations use the Euler angles of spatial bodies, which have no general position when joints are present"
NOWHERE = "the equations have no value at the random positions that were tried"


@dataclass(frozen=True)
class GenericRank:
    """The ``rank`` of the geometric equations in general position; None if it was not computed (``why``)."""

    rank: int | None
    verdict: Verdict = "undecided"
    why: str = ""


def in_general_position(system: System, rows: Sequence[Row], setting: Setting) -> GenericRank:
    """Return the rank of the geometric equations ``rows`` with random positions and directions."""
    if any(not isinstance(row.piece, Finite) for row in rows):
        return GenericRank(None, why=DIFFERENTIAL)
    pairs = linked_particles(system)
    if pairs is None:
        return _rank_of_rows(system, rows, setting)
    rank = linkage([pair for _, pair in pairs], system.dimension).rank
    return GenericRank(rank, "proved" if system.dimension < 3 else "probable")


def linked_particles(system: System) -> list[tuple[int, Pair]] | None:
    """Return the ends of every link, with its constraint; None unless every connection consists of links."""
    particles = set(system.particles)
    if not all(c.facts.bars and particles.issuperset(c.members) for c in system.connections):
        return None
    ends = ((c.constraint, [point.carrier for point in c.points]) for c in system.connections)
    return [(constraint, pair) for constraint, names in ends for pair in combinations(names, 2)]


def _rank_of_rows(system: System, finite: Sequence[Row], setting: Setting) -> GenericRank:
    """Return the rank of the connections, and of the ``finite`` rows that are formulas, at random positions.

    At random positions formulas may have a smaller rank by chance, so that with them it is probable.
    """
    written = _as_formulas(system, finite)
    if written and any(r.chart == "euler" for r in system.rotations):
        return GenericRank(None, why=ANGLES)
    for seed in range(DRAWS):
        random_rows = _at_random_places(system, written, setting, seed)
        if random_rows is None:
            continue
        placement, rows = random_rows
        for connection in placement.located:
            check()
            conditions = (rows_of(connection) or []) if connection.facts.placed else []
            rows += [{c: int(v % placement.p) for c, v in row.items() if v % placement.p} for row in conditions]
        rank = rank_of_rows(rows, placement.p)
        return GenericRank(rank, "proved" if rank == len(rows) and not written else "probable")
    return GenericRank(None, why=NOWHERE)


def _as_formulas(system: System, rows: Sequence[Row]) -> list[Row]:
    """Return the rows that are not given by a connection's geometry: equations, surfaces, profiles, strings."""
    placed = {c.constraint for c in system.connections if c.facts.placed}
    return [row for row in rows if row.constraint not in placed]


@none_without_value
def _at_random_places(
    system: System, written: Sequence[Row], setting: Setting, seed: int
) -> tuple[Placement, list[SparseRow]] | None:
    """Return (random placement, rows of the formulas ``written`` there); None if these have no value there."""
    if not written:
        return general_placement(system, prime_for(seed=seed), seed), []
    ring = Ring([row.piece.expr for row in written if isinstance(row.piece, Finite)], setting.positive)
    nodes = [ring.node(row.piece.expr) for row in written if isinstance(row.piece, Finite)]
    point = field_point([ring], seed)
    placement = general_placement(system, point.p, seed)
    for symbol, value in _values(system, placement).items():
        index = ring.var_index(symbol)
        if index is not None:
            point.set(ring.vars[index], point.number(ex.ONE.args[0]) * value)
    return placement, _slopes(system, ring, nodes, point)


def _values(system: System, placement: Placement) -> Mapping[Expr, int]:
    """Return {coordinate: its value} for the positions in a placement; spatial bodies are not rotated (g = 0)."""
    position_of = dict(placement.places)
    position_of |= {name: placement.members[name].start or () for name in system.bodies}
    positions = {ex.coordinate(n): 0 for r in system.rotations for n in r.names}
    for c in system.coordinates:
        if c.owner is not None and c.role in ("x", "y", "z"):
            positions[ex.coordinate(c.name)] = position_of[c.owner]["xyz".index(c.role)]
    return positions


@raising_no_value
def _slopes(system: System, ring: Ring, nodes: Sequence[int], point: FieldPoint) -> list[SparseRow]:
    """Return the gradients of nodes, in columns of twists: a Gibbs vector's rate at 0 is half the angular velocity."""
    at = values(ring, point)
    unit = point.number(ex.ONE.args[0])
    gibbs = {n for r in system.rotations for n in r.names}
    columns = {
        index: (k, unit / 2 if c.name in gibbs else unit)
        for k, c in enumerate(system.coordinates)
        if (index := ring.var_index(ex.coordinate(c.name))) is not None
    }
    rows = []
    for node in nodes:
        check()
        slope = gradient(ring, at, point, [(node, unit)])
        row = {columns[i][0]: int(v * columns[i][1]) for i, v in slope.items() if i in columns}
        rows.append({c: v for c, v in row.items() if v})
    return rows


# Blocks that are graphs of links

METHOD = "graph of rigid links"


def framework_answer(block: Block, setting: Setting) -> Answer | None:
    """Return the answer of a block of links in general position; None for other blocks."""
    pairs = _pairs(block, setting)
    if pairs is None:
        return None
    framework = linkage(pairs, setting.dimension)
    proof = framework.proof
    p = prime_for()
    matrix = _rows(pairs, block.coordinates, setting, p)
    dependent = set(framework.redundant_places)
    columns = last_columns([r for i, r in enumerate(matrix) if i not in dependent], len(block.coordinates), p)
    return Answer(
        dof=framework.freedom,
        velocity_dof=framework.freedom,
        verdict=proof.verdict,
        reasons=[proof.reason] if proof.verdict != "proved" else [],
        derived=(framework.rank,),
        matrix=matrix,
        modulus=p,
        supports=lambda: framework.circuit_places,
        dependent=tuple(block.coordinates[c] for c in columns),
        method=METHOD,
        argument="links in general position",
    )


def unprescribed_links(system: System) -> list[tuple[int, Pair]] | None:
    """Return (constraint, ends) of every link of a system that consists of links without given lengths; else None."""
    if system.reference is not None or system.tolerance is not None or not system.constraints:
        return None
    particles, links = frozenset(system.particles), system.links
    free = frozenset(ex.parameter(p) for p in system.generic) - system.pose.keys()
    relations = [r for c in system.constraints for r in c.relations]
    lengths = [frozenset(s for s in r.expr.symbols if s.args[0] != "coordinate") for r in relations]
    left_out = all(r.sense == "=" and len(of) == 1 and of <= free for r, of in zip(relations, lengths, strict=True))
    if not left_out or not len(set(lengths)) == len(relations) == len(links):
        return None
    joined = all(a != b and {a, b} <= particles for _, a, b in links)
    return [(i, (a, b)) for i, a, b in links] if joined else None


def _pairs(block: Block, setting: Setting) -> list[Pair] | None:
    """Return the ends of the links that the rows are; None if a row is not a link with its own length."""
    if setting.reference is not None or setting.tolerance is not None or block.conditions or not block.rows:
        return None
    of, places = _places(block.coordinates, setting)
    links_of = {i: iter(setting.links.get(i, ())) for i in {row.constraint for row in block.rows}}
    pairs, lengths = list[Pair](), set[Expr]()
    free = frozenset(setting.generic) - setting.pose.keys()  # lengths (and other geometry) that are not given
    prescribed = []
    for row in block.rows:
        pair = next(links_of[row.constraint], None)
        if pair is None or not isinstance(row.piece, Finite) or not {*pair} <= places.keys():
            return None
        length = _only(row.piece.expr, {*places[pair[0]], *places[pair[1]]})
        if length is None or length in lengths or not (length in free or _is_length(length, row, setting)):
            return None
        lengths.add(length)
        pairs.append(pair)
        prescribed += [] if length in free else [pair]
    whole = all(next(unused, None) is None for unused in links_of.values())
    if not whole or {of[c] for c in block.coordinates} != {end for pair in pairs for end in pair}:
        return None
    return None if prescribed and linkage(prescribed, setting.dimension).redundant else pairs


def _only(e: Expr, ends: set[str]) -> Expr | None:
    """Return the one symbol of ``e`` that is not a coordinate, if its coordinates are just ``ends``; else None."""
    shape = shape_of(e)
    others = [s.args[0] for s in shape.skeleton.symbols if s.args[0] != "coordinate"]
    if len(others) != 1 or coordinates_in(e) != ends:
        return None
    (name,) = {*shape.names, *shape.kept} - ends
    return ex.sym(others[0], name)


def _is_length(symbol: Expr, row: Row, setting: Setting) -> bool:
    """Return whether a link has the square of this parameter as its squared length."""
    return [d.squared for d in setting.distances.get(row.constraint, ())] == [ex.power(symbol, ex.TWO)]


def _places(coordinates: Iterable[str], setting: Setting) -> tuple[dict[str, str | None], dict[str, list[str]]]:
    """Return ({coordinate: its particle}, {particle: its coordinates, if all are in the block})."""
    owner = {c.name: c.owner for c in setting.roles if c.role in ("x", "y", "z")}
    of = {name: owner.get(name) for name in coordinates}
    columns: dict[str, list[str]] = {}
    for name, particle in of.items():
        if particle is not None:
            columns.setdefault(particle, []).append(name)
    return of, {particle: names for particle, names in columns.items() if len(names) == setting.dimension}


def _rows(pairs: Sequence[Pair], coordinates: Sequence[str], setting: Setting, p: int) -> list[SparseRow]:
    """Return the rigidity matrix at random positions modulo p."""
    number = {name: k for k, name in enumerate(coordinates)}
    _, places = _places(coordinates, setting)
    columns = {particle: [number[name] for name in names] for particle, names in places.items()}
    rng = random.Random("dofkit framework")
    at = {particle: [rng.randrange(p) for _ in names] for particle, names in columns.items()}
    rows = []
    for a, b in pairs:
        arm = [(x - y) % p for x, y in zip(at[a], at[b], strict=True)]
        row = dict(zip(columns[a], arm, strict=True)) | {c: -v % p for c, v in zip(columns[b], arm, strict=True)}
        rows.append({c: v for c, v in row.items() if v})
    return rows
