"""Combinations of relations nonlinear in the velocities, by elimination of their nonlinear monomials."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.tree import Expr

#: A monomial in what depends on velocities: (generator, exponent) pairs.
Monomial = tuple[tuple[int, int], ...]


def combinations_of(relations: Sequence[Expr], positive: frozenset[Expr]) -> dict[int, Expr]:
    """By number, the relations less their nonlinear monomials that occur in earlier ones; those without such left out.

    The factors are polynomials in what does not depend on velocities, so a combination holds wherever the relations
    do, and says the same beside the others wherever its own factor does not vanish. Empty where they grow too large.
    """
    try:
        ring = Ring(relations, positive)
        nodes = [ring.node(e) for e in relations]
        canon = Canon(ring)
        return {i: canon.to_expr(p) for i, p in _eliminated(canon, [canon.quotient(n)[0] for n in nodes]).items()}
    except NoValueError:
        return {}


def _eliminated(canon: Canon, polynomials: Sequence[Any]) -> dict[int, Any]:
    pivots: list[tuple[Monomial, Any, Any]] = []
    found: dict[int, Any] = {}
    for i, polynomial in enumerate(polynomials):
        rest = polynomial
        for monomial, factor, other in pivots:
            own = _nonlinear(canon, rest).get(monomial)
            if own is not None:
                common = own.gcd(factor)
                rest = found[i] = canon.reduce(rest * (factor / common) - other * (own / common))
        left = _nonlinear(canon, rest)
        if left:
            monomial = min(left, key=lambda m: (not left[m].is_constant(), -sum(k for _, k in m), m))
            pivots.append((monomial, left[monomial], rest))
    return found


def _nonlinear(canon: Canon, polynomial: Any) -> dict[Monomial, Any]:
    """The coefficients of the monomials that are not linear in the velocities."""
    return {
        moving: coefficient
        for moving, coefficient in by_velocities(canon, polynomial).items()
        if sum(k for _, k in moving) > 1 or any(canon.ring.vars[i].kind != "symbol" for i, _ in moving)
    }


def by_velocities(canon: Canon, polynomial: Any) -> dict[Monomial, Any]:
    """A polynomial as coefficients of the monomials in what depends on velocities."""
    n = len(canon.ring.vars)
    moves = [any(s.args[0] == "velocity" for s in e.symbols) for e in canon.ring.var_expr]
    found: dict[Monomial, Any] = {}
    for exponents, coefficient in polynomial.to_dict().items():
        moving = tuple((n - 1 - i, int(k)) for i, k in enumerate(exponents) if k and moves[n - 1 - i])
        rest = tuple(0 if moves[n - 1 - i] else k for i, k in enumerate(exponents))
        term = canon.ctx.from_dict({rest: coefficient})
        found[moving] = found[moving] + term if moving in found else term
    return found
