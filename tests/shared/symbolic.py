"""A second, slow and symbolic way through a scene: the derived flag in SymPy.

Nothing here is dofkit's but the reading of the text. Coefficients live in a differential field of SymPy's: rational
functions of the symbols, of the tangents of half angles, of exponentials and of unknown functions, where zero is
decided. Finite relations are solved for a coordinate where one enters linearly; the derived flag of what is left is
worked out by left null spaces of the curvature (Frobenius), down to the largest integrable part.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import combinations
from typing import Any

import networkx as nx
import sympy
from sympy.polys.fields import field as make_field

from dofkit.expressions.tree import Expr
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene

#: Coordinates of a part, and derivatives of an unknown function that are kept ready.
MOST, ORDERS = 8, 6
T = sympy.Symbol("t")
RATIO = {"tan": (0, 1), "cot": (1, 0), "sec": (None, 1), "csc": (None, 0), "sin": (0, None), "cos": (1, None)}
HYPERBOLIC = {
    "sinh": lambda u: (sympy.exp(u) - sympy.exp(-u)) / 2,
    "cosh": lambda u: (sympy.exp(u) + sympy.exp(-u)) / 2,
    "tanh": lambda u: (sympy.exp(u) - sympy.exp(-u)) / (sympy.exp(u) + sympy.exp(-u)),
}


class NotHereError(Exception):
    """What this route does not do: roots, inverse functions, relations that no coordinate enters linearly."""


# From dofkit's trees to SymPy's


@cache
def unknown(name: str, orders: tuple[int, ...]) -> Any:
    """An unknown function, differentiated so many times by each argument."""

    def fdiff(self: Any, argindex: int = 1) -> Any:
        more = tuple(n + (i == argindex - 1) for i, n in enumerate(orders))
        return unknown(name, more)(*self.args)

    kind = type(f"{name}_{'_'.join(map(str, orders))}", (sympy.Function,), {"fdiff": fdiff, "nargs": len(orders)})
    kind.source, kind.orders = name, orders
    return kind


def rate(name: str) -> sympy.Symbol:
    return sympy.Symbol(f"{name}'")


def symbolic(e: Expr) -> sympy.Expr:
    """The same expression in SymPy; differentials over dt are velocities."""
    if e.op == "num":
        return sympy.Rational(e.args[0].numerator, e.args[0].denominator)
    if e.op == "const":
        return sympy.pi if e.args[0] == "pi" else sympy.E
    if e.op == "sym":
        kind, name = e.args
        if kind == "acceleration":
            raise NotHereError("accelerations")
        if kind == "dt":
            return sympy.Integer(1)
        return rate(name) if kind in ("velocity", "differential") else sympy.Symbol(name)
    if e.op == "call":
        name, orders, arguments = e.args
        return unknown(name, tuple(orders))(*map(symbolic, arguments))
    if e.op == "fn":
        name, *arguments = e.args
        values = [symbolic(a) for a in arguments]
        if name in HYPERBOLIC:
            return HYPERBOLIC[name](*values)
        return (sympy.Abs if name == "abs" else getattr(sympy, name))(*values)
    parts = [symbolic(a) for a in e.args]
    return {"add": sympy.Add, "mul": sympy.Mul, "pow": sympy.Pow}[e.op](*parts)


# A differential field


def terms_of(e: sympy.Expr) -> list[tuple[sympy.Rational, sympy.Expr]]:
    """A sum as rational multiples of products."""
    return [term.as_coeff_Mul(rational=True) for term in sympy.Add.make_args(sympy.expand(e))]


class Tower:
    """QQ(symbols, generators), each generator with its total derivatives.

    Generators: tan of half the unit angle of every angle that occurs, exp of a unit, log of a symbol, and unknown
    functions with their derivatives; angles and exponents that are no rational multiples of each other give
    independent generators, so that an element is zero only where the function is.
    """

    def __init__(self, expressions: Sequence[sympy.Expr], variables: Sequence[sympy.Symbol]) -> None:
        self.units: dict[tuple[str, sympy.Expr], int] = {}
        self.atoms: list[sympy.Expr] = []
        for e in expressions:
            self._collect(e)
        free = sorted({s for e in [*expressions, *self.atoms] for s in e.free_symbols} | set(variables), key=str)
        self.unit_names = {key: sympy.Dummy(key[0]) for key in self.units}
        self.atom_names = {a: sympy.Dummy("f") for a in self.atoms}
        names = [*free, *self.unit_names.values(), *self.atom_names.values()]
        self.field, *_ = make_field(names or [sympy.Dummy()], sympy.QQ)
        self.of = dict(zip(self.field.symbols, self.field.gens, strict=True))
        self.rates: dict[tuple[sympy.Symbol, sympy.Symbol], Any] = {}

    def _collect(self, e: sympy.Expr) -> None:
        if e.is_Function:
            kind = type(e).__name__
            if kind in RATIO or kind == "exp":
                for number, unit in terms_of(e.args[0]):
                    if unit != 1:
                        key = ("exp" if kind == "exp" else "angle", unit)
                        self.units[key] = math.lcm(self.units.get(key, 1), int(number.q))
                        self._collect(unit)
                return
            if hasattr(e, "orders"):
                self._unknown(e)
            elif kind == "log" and e.args[0].is_Symbol:
                self.atoms += [e] if e not in self.atoms else []
            else:
                raise NotHereError(kind)
        elif e.is_Pow and not e.exp.is_Integer:
            raise NotHereError("roots and powers")
        for part in e.args:
            self._collect(part)

    def _unknown(self, e: Any) -> None:
        if len(e.orders) > 1:
            raise NotHereError("functions of several arguments")
        for order in range(e.orders[0] + ORDERS):
            atom = unknown(e.source, (order,))(*e.args)
            self.atoms += [atom] if atom not in self.atoms else []

    def element(self, e: sympy.Expr) -> Any:
        """An expression as an element of the field."""
        if e.is_Rational:
            return self.field.from_expr(e)
        if e in self.of:
            return self.of[e]
        if e in self.atom_names:
            return self.of[self.atom_names[e]]
        if e.is_Add:
            return sum((self.element(a) for a in e.args), self.field(0))
        if e.is_Mul:
            return math.prod((self.element(a) for a in e.args), start=self.field(1))
        if e.is_Pow and e.exp.is_Integer:
            return self.element(e.base) ** int(e.exp)
        kind = type(e).__name__
        if kind == "exp":
            return self._exponential(e.args[0])
        if kind in RATIO:
            return self._ratio(kind, e.args[0])
        raise NotHereError(str(e))

    def _exponential(self, e: sympy.Expr) -> Any:
        found = self.field(1)
        for number, unit in terms_of(e):
            if unit == 1 and number != 0:
                raise NotHereError("exp of a number")
            if number != 0:
                key = ("exp", unit)
                found = found * self.of[self.unit_names[key]] ** int(number * self.units[key])
        return found

    def _ratio(self, kind: str, angle: sympy.Expr) -> Any:
        circle = self._circle(angle)
        top, bottom = (None if k is None else circle[k] for k in RATIO[kind])
        return (self.field(1) if top is None else top) / (self.field(1) if bottom is None else bottom)

    def _circle(self, angle: sympy.Expr) -> tuple[Any, Any]:
        """(sin, cos) by the addition theorem, from the tangents of half the unit angles."""
        s, c = self.field(0), self.field(1)
        for number, unit in terms_of(angle):
            if unit == 1 and number != 0:
                raise NotHereError("angles of a number")
            if unit == sympy.pi:
                turn = sympy.sin(number * unit), sympy.cos(number * unit)
                if not all(v.is_Rational for v in turn):
                    raise NotHereError("roots")
                one, times = tuple(self.field.from_expr(v) for v in turn), 1
            elif number != 0:
                key = ("angle", unit)
                u, times = self.of[self.unit_names[key]], int(number * self.units[key])
                one = (2 * u / (1 + u * u) * (1 if times > 0 else -1), (1 - u * u) / (1 + u * u))
            else:
                continue
            for _ in range(abs(times)):
                s, c = s * one[1] + c * one[0], c * one[1] - s * one[0]
        return s, c

    def rate_of(self, generator: sympy.Symbol, variable: sympy.Symbol) -> Any:
        """The derivative of a generator by a coordinate or time."""
        key = (generator, variable)
        if key not in self.rates:
            self.rates[key] = self._rate(generator, variable)
        return self.rates[key]

    def _rate(self, generator: sympy.Symbol, variable: sympy.Symbol) -> Any:
        for (kind, unit), name in self.unit_names.items():
            if name == generator:
                u = self.of[name]
                inner = self.derivative(self.element(unit), variable) / self.units[kind, unit]
                return u * inner if kind == "exp" else (1 + u * u) / 2 * inner
        for atom, name in self.atom_names.items():
            if name == generator:
                inner = self.derivative(self.element(atom.args[0]), variable)
                if inner == 0:
                    return inner
                if isinstance(atom, sympy.log):
                    return inner / self.element(atom.args[0])
                return self.element(atom.fdiff()) * inner
        return self.field(int(generator == variable))

    def derivative(self, f: Any, variable: sympy.Symbol) -> Any:
        total = self.field(0)
        for name, generator in self.of.items():
            slope = f.diff(generator)
            if slope != 0:
                total = total + slope * self.rate_of(name, variable)
        return total


# Linear algebra over it

Row = list[Any]


def reduced(rows: Sequence[Row], width: int | None = None) -> tuple[list[Row], list[int], list[Row]]:
    """The reduced rows with their pivots, simplest entries first, and the rows that vanish on the first columns."""
    left, found, pivots = [list(r) for r in rows], [], []
    width = width if width is not None else len(left[0]) if left else 0
    while True:
        entries = [(size(r[c]), k, c) for k, r in enumerate(left) for c in range(width) if r[c] != 0]
        if not entries:
            return found, pivots, left
        _, k, c = min(entries)
        choice = left.pop(k)
        choice = [v / choice[c] if v != 0 else v for v in choice]
        left, found = [minus(r, choice, c) for r in left], [minus(r, choice, c) for r in found]
        found.append(choice)
        pivots.append(c)


def size(element: Any) -> int:
    return len(element.numer) + len(element.denom)


def minus(row: Row, pivot: Row, c: int) -> Row:
    factor = row[c]
    return row if factor == 0 else [a - factor * b if b != 0 else a for a, b in zip(row, pivot, strict=True)]


def rank(rows: Sequence[Row]) -> int:
    return len(reduced(rows)[1])


def in_span(row: Row, rows: Sequence[Row]) -> bool:
    return rank([*rows, row]) == rank(rows)


def left_null(matrix: Sequence[Row], one: Any) -> list[Row]:
    """All combinations of the rows that vanish."""
    width = len(matrix[0])
    marked = [[*row, *(one if i == j else one * 0 for j in range(len(matrix)))] for i, row in enumerate(matrix)]
    return [row[width:] for row in reduced(marked, width)[2]]


def derived_flag(tower: Tower, rows: Sequence[Row], variables: Sequence[sympy.Symbol]) -> list[list[Row]]:
    """Bases of I, I', I'', ... down to the largest integrable part (Frobenius: I' = I)."""
    basis, pivots, _ = reduced(rows)
    flag = [basis]
    while basis:
        curvature = curvatures(tower, basis, pivots, variables)
        if not curvature[0]:
            return flag
        kept = left_null(curvature, tower.field(1))
        if len(kept) == len(basis):
            return flag
        columns = list(zip(*basis, strict=True))
        combined = [[sum((a * b for a, b in zip(k, c, strict=True)), tower.field(0)) for c in columns] for k in kept]
        basis, pivots, _ = reduced(combined)
        flag.append(basis)
    return flag


def curvatures(
    tower: Tower, basis: Sequence[Row], pivots: Sequence[int], variables: Sequence[sympy.Symbol]
) -> list[Row]:
    """d(omega_a)(X_i, X_j) on the kernel's basis X_j = d_j - sum_a c_aj d_a, for omega_a = dx_a + sum_j c_aj dx_j."""
    free = [c for c in range(len(variables)) if c not in pivots]

    def along(f: Any, j: int) -> Any:
        total = tower.derivative(f, variables[j])
        for row, p in zip(basis, pivots, strict=True):
            if row[j] != 0:
                total = total - row[j] * tower.derivative(f, variables[p])
        return total

    return [[along(row[j], i) - along(row[i], j) for i, j in combinations(free, 2)] for row in basis]


