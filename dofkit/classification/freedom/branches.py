"""The answers of a system's blocks, for the largest of the branches of its relations (`solve`)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import product as cartesian

from dofkit.base.deadline import OUT_OF_TIME, OutOfTimeError, check, unless_late
from dofkit.base.verdicts import VERDICTS
from dofkit.classification.freedom.block import answer
from dofkit.classification.freedom.common_point import CommonPoint, at_one_point, restricted_to_domain
from dofkit.classification.freedom.isomorphic_blocks import AnsweredBlock, Likenesses
from dofkit.classification.freedom.preparation import (
    branches_at_reference,
    copies,
    has_kink_at_reference,
    passes_reference,
    reductions_at_reference,
)
from dofkit.classification.freedom.velocity_domain import with_values_in_motion
from dofkit.configuration.linear_blocks import confirmed
from dofkit.expressions.tree import Expr
from dofkit.integrability.rewritten_rows import NOT_EQUIVALENT, with_reductions_checked
from dofkit.integrability.traits import is_curved
from dofkit.relations.answer import Answer, AnsweredPart
from dofkit.relations.blocks import Block, Row, split
from dofkit.relations.normal.domain import DomainCondition, is_always_satisfied
from dofkit.relations.normal.no_solution import holds_somewhere
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Finite, JointEquation, Nonlinear, Normal, Pfaffian, Reduced
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import MAX_ALTERNATIVES, Alternative, RewrittenRow, alternatives_of

#: Bound on the choices of branches.
MAX_CHOICES = 16
_LEFT_OUT = (
    f"of more than {MAX_CHOICES} combinations of branches, not all were examined, so the largest dimension is not known"
)

OFF_REFERENCE = (
    "the reference configuration does not satisfy all geometric equations: the answer is for configurations that do, "
    "not for the reference configuration itself"
)
WINDS = "an angle in space was considered within half a turn of the reference configuration only"
KINKED = "the argument of an absolute value vanishes at the reference configuration, so there is no derivative"


@dataclass
class Outcome:
    """The blocks of one choice of branches and their answers.

    ``reduced``: rows written nonlinear in the velocities that the other rows make linear; ``impossible``: constraints
    that are satisfied nowhere, ``unsettled``: those for which this is undecided. ``crossing``: a relation has several
    branches at the reference. ``copies``: copy -> original. ``divided``: a reduction divided by an expression that may
    vanish. ``witness``: values of coordinates that occur only in conditions.
    """

    rows: list[Row]
    blocks: list[Block]
    answers: list[Answer]
    untouched: list[str]
    impossible: list[int] = field(default_factory=list)
    crossing: bool = False
    copies: dict[int, int] = field(default_factory=dict)
    reduced: tuple[RewrittenRow, ...] = ()
    unsettled: list[int] = field(default_factory=list)
    divided: bool = False
    witness: Mapping[Expr, str] = field(default_factory=dict)

    @property
    def consistent(self) -> bool | None:
        answers = [a.consistent for a in self.answers]
        if self.impossible or False in answers:
            return False
        return None if self.unsettled or None in answers else True

    @property
    def answered_parts(self) -> list[AnsweredPart]:
        """The blocks, or the parts of blocks that were analysed in parts, with their answers."""
        pairs = (AnsweredPart(block, a) for block, a in zip(self.blocks, self.answers, strict=True))
        return [part for p in pairs for part in ((p,) if p.answer.answered_parts is None else p.answer.answered_parts)]

    @property
    def bridged(self) -> Counter[int]:
        """The number of equations, by constraint, of joints that close no loop: each with a row in no part."""
        within = {id(row) for part in self.answered_parts for row in part.block.rows}
        rows = [row for block in self.blocks for row in block.rows]
        joints = {row.constraint for row in rows if id(row) not in within}
        return Counter(row.constraint for row in rows if row.constraint in joints)

    @property
    def written_rows(self) -> list[Row]:
        """The rows, and those of copies, which are not analysed."""
        copied_rows = [
            Row(copy, row.piece) for copy, i in self.copies.items() for row in self.rows if row.constraint == i
        ]
        return [*self.rows, *copied_rows]

    @property
    def dof(self) -> int | None:
        return self._total([a.dof for a in self.answers])

    @property
    def velocity_dof(self) -> int | None:
        return self._total([a.velocity_dof for a in self.answers])

    def _total(self, freedoms: Sequence[int | None]) -> int | None:
        """Return the untouched coordinates plus the sum of the freedoms; None if inconsistent, or one is unknown."""
        if not self.consistent or any(p is None for p in freedoms):
            return None
        return len(self.untouched) + sum(p for p in freedoms if p is not None)

    @property
    def most(self) -> int:
        """A bound on the freedom of this choice of branches; -1 if the freedom itself is known."""
        if self.dof is not None:
            return -1
        return len(self.untouched) + sum(_most(b, a) for b, a in zip(self.blocks, self.answers, strict=True))

    @property
    def unseen(self) -> int:
        """A bound on the freedom of every component of this choice of branches, those not examined included."""
        bounds = (
            _bound(b, a) if a.about == "component" else _most(b, a)
            for b, a in zip(self.blocks, self.answers, strict=True)
        )
        return len(self.untouched) + sum(bounds)

    @property
    def size(self) -> tuple[int, int, int]:
        """The key by which choices of branches are compared: consistency, freedom, velocity freedom, or uncertainty."""
        against = [VERDICTS.index(a.claim.verdict) for a in self.answers if a.consistent is False]
        doubt = 0 if self.impossible else min(against, default=0)
        return (int(self.consistent is not False), -1 if self.dof is None else self.dof, self.velocity_dof or doubt)


def _most(block: Block, a: Answer) -> int:
    """Return a block's freedom if it is known, otherwise a bound on it."""
    return a.dof if a.consistent and a.dof is not None else _bound(block, a)


