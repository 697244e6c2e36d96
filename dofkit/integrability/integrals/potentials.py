"""The potential of a closed form, by antiderivatives in one variable, with a bounded amount of exact algebra.

Results are not proved here: `search` differentiates them. A table contains the antiderivatives of powers, exponentials
and trigonometric functions of linear arguments, so that common forms need no SymPy; SymPy computes all others.
`Algebra` computes quotients in lowest terms and proves identities.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from typing import TypeVar

from dofkit.base.deadline import OutOfTimeError, by_processor, check, checked_calls, remaining_seconds, thread_time
from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import Canon, is_identically_zero, quotients_of
from dofkit.exact.ring.program import TooLargeError, none_without_value, raising_no_value
from dofkit.exact.ring.quotients import MAX_TERMS, Quotient, factored, rationalised
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, expand, substitute
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.sympy_bridge import UntranslatableError, antiderivative_by_sympy, integrators
from dofkit.expressions.tree import Expr

T = TypeVar("T")

#: The budget of one integration, in steps (about one for each canonical form); beyond it there is no result.
STEPS = 400
#: Seconds that SymPy may take in one integration.
SECONDS = 3.0
#: The largest expression that is brought to canonical form, in nodes.
MAX_NODES = 500


class GivenUpError(Exception):
    """The budget of steps is exhausted."""


class Algebra:
    """Canonical forms of expressions, within one budget of steps and seconds; ``positive`` symbols are > 0."""

    def __init__(self, positive: frozenset[Expr], reference: Mapping[Expr, Expr] | None = None) -> None:
        self.positive = positive
        self.reference = {**(reference or {}), ex.TIME: ex.ZERO}
        self.steps = STEPS
        self.seconds = SECONDS
        self._tidied: dict[Expr, Expr] = {}
        self._vanishing: dict[Expr, bool] = {}

    def attempt(self, work: Callable[[], T]) -> T | None:
        """Return the result of ``work``, or None where an expression has no canonical form or a divisor is 0."""
        return none_without_value(raising_no_value(work))()

    def spend(self, expressions: Iterable[Expr]) -> None:
        """Deduct the steps for canonical forms. Raises TooLargeError above MAX_NODES; GivenUpError: see `tick`."""
        sizes = [ex.size(e) for e in expressions]
        if max(sizes) > MAX_NODES:
            raise TooLargeError
        self.tick(sum(1 + nodes // 20 for nodes in sizes))

    def tick(self, steps: int = 1) -> None:
        """Deduct steps from the budget. Raises GivenUpError when none remain."""
        self.steps -= steps
        if self.steps < 0:
            raise GivenUpError

    def lowered(self, expressions: Sequence[Expr]) -> tuple[Canon, list[Quotient]]:
        """Return the expressions as quotients in lowest terms over one set of generators."""
        self.spend(expressions)
        canon, quotients = quotients_of(expressions, self.positive)
        self.tick(sum(len(p) for quotient in quotients for p in quotient) // 50)
        return canon, [rationalised(canon, quotient) for quotient in quotients]

    def tidy(self, e: Expr) -> Expr:
        """Return ``e`` as one factored quotient in lowest terms, or ``e`` itself where that is too large."""
        tidied = self._tidied.get(e)
        if tidied is None:
            factored_form = self.attempt(lambda: self._quotient(e))
            tidied = self._tidied[e] = e if factored_form is None else factored_form
            self._tidied[tidied] = tidied
        return tidied

    def _quotient(self, e: Expr) -> Expr:
        canon, (quotient,) = self.lowered([e])
        top, bottom = quotient
        if len(top) + len(bottom) > MAX_TERMS:
            raise TooLargeError
        return factored(canon, top) / factored(canon, bottom)

    def vanishes(self, e: Expr) -> bool:
        """Return whether ``e`` is proved to be zero identically."""
        if e.op in ("num", "sym"):
            return e.is_zero
        zero = self._vanishing.get(e)
        if zero is None:
            zero = self._vanishing[e] = bool(self.attempt(lambda: self._is_zero(e)))
        return zero

    def _is_zero(self, e: Expr) -> bool | None:
        self.spend([e])
        return is_identically_zero(e, self.positive)

    def with_values(self, e: Expr) -> Expr:
        """Return ``e`` with log(-u) for log(u), which has the same differential, if u < 0 at the reference."""
        operands = tuple(map(self.with_values, ex.children(e)))
        if e.op == "fn" and e.args[0] == "log" and (approximate(substitute(operands[0], self.reference)) or 0) < 0:
            return ex.fn("log", -operands[0])
        return ex.rebuild(e, operands) if operands else e

    def closed(self, form: dict[Expr, Expr]) -> bool:
        """Return whether d(omega) = 0 is proved for the form omega."""
        items = list(form.items())
        return all(self.vanishes(diff(b, s) - diff(a, u)) for i, (s, a) in enumerate(items) for u, b in items[i + 1 :])


#: A one-form omega, symbol -> coefficient; 0 for symbols that occur only in coefficients.
Form = dict[Expr, Expr]
#: Most orders of the variables of integration that are tried for a potential.
MAX_ORDERS = 4
#: The largest integrand given to SymPy, in nodes, and the steps that this deducts from the budget.
MAX_SYMPY, SYMPY_STEPS = 60, 20


def potential(work: Algebra, form: Form) -> Expr | None:
    """Return f with df = omega for a closed form, or None where an antiderivative is not found [PoincareLemma]."""
    symbols = list(form)
    for first in range(min(len(symbols), MAX_ORDERS)):
        f = _potential_in_order(work, form, [*symbols[first:], *symbols[:first]])
        if f is not None:
            return f
    return None


def _potential_in_order(work: Algebra, form: Form, order: list[Expr]) -> Expr | None:
    """Return the potential by integration over the symbols in this order; None if an antiderivative is not found."""
    total, integrated = ex.ZERO, set[Expr]()
    for symbol in order:
        slope = form[symbol] - diff(total, symbol)
        if not integrated.isdisjoint(slope.symbols):
            slope = work.tidy(slope)  # in a closed form the symbols integrated before cancel
            if not integrated.isdisjoint(slope.symbols):
                return None
        summand = ex.ZERO if slope.is_zero else antiderivative(work, slope, symbol)
        if summand is None:
            return None
        total = total + summand
        integrated.add(symbol)
    return total


def antiderivative(work: Algebra, e: Expr, x: Expr) -> Expr | None:
    """Return F with dF/dx = e, all other symbols constant, or None where neither the table nor SymPy has one."""
    if x not in e.symbols:
        return e * x
    for integrand in dict.fromkeys((e, work.tidy(e))):
        integral = _termwise(work, expand(integrand), x)
        if integral is not None:
            return integral
    return _by_sympy(work, min(e, work.tidy(e), key=ex.size), x)


def _termwise(work: Algebra, e: Expr, x: Expr) -> Expr | None:
    """Return the antiderivative of a sum of terms that are all in the table, else None."""
    integrals = []
    for term in e.args if e.op == "add" else (e,):
        work.tick()
        constant, factors = collected_powers(term, x)
        integral = x if not factors else _of_factor(factors[0], x) if len(factors) == 1 else None
        if integral is None:
            return None
        integrals.append(constant * integral)
    return ex.add(*integrals)


def as_power(e: Expr) -> tuple[Expr, Fraction]:
    """Return (base, exponent) of a power with a numeric exponent, (e, 1) for all else."""
    if e.op == "pow" and e.args[1].op == "num":
        return e.args[0], e.args[1].args[0]
    return e, Fraction(1)


def collected_powers(term: Expr, x: Expr) -> tuple[Expr, list[Expr]]:
    """Return the product of the factors without x, and the factors with x, powers of equal bases multiplied."""
    constants, bases = [], dict[Expr, Fraction]()
    for factor in term.args if term.op == "mul" else (term,):
        if x in factor.symbols:
            base, exponent = as_power(factor)
            bases[base] = bases.get(base, Fraction(0)) + exponent
        else:
            constants.append(factor)
    return ex.mul(*constants), [ex.power(base, ex.num(k)) for base, k in bases.items() if k]


def _linear(u: Expr, x: Expr) -> Expr | None:
    """Return a where u = a x + b, else None."""
    a = diff(u, x)
    return None if x in a.symbols or a.is_zero else a


def _of_factor(e: Expr, x: Expr) -> Expr | None:
    """Return the antiderivative by x of x itself, a power, an unknown function or one in the table, else None."""
    if e.op == "pow":
        return _of_power(e, x)
    if e.op == "call":
        return _of_unknown_function(e, x)
    a = x if e == x else _linear(e.args[1], x) if e.op == "fn" and len(e.args) == 2 else None
    if a is None:
        return None
    if e == x:
        return x * x / 2
    integral = _of_function(e.args[0], e.args[1])
    return None if integral is None else integral / a


def _of_function(name: str, u: Expr) -> Expr | None:
    """Return the antiderivative of the function ``name`` by its argument u; None if it is not in the table."""
    sin, cos = ex.fn("sin", u), ex.fn("cos", u)
    table = {
        "exp": ex.fn("exp", u), "sinh": ex.fn("cosh", u), "cosh": ex.fn("sinh", u),
        "tanh": ex.fn("log", ex.fn("cosh", u)),
        "sin": -cos, "cos": sin, "tan": -ex.fn("log", cos), "cot": ex.fn("log", sin),
        "sec": ex.fn("log", (1 + sin) / cos), "csc": ex.fn("log", (1 - cos) / sin),
    }  # fmt: skip
    return table.get(name)


def _of_power(e: Expr, x: Expr) -> Expr | None:
    """Return the antiderivative by x of a power that is in the table, else None."""
    base, exponent = e.args
    if x in exponent.symbols:
        a = _linear(exponent, x)
        return None if x in base.symbols or a is None else e / (a * ex.fn("log", base))
    a = _linear(base, x)
    if a is not None:
        return ex.fn("log", base) / a if exponent == ex.MINUS_ONE else base * e / ((exponent + 1) * a)
    if base.op == "fn" and base.args[0] in ("sin", "cos"):
        return _of_wave_power(base, exponent, x)
    return _of_inverse_root(base, x) if exponent == ex.num(Fraction(-1, 2)) else None


def _of_wave_power(wave: Expr, exponent: Expr, x: Expr) -> Expr | None:
    """Return the antiderivative of sin or cos of a linear argument to the power -2 or -1; None for all else."""
    name, u = wave.args
    a = _linear(u, x)
    if a is None or exponent.op != "num" or exponent.args[0] not in (-1, -2):
        return None
    if exponent == ex.MINUS_ONE:
        integral = _of_function("csc" if name == "sin" else "sec", u)
        return None if integral is None else integral / a
    return (ex.fn("tan", u) if name == "cos" else -ex.fn("cos", u) / ex.fn("sin", u)) / a


def _of_inverse_root(base: Expr, x: Expr) -> Expr | None:
    """Return the antiderivative of base^(-1/2) for base = a x^2 + b x + c, a a number; None for all else."""
    slope = diff(base, x)
    twice = _linear(slope, x)
    if twice is None or twice.op != "num":
        return None
    if twice.args[0] > 0:
        width = ex.sqrt(twice / 2)
        return ex.fn("log", 2 * width * ex.sqrt(base) + slope) / width
    width = ex.sqrt(-twice / 2)
    return ex.fn("atan", -slope / (2 * width * ex.sqrt(base))) / width


def _of_unknown_function(e: Expr, x: Expr) -> Expr | None:
    """Return the antiderivative of f'(u), f an unknown function, if x occurs, linearly, only in the argument u."""
    name, orders, arguments = e.args
    places = [i for i, u in enumerate(arguments) if x in u.symbols]
    a = _linear(arguments[places[0]], x)
    if len(places) > 1 or a is None or not orders[places[0]]:
        return None
    return ex.call(name, arguments, tuple(k - (i == places[0]) for i, k in enumerate(orders))) / a


def _by_sympy(work: Algebra, e: Expr, x: Expr) -> Expr | None:
    """Return SymPy's antiderivative, or None if SymPy finds none within the seconds that remain of the budget."""
    if ex.size(e) > MAX_SYMPY or any(n.op == "call" for n in ex.nodes(e)):
        return None
    work.tick(SYMPY_STEPS)
    integrators()
    start = thread_time()
    try:
        with by_processor(min(work.seconds, remaining_seconds())), checked_calls():
            return antiderivative_by_sympy(e, x, work.positive)
    except OutOfTimeError:
        check()
    except (UntranslatableError, NoValueError):
        pass
    finally:
        work.seconds -= thread_time() - start
    return None