# A scene's parts


@dataclass
class Part:
    """Relations that share coordinates: (constraint, expression with velocities)."""

    names: list[str]
    relations: list[tuple[int, sympy.Expr]] = field(default_factory=list)


@dataclass
class Answer:
    """What one part says; ``derived`` counts the solved finite relations too."""

    dof: int
    velocity_dof: int
    holonomic: dict[int, bool]
    derived: list[int]


def relations_of(scene: Scene) -> tuple[list[tuple[int, sympy.Expr]], list[str]]:
    """Every bilateral relation in SymPy, and the coordinates."""
    system = lower(scene)
    if system.tolerance is not None:
        raise NotHereError("measured numbers")
    written = [(i, r) for i, c in enumerate(system.constraints) for r in c.relations if r.sense == "="]
    return [(i, symbolic(r.expr)) for i, r in written], [q.name for q in system.coordinates]


def parts_of(relations: Sequence[tuple[int, sympy.Expr]], names: Sequence[str]) -> list[Part]:
    graph: nx.Graph = nx.Graph()
    known = {sympy.Symbol(q): q for q in names} | {rate(q): q for q in names}
    for k, (_, e) in enumerate(relations):
        graph.add_node(k)
        graph.add_edges_from((k, known[s]) for s in e.free_symbols if s in known)
    parts = []
    for component in nx.connected_components(graph):
        numbers = sorted(k for k in component if isinstance(k, int))
        parts.append(Part([q for q in names if q in component], [relations[k] for k in numbers]))
    return parts


