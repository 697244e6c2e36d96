"""Generalized coordinates: which of the scene's own coordinates can be chosen freely, ``dof`` of them."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from dofkit.base.deadline import expired
from dofkit.base.libraries import LateLibrary, np
from dofkit.classification.explicit_coordinates import MOST, PLAIN, QUADRATIC, explicit
from dofkit.classification.freedom.bridged_blocks import with_still_parts
from dofkit.classification.turned_coordinates import (
    ANYWHERE,
    TurnedGroup,
    chosen_at_drawing,
    partly_turned,
    rows_at_drawing,
)
from dofkit.configuration.drawing.at_reference import ball_point
from dofkit.configuration.drawing.rigid_orbit import RigidOrbit
from dofkit.configuration.finite_blocks import dependent_names
from dofkit.configuration.generic_points import field_jacobian, on_variety, pose_point
from dofkit.configuration.rigid_motions import displacements_real
from dofkit.exact.engines import BOTH
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.points.balls import FloatPoint, jacobian
from dofkit.exact.points.frames import sparse_frame
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import values
from dofkit.expressions import tree as ex
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block
from dofkit.relations.chart import Chart
from dofkit.relations.chart_of_block import make_chart
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import Setting
from dofkit.system import Rotation

if TYPE_CHECKING:
    from dofkit.configuration.local import neighbourhood
else:
    neighbourhood = LateLibrary("dofkit.configuration.local.neighbourhood")

#: How far a singular or special configuration is left to look at the set nearby, and what counts as 0 there.
AWAY, ZERO = (0.05, 0.05, 0.05, 0.05, 0.3, 0.6, 0.6, 1.0), 1e-7
#: The same where there are just as many relations as the freedom asks for: far from the origin they look nearly alike.
FAINT = 1e-10
#: The length of secants, and the least share of it that counts: the set is curved, and found to half its digits.
SECANT, SPREAD, SETTLING = 1e-4, 3e-2, 60
#: So many steps without half the error are the end: rounding, far from the origin, allows no less.
STALLED = 8
#: Powers of the error by which steps are damped: weakly first, then more.
DAMPED = (2, 1)
#: The same at a singular point, which a descent reaches to half its digits.
ROUGH = 1e-5
MAX_COLUMNS = 120


def generalized(block: Block, a: Answer, setting: Setting, rotations: Sequence[Rotation]) -> list[str] | None:
    """The free coordinates of a block; None where none could be told."""
    if a.dof is None:
        return None
    if a.dof == 0:
        return []
    own = frozenset(block.coordinates)
    turning = [r for r in rotations if r.chart == "gibbs" and not own.isdisjoint(r.names)]
    dependent = set(a.dependent if a.parts is None else _dependent_at_drawing(block, a, setting))
    direct = _regular_at_reference(block, a, setting) or [c for c in block.coordinates if c not in dependent]
    if not turning and len(direct) == a.dof:
        chosen = _explicit(block, a.dof, setting)
        return direct if chosen is None or regular_at_witness(block.coordinates, a, chosen) is False else chosen
    if setting.engines != BOTH:
        return direct if len(direct) == a.dof and not turning else None
    whole = direct if len(direct) == a.dof and not partly_turned(direct, turning) else None
    drawn = None if whole or not turning else chosen_at_drawing(TurnedGroup(block, tuple(a.hidden)), setting, turning)
    if drawn is not None and len(drawn) == a.dof:
        return drawn
    if len(block.coordinates) > MAX_COLUMNS or expired():
        return whole
    if block.forms or block.nonlinear:
        if whole or not (block.finite or a.hidden):
            return whole
        finite = Block(block.coordinates, block.finite, block.conditions)
        return _nearby(finite, a.dof, setting, turning, a.hidden)
    orbit = None if turning else orbit_at_reference(block, a, setting)
    if orbit is not None:
        return orbit.chart_of()
    block = with_still_parts(block, a, setting)
    found = _nearby(block, a.dof, setting, turning) or _rigid(block, a.dof, setting)
    return found if found is not None or turning else whole


def _dependent_at_drawing(block: Block, a: Answer, setting: Setting) -> tuple[str, ...]:
    """Coordinates that the rows at the drawing can be solved for, the last ones where there is a choice.

    Of bodies whose joints close no loop places are solved for before angles.
    """
    found = rows_at_drawing(TurnedGroup(block, ()), setting)
    if found is None:
        return ()
    own = frozenset(block.coordinates)
    places = frozenset(c.name for c in setting.roles if not a.parts and c.name in own and c.role in ("x", "y", "z"))
    names = sorted(block.coordinates, key=places.__contains__)
    place = {name: k for k, name in enumerate(names)}
    rows = [{place[name]: v for name, v in row.items()} for row in found.rows]
    return tuple(names[c] for c in sparse_frame(rows, len(place), found.p).dependent)


def orbit_at_reference(block: Block, a: Answer, setting: Setting) -> RigidOrbit | None:
    """Where a drawing is singular and yet moves as one body alone: its orbit. None elsewhere."""
    alone = a.about == "reference" and a.instantaneous != a.velocity_dof and not block.forms and not block.nonlinear
    return RigidOrbit.at_reference(make_chart(block, setting), setting, a.dof) if alone and a.dof else None


def regular_at_witness(names: Sequence[str], a: Answer, chosen: Sequence[str]) -> bool | None:
    """Have the finite relations, by the coordinates that are not chosen, their full rank at the witness?

    None where no rows are known there. What divides by a coefficient may divide by 0 on the part of the witness.
    """
    if a.real is None or a.dof is None:
        return None
    columns = [k for k, name in enumerate(a.real.names) if name in names and name not in chosen]
    return ball_part([[row[k] for k in columns] for row in a.real.matrix]).rank == len(names) - a.dof


def _regular_at_reference(block: Block, a: Answer, setting: Setting) -> list[str] | None:
    """Of a block with forms, none of which integrates: those for which its finite relations solve at the reference.

    None where there is no reference, or the relations are dependent there.
    """
    if setting.reference is None or not block.forms or "field" not in setting.engines:
        return None
    chart = make_chart(block, setting, a.hidden)
    point = pose_point(chart, {**setting.reference, ex.TIME: ex.ZERO}, 3)
    if point is None or not on_variety(chart, point):
        return None
    dependent = dependent_names(field_jacobian(chart, point), chart, point.p)
    return (
        [c for c in block.coordinates if c not in dependent]
        if len(block.coordinates) - len(dependent) == a.dof
        else None
    )


def _explicit(block: Block, dof: int, setting: Setting) -> list[str] | None:
    """Those by which the relations give all others at once: an angle rather than what it makes of lengths.

    At a reference configuration a coefficient may be 0, so that only numbers are divided by there.
    """
    if block.forms or block.nonlinear or len(block.coordinates) > MOST:
        return None
    relations = [p.expr for r in block.finite if isinstance(p := r.piece, Finite)]
    most = QUADRATIC if setting.reference is None else PLAIN
    return explicit(relations, block.coordinates, len(block.coordinates) - dof, most)


def _nearby(
    block: Block, dof: int, setting: Setting, turning: Sequence[Rotation], hidden: Sequence[Expr] = ()
) -> list[str] | None:
    """From the tangent space at a regular point near the reference, or anywhere where there is none."""
    chart = make_chart(block, setting, hidden)
    start = _start(chart, setting)
    drawn = _drawn_tangent(chart, start, setting, dof)
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.positive, chart.symbols)
    for seed, away in enumerate(AWAY):
        symbols = search.start(seed, {})
        for s, v in start.items():
            symbols[s] = v + away * (symbols[s] / 2 if s.args[0] == "coordinate" else 0)
        if search.descend(symbols, seed) is None:
            continue
        tangent = _tangent(chart, symbols, turning, setting, dof)
        if tangent.shape[0] == dof:
            chosen = None if drawn is None else _regular_columns(chart, tangent, drawn, turning)
            chosen = _columns(chart, tangent) if chosen is None else chosen
            return chosen if len(chosen) == dof else None
        regular = len(chart.nodes) == len(block.coordinates) - dof
        secants = None if regular or tangent.shape[0] < dof else _secants(chart, search, symbols, dof)
        if secants is not None:
            chosen = _columns(chart, _in_angles(chart, symbols, secants, turning), SPREAD)
            return chosen if len(chosen) == dof else None
    return None


def _drawn_tangent(chart: Chart, start: dict[Expr, float], setting: Setting, dof: int) -> Any:
    """The tangent space at the reference over the chart's own coordinates; None where the set is not regular there."""
    if not start:
        return None
    tangent = _tangent(chart, start, (), setting, dof)
    return tangent if tangent.shape[0] == dof else None


