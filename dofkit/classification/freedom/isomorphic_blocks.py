"""Blocks that differ in the names of their coordinates only: one of them is answered, the others take its answer."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Mapping, Sequence
from copy import copy
from typing import NamedTuple

from dofkit.base.deadline import check
from dofkit.expressions import tree as ex
from dofkit.expressions.renaming import Renaming
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer, AnsweredPart, Size
from dofkit.relations.blocks import Block
from dofkit.relations.normal.pieces import Finite, JointEquation, Normal, Pfaffian, Piece, Reduced
from dofkit.relations.piece_shapes import piece_shape
from dofkit.relations.setting import Setting

#: Owner and role of what is no coordinate of the system.
_FREE = (None, "")


class Likeness(NamedTuple):
    """``key``: equal for blocks that are the same up to ``names``: of coordinates, and of generic geometry after them.

    The name at one place of the one stands for that at the same place of the other, one for one.
    """

    key: Hashable
    names: tuple[str, ...]


class Likenesses:
    """What blocks of one system are compared by.

    What the engines know of a block goes in: its rows, which of them are measured, and its coordinates' places in the
    drawing, values and roles. Of names only who owns which coordinate counts, and which is the same as which.
    """

    def __init__(self, setting: Setting, roles: Mapping[str, tuple[str | None, str]]) -> None:
        self._setting, self._roles = setting, roles
        self._generic = {str(p.args[1]): k for k, p in enumerate(setting.generic)}
        self._positive = frozenset(str(p.args[1]) for p in setting.positive)
        self._pose = _by_name(setting.pose)
        self._reference = None if setting.reference is None else _by_name(setting.reference)

    def of(self, block: Block) -> Likeness:
        """What one block is compared by."""
        shapes = [piece_shape(p) for p in (*(row.piece for row in block.rows), *block.conditions)]
        known = self._generic
        mentioned = {n for shape in shapes for n in shape.names if n in known}
        generic = sorted(mentioned, key=known.__getitem__)
        names = (*block.coordinates, *generic)
        places: dict[str, int] = {name: k for k, name in enumerate(names)}
        measured = self._setting.geometric if self._setting.tolerance is not None else frozenset[int]()
        key = (
            len(block.coordinates),
            len(block.rows),
            tuple([(shape.key, tuple([places.get(n, n) for n in shape.names])) for shape in shapes]),
            tuple([self._pose.get(n) for n in names]) if self._pose else (),
            None if self._reference is None else tuple([self._reference.get(n) for n in names]),
            self._roles_of(block),
            tuple([(p[:2], p in self._positive) for p in generic]),
            tuple([row.constraint in measured for row in block.rows]) if measured else (),
        )
        return Likeness(key, names)

    def _roles_of(self, block: Block) -> Hashable:
        owners: dict[str | None, int] = {None: -1}
        roles, tilts, found = self._roles, self._setting.tilts, []
        for name in block.coordinates:
            owner, role = roles.get(name, _FREE)
            found.append((owners.setdefault(owner, len(owners)), role, name in tilts))
        return tuple(found)


def _by_name(values: Mapping[Expr, Expr]) -> dict[str, Expr]:
    return {str(s.args[1]): value for s, value in values.items()}


class AnsweredBlock(NamedTuple):
    """A block by its names, and its answer."""

    block: Block
    names: tuple[str, ...]
    answer: Answer

    def answer_of_twin(self, twin: Block, names: tuple[str, ...]) -> Answer:
        """The answer for a twin with other names."""
        a = copy(self.answer)
        renaming = Renaming(dict(zip(self.names, names, strict=True)))
        a.labels, a.reasons, a.size = dict(a.labels), list(a.reasons), Size()
        a.hidden = [renaming.of(g) for g in a.hidden]
        a.dependent = tuple([renaming.names.get(c, c) for c in a.dependent])
        if a.witness is not None:
            a.witness = {renaming.of(s): text for s, text in a.witness.items()}
        if a.real is not None:
            a.real = a.real._replace(names=tuple([renaming.names.get(n, n) for n in a.real.names]))
        if a.conflict:
            owners = {r.constraint: s.constraint for r, s in zip(self.block.rows, twin.rows, strict=True)}
            a.conflict = tuple(sorted(owners[i] for i in a.conflict))
        if a.parts is not None:
            a.parts = tuple([self._part_of(part, twin, names, renaming) for part in a.parts])
        return a

    def _part_of(self, part: AnsweredPart, twin: Block, names: tuple[str, ...], renaming: Renaming) -> AnsweredPart:
        """A part of the block as that of its twin."""
        rows = dict(zip(map(id, self.block.rows), twin.rows, strict=True))
        conditions = dict(zip(map(id, self.block.conditions), twin.conditions, strict=True))
        own = Block(
            tuple([renaming.names[c] for c in part.block.coordinates]),
            tuple([rows[id(r)] for r in part.block.rows]),
            tuple([conditions[id(c)] for c in part.block.conditions]),
        )
        return AnsweredPart(own, AnsweredBlock(part.block, self.names, part.answer).answer_of_twin(own, names))


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
