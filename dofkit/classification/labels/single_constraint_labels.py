"""What a constraint that is not finite says without the others: of its branches the largest, as for a system."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from itertools import product as cartesian

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.classification.freedom.block import alone
from dofkit.classification.freedom.branches import MAX_CHOICES
from dofkit.classification.freedom.domain import restricted_to_domain
from dofkit.classification.freedom.parts import AnsweredParts
from dofkit.classification.freedom.reference_branches import branches_at_reference
from dofkit.classification.labels.entry import LabelledRow
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, coordinates_of, with_rows
from dofkit.relations.normal.pieces import Nonlinear, Pfaffian, Reduced, Still

#: Up to this many coordinates, those of one constraint are listed in the scene's order.
LISTED = 2000


def by_itself(i: int, r: Reduced, told: Sequence[LabelledRow], parts: AnsweredParts) -> Answer | None:
    """The answer of a constraint's own rows; None where they are finite. ``told``: its rows in the system."""
    written = [Row(i, p) for normal in r.normals for p in normal.pieces]
    if any(isinstance(row.piece, Nonlinear) for row in written):
        still = [t.row for t in told if isinstance(t.row.piece, Still)]
        return _curved(told) or _in_time([*written, *still], parts)
    if not any(isinstance(row.piece, Pfaffian) for row in written):
        return None
    linear = any(isinstance(t.row.piece, Pfaffian) for t in told)
    inherited = _inherited(told) if linear else None
    if inherited is not None:
        return inherited
    if any(len(normal.branches) > 1 for normal in r.normals):
        return _largest(i, r, parts)
    return _in_time([t.row for t in told], parts) if linear else None


def _largest(i: int, r: Reduced, parts: AnsweredParts) -> Answer | None:
    """The answer of the largest branch; None where that is finite, undecided where it is not known which is."""
    mentioned = {name for n in r.normals for b in n.branches for p in b for name in coordinates_of(p)}
    mentioned -= {*r.constants}
    constants = {c: Row(i, Still(c)) for c in r.constants}
    normals = [branches_at_reference(normal, parts.setting) for normal in r.normals]
    best: tuple[tuple[int, int, int], Answer, bool] | None = None
    seen_all = True
    for number, choice in enumerate(islice(cartesian(*(n.branches for n in normals)), MAX_CHOICES + 1)):
        rows = [Row(i, p) for branch in choice for p in branch]
        if number == MAX_CHOICES:
            seen_all = False
            break
        found = _in_time(with_rows(rows, constants), parts, mentioned)
        seen_all = seen_all and (found.consistent is False or found.dof is not None)
        size = int(found.consistent is not False), found.dof or 0, found.velocity_dof or 0
        if best is None or size > best[0]:
            best = size, found, any(isinstance(row.piece, Pfaffian) for row in rows)
    if not seen_all and (best is None or best[1].dof != len(mentioned)):
        return Answer(None, verdict="undecided")
    return best[1] if best is not None and best[2] else None


def _in_time(own: Sequence[Row], parts: AnsweredParts, others: set[str] | None = None) -> Answer:
    mentioned = {name for row in own for name in coordinates_of(row.piece)} | (others or set())
    roles = parts.setting.roles
    coordinates = [c.name for c in roles if c.name in mentioned] if len(roles) < LISTED else []
    coordinates += sorted(mentioned - set(coordinates))

    def answered(part: Block) -> Answer:
        return restricted_to_domain(part, parts.of(part), parts.plain)

    try:
        check()
        return alone(own, parts.setting, coordinates, parts.of if others is None else answered)
    except (OutOfTimeError, ArithmeticError):
        return Answer(None, verdict="undecided")


def _curved(told: Sequence[LabelledRow]) -> Answer | None:
    """Velocities that bend under the other constraints bend without them."""
    return next((t.answer for t in told if isinstance(t.row.piece, Nonlinear) and t.answer.curved), None)


def _inherited(told: Sequence[LabelledRow]) -> Answer | None:
    """A single form that is non-holonomic in the system is so alone: what integrates alone integrates in any system."""
    if len(told) != 1 or told[0].label is None or told[0].label.holonomic is not False:
        return None
    return Answer(labels={0: told[0].label})