def _regular_columns(chart: Chart, near: Any, drawn: Any, turning: Sequence[Rotation]) -> list[str] | None:
    """The first coordinates on which the tangent space projects regularly nearby and at the reference.

    The angles of a body that turns are no coordinates where it is drawn; a body some of whose angles are chosen stands
    there with all of its Gibbs vector. None where there is no such choice.
    """
    names = [str(s.args[1]) for s in chart.symbols if s != ex.TIME]
    whose = {name: k for k, r in enumerate(turning) for name in r.names}
    chosen: list[int] = []
    for c in range(len(names)):
        lengths = [i for i in (*chosen, c) if names[i] not in whose]
        if _rank(near, [*chosen, c]) > len(chosen) and _rank(drawn, lengths) == len(lengths):
            chosen.append(c)
    turned = {whose[names[i]] for i in chosen if names[i] in whose}
    standing = [i for i, n in enumerate(names) if whose.get(n) in turned or (i in chosen and n not in whose)]
    complete = len(chosen) == len(near) and _rank(drawn, standing) == len(drawn)
    return [names[i] for i in chosen] if complete else None


def _rank(tangent: Any, columns: Sequence[int], least: float = ROUGH) -> int:
    return int(np.linalg.matrix_rank(tangent[:, columns], tol=least)) if columns else 0


