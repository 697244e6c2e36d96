"""The companions of a form: a minimal set of constraints together with which it is integrable, and the integral."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, count, islice

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.classification.freedom.branches import AnsweredBlocks
from dofkit.classification.labels.reasons import Others
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import TIME
from dofkit.integrability import first_integrals
from dofkit.integrability.first_integrals import FirstIntegral
from dofkit.integrability.pfaffian_system import codistribution
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row, split, uses_time
from dofkit.relations.normal.pieces import Pfaffian

#: Blocks up to this many constraints and coordinates are searched for companions and integrals.
MAX_CONSTRAINTS, MAX_COORDINATES = 10, 12


@dataclass(frozen=True)
class CompanionIntegrals:
    """First integrals of some rows: ``by_row``, {row: an integral that can replace it}, and all ``integrals``."""

    by_row: Mapping[int, FirstIntegral]
    integrals: Sequence[FirstIntegral]


@dataclass
class Companionship:
    """Searches for the companions and integrals of constraints, and remembers the integrals of each block.

    ``answered``: answers of parts of blocks, without a reference; ``names``: of the constraints, by number.
    """

    answered: AnsweredBlocks
    names: Sequence[str]
    _integrals: dict[tuple[int, ...], CompanionIntegrals] = field(default_factory=dict)

    def of(self, constraint: int, block: Block, a: Answer) -> Others:
        """Return the companions and the integral of a constraint that is holonomic in its block (answer ``a``)."""
        owners = list(dict.fromkeys(r.constraint for r in block.rows))
        if len(owners) > MAX_CONSTRAINTS or len(block.coordinates) > MAX_COORDINATES or block.nonlinear:
            return Others()
        try:
            kept = self._needed(constraint, block, owners)
            integral = self._integral(constraint, block, kept, a)
            if integral is not None and len(kept) < len(owners) and not self._is_constant(integral, block, a):
                kept = self._needed(constraint, block, owners, a)
                integral = self._integral(constraint, block, owners, a)
        except (OutOfTimeError, ArithmeticError):
            return Others()
        companions = tuple(f"'{self.names[o]}'" for o in kept if o != constraint)
        if integral is None:
            return Others(companions, identically=False, timed=_advances(constraint, block, a))
        timed = self._timed(integral, constraint, block, a)
        return Others(companions, equation(integral, block), integral.identically, timed)

    def _timed(self, f: FirstIntegral, constraint: int, block: Block, a: Answer) -> bool | None:
        """Return whether t occurs in the integral f of a form with a dt term; None if this is ambiguous.

        It is ambiguous if t occurs in other constraints, which may make the dt term 0 or eliminate t: with x = t + C
        the equation zdot = x gives x^2 - 2 z = C, as well as 2 z = t^2 + 2 C t + C1.
        """
        others = Block(block.coordinates, tuple(r for r in block.rows if r.constraint != constraint))
        timed = TIME in f.expr.symbols
        if not uses_time(others):
            return timed
        moving = {r.constraint for r in others.rows if isinstance(r.piece, Pfaffian) and not r.piece.dt.is_zero}
        advances = not timed and any(self._holonomic(o, others.rows, block) for o in moving)
        return None if others.finite or a.hidden or advances else True

    def modulo(self, constraint: int, block: Block, a: Answer) -> Others:
        """Return the geometric equation that is implied by a non-holonomic constraint together with all the others.

        Empty if none is known. ``a``: the answer of the block.
        """
        owners = list(dict.fromkeys(r.constraint for r in block.rows))
        if a.dof is None or len(owners) > MAX_CONSTRAINTS or len(block.coordinates) > MAX_COORDINATES:
            return Others()
        try:
            integral = self._integral(constraint, block, owners, a)
        except (OutOfTimeError, ArithmeticError):
            return Others()
        return Others() if integral is None else Others((), equation(integral, block), integral.identically)

    def _needed(self, constraint: int, block: Block, owners: Sequence[int], a: Answer | None = None) -> list[int]:
        """Return a minimal set of constraints, ``constraint`` included, in which it is holonomic; later ones go first.

        With the block's answer ``a``, an integral in this set must also be constant along the motions of the block.
        """
        kept = list(owners)
        for other in reversed(owners):
            check()
            fewer = [o for o in kept if o != other]
            rows = [r for r in block.rows if r.constraint in fewer]
            if other == constraint or not self._holonomic(constraint, rows, block):
                continue
            integral = None if a is None else self._integral(constraint, block, fewer, a)
            if a is None or integral is None or self._is_constant(integral, block, a):
                kept = fewer
        return kept

    def _is_constant(self, f: FirstIntegral, block: Block, a: Answer) -> bool:
        """Return whether f is constant along every motion of the block.

        An integral of some of its rows need not be: dx = y dz and x = 0 make z constant, but not where y = 0.
        """
        forms = codistribution(block, self.answered.setting, a.hidden, [f.expr])
        return first_integrals.IntegralSearch(forms).is_constant(f.expr)

    def _holonomic(self, constraint: int, rows: Sequence[Row], block: Block) -> bool:
        """Return whether the forms of a constraint are holonomic together with ``rows`` only; False if undecided."""
        for part in split(block.coordinates, rows)[0]:
            linear = _forms_of(constraint, part)
            if linear:
                first = part.rows[0].piece
                if len(part.rows) == 1 and isinstance(first, Pfaffian) and self.answered.is_curved(first):
                    return False
                result = self.answered.of(part)
                if not result.consistent or any(not _true(result, i) for i in linear):
                    return False
        return True

    def _integral(self, constraint: int, block: Block, owners: Sequence[int], a: Answer) -> FirstIntegral | None:
        """Return the integral of a constraint with one form, among those of the rows of ``owners``; None if none."""
        forms = _forms_of(constraint, block)
        return self._integrals_of(block, owners, a).by_row.get(forms[0]) if len(forms) == 1 else None

    def basis(self, block: Block, a: Answer) -> list[str]:
        """Return independent integrals of all the block's rows together, as text."""
        owners = list(dict.fromkeys(r.constraint for r in block.rows))
        if len(owners) > MAX_CONSTRAINTS or len(block.coordinates) > MAX_COORDINATES or block.nonlinear:
            return []
        try:
            integrals = self._integrals_of(block, owners, a).integrals
        except (OutOfTimeError, ArithmeticError):
            return []
        return [equation(f, block, i if len(integrals) > 1 else None) for i, f in enumerate(integrals)]

    def _integrals_of(self, block: Block, owners: Sequence[int], a: Answer) -> CompanionIntegrals:
        """Return the integrals of the block's rows that belong to the constraints ``owners``, searched once."""
        key = (id(block), *owners)  # a block has one answer a
        if key not in self._integrals:
            self._integrals[key] = self._search(block, owners, a)
        return self._integrals[key]

    def _search(self, block: Block, owners: Sequence[int], a: Answer) -> CompanionIntegrals:
        """Search for the integrals of the rows of ``owners``; ``a``: the answer of the block, maybe on one branch."""
        numbers = [i for i, r in enumerate(block.rows) if r.constraint in owners]
        part = Block(block.coordinates, tuple(block.rows[i] for i in numbers))
        of_part = a if len(numbers) == len(block.rows) else self.answered.of(part)
        if of_part.dof is None:
            return CompanionIntegrals({}, [])
        forms = codistribution(part, self.answered.setting, of_part.hidden)
        sought = len(part.coordinates) - of_part.dof - len(part.finite) - len(of_part.hidden)
        integrals = first_integrals.first_integrals(forms, sought)
        shift = forms.finite - len(part.finite)
        by_row = first_integrals.integral_by_row(forms, integrals)
        return CompanionIntegrals({numbers[row - shift]: f for row, f in by_row.items()}, integrals)


