"""Blocks that are connected by bridges, joints that close no loop (`dofkit.mobility.joint_tree`): analysed in parts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace

from dofkit.base.verdicts import VERDICTS, weakest
from dofkit.configuration.variety import field_jacobian, of_reference, pose_point
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.relations.answer import Answer, AnsweredPart, FollowedClasses, Size
from dofkit.relations.blocks import Block, Row, coordinates_of, make_chart, split, uses_time
from dofkit.relations.normal.pieces import Finite, JointEquation
from dofkit.relations.setting import Setting

#: A block of at most so many coordinates whose equations are written out is not divided.
FEW = 12
METHOD = "rank over GF(p) at the given configuration"


def bridged_answer(block: Block, setting: Setting, solve: Callable[[Block, Setting], Answer]) -> Answer | None:
    """Return the answer of a block from those of its parts without bridges, each by ``solve``; None if not applicable.

    Each equation of a bridge removes one freedom. Not applicable if there are other than geometric equations, if a part
    does not satisfy its equations at the reference configuration, or if the block does not move.
    """
    joints = [row for row in block.rows if row.constraint in setting.bridges]
    if not joints or not _is_eligible(block, joints, setting):
        return None
    rows = [row for row in block.rows if row.constraint not in setting.bridges]
    cores, loose = split(block.coordinates, rows)
    answered = [AnsweredPart(core, _answer_afloat(core, setting, solve) or solve(core, setting)) for core in cores]
    if not all(map(_is_satisfied, answered)):
        return None
    result = _together(block, setting, answered, len(loose) - len(joints))
    moves = result.dof if setting.reference is None else result.instantaneous
    return replace(result, looked=_looked(block, answered)) if moves else None


def _is_satisfied(part: AnsweredPart) -> bool:
    """Return whether a part is consistent with an answer about the reference."""
    return part.answer.consistent is True and part.answer.about == "reference"


def _answer_afloat(core: Block, setting: Setting, solve: Callable[[Block, Setting], Answer]) -> Answer | None:
    """Return the answer of a part that is not connected to the ground, by fixing the body with most rows; else None.

    Its set is the product of the body's own coordinates with the set for the fixed body.
    """
    host = _host(core, setting)
    if not host or setting.reference is None:
        return None
    fixed = {s: setting.reference[s] for s in map(ex.coordinate, host)}
    rows = [
        r._replace(piece=Finite(substitute(r.piece.expr, fixed))) for r in core.finite if isinstance(r.piece, Finite)
    ]
    blocks, loose = split([name for name in core.coordinates if name not in host], rows)
    answered = [AnsweredPart(block, solve(block, setting)) for block in blocks]
    chart = make_chart(core, setting)
    point = pose_point(chart, {**setting.reference, ex.TIME: ex.ZERO}, 3)
    if point is None or not all(map(_is_satisfied, answered)):
        return None
    result = _together(core, setting, answered, len(loose) + len(host))
    looked, matrix = _looked(core, answered), field_jacobian(chart, point)
    return replace(result, looked=looked, answered_parts=None, matrix=matrix, modulus=point.p)


def _host(core: Block, setting: Setting) -> tuple[str, ...]:
    """Return the coordinates of the body with most rows; none if the part is connected to the ground."""
    owners = {c.name: c.owner for c in setting.roles if c.name in core.coordinates}
    if not (setting.tilts.isdisjoint(owners) and setting.afloat.issuperset(row.constraint for row in core.rows)):
        return ()
    counted = Counter(owner for row in core.rows for owner in {owners[q] for q in coordinates_of(row.piece)})
    coordinates = tuple(q for q, owner in owners.items() if owner == counted.most_common(1)[0][0])
    return coordinates if len(coordinates) == setting.dimension * (setting.dimension + 1) // 2 else ()


def _is_eligible(block: Block, joints: Sequence[Row], setting: Setting) -> bool:
    """Return whether a block has only geometric equations without time, and a reference configuration.

    Without a reference, all rows must be those of bridges, and no Euler angles (which may become singular) may occur.
    """
    if "field" not in setting.engines or block.conditions or block.forms or block.nonlinear:
        return False
    is_open_tree = len(joints) == len(block.rows) and setting.tilts.isdisjoint(block.coordinates)
    if setting.reference is None and not is_open_tree:
        return False
    written = not any(isinstance(row.piece, JointEquation) for row in joints)
    if written and len(block.coordinates) <= FEW:
        return False
    others = tuple(row for row in block.rows if row.constraint not in setting.bridges)
    return not uses_time(Block(block.coordinates, others))


def _together(block: Block, setting: Setting, answered: Sequence[AnsweredPart], free: int) -> Answer:
    """Return the answer of a block from those of its parts; ``free``: the freedom outside the parts."""
    has_reference = setting.reference is not None
    reference = setting.reference if setting.reference is not None else setting.pose
    symbols = [ex.coordinate(name) for name in block.coordinates]
    answers = [p.answer for p in answered]
    dependent = [a for a in answers if a.argument != "independent relations"] or answers
    weak = max(dependent, key=lambda a: VERDICTS.index(a.verdict), default=None)
    result = Answer(
        dof=_total([a.dof for a in answers], free),
        velocity_dof=_total([a.velocity_dof for a in answers], free),
        verdict=weakest(*(a.verdict for a in answers)),
        about="reference" if has_reference else "everywhere",
        argument="joints that close no loop" if weak is None else weak.argument,
        reasons=list(dict.fromkeys(reason for a in answers for reason in a.reasons)),
        degenerate=any(a.degenerate for a in answers),
        instantaneous=_total([a.instantaneous for a in answers], free) if has_reference else None,
        first_order_sure=all(a.first_order_sure for a in answers),
        exists=has_reference and all(a.exists for a in answers) and all(reference[s].op == "num" for s in symbols),
        doubt=any(a.doubt for a in answers),
        method="; ".join(dict.fromkeys(a.method for a in answers)) or METHOD,
        witness=of_reference(symbols, reference),
        size=Size(*map(sum, zip(Size(), *(a.size for a in answers), strict=True))),
        answered_parts=tuple(answered),
    )
    if answers:
        result.bits, result.gap = min(a.bits for a in answers), min(a.gap for a in answers)
    result.derived = None if result.dof is None else (len(block.coordinates) - result.dof,)
    return result


def _total(numbers: Sequence[int | None], free: int) -> int | None:
    """Return ``free`` plus the sum of the numbers; None if one of them is unknown."""
    decided = [n for n in numbers if n is not None]
    return free + sum(decided) if len(decided) == len(numbers) else None


def _looked(block: Block, answered: Sequence[AnsweredPart]) -> FollowedClasses:
    """Return the sums of the parts' numbers; the rows of bridges count as left out if each part left rows out."""
    classes = [p.answer.looked for p in answered]
    total = FollowedClasses(*map(sum, zip(FollowedClasses(), *classes, strict=True)))
    if not all(k.left_out for k in classes):
        return total._replace(left_out=0)
    return total._replace(left_out=total.left_out + len(block.rows) - sum(len(p.block.rows) for p in answered))
