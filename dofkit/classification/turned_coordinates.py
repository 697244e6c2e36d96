"""Which Euler angles of bodies are generalized coordinates, where the engines compute with Gibbs vectors g.

omega = 2 (gdot + g x gdot) / (1 + g.g) = phidot e_z + thetadot n + psidot R e_z, with n along e_z x R e_z. So a choice
of all three components of g, or of none, is one of all three angles or of none; any other has to be translated. The
components of a Gibbs vector may be in several blocks.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from fractions import Fraction
from itertools import chain
from typing import NamedTuple

from flint import arb, arb_mat

from dofkit.base.errors import NoValueError
from dofkit.base.libraries import nx
from dofkit.configuration.at_reference import near_reference
from dofkit.configuration.variety import field_jacobian, point_at
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import sparse_frame, without_time
from dofkit.exact.points.balls import RealPoint
from dofkit.expressions import tree as ex
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Chart, make_chart
from dofkit.relations.normal.pieces import Finite, JointEquation
from dofkit.relations.setting import NamedRows, Setting
from dofkit.system import Rotation

#: The value of unconstrained components of Gibbs vectors, at which the Euler angles are not singular.
ANYWHERE = 0.3
#: Added to a float, so that the ball contains the true number.
NEARLY = arb(0, 1e-12)
#: A body counts as upright if the square of the sine of its tilt is smaller.
TILTED = 1e-7
#: Bounds on the coordinates of a group for which rows are computed at the reference, or a point is searched.
MOST_AT_REFERENCE, MOST_SEARCHED = 700, 60


class TurnedGroup(NamedTuple):
    """Blocks that contain angles of the same bodies, joined, without their forms.

    ``places``: the number of these blocks and unconstrained coordinates; ``fixed``: coordinates proved to be constant.
    """

    block: Block
    hidden: tuple[Expr, ...]
    places: int = 1
    fixed: frozenset[str] = frozenset()


def partly_turned(chosen: Collection[str], rotations: Sequence[Rotation]) -> tuple[Rotation, ...]:
    """Return the rotations of which some angles (or components of Gibbs vectors) are chosen and some are not."""
    chosen_names = frozenset(chosen)
    return tuple(r for r in rotations if r.chart == "gibbs" and 0 < len(chosen_names.intersection(r.names)) < 3)


def turned_together(
    blocks: Sequence[Block], answers: Sequence[Answer], untouched: Collection[str], rotations: Sequence[Rotation]
) -> Iterator[TurnedGroup]:
    """Yield the groups of blocks and untouched coordinates that are connected through the angles of bodies."""
    if not rotations:
        return
    graph: nx.Graph = nx.Graph()
    for i, block in enumerate(blocks):
        graph.add_edges_from((i, name) for name in block.coordinates)
    for r in rotations:
        graph.add_edges_from((r, name) for name in r.names)
    for component in nx.connected_components(graph):
        if not any(isinstance(node, Rotation) for node in component):
            continue
        members = sorted(i for i in component if isinstance(i, int))
        free = [name for name in untouched if name in component]
        names = (*(c for i in members for c in blocks[i].coordinates), *free)
        hidden = tuple(g for i in members for g in answers[i].hidden)
        rows = tuple(row for i in members for row in blocks[i].finite)
        still = chain.from_iterable(blocks[i].coordinates for i in members if _stays(answers[i]))
        zero = (p.expr for row in rows if isinstance(p := row.piece, Finite) and not isinstance(p, JointEquation))
        fixed = frozenset(still).union(*(_vanishing(e) for e in zero))
        yield TurnedGroup(Block(names, rows), hidden, len(members) + len(free), fixed)


def _vanishing(e: Expr) -> Iterator[str]:
    """Yield the coordinate x if the relation is x = 0 or -x = 0."""
    for s in e.symbols:
        if s.args[0] == "coordinate" and e in (s, ex.mul(ex.MINUS_ONE, s)):
            yield str(s.args[1])


def _stays(a: Answer) -> bool:
    """Return whether all coordinates of a block are proved to be constant."""
    return a.dof == 0 and a.verdict == "proved" and (a.about == "reference" or a.linear)


def rows_at_reference(group: TurnedGroup, setting: Setting, most: float = math.inf) -> NamedRows | None:
    """Return the rows of a group's relations at the reference; None if these are not satisfied there.

    None also if a relation is not one of a joint and there are more than ``most`` coordinates.
    """
    numbers = dict.fromkeys(row.constraint for row in group.block.rows)
    result = setting.joint_rows(numbers) if setting.joint_rows is not None and not group.hidden else None
    if result is not None and len(result.rows) == len(group.block.rows):
        return result
    if len(group.block.coordinates) > most:
        return None
    chart = make_chart(group.block, setting, group.hidden)
    point = point_at(chart, {**(setting.reference or {}), ex.TIME: ex.ZERO}, 3)
    if point is None:
        return None
    names = [str(s.args[-1]) for s in chart.symbols if s != ex.TIME]
    rows = without_time(field_jacobian(chart, point), len(names))
    return NamedRows([{names[c]: v for c, v in row.items()} for row in rows], point.p)


def chosen_at_reference(group: TurnedGroup, setting: Setting, turning: Sequence[Rotation]) -> list[str] | None:
    """Return the first coordinates whose differentials complete the rows of the relations at the reference to a basis.

    The rank is taken over GF(p): a nonzero minor there is nonzero. The rows are solved for the other coordinates, later
    ones preferred [Whitney1935]. None without a reference, for large groups, and if chosen angles are singular there or
    those of a body that is not turned by right angles.
    """
    names = group.block.coordinates
    if setting.reference is None or not any(map(_right_rates, turning)):
        return None
    result = rows_at_reference(group, setting, MOST_AT_REFERENCE)
    if result is None:
        return None
    place = {name: k for k, name in enumerate(names)}
    angle_of = {g: a for r in turning if place.keys() >= {*r.names} for a, g in _right_rates(r).items()}
    rows = [{place[angle_of.get(name, name)]: v for name, v in row.items()} for row in result.rows]
    solved = set(sparse_frame(rows, len(names), result.p).dependent)
    chosen = [name for k, name in enumerate(names) if k not in solved]
    return None if any(not _right_rates(r) for r in partly_turned(chosen, turning)) else chosen


def _right_rates(r: Rotation) -> dict[str, str]:
    """Return {Euler angle: component of the Gibbs vector with its rate}; empty unless the reference has right angles.

    The axes e_z, n = (-b, a, 0) and k = (a, b, 0) are then, up to signs, those of the world.
    """
    phi, theta = map(_right_angles, r.initial[:2])
    if phi is None or theta is None or theta % 2 == 0:
        return {}
    x, y, z = r.names
    about_x = phi % 2 == 0
    return dict(zip(r.names, (z, x, y) if about_x else (z, y, x), strict=True))


def _right_angles(e: Expr) -> int | None:
    """Return the number of right angles in an angle, modulo 4; None if it is not an integer."""
    k = round((approximate(e) or 0.0) * 2 / math.pi)
    return k % 4 if e == ex.mul(ex.num(Fraction(k, 2)), ex.PI) else None


def are_coordinates(group: TurnedGroup, chosen: Collection[str], setting: Setting, turning: Sequence[Rotation]) -> bool:
    """Return whether the chosen coordinates are a local chart at some certified configuration near the reference.

    Their differentials and the rows of the relations have full rank there: a minor's ball excludes 0.
    """
    chosen = frozenset(chosen)
    names = [name for name in group.block.coordinates if name in chosen]
    if chosen_at_reference(group, setting, turning) == names:
        return True
    if len(group.block.coordinates) > MOST_SEARCHED:
        return False
    chart = make_chart(group.block, setting, group.hidden)
    for real in near_reference(chart, len(group.block.coordinates) - len(names)):
        try:
            rows = _rows(group, chart, real, chosen, turning)
        except (NoValueError, ZeroDivisionError):
            continue
        if ball_part(rows).rank == len(group.block.coordinates):
            return True
    return False


def _rows(
    group: TurnedGroup, chart: Chart, real: RealPoint | None, chosen: Collection[str], turning: Sequence[Rotation]
) -> list[list[arb]]:
    """Return the rows of the relations and those of the chosen coordinates' rates, over the block's coordinates."""
    place = {name: k for k, name in enumerate(group.block.coordinates)}
    ranked = [s for s in chart.symbols if chart.ring.var_index(s) is not None]
    rows = []
    for entries in real.matrix if real is not None else ():
        row = [arb(0)] * len(place)
        for s, v in zip(ranked, entries, strict=True):
            if s != ex.TIME:
                row[place[str(s.args[1])]] = v
        rows.append(row)
    rates: dict[str, dict[str, arb]] = {name: {name: arb(1)} for name in place}
    for r in turning:
        if set(r.names) <= place.keys() and not set(r.names).isdisjoint(chosen):
            values = [arb(ANYWHERE) if real is None else real.point.symbols.get(ex.coordinate(n)) for n in r.names]
            upright = group.fixed.issuperset(r.names[:2]) and all(e.is_zero for e in r.initial[:2])
            solved = angle_rates([arb(ANYWHERE) if v is None else v for v in values], r, upright)
            rates |= {a: {g: solved[i, j] for j, g in enumerate(r.names)} for i, a in enumerate(r.names)}
    return [*rows, *([rates[name].get(c, arb(0)) for c in place] for name in place if name in chosen)]


def angle_rates(g: Sequence[arb], r: Rotation, upright: bool | None = None) -> arb_mat:
    """Return the matrix of the Euler angles' rates by the rates of the Gibbs vector ``g``.

    For a body that is ``upright`` (by default if it seems to be) psi is the rotation about z, and theta and phi are
    tilts; otherwise raises ZeroDivisionError if the angles are singular. The z axis of the body at the reference is
    R0 e_z = (sin theta sin phi, -sin theta cos phi, cos theta).
    """
    x, y, z = g
    phi, theta = (NEARLY + (approximate(e) or 0.0) if not e.is_zero else arb(0) for e in r.initial[:2])
    z_axis = [theta.sin() * phi.sin(), -theta.sin() * phi.cos(), theta.cos()]
    cross = arb_mat([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    identity = arb_mat([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    scale = 2 / (1 + x * x + y * y + z * z)
    axis = (identity + (cross + cross * cross) * scale) * arb_mat([[v] for v in z_axis])
    a, b, c = (axis[i, 0] for i in range(3))
    if upright is None:
        upright = bool(a * a + b * b < TILTED)
    axes = arb_mat([[0, 1, 0], [1, 0, 0], [0, 0, 1]] if upright else [[0, -b, a], [0, a, b], [1, 0, c]])
    return axes.solve((identity + cross) * scale)