def linear_in(e: sympy.Expr, names: Sequence[str]) -> dict[str, sympy.Expr] | None:
    """Coefficients by coordinate and of dt; None for a finite relation."""
    rates = [q for q in names if rate(q) in e.free_symbols]
    if not rates:
        return None
    found = {q: sympy.diff(e, rate(q)) for q in rates}
    if any(rate(q) in c.free_symbols for c in found.values() for q in names):
        raise NotHereError("nonlinear in the velocities")
    rest = e.subs({rate(q): 0 for q in rates})
    return {**found, "t": rest}


def solved(finite: Sequence[sympy.Expr], names: Sequence[str]) -> list[tuple[str, sympy.Expr]]:
    """Coordinates in terms of the others, one a relation; relations that become 0 = 0 add nothing."""
    left, found = list(finite), []
    while left:
        g = left.pop(0)
        if sympy.simplify(g) == 0:
            continue
        choice = next((q for q in names if enters_linearly(g, sympy.Symbol(q), names)), None)
        if choice is None:
            raise NotHereError("no coordinate enters linearly")
        q = sympy.Symbol(choice)
        value = sympy.expand(-g.subs(q, 0) / sympy.diff(g, q))
        left = [other.subs(q, value) for other in left]
        found = [(name, e.subs(q, value)) for name, e in found] + [(choice, value)]
    return found


