"""Which Euler angles of bodies are coordinates, where the engines compute with Gibbs vectors.

omega = 2 (gdot + g x gdot) / (1 + g.g) = phidot e_z + thetadot n + psidot R e_z, with n along e_z x R e_z. Names of
angles are only read off where all three rates are solved for; a Gibbs vector may be spread over several blocks.
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

#: A value of what nothing constrains, at which no angle is singular.
ANYWHERE = 0.3
#: What is added to a number of floating point, so that the ball holds the number meant.
NEARLY = arb(0, 1e-12)
#: The least square of the sine of a tilt at which a body does not seem to stand upright.
TILTED = 1e-7
#: Coordinates at most of what is looked at where it is drawn, and where it is searched for.
MOST_DRAWN, MOST_SEARCHED = 700, 60


class TurnedGroup(NamedTuple):
    """Blocks joined that hold the angles of bodies, forms left out; ``places``: how many they were.

    ``fixed``: the coordinates that are proved to stay as they are drawn.
    """

    block: Block
    hidden: tuple[Expr, ...]
    places: int = 1
    fixed: frozenset[str] = frozenset()


def partly_turned(chosen: Collection[str], rotations: Sequence[Rotation]) -> tuple[Rotation, ...]:
    """The rotations of which some angles are chosen and some are not: only all three stand for all three."""
    chosen_names = frozenset(chosen)
    return tuple(r for r in rotations if r.chart == "gibbs" and 0 < len(chosen_names.intersection(r.names)) < 3)


def turned_together(
    blocks: Sequence[Block], answers: Sequence[Answer], untouched: Collection[str], rotations: Sequence[Rotation]
) -> Iterator[TurnedGroup]:
    """What holds the angles of each body together, with what nothing touches."""
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
    """The coordinate that a relation says is 0, and no more; none of another relation."""
    for s in e.symbols:
        if s.args[0] == "coordinate" and e in (s, ex.mul(ex.MINUS_ONE, s)):
            yield str(s.args[1])


def _stays(a: Answer) -> bool:
    return a.dof == 0 and a.verdict == "proved" and (a.about == "reference" or a.linear)


def rows_at_drawing(group: TurnedGroup, setting: Setting, most: float = math.inf) -> NamedRows | None:
    """The rows of the relations at the reference; None where they do not hold there.

    Where not all are those of joints they are written out for at ``most`` so many coordinates.
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


def chosen_at_drawing(group: TurnedGroup, setting: Setting, turning: Sequence[Rotation]) -> list[str] | None:
    """The first coordinates whose differentials complete the rows of the relations at the reference.

    Over GF(p), where a minor that is not 0 is not 0 over the numbers either. The others are those that the rows can be
    solved for, the last ones where there is a choice [Whitney1935]. None where angles are singular there or drawn at
    others than right ones, and for what is large.
    """
    names = group.block.coordinates
    if setting.reference is None or not any(map(_right_rates, turning)):
        return None
    result = rows_at_drawing(group, setting, MOST_DRAWN)
    if result is None:
        return None
    place = {name: k for k, name in enumerate(names)}
    angle_of = {g: a for r in turning if place.keys() >= {*r.names} for a, g in _right_rates(r).items()}
    rows = [{place[angle_of.get(name, name)]: v for name, v in row.items()} for row in result.rows]
    solved = set(sparse_frame(rows, len(names), result.p).dependent)
    chosen = [name for k, name in enumerate(names) if k not in solved]
    return None if any(not _right_rates(r) for r in partly_turned(chosen, turning)) else chosen


def _right_rates(r: Rotation) -> dict[str, str]:
    """Of a body drawn at right angles the part of the Gibbs vector whose rate is each Euler angle's; else none.

    The axes e_z, n = (-b, a, 0) and k = (a, b, 0) are orthonormal: up to signs they are those of the world.
    """
    phi, theta = map(_right_angles, r.initial[:2])
    if phi is None or theta is None or theta % 2 == 0:
        return {}
    x, y, z = r.names
    about_x = phi % 2 == 0
    return dict(zip(r.names, (z, x, y) if about_x else (z, y, x), strict=True))


def _right_angles(e: Expr) -> int | None:
    """How many right angles an angle is, less whole turns; None where it is no whole number of them."""
    k = round((approximate(e) or 0.0) * 2 / math.pi)
    return k % 4 if e == ex.mul(ex.num(Fraction(k, 2)), ex.PI) else None


def are_coordinates(group: TurnedGroup, chosen: Collection[str], setting: Setting, turning: Sequence[Rotation]) -> bool:
    """Return whether the chosen coordinates are a local chart at some certified configuration near the reference.

    Their differentials and the rows of the relations have full rank there: a minor's ball excludes 0.
    """
    chosen = frozenset(chosen)
    names = [name for name in group.block.coordinates if name in chosen]
    if chosen_at_drawing(group, setting, turning) == names:
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
    """The rows of the relations and of the chosen coordinates' rates, over the block's coordinates."""
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
    """The Euler angles' rates by the rates of the Gibbs vector. Raises ZeroDivisionError where they are singular.

    Where the body keeps its z axis ``upright``, psi stands for the turn about it, theta and phi for tilts; None: where
    it seems to stand upright. Its z axis is drawn at R0 e_z = (sin theta sin phi, -sin theta cos phi, cos theta).
    """
    x, y, z = g
    phi, theta = (NEARLY + (approximate(e) or 0.0) if not e.is_zero else arb(0) for e in r.initial[:2])
    drawn = [theta.sin() * phi.sin(), -theta.sin() * phi.cos(), theta.cos()]
    cross = arb_mat([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    identity = arb_mat([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    scale = 2 / (1 + x * x + y * y + z * z)
    axis = (identity + (cross + cross * cross) * scale) * arb_mat([[v] for v in drawn])
    a, b, c = (axis[i, 0] for i in range(3))
    if upright is None:
        upright = bool(a * a + b * b < TILTED)
    axes = arb_mat([[0, 1, 0], [1, 0, 0], [0, 0, 1]] if upright else [[0, -b, a], [0, a, b], [1, 0, c]])
    return axes.solve((identity + cross) * scale)
