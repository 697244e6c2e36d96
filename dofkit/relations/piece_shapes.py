"""What relations say, up to names: two pieces of one shape are each other's, renamed, and so is what comes of them."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from dofkit.expressions.renaming import Template, shape_of
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.pieces import Finite, Inequality, Nonlinear, Normal, Pfaffian, Piece

#: Under which a piece keeps its shape.
_SHAPE = "_shape"


class PieceShape(NamedTuple):
    """A piece without its names (``key``), and these in the order in which they first occur."""

    key: Hashable
    names: tuple[str, ...]


def piece_shape(piece: Piece) -> PieceShape:
    """A piece without its names; kept with the piece, which never changes."""
    kept = vars(piece)
    result: PieceShape | None = kept.get(_SHAPE)
    if result is None:
        result = kept[_SHAPE] = _form_shape(piece) if isinstance(piece, Pfaffian) else _shape(piece)
    return result


def _shape(piece: Finite | Nonlinear | Inequality | DomainCondition) -> PieceShape:
    shape = shape_of(piece.expr)
    return PieceShape((type(piece).__name__, _sense(piece), shape.skeleton), shape.names)


def _sense(piece: Finite | Nonlinear | Inequality | DomainCondition) -> str | bool | None:
    if isinstance(piece, Inequality):
        return piece.strict
    return piece.sense if isinstance(piece, DomainCondition) else None


def _form_shape(form: Pfaffian) -> PieceShape:
    places: dict[str, int] = {}
    parts: list[Hashable] = [type(form).__name__]
    for name, e in _coefficients(form):
        shape = shape_of(e)
        own = -1 if name is None else places.setdefault(name, len(places))
        parts.append((own, shape.skeleton, tuple(places.setdefault(n, len(places)) for n in shape.names)))
    return PieceShape(tuple(parts), tuple(places))


def _coefficients(form: Pfaffian) -> Iterator[tuple[str | None, Expr]]:
    yield from form.coefficients.items()
    yield None, form.dt


class NormalTemplate:
    """What a relation with some names says, to be told of others of its shape."""

    def __init__(self, normal: Normal, names: Sequence[str]) -> None:
        self._normal = normal
        self._branches = [[_PieceTemplate(piece, names) for piece in branch] for branch in normal.branches]

    def of(self, names: Sequence[str]) -> Normal:
        """The same in other names."""
        branches = tuple([tuple([piece.of(names) for piece in branch]) for branch in self._branches])
        return self._normal._replace(branches=branches)


class _PieceTemplate:
    """A piece, its expressions as templates with the numbers of their names, and its shape."""

    def __init__(self, piece: Piece, names: Sequence[str]) -> None:
        number = {name: k for k, name in enumerate(names)}
        self._piece, self._shape = piece, piece_shape(piece)
        self._own = [number[n] for n in self._shape.names]
        parts = list(_coefficients(piece)) if isinstance(piece, Pfaffian) else [(None, piece.expr)]
        self._parts = []
        for name, e in parts:
            template = Template(e)
            self._parts.append((number.get(name or "", -1), template, [number[n] for n in template.names]))

    def of(self, names: Sequence[str]) -> Piece:
        """The piece in other names."""
        result = [(k, template.of([names[i] for i in own])) for k, template, own in self._parts]
        made: Piece
        if isinstance(self._piece, Pfaffian):
            made = Pfaffian({names[k]: e for k, e in result[:-1]}, result[-1][1])
        elif isinstance(self._piece, Finite):
            made = Finite(result[0][1])
        else:
            made = replace(self._piece, expr=result[0][1])
        vars(made)[_SHAPE] = PieceShape(self._shape.key, tuple([names[k] for k in self._own]))
        return made