def _secants(chart: Chart, search: RealSearch, symbols: dict[Expr, float], dof: int) -> Any:
    """The tangent space where relations are dependent all along, from short secants; what none holds is free."""
    names = [s for s in chart.symbols if s != ex.TIME]
    symbols = {**dict.fromkeys(names, 0.0), **symbols}
    found = []
    for seed in range(2 * dof + 2):
        beside, change, rng = dict(symbols), search.start(seed + len(AWAY), {}), random.Random(f"dofkit secant {seed}")
        for s in names:
            beside[s] += SECANT * change.get(s, rng.uniform(-1.0, 1.0))
        if any(_settles(search, beside, seed, power) for power in DAMPED):
            found.append([(beside[s] - symbols[s]) / SECANT for s in names])
    if not found:
        return None
    _, singular, right = np.linalg.svd(np.array(found))
    spread = int(np.sum(singular > SPREAD))
    return right[:dof] if spread == dof else None


def _settles(search: RealSearch, symbols: dict[Expr, float], seed: int, power: int) -> bool:
    """Moves ``symbols`` to the set nearby, by damped steps: where the gradients are dependent others go far away."""
    errors: list[float] = []
    for _ in range(SETTLING):
        f, j = search.float_system(symbols, seed)
        scale = np.abs(j).max(axis=1, initial=0) + 1e-300
        f, j = f / scale, j / scale[:, None]
        errors.append(float(np.max(np.abs(f))))
        if errors[-1] < 1e-15:
            return True
        if len(errors) > STALLED and min(errors[-STALLED:]) > min(errors[:-STALLED]) / 2:
            break
        for u, s in zip(search.unknowns, neighbourhood.damped(j, f, power), strict=True):
            symbols[u] += float(s)
    return errors[-1] < 1e-13


def _start(chart: Chart, setting: Setting) -> dict[Expr, float]:
    if setting.reference is None:
        return {}
    known = {**setting.reference, ex.TIME: ex.ZERO}
    point = pose_point(chart, known, 3)
    ball = None if point is None else ball_point(chart, known, point.rng)
    return {} if ball is None else {s: float(v.mid()) for s, v in ball.symbols.items()}


def _tangent(chart: Chart, symbols: dict[Expr, float], turning: Sequence[Rotation], setting: Setting, dof: int) -> Any:
    """A basis of the tangent space at fixed time over the block's coordinates, as rows.

    Lengths, angles and other coordinates are each measured in the unit in which they change the relations as much.
    """
    point = FloatPoint(symbols, 0)
    at = values(chart.ring, point)
    columns = [c for s, c in zip(chart.symbols, chart.columns, strict=True) if s != ex.TIME]
    j = np.array(jacobian(chart.ring, at, point, chart.nodes, columns, 0.0), dtype=float).reshape(-1, len(columns))
    norms = np.linalg.norm(j, axis=1, keepdims=True)
    j = j / np.where(norms > ZERO, norms, 1.0)
    for group in _groups(chart, setting):
        j[:, group] /= np.max(np.abs(j[:, group]), initial=0) or 1.0
    _, singular, right = np.linalg.svd(j)
    rank = int(np.sum(singular > ZERO))
    if len(j) == len(columns) - dof < len(columns) and singular[-1] > FAINT:
        rank = len(j)
    return _in_angles(chart, symbols, right[rank:], turning)


