"""Parts of blocks by themselves, at no drawing: each is answered once, whoever asks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from dofkit.classification.freedom.block import answer
from dofkit.exact.zero import BOTH
from dofkit.expressions.tree import Expr
from dofkit.integrability.pfaffian_system import Codistribution, codistribution
from dofkit.integrability.shared_forms import SharedForms, shared_forms
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block
from dofkit.relations.normal.pieces import Piece
from dofkit.relations.setting import Setting

#: A part by its coordinates and by which pieces its rows and conditions are.
_Key = tuple[tuple[str, ...], tuple[int, ...]]


@dataclass
class AnsweredParts:
    """The answers to parts of the blocks of a system. What was answered is kept: identities of its pieces are keys."""

    setting: Setting
    _answers: dict[_Key, tuple[Block, Answer]] = field(default_factory=dict)
    _blocks: list[tuple[Block, Answer]] = field(default_factory=list)
    _shared: dict[int, SharedForms | None] = field(default_factory=dict)
    _forms: dict[tuple[int, ...], tuple[Block, Codistribution]] = field(default_factory=dict)

    @cached_property
    def plain(self) -> Setting:
        """What may be assumed where no drawing is looked at, and nothing but the labels is asked."""
        return replace(self.setting, pose={}, reference=None, grows=False, flag=False)

    def know(self, blocks: Iterable[tuple[Block, Answer]]) -> None:
        """Take the answers of whole blocks; those that were found at no drawing either are not asked again."""
        self._blocks += blocks
        if self.setting.reference is None and not self.setting.pose:
            self._answers |= {_key(b): (b, a) for b, a in self._blocks if a.dof is not None}

    def of(self, part: Block) -> Answer:
        """The answer to a part. Raises OutOfTimeError, and ArithmeticError where an expression has no value."""
        key = _key(part)
        if key not in self._answers:
            self._answers[key] = part, self._unrestricted(part) or answer(part, self.plain)
        return self._answers[key][1]

    def forms(self, part: Block, hidden: Sequence[Expr] = ()) -> Codistribution:
        """The rows of a part as one-forms, with hidden relations; written down once."""
        key = _key(part)[1]
        if hidden:
            return codistribution(part, self.plain, hidden)
        if key not in self._forms:
            self._forms[key] = part, codistribution(part, self.plain, ())
        return self._forms[key][1]

    def is_open(self, piece: Piece) -> bool:
        """Is it known already that the differential of a form is not 0?"""
        k, i = self._places.get(id(piece), (-1, -1))
        shared = self._shared.get(k)
        return shared is not None and shared.curl(i).is_open

    @cached_property
    def _places(self) -> dict[int, tuple[int, int]]:
        """The block of a piece, and its number among the block's forms."""
        return {id(row.piece): (k, i) for k, (block, _) in enumerate(self._blocks) for i, row in enumerate(block.forms)}

    def _unrestricted(self, part: Block) -> Answer | None:
        """The answer for some forms of a block whose brackets reach every direction; None where that is not proved.

        They do so at a point of the block's, which has a real configuration: there is one for its parts.
        """
        places = [self._places.get(id(row.piece), (-1, -1)) for row in part.rows]
        numbers = {k for k, _ in places}
        certain = self.setting.engines == BOTH and self.setting.tolerance is None and not self.setting.tilts
        if not certain or part.conditions or len(numbers) != 1 or -1 in numbers:
            return None
        block, a = self._blocks[(k := numbers.pop())]
        if a.witness is None or not a.consistent or len(part.rows) == len(block.rows):
            return None
        if k not in self._shared:
            linear = not block.finite and not block.nonlinear
            self._shared[k] = shared_forms(self.forms(block)) if linear else None
        shared = self._shared[k]
        if shared is None or not shared.reach_everything([i for _, i in places]):
            return None
        labels = {i: HolonomyLabel(False, "proved") for i in range(len(places))}
        n = len(part.coordinates)
        return Answer(True, n, n - len(places), labels=labels, argument="Lie algebra, certified", trusted=True)


def _key(part: Block) -> _Key:
    return part.coordinates, tuple(id(p) for p in (*(row.piece for row in part.rows), *part.conditions))
