"""What a form integrates to with the help of others: which of them it needs, and the finite relation they give."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain, count, islice
from itertools import product as cartesian

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.classification.freedom.block import alone, answer
from dofkit.classification.freedom.branches import MAX_CHOICES, Outcome
from dofkit.classification.freedom.common_point import restricted_to_domain
from dofkit.classification.freedom.preparation import branches_at_reference
from dofkit.classification.labels.entry import LabelledRow
from dofkit.classification.labels.reasons import Others
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import TIME, Expr
from dofkit.integrability import first_integrals
from dofkit.integrability.first_integrals import FirstIntegral
from dofkit.integrability.pfaffian_system import Codistribution, codistribution
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, coordinates_of, split, uses_time
from dofkit.relations.normal.pieces import Nonlinear, Pfaffian, Reduced
from dofkit.relations.setting import Setting
from dofkit.report import ConstraintEntry, IntegrablePart

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


def by_itself(i: int, r: Reduced, labelled: Sequence[LabelledRow], answered: AnsweredParts) -> Answer | None:
    """The answer of a constraint's own rows; None where they are finite. ``labelled``: its rows in the system."""
    written = [Row(i, p) for normal in r.normals for p in normal.pieces]
    if any(isinstance(row.piece, Nonlinear) for row in written):
        return _curved(labelled) or _in_time(written, answered)
    if not any(isinstance(row.piece, Pfaffian) for row in written):
        return None
    linear = any(isinstance(t.row.piece, Pfaffian) for t in labelled)
    inherited = _inherited(labelled) if linear else None
    if inherited is not None:
        return inherited
    if any(len(normal.branches) > 1 for normal in r.normals):
        return _largest(i, r, answered)
    return _in_time([t.row for t in labelled], answered) if linear else None


def _largest(i: int, r: Reduced, answers: AnsweredParts) -> Answer | None:
    """The answer of the largest branch; None where that is finite, undecided where it is not known which is."""
    mentioned = {name for n in r.normals for b in n.branches for p in b for name in coordinates_of(p)}
    normals = [branches_at_reference(normal, answers.setting) for normal in r.normals]
    best: tuple[tuple[int, int, int], Answer, bool] | None = None
    seen_all = True
    for number, choice in enumerate(islice(cartesian(*(n.branches for n in normals)), MAX_CHOICES + 1)):
        rows = [Row(i, p) for branch in choice for p in branch]
        if number == MAX_CHOICES:
            seen_all = False
            break
        result = _in_time(rows, answers, mentioned)
        seen_all = seen_all and (result.consistent is False or result.dof is not None)
        size = int(result.consistent is not False), result.dof or 0, result.velocity_dof or 0
        if best is None or size > best[0]:
            best = size, result, any(isinstance(row.piece, Pfaffian) for row in rows)
    if not seen_all and (best is None or best[1].dof != len(mentioned)):
        return Answer(None, verdict="undecided")
    return best[1] if best is not None and best[2] else None


def _in_time(rows: Sequence[Row], answers: AnsweredParts, others: set[str] | None = None) -> Answer:
    mentioned = {name for row in rows for name in coordinates_of(row.piece)} | (others or set())
    roles = answers.setting.roles
    coordinates = [c.name for c in roles if c.name in mentioned] if len(roles) < LISTED else []
    coordinates += sorted(mentioned - set(coordinates))

    def answered(part: Block) -> Answer:
        return restricted_to_domain(part, answers.of(part), answers.plain)

    try:
        check()
        return alone(rows, answers.setting, coordinates, answers.of if others is None else answered)
    except (OutOfTimeError, ArithmeticError):
        return Answer(None, verdict="undecided")


def _curved(labelled: Sequence[LabelledRow]) -> Answer | None:
    """Velocities that bend under the other constraints bend without them."""
    return next((t.answer for t in labelled if isinstance(t.row.piece, Nonlinear) and t.answer.curved), None)


def _inherited(labelled: Sequence[LabelledRow]) -> Answer | None:
    """A single form that is non-holonomic in the system is so alone: what integrates alone integrates in any system."""
    if len(labelled) != 1 or labelled[0].label is None or labelled[0].label.holonomic is not False:
        return None
    return Answer(labels={0: labelled[0].label})


#: Blocks up to this many constraints and coordinates are searched for companions and integrals.
MAX_CONSTRAINTS, MAX_COORDINATES = 10, 12


@dataclass(frozen=True)
class CompanionIntegrals:
    """Integrals by the numbers of the rows they can stand for, and all of them."""

    by_row: Mapping[int, FirstIntegral]
    integrals: Sequence[FirstIntegral]


