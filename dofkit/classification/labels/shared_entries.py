"""Entries of constraints that are the same up to names: one is worked out, the others are it with their own text."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence

from dofkit.classification.freedom.parts import AnsweredParts
from dofkit.classification.labels.entry import LabelledRow
from dofkit.expressions.tree import TIME
from dofkit.integrability.traits import Traits, traits
from dofkit.relations.answer import Answer
from dofkit.relations.joint_equations import JointEquation
from dofkit.relations.normal.notes import INSTANT_NOTE
from dofkit.relations.normal.pieces import Clause, Finite, Nonlinear, Pfaffian
from dofkit.relations.piece_shapes import shape_together
from dofkit.relations.reduced import Reduced
from dofkit.relations.setting import Setting
from dofkit.report import ConstraintEntry

#: Of the equations of a joint that is not driven.
STILL = Traits((True, "proved"))


class SharedEntries:
    """What was found of constraints, to be told again of others of the same kind."""

    def __init__(self, setting: Setting, parts: AnsweredParts) -> None:
        self._setting, self._parts = setting, parts
        self._traits: dict[Hashable, Traits] = {}
        self._entries: dict[Hashable, ConstraintEntry] = {}
        self._sure: dict[int, tuple[Answer, Hashable]] = {}

    def traits(self, piece: Clause) -> Traits:
        """The labels that a piece carries by itself."""
        if isinstance(piece, JointEquation):
            return STILL
        key: Hashable = shape_together((piece,)) if isinstance(piece, Pfaffian) else piece
        found = self._traits.get(key)
        if found is None:
            opened = isinstance(piece, Pfaffian) and self._parts.is_open(piece)
            found = self._traits[key] = traits(piece, self._setting.positive, self._setting.engines, opened)
        return found

    def kind(self, r: Reduced, told: Sequence[LabelledRow], *beside: Hashable) -> Hashable:
        """Equal for constraints of which the same is told, names apart; None for one that is looked at by itself.

        ``beside``: what else is known of it. Where it holds a form its shape goes in, else only what its finite
        relations and inequalities carry by themselves: no more of these is told.
        """
        every = [p for n in r.normals for p in n.pieces]
        if [id(p) for p in every] != [id(t.row.piece) for t in told]:
            every += [t.row.piece for t in told]
        kinds = {type(p) for p in every}
        if Nonlinear in kinds or r.constants or [t for t in told if t.reduced or (t.label and t.label.modulo)]:
            return None
        return (
            r.constraint.type,
            tuple([(tuple(map(len, n.branches)), INSTANT_NOTE in n.notes) for n in r.normals]),
            len(every),
            shape_together(every) if any(issubclass(kind, Pfaffian) for kind in kinds) else self._plain_kinds(every),
            self._plain_kinds(r.inequalities),
            tuple([(t.label, self._sureness(t.answer)) for t in told]),
            beside,
        )

    def _sureness(self, a: Answer) -> Hashable:
        """What an entry tells of its blocks' answers; kept with the answer itself, so that no other is taken for it."""
        known = self._sure.get(id(a))
        if known is None:
            told = a.verdict, a.argument, a.bits, a.gap, a.about, a.curved, a.late, a.consistent
            known = self._sure[id(a)] = a, told
        return known[1]

    def _plain_kinds(self, pieces: Iterable[Clause]) -> Hashable:
        return tuple([(type(p).__name__, None if _is_still(p) else self.traits(p)) for p in pieces])

    def known(self, kind: Hashable, r: Reduced) -> ConstraintEntry | None:
        """What was told of another constraint of that kind, told of this one."""
        found = None if kind is None else self._entries.get(kind)
        if found is None:
            return None
        return found.model_copy(update={"name": r.constraint.name, "text": r.constraint.text})

    def keep(self, kind: Hashable, made: ConstraintEntry) -> None:
        """Tell the same of others of that kind, where all of it is decided and nothing in it has a name."""
        decided = None not in (made.holonomic, made.holonomic_alone, made.scleronomic)
        nameless = made.integral is None and made.integrating_factor is None and made.circuit is None
        plain = made.form in ("finite", "inequality") or (made.form == "pfaffian" and made.holonomic is False)
        if kind is not None and decided and nameless and plain:
            self._entries[kind] = made


def _is_still(piece: Clause) -> bool:
    """Is it a finite relation without time? All that it carries by itself is known then."""
    return isinstance(piece, JointEquation) or (isinstance(piece, Finite) and TIME not in piece.expr.symbols)
