"""Expression trees, node by node, with exact numbers: their derivatives, what is put in, and what work may cost.

Heads: ``number`` (``value`` a Fraction), ``symbol`` (``value`` its name), ``sum``, ``product``, ``power`` (base and
exponent), the name of an elementary function (``sin``, ``atan2``, ...), and ``apply`` (``value`` the name of a declared
function, ``orders`` how often it is differentiated by each argument). ``pi`` is a head of its own; E is ``exp(1)``.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache, reduce
from itertools import chain
from typing import TypeVar

_NAMES = "sin cos tan cot sec csc asin acos atan atan2 sinh cosh tanh exp log sqrt abs diff"
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
        self.remaining = units

    def spend(self, units: int) -> None:
        """Take units out of the purse."""
        self.remaining -= units
        refuse(self.remaining < 0, "the work that a certificate may cost is used up")


@dataclass(slots=True, eq=False)
class Tree:
    """A node of an expression, never changed; ``symbols`` are those in it; ``applied``: a declared function occurs."""

    head: str
    below: tuple[Tree, ...] = ()
    value: Fraction | str = ""
    orders: tuple[int, ...] = ()
    size: int = field(init=False, repr=False)
    symbols: frozenset[str] = field(init=False, repr=False)
    applied: bool = field(init=False, repr=False)
    hashed: int = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Parts may be shared, so that a short text writes a huge tree, and powers of powers a huge number."""
        head, below, value, often, words = self.head, self.below, self.value, 1, 1
        if head == "power" and isinstance(exponent := below[1].value, Fraction):
            often = max(1, int(abs(exponent)))
        elif isinstance(value, Fraction):
            words += max(value.numerator.bit_length(), value.denominator.bit_length()) // 64
        self.size = words + often * sum([part.size for part in below])
        named = frozenset((str(value),) if head == "symbol" else ())
        self.symbols = named.union(*[part.symbols for part in below]) if below else named
        self.applied = head == "apply" or any(part.applied for part in below)
        self.hashed = hash((head, below, value, self.orders))
        refuse(self.size > LARGEST or words > LARGEST_NUMBER, "an expression or a number is too large")

    def __hash__(self) -> int:
        """Trees are keys of memories again and again."""
        return self.hashed

    def __eq__(self, other: object) -> bool:
        """Whether both are written the same; with different hashes they are not."""
        if self is other or not isinstance(other, Tree) or self.hashed != other.hashed:
            return self is other
        same = self.head == other.head and self.value == other.value and self.orders == other.orders
        return same and self.below == other.below

    def __add__(self, other: Tree) -> Tree:
        """The sum."""
        return add(self, other)

    def __sub__(self, other: Tree) -> Tree:
        """The difference, 0 where both are the same."""
        return ZERO if self == other else add(self, -other)

    def __neg__(self) -> Tree:
        """Times -1."""
        return times(MINUS, self)

    def __mul__(self, other: Tree) -> Tree:
        """The product."""
        return times(self, other)

    def __truediv__(self, other: Tree) -> Tree:
        """The product with the inverse."""
        return times(self, power(other, MINUS))

    def __pow__(self, exponent: int) -> Tree:
        """A whole power."""
        return power(self, number(exponent))


ZERO, ONE, TWO, MINUS = (Tree("number", (), Fraction(k)) for k in (0, 1, 2, -1))
HALF = Tree("number", (), Fraction(1, 2))


@lru_cache(maxsize=1024)
def number(value: Fraction | int) -> Tree:
    """A rational number."""
    return Tree("number", (), Fraction(value))


def symbol(name: str) -> Tree:
    """A coordinate, a parameter, time, or a velocity."""
    return Tree("symbol", (), name)


def _split(terms: Sequence[Tree]) -> tuple[list[Fraction], list[Tree]]:
    """The numbers among terms or factors, and the others."""
    numbers = [term for term in terms if term.head == "number"]
    if not numbers:
        return [], [*terms]
    refuse(sum([p.size - 1 for p in numbers]) > LARGEST_NUMBER, "a number is too large")
    others = [term for term in terms if term.head != "number"]
    return [p.value for p in numbers if isinstance(p.value, Fraction)], others


def add(*terms: Tree) -> Tree:
    """A sum; numbers are added up and 0 is left out."""
    numbers, others = _split(terms)
    if numbers and (constant := reduce(operator.add, numbers)):
        others.append(number(constant))
    return others[0] if len(others) == 1 else Tree("sum", tuple(others)) if others else ZERO


def times(*factors: Tree) -> Tree:
    """A product; numbers are multiplied and 1 is left out, 0 is 0."""
    numbers, others = _split(factors)
    constant = reduce(operator.mul, numbers) if numbers else 1
    if constant == 0:
        return ZERO
    if constant != 1 or not others:
        others.insert(0, number(constant))
    return others[0] if len(others) == 1 else Tree("product", tuple(others))


