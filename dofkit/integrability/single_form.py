"""Integrability of one form by itself, with a proof in hand: few variables, closed, an identity, an integral."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

from dofkit.exact.points.frames import FormRows
from dofkit.exact.ring.program import Scalar, gradient
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import odd_constants, zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals import search
from dofkit.integrability.traits import exact
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
