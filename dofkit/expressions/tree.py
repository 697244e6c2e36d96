"""Expressions: an immutable tree of exact arithmetic, light enough to build thousands of in a millisecond.

A node is ``Expr(op, args)``:

========  ==========================================================================
``op``    ``args``
========  ==========================================================================
num       ``(Fraction,)``; every number is exact, floats never enter
sym       ``(kind, name)``; ``kind`` is one of `Kind`: the velocity of ``x`` is
          ``("velocity", "x")``, its differential ``("differential", "x")``
const     ``("pi",)`` or ``("E",)``
add       terms
mul       factors
pow       ``(base, exponent)``; ``sqrt(x)`` is ``x^(1/2)``, ``exp`` is a function
fn        ``(name, argument, ...)`` with a name of `FUNCTIONS`
call      ``(name, orders, arguments)``: an unknown smooth function, differentiated
          ``orders[i]`` times by its i-th argument
========  ==========================================================================

Build nodes with the functions below or with ``+ - * / **``; they fold numbers and collect
equal terms and nothing else. Nodes compare by structure.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from functools import lru_cache
from typing import Any, Literal, get_args

from dofkit.expressions.rational_values import TURNING, exact_power, value_at, value_at_turn

Kind = Literal["coordinate", "velocity", "acceleration", "differential", "parameter", "time", "dt"]
KINDS: tuple[str, ...] = get_args(Kind)

#: Symbols that are remembered.
MOST_SYMBOLS = 400_000
#: The closed list of elementary functions, with their numbers of arguments.
FUNCTIONS: dict[str, int] = {
    "sin": 1, "cos": 1, "tan": 1, "cot": 1, "sec": 1, "csc": 1,
    "asin": 1, "acos": 1, "atan": 1, "atan2": 2,
    "sinh": 1, "cosh": 1, "tanh": 1, "exp": 1, "log": 1, "abs": 1,
}  # fmt: skip


class Expr:
    """One node of an expression; see the module's table for ``op`` and ``args``."""

    __slots__ = ("_functions", "_hash", "_symbols", "args", "op", "shape")

    def __init__(self, op: str, args: tuple[Any, ...]) -> None:
        self.op = op
        self.args = args
        self.shape: Any = None  # kept by `renaming`
        self._hash = hash((op, args))
        self._symbols: frozenset[Expr] | None = None
        self._functions: frozenset[str] | None = None

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        if not isinstance(other, Expr) or self._hash != other._hash:
            return False
        return self.op == other.op and self.args == other.args

    def __reduce__(self) -> tuple[Any, ...]:
        return (Expr, (self.op, self.args))

    def __repr__(self) -> str:
        return f"Expr({self.op!r}, {self.args!r})"

    def __add__(self, other: ExprLike) -> Expr:
        return add(self, as_expr(other))

    def __radd__(self, other: ExprLike) -> Expr:
        return add(as_expr(other), self)

    def __sub__(self, other: ExprLike) -> Expr:
        return add(self, mul(MINUS_ONE, as_expr(other)))

    def __rsub__(self, other: ExprLike) -> Expr:
        return add(as_expr(other), mul(MINUS_ONE, self))

    def __mul__(self, other: ExprLike) -> Expr:
        return mul(self, as_expr(other))

    def __rmul__(self, other: ExprLike) -> Expr:
        return mul(as_expr(other), self)

    def __truediv__(self, other: ExprLike) -> Expr:
        return mul(self, power(as_expr(other), MINUS_ONE))

    def __rtruediv__(self, other: ExprLike) -> Expr:
        return mul(as_expr(other), power(self, MINUS_ONE))

    def __pow__(self, other: ExprLike) -> Expr:
        return power(self, as_expr(other))

    def __neg__(self) -> Expr:
        return mul(MINUS_ONE, self)

    @property
    def symbols(self) -> frozenset[Expr]:
        """All ``sym`` nodes in the expression."""
        if self._symbols is None:
            if self.op == "sym":
                self._symbols = frozenset((self,))
            else:
                symbols: frozenset[Expr] = _NO_SYMBOLS
                for child in children(self):
                    of_child = child.symbols
                    if of_child and not of_child <= symbols:
                        symbols = of_child if symbols <= of_child else symbols | of_child
                self._symbols = symbols
        return self._symbols

    @property
    def functions(self) -> frozenset[str]:
        """The names of the functions that occur; ``pow`` for powers but whole ones, ``call`` for unknown functions."""
        if self._functions is None:
            functions = _NO_NAMES if self.op in ("num", "sym", "const", "add", "mul") else _function_of(self)
            for child in children(self):
                of_child = child.functions
                if of_child and not of_child <= functions:
                    functions = functions | of_child
            self._functions = functions
        return self._functions

    @property
    def is_zero(self) -> bool:
        """True for the number 0 as written; says nothing of hidden zeros."""
        return self.op == "num" and not self.args[0]


