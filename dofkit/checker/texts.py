"""Texts of a certificate: what they say, their signs, and why an expression is nowhere 0."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from dofkit.checker.balls import evaluated, excludes_zero
from dofkit.checker.derivatives import substituted, symbols_in
from dofkit.checker.effort import Effort
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.grammar import parse
from dofkit.checker.problem import Problem
from dofkit.checker.ring import CheckedRing
from dofkit.checker.trees import Tree, add, call, negative, symbol, times
from dofkit.checker.words import KnownNames

LONGEST_TEXT = 40_000


class CheckedTexts:
    """The texts that a certificate may write about a problem."""

    def __init__(self, problem: Problem, effort: Effort) -> None:
        self.problem, self.effort = problem, effort
        self.ring = CheckedRing(effort)
        self.variables: tuple[str, ...] = (*problem.coordinates, "t")
        self.velocities = frozenset(name + "dot" for name in self.variables)
        plain = [*problem.parameters, *problem.generic]
        values = {name: symbol(name) for name in dict.fromkeys([*plain, "tdot"])}
        functions = {name: tuple(f"a{i}" for i in range(k)) for name, k in problem.functions.items()}
        self.names = KnownNames(frozenset(problem.coordinates), values, functions)
        forms = {f"d{name}": symbol(name + "dot") for name in self.variables}
        self.forms = {name: tree for name, tree in forms.items() if name not in {*problem.coordinates, *plain}}
        self._texts: dict[str, Tree] = {}

    def text(self, text: Any, extra: Iterable[str] = ()) -> Tree:
        """The tree of a text; ``extra`` are further names it may mention."""
        if not isinstance(text, str) or len(text) > LONGEST_TEXT:
            raise CheckError("an expression is a text of moderate length")
        more = tuple(extra)
        if not more and text in self._texts:
            return self._texts[text]
        names = self.names
        if more:
            added = {name: symbol(name) for name in more}
            names = KnownNames(names.coordinates, {**names.values, **added}, names.functions)
        self.effort.spend(10 * len(text) + 1)
        found = substituted(parse(text, names), self.forms)
        if not more:
            self._texts[text] = found
        return found

    def identity(self, tree: Tree, what: str) -> None:
        """`CheckError` unless a tree is 0 in the ring."""
        refuse(not self.ring.vanishes(tree), f"{what}: the two sides are not the same")

    def number_sign(self, text: Any) -> int:
        """The sign of a text of numbers that is not 0."""
        ball = evaluated(self.text(text), {}, self.effort)
        refuse(not excludes_zero(ball), f"`{str(text)[:60]}` is not shown to be positive or negative")
        return 1 if ball > 0 else -1

    def not_negative(self, text: Any) -> bool:
        """Whether a text of numbers is 0 or more."""
        return self.ring.rational(self.text(text)) == 0 or self.number_sign(text) > 0

    def squares(self, terms: Any) -> Tree:
        """A sum of squares with coefficients that are not negative."""
        refuse(any(not self.not_negative(c) for c, _ in terms), "a coefficient of a sum of squares is negative")
        return add(*(times(self.text(c), self.text(a), self.text(a)) for c, a in terms))

    def is_open(self, tree: Tree) -> bool:
        """Whether parameters, generic lengths or unknown functions occur, for which a point chooses values.

        A claim is about almost all of them: what holds for the chosen ones has to hold for those near them.
        """
        chosen = {*self.problem.parameters, *self.problem.generic}
        return not chosen.isdisjoint(symbols_in(tree)) or "apply" in heads_in(tree)

    def has_velocities(self, tree: Tree) -> bool:
        """Whether a velocity occurs."""
        return not self.velocities.isdisjoint(symbols_in(tree))

    def reason(self, why: Any, tree: Tree) -> bool:
        """Whether ``why`` shows that a tree is nowhere 0; False where no reason is given."""
        if why is None:
            return False
        if "sos" in why:
            refuse(self.number_sign(why["plus"]) < 0, "what is added to the squares is not positive")
            total = add(self.squares(why["sos"]), self.text(why["plus"]))
            if not self.ring.vanishes(add(tree, negative(total))):
                self.identity(add(tree, total), "the sum of squares that is nowhere 0")
        elif "parameters" in why:
            product = self.text(why["parameters"])
            self.identity(add(tree, negative(product)), "the product of parameters")
            refuse(not self.is_nonzero_product(product), "not a product of parameters that are not 0")
        elif "exp" in why:
            self.identity(add(tree, negative(call("exp", self.text(why["exp"])))), "the exponential")
        elif not excludes_zero(evaluated(tree, {}, self.effort)):
            raise CheckError("a number may be 0")
        return True

    def is_nonzero_product(self, tree: Tree) -> bool:
        """Whether a tree is a product of powers of numbers and of parameters that are not 0."""
        if tree.head == "product":
            return all(self.is_nonzero_product(part) for part in tree.below)
        if tree.head == "power":
            return self.is_nonzero_product(tree.below[0]) and not symbols_in(tree.below[1])
        if tree.head == "symbol":
            return self.problem.parameters.get(str(tree.value)) in ("positive", "nonzero")
        return not symbols_in(tree) and excludes_zero(evaluated(tree, {}, self.effort))


def has_value_everywhere(tree: Tree) -> bool:
    """Whether a tree is smooth (analytic, but for declared functions) at all real values of its symbols."""
    if not symbols_in(tree):
        return True
    if tree.head == "power":
        exponent = tree.below[1].value
        return isinstance(exponent, Fraction) and exponent.denominator == 1 and exponent > 0 and _parts_have(tree)
    plain = ("symbol", "sum", "product", "sin", "cos", "exp", "sinh", "cosh", "tanh", "atan", "apply")
    return tree.head in plain and _parts_have(tree)


def _parts_have(tree: Tree) -> bool:
    return all(has_value_everywhere(part) for part in tree.below)


def nodes_of(tree: Tree) -> dict[int, Tree]:
    """All nodes of a tree, each once."""
    found, stack = {}, [tree]
    while stack:
        node = stack.pop()
        if id(node) not in found:
            found[id(node)] = node
            stack += node.below
    return found


def heads_in(tree: Tree) -> set[str]:
    """The kinds of nodes that occur in a tree."""
    return {node.head for node in nodes_of(tree).values()}


def size_of(tree: Tree) -> int:
    """The number of nodes, each counted once."""
    return len(nodes_of(tree))
