"""Texts of a certificate: what they say, their signs, and why an expression is nowhere 0."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from dofkit.checker.balls import evaluated, excludes_zero
from dofkit.checker.derivatives import substituted, symbols_in
from dofkit.checker.grammar import KnownNames, parse
from dofkit.checker.problem import Problem
from dofkit.checker.ring import CheckedRing
from dofkit.checker.trees import Effort, Tree, add, negative, power, refuse, symbol, times
from dofkit.checker.trees import number as numeral

LONGEST_TEXT = 40_000
_PLAIN = frozenset(("symbol", "sum", "product", "sin", "cos", "exp", "sinh", "cosh", "tanh", "atan", "apply"))


class CheckedTexts:
    """The texts that a certificate may write about a problem."""

    def __init__(self, problem: Problem, effort: Effort) -> None:
        self.problem, self.effort, self.ring = problem, effort, CheckedRing(effort)
        self.variables: tuple[str, ...] = (*problem.coordinates, "t")
        self.velocities = frozenset(name + "dot" for name in self.variables)
        self.chosen = frozenset((*problem.parameters, *problem.generic))
        self.functions = {name: tuple(f"a{i}" for i in range(k)) for name, k in problem.functions.items()}
        taken = self.chosen.union(problem.coordinates)
        self.forms = {f"d{q}": symbol(f"{q}dot") for q in self.variables if f"d{q}" not in taken}
        self.texts: dict[Any, Tree] = {}

    def text(self, text: Any, extra: Iterable[str] = ()) -> Tree:
        """The tree of a text; ``extra`` are further names it may mention."""
        key = (text, tuple(extra))
        if key not in self.texts:
            refuse(not isinstance(text, str) or len(text) > LONGEST_TEXT, "an expression is a text of moderate length")
            self.effort.spend(10 * len(text) + 1)
            values = {name: symbol(name) for name in (*sorted(self.chosen), "tdot", *key[1])}
            names = KnownNames(frozenset(self.problem.coordinates), values, self.functions)
            self.texts[key] = substituted(parse(text, names), self.forms)
        return self.texts[key]

    def identity(self, left: Tree, right: Tree, what: str) -> None:
        """`CheckError` unless two trees are the same in the ring."""
        refuse(not self.same(left, right), f"{what}: the two sides are not the same")

    def same(self, left: Tree, right: Tree) -> bool:
        """Whether two trees are the same in the ring."""
        return self.ring.vanishes(add(left, negative(right)))

    def squares(self, terms: Any) -> Tree:
        """A sum of squares, which have a value everywhere, with positive coefficients."""
        pairs = [(self.text(c), self.text(a)) for c, a in terms]
        refuse(not all(self.is_nowhere_zero(c, True) for c, _ in pairs), "a coefficient of a square is not positive")
        refuse(not all(self.has_value_everywhere(a) for _, a in pairs), "a square has no value everywhere")
        return add(*(times(c, power(a, numeral(2))) for c, a in pairs))

    def is_open(self, tree: Tree) -> bool:
        """Whether parameters, generic lengths or unknown functions occur, for which a point chooses values.

        A claim is about almost all of them: what holds for the chosen ones has to hold for those near them.
        """
        return not self.chosen.isdisjoint(symbols_in(tree)) or "apply" in heads_in(tree)

    def has_velocities(self, tree: Tree) -> bool:
        """Whether a velocity occurs."""
        return not self.velocities.isdisjoint(symbols_in(tree))

    def is_nowhere_zero(self, tree: Tree, positive: bool = False) -> bool:
        """Whether a tree is a product of powers of numbers and parameters that are not 0, or are positive."""
        if not symbols_in(tree):
            ball = evaluated(tree, {}, self.effort)
            return bool(ball > 0) if positive else excludes_zero(ball)
        if tree.head == "product":
            return all(self.is_nowhere_zero(part, positive) for part in tree.below)
        if tree.head == "power":
            return self.is_nowhere_zero(tree.below[0], positive) and not symbols_in(tree.below[1])
        sign = self.problem.parameters.get(str(tree.value)) if tree.head == "symbol" else ""
        return sign == "positive" or (sign == "nonzero" and not positive)

    def has_value_everywhere(self, tree: Tree) -> bool:
        """Whether a tree is smooth (analytic, but for declared functions) at all real values of its symbols."""
        if not symbols_in(tree):
            return evaluated(tree, {}, self.effort) is not None
        exponent = tree.below[1].value if tree.head == "power" else None
        whole = isinstance(exponent, Fraction) and exponent.denominator == 1 and exponent > 0
        return (whole or tree.head in _PLAIN) and all(map(self.has_value_everywhere, tree.below))

    def reason(self, why: Any, tree: Tree) -> bool:
        """Whether it is shown that a tree is nowhere 0: as it is written, or as squares and what is positive."""
        if why is None or "sos" not in why:
            return self.is_nowhere_zero(tree)
        squares, plus = self.squares(why["sos"]), self.text(why["plus"])
        total = add(squares, plus)
        refuse(not self.is_nowhere_zero(plus, True), "what is added to the squares is not positive")
        refuse(not self.same(tree, total) and not self.same(tree, negative(total)), "not the squares that are told")
        return True


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