ExprLike = Expr | int | Fraction
_NO_SYMBOLS, _NO_NAMES = frozenset[Expr](), frozenset[str]()


def _function_of(e: Expr) -> frozenset[str]:
    whole = e.op == "pow" and e.args[1].op == "num" and e.args[1].args[0].denominator == 1
    return _NO_NAMES if whole else frozenset((str(e.args[0]) if e.op == "fn" else e.op,))


def num(value: int | Fraction) -> Expr:
    """Return the exact number ``value``."""
    if value.denominator == 1 and value.numerator in _SMALL:
        return _SMALL[value.numerator]
    return Expr("num", (value if type(value) is Fraction else Fraction(value),))


#: The numbers that occur most.
_SMALL: dict[int, Expr] = {}
_SMALL |= {n: num(n) for n in range(-16, 17)}

ZERO, ONE, MINUS_ONE, TWO, HALF = (num(Fraction(v)) for v in (0, 1, -1, 2, Fraction(1, 2)))
PI, E = Expr("const", ("pi",)), Expr("const", ("E",))


def as_expr(value: ExprLike) -> Expr:
    """Return ``value`` itself, or the exact number it stands for. Raises TypeError for floats and text."""
    if isinstance(value, Expr):
        return value
    if isinstance(value, (int, Fraction)) and not isinstance(value, bool):
        return num(value)
    raise TypeError(f"an exact number or an Expr is needed, not {type(value).__name__}")


@lru_cache(MOST_SYMBOLS)
def sym(kind: Kind, name: str) -> Expr:
    """Return the symbol ``name`` of the given kind: mostly one object, however often it occurs."""
    return Expr("sym", (kind, name))


def coordinate(name: str) -> Expr:
    """Return the configuration coordinate q."""
    return sym("coordinate", name)


def velocity(name: str) -> Expr:
    """qdot."""
    return sym("velocity", name)


def differential(name: str) -> Expr:
    """dq."""
    return sym("differential", name)


def parameter(name: str) -> Expr:
    """Return a constant with a name."""
    return sym("parameter", name)


TIME, DT = sym("time", "t"), sym("dt", "t")
_ONCE: Fraction = ONE.args[0]


def number_and_rest(term: Expr) -> tuple[Fraction, Expr]:
    """Return (number, other factors), whose product is ``term``."""
    if term.op == "num":
        return term.args[0], ONE
    if term.op == "mul" and term.args[0].op == "num":
        factors = term.args[1:]
        return term.args[0].args[0], factors[0] if len(factors) == 1 else Expr("mul", factors)
    return _ONCE, term


def add(*terms: Expr) -> Expr:
    """Return the sum; numbers are folded and equal terms collected."""
    return total([(1, term) for term in terms])


def total(multiples: Iterable[tuple[int | Fraction, Expr]]) -> Expr:
    """Return the sum of numbers times expressions, equal terms collected.

    Whole numbers are kept as int while they are added, which is several times faster than Fraction.
    """
    collected: dict[Expr, int | Fraction] = {}
    for factor, e in multiples:
        for term in e.args if e.op == "add" else (e,):
            number: int | Fraction = factor
            if term.op == "num" or (term.op == "mul" and term.args[0].op == "num"):
                coefficient, term = number_and_rest(term)
                number = factor * whole(coefficient)
            collected[term] = collected[term] + number if term in collected else number
    terms = [_times(number, term) for term, number in collected.items() if number]
    if len(terms) > 1:
        return Expr("add", tuple(terms))
    return terms[0] if terms else ZERO


def whole(number: Fraction) -> int | Fraction:
    """Return a whole number as int, and any other as it is."""
    return number.numerator if number.denominator == 1 else number


def _times(number: int | Fraction, term: Expr) -> Expr:
    if number == 1:
        return term
    factor = num(number)
    if term == ONE:
        return factor
    return Expr("mul", (factor, *term.args) if term.op == "mul" else (factor, term))


