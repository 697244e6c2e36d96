"""Constraints that say what an earlier one wrote already."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Sequence

from dofkit.base.deadline import check
from dofkit.expressions import tree as ex
from dofkit.relations.joint_equations import JointEquation
from dofkit.relations.normal.pieces import Finite, Normal, Pfaffian, Piece
from dofkit.relations.reduced import Reduced


def copies(reduced: Sequence[Reduced]) -> dict[int, int]:
    """Constraints all of whose relations an earlier one wrote already, up to a number: copy -> original.

    Only those are compared that mention the same symbols.
    """
    alike: dict[Hashable, list[int]] = {}
    for i, r in enumerate(reduced):
        check()
        if r.normals and not r.inequalities and not any(_says_nothing(normal) for normal in r.normals):
            alike.setdefault(_mentioned(r.normals), []).append(i)
    seen: dict[Hashable, int] = {}
    found = {}
    for i in sorted(i for numbers in alike.values() if len(numbers) > 1 for i in numbers):
        keys = [_up_to_a_number(normal) for normal in reduced[i].normals]
        key: Hashable = keys[0] if len(keys) == 1 else frozenset(Counter(keys).items())
        if key in seen:
            found[i] = seen[key]
        else:
            seen[key] = i
    return found


def _mentioned(normals: Sequence[Normal]) -> Hashable:
    """The same for relations that are each other's up to a number: what their first pieces mention, in any order."""
    first = [_symbols_of(normal.branches[0]) for normal in normals]
    return first[0] if len(first) == 1 else frozenset(first)


def _symbols_of(branch: Sequence[Piece]) -> Hashable:
    piece = branch[0] if branch else None
    if isinstance(piece, Pfaffian):
        return frozenset(piece.coefficients)
    return piece if piece is None else piece.expr.symbols


def _says_nothing(normal: Normal) -> bool:
    """Is there nothing to compare: it holds always or never, or is not written out, as no other joint is the same?"""
    branches = normal.branches
    return branches in ((), ((),)) or any(isinstance(p, JointEquation) for p in branches[0])


def _up_to_a_number(normal: Normal) -> Hashable:
    return tuple(tuple(_scaled(p) for p in branch) for branch in normal.branches)


def _scaled(piece: object) -> Hashable:
    """A piece with the first coefficient made 1."""
    if isinstance(piece, Finite):
        first = piece.expr.args[0] if piece.expr.op == "add" else piece.expr
        number = first.args[0] if first.op == "mul" and first.args[0].op == "num" else first
        numeric = number.op == "num" and not number.is_zero
        return ex.mul(piece.expr, ex.power(number, ex.MINUS_ONE)) if numeric else piece.expr
    if isinstance(piece, Pfaffian):
        return type(piece), tuple(piece.coefficients.items()), piece.dt
    return piece
