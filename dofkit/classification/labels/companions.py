"""What a form integrates to with the help of others: which of them it needs, and the finite relation they give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, count, islice

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.labels.single_constraint_labels import AnsweredParts
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import TIME
from dofkit.integrability import first_integrals
from dofkit.integrability.first_integrals import FirstIntegral
from dofkit.integrability.pfaffian_system import codistribution
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, about_constants, split, uses_time
from dofkit.relations.normal.pieces import Pfaffian, Still
from dofkit.report import ConstraintEntry, IntegrablePart

#: Blocks up to this many constraints and coordinates are searched for companions and integrals.
MAX_CONSTRAINTS, MAX_COORDINATES = 10, 12


@dataclass(frozen=True)
class Together:
    """``companions``: a minimal set of other constraints with which a form integrates; None where it was not sought.

    ``integral``: what it then says, as text; ``identically`` tells that this was proved in the canonical ring, and
    ``timed`` that t occurs in it.
    """

    companions: tuple[int, ...] | None = None
    integral: str | None = None
    identically: bool = True
    timed: bool | None = None


@dataclass(frozen=True)
class CompanionIntegrals:
    """Integrals by the numbers of the rows they can stand for, and all of them."""

    by_row: Mapping[int, FirstIntegral]
    integrals: Sequence[FirstIntegral]


@dataclass
class Companionship:
    """The blocks of a system, asked one constraint at a time; what was found for a block is kept."""

    parts: AnsweredParts
    _integrals: dict[tuple[int, ...], CompanionIntegrals] = field(default_factory=dict)

    def of(self, constraint: int, block: Block, a: Answer) -> Together:
        """For a constraint that is holonomic in its block: what it needs there, and its integral."""
        owners = list(dict.fromkeys(r.constraint for r in block.rows))
        if len(owners) > MAX_CONSTRAINTS or len(block.coordinates) > MAX_COORDINATES or block.nonlinear:
            return Together()
        try:
            kept = self._needed(constraint, block, owners)
            integral = self._integral(constraint, block, kept)
            if integral is not None and len(kept) < len(owners) and not self._holds(integral, block, a):
                kept = self._needed(constraint, block, owners, a)
                integral = self._integral(constraint, block, owners)
        except (OutOfTimeError, ArithmeticError):
            return Together()
        companions = tuple(o for o in kept if o != constraint)
        if integral is None:
            return Together(companions)
        timed = _timed(integral, constraint, block, a)
        return Together(companions, equation(integral, block), integral.identically, timed)

    def modulo(self, constraint: int, block: Block, a: Answer) -> Together:
        """For a constraint that is not: a finite relation that it says in the presence of all the others."""
        owners = list(dict.fromkeys(r.constraint for r in block.rows))
        if a.dof is None or len(owners) > MAX_CONSTRAINTS or len(block.coordinates) > MAX_COORDINATES:
            return Together()
        try:
            integral = self._integral(constraint, block, owners)
        except (OutOfTimeError, ArithmeticError):
            return Together()
        return Together() if integral is None else Together((), equation(integral, block), integral.identically)

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
        """Is f constant along every motion of the whole block?

        What some of its rows integrate to need not be: where y = 0, dx = y dz says nothing of z, though it makes z
        constant beside x = 0 alone.
        """
        return first_integrals.is_first_integral(codistribution(block, self.parts.plain, a.hidden, [f.expr]), f.expr)

    def _holonomic(self, constraint: int, rows: Sequence[Row], block: Block) -> bool:
        for part in split(block.coordinates, rows)[0]:
            linear = [
                i for i, r in enumerate(part.rows) if r.constraint == constraint and isinstance(r.piece, Pfaffian)
            ]
            if linear:
                found = self.parts.of(part)
                if not found.consistent or any(not _true(found, i) for i in linear):
                    return False
        return True

    def _integral(self, constraint: int, block: Block, owners: Sequence[int]) -> FirstIntegral | None:
        """The integral of the one form that a constraint wrote, among those of some constraints."""
        own = _forms_of(constraint, block)
        return self._integrals_of(block, owners).by_row.get(own[0]) if len(own) == 1 else None

    def basis(self, block: Block) -> list[str]:
        """Return independent integrals of all the block's rows together, as text, less those between constants."""
        owners = list(dict.fromkeys(r.constraint for r in block.rows))
        if len(owners) > MAX_CONSTRAINTS or len(block.coordinates) > MAX_COORDINATES or block.nonlinear:
            return []
        try:
            constants = [c for r in block.rows if isinstance(r.piece, Still) for c in r.piece.coefficients]
            every = self._integrals_of(block, owners).integrals
            integrals = [f for f in every if not about_constants(f.expr, constants)]
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
        whole = self.parts.of(part)
        if whole.dof is None:
            return CompanionIntegrals({}, [])
        forms = self.parts.forms(part, whole.hidden)
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
        parts = [e for _, e in piece.items()] if isinstance(piece, Pfaffian) else [piece.expr]
        taken |= {str(s.args[1]) for e in parts for s in e.symbols}
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
    coordinates = len(outcome.untouched) + sum(len(b.coordinates) - _constants(b) for b in outcome.blocks)
    basis: list[str] | None = []
    for block, a in blocks:
        known = len(block.finite) + len(a.hidden)
        finite = rank_of_rows(a.matrix[:known], a.modulus) if a.matrix else known
        left = len(block.coordinates) - (a.dof or 0) - finite
        left -= _constants(block)
        found = _integrals(block, left, entries, company) if left > 0 else []
        if found is None or basis is None:
            basis = None
        else:
            basis += [f"{to_text(g)} = 0" for g in a.hidden] + found
    return IntegrablePart(rank=coordinates - outcome.dof, basis=basis)


def _constants(block: Block) -> int:
    """Return the number of constants of an earlier integration, which are coordinates of the block and do not move."""
    return sum(isinstance(r.piece, Still) for r in block.rows)


def _integrals(
    block: Block, number: int, entries: Sequence[ConstraintEntry], company: Companionship
) -> list[str] | None:
    """So many independent integrals of a block; None where fewer were found."""
    owners = {r.constraint for r in block.rows if isinstance(r.piece, Pfaffian)}
    alone = [entries[i].integral for i in owners]
    if number == len(alone) == 1 and alone[0] is not None:
        return [alone[0]]
    found = company.basis(block)
    return found if len(found) == number else None