def _bound(block: Block, a: Answer) -> int:
    """Return a bound on a block's freedom on any component: a relation removes at least one, unless it may be 0 = 0."""
    bound = len(block.coordinates) - (not a.doubt and bool(block.finite))
    return bound if a.most is None else min(bound, a.most)


def solve(reduced: Sequence[Reduced], setting: Setting, answered: AnsweredBlocks | None = None) -> Outcome:
    """Return the outcome of the largest choice of branches; ``answered``: blocks that were analysed before.

    Only branches through the reference configuration count, unless it does not satisfy all constraints.
    """
    best, chosen = _through_reference(reduced, setting, answered or AnsweredBlocks(setting))
    if chosen and (best.consistent is False or any(off_reference(best, setting))):
        anywhere = replace(setting, reference=None)
        best, chosen = _through_reference(reduced, anywhere, AnsweredBlocks(anywhere))
    best.answers = _about_component(_with_reference_checked(best, setting), best.blocks, chosen)
    others = [r for r in reduced if not r.constraint.winds] if best.consistent is False else reduced
    if len(others) < len(reduced) and solve(others, setting).consistent is not False:
        best.answers = [Answer(None, verdict="undecided", reasons=[WINDS]) for _ in best.answers]
    return best


def _through_reference(
    reduced: Sequence[Reduced], setting: Setting, answered: AnsweredBlocks
) -> tuple[Outcome, set[int]]:
    """Return (outcome of the largest branch through the reference, constraints with branches not through it)."""
    normals, chosen = _normals_at_reference(reduced, setting)
    options = [range(len(normal.branches)) or (None,) for _, normal in normals]
    never, unsettled = _one_sided(reduced, setting.positive)
    copied = copies(reduced)
    outcomes, why = list[Outcome](), None
    domain = [(i, c) for i, r in enumerate(reduced) for c in r.domain() if not is_always_satisfied(c, setting.positive)]
    names = [c.name for c in setting.roles]
    for number, choice in enumerate(cartesian(*options)):
        if number == MAX_CHOICES:
            why = _LEFT_OUT
            break
        rows, impossible = list[Row](), list(never)
        for (i, normal), branch in zip(normals, choice, strict=True):
            if branch is None:
                impossible.append(i)
            elif i not in copied:
                rows += [Row(i, p) for p in normal.branches[branch]]
        plain = not any(isinstance(row.piece, Nonlinear | DomainCondition) for row in rows)
        alternatives = [Alternative(rows)] if plain else alternatives_of(rows, setting.positive)
        why = _LEFT_OUT if len(alternatives) >= MAX_ALTERNATIVES else why
        through = reductions_at_reference(alternatives, setting)
        if len(through) < len(alternatives):
            chosen |= {slot.written.constraint for a in alternatives for slot in a.slots if not slot.unchanged}
        for alternative in through:
            outcome = _answered(names, alternative.rows, impossible, domain, answered)
            outcome.reduced, outcome.divided = alternative.reduced, alternative.divided
            outcomes.append(outcome)
    best = _largest(outcomes, why, setting) if outcomes else Outcome([], [], [], names)
    if len(outcomes) == 1:
        best.answers = _confirmed(best, setting)
    best.copies = copied if outcomes else {}
    best.unsettled = [*unsettled, *best.unsettled]
    best.crossing = setting.reference is not None and any(len(normal.branches) > 1 for _, normal in normals)
    if any(has_kink_at_reference(normal, setting) for _, normal in normals) and best.consistent is not False:
        best.answers = [Answer(None, verdict="undecided", reasons=[KINKED]) for _ in best.answers]
    return best, chosen


