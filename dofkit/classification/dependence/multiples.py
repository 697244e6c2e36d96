"""The shortest ways to see that two equations say the same: one is a number times the other, or a polynomial in it.

What is no polynomial in coordinates, parameters, sines, cosines and exponentials is not looked at: a root or a
quotient may have no value where its multiple has one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import fmpq, fmpq_poly

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon, Poly
from dofkit.exact.ring.program import POW
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.tree import ZERO, Expr
from dofkit.relations.normal.pieces import Finite, Normal, Pfaffian, Reduced

#: Generators of a ring that have a value everywhere.
_ENTIRE = frozenset({"symbol", "cos", "sin", "exp", "pi"})


def same_up_to_numbers(given: Sequence[Reduced], wanted: Sequence[Reduced], positive: frozenset[Expr]) -> bool:
    """Is every equation given a number times one that is wanted, as it was written, and each of those met?

    True is a proof that they say the same and are as regular; False says nothing.
    """
    asked = [_terms(n) for r in wanted for n in r.normals]
    answer = [terms for r in given for terms in _written(r)]
    if not answer or [] in asked or [] in answer:
        return False
    table = [[_proportional(one, other, positive) for other in asked] for one in answer]
    return all(map(any, table)) and all(any(row[k] for row in table) for k in range(len(asked)))


def power_of(given: Sequence[Reduced], wanted: Sequence[Reduced], positive: frozenset[Expr]) -> int | None:
    """m where the one equation given is P(g) = 0 for the one g = 0 wanted, and 0 is P's only real root, m times.

    They have the same zeros then, and are as regular where m = 1: u^3 + u = 0 says u = 0, and u^3 = 0 does so worse.
    A number is a proof; None says nothing.
    """
    asked = [n for r in wanted for n in r.normals]
    answer = [relation.expr for r in given for relation in r.constraint.relations]
    terms = _terms(asked[0]) if len(asked) == len(answer) == 1 else []
    if not terms or terms[0][0]:
        return None
    ring = Ring([answer[0], terms[0][1]], positive)
    nodes = ring.node(answer[0]), ring.node(terms[0][1])
    if not _entire(ring):
        return None
    canon = Canon(ring)
    try:
        (h, over), (g, under) = canon.quotient(nodes[0]), canon.quotient(nodes[1])
    except NoValueError:
        return None
    digits = _digits(h, g) if over.is_constant() and under.is_constant() and not g.is_constant() else None
    return None if digits is None else _only_root(fmpq_poly(digits))


def _digits(h: Poly, g: Poly) -> list[fmpq] | None:
    """The c_k of h = c_0 + c_1 g + c_2 g^2 + ..., where there are such numbers."""
    digits: list[fmpq] = []
    while h != 0:
        h, remainder = divmod(h, g)
        if not remainder.is_constant():
            return None
        digits.append(remainder.leading_coefficient() if remainder != 0 else fmpq(0))
    return digits


def _only_root(p: fmpq_poly) -> int | None:
    """How often 0 is a root of p; None where it is none, or not the only real one."""
    low = next((k for k in range(p.degree() + 1) if p[k] != 0), 0)
    remainder = fmpq_poly([p[k] for k in range(low, p.degree() + 1)])
    roots: Any = remainder.numer().complex_roots()
    return low if low and not any(z.imag == 0 for z, _ in roots) else None


def _entire(ring: Ring) -> bool:
    """Have all of its nodes a value everywhere?"""
    kinds = {var.kind for var in ring.vars}
    return kinds <= _ENTIRE and not any(op == POW and p[1] < 0 for op, p in ring.code)


def _written(r: Reduced) -> list[list[tuple[str, Expr]]]:
    """The equations of a constraint before anything was taken out of them; an empty one for what is not looked at."""
    if len(r.normals) != len(r.constraint.relations) or any(n.notes for n in r.normals):
        return [[]]
    result = []
    for normal, relation in zip(r.normals, r.constraint.relations, strict=True):
        terms = _terms(normal)
        result.append([("", relation.expr)] if terms and terms[0][0] == "" else terms)
    return result


def _terms(normal: Normal) -> list[tuple[str, Expr]]:
    """g of g = 0 under no name, or a form's coefficients by coordinate; none of what has branches or conditions."""
    if len(normal.branches) != 1 or len(normal.branches[0]) != 1 or normal.constants:
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
    if not _entire(ring):
        return False
    canon = Canon(ring)
    try:
        result = [(canon.quotient(x)[0], canon.quotient(y)[0]) for x, y in nodes]
    except NoValueError:
        return False
    if any((x == 0) != (y == 0) for x, y in result):
        return False
    remaining = [(x, y) for x, y in result if x != 0]
    if not remaining:
        return False
    c, d = (poly.leading_coefficient() for poly in remaining[0])
    return all(x * d == y * c for x, y in remaining)
