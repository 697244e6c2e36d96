"""Constants of an integration by time: coordinates of their own that do not move (dC = 0).

As coordinates they may be fixed by what the other constraints say, which a generic parameter may not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.terms import linear_terms
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row, coordinates_of


def with_rows(rows: Sequence[Row], constants: Mapping[str, Row]) -> list[Row]:
    """The rows and, for every constant of integration C that they mention, dC = 0."""
    mentioned = frozenset().union(*(coordinates_of(r.piece) for r in rows)) if constants else frozenset[str]()
    return [*rows, *(row for c, row in constants.items() if c in mentioned)]


def names_in(rows: Sequence[Row], constants: Mapping[str, Row]) -> list[str]:
    """The constants of integration whose dC = 0 is among the rows."""
    kept = {id(row.piece) for row in rows} if constants else set()
    return [c for c, row in constants.items() if id(row.piece) in kept]


def about_constants(g: Expr, constants: Sequence[str]) -> bool:
    """Does a relation hold between constants of integration only?"""
    return all(s.args[0] == "parameter" or s.args[1] in constants for s in g.symbols)


def fixed_constants(hidden: Sequence[Expr], constants: Sequence[str]) -> dict[str, Expr]:
    """The constants that linear relations among them give in terms of parameters and the other constants."""
    found: dict[str, Expr] = {}
    for g in hidden if constants else ():
        if not about_constants(g, constants):
            continue
        left = substitute(g, {ex.coordinate(c): value for c, value in found.items()})
        terms = linear_terms(left)
        for c in reversed(constants):
            s = ex.coordinate(c)
            if s in terms and not any(s in u.symbols for u in terms if u != s):
                value = ex.ZERO - (left - ex.mul(ex.num(terms[s]), s)) / ex.num(terms[s])
                found = {k: substitute(v, {s: value}) for k, v in found.items()} | {c: value}
                break
    named = {ex.coordinate(c): ex.parameter(c) for c in constants}
    return {c: substitute(value, named) for c, value in found.items()}
