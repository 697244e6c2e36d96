"""The types of normal forms: pieces, branches, clauses; and which relations are equal up to names."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence
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
QUADRATIC_NOTE = "over the real numbers the relation between velocities splits into linear ones"
INSTANT_NOTE = "a factor that vanishes only at instants of time was taken out"


@dataclass(frozen=True)
class Finite:
    """g(q, t) = 0."""

    expr: Expr


@dataclass(frozen=True)
class Pfaffian:
    """sum a_i dq_i + b dt = 0: nonzero ``coefficients`` a_i by coordinate, and b = ``dt``."""

    coefficients: Mapping[str, Expr]
    dt: Expr

    def items(self) -> Iterable[tuple[Expr, Expr]]:
        """Yield (symbol of the coordinate or of time, coefficient) for every nonzero coefficient."""
        for name, coefficient in self.coefficients.items():
            yield ex.coordinate(name), coefficient
        if not self.dt.is_zero:
            yield ex.TIME, self.dt

    @property
    def rate(self) -> Expr:
        """The form divided by dt: sum a_i qdot_i + b."""
        return ex.add(*(e * ex.velocity(name) for name, e in self.coefficients.items()), self.dt)

    @property
    def components(self) -> dict[Expr, Expr]:
        """The coefficient of every coordinate (and time) that occurs, 0 for those that occur in coefficients only."""
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


#: A branch of an equation consists of pieces, a constraint of clauses.
Piece = Finite | Pfaffian | Nonlinear | DomainCondition
Clause = Piece | Inequality
#: A point satisfies an equation if it satisfies all pieces of one branch. Without branches the solution set is empty.
Branches = tuple[tuple[Piece, ...], ...]


class Normal(NamedTuple):
    """The normal form of a relation: its branches, and notes for the user on how they were obtained."""

    branches: Branches
    notes: tuple[str, ...] = ()

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The pieces of all branches that are equations, not conditions."""
        if len(self.branches) == 1 and len(self.branches[0]) == 1:
            return () if isinstance(self.branches[0][0], DomainCondition) else self.branches[0]
        return tuple(piece for branch in self.branches for piece in branch if not isinstance(piece, DomainCondition))


class JointEquation(Finite):
    """g(q) = 0: equation ``number`` of a ``joint``; its ``expr`` is computed at first use."""

    def __init__(self, joint: Unwritten[Relation], number: int) -> None:
        object.__setattr__(self, "joint", joint)
        object.__setattr__(self, "number", number)

    joint: Unwritten[Relation]
    number: int

    def __getattr__(self, name: str) -> Expr:
        """Compute and set ``expr``, which is not set by __init__."""
        if name != "expr":
            raise AttributeError(name)
        written = self.joint[self.number].expr
        object.__setattr__(self, "expr", written)
        return written


def unwritten(joint: Unwritten[Relation]) -> tuple[Normal, ...]:
    """Return the normal forms of a joint's equations, not written out; each is one regular geometric equation."""
    return tuple(Normal(((JointEquation(joint, k),),)) for k in range(len(joint)))


class Reduced(NamedTuple):
    """A constraint with the normal form of each equation, its ``inequalities``, and the equations as ``written``."""

    constraint: Constraint
    normals: tuple[Normal, ...]
    inequalities: tuple[Inequality, ...]
    written: Sequence[Relation] = ()

    @property
    def equations(self) -> int:
        return len(self.normals)

    def domain(self, inequalities: bool = False) -> tuple[DomainCondition, ...]:
        """Return the conditions, in velocities, for a value of the written equations (and of ``inequalities``)."""
        relations = self.constraint.relations
        if isinstance(relations, Unwritten) or not (self.normals or self.inequalities):
            return ()
        selected = (r for r in relations if r.sense == "=" or inequalities)
        written = ((in_velocities(e)[0], sense) for r in selected for e, sense in r.domain)
        return tuple(dict.fromkeys(DomainCondition(*required) for required in written))


#: The attribute of a piece in which its shape is kept.
_SHAPE = "_shape"


class PieceShape(NamedTuple):
    """The structure of a piece without names (``key``), and its names in the order in which they first occur."""

    key: Hashable
    names: tuple[str, ...]


def piece_shape(piece: Piece) -> PieceShape:
    """Return the shape of a piece; equal keys mean equality up to names. It is kept with the (immutable) piece."""
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
    """Return the shape of a form: equal for forms that are equal up to names."""
    places: dict[str, int] = {}
    key: list[Hashable] = [type(form).__name__]
    for name, e in (*form.coefficients.items(), (None, form.dt)):
        shape = shape_of(e)
        place = -1 if name is None else places.setdefault(name, len(places))
        key.append((place, shape.skeleton, tuple(places.setdefault(n, len(places)) for n in shape.names)))
    return PieceShape(tuple(key), tuple(places))


def in_names(normal: Normal, renaming: Renaming) -> Normal:
    """Return a normal form with other names."""
    branches = [tuple([_renamed(piece, renaming) for piece in branch]) for branch in normal.branches]
    return normal._replace(branches=tuple(branches))


def _renamed(piece: Piece, renaming: Renaming) -> Piece:
    """Return a piece with other names; its shape is set from that of the original."""
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
