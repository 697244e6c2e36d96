"""Blocks that are equal up to the names of their coordinates (twins): one is analysed, the others take its answer."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from copy import copy
from typing import NamedTuple

from dofkit.expressions.renaming import Renaming
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer, Size
from dofkit.relations.blocks import Block
from dofkit.relations.normal.pieces import piece_shape
from dofkit.relations.setting import Setting

#: Owner and role of a name that is not a coordinate of the system.
_FREE = (None, "")


class Likeness(NamedTuple):
    """``key``: equal for blocks that are equal up to ``names``, of coordinates, then unnamed parameters, in order."""

    key: Hashable
    names: tuple[str, ...]


class Likenesses:
    """Computes the likeness of blocks of one system.

    It consists of all that the engines use: the rows, which of them have a tolerance, and the coordinates' values and
    roles. Names of coordinates and owners matter only by their equality.
    """

    def __init__(self, setting: Setting) -> None:
        self._setting, self._roles = setting, {c.name: (c.owner, c.role) for c in setting.roles}
        self._generic = {str(p.args[1]): k for k, p in enumerate(setting.generic)}
        self._pose = _by_name(setting.pose)
        self._reference = None if setting.reference is None else _by_name(setting.reference)

    def of(self, block: Block) -> Likeness:
        """Return the likeness of a block."""
        shapes = [piece_shape(p) for p in (*(row.piece for row in block.rows), *block.conditions)]
        numbers = self._generic
        mentioned = {n for shape in shapes for n in shape.names if n in numbers}
        generic = sorted(mentioned, key=numbers.__getitem__)
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
            tuple([p[:2] for p in generic]),
            tuple([row.constraint in measured for row in block.rows]) if measured else (),
        )
        return Likeness(key, names)

    def _roles_of(self, block: Block) -> Hashable:
        owners: dict[str | None, int] = {None: -1}
        roles, tilts, result = self._roles, self._setting.tilts, []
        for name in block.coordinates:
            owner, role = roles.get(name, _FREE)
            result.append((owners.setdefault(owner, len(owners)), role, name in tilts))
        return tuple(result)


def _by_name(values: Mapping[Expr, Expr]) -> dict[str, Expr]:
    return {str(s.args[1]): value for s, value in values.items()}


class AnsweredBlock(NamedTuple):
    """A block with its names (as in `Likeness`) and its answer."""

    block: Block
    names: tuple[str, ...]
    answer: Answer

    def answer_of_twin(self, twin: Block, names: tuple[str, ...]) -> Answer:
        """Return the answer for a twin with other names."""
        a = copy(self.answer)
        renaming = Renaming(dict(zip(self.names, names, strict=True)))
        a.labels, a.reasons, a.size = dict(a.labels), list(a.reasons), Size()
        a.hidden = [renaming.of(g) for g in a.hidden]
        a.hidden_branches = [[renaming.of(g) for g in branch] for branch in a.hidden_branches]
        a.dependent = tuple([renaming.names.get(c, c) for c in a.dependent])
        if a.witness is not None:
            a.witness = {renaming.of(s): text for s, text in a.witness.items()}
        if a.real is not None:
            a.real = a.real._replace(names=tuple([renaming.names.get(n, n) for n in a.real.names]))
        if a.conflict:
            owners = {r.constraint: s.constraint for r, s in zip(self.block.rows, twin.rows, strict=True)}
            a.conflict = tuple(sorted(owners[i] for i in a.conflict))
        return a
