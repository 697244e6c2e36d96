"""Differential forms on a measured manifold: curved beyond what the tolerance may hide, or not decided.

The finite relations leave a manifold M of dimension m, with the tangent space T at the drawing as far as the tolerance
tells it. Forms w_1, ..., w_k that are independent on T leave D, of dimension v = m - k. Where no combination of the
matrices dw_i(X, Y) on D is 0, none of them is in the derived system, and nothing integrates; where v is 1 at most,
everything does [Frobenius1877]. Both are asked of numbers beyond what errors of the tolerance's size do to them; a
matrix that is 0 within the tolerance proves nothing.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from dofkit.base.libraries import np
from dofkit.configuration.finite_blocks import finite_answer
from dofkit.configuration.measured.equations import SLACK, ScaledEquations, float_point, independent_rows, pose_of_block
from dofkit.exact.errors import NoValueError, OutsideDomainError
from dofkit.exact.matrices.singular_values import dependency_pattern, greedy_pivots
from dofkit.exact.matrices.sparse import sparse
from dofkit.exact.points.balls import FloatPoint
from dofkit.exact.ring.program import gradient, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block, split, uses_time
from dofkit.relations.chart_of_block import make_chart
from dofkit.relations.normal.pieces import Pfaffian
from dofkit.relations.setting import Setting

#: Decimals that were measured are no exact numbers, to which a form would have to be put.
BESIDE = (
    "measured equations occur together with differential ones; whether these integrate was not decided "
    "within the tolerance"
)
CURVED = "no combination of the forms is integrable, by more than the tolerance could hide"
LINE = "at most one direction is admissible, and along it every form integrates"
#: Errors of rounding.
ROUGH = 1e-9


@dataclass(frozen=True)
class _Tangents:
    """M at the drawing, in scaled columns: the Jacobian ``j``, orthonormal ``ways`` (m x n), ``error`` of these."""

    relations: ScaledEquations
    at: Mapping[Expr, float]
    j: Any
    ways: Any
    error: float


def measured_answer(block: Block, setting: Setting) -> Answer:
    """The answer to measured relations with Pfaffian forms beside them; at best numeric."""
    parts, untouched = split(block.coordinates, block.finite)
    told = [finite_answer(part, setting) for part in parts]
    reasons = [reason for a in told for reason in a.reasons]
    left = Answer(None, verdict="undecided", reasons=[*reasons, BESIDE])
    if block.nonlinear or uses_time(block) or any(a.degenerate or a.consistent is not True for a in told):
        return left
    known = [a.dof for a in told if a.dof is not None]
    if len(known) < len(told):
        return left
    try:
        tangents = _tangents(block, setting, sum(known) + len(untouched))
        found = None if tangents is None else _of_forms(block, setting, tangents)
    except NoValueError:
        return left
    return left if tangents is None or found is None else _told(block, setting, tangents, found, reasons)


class _Forms(NamedTuple):
    """The forms as rows, the velocities they leave, and whether everything integrates."""

    rows: Any
    velocities: int
    holonomic: bool


def _told(block: Block, setting: Setting, tangents: _Tangents, found: _Forms, reasons: Sequence[str]) -> Answer:
    n, tolerance = len(block.coordinates), float(setting.tolerance or 0)
    rank = n - len(tangents.ways)
    dof = found.velocities if found.holonomic else n - rank
    labels = {
        i: HolonomyLabel(found.holonomic or not isinstance(row.piece, Pfaffian), "numeric")
        for i, row in enumerate(block.rows)
    }
    result = Answer(True, dof, found.velocities, "numeric", "reference", "singular values", labels=labels)
    result.reasons = [*reasons, LINE if found.holonomic else CURVED]
    result.method = "singular values within the tolerance at the given configuration"
    result.instantaneous = None if setting.reference is None else found.velocities
    pattern = dependency_pattern(tangents.j, independent_rows(tangents.j, rank, tolerance))
    result.matrix = [*sparse(pattern), *({rank + i: 1} for i in range(len(found.rows)))]
    result.modulus = 2
    rows = np.vstack([tangents.j, found.rows]) if found.holonomic else tangents.j
    result.dependent = tuple(block.coordinates[c] for c in greedy_pivots(rows.T, n - dof))
    return result


def _tangents(block: Block, setting: Setting, dimension: int) -> _Tangents | None:
    """M at the drawing, of a known dimension; None where that is not drawn."""
    chart = make_chart(Block(block.coordinates, block.finite, block.conditions), setting)
    drawing = pose_of_block(chart, setting)
    at = None if drawing is None else float_point(chart, drawing)
    if at is None:
        return None
    relations = ScaledEquations(chart, setting, at)
    j = relations.system(at)[1]
    _, singular, right = np.linalg.svd(j)
    rank = len(block.coordinates) - dimension
    least = float(singular[rank - 1]) if rank else 1.0
    error = SLACK * float(setting.tolerance or 0) * (1 + 1 / least) + ROUGH
    return _Tangents(relations, at, j, right[rank:], error)


def _of_forms(block: Block, setting: Setting, tangents: _Tangents) -> _Forms | None:
    """What the forms leave; None where the tolerance hides it."""
    w, slopes = _forms_at(block, setting, tangents)
    bend = 1 + max(float(np.linalg.norm(s, 2)) for s in slopes)
    on_manifold = w @ tangents.ways.T
    left, k = on_manifold.shape[1] - len(w), len(w)
    if left < 0:
        return None
    _, singular, right = np.linalg.svd(on_manifold)
    if singular[-1] <= 2 * tangents.error * bend:
        return None
    if left <= 1:
        return _Forms(w, left, holonomic=True)
    ways = right[k:] @ tangents.ways
    above = np.triu_indices(left, 1)
    curvature = np.array([(ways @ (s - s.T) @ ways.T)[above] for s in slopes])
    if curvature.shape[1] < k:
        return None
    noise = 4 * tangents.error * bend * (1 + 1 / float(singular[-1]))
    curved = float(np.linalg.svd(curvature, compute_uv=False)[-1]) > noise
    return _Forms(w, left, holonomic=False) if curved else None


def _forms_at(block: Block, setting: Setting, tangents: _Tangents) -> tuple[Any, Sequence[Any]]:
    """The forms (k x n), each of length 1, and their derivatives by the columns: slopes[i][a, b] = d_a w_ib.

    Raises NoValueError.
    """
    pieces = [row.piece for row in block.forms if isinstance(row.piece, Pfaffian)]
    ring = Ring([e for piece in pieces for e in piece.coefficients.values()], setting.positive)
    nodes = [{name: ring.node(e) for name, e in piece.coefficients.items()} for piece in pieces]
    if any(v.kind == "call" for v in ring.vars):
        raise OutsideDomainError("the answer depends on the unknown function")
    rng = random.Random("dofkit measured forms")
    place = {v.key: rng.uniform(0.5, 2) for v in ring.vars if v.kind == "symbol"}
    point = FloatPoint({**place, **tangents.at}, 0)
    out = values(ring, point)
    number = {str(s.args[-1]): i for i, s in enumerate(tangents.relations.symbols)}
    column = {v.key: number.get(str(v.key.args[-1])) for v in ring.vars if v.kind == "symbol"}
    scale = tangents.relations.scale
    w, slopes = np.zeros((len(pieces), len(number))), []
    for i, form in enumerate(nodes):
        slope = np.zeros((len(number), len(number)))
        for name, node in form.items():
            b = number[name]
            w[i, b] = float(out[node]) * scale[b]
            for c, v in gradient(ring, out, point, [(node, 1.0)]).items():
                a = column.get(ring.vars[c].key)
                if a is not None:
                    slope[a, b] = float(v) * scale[a] * scale[b]
        length = float(np.linalg.norm(w[i])) or 1.0
        w[i] /= length
        slopes.append(slope / length)
    return w, slopes
