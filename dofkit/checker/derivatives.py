"""Trees as functions of their symbols: substitution, derivatives, and relations in velocities."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TypeVar

from dofkit.checker.trees import ONE, TWO, ZERO, Tree, add, call, negative, number, power, refuse, symbol, times

TIME_RATE, MINUS = "tdot", number(-1)
Made = TypeVar("Made")
#: A choice for a declared function: its arguments, and a text of them.
Choices = Mapping[str, tuple[tuple[str, ...], Tree]]


def nodes_of(tree: Tree) -> Iterator[Tree]:
    """All nodes of a tree, each once."""
    stack, seen = [tree], set()
    while stack:
        node = stack.pop()
        if id(node) not in seen:
            seen.add(id(node))
            stack += node.below
            yield node


def symbols_in(tree: Tree) -> frozenset[str]:
    """The names of the symbols of a tree."""
    return frozenset(str(node.value) for node in nodes_of(tree) if node.head == "symbol")


def heads_in(tree: Tree) -> set[str]:
    """The kinds of nodes that occur in a tree."""
    return {node.head for node in nodes_of(tree)}


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

    def put_in(node: Tree, below: tuple[Tree, ...]) -> Tree:
        if node.head == "apply" and functions and node.value in functions:
            arguments, text = functions[str(node.value)]
            return substituted(slope_of(text, arguments, node.orders), dict(zip(arguments, below, strict=True)))
        if below == node.below:
            return values.get(str(node.value), node) if node.head == "symbol" else node
        makers: dict[str, Callable[..., Tree]] = {"sum": add, "product": times, "power": power}
        return makers[node.head](*below) if node.head in makers else Tree(node.head, below, node.value, node.orders)

    return folded(tree, put_in)


def slope_of(text: Tree, arguments: Sequence[str], orders: Sequence[int]) -> Tree:
    """A text differentiated so often by each of its arguments."""
    for argument, order in zip(arguments, orders, strict=True):
        for _ in range(order):
            text = derivative(text, argument)
    return text


def derivative(tree: Tree, name: str) -> Tree:
    """The partial derivative by a symbol."""

    def by(node: Tree, inner: tuple[Tree, ...]) -> Tree:
        if not inner:
            return ONE if node.head == "symbol" and node.value == name else ZERO
        return add(*(times(_partial(node, i), part) for i, part in enumerate(inner) if part != ZERO))

    return folded(tree, by)


def _partial(node: Tree, place: int) -> Tree:
    """The derivative of a node by what stands at one place below it."""
    below, head = node.below, node.head
    if head == "product":
        return times(*below[:place], *below[place + 1 :])
    if head == "power":
        falling = times(below[1], power(below[0], add(below[1], MINUS)))
        return times(node, call("log", below[0])) if place else falling
    if head == "apply":
        return Tree(head, below, node.value, tuple(k + (i == place) for i, k in enumerate(node.orders)))
    if head == "atan2":
        size = add(power(below[0], TWO), power(below[1], TWO))
        return times(MINUS if place else ONE, below[1 - place], power(size, MINUS))
    slopes = {"sum": ONE, "exp": node, "log": power(below[0], MINUS)}
    slopes |= {"sin": call("cos", below[0]), "cos": negative(call("sin", below[0]))}
    return slopes[head]


def along(field: Mapping[str, Tree], tree: Tree) -> Tree:
    """The derivative of a tree along a field."""
    held = symbols_in(tree)
    return add(*(times(value, derivative(tree, name)) for name, value in field.items() if name in held))


def linear_parts(tree: Tree, names: Collection[str]) -> tuple[dict[str, Tree], Tree] | None:
    """The slopes (not 0) and the rest of a tree that is linear in some symbols; None where it is not, as written."""
    used = sorted(symbols_in(tree).intersection(names))
    slopes = {name: derivative(tree, name) for name in used}
    if any(not symbols_in(slope).isdisjoint(used) for slope in slopes.values()):
        return None
    return {q: slope for q, slope in slopes.items() if slope != ZERO}, substituted(tree, dict.fromkeys(used, ZERO))


def homogeneous_degree(tree: Tree, names: Collection[str]) -> Fraction | None:
    """The degree in symbols in which every term of a tree is homogeneous; None where there is none."""

    def of(node: Tree, below: tuple[Fraction | None, ...]) -> Fraction | None:
        if not below:
            return Fraction(node.head == "symbol" and node.value in names)
        known, exponent = [degree for degree in below if degree is not None], node.below[-1].value
        if len(known) < len(below):
            return None
        if node.head == "power" and isinstance(exponent, Fraction):
            return known[0] * exponent
        if node.head == "product":
            return sum(known, Fraction(0))
        return known[0] if len(set(known)) == 1 and (node.head == "sum" or not known[0]) else None

    return folded(tree, of)


def _differentials(tree: Tree, coordinates: Collection[str]) -> dict[str, Tree]:
    """The differentials in a tree, and what they are over dt."""
    found = {name for name in symbols_in(tree) if name == "dt" or (name[0] == "d" and name[1:] in coordinates)}
    return {name: ONE if name == "dt" else symbol(f"{name[1:]}dot") for name in found}


def over_time(tree: Tree, coordinates: Collection[str]) -> Tree:
    """A tree over dt: ``dx/dt`` is the velocity."""
    moved = _differentials(tree, coordinates)
    linear = homogeneous_degree(tree, moved) == 1
    return substituted(tree, moved) if linear else times(tree, power(symbol("dt"), MINUS))


def in_velocities(tree: Tree, coordinates: Collection[str]) -> Tree:
    """A relation with velocities in the place of differentials: over the power of dt in which it is homogeneous.

    What is linear in velocities becomes a form, its terms without one times ``tdot``.
    """
    moved = _differentials(tree, coordinates)
    refuse(moved and homogeneous_degree(tree, moved) is None, "differentials and finite terms are added together")
    tree = substituted(tree, moved)
    parts = linear_parts(tree, [f"{q}dot" for q in coordinates])
    if parts is None:
        return tree
    form = [times(slope, symbol(rate)) for rate, slope in parts[0].items()]
    return add(*form, times(parts[1], symbol(TIME_RATE))) if form or moved else parts[1]
