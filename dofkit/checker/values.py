"""Trees as functions of their symbols: substitution, derivatives, relations in velocities, points and values in balls.

Every operation on balls encloses the true one, where it is defined and smooth around.
"""

import operator
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import reduce
from typing import Any, TypeVar

from flint import arb, arb_mat, ctx, fmpq

from dofkit.checker.ring import repeated
from dofkit.checker.trees import MINUS, ONE, TWO, ZERO, Effort, Tree, add, call, negative, power, refuse, symbol, times

#: Bits of every ball.
PRECISION = 320
Made = TypeVar("Made")
MAKERS: Mapping[str, Callable[..., Tree]] = {"sum": add, "product": times, "power": power}
#: A choice for a declared function: its arguments, and a text of them.
Choices = Mapping[str, tuple[tuple[str, ...], Tree]]


def folded(tree: Tree, made: Callable[[Tree, tuple[Made, ...]], Made]) -> Made:
    """What is made of a tree, of each node once, from what was made of the nodes right below it."""
    done: dict[int, Made] = {}

    def read(node: Tree) -> Made:
        if id(node) not in done:
            done[id(node)] = made(node, tuple(map(read, node.below)))
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

    return folded(tree, replaced)


def derivative(tree: Tree, name: str) -> Tree:
    """The partial derivative by a symbol."""

    def by(node: Tree, inner: tuple[Tree, ...]) -> Tree:
        if not inner:
            return ONE if node.head == "symbol" and node.value == name else ZERO
        return add(*(times(_partial(node, i), part) for i, part in enumerate(inner) if part != ZERO))

    return folded(tree, by)


def _partial(node: Tree, place: int) -> Tree:
    """The derivative of a node by what stands at one place below it."""
    u, *others = below = node.below
    if node.head == "product":
        return times(*below[:place], *below[place + 1 :])
    if node.head == "power":
        return times(node, call("log", u)) if place else times(below[1], power(u, add(below[1], MINUS)))
    if node.head == "apply":
        return replace(node, orders=tuple(k + (i == place) for i, k in enumerate(node.orders)))
    if node.head == "atan2":
        size = add(power(u, TWO), *(power(v, TWO) for v in others))
        return times(MINUS if place else ONE, below[1 - place], power(size, MINUS))
    slopes = {"sum": ONE, "exp": node, "log": power(u, MINUS), "sin": call("cos", u), "cos": negative(call("sin", u))}
    return slopes[node.head]


def along(field: Mapping[str, Tree], tree: Tree) -> Tree:
    """The derivative of a tree along a field."""
    held = tree.symbols
    return add(*(times(value, derivative(tree, name)) for name, value in field.items() if name in held))


def linear_in(tree: Tree, names: Collection[str]) -> tuple[dict[str, Tree], Tree] | None:
    """The slopes (not 0) and the rest of a tree that is linear in some symbols; None where it is not, as written."""
    used = sorted(tree.symbols.intersection(names))
    slopes = {name: derivative(tree, name) for name in used}
    if any(not slope.symbols.isdisjoint(used) for slope in slopes.values()):
        return None
    return {q: slope for q, slope in slopes.items() if slope != ZERO}, substituted(tree, dict.fromkeys(used, ZERO))


def put_in(tree: Tree, name: str, given: Tree) -> tuple[Tree, Tree]:
    """The slope (or 0) of what is linear in a symbol, and a tree with the value of it at which that is 0."""
    slopes, rest = linear_in(given, [name]) or ({}, ZERO)
    slope = slopes.get(name, ZERO)
    return slope, substituted(tree, {name: times(MINUS, rest, power(slope, MINUS))})


def homogeneous_degree(tree: Tree, names: Collection[str]) -> Fraction | None:
    """The degree in symbols in which every term of a tree is homogeneous; None where there is none."""

    def degree(node: Tree, below: tuple[Fraction | None, ...]) -> Fraction | None:
        if not below:
            return Fraction(node.head == "symbol" and node.value in names)
        known, exponent = [one for one in below if one is not None], node.below[-1].value
        if len(known) < len(below):
            return None
        if node.head == "power" and isinstance(exponent, Fraction):
            return known[0] * exponent
        if node.head == "product":
            return sum(known, Fraction(0))
        return known[0] if len(set(known)) == 1 and (node.head == "sum" or not known[0]) else None

    return folded(tree, degree)


def in_velocities(tree: Tree, coordinates: Collection[str]) -> Tree:
    """A relation in velocities, without ``dt``: over the power of it in which the relation is homogeneous.

    What is linear in velocities becomes a form, its terms without one times ``tdot``.
    """
    degree = homogeneous_degree(tree, ["dt"])
    refuse(degree is None, "differentials and finite terms are added together")
    tree = substituted(tree, {"dt": ONE})
    parts = linear_in(tree, [f"{q}dot" for q in coordinates])
    if parts is None:
        return tree
    form = [times(slope, symbol(rate)) for rate, slope in parts[0].items()]
    return add(*form, times(parts[1], symbol("tdot"))) if form or degree else parts[1]


