"""Are a ring's generators independent? Where they may be related in a way the ring does not know, GF(p) misleads."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any, Literal

from flint import fmpq_mat, nmod_poly

from dofkit.exact.errors import NoPointError, NoValueError
from dofkit.exact.points.characters import MOST_REDUCED
from dofkit.exact.points.field import FieldPoint, field_point
from dofkit.exact.ring.canonical import Canon, divided
from dofkit.exact.ring.program import VAR, Var, reachable, value_of
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr

Doubt = Literal["numbers", "functions"]
#: Entries of a matrix that tells whether arguments are independent.
MOST_TERMS = 20_000
INVERSE = ("asin", "atan", "atan2")


def odd_constants(ring: Ring) -> bool:
    """Do constants occur that may be related (nested roots, inverse functions and logarithms of numbers)?"""
    constant = [v for v in ring.vars if not ring.var_expr[v.index].symbols]
    return any(v.kind in (*INVERSE, "log", "sign") or _root_of_more(v) for v in constant)


def independent_generators(ring: Ring) -> bool:
    """True where the generators are algebraically independent up to the relations that the ring knows.

    Symbols, sines, cosines and exponentials of different terms are [Ax1971], and so are unknown functions, square
    roots of different primes and one root of what is linear in a symbol, so no power itself, and one transcendental
    constant. False says that a relation may have been missed: other roots, inverse functions, logarithms, constants.
    """
    roots = 0
    for var in ring.vars:
        if var.kind in (*INVERSE, "log", "sign"):
            return False
        if _root_of_more(var):
            roots += 1
            if not _linear_somewhere(ring.var_expr[var.index].args[0]):
                return False
    independent = all(_independent_arguments(ring, kind) for kind in ("cos", "exp"))
    return roots < 2 and not ring.related and independent and _one_constant(ring)


def _one_constant(ring: Ring) -> bool:
    """Is there at most one transcendental constant: pi, or the exponential or angle of one rational number?

    These are transcendental [Lindemann1882]; of two of them it is not known, or they are related as e and e^1000 are.
    """
    constants = [v for v in ring.vars if not ring.var_expr[v.index].symbols]
    found = {
        ("pi", ex.PI) if v.kind == "pi" else (v.kind.replace("sin", "cos"), v.key[0])
        for v in constants
        if v.kind in ("pi", "cos", "sin", "exp")
    }
    return len(found) < 2 and all(kind == "pi" or _is_rational(e) for kind, e in found)


def _is_rational(e: Expr) -> bool:
    """A product of numbers that are not 0, as written."""
    return all(part.op == "num" and not part.is_zero for part in (e.args if e.op == "mul" else (e,)))


def independent_on_set(ring: Ring, relations: Sequence[object]) -> bool:
    """The same where some relations hold.

    There arguments may be related that are not related as written: of few of them a point tells (`characters`); of
    more only what is equal, or a sum, so that no other argument may occur than a symbol.
    """
    return independent_generators(ring) and not (
        relations and any(_out_of_reach(ring, kind) for kind in ("cos", "exp"))
    )


def _out_of_reach(ring: Ring, kind: str) -> bool:
    moving = [v for v in ring.vars if v.kind == kind and ring.var_expr[v.index].symbols]
    return len(moving) > MOST_REDUCED and not all(_of_symbol(v) for v in moving)


def _of_symbol(var: Var) -> bool:
    return isinstance(var.key[0], Expr) and var.key[0].op == "sym"


def _independent_arguments(ring: Ring, kind: str) -> bool:
    """Are the arguments of all exponentials, or of all angles, linearly independent over Q modulo constants? [Ax1971].

    They are put over one denominator L: then so are their numerators together with L. False where they grow too large.
    """
    moving = [v for v in ring.vars if v.kind == kind and ring.var_expr[v.index].symbols]
    if len(moving) < 2 or all(_of_symbol(v) for v in moving):
        return True
    canon = Canon(ring)
    try:
        pairs = [canon.quotient(v.args[0]) for v in moving]
        below = canon.one
        for _, bottom in pairs:
            below = below * divided(bottom, below.gcd(bottom))
        rows = [below, *(top * divided(below, bottom) for top, bottom in pairs)]
    except NoValueError:
        return False
    terms = sorted({m for row in rows for m in row.to_dict()})
    if len(rows) * len(terms) > MOST_TERMS:
        return False
    matrix = fmpq_mat([[row.to_dict().get(m, 0) for m in terms] for row in rows])
    return bool(matrix.rref()[1] == len(rows))


def _root_of_more(var: Var) -> bool:
    """A root of something else than a prime number."""
    return var.kind == "root" and not isinstance(var.key[0], Expr)


def _linear_somewhere(e: Expr) -> bool:
    """Is ``e`` of degree 1 in one of its symbols?"""
    slopes = ((s, diff(e, s)) for s in e.symbols)
    return any(not slope.is_zero and s not in slope.symbols for s, slope in slopes)


def doubt(ring: Ring) -> Doubt | None:
    """May what is 0 look like something else over GF(p), or a root stand there for the other one?

    Of numbers only, or of functions: these may be 0 in one region and not in another, so that no point decides. Less is
    asked than of `independent_generators`: no proof rests on the answer, but where it is None no relation among the
    generators is known to be possible. Roots and logarithms of pairwise coprime polynomials have none [Ostrowski1946],
    and a square root of what is no square is as good as its negative.
    """
    if _related_functions(ring):
        return "functions"
    return "numbers" if odd_constants(ring) else None


def _related_functions(ring: Ring) -> bool:
    """May functions of the variables be related?"""
    moving = [v for v in ring.vars if ring.var_expr[v.index].symbols]
    kinds = [v.kind for v in moving]
    if sum(kind in INVERSE for kind in kinds) + kinds.count("sign") > 1:
        return True
    if ring.related or _odd_arguments(moving) or not all(_changes_sign(ring, v) for v in moving if v.kind == "sign"):
        return True
    roots = [v for v in moving if _root_of_more(v)]
    logs = [v for v in moving if v.kind == "log"]
    return not (_apart(ring, roots, squares=True) and (len(logs) < 2 or _apart(ring, logs, squares=False)))


def _changes_sign(ring: Ring, var: Var) -> bool:
    """Is the argument of a sign linear in a symbol, so that both signs occur?"""
    shown = ring.var_expr[var.index]
    return any(_linear_somewhere(node.args[1]) for node in ex.nodes(shown) if node.op == "fn" and node.args[0] == "abs")


def _odd_arguments(moving: Sequence[Var]) -> bool:
    """Are there several sines or exponentials, one of them of something that is no polynomial?"""
    angles = [v for v in moving if v.kind in ("cos", "exp")]
    if len(angles) < 2:
        return False
    return any(_beyond_polynomials(v.key[0]) for v in angles)


def _beyond_polynomials(e: Expr) -> bool:
    """Do quotients, roots or functions occur?"""
    return any(
        node.op == "fn" or (node.op == "pow" and (node.args[1].op != "num" or not _natural(node.args[1])))
        for node in ex.nodes(e)
    )


def _natural(exponent: Expr) -> bool:
    value = exponent.args[0]
    return bool(value.denominator == 1 and value > 0)


class _LinePoint:
    """Random values in GF(p), but for one symbol, which is the unknown of polynomials."""

    def __init__(self, base: FieldPoint, index: int) -> None:
        self.base, self.index = base, index
        self.unknown = nmod_poly([0, 1], base.p)

    def number(self, value: Any) -> nmod_poly:
        return nmod_poly([int(self.base.number(value))], self.base.p)

    def generator(self, var: Var, args: Sequence[Any]) -> nmod_poly:
        if var.index == self.index:
            return self.unknown
        if any(a.degree() > 0 for a in args):
            raise NoPointError("a function of the unknown")
        known = [self.base.number(ex.ZERO.args[0]) + a[0] for a in args]
        return nmod_poly([int(self.base.generator(var, known))], self.base.p)


def _apart(ring: Ring, found: Sequence[Var], squares: bool) -> bool:
    """Are the arguments of roots (or logs) without common factors, and those of roots no powers?

    They are looked at along a line in one symbol at a time: what has no common factor there has none at all.
    """
    left = list(found)
    while left:
        chosen = _line(ring, left, squares)
        if not chosen:
            return False
        left = [v for v in left if v not in chosen]
    return True


def _line(ring: Ring, found: Sequence[Var], squares: bool) -> list[Var]:
    """Some of the roots that are independent over all functions of the other symbols."""
    for symbol in (v for v in ring.vars if v.kind == "symbol"):
        own = [v for v in found if symbol.index in _generators(ring, v)]
        if not own:
            continue
        polynomials = [_along(ring, v, symbol.index, squares) for v in own]
        if all(p is not None and p.degree() > 0 for p in polynomials) and all(
            a.gcd(b).degree() == 0 for a, b in combinations(polynomials, 2)
        ):
            return own
    return []


def _generators(ring: Ring, var: Var) -> set[int]:
    code = ring.code
    return {code[i][1] for i in reachable(ring, var.args) if code[i][0] == VAR}


def _along(ring: Ring, var: Var, index: int, squares: bool) -> Any:
    """The argument as a polynomial in one symbol, of a root without the powers in it; None where it is none."""
    for seed in range(4):
        try:
            point = _LinePoint(field_point([ring], 7000 + seed), index)
            polynomial = value_of(ring, point, var.args[0])
        except NoPointError:
            return None
        except (NoValueError, TypeError):
            continue
        return _odd_part(polynomial, var.degree) if squares else polynomial
    return None


def _odd_part(polynomial: Any, degree: int) -> Any:
    """The product of the factors whose multiplicity is prime to the root's degree."""
    total = polynomial * 0 + 1
    for factor, k in polynomial.factor()[1]:
        if k % degree and all(k % q or degree % q for q in (2, 3, 5, 7)):
            total = total * factor
    return total
