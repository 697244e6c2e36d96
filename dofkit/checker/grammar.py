"""The grammar of texts: relations and values as people write them, read into trees.

From loosest to tightest: relation, sum, term, factor, power, primary. What could be read in two ways is an error.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from dofkit.checker.derivatives import derivative, linear_parts, substituted, symbols_in
from dofkit.checker.errors import CheckError
from dofkit.checker.tokens import Lexeme, tokens_of
from dofkit.checker.trees import ONE, ZERO, Tree, add, call, negative, number, power, symbol, times
from dofkit.checker.words import EULER, PI, KnownNames

DEEPEST = 60
LARGEST_EXPONENT = 64
MOST_BITS = 8192
#: How often a function is differentiated, and the nodes of a tree that is differentiated while a text is read.
MOST_ORDERS, LARGEST = 6, 400
_PAIRS = {"(": ")", "[": "]", "{": "}"}
_BEGIN = ("value", "moving", "function", "declared", "operator", "(")


class Sided(NamedTuple):
    """One relation: ``tree`` = 0; with the sign ``>`` it is > 0 (``strict``) or >= 0."""

    tree: Tree
    sign: str = "="
    strict: bool = False


def parse(text: str, names: KnownNames) -> Tree:
    """The value that a text writes."""
    reader = _Reader(text, names)
    found = reader.sum()
    reader.expect("end")
    return found


def parse_relations(text: str, names: KnownNames) -> list[Sided]:
    """The relations of a text, left less right side; a text without a sign is ``= 0``, a chain is several."""
    reader = _Reader(text, names)
    left, found = reader.sum(), []
    while reader.next.kind == "relation":
        sign = reader.take().name
        right = reader.sum()
        larger, smaller = (right, left) if "<" in sign else (left, right)
        found.append(Sided(add(larger, negative(smaller)), ">" if sign[0] in "<>" else "=", sign in ("<", ">")))
        left = right
    reader.expect("end")
    return found or [Sided(left)]


class _Reader:
    """One text, read from left to right."""

    def __init__(self, text: str, names: KnownNames) -> None:
        self.names = names
        self.tokens = tokens_of(text, names)
        self.at = self.depth = 0

    @property
    def next(self) -> Lexeme:
        return self.tokens[self.at]

    def take(self) -> Lexeme:
        self.at += 1
        return self.tokens[self.at - 1]

    def expect(self, kind: str, opening: str = "") -> None:
        token = self.take()
        if token.kind != kind or (opening and token.name != _PAIRS[opening]):
            raise CheckError(f"`{token.name or token.kind}` stands where `{kind}` is expected")

    def sum(self) -> Tree:
        """Terms with signs between them."""
        self.depth += 1
        if self.depth > DEEPEST:
            raise CheckError("a text is nested too deep")
        terms = [self.term()]
        while self.next.kind in ("+", "-"):
            terms.append(negative(self.term()) if self.take().kind == "-" else self.term())
        self.depth -= 1
        return terms[0] if len(terms) == 1 else add(*terms)

    def term(self) -> Tree:
        """Factors; a space after a quotient makes what follows a factor of all that was before."""
        factors = [self.factor()]
        quotient = False
        while self.next.kind in ("*", "/", *_BEGIN):
            kind = self.next.kind
            if kind not in "*/":
                if quotient and self.next.touching:
                    raise CheckError("what stands under a fraction line can be read in two ways")
                factors.append(self.power())
            elif self.take().kind == "*":
                factors.append(self.factor())
            quotient = kind == "/" and not self.divide(factors)
        if self.next.kind == "number":
            raise CheckError("a number stands right after a factor")
        return times(*factors)

    def divide(self, factors: list[Tree]) -> bool:
        """Divide by the next factor; True for ``dx/dt``, which is one unit."""
        divisor = self.factor()
        if divisor == symbol("dt"):
            known = self.names.coordinates
            rates = {d: symbol(f"{d[1:]}dot") for d in symbols_in(factors[-1]) if d[0] == "d" and d[1:] in known}
            rates |= {"dt": ONE}
            parts = linear_parts(factors[-1], rates)
            if parts is not None and parts[0] and parts[1] == ZERO:
                factors[-1] = substituted(factors[-1], rates)
                return True
        factors.append(_power(divisor, number(-1)))
        return False

    def factor(self) -> Tree:
        """A power with signs before it."""
        minus = False
        while self.next.kind in ("+", "-"):
            minus ^= self.take().kind == "-"
        return negative(self.power()) if minus else self.power()

    def power(self) -> Tree:
        """A primary, perhaps raised; ``x^y^z`` is x^(y^z)."""
        base = self.primary()
        if self.next.kind == "raised":
            base = _power(base, self.take().tree)
            if self.next.kind in ("^", "raised"):
                raise CheckError("one power stands on another")
        elif self.next.kind == "^":
            self.at += 1
            self.depth += 1
            if self.depth > DEEPEST:
                raise CheckError("a text is nested too deep")
            base = _power(base, self.factor())
            self.depth -= 1
        return base

    def primary(self) -> Tree:
        """A number, a name, a group, or a function of something."""
        token = self.take()
        if token.kind == "number":
            return token.tree
        if token.kind in ("value", "moving"):
            return self.named(token)
        if token.kind == "(":
            self.at -= 1
            return self.arguments(1)[0]
        readers = {"function": self.function, "declared": self.declared, "operator": self.derivative}
        if token.kind not in readers:
            raise CheckError(f"`{token.name or token.kind}` cannot stand here")
        return readers[token.kind](token)

    def arguments(self, most: int) -> list[Tree]:
        """Values in parentheses, with commas between them."""
        opening = self.take()
        if opening.kind != "(":
            raise CheckError("parentheses are missing")
        found = [self.sum()]
        while self.next.kind == "," and len(found) < most:
            self.at += 1
            found.append(self.sum())
        self.expect(")", opening.name)
        return found

    def named(self, token: Lexeme) -> Tree:
        """A name with its prime; ``x(y)`` is a question, as is ``x (t)``."""
        found = token.tree
        if self.next.kind == "prime" and self.next.touching:
            motion = self.names.moved(token.name, "{}dot") if self.take().name == "'" else None
            if motion is None:
                raise CheckError("a prime stands where nothing can be differentiated by time")
            found = motion.tree
        ahead = [token.kind for token in self.tokens[self.at : self.at + 3]]
        called = ahead in (["(", "value", ")"], ["(", "number", ")"]) and found not in (PI, EULER, symbol("t"))
        if called and (self.next.touching or self.tokens[self.at + 1].tree == symbol("t")):
            raise CheckError("a name before parentheses may be a factor or a function")
        return found

    def function(self, token: Lexeme) -> Tree:
        """``sin(x)``, ``sin^2(x)``, ``sin x``."""
        exponent = ONE
        if self.next.kind in ("^", "raised"):
            raised = self.take()
            raised = self.take() if raised.kind == "^" and self.next.kind == "number" else raised
            exponent = raised.tree
            if not isinstance(exponent.value, Fraction) or exponent.value.denominator != 1 or exponent.value < 2:
                raise CheckError(f"this power of `{token.name}` can be read in two ways")
        given = self.arguments(2) if self.next.kind == "(" else [self.bare(token)]
        if len(given) != (2 if token.name == "atan2" else 1):
            raise CheckError(f"`{token.name}` has {len(given)} arguments")
        return _power(ONE if (token.name, given) == ("exp", [ZERO]) else call(token.name, *given), exponent)

    def bare(self, token: Lexeme) -> Tree:
        """What a function without parentheses is taken of: one name, where nothing after it could belong to it."""
        if self.next.kind != "value":
            raise CheckError(f"it is not clear what `{token.name}` is taken of")
        found = self.named(self.take())
        after = self.next
        if after.kind in ("value", "number", "^", "raised", "(") or (after.kind in ("*", "/") and after.touching):
            raise CheckError(f"it is not clear what `{token.name}` is taken of")
        return found

    def declared(self, token: Lexeme) -> Tree:
        """``h(s)``, ``h'(s)``, ``h`` alone."""
        own = self.names.functions[token.name]
        primes = len(self.take().name) if self.next.kind == "prime" and self.next.touching else 0
        if self.next.kind == "(":
            given = self.arguments(len(own))
        else:
            meanings = [self.names.meaning(name) for name in own]
            given = [meaning.tree for meaning in meanings if meaning is not None and meaning.kind == "value"]
            if self.next.kind in ("value", "^", "raised"):
                raise CheckError(f"`{token.name}` needs its argument in parentheses here")
        if len(given) != len(own) or (primes and len(own) != 1) or primes > MOST_ORDERS:
            raise CheckError(f"`{token.name}` is declared with {len(own)} arguments")
        return Tree("apply", tuple(given), token.name, (primes,) if primes else (0,) * len(own))

    def derivative(self, token: Lexeme) -> Tree:
        """``diff(h(s), s)``, ``diff(h(s), s, 2)``; ``partial(h(x, x), 2)`` by the place of an argument."""
        found, *steps = self.arguments(2 * MOST_ORDERS)
        by: list[Tree] = []
        for step in steps:
            count = int(step.value) if isinstance(step.value, Fraction) and step.value.denominator == 1 else 0
            if by and token.name == "diff" and 0 < count <= MOST_ORDERS:
                by += by[-1:] * (count - 1)
            else:
                by.append(step)
        if not 0 < len(by) <= MOST_ORDERS:
            raise CheckError(f"`{token.name}` needs what to differentiate and by what")
        for step in by:
            found = self.once(found, step, token.name)
        return found

    def once(self, tree: Tree, step: Tree, name: str) -> Tree:
        """One derivative, by a symbol or by the place of an argument."""
        if step.head == "symbol":
            total = step == symbol("t") and name == "diff" and not symbols_in(tree) <= {"t", *self.names.values}
            if total or _size(tree) > LARGEST:
                raise CheckError("this derivative by time, or of a long expression, is not read")
            return derivative(tree, str(step.value))
        places = [i for i in range(len(tree.below)) if number(i + 1) == step]
        if tree.head != "apply" or not places:
            raise CheckError(f"`{name}` differentiates by a symbol, or a declared function by its argument")
        return Tree("apply", tree.below, tree.value, tuple(k + (i in places) for i, k in enumerate(tree.orders)))


