"""Coordinates that are independent on the tangent space of a configuration space at a point near the reference."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from flint import arb

from dofkit.classification.turned_coordinates import ANYWHERE, angle_rates
from dofkit.configuration.at_reference import float_point
from dofkit.exact.matrices.dense import Pivoting, complement, damped, dot, largest, pivoted, rank, unit_rows
from dofkit.exact.points.balls import FloatPoint, jacobian
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import values
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Block, Chart, make_chart
from dofkit.relations.setting import Setting
from dofkit.system import Rotation

#: Sizes of the random displacements from the reference in successive searches, and the pivot that counts as 0.
AWAY, ZERO = (0.05, 0.05, 0.05, 0.05, 0.3, 0.6, 0.6, 1.0), 1e-7
#: The pivot that counts as 0 if the number of relations agrees with the freedom; they may look nearly dependent.
FAINT = 1e-10
#: Length of secants, relative size below which a remainder of one counts as 0 (curvature), and damped steps.
SECANT, SPREAD, SETTLING = 1e-4, 3e-2, 60
#: Powers of the error by which steps are damped: weakly first, then more.
DAMPED = (2, 1)
#: Relative size below which a remainder of tangent vectors counts as 0; singular points have half the digits.
ROUGH = 1e-5


def nearby(block: Block, dof: int, setting: Setting, turning: Sequence[Rotation]) -> list[str] | None:
    """Return ``dof`` coordinates that are independent on the tangent space at a regular point, or None.

    The point is near the reference, if there is one. ``turning``: the rotations given by Gibbs vectors.
    """
    chart = make_chart(block, setting)
    reference = chart.setting.reference
    start = {} if reference is None else float_point(chart, reference) or {}
    at_reference = None
    order = _independent(chart, start, dof).order if start else []
    if len(order) == len(block.coordinates) - dof:  # the set is regular there, and that of these relations
        chart = replace(chart, nodes=tuple(chart.nodes[k] for k in order))
        at_reference = _tangent(chart, start, (), dof)
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.setting.positive, chart.symbols)
    for seed, away in enumerate(AWAY):
        symbols = search.start(seed, {})
        for s, v in start.items():
            symbols[s] = v + away * (symbols[s] / 2 if s.args[0] == "coordinate" else 0)
        if search.descend(symbols, seed) is None:
            continue
        tangent = _tangent(chart, symbols, turning, dof)
        if len(tangent) == dof:
            chosen = None if at_reference is None else _regular_columns(chart, tangent, at_reference, turning)
            chosen = _columns(chart, tangent) if chosen is None else chosen
            return chosen if len(chosen) == dof else None
        regular = len(chart.nodes) == len(block.coordinates) - dof
        secants = None if regular or len(tangent) < dof else _secants(chart, search, symbols, dof)
        if secants is not None:
            chosen = _columns(chart, _in_angles(chart, symbols, secants, turning), SPREAD)
            return chosen if len(chosen) == dof else None
    return None


def _regular_columns(chart: Chart, near: Any, at_reference: Any, turning: Sequence[Rotation]) -> list[str] | None:
    """Return the first coordinates that are independent on the tangent spaces nearby and at the reference, or None.

    At the reference, a body with a chosen Euler angle is represented by its whole Gibbs vector, because Euler angles
    may be singular there.
    """
    names = [str(s.args[1]) for s in chart.symbols if s != ex.TIME]
    whose = {name: k for k, r in enumerate(turning) for name in r.names}
    chosen: list[int] = []
    for c in range(len(names)):
        lengths = [i for i in (*chosen, c) if names[i] not in whose]
        if _rank(near, [*chosen, c]) > len(chosen) and _rank(at_reference, lengths) == len(lengths):
            chosen.append(c)
    turned = {whose[names[i]] for i in chosen if names[i] in whose}
    columns = [i for i, n in enumerate(names) if whose.get(n) in turned or (i in chosen and n not in whose)]
    complete = len(chosen) == len(near) and _rank(at_reference, columns) == len(at_reference)
    return [names[i] for i in chosen] if complete else None


def _rank(tangent: Any, columns: Sequence[int], least: float = ROUGH) -> int:
    return rank([[row[c] for c in columns] for row in tangent], least)


def _secants(chart: Chart, search: RealSearch, symbols: dict[Expr, float], dof: int) -> Any:
    """Return a basis of the tangent space from ``dof`` independent short secants, or None.

    It is used where the relations are dependent on the whole set. Coordinates that occur in no relation are free.
    """
    names = [s for s in chart.symbols if s != ex.TIME]
    symbols = {**dict.fromkeys(names, 0.0), **symbols}
    result = []
    for seed in range(2 * dof + 2):
        rng = random.Random(f"dofkit secant {seed}")
        change = {**{s: rng.uniform(-1.0, 1.0) for s in names}, **search.start(seed + len(AWAY), {})}
        moved = dict(symbols)
        for s in names:
            moved[s] += SECANT * change[s]
        if any(_settles(search, moved, seed, power) for power in DAMPED):
            result.append([(moved[s] - symbols[s]) / SECANT for s in names])
    basis = pivoted(result, SPREAD).basis
    return basis if len(basis) == dof else None


def _settles(search: RealSearch, symbols: dict[Expr, float], seed: int, power: int) -> bool:
    """Move ``symbols`` (in place) to the set nearby by damped steps, and return whether this converges."""
    for _ in range(SETTLING):
        f, j = search.float_system(symbols, seed)
        scale = [largest(row) + 1e-300 for row in j]
        f = [v / size for v, size in zip(f, scale, strict=True)]
        j = [[v / size for v in row] for row, size in zip(j, scale, strict=True)]
        if largest(f) < 1e-15:
            return True
        for u, s in zip(search.unknowns, damped(j, f, power), strict=True):
            symbols[u] += s
    return False


def _independent(chart: Chart, symbols: dict[Expr, float], dof: int) -> Pivoting:
    """Return which relations are independent at a point, with a basis of their rows, over the block's coordinates."""
    point = FloatPoint(symbols)
    columns = [c for s, c in zip(chart.symbols, chart.columns, strict=True) if s != ex.TIME]
    rows = jacobian(chart.ring, values(chart.ring, point), point, chart.nodes, columns, 0.0)
    j = unit_rows([list(map(float, row)) for row in rows], ZERO)
    regular = len(j) == len(columns) - dof and len(pivoted(j, FAINT).order) == len(j)
    return pivoted(j, FAINT if regular else ZERO)


