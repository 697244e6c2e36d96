"""Conversion between expressions and SymPy, node by node: never through text, in either direction.

A coordinate q is the dynamic symbol q(t); its velocity and acceleration are the derivatives of q(t) by t.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import Any

from dofkit.base.errors import DofkitError
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr

_ELEMENTARY = {name: "Abs" if name == "abs" else name for name in ex.FUNCTIONS}
_BACK = {sympy: name for name, sympy in _ELEMENTARY.items()}


class UntranslatableError(DofkitError):
    """A SymPy expression that has no counterpart in the grammar of scenes."""


class Bridge:
    """Converts expressions in ``coordinates`` to SymPy and back; ``positive`` parameters are positive in SymPy too."""

    def __init__(self, coordinates: Iterable[str], positive: frozenset[Expr] = frozenset()) -> None:
        import sympy
        from sympy.physics.mechanics import dynamicsymbols

        self._sympy = sympy
        self.time = dynamicsymbols._t
        self.positions: dict[str, Any] = {}
        for name in coordinates:
            self.positions[name] = sympy.Function(name, real=True)(self.time)
        self._names = {q: name for name, q in self.positions.items()}
        self._positive = positive
        self._memo: dict[Expr, Any] = {}
        self._back: dict[Any, Expr] = {}
        self._parameters: dict[Any, Expr] = {}

    # To SymPy

    def velocity(self, name: str, order: int = 1) -> Any:
        """Return the ``order``-th derivative by time of the coordinate ``name``, in SymPy."""
        return self.positions[name].diff(self.time, order)

    def to_sympy(self, e: Expr) -> Any:
        """Return ``e`` in SymPy. Raises KeyError if a coordinate of ``e`` was not given."""
        for node in ex.nodes(e):  # operands before what has them
            if node not in self._memo:
                self._memo[node] = self._node_to_sympy(node)
        return self._memo[e]

    def _node_to_sympy(self, e: Expr) -> Any:
        """Return a node in SymPy, whose operands are in the memo already."""
        sp = self._sympy
        if e.op == "num":
            return sp.Rational(e.args[0].numerator, e.args[0].denominator)
        if e.op == "sym":
            return self._symbol(e)
        if e.op == "const":
            return sp.pi if e.args[0] == "pi" else sp.E
        translated = [self._memo[child] for child in ex.children(e)]
        if e.op == "add":
            return sp.Add(*translated)
        if e.op == "mul":
            return sp.Mul(*translated)
        if e.op == "pow":
            return sp.Pow(*translated)
        if e.op == "fn":
            return getattr(sp, _ELEMENTARY[e.args[0]])(*translated)
        return self._call(e.args[0], e.args[1], translated)

    def _symbol(self, e: Expr) -> Any:
        kind, name = e.args
        if kind == "time":
            return self.time
        if kind == "parameter":
            assumption = "positive" if e in self._positive else "real"
            symbol = self._sympy.Symbol(name, **{assumption: True})
            self._parameters[symbol] = e
            return symbol
        orders = {"coordinate": 0, "velocity": 1, "differential": 1, "acceleration": 2}
        return self._sympy.Integer(1) if kind == "dt" else self.velocity(name, orders[kind])

    def _call(self, name: str, orders: tuple[int, ...], arguments: list[Any]) -> Any:
        sp = self._sympy
        function = sp.Function(name, real=True)
        if not any(orders):
            return function(*arguments)
        places = [sp.Dummy(f"xi_{i}", real=True) for i in range(len(arguments))]
        steps = [(place, order) for place, order in zip(places, orders, strict=True) if order]
        return sp.Subs(sp.Derivative(function(*places), *steps), places, arguments)

    # From SymPy

    def from_sympy(self, e: Any) -> Expr:
        """Return the SymPy expression ``e`` as an `Expr`. Raises UntranslatableError if it has no counterpart."""
        translated = self._back.get(e)
        if translated is None:
            translated = self._back[e] = self._node_from_sympy(e)
        return translated

    def _node_from_sympy(self, e: Any) -> Expr:
        """Return a SymPy expression as an `Expr`. Raises UntranslatableError."""
        sp = self._sympy
        if e.is_Rational:
            return ex.num(Fraction(int(e.p), int(e.q)))
        if e.is_Symbol:
            return ex.TIME if e == self.time else self._parameter(e)
        if e in self._names:
            return ex.coordinate(self._names[e])
        if e == sp.pi or e == sp.E:
            return ex.PI if e == sp.pi else ex.E
        for kind, read in _READ.items():
            if isinstance(e, getattr(sp, kind)):
                return read(self, e)
        if isinstance(e, sp.core.function.AppliedUndef):
            return ex.call(str(e.func.__name__), map(self.from_sympy, e.args))
        elementary = _BACK.get(type(e).__name__)
        if elementary is None:
            raise UntranslatableError(f"SymPy's {type(e).__name__} cannot be written here")
        return ex.fn(elementary, *map(self.from_sympy, e.args))

    def _parameter(self, e: Any) -> Expr:
        return self._parameters.get(e) or ex.parameter(str(e.name))

    def derivative(self, e: Any) -> Expr:
        """Return a SymPy ``Derivative``: a velocity, an acceleration, or the derivative of an unknown function."""
        base, steps = e.expr, {variable: int(order) for variable, order in e.variable_count}
        if steps == {base: 1}:
            return ex.ONE
        if base in self._names:
            order = steps.pop(self.time, 0)
            kinds: dict[int, ex.Kind] = {1: "velocity", 2: "acceleration"}
            if steps or order not in kinds:
                raise UntranslatableError("a derivative of higher order than the second")
            return ex.sym(kinds[order], self._names[base])
        if not isinstance(base, self._sympy.core.function.AppliedUndef):
            raise UntranslatableError("a derivative that was not worked out")
        return ex.call(str(base.func.__name__), map(self.from_sympy, base.args), self._orders(base, steps))

    def _orders(self, base: Any, steps: Mapping[Any, int]) -> tuple[int, ...]:
        """Return how often ``base`` is differentiated by each argument. Raises if two arguments share a variable."""
        for variable in steps:
            if sum(a == variable or a.has(variable) for a in base.args) != 1 or variable not in base.args:
                raise UntranslatableError("a derivative by a variable of several arguments")
        return tuple(steps.get(a, 0) for a in base.args)

    def substituted(self, e: Any) -> Expr:
        """Return a SymPy ``Subs``: a derivative of an unknown function, evaluated at other arguments."""
        inner = e.expr
        if not isinstance(inner, self._sympy.Derivative):
            raise UntranslatableError("a substitution that was not carried out")
        values = dict(zip(e.variables, e.point, strict=True))
        steps = {variable: int(order) for variable, order in inner.variable_count}
        arguments = [self.from_sympy(values.get(a, a)) for a in inner.expr.args]
        return ex.call(str(inner.expr.func.__name__), arguments, self._orders(inner.expr, steps))


def _sign(bridge: Bridge, e: Any) -> Expr:
    argument = bridge.from_sympy(e.args[0])
    return argument / ex.fn("abs", argument)


_READ: dict[str, Callable[[Bridge, Any], Expr]] = {
    "Add": lambda b, e: ex.add(*map(b.from_sympy, e.args)),
    "Mul": lambda b, e: ex.mul(*map(b.from_sympy, e.args)),
    "exp": lambda b, e: ex.fn("exp", b.from_sympy(e.args[0])),
    "Pow": lambda b, e: ex.power(b.from_sympy(e.base), b.from_sympy(e.exp)),
    "Derivative": Bridge.derivative,
    "Subs": Bridge.substituted,
    "sign": _sign,
}  # fmt: skip


def integrators() -> tuple[Callable[..., Any], ...]:
    """Return SymPy's integration functions; a first call, before a time limit begins, keeps the import out of it."""
    from sympy.integrals.manualintegrate import manualintegrate
    from sympy.integrals.risch import risch_integrate

    return risch_integrate, manualintegrate


def antiderivative_by_sympy(e: Expr, x: Expr, positive: frozenset[Expr]) -> Expr | None:
    """Return an antiderivative of ``e`` by the symbol ``x``, or None if SymPy finds none.

    Risch's algorithm (rational functions, exponentials and logarithms) is tried first, then textbook rules. Raises
    UntranslatableError if the result has no counterpart in the grammar.
    """
    from sympy import Integral, Piecewise
    from sympy.polys.polyerrors import BasePolynomialError

    renamed = {s: ex.parameter(f"p{i}") for i, s in enumerate(sorted(e.symbols, key=repr))}
    bridge = Bridge((), frozenset(renamed[s] for s in e.symbols & positive))
    integrand, variable = bridge.to_sympy(substitute(e, renamed)), bridge.to_sympy(renamed[x])
    for integrate in integrators():
        try:
            integral = integrate(integrand, variable)
        except (ArithmeticError, AttributeError, BasePolynomialError, LookupError, RuntimeError, TypeError, ValueError):
            continue  # NotImplementedError is a RuntimeError
        if not integral.has(Integral, Piecewise):
            return substitute(bridge.from_sympy(integral), {p: s for s, p in renamed.items()})
    return None
