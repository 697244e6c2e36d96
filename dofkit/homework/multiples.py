"""The shortest way to see that two equations say the same: one is a number times the other.

What is no polynomial in coordinates, parameters, sines, cosines and exponentials is not looked at: a root or a
quotient may have no value where its multiple has one.
"""

from __future__ import annotations

from collections.abc import Sequence

from flint.utils.flint_exceptions import DomainError

from dofkit.exact.canon import Canon, TooLargeError
from dofkit.exact.ring import POW, Ring
from dofkit.expr import ZERO, Expr
from dofkit.normal import Finite, Normal, Pfaffian
from dofkit.solving import Reduced

#: Generators of a ring that have a value everywhere.
_ENTIRE = frozenset({"symbol", "cos", "sin", "exp", "pi"})


def same_up_to_numbers(given: Sequence[Reduced], wanted: Sequence[Reduced], positive: frozenset[Expr]) -> bool:
    """Is every equation given a number times one that is wanted, as it was written, and each of those met?

    True is a proof that they say the same and are as regular; False says nothing.
    """
    asked = [_terms(n) for r in wanted for n in r.normals]
    told = [terms for r in given for terms in _written(r)]
    if not told or [] in asked or [] in told:
        return False
    table = [[_proportional(one, other, positive) for other in asked] for one in told]
    return all(map(any, table)) and all(any(row[k] for row in table) for k in range(len(asked)))


def _written(r: Reduced) -> list[list[tuple[str, Expr]]]:
    """The equations of a constraint before anything was taken out of them; an empty one for what is not looked at."""
    if len(r.normals) != len(r.constraint.relations) or any(n.notes for n in r.normals):
        return [[]]
    found = []
    for normal, relation in zip(r.normals, r.constraint.relations, strict=True):
        terms = _terms(normal)
        found.append([("", relation.expr)] if terms and terms[0][0] == "" else terms)
    return found


def _terms(normal: Normal) -> list[tuple[str, Expr]]:
    """g of g = 0 under no name, or a form's coefficients by coordinate; none of what has branches or conditions."""
    if len(normal.branches) != 1 or len(normal.branches[0]) != 1 or normal.constants or normal.kinked:
        return []
    (piece,) = normal.branches[0]
    if isinstance(piece, Finite):
        return [("", piece.expr)]
    if type(piece) is Pfaffian:
        return [*sorted(piece.coefficients.items()), ("dt", piece.dt)]
    return []


def _proportional(a: Sequence[tuple[str, Expr]], b: Sequence[tuple[str, Expr]], positive: frozenset[Expr]) -> bool:
    """Is one number c, not 0, such that every a_i = c b_i identically? Proved in the canonical ring."""
    first, second = dict(a), dict(b)
    names = sorted(first.keys() | second.keys())
    pairs = [(first.get(name, ZERO), second.get(name, ZERO)) for name in names]
    ring = Ring([e for pair in pairs for e in pair], positive)
    nodes = [(ring.node(x), ring.node(y)) for x, y in pairs]
    if any(var.kind not in _ENTIRE for var in ring.vars) or any(op == POW and p[1] < 0 for op, p in ring.code):
        return False
    canon = Canon(ring)
    try:
        found = [(canon.quotient(x)[0], canon.quotient(y)[0]) for x, y in nodes]
    except (TooLargeError, DomainError, ZeroDivisionError):
        return False
    if any((x == 0) != (y == 0) for x, y in found):
        return False
    left = [(x, y) for x, y in found if x != 0]
    if not left:
        return False
    c, d = (poly.leading_coefficient() for poly in left[0])
    return all(x * d == y * c for x, y in left)