def _tangent(chart: Chart, symbols: dict[Expr, float], turning: Sequence[Rotation], dof: int) -> Any:
    """Return a basis of the tangent space at fixed time over the block's coordinates, as rows; angles are Euler's."""
    return _in_angles(chart, symbols, complement(_independent(chart, symbols, dof).basis, chart.coordinates), turning)


def _in_angles(chart: Chart, symbols: dict[Expr, float], basis: Any, turning: Sequence[Rotation]) -> Any:
    """Return tangent vectors with the rates of Euler angles in place of those of Gibbs vectors."""
    at = values(chart.ring, FloatPoint(symbols))
    names = [str(s.args[1]) for s in chart.symbols if s != ex.TIME]
    changed = [list(row) for row in basis]
    for rotation in turning:
        places = [names.index(n) for n in rotation.names if n in names]
        if len(places) != 3:
            continue
        gibbs = [arb(_value(at, chart, n)) for n in rotation.names]
        rates = [[float(v.mid()) for v in row] for row in angle_rates(gibbs, rotation).tolist()]
        for row in changed:
            rate = [row[place] for place in places]
            for place, of_angle in zip(places, rates, strict=True):
                row[place] = dot(of_angle, rate)
    return changed


def _value(at: Any, chart: Chart, name: str) -> float:
    index = chart.ring.var_index(ex.coordinate(name))
    return ANYWHERE if index is None else float(at[chart.ring.var_node[index]])


def _columns(chart: Chart, tangent: Any, least: float = ROUGH) -> list[str]:
    """Return the first coordinates, in order, that are independent on the tangent space up to ``least``."""
    names = [str(s.args[1]) for s in chart.symbols if s != ex.TIME]
    chosen: list[int] = []
    most = rank(tangent, least)
    for c in range(len(names)):
        if len(chosen) < most and _rank(tangent, [*chosen, c], least) > len(chosen):
            chosen.append(c)
    return [names[c] for c in chosen]
