"""SymPy used in the obvious way: rank of a Jacobian, wedge products, simplify. No answer of dofkit depends on it.

SymPy's answers are taken whether they are right or not. Ranks are those at a generic point of the coordinate space, not
of the configuration space, unless there is a reference configuration to substitute.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any

import sympy

from dofkit.expressions import tree as ex
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.tree import Expr
from dofkit.methods.as_written import Written, as_written, labelled, without_loss
from dofkit.methods.table import Reply
from dofkit.scene.scene import Scene
from dofkit.system import System

#: A differential form: {increasing indices of the differentials: coefficient}.
Form = dict[tuple[int, ...], Any]


class Symbols:
    """A scene's equations in SymPy, with coordinates as SymPy symbols."""

    def __init__(self, written: Written) -> None:
        self.written = written
        names = [c.name for c in written.system.coordinates]
        self._bridge = Bridge(names, written.positive)
        self._time = sympy.Symbol("t", real=True)
        plain = {name: sympy.Symbol(name, real=True) for name in names}
        self._positions = {self._bridge.positions[name]: symbol for name, symbol in plain.items()}
        self.columns = [*plain.values(), *([self._time] if written.timed else [])]
        self.n = len(names)
        place = {s: k for k, s in enumerate([*written.coordinates, ex.TIME])}
        self.finite = [(i, self.read(g)) for i, g in written.finite]
        self.forms: list[tuple[int, Form]] = [
            (i, {(place[s],): self.read(a) for s, a in f.items()}) for i, f in written.forms
        ]
        reference = written.system.reference or {}
        self.drawing = {plain[str(s.args[1])]: self.read(value) for s, value in reference.items() if s.op == "sym"}
        if reference:
            self.drawing[self._time] = sympy.Integer(0)

    def read(self, e: Expr) -> Any:
        """Return an expression in positions, parameters and time as a SymPy expression."""
        expression = self._bridge.to_sympy(e)
        return expression.xreplace(self._positions).xreplace({self._bridge.time: self._time})

    def row(self, form: Form) -> list[Any]:
        """Return the coefficients of a one-form as a row."""
        return [form.get((k,), sympy.Integer(0)) for k in range(len(self.columns))]

    def differential(self, g: Any) -> Form:
        """Return the one-form dg."""
        return {(k,): g.diff(s) for k, s in enumerate(self.columns)}

    def rows(self, of: Sequence[int], more: Sequence[int]) -> Any:
        """Return the matrix of the geometric equations ``of`` and forms ``more``, at the reference if there is one."""
        rows = [self.row(self.differential(self.finite[k][1])) for k in of]
        rows += [self.row(self.forms[k][1]) for k in more]
        matrix = sympy.Matrix(len(rows), len(self.columns), [entry for row in rows for entry in row])
        return matrix[:, : self.n].xreplace(self.drawing)


def wedge(a: Form, b: Form) -> Form:
    """Return the exterior product of two forms."""
    form: Form = {}
    for i, x in a.items():
        for j, y in b.items():
            if set(i) & set(j):
                continue
            order = i + j
            swaps = sum(p > q for p, q in combinations(order, 2))
            key = tuple(sorted(order))
            form[key] = form.get(key, sympy.Integer(0)) + (-1) ** swaps * x * y
    return form


def exterior(form: Form, columns: Sequence[Any]) -> Form:
    """Return the exterior derivative of a one-form."""
    derivative: Form = {}
    for (j,), a in form.items():
        for i, s in enumerate(columns):
            if i != j:
                key, sign = ((i, j), 1) if i < j else ((j, i), -1)
                derivative[key] = derivative.get(key, sympy.Integer(0)) + sign * a.diff(s)
    return derivative


def passing(symbols: Symbols) -> list[bool]:
    """Return which forms w satisfy dw ^ w_1 ^ ... ^ w_m = 0, with all forms w_i of the system [Frobenius1877]."""
    system = [symbols.differential(g) for _, g in symbols.finite] + [f for _, f in symbols.forms]
    answers = []
    for _, form in symbols.forms:
        product = exterior(form, symbols.columns)
        for other in system:
            product = wedge(product, other)
        answers.append(all(sympy.simplify(a) == 0 for a in product.values()))
    return answers


def dof(scene: Scene | System) -> Reply:
    """Return coordinates less SymPy's rank of the equations and of the forms that pass Frobenius' test."""
    symbols = Symbols(as_written(scene))
    return Reply(_freedom(symbols, passing(symbols)))


def _freedom(symbols: Symbols, passes: Sequence[bool]) -> int:
    kept = [k for k, p in enumerate(passes) if p]
    return symbols.n - int(symbols.rows(range(len(symbols.finite)), kept).rank())


def integrability(scene: Scene | System) -> Reply:
    """Return {name: label}, by wedge products."""
    symbols = Symbols(as_written(scene))
    return Reply(labelled(symbols.written, passing(symbols)))


def redundancy(scene: Scene | System) -> Reply:
    """Return the names of constraints that are removed, later ones first, while SymPy's ranks do not change."""
    symbols = Symbols(as_written(scene))

    def ranks(finite: Sequence[int], forms: Sequence[int]) -> tuple[int, int]:
        return int(symbols.rows(finite, []).rank()), int(symbols.rows(finite, forms).rank())

    return Reply(without_loss(symbols.written, ranks))
