"""Trees as functions of their symbols: substitution, derivatives, and relations in velocities."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from fractions import Fraction
from typing import TypeVar

from dofkit.checker.trees import ONE, ZERO, Tree, add, call, difference, negative, number, power, refuse, symbol, times

TIME_RATE = "tdot"
TWO = number(2)
Made = TypeVar("Made")


def symbols_in(tree: Tree) -> frozenset[str]:
    """The names of the symbols of a tree."""
    found: set[str] = set()
    stack, seen = [tree], set()
    while stack:
        node = stack.pop()
        if id(node) not in seen:
            seen.add(id(node))
            stack.extend(node.below)
            if node.head == "symbol":
                found.add(str(node.value))
    return frozenset(found)


def folded(tree: Tree, made: Callable[[Tree, tuple[Made, ...]], Made]) -> Made:
    """What is made of a tree, of each node once, from what was made of the nodes right below it."""
    done: dict[int, Made] = {}

    def read(node: Tree) -> Made:
        if id(node) not in done:
            done[id(node)] = made(node, tuple(map(read, node.below)))
        return done[id(node)]

    return read(tree)


def substituted(tree: Tree, values: Mapping[str, Tree]) -> Tree:
    """A tree with trees in the place of symbols, all at once."""

    def put_in(node: Tree, below: tuple[Tree, ...]) -> Tree:
        if below:
            return rebuilt(node, below)
        return values.get(str(node.value), node) if node.head == "symbol" else node

    return folded(tree, put_in)


def rebuilt(node: Tree, below: tuple[Tree, ...]) -> Tree:
    """The node with other parts below it."""
    if below == node.below:
        return node
    makers: dict[str, Callable[..., Tree]] = {"sum": add, "product": times, "power": power}
    return makers[node.head](*below) if node.head in makers else Tree(node.head, below, node.value, node.orders)


def derivative(tree: Tree, name: str) -> Tree:
    """The partial derivative by a symbol."""

    def by(node: Tree, inner: tuple[Tree, ...]) -> Tree:
        if not inner:
            return ONE if node.head == "symbol" and node.value == name else ZERO
        return ZERO if all(part == ZERO for part in inner) else _chain(node, inner)

    return folded(tree, by)


def _chain(node: Tree, inner: tuple[Tree, ...]) -> Tree:
    """The chain rule at one node, whose parts have the derivatives ``inner``."""
    below = node.below
    if node.head == "sum":
        return add(*inner)
    if node.head == "product":
        return add(*(times(*below[:i], part, *below[i + 1 :]) for i, part in enumerate(inner) if part != ZERO))
    if node.head == "power":
        (base, exponent), (slope, growth) = below, inner
        falling = times(exponent, power(base, add(exponent, number(-1))), slope)
        return falling if growth == ZERO else add(falling, times(node, call("log", base), growth))
    if node.head == "apply":
        orders = [tuple(k + (i == j) for j, k in enumerate(node.orders)) for i in range(len(below))]
        return add(*(times(Tree("apply", below, node.value, k), part) for k, part in zip(orders, inner, strict=True)))
    if node.head == "atan2":
        (y, x), (dy, dx) = below, inner
        return times(difference(times(x, dy), times(y, dx)), power(add(power(x, TWO), power(y, TWO)), number(-1)))
    refuse(node.head not in _SLOPES, f"`{node.head}` has no derivative here")
    return times(substituted(_SLOPES[node.head], {"u": below[0]}), inner[0])


def _of(name: str, exponent: int = 1) -> Tree:
    return power(call(name, _U), number(exponent))


_U = symbol("u")
_ROOT = power(call("sqrt", difference(ONE, power(_U, TWO))), number(-1))
_SLOPES = {
    "sin": _of("cos"), "cos": negative(_of("sin")), "tan": _of("cos", -2), "cot": negative(_of("sin", -2)),
    "sec": times(_of("sec"), _of("tan")), "csc": times(number(-1), _of("csc"), _of("cot")), "sinh": _of("cosh"),
    "cosh": _of("sinh"), "tanh": _of("cosh", -2), "asin": _ROOT, "acos": negative(_ROOT), "exp": _of("exp"),
    "atan": power(add(ONE, power(_U, TWO)), number(-1)), "log": power(_U, number(-1)),
    "sqrt": times(number(Fraction(1, 2)), _of("sqrt", -1)), "abs": times(_U, _of("abs", -1)),
}  # fmt: skip


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
        known = [degree for degree in below if degree is not None]
        if not below or len(known) < len(below):
            return None if below else Fraction(node.head == "symbol" and node.value in names)
        exponent = Fraction(1, 2) if node.head == "sqrt" else node.below[-1].value
        if node.head in ("power", "sqrt") and isinstance(exponent, Fraction):
            return known[0] * exponent
        if node.head == "product":
            return sum(known, Fraction(0))
        return known[0] if len(set(known)) == 1 and (node.head == "sum" or not known[0]) else None

    return folded(tree, of)


def differentials(tree: Tree, coordinates: Collection[str]) -> dict[str, Tree]:
    """The differentials in a tree, and the velocities that belong to them."""
    found = {name for name in symbols_in(tree) if name == "dt" or (name[0] == "d" and name[1:] in coordinates)}
    return {name: symbol(f"{name[1:]}dot") for name in found}


def over_time(tree: Tree, coordinates: Collection[str]) -> Tree:
    """A tree over dt: ``dx/dt`` is the velocity."""
    moved = differentials(tree, coordinates)
    if homogeneous_degree(tree, moved) == 1:
        return substituted(tree, {**moved, "dt": ONE})
    return times(tree, power(symbol("dt"), number(-1)))


def in_velocities(tree: Tree, coordinates: Collection[str]) -> Tree:
    """A relation with velocities in the place of differentials.

    What is linear in velocities becomes a form, its terms without one times ``tdot``. Other relations that are
    homogeneous in differentials are divided by a power of dt.
    """
    moved = differentials(tree, coordinates)
    if moved:
        refuse(homogeneous_degree(tree, moved) is None, "differentials and finite terms are added together")
        tree = substituted(tree, moved)
    rates = [
        name for name in symbols_in(tree) if name == TIME_RATE or (name[-3:] == "dot" and name[:-3] in coordinates)
    ]
    parts = linear_parts(tree, rates)
    if moved and (parts is None or parts[1] != ZERO):
        tree = substituted(tree, {TIME_RATE: ONE})
        parts = linear_parts(tree, rates)
    if parts is None or parts[1] == ZERO:
        return tree
    slopes, rest = parts
    form = [times(slope, symbol(rate)) for rate, slope in slopes.items()]
    return add(*form, times(rest, symbol(TIME_RATE))) if slopes else rest