def mul(*factors: Expr) -> Expr:
    """Return the product; numbers are folded and integer powers of equal factors collected."""
    number = _ONCE
    powers: dict[Expr, int] = {}
    for factor in factors:
        for part in factor.args if factor.op == "mul" else (factor,):
            if part.op == "num":
                number = part.args[0] if number is _ONCE else number * part.args[0]
                continue
            base, exponent = part, 1
            if part.op == "pow" and part.args[1].op == "num" and part.args[1].args[0].denominator == 1:
                base, exponent = part.args[0], part.args[1].args[0].numerator
            powers[base] = powers.get(base, 0) + exponent
    if not number:
        return ZERO
    grouped = [base if e == 1 else power(base, num(e)) for base, e in powers.items() if e]
    if len(grouped) == 1 and number != 1 and grouped[0].op == "add":
        return add(*(mul(num(number), term) for term in grouped[0].args))
    flat = [p for part in grouped for p in (part.args if part.op == "mul" else (part,))]
    for p in flat:
        if p.op == "num":
            number *= p.args[0]
    flat = [p for p in flat if p.op != "num"]
    if number != 1 or not flat:
        flat.insert(0, num(number))
    return flat[0] if len(flat) == 1 else Expr("mul", tuple(flat))


def power(base: Expr, exponent: Expr) -> Expr:
    """Return ``base^exponent``; ``E^u`` is ``exp(u)``, ``0^-n`` raises PoleError."""
    if exponent.op == "num":
        value: Fraction = exponent.args[0]
        if value == 1:
            return base
        if base.op == "num":
            folded = exact_power(base.args[0], value)
            if folded is not None:
                return num(folded)
        if value == 0:
            return ONE
        if value.denominator == 1:
            if base.op == "pow" and base.args[1].op == "num":
                return power(base.args[0], num(base.args[1].args[0] * value))
            if base.op == "mul":
                return mul(*(power(part, exponent) for part in base.args))
    if base == E:
        return fn("exp", exponent)
    return Expr("pow", (base, exponent))


def sqrt(value: Expr) -> Expr:
    """Return the non-negative square root."""
    return power(value, HALF)


def fn(name: str, *arguments: Expr) -> Expr:
    """An elementary function of `FUNCTIONS`; ``sqrt`` is taken too. Folds values at 0, and rational ones of angles."""
    if name == "sqrt":
        return sqrt(*arguments)
    if FUNCTIONS.get(name) != len(arguments):
        raise ValueError(f"{name} does not take {len(arguments)} argument(s)")
    first = arguments[0]
    if first.op == "num":
        value = value_at(name, first.args[0])
    else:
        multiple, base = number_and_rest(first) if name in TURNING else (_ONCE, ONE)
        value = value_at_turn(name, multiple) if base == PI else None
    return Expr("fn", (name, *arguments)) if value is None else num(value)


def call(name: str, arguments: Iterable[Expr], orders: Iterable[int] | None = None) -> Expr:
    """Return the unknown function ``name`` at ``arguments``, differentiated ``orders[i]`` times by the i-th."""
    values = tuple(arguments)
    return Expr("call", (name, tuple(orders) if orders is not None else (0,) * len(values), values))


def children(e: Expr) -> tuple[Expr, ...]:
    """Return the nodes directly below ``e``."""
    if e.op in ("num", "sym", "const"):
        return ()
    if e.op == "fn":
        return e.args[1:]
    if e.op == "call":
        return tuple(e.args[2])
    return e.args


def rebuild(e: Expr, new_children: tuple[Expr, ...]) -> Expr:
    """Return ``e`` with its children replaced, folded again."""
    if e.op == "add":
        return add(*new_children)
    if e.op == "mul":
        return mul(*new_children)
    if e.op == "pow":
        return power(*new_children)
    if e.op == "fn":
        return fn(e.args[0], *new_children)
    if e.op == "call":
        return call(e.args[0], new_children, e.args[1])
    return e


def nodes(e: Expr) -> Iterator[Expr]:
    """Return every different node of ``e``, children first."""
    seen: set[Expr] = set()
    stack = [(e, False)]
    while stack:
        node, done = stack.pop()
        if done:
            yield node
        elif node not in seen:
            seen.add(node)
            stack.append((node, True))
            stack.extend((child, False) for child in reversed(children(node)))


def size(e: Expr) -> int:
    """Return the number of different nodes of ``e``."""
    return sum(1 for _ in nodes(e))