def _advances(constraint: int, block: Block, a: Answer) -> bool | None:
    """Return True if t must occur in the integral of a form with the other constraints, else None.

    It must if the form a dq + b dt has b != 0 at a generic point and t is not in the others: the differential of the
    integral is mu (a dq + b dt) plus multiples of forms without dt, so that its derivative by t is mu b.
    """
    numbers = _forms_of(constraint, block)
    others = Block(block.coordinates, tuple(r for r in block.rows if r.constraint != constraint))
    if len(numbers) != 1 or uses_time(others) or a.hidden or not a.matrix:
        return None
    return a.matrix[numbers[0]].get(len(block.coordinates), 0) % a.modulus != 0 or None


def _forms_of(constraint: int, block: Block) -> list[int]:
    return [i for i, r in enumerate(block.rows) if r.constraint == constraint and isinstance(r.piece, Pfaffian)]


def _true(a: Answer, i: int) -> bool:
    """Return whether row i of a block is labelled holonomic."""
    label = a.labels.get(i)
    return label is not None and label.holonomic is True


def equation(f: FirstIntegral, block: Block, number: int | None = None) -> str:
    """Return the text ``f = C``, or with C1, C2, ... if there are several (``number``) or the block has a symbol C."""
    taken = set(block.coordinates)
    for row in block.rows:
        piece = row.piece
        entries = [e for _, e in piece.items()] if isinstance(piece, Pfaffian) else [piece.expr]
        taken |= {str(s.args[1]) for e in entries for s in e.symbols}
    names = (f"C{i}" for i in count(1))
    free = (name for name in (names if number is not None else chain(("C",), names)) if name not in taken)
    return f"{to_text(f.expr)} = {next(islice(free, number or 0, None))}"
