"""Blocks that differ in the names of their coordinates only: one of them is answered, the others take its answer."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer, Size
from dofkit.relations.blocks import Block, coordinates_of, expressions
from dofkit.relations.normal.normal_form import Pfaffian, Piece
from dofkit.relations.setting import Setting


def alike(block: Block, setting: Setting, roles: Mapping[str, tuple[str | None, str]]) -> Hashable:
    """Equal for blocks that are the same up to the names of coordinates and of generic geometry.

    What the engines know of a block goes in: its rows, and its coordinates' places in the drawing, values and roles.
    """
    symbols = [ex.coordinate(c) for c in block.coordinates]
    everything = [*expressions(block), *(c.expr for c in block.conditions)]
    mentioned = frozenset[Expr]().union(*(e.symbols for e in everything))
    generic = [p for p in setting.generic if p in mentioned]
    names = {s: ex.coordinate(f"_{i}") for i, s in enumerate(symbols)}
    names |= {p: ex.parameter(f"_{i}") for i, p in enumerate(generic)}
    names |= {ex.velocity(c): ex.velocity(f"_{i}") for i, c in enumerate(block.coordinates)}
    owners: dict[str | None, int] = {}
    return (
        tuple(_renamed(row.piece, names) for row in block.rows),
        tuple((c.sense, substitute(c.expr, names)) for c in block.conditions),
        tuple(_value(setting.pose, s) for s in (*symbols, *generic)),
        None if setting.reference is None else tuple(_value(setting.reference, s) for s in (*symbols, *generic)),
        tuple(_role(roles.get(c), owners) for c in block.coordinates),
        tuple(_kind(p, setting) for p in generic),
    )


def _value(values: Mapping[Expr, Expr], symbol: Expr) -> Expr | None:
    return values.get(symbol)


def _role(found: tuple[str | None, str] | None, owners: dict[str | None, int]) -> Hashable:
    if found is None:
        return None
    owner, role = found
    return (None if owner is None else owners.setdefault(owner, len(owners)), role)


def _kind(p: Expr, setting: Setting) -> Hashable:
    return (str(p.args[1])[:2], p in setting.positive)


def _renamed(piece: Piece, names: Mapping[Expr, Expr]) -> Hashable:
    if isinstance(piece, Pfaffian):
        forms = tuple((substitute(s, names), substitute(a, names)) for s, a in piece.items())
        return (type(piece).__name__, forms)
    return (type(piece).__name__, substitute(piece.expr, names))


def nameless(piece: Piece) -> Hashable:
    """Equal for pieces that are the same up to the names of their coordinates."""
    names: dict[Expr, Expr] = {}
    for i, c in enumerate(sorted(coordinates_of(piece))):
        names[ex.coordinate(c)] = ex.coordinate(f"_{i}")
        names[ex.velocity(c)] = ex.velocity(f"_{i}")
    return _renamed(piece, names)


def retold(a: Answer, own: Sequence[str], other: Sequence[str]) -> Answer:
    """The answer of a block with the coordinates ``own`` for its twin with the coordinates ``other``."""
    names = dict(zip(own, other, strict=True))
    symbols = {ex.coordinate(x): ex.coordinate(y) for x, y in names.items()}
    return replace(
        a,
        labels=dict(a.labels),
        reasons=list(a.reasons),
        hidden=[substitute(g, symbols) for g in a.hidden],
        dependent=tuple(names.get(c, c) for c in a.dependent),
        size=Size(),
    )
