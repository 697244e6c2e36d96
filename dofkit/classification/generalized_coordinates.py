"""Generalized coordinates: which of the scene's own coordinates can be chosen freely, ``dof`` of them."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.base.deadline import expired
from dofkit.classification import tangent_spaces
from dofkit.classification.explicit_coordinates import MOST, PLAIN, QUADRATIC, explicit
from dofkit.classification.freedom.bridged_blocks import with_still_parts
from dofkit.classification.turned_coordinates import TurnedGroup, chosen_at_drawing, partly_turned, rows_at_drawing
from dofkit.configuration.drawing.rigid_orbit import RigidOrbit
from dofkit.configuration.finite_blocks import dependent_names
from dofkit.configuration.generic_points import field_jacobian, on_variety, pose_point
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import last_columns, rank_of_rows
from dofkit.exact.zero import BOTH
from dofkit.expressions import tree as ex
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block
from dofkit.relations.chart_of_block import make_chart
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import Setting
from dofkit.system import Rotation

#: Coordinates up to so many are looked for on a tangent space.
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
        return direct if chosen is None or not _is_regular(block, a, chosen, setting) else chosen
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
        return tangent_spaces.nearby(finite, a.dof, setting, turning, a.hidden)
    orbit = None if turning else orbit_at_reference(block, a, setting)
    if orbit is not None:
        return orbit.chart_of()
    block = with_still_parts(block, a, setting)
    found = tangent_spaces.nearby(block, a.dof, setting, turning) or tangent_spaces.rigid(block, a.dof, setting)
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
    return tuple(names[c] for c in last_columns(rows, len(place), found.p))


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


def _is_regular(block: Block, a: Answer, chosen: Sequence[str], setting: Setting) -> bool:
    """Have the relations, by the coordinates that are not chosen, their full rank at the point that was looked at?

    A coefficient that was divided by may be 0 all over the set; at a reference these are numbers. Of what was answered
    by parts no rows are known.
    """
    if a.parts is not None:
        return setting.reference is not None
    if regular_at_witness(block.coordinates, a, chosen) is False:
        return False
    if not a.matrix or a.modulus <= 2:
        return True
    left = {k for k, name in enumerate(block.coordinates) if name not in chosen}
    rows = [{c: v for c, v in row.items() if c in left} for row in a.matrix]
    return rank_of_rows(rows, a.modulus) == len(left)


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