def not_zero(ball: Any) -> bool:
    """Whether 0 is certainly not in a ball."""
    return bool(ball.is_finite() and (ball > 0 or ball < 0))


def evaluated(tree: Tree, values: Mapping[str, Any], effort: Effort) -> Any:
    """The ball of a tree, where every part of it, as written, has a value and is smooth around; else `CheckError`."""

    def value(node: Tree, below: tuple[Any, ...]) -> Any:
        effort.spend(1)
        found = _value(node, values, below)
        refuse(not found.is_finite(), "a value is not finite at the point")
        return found

    with ctx.workprec(PRECISION):
        return folded(tree, value)


def _value(node: Tree, values: Mapping[str, Any], below: tuple[Any, ...]) -> Any:
    head = node.head
    if isinstance(node.value, Fraction):
        return arb(fmpq(node.value.numerator, node.value.denominator))
    if head == "symbol":
        refuse(node.value not in values, f"`{node.value}` has no value at the point")
        return values[str(node.value)]
    if head == "pi":
        return arb.pi()
    if head in ("sum", "product"):
        return reduce(operator.add if head == "sum" else operator.mul, below)
    u, other = below[0], below[-1]
    if head in ("sin", "cos", "exp") or (head == "log" and u > 0):
        return getattr(u, head)()
    if head == "atan2" and (other > 0 or not_zero(u)):
        return arb.atan2(u, other)
    # a power: of what is positive; a whole one, of what is not 0 where it is negative; a constant root of 0
    exponent = node.below[1].value if head == "power" else Fraction(1, 2)
    if isinstance(exponent, Fraction) and exponent.denominator == 1 and (exponent > 0 or not_zero(u)):
        found = repeated(arb(1), u, abs(int(exponent)), operator.mul)
        return found if exponent > 0 else 1 / found
    zero = u == 0 and other > 0 and not node.symbols
    refuse(head != "power" or not (u > 0 or zero), f"a {head} has no smooth value at the point, or may have none")
    return u if zero else u**other


@dataclass
class CheckedPoint:
    """A point that was checked: ``exact`` values, ``functions`` chosen, and ``balls`` for all symbols.

    The relations ``rows`` hold at it by interval Newton.
    """

    name: str
    exact: dict[str, Tree]
    functions: Choices
    effort: Effort
    balls: dict[str, Any] = field(default_factory=dict)
    rows: frozenset[str] = frozenset()
    memory: dict[int, tuple[Tree, Any]] = field(default_factory=dict)

    def prepared(self, tree: Tree) -> Tree:
        """A tree with the exact values and the chosen functions put in; velocities are by ``t``."""
        return substituted(substituted(tree, {}, self.functions), {"tdot": ONE, **self.exact})

    def value(self, tree: Tree) -> Any:
        """The ball of a tree at the point, every part of which has a value."""
        if id(tree) not in self.memory:
            self.memory[id(tree)] = (tree, self.value_with(tree, {}))
        return self.memory[id(tree)][1]

    def value_with(self, tree: Tree, others: Mapping[str, Any]) -> Any:
        """The ball of a tree at the point, with other balls for some symbols."""
        chosen = substituted(tree, {}, self.functions) if tree.applied else tree
        return evaluated(chosen, {"tdot": arb(1), **self.balls, **others}, self.effort)

    def is_regular(self, matrix: Sequence[Sequence[Tree]]) -> None:
        """`CheckError` unless a square matrix is regular at the point."""
        self.effort.spend(len(matrix) ** 3 // 10 + 1)
        rows = [[self.value(tree) for tree in row] for row in matrix]
        with ctx.workprec(PRECISION):
            refuse(rows and not not_zero(arb_mat(rows).det()), "the minor may be 0")

    def settle(self, equations: Sequence[Tree], columns: Sequence[str], radius: Any) -> None:
        """The balls of columns become those of the only zero of as many equations in a box around them.

        Where all matrices in F'(X) are regular and y - F'(X)^-1 F(y) lies inside X, F has exactly one zero in X, and it
        lies there (Moore 1966, Nickel 1971).
        """
        refuse(not radius > 0, "the radius of a box is positive")
        with ctx.workprec(PRECISION):
            middle = {name: self.balls[name].mid() for name in columns}
            box = {name: ball + arb(0, radius.mid()) for name, ball in middle.items()}
            smooth = all(self.value_with(equation, box).is_finite() for equation in equations)
            slopes = [[self.value_with(derivative(equation, name), box) for name in columns] for equation in equations]
            values = arb_mat([[self.value_with(equation, middle)] for equation in equations])
            steps = arb_mat(slopes).solve(values, nonstop=True, algorithm="precond")
            for i, name in enumerate(columns):
                self.balls[name] = middle[name] - steps[i, 0]
                inside = smooth and box[name].contains_interior(self.balls[name])
                refuse(not inside, f"interval Newton does not certify a zero: `{name}` leaves its box")
