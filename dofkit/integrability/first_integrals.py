"""First integrals of a system of forms: functions f with df in the span I of its rows, found together.

f is a combination of few products of the block's own functions (coordinates, sines, exponentials, parameters) with
rational coefficients. X f = 0 for every X in D = ker I is linear in the coefficients; it is imposed at random points
of the configuration space over GF(p), and what is left is read as rationals. Nothing is shown unless it holds
identically: the bordered minors of df under the rows vanish in the canonical ring (modulo a finite relation that
is there), or where that grows too large or several finite relations hold, at fresh points modulo fresh primes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations

from dofkit.exact.errors import NoValueError
from dofkit.exact.points.frames import field_frame
from dofkit.exact.ring.canonical import Canon, Poly, determinant, polynomials, remainder
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
    bordered: BorderedMinors | None = None
    for degree in range(1, MAX_DEGREE + 1):
        monomials = search.monomials(degree)
        if len(monomials) > MAX_PRODUCTS or len(found) >= number:
            break
        for f in search.candidates(monomials):
            if search.adds(f, [k.expr for k in found]):
                bordered = bordered or BorderedMinors(search.forms, search.points[0])
                sure = _identically(bordered, f)
                if sure or (sure is None and search.holds(f)):
                    found.append(FirstIntegral(readable(f), bool(sure)))
                if len(found) == number:
                    return found
    return found


def is_first_integral(forms: Codistribution, f: Expr) -> bool:
    """Is df in the span of the rows at random points, modulo several primes?"""
    return IntegralSearch(forms, 0).holds(f)


def integral_by_row(forms: Codistribution, integrals: Sequence[FirstIntegral]) -> dict[int, FirstIntegral]:
    """An integral for every row that it can stand for: with the other rows it says what the row says.

    f can stand for a row where df is not in the span of the others; different rows get different ones while they last.
    """
    if not integrals:
        return {}
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


def _identically(bordered: BorderedMinors, f: Expr) -> bool | None:
    """Do the bordered minors of df under the rows vanish identically? None where they are not written out."""
    if not bordered.short:
        return None
    try:
        if all(minor == 0 for minor in bordered.of(f)):
            return True
    except NoValueError:
        return None
    return None if bordered.chart.nodes else False


class BorderedMinors:
    """The minors of a system's independent rows bordered by the differential of a function, in the canonical ring."""

    def __init__(self, forms: Codistribution, sample: FormSample) -> None:
        self.forms, self.chart = forms, forms.chart
        self.short = len(self.chart.nodes) <= 1 and len(forms.rows.entries) <= MAX_ROWS
        self.frame = field_frame(sample.matrix, len(self.chart.symbols), sample.p)
        self.canon: Canon | None = None
        self._cofactors: dict[int, dict[int, Poly]] = {}

    def of(self, f: Expr) -> Iterator[Poly]:
        """Those of df, one for each free column, modulo a finite relation. Raises NoValueError."""
        ring, symbols = self.chart.ring, self.chart.symbols
        slopes = {i: ring.node(diff(f, s)) for i, s in enumerate(symbols) if s in f.symbols}
        if self.canon is None or len(self.canon.gens) < len(ring.vars):
            self.canon, self._cofactors = Canon(ring), {}
        canon = self.canon
        relation = canon.quotient(self.chart.nodes[0])[0] if self.chart.nodes else None
        row = polynomials(canon, slopes, len(symbols))
        for j in self.frame.free:
            minor = canon.one * 0
            for c, cofactor in self._along(canon, j).items():
                if row[c] != 0:
                    minor = minor + canon.reduce(row[c] * cofactor)
            minor = canon.reduce(minor)
            yield minor if relation is None or minor == 0 else remainder(minor, relation)

    def _along(self, canon: Canon, j: int) -> dict[int, Poly]:
        """The cofactors of the bordering row in the dependent columns and column ``j``; all functions share them."""
        if j not in self._cofactors:
            n = len(self.chart.symbols)
            rows = [polynomials(canon, self.forms.rows.entries[r], n) for r in self.frame.rows]
            columns = (*self.frame.dependent, j)
            found = {}
            for k, c in enumerate(columns):
                others = [d for d in columns if d != c]
                minor = determinant(canon, [[row[d] for d in others] for row in rows]) if rows else canon.one
                found[c] = -minor if k % 2 else minor
            self._cofactors[j] = found
        return self._cofactors[j]