@dataclass
class Companionship:
    """The blocks of a system, asked one constraint at a time; what was found for a block is kept.

    ``names``: those of the constraints, by number.
    """

    answered: AnsweredParts
    names: Sequence[str]
    _integrals: dict[tuple[int, ...], CompanionIntegrals] = field(default_factory=dict)

    def of(self, constraint: int, block: Block, a: Answer) -> Others:
        """For a constraint that is holonomic in its block: what it needs there, and its integral."""
        owners = list(dict.fromkeys(r.constraint for r in block.rows))
        if len(owners) > MAX_CONSTRAINTS or len(block.coordinates) > MAX_COORDINATES or block.nonlinear:
            return Others()
        try:
            kept = self._needed(constraint, block, owners)
            integral = self._integral(constraint, block, kept)
            if integral is not None and len(kept) < len(owners) and not self._holds(integral, block, a):
                kept = self._needed(constraint, block, owners, a)
                integral = self._integral(constraint, block, owners)
        except (OutOfTimeError, ArithmeticError):
            return Others()
        companions = tuple(f"'{self.names[o]}'" for o in kept if o != constraint)
        if integral is None:
            return Others(companions, identically=False, timed=_advances(constraint, block, a))
        timed = _timed(integral, constraint, block, a)
        return Others(companions, equation(integral, block), integral.identically, timed)

    def modulo(self, constraint: int, block: Block, a: Answer) -> Others:
        """For a constraint that is not: a finite relation that it says in the presence of all the others."""
        owners = list(dict.fromkeys(r.constraint for r in block.rows))
        if a.dof is None or len(owners) > MAX_CONSTRAINTS or len(block.coordinates) > MAX_COORDINATES:
            return Others()
        try:
            integral = self._integral(constraint, block, owners)
        except (OutOfTimeError, ArithmeticError):
            return Others()
        return Others() if integral is None else Others((), equation(integral, block), integral.identically)

    def _needed(self, constraint: int, block: Block, owners: Sequence[int], a: Answer | None = None) -> list[int]:
        """A minimal set of constraints, ``constraint`` among them, in which it is holonomic; later ones go first.

        With the block's answer: and where its integral, if it has one, stands beside all the others too.
        """
        kept = list(owners)
        for other in reversed(owners):
            check()
            fewer = [o for o in kept if o != other]
            if other == constraint or not self._holonomic(constraint, _rows(block, fewer), block):
                continue
            integral = None if a is None else self._integral(constraint, block, fewer)
            if a is None or integral is None or self._holds(integral, block, a):
                kept = fewer
        return kept

    def _holds(self, f: FirstIntegral, block: Block, a: Answer) -> bool:
        """Return whether f is constant along every motion of the whole block.

        What some of its rows integrate to need not be: where y = 0, dx = y dz says nothing of z, though it makes z
        constant beside x = 0 alone.
        """
        return first_integrals.is_first_integral(codistribution(block, self.answered.plain, a.hidden, [f.expr]), f.expr)

    def _holonomic(self, constraint: int, rows: Sequence[Row], block: Block) -> bool:
        for part in split(block.coordinates, rows)[0]:
            linear = [
                i for i, r in enumerate(part.rows) if r.constraint == constraint and isinstance(r.piece, Pfaffian)
            ]
            if linear:
                result = self.answered.of(part)
                if not result.consistent or any(not _true(result, i) for i in linear):
                    return False
        return True

    def _integral(self, constraint: int, block: Block, owners: Sequence[int]) -> FirstIntegral | None:
        """The integral of the one form that a constraint wrote, among those of some constraints."""
        forms = _forms_of(constraint, block)
        return self._integrals_of(block, owners).by_row.get(forms[0]) if len(forms) == 1 else None

    def basis(self, block: Block) -> list[str]:
        """Return independent integrals of all the block's rows together, as text."""
        owners = list(dict.fromkeys(r.constraint for r in block.rows))
        if len(owners) > MAX_CONSTRAINTS or len(block.coordinates) > MAX_COORDINATES or block.nonlinear:
            return []
        try:
            integrals = self._integrals_of(block, owners).integrals
        except (OutOfTimeError, ArithmeticError):
            return []
        return [equation(f, block, i if len(integrals) > 1 else None) for i, f in enumerate(integrals)]

    def _integrals_of(self, block: Block, owners: Sequence[int]) -> CompanionIntegrals:
        """The integrals of a block's rows that some constraints wrote."""
        key = (id(block), *owners)
        if key not in self._integrals:
            self._integrals[key] = self._searched(block, owners)
        return self._integrals[key]

    def _searched(self, block: Block, owners: Sequence[int]) -> CompanionIntegrals:
        numbers = [i for i, r in enumerate(block.rows) if r.constraint in owners]
        part = Block(block.coordinates, tuple(block.rows[i] for i in numbers))
        whole = self.answered.of(part)
        if whole.dof is None:
            return CompanionIntegrals({}, [])
        forms = self.answered.forms(part, whole.hidden)
        sought = len(part.coordinates) - whole.dof - len(part.finite) - len(whole.hidden)
        integrals = first_integrals.first_integrals(forms, sought)
        shift = forms.finite - len(part.finite)
        by_row = first_integrals.integral_by_row(forms, integrals)
        return CompanionIntegrals({numbers[row - shift]: f for row, f in by_row.items()}, integrals)