def power(base: Tree, exponent: Tree) -> Tree:
    """A power; exponents 0 and 1, and powers of 1, are carried out."""
    if exponent == ONE:
        return base
    return ONE if base == ONE or exponent == ZERO else Tree("power", (base, exponent))


def call(name: str, *arguments: Tree) -> Tree:
    """An elementary function, written with sines, cosines, exponentials, logarithms, powers and ``atan2``; a slope."""
    return _MEANINGS[name](*arguments) if name in _MEANINGS else Tree(name, arguments)


#: Each is the same real number, and has a value and is smooth at the same places.
_MEANINGS: dict[str, Callable[..., Tree]] = {
    "tan": lambda u: call("sin", u) / call("cos", u), "sec": lambda u: call("cos", u) ** -1,
    "cot": lambda u: call("cos", u) / call("sin", u), "csc": lambda u: call("sin", u) ** -1,
    "sqrt": lambda u: power(u, HALF), "abs": lambda u: power(u**2, HALF), "atan": lambda u: call("atan2", u, ONE),
    "asin": lambda u: call("atan2", u, call("sqrt", ONE - u**2)),
    "acos": lambda u: call("atan2", call("sqrt", ONE - u**2), u),
    "sinh": lambda u: HALF * (call("exp", u) - call("exp", -u)),
    "cosh": lambda u: HALF * (call("exp", u) + call("exp", -u)), "tanh": lambda u: call("sinh", u) / call("cosh", u),
}  # fmt: skip


# Trees as functions of their symbols

Factor = TypeVar("Factor")


def repeated(unit: Factor, base: Factor, exponent: int, product: Callable[[Factor, Factor], Factor]) -> Factor:
    """A power by squaring."""
    product_so_far = unit
    for bit in bin(exponent)[2:]:
        product_so_far = product(product_so_far, product_so_far)
        product_so_far = product(product_so_far, base) if bit == "1" else product_so_far
    return product_so_far


Made = TypeVar("Made")
MAKERS: Mapping[str, Callable[..., Tree]] = {"sum": add, "product": times, "power": power}
#: A choice for a declared function: its arguments, and a text of them.
Choices = Mapping[str, tuple[tuple[str, ...], Tree]]


def folded(
    tree: Tree, compose: Callable[[Tree, tuple[Made, ...]], Made], plain: Callable[[Tree], Made | None] | None = None
) -> Made:
    """Return what is made of a tree, of each node once, from what was made of the nodes right below it.

    Below a node of which ``plain`` knows what is made of it nothing is looked at.
    """
    done: dict[int, Made] = {}

    def read(node: Tree) -> Made:
        if id(node) not in done:
            made_already = plain(node) if plain else None
            done[id(node)] = compose(node, tuple(map(read, node.below))) if made_already is None else made_already
        return done[id(node)]

    return read(tree)


def substituted(tree: Tree, values: Mapping[str, Tree], functions: Choices | None = None) -> Tree:
    """A tree with trees in the place of symbols, all at once, and texts in the place of declared functions."""

    def replaced(node: Tree, below: tuple[Tree, ...]) -> Tree:
        if node.head == "apply" and functions and node.value in functions:
            arguments, text = functions[str(node.value)]
            for argument, order in zip(arguments, node.orders, strict=True):
                for _ in range(order):
                    text = derivative(text, argument)
            return substituted(text, dict(zip(arguments, below, strict=True)))
        if below == node.below:
            return values.get(str(node.value), node) if node.head == "symbol" else node
        return MAKERS[node.head](*below) if node.head in MAKERS else Tree(node.head, below, node.value, node.orders)

    return folded(
        tree, replaced, lambda n: n if n.symbols.isdisjoint(values) and not (functions and n.applied) else None
    )


@lru_cache(maxsize=4096)
def derivative(tree: Tree, name: str) -> Tree:
    """Return the partial derivative by a symbol.

    Rules differentiate the same relations again and again: remembered, a certificate takes half of the time.
    """

    def by(node: Tree, inner: tuple[Tree, ...]) -> Tree:
        if not inner:
            return ONE
        return add(*(_partial(node, i) * part for i, part in enumerate(inner) if part != ZERO))

    return folded(tree, by, lambda node: None if name in node.symbols else ZERO)


_MEANINGS["diff"] = lambda function, by: derivative(function, str(by.value))


def _partial(node: Tree, place: int) -> Tree:
    """The derivative of a node by what stands at one place below it."""
    u, *_ = below = node.below
    if node.head == "product":
        return times(*below[:place], *below[place + 1 :])
    if node.head == "power":
        return node * call("log", u) if place else below[1] * power(u, below[1] + MINUS)
    if node.head == "apply":
        return replace(node, orders=tuple(k + (i == place) for i, k in enumerate(node.orders)))
    if node.head == "atan2":
        return (-u if place else below[1]) / add(*(v**2 for v in below))
    slopes = {"sum": ONE, "exp": node, "log": u**-1, "sin": call("cos", u), "cos": -call("sin", u)}
    return slopes[node.head]


