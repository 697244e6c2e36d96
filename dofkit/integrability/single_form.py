"""Integrability of one form by itself, with a proof in hand: few variables, closed, an identity, an integral."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

from dofkit.base.errors import NoValueError
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import FormRows, field_frame
from dofkit.exact.ring.program import VAR, Scalar, gradient, values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import doubt, independent_generators, odd_constants, zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals import search
from dofkit.integrability.lie_algebra import lie_span
from dofkit.integrability.pfaffian_system import Codistribution
from dofkit.integrability.traits import exact
from dofkit.relations.chart import free_point
from dofkit.relations.normal.pieces import Pfaffian


@dataclass(frozen=True)
class Integrability:
    """``proved``: the form is integrable and why is in ``reason``; ``factor`` and ``integral`` as text where found."""

    proved: bool
    reason: str = ""
    factor: str | None = None
    integral: str | None = None


def integrability(form: Pfaffian, positive: frozenset[Expr], alone: bool | None) -> Integrability:
    """What can be proved of one form that is integrable alone as far as is known (``alone``)."""
    if alone is False:
        return Integrability(False)
    reason = proof(form, positive)
    plain = bool(form.coefficients) and not odd_constants(_ring(form, positive))
    found = search.integrate(form, positive) if plain and (reason or alone) else None
    if found is not None:
        return Integrability(True, "an integral was found and checked", found.factor, found.integral)
    return Integrability(reason is not None, reason or "")


def _ring(form: Pfaffian, positive: frozenset[Expr]) -> Ring:
    ring = Ring([e for _, e in form.items()], positive)
    for _, e in form.items():
        ring.node(e)
    return ring


def proof(form: Pfaffian, positive: frozenset[Expr]) -> str | None:
    """Why the form integrates by itself, where that is proved; else None."""
    if exact(form, positive) == (True, "proved"):  # [PoincareLemma]
        return "it is closed, so locally it is the differential of a function"
    items = list(form.items())
    symbols = {s for s, _ in items} | {s for _, e in items for s in e.symbols if s.args[0] in ("coordinate", "time")}
    if len(symbols) <= 2:  # [Frobenius1877]
        return "a form in two variables is always integrable"
    if len(items) <= 5 and _frobenius(items):
        return "d(omega) ^ omega = 0 identically"
    return None


def _frobenius(items: list[tuple[Expr, Expr]]) -> bool:
    """d(omega) ^ omega = 0 for every three variables [Frobenius1877]."""
    symbols = {s for _, e in items for s in e.symbols if s.args[0] in ("coordinate", "time")} - {s for s, _ in items}
    everything = [*items, *((s, ex.ZERO) for s in sorted(symbols, key=repr))]
    for (s, a), (u, b), (w, c) in combinations(everything, 3):
        total = a * (diff(c, u) - diff(b, w))
        total += b * (diff(a, w) - diff(c, s))
        total += c * (diff(b, s) - diff(a, u))
        if zero_and_verdict(total, frozenset()) != (True, "proved"):
            return False
    return True


#: The seed of the point.
SEED = 5


class CurlAtPoint:
    """One form and its differential at a point: d(omega) has the components d_i a_j - d_j a_i."""

    def __init__(self, rows: FormRows, row: int, at: Sequence[Scalar], point: Any) -> None:
        one, entries = point.number(ex.ONE.args[0]), rows.entries[row]
        self.columns, self.zero = rows.columns, one * 0
        self.value = {c: at[node] for c, node in entries.items()}
        self.slopes = {c: gradient(rows.ring, at, point, [(node, one)]) for c, node in entries.items()}

    def curl(self, i: int, j: int) -> Scalar:
        """A component of d(omega)."""
        columns, zero = self.columns, self.zero
        return self.slopes.get(j, {}).get(columns[i], zero) - self.slopes.get(i, {}).get(columns[j], zero)

    @cached_property
    def is_open(self) -> bool:
        """Is d(omega) something else than 0?"""
        return any(self.curl(i, j) != 0 for i, j in combinations(range(len(self.columns)), 2))

    @cached_property
    def is_curved(self) -> bool:
        """Is d(omega) ^ omega something else than 0? Then the form does not integrate by itself [Frobenius1877].

        With a coefficient a_k that is not 0 that holds where a component (i, j, k) is not 0 for some i and j.
        """
        value, zero = self.value, self.zero
        k = next((c for c, a in value.items() if a != 0), None)
        if k is None:
            return False
        for i, j in combinations([c for c in range(len(self.columns)) if c != k], 2):
            total = value[k] * self.curl(i, j) + value.get(i, zero) * self.curl(j, k)
            if total + value.get(j, zero) * self.curl(k, i) != 0:
                return True
        return False


class SharedForms:
    """A block's forms, a point, and the program's values there."""

    def __init__(self, forms: Codistribution, point: FieldPoint) -> None:
        self.forms, self.point = forms, point
        self.at = values(forms.chart.ring, point)
        self._curls: dict[int, CurlAtPoint] = {}

    def curl(self, number: int) -> CurlAtPoint:
        """One form with its differential."""
        if number not in self._curls:
            self._curls[number] = CurlAtPoint(self.forms.rows, number, self.at, self.point)
        return self._curls[number]

    def reach_everything(self, numbers: Sequence[int]) -> bool:
        """Do brackets of the velocities that some independent forms allow reach every direction?

        Then the largest integrable part of these forms is 0 at a generic point [Frobenius1877]. Only columns of what
        they mention are looked at: nothing else is touched by them.
        """
        if len(numbers) == 1:
            return self.curl(numbers[0]).is_curved
        rows = self._of(numbers)
        n = len(rows.columns)
        try:
            frame = field_frame(rows.matrix(self.at, self.point.number(ex.ZERO.args[0])), n, self.point.p)
            return len(frame.rows) == len(numbers) and lie_span(rows, frame, self.point).dimension == n
        except NoValueError:
            return False

    def _of(self, numbers: Sequence[int]) -> FormRows:
        """Some rows over the columns that these mention."""
        rows = self.forms.rows
        entries = [rows.entries[i] for i in numbers]
        own = set(_symbols(rows, entries))
        kept = [c for c, index in enumerate(rows.columns) if index in own or any(c in row for row in entries)]
        place = {c: k for k, c in enumerate(kept)}
        moved = tuple({place[c]: node for c, node in row.items()} for row in entries)
        return FormRows(rows.ring, moved, tuple(rows.columns[c] for c in kept))


def _symbols(rows: FormRows, entries: Iterable[dict[int, int]]) -> Iterable[int]:
    """The generators that the coefficients of some rows depend on."""
    ring = rows.ring
    roots = tuple(node for row in entries for node in row.values())
    return (ring.code[i][1] for i in ring.order(roots) if ring.code[i][0] == VAR)


def shared_forms(forms: Codistribution) -> SharedForms | None:
    """Forms on which no finite relation holds, at a point; None where GF(p) does not tell what is not 0."""
    ring = forms.chart.ring
    certain = not forms.finite and doubt(ring) is None and independent_generators(ring)
    point = free_point(forms.chart, SEED) if certain else None
    return None if point is None else SharedForms(forms, point)