def _timed(f: FirstIntegral, constraint: int, block: Block, a: Answer) -> bool | None:
    """Return whether t occurs in what a form with a dt term integrates to; None if that depends on how it is written.

    That is so if other constraints hold t, and may hold it so that the dt term is 0.
    """
    others = Block(block.coordinates, tuple(r for r in block.rows if r.constraint != constraint))
    if not uses_time(others):
        return TIME in f.expr.symbols
    return None if others.finite or a.hidden else True


def _advances(constraint: int, block: Block, a: Answer) -> bool | None:
    """Return True where a form has a dt term at a generic point and the other constraints hold no time, else None.

    What it integrates to with them then has t: its differential is mu (a dq + b dt) and multiples of the others', none
    of which has dt, so that its derivative by t is mu b.
    """
    numbers = _forms_of(constraint, block)
    others = Block(block.coordinates, tuple(r for r in block.rows if r.constraint != constraint))
    if len(numbers) != 1 or uses_time(others) or a.hidden or not a.matrix:
        return None
    return a.matrix[numbers[0]].get(len(block.coordinates), 0) % a.modulus != 0 or None


def _forms_of(constraint: int, block: Block) -> list[int]:
    return [i for i, r in enumerate(block.rows) if r.constraint == constraint and isinstance(r.piece, Pfaffian)]


def _rows(block: Block, owners: Sequence[int]) -> list[Row]:
    return [r for r in block.rows if r.constraint in owners]


def _true(a: Answer, i: int) -> bool:
    label = a.labels.get(i)
    return label is not None and label.holonomic is True


def equation(f: FirstIntegral, block: Block, number: int | None = None) -> str:
    """``f = C``, or C1, C2, ... where there are several or the block itself has a C."""
    taken = set(block.coordinates)
    for row in block.rows:
        piece = row.piece
        entries = [e for _, e in piece.items()] if isinstance(piece, Pfaffian) else [piece.expr]
        taken |= {str(s.args[1]) for e in entries for s in e.symbols}
    names = (f"C{i}" for i in count(1))
    free = (name for name in (names if number is not None else chain(("C",), names)) if name not in taken)
    return f"{to_text(f.expr)} = {next(islice(free, number or 0, None))}"


def integrable_part(
    outcome: Outcome, entries: Sequence[ConstraintEntry], company: Companionship
) -> IntegrablePart | None:
    """What the differential constraints say in finite relations; None where there are none or it is undecided.

    The rank of I^(inf), the bottom of the derived flag, over all coordinates; its basis beyond the finite relations
    that were written: hidden ones, and integrals of which each block's are independent.
    """
    blocks = [(b, a) for b, a in zip(outcome.blocks, outcome.answers, strict=True) if b.forms]
    if not blocks or outcome.dof is None:
        return None
    coordinates = len(outcome.untouched) + sum(len(b.coordinates) for b in outcome.blocks)
    basis: list[str] | None = []
    for block, a in blocks:
        number_finite = len(block.finite) + len(a.hidden)
        finite = rank_of_rows(a.matrix[:number_finite], a.modulus) if a.matrix else number_finite
        remaining = len(block.coordinates) - (a.dof or 0) - finite
        result = _integrals(block, remaining, entries, company) if remaining > 0 else []
        if result is None or basis is None:
            basis = None
        else:
            basis += [f"{to_text(g)} = 0" for g in a.hidden] + result
    return IntegrablePart(rank=coordinates - outcome.dof, basis=basis)


def _integrals(
    block: Block, number: int, entries: Sequence[ConstraintEntry], company: Companionship
) -> list[str] | None:
    """So many independent integrals of a block; None where fewer were found."""
    owners = {r.constraint for r in block.rows if isinstance(r.piece, Pfaffian)}
    alone = [entries[i].integral for i in owners]
    if number == len(alone) == 1 and alone[0] is not None:
        return [alone[0]]
    result = company.basis(block)
    return result if len(result) == number else None