def _groups(chart: Chart, setting: Setting) -> list[list[int]]:
    """The columns of lengths, of angles, and of other coordinates."""
    roles = {c.name: c.role for c in setting.roles}
    kinds: dict[str, list[int]] = {}
    for i, s in enumerate(s for s in chart.symbols if s != ex.TIME):
        role = roles.get(str(s.args[1]), "free")
        kinds.setdefault("length" if role in ("x", "y", "z") else "free" if role == "free" else "angle", []).append(i)
    return list(kinds.values())


def _in_angles(chart: Chart, symbols: dict[Expr, float], basis: Any, turning: Sequence[Rotation]) -> Any:
    at = values(chart.ring, FloatPoint(symbols, 0))
    names = [str(s.args[1]) for s in chart.symbols if s != ex.TIME]
    for rotation in turning:
        basis = _euler_rates(basis, [names.index(n) for n in rotation.names if n in names], at, chart, rotation)
    return basis


def _euler_rates(basis: Any, places: Sequence[int], at: Any, chart: Chart, rotation: Rotation) -> Any:
    """The columns of a Gibbs vector g turned into those of the Euler angles (phi, theta, psi), up to a factor each.

    omega = 2 (gdot + g x gdot) / (1 + g.g) = phidot e_z + thetadot n + psidot R e_z, with n along e_z x R e_z.
    Where the body keeps its z axis upright, psi stands for the turn about it, theta and phi for tilts.
    """
    if len(places) != 3:
        return basis
    g = np.array([_value(at, chart, n) for n in rotation.names])
    cross = np.array([[0, -g[2], g[1]], [g[2], 0, -g[0]], [-g[1], g[0], 0]])
    turned = np.eye(3) + 2 * (cross + cross @ cross) / (1 + g @ g)
    phi, theta = (approximate(e) or 0.0 for e in rotation.initial[:2])
    axis = turned @ [math.sin(theta) * math.sin(phi), -math.sin(theta) * math.cos(phi), math.cos(theta)]
    axes = np.array([[0, 0, 1.0], np.cross([0, 0, 1.0], axis), axis]).T
    if abs(np.linalg.det(axes)) < ZERO:
        axes = np.array([[0, 1.0, 0], [1.0, 0, 0], [0, 0, 1.0]])
    rates = np.linalg.solve(axes, 2 * (np.eye(3) + cross) / (1 + g @ g))
    changed = basis.copy()
    changed[:, list(places)] = basis[:, list(places)] @ rates.T
    return changed


def _value(at: Any, chart: Chart, name: str) -> float:
    index = chart.ring.var_index(ex.coordinate(name))
    return ANYWHERE if index is None else float(at[chart.ring.var_node[index]])


def _rigid(block: Block, dof: int, setting: Setting) -> list[str] | None:
    """Where only motions of the whole are left: from the displacement fields at the reference."""
    chart = make_chart(block, setting)
    start = _start(chart, setting)
    if not start:
        search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.positive, chart.symbols)
        start = search.start(1, {})
        if search.descend(start, 1) is None:
            return None
    fields = displacements_real(chart, lambda i: start.get(chart.ring.vars[i].key, 0.0))
    rank = int(np.linalg.matrix_rank(fields, tol=ROUGH)) if fields.size else 0
    return _columns(chart, fields) if rank == dof else None


def _columns(chart: Chart, tangent: Any, least: float = ROUGH) -> list[str]:
    """The first coordinates, in order, on which the tangent space projects regularly, by singular values of at least
    that.
    """
    names = [str(s.args[1]) for s in chart.symbols if s != ex.TIME]
    chosen: list[int] = []
    rank = int(np.linalg.matrix_rank(tangent, tol=least))
    for c in range(len(names)):
        if len(chosen) < rank and _rank(tangent, [*chosen, c], least) > len(chosen):
            chosen.append(c)
    return [names[c] for c in chosen]