_TOTAL = frozenset(("number", "pi", "symbol", "sum", "product", "exp", "sin", "cos", "apply"))


def keeps_values(node: Tree, poles: bool = False) -> bool:
    """Whether a node has a value, and is smooth, wherever all below it do and are; with ``poles``: but for those."""
    exponent = node.below[1].value if node.head == "power" else ""
    whole = isinstance(exponent, Fraction) and exponent.denominator == 1 and (poles or exponent > 0)
    return node.head in _TOTAL or whole


def is_partial(tree: Tree) -> bool:
    """Whether a tree may have no value somewhere: then 0 times it is not 0 there."""
    return not keeps_values(tree) or any(map(is_partial, tree.below))


def along(field: Mapping[str, Tree], tree: Tree) -> Tree:
    """The derivative of a tree along a field."""
    held = tree.symbols
    return add(*(value * derivative(tree, name) for name, value in field.items() if name in held))


def linear_in(tree: Tree, names: Collection[str]) -> tuple[dict[str, Tree], Tree] | None:
    """The slopes (not 0) and the rest of a tree that is linear in some symbols; None where it is not, as written."""
    used = sorted(tree.symbols.intersection(names))
    slopes = {name: derivative(tree, name) for name in used}
    if any(not slope.symbols.isdisjoint(used) for slope in slopes.values()):
        return None
    return {q: slope for q, slope in slopes.items() if slope != ZERO}, substituted(tree, dict.fromkeys(used, ZERO))


def put_in(tree: Tree, name: str, relation: Tree) -> tuple[Tree, Tree]:
    """The slope (or 0) of what is linear in a symbol, and a tree with the value of it at which that is 0."""
    slopes, remainder = linear_in(relation, [name]) or ({}, ZERO)
    slope = slopes.get(name, ZERO)
    return slope, substituted(tree, {name: -remainder / slope})


def homogeneous_degree(tree: Tree, names: Collection[str]) -> Fraction | None:
    """The degree in symbols in which every term of a tree is homogeneous; None where there is none."""

    def degree(node: Tree, below: tuple[Fraction | None, ...]) -> Fraction | None:
        """Return the degree of a node from those of its parts; None where terms differ in degree."""
        if not below:
            return Fraction(node.head == "symbol" and node.value in names)
        degrees, exponent = [degree_below for degree_below in below if degree_below is not None], node.below[-1].value
        if len(degrees) < len(below):
            return None
        if node.head == "power" and isinstance(exponent, Fraction):
            return degrees[0] * exponent
        if node.head == "product":
            return sum(degrees, Fraction(0))
        return degrees[0] if len(set(degrees)) == 1 and (node.head == "sum" or not degrees[0]) else None

    return folded(tree, degree)


def in_velocities(tree: Tree, coordinates: Collection[str]) -> Tree:
    """Return a relation divided by the power of ``dt`` in which it is homogeneous: dq becomes qdot dt.

    If it is linear in velocities, its terms without a velocity are multiplied by ``tdot``: it is a form.
    """
    degree = homogeneous_degree(tree, ["dt"])
    refuse(degree is None, "differentials and finite terms are added together")
    tree = substituted(tree, {"dt": ONE})
    rates = [f"{q}dot" for q in coordinates]
    linear = linear_in(tree, rates) or linear_in(_cleared(tree, rates), rates)
    if linear is None:
        return tree
    form = [slope * symbol(rate) for rate, slope in linear[0].items()]
    return add(*form, linear[1] * symbol("tdot")) if form or degree else linear[1]


def _cleared(tree: Tree, rates: Collection[str]) -> Tree:
    """A relation times the velocities that its terms are divided by, each once, so that dy/dx = f says dy = f dx."""
    terms = [operands(term, "product") for term in operands(tree, "sum")]
    inverses = {
        factor: factor.below[0]
        for factor in chain(*terms)
        if factor.head == "power" and factor.below[1] == MINUS and factor.symbols and factor.symbols.issubset(rates)
    }
    if any(term.count(inverse) > 1 for term in terms for inverse in inverses):
        return tree
    cleared = []
    for term in terms:
        others = [base for inverse, base in inverses.items() if inverse not in term]
        cleared.append(times(*(factor for factor in term if factor not in inverses), *others))
    return add(*cleared)


def operands(tree: Tree, head: str) -> list[Tree]:
    """The terms of a sum, or the factors of a product, those of the parts included."""
    return [operand for part in tree.below for operand in operands(part, head)] if tree.head == head else [tree]
