"""Trees as functions of their symbols: substitution, derivatives, and degrees in velocities."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from fractions import Fraction

from dofkit.checker.errors import CheckError
from dofkit.checker.trees import ONE, ZERO, Tree, add, call, negative, number, power, symbol, times


def symbols_in(tree: Tree) -> frozenset[str]:
    """The names of the symbols of a tree."""
    found: set[str] = set()
    stack, seen = [tree], set()
    while stack:
        node = stack.pop()
        if id(node) in seen:
            continue
        seen.add(id(node))
        if node.head == "symbol":
            found.add(str(node.value))
        stack.extend(node.below)
    return frozenset(found)


def substituted(tree: Tree, values: Mapping[str, Tree]) -> Tree:
    """A tree with trees in the place of symbols, all at once."""
    done: dict[int, Tree] = {}

    def read(node: Tree) -> Tree:
        if not node.below:
            return values.get(str(node.value), node) if node.head == "symbol" else node
        if id(node) not in done:
            done[id(node)] = rebuilt(node, tuple(read(part) for part in node.below))
        return done[id(node)]

    return read(tree)


def rebuilt(node: Tree, below: tuple[Tree, ...]) -> Tree:
    """The node with other parts below it."""
    if below == node.below:
        return node
    if node.head == "sum":
        return add(*below)
    if node.head == "product":
        return times(*below)
    return power(*below) if node.head == "power" else Tree(node.head, below, node.value, node.orders)


def derivative(tree: Tree, name: str) -> Tree:
    """The partial derivative by a symbol."""
    done: dict[int, Tree] = {}

    def by(node: Tree) -> Tree:
        if not node.below:
            return ONE if node.head == "symbol" and node.value == name else ZERO
        if id(node) not in done:
            inner = [by(part) for part in node.below]
            done[id(node)] = ZERO if all(part == ZERO for part in inner) else _chain(node, inner)
        return done[id(node)]

    return by(tree)


def _chain(node: Tree, inner: list[Tree]) -> Tree:
    """The chain rule at one node, whose parts have the derivatives ``inner``."""
    below = node.below
    if node.head == "sum":
        return add(*inner)
    if node.head == "product":
        return add(*(times(*below[:i], inner[i], *below[i + 1 :]) for i in range(len(below)) if inner[i] != ZERO))
    if node.head == "power" and inner[1] == ZERO:
        return times(below[1], power(below[0], add(below[1], number(-1))), inner[0])
    if node.head == "power":
        logarithmic = add(
            times(inner[1], call("log", below[0])), times(below[1], inner[0], power(below[0], number(-1)))
        )
        return times(node, logarithmic)
    if node.head == "apply":
        orders = [tuple(k + (i == j) for j, k in enumerate(node.orders)) for i in range(len(below))]
        return add(*(times(Tree("apply", below, node.value, orders[i]), inner[i]) for i in range(len(below))))
    if node.head == "atan2":
        (y, x), (dy, dx) = below, inner
        under = power(add(power(x, number(2)), power(y, number(2))), number(-1))
        return times(add(times(x, dy), negative(times(y, dx))), under)
    return times(_slope(node, below[0]), inner[0])


def _slope(node: Tree, u: Tree) -> Tree:
    """The derivative of an elementary function of one argument."""
    if node.head not in _SLOPES:
        raise CheckError(f"`{node.head}` has no derivative here")
    return substituted(_SLOPES[node.head], {"u": u})


_U = symbol("u")
_INVERSE_ROOT = power(call("sqrt", add(ONE, negative(power(_U, number(2))))), number(-1))
_SLOPES = {
    "sin": call("cos", _U), "cos": negative(call("sin", _U)), "tan": power(call("cos", _U), number(-2)),
    "cot": negative(power(call("sin", _U), number(-2))), "sec": times(call("sec", _U), call("tan", _U)),
    "csc": times(number(-1), call("csc", _U), call("cot", _U)), "asin": _INVERSE_ROOT, "acos": negative(_INVERSE_ROOT),
    "atan": power(add(ONE, power(_U, number(2))), number(-1)), "sinh": call("cosh", _U), "cosh": call("sinh", _U),
    "tanh": power(call("cosh", _U), number(-2)), "exp": call("exp", _U), "log": power(_U, number(-1)),
    "sqrt": times(number(Fraction(1, 2)), power(call("sqrt", _U), number(-1))),
    "abs": times(_U, power(call("abs", _U), number(-1))),
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
    if symbols_in(tree).isdisjoint(names):
        return Fraction(0)
    degrees = [homogeneous_degree(part, names) for part in tree.below]
    known = [degree for degree in degrees if degree is not None]
    if not degrees or len(known) < len(degrees):
        return None if degrees else Fraction(1)
    if tree.head == "product":
        return sum(known, Fraction(0))
    if tree.head == "power" and isinstance(tree.below[1].value, Fraction):
        return known[0] * tree.below[1].value
    if tree.head == "sqrt":
        return known[0] / 2
    return known[0] if len(set(known)) == 1 and (tree.head == "sum" or known[0] == 0) else None
