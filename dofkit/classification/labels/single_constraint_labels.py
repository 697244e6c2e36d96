"""What a constraint that is not finite says without the others: of its branches the largest, as for a system."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice
from itertools import product as cartesian

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.classification.freedom.block import alone, answer
from dofkit.classification.freedom.branches import MAX_CHOICES
from dofkit.classification.freedom.domain import restricted_to_domain
from dofkit.classification.freedom.reference_branches import branches_at_reference
from dofkit.classification.labels.entry import LabelledRow
from dofkit.expressions.tree import Expr
from dofkit.integrability.pfaffian_system import Codistribution, codistribution
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, coordinates_of, with_rows
from dofkit.relations.normal.pieces import Nonlinear, Pfaffian, Reduced, Still
from dofkit.relations.setting import Setting

#: A part by its coordinates and by which pieces its rows and conditions are.
_Key = tuple[tuple[str, ...], tuple[int, ...]]


@dataclass
class AnsweredParts:
    """The answers to parts of the blocks of a system. What was answered is kept: identities of its pieces are keys."""

    setting: Setting
    _answers: dict[_Key, tuple[Block, Answer]] = field(default_factory=dict)
    _forms: dict[tuple[int, ...], tuple[Block, Codistribution]] = field(default_factory=dict)

    @cached_property
    def plain(self) -> Setting:
        """What may be assumed where no drawing is looked at, and nothing but the labels is asked."""
        return replace(self.setting, pose={}, reference=None, grows=False, flag=False)

    def know(self, blocks: Iterable[tuple[Block, Answer]]) -> None:
        """Take the answers of whole blocks; those that were found at no drawing either are not asked again."""
        if self.setting.reference is None and not self.setting.pose:
            self._answers |= {_key(b): (b, a) for b, a in blocks if a.dof is not None}

    def of(self, part: Block) -> Answer:
        """The answer to a part. Raises OutOfTimeError, and ArithmeticError where an expression has no value."""
        key = _key(part)
        if key not in self._answers:
            self._answers[key] = part, answer(part, self.plain)
        return self._answers[key][1]

    def forms(self, part: Block, hidden: Sequence[Expr] = ()) -> Codistribution:
        """The rows of a part as one-forms, with hidden relations; written down once."""
        key = _key(part)[1]
        if hidden:
            return codistribution(part, self.plain, hidden)
        if key not in self._forms:
            self._forms[key] = part, codistribution(part, self.plain, ())
        return self._forms[key][1]


def _key(part: Block) -> _Key:
    return part.coordinates, tuple(id(p) for p in (*(row.piece for row in part.rows), *part.conditions))


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
