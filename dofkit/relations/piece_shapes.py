"""What relations say, up to names: two pieces of one shape are each other's, renamed, and so is what comes of them."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from dataclasses import replace
from typing import NamedTuple

from dofkit.expressions.renaming import Renaming, order_of, shape_of
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.normal_form import Finite, Inequality, Nonlinear, Normal, Pfaffian, Piece

#: Under which a piece keeps its shape.
_SHAPE = "_shape"


class PieceShape(NamedTuple):
    """A piece without its names (``key``), these in the order in which they first occur, and those that are kept."""

    key: Hashable
    names: tuple[str, ...]
    kept: tuple[str, ...]


def piece_shape(piece: Piece) -> PieceShape:
    """A piece without its names; kept with the piece, which never changes."""
    kept = vars(piece)
    found: PieceShape | None = kept.get(_SHAPE)
    if found is None:
        found = kept[_SHAPE] = _form_shape(piece) if isinstance(piece, Pfaffian) else _shape(piece)
    return found


def _shape(piece: Finite | Nonlinear | Inequality | DomainCondition) -> PieceShape:
    skeleton, names, kept = shape_of(piece.expr)
    return PieceShape((type(piece).__name__, _sense(piece), skeleton), names, kept)


def _sense(piece: Finite | Nonlinear | Inequality | DomainCondition) -> str | bool | None:
    if isinstance(piece, Inequality):
        return piece.strict
    return piece.sense if isinstance(piece, DomainCondition) else None


def _form_shape(form: Pfaffian) -> PieceShape:
    places: dict[str, int] = {}
    kept: set[str] = set()
    parts: list[Hashable] = [type(form).__name__]
    for name, e in _coefficients(form):
        skeleton, names, others = shape_of(e)
        own = -1 if name is None else places.setdefault(name, len(places))
        parts.append((own, skeleton, tuple(places.setdefault(n, len(places)) for n in names)))
        kept.update(others)
    return PieceShape(tuple(parts), tuple(places), tuple(sorted(kept)))


def _coefficients(form: Pfaffian) -> Iterator[tuple[str | None, Expr]]:
    yield from form.coefficients.items()
    yield None, form.dt


def shape_together(pieces: Iterable[Piece]) -> Hashable:
    """Equal for pieces that are each other's, renamed all at once, whose names are sorted in the same order."""
    places: dict[str, int] = {}
    kept: set[str] = set()
    parts = []
    for shape in map(piece_shape, pieces):
        parts.append((shape.key, tuple([places.setdefault(n, len(places)) for n in shape.names])))
        kept.update(shape.kept)
    return tuple(parts), order_of(tuple(places), tuple(kept))


def renamed_normal(normal: Normal, renaming: Renaming) -> Normal:
    """What a relation says, in other names."""
    branches = tuple(tuple(_renamed(piece, renaming) for piece in branch) for branch in normal.branches)
    return replace(normal, branches=branches)


def _renamed(piece: Piece, renaming: Renaming) -> Piece:
    shape, made = piece_shape(piece), _rewritten(piece, renaming)
    vars(made)[_SHAPE] = shape._replace(names=tuple([renaming.names.get(n, n) for n in shape.names]))
    return made


def _rewritten(piece: Piece, renaming: Renaming) -> Piece:
    if isinstance(piece, Pfaffian):
        named = {renaming.names.get(name, name): renaming.of(e) for name, e in piece.coefficients.items()}
        return Pfaffian(named, renaming.of(piece.dt))
    if isinstance(piece, Finite):
        return Finite(renaming.of(piece.expr))
    return replace(piece, expr=renaming.of(piece.expr))
