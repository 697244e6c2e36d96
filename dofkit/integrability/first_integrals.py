"""First integrals of a system of forms: functions f with df in the span I of its rows, found together.

f is a combination of few products of the block's own functions (coordinates, sines, exponentials, parameters) with
rational coefficients. X f = 0 for every X in D = ker I is linear in the coefficients; it is imposed at random points
of the configuration space over GF(p), and what is left is read as rationals. Nothing is shown unless it holds
identically: the bordered minors of df under the rows vanish in the canonical ring (modulo a finite relation that
is there), or where that grows too large or several finite relations hold, at fresh points modulo fresh primes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

from dofkit.exact.errors import NoValueError
from dofkit.exact.points.frames import field_frame
from dofkit.exact.ring.canonical import Canon, remainder
from dofkit.exact.ring.minors import determinant, polynomials
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.ansatz import MAX_DEGREE, MAX_PRODUCTS, FormSample, IntegralSearch
from dofkit.integrability.integrals.normal_shape import arranged, upright
from dofkit.integrability.pfaffian_system import Codistribution

#: Rows of the bordered minors that are written out.
MAX_ROWS = 5
#: Integrals that are distributed over the rows, and how bad it is to give one twice.
MAX_ASSIGNED, UNLIKE = 6, 1000


@dataclass(frozen=True)
class FirstIntegral:
    """f, constant along all motions; ``identically``: proved so in the canonical ring."""

    expr: Expr
    identically: bool


def first_integrals(forms: Codistribution, number: int, seed: int = 0) -> list[FirstIntegral]:
    """Up to ``number`` independent f with df in the span of the rows, none of them a consequence of finite relations.

    The simplest come first.
    """
    search = IntegralSearch(forms, seed)
    found: list[FirstIntegral] = []
    for degree in range(1, MAX_DEGREE + 1):
        monomials = search.monomials(degree)
        if len(monomials) > MAX_PRODUCTS or len(found) >= number:
            break
        for f in search.candidates(monomials):
            if len(found) < number and search.adds(f, [k.expr for k in found]):
                sure = _identically(search.forms, f, search.points[0])
                if sure or (sure is None and search.holds(f)):
                    found.append(FirstIntegral(readable(f), bool(sure)))
    return found


def is_first_integral(forms: Codistribution, f: Expr) -> bool:
    """Is df in the span of the rows at random points, modulo several primes?"""
    return IntegralSearch(forms, 0).holds(f)


def integral_by_row(forms: Codistribution, integrals: Sequence[FirstIntegral]) -> dict[int, FirstIntegral]:
    """An integral for every row that it can stand for: with the other rows it says what the row says.

    f can stand for a row where df is not in the span of the others; different rows get different ones while they last.
    """
    search = IntegralSearch(forms, 0)
    sample = search.sample()
    if sample is None:
        return {}
    usable: dict[int, list[int]] = {}
    for row in range(forms.finite, len(forms.rows.entries)):
        across = sample.across(row)
        usable[row] = [k for k, f in enumerate(integrals) if across and search.slope(f.expr, sample, across) != 0]
    chosen = _likest_integral_by_row(forms, integrals, {row: few for row, few in usable.items() if few})
    return {row: integrals[k] for row, k in chosen.items()}


def _likest_integral_by_row(
    forms: Codistribution, integrals: Sequence[FirstIntegral], usable: dict[int, list[int]]
) -> dict[int, int]:
    """One integral a row, different ones where there are enough, such that they mention what the rows mention."""
    moving = frozenset(forms.chart.symbols)
    own = {row: {forms.chart.symbols[c] for c in forms.rows.entries[row]} for row in usable}
    places = [*range(len(integrals)), *(None for row in usable if len(usable) > len(integrals))][:MAX_ASSIGNED]
    best: tuple[int, dict[int, int]] | None = None
    for choice in permutations(places, len(usable)):
        total, found = 0, {}
        for row, k in zip(usable, choice, strict=True):
            found[row] = k if k in usable[row] and k is not None else usable[row][0]
            unlike = own[row] ^ (integrals[found[row]].expr.symbols & moving)
            total += UNLIKE if found[row] != k else len(unlike) ** 2
        if best is None or total < best[0]:
            best = total, found
    return best[1] if best is not None else {row: few[0] for row, few in usable.items()}


def readable(f: Expr) -> Expr:
    """An integral times the number that makes its coefficients whole, in a fixed order."""
    return arranged(upright(f))


def _identically(forms: Codistribution, f: Expr, sample: FormSample) -> bool | None:
    """Do the bordered minors of df under the rows vanish identically? None where they are not written out."""
    chart = forms.chart
    if len(chart.nodes) > 1 or len(forms.rows.entries) > MAX_ROWS:
        return None
    slopes = {i: chart.ring.node(diff(f, s)) for i, s in enumerate(chart.symbols) if s in f.symbols}
    try:
        canon = Canon(chart.ring)
        relation = canon.quotient(chart.nodes[0])[0] if chart.nodes else None
        n = len(chart.symbols)
        table = [polynomials(canon, row, n) for row in (*forms.rows.entries, slopes)]
        frame = field_frame(sample.matrix, n, sample.p)
        rows = [*frame.rows, len(table) - 1]
        for j in frame.free:
            minor = determinant(canon, [[table[r][c] for c in (*frame.dependent, j)] for r in rows])
            if relation is not None and minor != 0:
                minor = remainder(minor, relation)
            if minor != 0:
                return False if relation is None else None
    except NoValueError:
        return None
    return True