def _normals_at_reference(reduced: Sequence[Reduced], setting: Setting) -> tuple[list[tuple[int, Normal]], set[int]]:
    """Return ((constraint, normal form with the branches through the reference), constraints with other branches)."""
    written = [(i, normal) for i, r in enumerate(reduced) for normal in r.normals]
    normals = [(i, branches_at_reference(normal, setting)) for i, normal in written]
    chosen = {i for (i, n), (_, kept) in zip(written, normals, strict=True) if len(kept.branches) < len(n.branches)}
    return normals, chosen


def off_reference(best: Outcome, setting: Setting) -> list[bool]:
    """Return whether the reference configuration does not satisfy the geometric equations, for each block."""
    if setting.reference is None or setting.tolerance is not None or best.consistent is not True:
        return [False for _ in best.blocks]
    return [
        a.instantaneous is None
        and not passes_reference([*(row.piece for row in block.rows), *map(Finite, a.hidden)], setting)
        for block, a in zip(best.blocks, best.answers, strict=True)
    ]


def _with_reference_checked(best: Outcome, setting: Setting) -> list[Answer]:
    """Return the answers, about a component if the reference configuration does not satisfy all geometric equations."""
    off = off_reference(best, setting)
    if not any(off):
        return best.answers
    scoped = [replace(a, about="component", exists=False) if a.about == "reference" else a for a in best.answers]
    return [
        replace(a, reasons=list(dict.fromkeys([*a.reasons, OFF_REFERENCE]))) if missed else a
        for a, missed in zip(scoped, off, strict=True)
    ]


def _about_component(answers: Sequence[Answer], blocks: Sequence[Block], chosen: Collection[int]) -> list[Answer]:
    """Return the answers, about a component for blocks with a ``chosen`` constraint, which has other branches."""
    return [
        replace(a, about="component")
        if a.about == "everywhere" and any(row.constraint in chosen for row in block.rows)
        else a
        for block, a in zip(blocks, answers, strict=True)
    ]


def _one_sided(reduced: Sequence[Reduced], positive: frozenset[Expr]) -> tuple[list[int], list[int]]:
    """Return (constraints with an inequality that is satisfied nowhere, those for which this is undecided)."""
    satisfiable = {
        i: [holds_somewhere(q.expr, q.strict, positive) for q in r.inequalities]
        for i, r in enumerate(reduced)
        if r.inequalities
    }
    never = [i for i, holds in satisfiable.items() if False in holds]
    return never, [i for i, holds in satisfiable.items() if None in holds and False not in holds]


def _largest(outcomes: Sequence[Outcome], why: str | None, setting: Setting) -> Outcome:
    """Return the largest outcome; an undecided one if it may be larger, or if not all were examined (``why``)."""
    best = max(outcomes, key=lambda o: o.size)
    remaining = [o for o in outcomes if o.consistent is not False]
    perhaps_larger = max(remaining, key=lambda o: o.most, default=None)
    if best.dof is not None and perhaps_larger is not None and perhaps_larger.most > best.dof:
        best = perhaps_larger
    if why or (len(outcomes) > 1 and any(a.late for o in outcomes for a in o.answers)):
        best.answers = [Answer(None, verdict="undecided", reasons=[why or OUT_OF_TIME]) for _ in best.answers]
    elif best.consistent is not False:
        best.answers = _among_branches(best, [o for o in remaining if o is not best])
        if best.reduced:
            best.answers = with_reductions_checked(best.reduced, best.blocks, best.answers, setting)
    elif any(o.divided and not o.impossible for o in outcomes):
        best.answers = [Answer(None, verdict="undecided", reasons=[NOT_EQUIVALENT]) for _ in best.answers]
    return best


def _among_branches(best: Outcome, others: Sequence[Outcome]) -> list[Answer]:
    """Return the answers, about one branch or component as far as ``others`` may have larger or different ones."""
    shared = [{_identity(block) for block in o.blocks} for o in others]
    answers = [
        a if all(_identity(block) in blocks for blocks in shared) else replace(a, one_branch=True)
        for block, a in zip(best.blocks, best.answers, strict=True)
    ]
    if best.dof is None or all(o.unseen <= best.dof and (o.dof != best.dof or o.size == best.size) for o in others):
        return answers
    return [replace(a, about="component") if a.about == "everywhere" else a for a in answers]


