"""The grammar of texts: relations and values as people write them, read into trees.

From loosest to tightest: relation, sum, term, factor, primary. What could be read in two ways is an error.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from dofkit.checker.derivatives import derivative, folded, over_time, symbols_in
from dofkit.checker.trees import ONE, ZERO, Tree, add, call, negative, number, power, refuse, symbol, times
from dofkit.checker.words import EULER, MOST_ORDERS, KnownNames, Lexeme, tokens_of

DEEPEST, LARGEST_EXPONENT, MOST_BITS = 60, 64, 8192
#: The nodes of a tree that is differentiated while a text is read.
LARGEST = 400
_TIME = symbol("t")
_PAIRS = {"(": ")", "[": "]", "{": "}"}
_BEGIN = ("value", "moving", "function", "declared", "operator", *_PAIRS)


class Sided(NamedTuple):
    """One relation: ``tree`` = 0; with the sign ``>`` it is > 0 (``strict``) or >= 0."""

    tree: Tree
    sign: str = "="
    strict: bool = False


def parse(text: str, names: KnownNames) -> Tree:
    """The value that a text writes."""
    reader = _Reader(text, names)
    found = reader.sum()
    reader.take("end")
    return found


def parse_relations(text: str, names: KnownNames) -> list[Sided]:
    """The relations of a text, left less right side; a text without a sign is ``= 0``, a chain is several."""
    reader = _Reader(text, names)
    left, found = reader.sum(), []
    while reader.next.kind == "relation":
        sign, right = reader.take().name, reader.sum()
        tree = add(right, negative(left)) if "<" in sign else add(left, negative(right))
        found.append(Sided(tree, ">" if sign[0] in "<>" else "=", sign in ("<", ">")))
        left = right
    reader.take("end")
    return found or [Sided(left)]


class _Reader:
    """One text, read from left to right."""

    def __init__(self, text: str, names: KnownNames) -> None:
        self.names, self.tokens = names, tokens_of(text, names)
        self.at = self.depth = 0

    @property
    def next(self) -> Lexeme:
        return self.tokens[self.at]

    def take(self, kind: str = "") -> Lexeme:
        self.at += 1
        token = self.tokens[self.at - 1]
        refuse(kind and token.kind != kind, f"`{token.name or token.kind}` stands where `{kind}` is expected")
        return token

    def sum(self) -> Tree:
        """Terms, each with its sign before it."""
        terms = [self.term()]
        while self.next.kind in ("+", "-"):
            terms.append(self.term())
        return terms[0] if len(terms) == 1 else add(*terms)

    def term(self) -> Tree:
        """Factors; a space after a quotient makes what follows a factor of all that was before."""
        factors, quotient = [self.factor()], False
        while self.next.kind in ("*", "/", *_BEGIN):
            kind = self.next.kind
            refuse(quotient and kind in _BEGIN and self.next.touching, "it is not clear what is under a fraction line")
            self.at += kind in ("*", "/")
            factor = self.factor()
            quotient = kind == "/" and factor != symbol("dt")
            if kind != "/":
                factors.append(factor)
            elif quotient:
                factors.append(_power(factor, number(-1)))
            else:
                factors[-1] = over_time(factors[-1], self.names.coordinates)
        return times(*factors)

    def factor(self) -> Tree:
        """Signs, a primary and its power: ``-x^2`` is -(x^2), ``x^y^z`` is x^(y^z)."""
        self.depth += 1
        refuse(self.depth > DEEPEST, "a text is nested too deep")
        minus = False
        while self.next.kind in ("+", "-"):
            minus ^= self.take().kind == "-"
        found = self.primary()
        if self.next.kind == "^":
            self.at += 1
            found = _power(found, self.factor())
        self.depth -= 1
        return negative(found) if minus else found

    def primary(self) -> Tree:
        """A number, a name, a group, or a function of something."""
        token = self.next
        if token.kind in _PAIRS:
            found, *more = self.arguments()
            refuse(more, "a comma stands in a group")
            return found
        self.at += 1
        if token.kind == "number":
            return token.tree
        if token.kind in ("value", "moving"):
            return self.named(token)
        readers = {"function": self.function, "declared": self.declared, "operator": self.derivative}
        refuse(token.kind not in readers, f"`{token.name or token.kind}` cannot stand here")
        return readers[token.kind](token)

    def arguments(self) -> list[Tree]:
        """Values in parentheses, with commas between them."""
        opening = self.take().kind
        refuse(opening not in _PAIRS, "parentheses are missing")
        found = [self.sum()]
        while self.next.kind == ",":
            self.at += 1
            found.append(self.sum())
        self.take(_PAIRS[opening])
        return found

    def named(self, token: Lexeme) -> Tree:
        """A name; ``x(y)`` is a question, as is ``x (t)``."""
        after = self.tokens[self.at : self.at + 3]
        called = [one.kind for one in after] in (["(", "value", ")"], ["(", "number", ")"])
        doubtful = called and (self.next.touching or after[1].tree == _TIME)
        refuse(doubtful, "a name before parentheses may be a factor or a function")
        return token.tree

    def function(self, token: Lexeme) -> Tree:
        """``sin(x)``, ``sin^2(x)``, ``sin x``."""
        exponent = ONE
        if self.next.kind == "^":
            self.at += 1
            exponent = self.next.tree
            refuse(_whole(exponent) < 2, f"this power of `{token.name}` can be read in two ways")
            self.at += 1
        given = self.arguments() if self.next.kind in _PAIRS else [self.bare(token)]
        refuse(len(given) != (2 if token.name == "atan2" else 1), f"`{token.name}` has {len(given)} arguments")
        return _power(ONE if (token.name, given) == ("exp", [ZERO]) else call(token.name, *given), exponent)

    def bare(self, token: Lexeme) -> Tree:
        """What a function without parentheses is taken of: one name, where nothing after it could belong to it."""
        refuse(self.next.kind != "value", f"it is not clear what `{token.name}` is taken of")
        taken, after = self.take(), self.next
        unclear = after.kind in ("value", "number", "^", *_PAIRS) or (after.kind in ("*", "/") and after.touching)
        refuse(unclear, f"it is not clear what `{token.name}` is taken of")
        return taken.tree

    def declared(self, token: Lexeme) -> Tree:
        """``h(s)``, ``h'(s)``, ``h`` alone."""
        alone = token.tree
        given = tuple(self.arguments()) if self.next.kind in _PAIRS else alone.below
        refuse(given is alone.below and self.next.kind in ("value", "^"), f"`{token.name}` needs parentheses here")
        refuse(len(given) != len(alone.orders), f"`{token.name}` is declared with {len(alone.orders)} arguments")
        return Tree("apply", given, alone.value, alone.orders)

    def derivative(self, token: Lexeme) -> Tree:
        """``diff(h(s), s)``, ``diff(h(s), s, 2)``; ``partial(h(x, x), 2)`` by the place of an argument."""
        found, *steps = self.arguments()
        by: list[Tree] = []
        for step in steps:
            again = by and token.name == "diff" and 0 < _whole(step) <= MOST_ORDERS
            by += by[-1:] * (_whole(step) - 1) if again else [step]
        refuse(not 0 < len(by) <= MOST_ORDERS, f"`{token.name}` needs what to differentiate and by what")
        for step in by:
            if token.name == "diff" and step == _TIME:
                refuse(not symbols_in(found) <= {"t", *self.names.values}, "a derivative by time is not read")
            found = _once(found, step)
        return found


