"""Trees as functions of their symbols: substitution, derivatives, and degrees in velocities."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from fractions import Fraction

from dofkit.checker.errors import CheckError
from dofkit.checker.trees import ONE, ZERO, Tree, add, call, negative, number, power, times

#: A tree with more nodes than this is not worked on.
LARGEST = 200_000


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
    one_over_root = power(call("sqrt", add(ONE, negative(power(u, number(2))))), number(-1))
    slopes = {
        "sin": lambda: call("cos", u),
        "cos": lambda: negative(call("sin", u)),
        "tan": lambda: power(call("cos", u), number(-2)),
        "cot": lambda: negative(power(call("sin", u), number(-2))),
        "sec": lambda: times(node, call("tan", u)),
        "csc": lambda: negative(times(node, call("cot", u))),
        "asin": lambda: one_over_root,
        "acos": lambda: negative(one_over_root),
        "atan": lambda: power(add(ONE, power(u, number(2))), number(-1)),
        "sinh": lambda: call("cosh", u),
        "cosh": lambda: call("sinh", u),
        "tanh": lambda: power(call("cosh", u), number(-2)),
        "exp": lambda: node,
        "log": lambda: power(u, number(-1)),
        "sqrt": lambda: times(number(Fraction(1, 2)), power(node, number(-1))),
        "abs": lambda: times(u, power(node, number(-1))),
    }
    if node.head not in slopes:
        raise CheckError(f"`{node.head}` has no derivative here")
    return slopes[node.head]()


def degree_parts(tree: Tree, names: Collection[str]) -> dict[int, Tree] | None:
    """A polynomial in symbols by its degrees in them; None where it is none as written."""
    if not tree.below or symbols_in(tree).isdisjoint(names):
        return {1 if tree.head == "symbol" and tree.value in names else 0: tree}
    if tree.head == "sum":
        return _added([degree_parts(part, names) for part in tree.below])
    if tree.head == "product":
        found: dict[int, Tree] | None = {0: ONE}
        for part in tree.below:
            found = _multiplied(found, degree_parts(part, names))
        return found
    if tree.head == "power" and isinstance(tree.below[1].value, Fraction):
        exponent, base = tree.below[1].value, degree_parts(tree.below[0], names)
        if exponent.denominator == 1 and 0 < exponent <= 8:
            found = {0: ONE}
            for _ in range(int(exponent)):
                found = _multiplied(found, base)
            return found
    return None


def _added(parts: list[dict[int, Tree] | None]) -> dict[int, Tree] | None:
    found: dict[int, list[Tree]] = {}
    for part in parts:
        if part is None:
            return None
        for degree, term in part.items():
            found.setdefault(degree, []).append(term)
    return {degree: add(*terms) for degree, terms in found.items()}


def _multiplied(first: dict[int, Tree] | None, second: dict[int, Tree] | None) -> dict[int, Tree] | None:
    if first is None or second is None:
        return None
    return _added([{i + j: times(a, b)} for i, a in first.items() for j, b in second.items()])


def homogeneous_degree(tree: Tree, names: Collection[str]) -> Fraction | None:
    """The degree in symbols in which every term of a tree is homogeneous; None where there is none."""
    if not tree.below or symbols_in(tree).isdisjoint(names):
        return Fraction(tree.head == "symbol" and tree.value in names)
    below = [homogeneous_degree(part, names) for part in tree.below]
    if None in below:
        return None
    degrees = [degree for degree in below if degree is not None]
    if tree.head == "sum":
        return degrees[0] if len(set(degrees)) == 1 else None
    if tree.head == "product":
        return sum(degrees, Fraction(0))
    if tree.head == "power" and isinstance(tree.below[1].value, Fraction):
        return degrees[0] * tree.below[1].value
    if tree.head == "sqrt":
        return degrees[0] / 2
    return degrees[0] if tree.head == "abs" else Fraction(0) if not any(degrees) else None
