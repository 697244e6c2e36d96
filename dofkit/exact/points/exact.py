"""Points with rational coordinates: values there are exact, and so is a rank."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from flint import fmpq, fmpq_mat

from dofkit.exact.errors import NoPointError, NoValueError
from dofkit.exact.ring.program import Scalar, Var, gradient, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions.tree import Expr

#: Entries of a matrix that is eliminated over the rationals.
MAX_ENTRIES = 20_000
#: Functions that have a rational value at 0.
AT_ZERO = {"cos": 1, "sin": 0, "exp": 1, "asin": 0, "atan": 0}


class ExactPoint:
    """Rational values of the symbols; of functions, those at 0 and roots of powers. Raises NoPointError for others."""

    def __init__(self, symbols: Mapping[Expr, Fraction]) -> None:
        self.symbols = symbols

    def number(self, value: Fraction) -> fmpq:
        return fmpq(value.numerator, value.denominator)

    def generator(self, var: Var, args: Sequence[Scalar]) -> fmpq:
        if var.kind == "symbol" and var.key in self.symbols:
            return self.number(self.symbols[var.key])
        if var.kind in AT_ZERO and args and args[0] == 0:
            return fmpq(AT_ZERO[var.kind])
        if var.kind == "root":
            return _root(args[0], var.degree)
        raise NoPointError(f"{var.kind} has no rational value there")


def _root(value: fmpq, degree: int) -> fmpq:
    """The root of a power of a rational that is not negative. Raises NoPointError."""
    if value >= 0:
        top, bottom = (n.root(degree) for n in (value.p, value.q))
        if top**degree == value.p and bottom**degree == value.q:
            return fmpq(top, bottom)
    raise NoPointError("a root that is no rational")


def rational_values(known: Mapping[Expr, Expr]) -> dict[Expr, Fraction]:
    """The symbols whose values are written as rational numbers."""
    return {s: v.args[0] for s, v in known.items() if v.op == "num"}


def vanish_exactly(ring: Ring, nodes: Sequence[int], symbols: Mapping[Expr, Fraction]) -> bool:
    """Are nodes proved to be 0 at a rational point? False where a value is no rational."""
    try:
        at = values(ring, ExactPoint(symbols))
    except NoValueError:
        return False
    return all(at[node] == 0 for node in nodes)


def exact_rank(
    ring: Ring, nodes: Sequence[int], columns: Sequence[int], symbols: Mapping[Expr, Fraction]
) -> int | None:
    """The rank of d(nodes)/d(columns) at a rational point; None where a value is none, or there are too many.

    ``columns``: generators of symbols, -1 for one that does not occur.
    """
    present = [c for c in columns if c >= 0]
    if len(nodes) * len(present) > MAX_ENTRIES:
        return None
    if not nodes or not present:
        return 0
    point = ExactPoint(symbols)
    try:
        at = values(ring, point)
        slopes = [gradient(ring, at, point, [(node, fmpq(1))]) for node in nodes]
    except NoValueError:
        return None
    return int(fmpq_mat([[row.get(c, fmpq(0)) for c in present] for row in slopes]).rref()[1])