def _whole(tree: Tree) -> int:
    """A whole number; 0 for anything else."""
    return int(tree.value) if isinstance(tree.value, Fraction) and tree.value.denominator == 1 else 0


def _once(tree: Tree, step: Tree) -> Tree:
    """One derivative, by a symbol or by the place of an argument."""
    if step.head == "symbol":
        size = folded(tree, lambda _, below: 1 + sum(below))
        refuse(size > LARGEST, "a derivative of a long expression is not read")
        return derivative(tree, str(step.value))
    places = [i for i in range(len(tree.below)) if number(i + 1) == step]
    refuse(tree.head != "apply" or not places, "a derivative is by a symbol, or of a declared function by its argument")
    return Tree("apply", tree.below, tree.value, tuple(k + (i in places) for i, k in enumerate(tree.orders)))


def _power(base: Tree, exponent: Tree) -> Tree:
    """A power within the bounds; powers of numbers are carried out."""
    raised, value = base.value, exponent.value
    if base == EULER:
        return call("exp", exponent)
    if isinstance(value, Fraction):
        deep: Fraction = abs(value) * folded(base, _nested)
        large = max(abs(value.numerator), value.denominator) > LARGEST_EXPONENT
        refuse(large or deep > LARGEST_EXPONENT, "an exponent is too large")
        if isinstance(raised, Fraction):
            refuse(raised == 0 and value <= 0, "0 stands in a denominator")
            refuse(raised < 0 and value.denominator != 1, "a negative number stands under a root")
            if value.denominator == 1:
                found = raised ** int(value)
                size = max(found.numerator.bit_length(), found.denominator.bit_length())
                refuse(size > MOST_BITS, "a number is too large")
                return number(found)
    return power(base, exponent)


def _nested(node: Tree, below: tuple[Fraction, ...]) -> Fraction:
    """The largest product of exponents within each other."""
    exponent = node.below[1].value if node.head == "power" else ""
    own = abs(exponent) if isinstance(exponent, Fraction) else Fraction(1)
    return max(own, Fraction(1)) * max(below, default=Fraction(1))
