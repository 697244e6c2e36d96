"""Expression trees: what a text says, node by node, with exact numbers; what is refused, and what work may cost.

Heads: ``number`` (``value`` a Fraction), ``symbol`` (``value`` its name), ``sum``, ``product``, ``power`` (base and
exponent), the name of an elementary function (``sin``, ``atan2``, ...), and ``apply`` (``value`` the name of a declared
function, ``orders`` how often it is differentiated by each argument). ``pi`` is a head of its own; E is ``exp(1)``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import prod

_NAMES = "sin cos tan cot sec csc asin acos atan atan2 sinh cosh tanh exp log sqrt abs"
FUNCTIONS = tuple(_NAMES.split())

#: The size of a tree: its nodes, each as often as powers repeat it, and 64 bits of a number for one; that of a number.
LARGEST, LARGEST_NUMBER = 50_000, 512
#: Units of work of a whole certificate: about products of terms of polynomials, or nodes evaluated.
MOST_WORK = 60_000_000


class CheckError(ValueError):
    """A text, a scene or a certificate that cannot be read: nothing about it is verified."""


def refuse(when: object, why: str) -> None:
    """`CheckError` where something is so that must not be."""
    if when:
        raise CheckError(why)


class Effort:
    """A purse of units of work, the same on every machine: who has spent them all is refused."""

    def __init__(self, units: int = MOST_WORK) -> None:
        self.left = units

    def spend(self, units: int) -> None:
        """Take units out of the purse."""
        self.left -= units
        refuse(self.left < 0, "the work that a certificate may cost is used up")


@dataclass(frozen=True, slots=True)
class Tree:
    """One node of an expression; ``symbols`` are those in it; ``applied``: a declared function occurs."""

    head: str
    below: tuple[Tree, ...] = ()
    value: Fraction | str = ""
    orders: tuple[int, ...] = ()
    size: int = field(init=False, compare=False, repr=False)
    symbols: frozenset[str] = field(init=False, compare=False, repr=False)
    applied: bool = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Parts may be shared, so that a short text writes a huge tree, and powers of powers a huge number."""
        exponent = self.below[1].value if self.head == "power" else 1
        often = max(1, int(abs(exponent))) if isinstance(exponent, Fraction) else 1
        digits = self.value.as_integer_ratio() if isinstance(self.value, Fraction) else (0,)
        own = 1 + max(map(int.bit_length, digits)) // 64
        object.__setattr__(self, "size", own + often * sum(part.size for part in self.below))
        named = frozenset((str(self.value),) if self.head == "symbol" else ())
        object.__setattr__(self, "symbols", named.union(*(part.symbols for part in self.below)))
        object.__setattr__(self, "applied", self.head == "apply" or any(part.applied for part in self.below))
        refuse(self.size > LARGEST or own > LARGEST_NUMBER, "an expression or a number is too large")


ZERO, ONE = (Tree("number", (), Fraction(k)) for k in (0, 1))


def number(value: Fraction | int) -> Tree:
    """A rational number."""
    return Tree("number", (), Fraction(value))


def symbol(name: str) -> Tree:
    """A coordinate, a parameter, time, or a velocity."""
    return Tree("symbol", (), name)


def _split(parts: Sequence[Tree]) -> tuple[list[Fraction], list[Tree]]:
    """The numbers among terms or factors, and the others."""
    refuse(sum(p.size - 1 for p in parts if p.head == "number") > LARGEST_NUMBER, "a number is too large")
    return [p.value for p in parts if isinstance(p.value, Fraction)], [p for p in parts if p.head != "number"]


def add(*terms: Tree) -> Tree:
    """A sum; numbers are added up and 0 is left out."""
    numbers, rest = _split(terms)
    if constant := sum(numbers, Fraction(0)):
        rest.append(number(constant))
    return rest[0] if len(rest) == 1 else Tree("sum", tuple(rest)) if rest else ZERO


def times(*factors: Tree) -> Tree:
    """A product; numbers are multiplied and 1 is left out, 0 is 0."""
    numbers, rest = _split(factors)
    constant = prod(numbers, start=Fraction(1))
    if constant == 0:
        return ZERO
    if constant != 1 or not rest:
        rest.insert(0, number(constant))
    return rest[0] if len(rest) == 1 else Tree("product", tuple(rest))


def negative(term: Tree) -> Tree:
    """Times -1."""
    return times(number(-1), term)


def difference(a: Tree, b: Tree) -> Tree:
    """a - b, 0 where they are the same."""
    return ZERO if a == b else add(a, negative(b))


def power(base: Tree, exponent: Tree) -> Tree:
    """A power; exponents 0 and 1, and powers of 1, are carried out."""
    if exponent == ONE:
        return base
    return ONE if base == ONE or exponent == ZERO else Tree("power", (base, exponent))


def call(name: str, *arguments: Tree) -> Tree:
    """An elementary function, told by sines, cosines, exponentials, logarithms, powers and ``atan2``."""
    return _MEANINGS[name](*arguments) if name in _MEANINGS else Tree(name, arguments)


TWO, HALF, MINUS = number(2), number(Fraction(1, 2)), number(-1)
#: Each is the same real number, and has a value and is smooth at the same places.
_MEANINGS: dict[str, Callable[..., Tree]] = {
    "tan": lambda u: times(call("sin", u), call("sec", u)), "sec": lambda u: power(call("cos", u), MINUS),
    "cot": lambda u: times(call("cos", u), call("csc", u)), "csc": lambda u: power(call("sin", u), MINUS),
    "sqrt": lambda u: power(u, HALF), "abs": lambda u: power(power(u, TWO), HALF),
    "asin": lambda u: call("atan2", u, call("cos asin", u)), "acos": lambda u: call("atan2", call("cos asin", u), u),
    "cos asin": lambda u: call("sqrt", difference(ONE, power(u, TWO))), "atan": lambda u: call("atan2", u, ONE),
    "sinh": lambda u: times(HALF, difference(call("exp", u), call("exp", negative(u)))),
    "cosh": lambda u: times(HALF, add(call("exp", u), call("exp", negative(u)))),
    "tanh": lambda u: times(call("sinh", u), power(call("cosh", u), MINUS)),
}  # fmt: skip
