"""What a relation says: its pieces, branch by branch."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition


@dataclass(frozen=True)
class Finite:
    """g(q, t) = 0."""

    expr: Expr


@dataclass(frozen=True)
class Pfaffian:
    """sum a_i dq_i + b dt = 0; ``coefficients`` by coordinate, without zeros."""

    coefficients: Mapping[str, Expr]
    dt: Expr

    def items(self) -> Iterable[tuple[Expr, Expr]]:
        """(symbol of the coordinate or of time, coefficient) for every coefficient as written."""
        for name, coefficient in self.coefficients.items():
            yield ex.coordinate(name), coefficient
        if not self.dt.is_zero:
            yield ex.TIME, self.dt


class Still(Pfaffian):
    """dC = 0 for a constant of integration C."""

    def __init__(self, constant: str) -> None:
        super().__init__({constant: ex.ONE}, ex.ZERO)


@dataclass(frozen=True)
class Nonlinear:
    """f(q, qdot, t) = 0, not linear in the velocities over the reals."""

    expr: Expr


@dataclass(frozen=True)
class Inequality:
    """g >= 0 or g > 0 (``strict``), finite or in velocities."""

    expr: Expr
    strict: bool = False


#: What a branch of an equation consists of; with inequalities, what a constraint consists of.
Piece = Finite | Pfaffian | Nonlinear | DomainCondition
Clause = Piece | Inequality
#: All pieces of a branch hold together; one of the branches holds. No branch: nothing satisfies it.
Branches = tuple[tuple[Piece, ...], ...]


class Normal(NamedTuple):
    """What a relation says, and what was done to see it.

    ``constants``: coordinates that stand for constants of an integration by time, which ``once`` tells.
    """

    branches: Branches
    notes: tuple[str, ...] = ()
    constants: tuple[str, ...] = ()
    once: str = ""

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Every piece of every branch that is a relation."""
        if len(self.branches) == 1 and len(self.branches[0]) == 1:
            return () if isinstance(self.branches[0][0], DomainCondition) else self.branches[0]
        return tuple(piece for branch in self.branches for piece in branch if not isinstance(piece, DomainCondition))


def with_constants(piece: Piece, values: Mapping[str, Expr]) -> Piece:
    """``piece`` with constants of integration replaced by parameters or values: what it says for one initial state."""
    if not values:
        return piece
    mapping = {ex.coordinate(c): value for c, value in values.items()}
    if isinstance(piece, Pfaffian):
        named = {name: substitute(e, mapping) for name, e in piece.coefficients.items()}
        return Pfaffian(named, substitute(piece.dt, mapping))
    return replace(piece, expr=substitute(piece.expr, mapping))