def _confirmed(only: Outcome, setting: Setting) -> list[Answer]:
    """Return the answers of the only choice of branches, proved if exact elimination confirms them."""
    written = Counter(row.constraint for row in only.rows)
    answers = []
    for block, a in zip(only.blocks, only.answers, strict=True):
        alone = all(written[row.constraint] == 1 for row in block.rows)
        of_block = partial(confirmed, block, a, setting, alone)
        answers.append(unless_late(of_block, a) if a.verdict == "probable" else a)
    return answers


def _answered(
    names: Sequence[str],
    rows: list[Row],
    impossible: list[int],
    domain: Sequence[tuple[int, DomainCondition]],
    answered: AnsweredBlocks,
) -> Outcome:
    """Return the outcome for some rows; ``domain``: (constraint, condition for a value of it as written)."""
    setting = answered.setting
    blocks, untouched = split(names, rows)
    result = CommonPoint(list(blocks), answered.answers(blocks))
    moving = [(i, c) for i, c in domain if velocities_of(c.expr)]
    still = [(i, c) for i, c in domain if not velocities_of(c.expr)]
    if still or len(blocks) > 1:
        result = at_one_point(*result[:2], still, setting, partial(in_time, setting=setting))
    if moving:
        result = with_values_in_motion(result, moving, setting, answered.of)
    never = [*impossible, *result.nowhere]
    return Outcome(
        rows, result.blocks, result.answers, untouched, never, unsettled=[*result.unsettled], witness=result.witness
    )


class AnsweredBlocks:
    """The answers of blocks, remembered for the same block, and for blocks that are equal up to names.

    The blocks are stored with them, because the identities of their pieces are keys.
    """

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self._answers: dict[Hashable, tuple[Block, Answer]] = {}
        self._alike: dict[Hashable, AnsweredBlock] = {}
        self._shapes: set[Hashable] = set()
        self._curved: dict[int, tuple[Pfaffian, bool]] = {}

    def know(self, outcome: Outcome) -> None:
        """Remember the decided answers of an outcome."""
        answered = zip(outcome.blocks, outcome.answers, strict=True)
        self._answers |= {_identity(block): (block, a) for block, a in answered if a.dof is not None}

    def answers(self, blocks: Sequence[Block]) -> list[Answer]:
        """Return the blocks' answers; likenesses are computed only for blocks that may be twins (`_shape`)."""
        shapes = Counter(map(_shape, blocks)) if len(blocks) > 1 else Counter()
        self._shapes |= {shape for shape, times in shapes.items() if times > 1}
        likenesses = Likenesses(self.setting) if self._shapes else None
        return [self.of(block, likenesses) for block in blocks]

    def of(self, block: Block, likenesses: Likenesses | None = None) -> Answer:
        """Return the answer of one block; ``likenesses`` finds a block equal up to names, whose answer is renamed."""
        same = _identity(block)
        if same not in self._answers:
            twins = _shape(block) in self._shapes and not any(isinstance(r.piece, JointEquation) for r in block.rows)
            result = self._twin(block, likenesses) if twins and likenesses else in_time(block, self.setting)
            self._answers[same] = block, result
        return self._answers[same][1]

    def is_curved(self, form: Pfaffian) -> bool:
        """Return whether it is proved that a form is not integrable on its own."""
        if id(form) not in self._curved:
            self._curved[id(form)] = form, is_curved(form, self.setting)
        return self._curved[id(form)][1]

    def _twin(self, block: Block, likenesses: Likenesses) -> Answer:
        """Return the answer of a block, from a twin if there is one."""
        key, names = likenesses.of(block)
        twin = self._alike.get(key)
        if twin is not None:
            return twin.answer_of_twin(block, names)
        result = in_time(block, self.setting)
        if result.answered_parts is None:
            result.kind = len(self._alike)
            self._alike[key] = AnsweredBlock(block, names, result)
        return result


def _identity(block: Block) -> Hashable:
    """Return a key that is equal for blocks with the same coordinates and identical pieces."""
    return block.coordinates, tuple([id(row.piece) for row in block.rows]), tuple([id(c) for c in block.conditions])


def _shape(block: Block) -> Hashable:
    """Return a quickly computed key that is equal for twins."""
    return len(block.coordinates), tuple(type(row.piece) for row in block.rows), len(block.conditions)


def in_time(block: Block, setting: Setting) -> Answer:
    """Return the block's answer; undecided if time runs out or an expression has no value."""
    try:
        check()
        result = answer(block, setting)
        return restricted_to_domain(block, result, setting) if block.conditions else result
    except OutOfTimeError as error:
        return Answer(None, verdict="undecided", reasons=[str(error)], late=True)
    except ArithmeticError:
        return Answer(None, verdict="undecided", reasons=["an expression has no value at the points that were tried"])
