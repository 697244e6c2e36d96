"""What a relation says: its pieces, branch by branch, and which relations are equal up to names."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import in_velocities
from dofkit.expressions.renaming import Renaming, Unwritten, shape_of
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.domain import DomainCondition
from dofkit.system import Constraint, Relation

REGION_NOTE = (
    "for one sign of the argument of abs() or of the root it is satisfied on a whole region, where it does "
    "not reduce the number of degrees of freedom"
)
NOWHERE_NOTE = "no real configuration satisfies it, because it has no real value anywhere"
SQUARED_NOTE = "the root was removed by squaring, with the sign of the other side as a condition"
UNDONE_NOTE = "the arctangent of the velocities was inverted"
QUADRATIC_NOTE = "over the real numbers the relation between velocities splits into linear ones"
INSTANT_NOTE = "a factor that vanishes only at instants of time was taken out"


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

    @property
    def rate(self) -> Expr:
        """The form with velocities in place of differentials."""
        return ex.add(*(e * ex.velocity(name) for name, e in self.coefficients.items()), self.dt)

    @property
    def components(self) -> dict[Expr, Expr]:
        """The coefficient of every symbol that occurs, 0 for those that only coefficients mention."""
        written = dict(self.items())
        mentioned = {s for e in written.values() for s in e.symbols if s.args[0] in ("coordinate", "time")}
        return written | dict.fromkeys(sorted(mentioned - written.keys(), key=repr), ex.ZERO)


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
    """What a relation says, and what was done to see it."""

    branches: Branches
    notes: tuple[str, ...] = ()

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """Every piece of every branch that is a relation."""
        if len(self.branches) == 1 and len(self.branches[0]) == 1:
            return () if isinstance(self.branches[0][0], DomainCondition) else self.branches[0]
        return tuple(piece for branch in self.branches for piece in branch if not isinstance(piece, DomainCondition))


class JointEquation(Finite):
    """g(q) = 0: equation ``number`` of the ``joint``, whose ``expr`` is written out when it is asked for."""

    def __init__(self, joint: Unwritten[Relation], number: int) -> None:
        object.__setattr__(self, "joint", joint)
        object.__setattr__(self, "number", number)

    joint: Unwritten[Relation]
    number: int

    def __getattr__(self, name: str) -> Expr:
        if name != "expr":
            raise AttributeError(name)
        written = self.joint[self.number].expr
        object.__setattr__(self, "expr", written)
        return written


def unwritten(joint: Unwritten[Relation]) -> tuple[Normal, ...]:
    """The equations of a joint as they stand: each says one thing over the reals."""
    return tuple(Normal(((JointEquation(joint, k),),)) for k in range(len(joint)))


class Reduced(NamedTuple):
    """A constraint with every relation reduced; ``inequalities`` apart. ``written``: the relation of each normal."""

    constraint: Constraint
    normals: tuple[Normal, ...]
    inequalities: tuple[Inequality, ...]
    written: Sequence[Relation] = ()

    @property
    def equations(self) -> int:
        return len(self.normals)

    def domain(self, inequalities: bool = False) -> tuple[DomainCondition, ...]:
        """Where its equations (and ``inequalities``) have a value as written; in velocities, not differentials."""
        relations = self.constraint.relations
        if isinstance(relations, Unwritten) or not (self.normals or self.inequalities):
            return ()
        asked = (r for r in relations if r.sense == "=" or inequalities)
        written = ((in_velocities(e)[0], sense) for r in asked for e, sense in r.domain)
        return tuple(dict.fromkeys(DomainCondition(*required) for required in written))


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
    key: list[Hashable] = [type(form).__name__]
    for name, e in _coefficients(form):
        shape = shape_of(e)
        place = -1 if name is None else places.setdefault(name, len(places))
        key.append((place, shape.skeleton, tuple(places.setdefault(n, len(places)) for n in shape.names)))
    return PieceShape(tuple(key), tuple(places))


def _coefficients(form: Pfaffian) -> Iterator[tuple[str | None, Expr]]:
    yield from form.coefficients.items()
    yield None, form.dt


def in_names(normal: Normal, renaming: Renaming) -> Normal:
    """Return what a relation says in other names."""
    branches = [tuple([_renamed(piece, renaming) for piece in branch]) for branch in normal.branches]
    return normal._replace(branches=tuple(branches))


def _renamed(piece: Piece, renaming: Renaming) -> Piece:
    names, shape, renamed = renaming.names, piece_shape(piece), renaming.of
    renamed_piece: Piece
    if isinstance(piece, Pfaffian):
        renamed_piece = Pfaffian(
            {names.get(n, n): renamed(e) for n, e in piece.coefficients.items()}, renamed(piece.dt)
        )
    else:
        renamed_piece = replace(piece, expr=renamed(piece.expr))
    vars(renamed_piece)[_SHAPE] = PieceShape(shape.key, tuple([names.get(n, n) for n in shape.names]))
    return renamed_piece