def enters_linearly(g: sympy.Expr, q: sympy.Symbol, names: Sequence[str]) -> bool:
    """With a coefficient that is a constant, so that no branch is lost."""
    if q not in g.free_symbols:
        return False
    slope = sympy.simplify(sympy.diff(g, q))
    return slope != 0 and not slope.free_symbols & {T, *map(sympy.Symbol, names)}


def answer(part: Part) -> Answer:
    if len(part.names) > MOST:
        raise NotHereError("many coordinates")
    forms = [(i, linear_in(e, part.names), e) for i, e in part.relations]
    values = solved([e for _, form, e in forms if form is None], part.names)
    names = [q for q in part.names if q not in dict(values)]
    timed = any(T in e.free_symbols for _, e in part.relations) or any(f and f["t"] != 0 for _, f, _ in forms)
    variables = [sympy.Symbol(q) for q in names] + ([T] if timed else [])
    kept = [(i, restricted(form, values, variables)) for i, form, _ in forms if form is not None]
    tower = Tower([e for _, row in kept for e in row], variables)
    rows = [(i, [tower.element(e) for e in row]) for i, row in kept]
    flag = derived_flag(tower, [row for _, row in rows], variables)
    n = len(names)
    if any(rank([r[:n] for r in basis]) < len(basis) for basis in flag):
        raise NotHereError("dt lies in the span: motion is confined to a locus")
    holonomic = {i: True for i, form, _ in forms if form is None}
    for i, row in rows:
        holonomic[i] = holonomic.get(i, True) and in_span(row, flag[-1])
    return Answer(n - len(flag[-1]), n - len(flag[0]), holonomic, [len(basis) + len(values) for basis in flag])


def restricted(
    form: Mapping[str, sympy.Expr], values: Sequence[tuple[str, sympy.Expr]], variables: Sequence[sympy.Symbol]
) -> list[sympy.Expr]:
    """The form on the finite relations: solved coordinates and their differentials put in."""
    known = {sympy.Symbol(q): e for q, e in values}
    total = []
    for v in variables:
        whole = form.get(str(v), sympy.Integer(0))
        whole += sum(form[q] * sympy.diff(e, v) for q, e in values if q in form)
        total.append(whole.subs(known, simultaneous=True))
    return total


def closed(form: Mapping[str, sympy.Expr], names: Sequence[str]) -> bool:
    """d(omega) = 0 in the coordinates and time."""
    written = {sympy.Symbol(q): e for q, e in form.items()}
    occurs = {s for e in form.values() for s in e.free_symbols} | set(written)
    variables = [v for v in [*map(sympy.Symbol, names), T] if v in occurs]
    tower = Tower(list(written.values()), variables)
    c = {v: tower.element(written.get(v, sympy.Integer(0))) for v in variables}
    return all(tower.derivative(c[a], b) == tower.derivative(c[b], a) for a, b in combinations(variables, 2))
