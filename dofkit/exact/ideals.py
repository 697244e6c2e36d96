"""Ideals of polynomials in a ring's generators, by Groebner bases [Buchberger1965].

Gaussian elimination divides by pivots and misses the part of a set where a pivot is 0; a Groebner basis does not.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from itertools import combinations
from math import lcm
from typing import Any

from flint import Ordering, fmpq, fmpq_mat, fmpz_mpoly_ctx, fmpz_mpoly_vec

from dofkit.base.deadline import check
from dofkit.exact.ring.canonical import Canon, quotients_of
from dofkit.exact.ring.program import none_without_value
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.tree import Expr

#: Bounds on the input: unknowns in all, degree and number of terms of each polynomial.
MAX_UNKNOWNS, MAX_DEGREE, MAX_LENGTH = 12, 6, 40
#: Bounds on a basis: its polynomials, the terms and the bits of each. Beyond them there is no answer.
LIMITS = (60, 200, 400)
#: Parameters are replaced by random integers up to this size.
LARGEST = 10**4

#: Bound on the entries of the matrix of coefficients in `echelon_by_degree`.
COMBINED_ENTRIES = 20_000

Poly = Any


def dimension_of(canon: Canon, generators: Sequence[Poly], moving: Sequence[int]) -> int | None:
    """Return the dimension of the set of complex points at which polynomials ``generators`` vanish; -1 if it is empty.

    None if other functions than sines and cosines of single coordinates occur, or if the basis grows too large.
    ``moving`` are the indices of the ring's generators that are coordinates; parameters are generic. The dimension is
    the largest number of unknowns such that no leading monomial is a product of these unknowns alone.
    """
    integral = _integer_polynomials(canon, generators, moving)
    basis = None if integral is None else _basis(integral[0])
    if integral is None or basis is None:
        return None
    _, count, unseen = integral  # ``unseen``: the number of coordinates in no polynomial
    leading = [frozenset(i for i, k in enumerate(p.monomial(0)) if k) for p in basis]
    if frozenset() in leading:
        return -1
    check()
    choices = (free for size in range(count, -1, -1) for free in combinations(range(count), size))
    return unseen + len(next(free for free in choices if not any(used <= set(free) for used in leading)))


@none_without_value
def have_complex_points(relations: Sequence[Expr], positive: frozenset[Expr]) -> bool | None:
    """Return whether relations are satisfied at some complex point, None if undecided; parameters are generic."""
    symbols = {s for e in relations for s in e.symbols if s.args[0] != "parameter"}
    canon, quotients = quotients_of(relations, positive)
    moving = [k for s in symbols if (k := canon.ring.var_index(s)) is not None]
    dimension = dimension_of(canon, [top for top, _ in quotients], moving)
    return None if dimension is None else dimension >= 0


def _integer_polynomials(
    canon: Canon, generators: Sequence[Poly], moving: Sequence[int]
) -> tuple[list[Poly], int, int] | None:
    """Return (polynomials over Z, their number of unknowns, number of coordinates that do not occur), or None."""
    ring = canon.ring
    used = sorted({i for p in generators for i in canon.generators_in(p)})
    if any(len(p) > MAX_LENGTH or p.total_degree() > MAX_DEGREE for p in generators):
        return None
    kept = _unknowns(ring, used, moving)
    if kept is None or len(kept) > MAX_UNKNOWNS:
        return None
    pairs = [(i, ring.vars[i].partner) for i in kept if ring.vars[i].kind == "cos"]
    seen = {i if ring.vars[i].kind == "symbol" else _angle(ring, i) for i in kept}
    values = _constants(ring, [i for i in used if i not in kept], random.Random(f"dofkit ideals {ring.digest}"))
    place = {i: k for k, i in enumerate(kept)}
    ctx = fmpz_mpoly_ctx.get([f"u{k}" for k in range(len(kept))], Ordering.degrevlex)
    gens = ctx.gens()
    polynomials = [ctx.from_dict(_integer_terms(p, kept, values)) for p in generators]
    circles = [gens[place[c]] ** 2 + gens[place[s]] ** 2 - 1 for c, s in pairs]
    return [*polynomials, *circles], len(kept), len(moving) - len(seen)


def _unknowns(ring: Ring, used: Sequence[int], moving: Sequence[int]) -> list[int] | None:
    """Return the generators ``used`` that are coordinates, or cosines and sines of other coordinates.

    None if another function of a coordinate occurs, or one occurs outside its cosine and sine too. Parameters, and
    their cosines, sines and exponentials, are constants.
    """
    kept: set[int] = set()
    for i in used:
        var = ring.vars[i]
        if var.kind == "symbol":
            kept |= {i} & set(moving)
        elif var.kind in ("cos", "sin") and _angle(ring, i) in moving:
            kept |= {i, var.partner}
        elif var.kind not in ("cos", "sin", "exp") or any(
            ring.var_index(s) in moving for s in ring.var_expr[i].symbols
        ):
            return None
    angles = {_angle(ring, i) for i in kept if ring.vars[i].kind != "symbol"}
    return None if angles & kept else sorted(kept)


def _constants(ring: Ring, others: Sequence[int], rng: random.Random) -> dict[int, fmpq]:
    """Return random values of parameters and of functions of them; a cosine and its sine are a point of the circle."""
    values = dict[int, fmpq]()
    for i in others:
        var = ring.vars[i]
        if var.kind in ("cos", "sin") and i not in values:
            half = fmpq(rng.randint(2, LARGEST), LARGEST)
            pair = {"cos": (1 - half**2) / (1 + half**2), "sin": 2 * half / (1 + half**2)}
            values |= {i: pair[var.kind], var.partner: pair[ring.vars[var.partner].kind]}
        else:
            values.setdefault(i, fmpq(rng.randint(2, LARGEST)))
    return values


def _angle(ring: Ring, index: int) -> int | None:
    """Return the generator index of the angle of a cosine or sine; None if the angle is not a single symbol."""
    return ring.var_index(ring.vars[index].key[0])


def _integer_terms(p: Poly, kept: Sequence[int], values: Mapping[int, fmpq]) -> dict[tuple[int, ...], int]:
    """Return {exponents of ``kept`` generators: integer coefficient} of a multiple of p, with ``values`` of others."""
    terms = p.subs({f"v{i}": value for i, value in values.items()}).to_dict()
    scale = lcm(*(int(c.q) for c in terms.values()))
    return {tuple(int(powers[-1 - i]) for i in kept): int(c * scale) for powers, c in terms.items()}


def _basis(polynomials: Sequence[Poly]) -> list[Poly] | None:
    """Return a Groebner basis in degree reverse lexicographic order; None if it exceeds `LIMITS`."""
    nonzero = [p for p in polynomials if p != 0]
    if not nonzero:
        return []
    vector: Any = fmpz_mpoly_vec(nonzero, nonzero[0].context())
    basis, complete = vector.buchberger_naive(limits=LIMITS)
    return list(basis) if complete else None


# -- linear combinations of lower degree -----------------------------------------------------------


@none_without_value
def echelon_by_degree(relations: Sequence[Expr], positive: frozenset[Expr]) -> tuple[Expr, ...] | None:
    """Return polynomials in echelon form with the linear span of the relations' numerators; None if too large.

    Terms of the highest degree are eliminated first: for two circles one of the polynomials is their radical line.
    """
    canon, quotients = quotients_of(relations, positive)
    tables = [top.to_dict() for top, _ in quotients]
    monomials = sorted({m for table in tables for m in table}, key=lambda m: (-sum(m), m))
    if not monomials or len(monomials) * len(tables) > COMBINED_ENTRIES:
        return None
    reduced, rank = fmpq_mat([[table.get(m, 0) for m in monomials] for table in tables]).rref()
    rows = ({m: reduced[r, c] for c, m in enumerate(monomials) if reduced[r, c] != 0} for r in range(rank))
    return tuple(canon.to_expr(canon.ctx.from_dict(row)) for row in rows)