def _power(base: Tree, exponent: Tree) -> Tree:
    """A power within the bounds; powers of numbers are carried out."""
    value = exponent.value
    if base == EULER:
        return call("exp", exponent)
    if not isinstance(value, Fraction):
        return power(base, exponent)
    if (
        value.denominator > LARGEST_EXPONENT
        or max(Fraction(abs(value.numerator)), _nested(base) * abs(value)) > LARGEST_EXPONENT
    ):
        raise CheckError("an exponent is too large")
    if not isinstance(base.value, Fraction):
        return power(base, exponent)
    if (base == ZERO and value <= 0) or (base.value < 0 and value.denominator != 1):
        raise CheckError("0 stands in a denominator, or a negative number under a root")
    if value.denominator != 1:
        return power(base, exponent)
    found = base.value ** int(value)
    if max(found.numerator.bit_length(), found.denominator.bit_length()) > MOST_BITS:
        raise CheckError("a number is too large")
    return number(found)


def _nested(tree: Tree) -> Fraction:
    """The largest product of exponents within each other."""
    inner = max([Fraction(1), *map(_nested, tree.below)])
    exponent = tree.below[1].value if tree.head == "power" else ""
    return inner * max(Fraction(1), abs(exponent)) if isinstance(exponent, Fraction) else inner


def _size(tree: Tree) -> int:
    """The number of nodes."""
    return 1 + sum(map(_size, tree.below))
