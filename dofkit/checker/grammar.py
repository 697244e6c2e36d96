"""The grammar of texts: relations and values as people write them, read into trees.

From loosest to tightest: relation, sum, term, factor, power, primary. What could be read in two ways is an error.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from dofkit.checker.derivatives import degree_parts, derivative, substituted, symbols_in
from dofkit.checker.errors import CheckError
from dofkit.checker.tokens import LARGEST_EXPONENT, Lexeme, tokens_of
from dofkit.checker.trees import ONE, ZERO, Tree, add, call, negative, number, power, symbol, times
from dofkit.checker.words import EULER, PI, KnownNames, moved

DEEPEST = 60
MOST_ORDERS = 6
#: A tree of more nodes is not differentiated while a text is read.
LARGEST = 400
_PAIRS = {"(": ")", "[": "]", "{": "}"}
_BEGIN = ("value", "moving", "function", "declared", "operator", "(", "|")


class Sided(NamedTuple):
    """One relation: ``tree`` = 0; with the sign ``>`` it is > 0 (``strict``) or >= 0."""

    tree: Tree
    sign: str
    strict: bool


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
        strict = sign in ("<", ">")
        found.append(Sided(add(larger, negative(smaller)), "=" if sign in ("=", "==") else ">", strict))
        left = right
    reader.expect("end")
    return found or [Sided(left, "=", False)]


class _Reader:
    """One text, read from left to right."""

    def __init__(self, text: str, names: KnownNames) -> None:
        self.names = names
        self.tokens = tokens_of(text, names)
        self.at = self.depth = self.bars = 0

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
            sign = self.take().kind
            term = self.term()
            terms.append(term if sign == "+" else negative(term))
        self.depth -= 1
        return terms[0] if len(terms) == 1 else add(*terms)

    def term(self) -> Tree:
        """Factors; a space after a quotient makes what follows a factor of all that was before."""
        factors = [self.factor()]
        quotient = False
        while True:
            token = self.next
            if token.kind in ("*", "/"):
                self.at += 1
                quotient = token.kind == "/" and not self.divide(factors)
                if token.kind == "*":
                    factors.append(self.factor())
            elif token.kind in _BEGIN and not (token.kind == "|" and self.bars):
                if quotient and token.touching:
                    raise CheckError("what stands under a fraction line can be read in two ways")
                quotient = False
                factors.append(self.power())
            elif token.kind == "number":
                raise CheckError("a number stands right after a factor")
            else:
                return times(*factors)

    def divide(self, factors: list[Tree]) -> bool:
        """Divide by the next factor; True for ``dx/dt``, which is one unit."""
        divisor = self.factor()
        if divisor == symbol("dt"):
            rates = {f"d{q}": symbol(f"{q}dot") for q in self.names.coordinates} | {"dt": ONE}
            if set(degree_parts(factors[-1], rates.keys()) or ()) == {1}:
                factors[-1] = substituted(factors[-1], rates)
                return True
        if divisor.head == "symbol" and factors[-1].head == "product" and divisor in factors[-1].below:
            above = list(factors[-1].below)
            above.remove(divisor)
            factors[-1] = times(*above)
        else:
            factors.append(_power(divisor, number(-1)))
        return False

    def factor(self) -> Tree:
        """A power with signs before it."""
        minus = False
        while self.next.kind in ("+", "-"):
            minus ^= self.take().kind == "-"
        found = self.power()
        return negative(found) if minus else found

    def power(self) -> Tree:
        """A primary, perhaps raised; ``x^y^z`` is x^(y^z)."""
        base = self.primary()
        if self.next.kind == "raised":
            found = _power(base, self.take().tree)
            if self.next.kind in ("^", "raised"):
                raise CheckError("one power stands on another")
            return found
        if self.next.kind != "^":
            return base
        self.at += 1
        self.depth += 1
        if self.depth > DEEPEST:
            raise CheckError("a text is nested too deep")
        exponent = self.factor()
        self.depth -= 1
        return _power(base, exponent)

    def primary(self) -> Tree:
        """A number, a name, a group, or a function of something."""
        token = self.take()
        if token.kind == "number":
            return token.tree
        if token.kind in ("value", "moving"):
            return self.named(token)
        if token.kind == "(":
            bars, self.bars = self.bars, 0
            found = self.sum()
            self.bars = bars
            self.expect(")", token.name)
            return found
        if token.kind == "|":
            self.bars += 1
            found = self.sum()
            self.bars -= 1
            self.expect("|")
            return call("abs", found)
        readers = {"function": self.function, "declared": self.declared, "operator": self.derivative}
        if token.kind not in readers:
            raise CheckError(f"`{token.name or token.kind}` cannot stand here")
        return readers[token.kind](token)

    def arguments(self) -> list[Tree]:
        """Values in parentheses, with commas between them."""
        opening = self.take().name
        bars, self.bars = self.bars, 0
        found = [self.sum()]
        while self.next.kind == ",":
            self.at += 1
            found.append(self.sum())
        self.bars = bars
        self.expect(")", opening)
        return found

    def named(self, token: Lexeme) -> Tree:
        """A name with its primes; ``x(t)`` is x, and ``x(y)`` a question."""
        found = token.tree
        if self.next.kind == "prime" and self.next.touching:
            motion = moved(token.name, self.take().order) if token.name else None
            if motion is None:
                raise CheckError("a prime stands where nothing can be differentiated by time")
            found = motion.tree
        ahead = [token.kind for token in self.tokens[self.at : self.at + 3]]
        if ahead in (["(", "value", ")"], ["(", "number", ")"]) and found not in (PI, EULER, symbol("t"), symbol("dt")):
            inside = self.tokens[self.at + 1]
            moves = token.kind == "moving" or bool(token.name)
            if inside.tree == symbol("t"):
                if not moves:
                    raise CheckError("a constant is no function of t")
                self.at += 3
            elif self.next.touching:
                raise CheckError("a name before parentheses may be a factor or a function")
        return found

    def function(self, token: Lexeme) -> Tree:
        """``sin(x)``, ``sin x``, ``sin^2(x)``."""
        exponent = ONE
        if self.next.kind in ("^", "raised"):
            exponent = ZERO
            if self.take().kind == "raised":
                exponent = self.tokens[self.at - 1].tree
            elif self.next.kind in ("number", "("):
                exponent = self.primary()
            value = exponent.value
            if not isinstance(value, Fraction) or value.denominator != 1 or value < 1:
                raise CheckError(f"this power of `{token.name}` can be read in two ways")
        given = self.arguments() if self.next.kind == "(" else [self.bare(token)]
        if len(given) != (2 if token.name == "atan2" else 1):
            raise CheckError(f"`{token.name}` has {len(given)} arguments")
        found = ONE if (token.name, given) == ("exp", [ZERO]) else call(token.name, *given)
        return _power(found, exponent)

    def bare(self, token: Lexeme) -> Tree:
        """What a function without parentheses is taken of: a number and a name, or one of them, and nothing after."""
        parts = [self.take().tree] if self.next.kind == "number" else []
        number_alone = bool(parts) and self.next.kind != "value"
        if self.next.kind == "value":
            parts.append(self.named(self.take()))
        elif self.next.kind in ("moving", "declared") and not parts:
            parts.append(self.primary())
        after = self.next
        open_ended = after.kind in ("value", "number", "^", "raised", "(") or (number_alone and after.kind in _BEGIN)
        open_ended = open_ended or (after.kind in ("*", "/") and after.touching)
        if not parts or open_ended:
            raise CheckError(f"it is not clear what `{token.name}` is taken of")
        return times(*parts)

    def declared(self, token: Lexeme) -> Tree:
        """``h(s)``, ``h'(s)``, ``h`` alone, ``hdot``, ``dh``."""
        own = self.names.functions[token.name]
        primes = self.take().order if self.next.kind == "prime" and self.next.touching else 0
        ahead = [t.kind for t in self.tokens[self.at : self.at + 3]]
        if ahead == ["^", "number", "("] or ahead[:2] == ["raised", "("]:
            raise CheckError(f"a power stands between `{token.name}` and its argument")
        if self.next.kind == "(":
            given = self.arguments()
        else:
            meanings = [self.names.meaning(name) for name in own]
            if any(meaning is None or meaning.kind != "value" for meaning in meanings):
                raise CheckError(f"`{token.name}` alone has arguments that are not declared")
            given = [meaning.tree for meaning in meanings if meaning is not None]
            if self.next.kind == "value" and self.next.tree in given:
                raise CheckError(f"`{token.name}` beside its argument may be a value or a product")
        if len(given) != len(own) or (primes and len(own) != 1) or primes > MOST_ORDERS:
            raise CheckError(f"`{token.name}` is declared with {len(own)} arguments")
        found = Tree("apply", tuple(given), token.name, (primes,) if primes else (0,) * len(own))
        if token.order == -1:
            return self.total(found, -1)
        for _ in range(token.order):
            found = self.total(found, 1)
        return found

    def total(self, tree: Tree, order: int) -> Tree:
        """The derivative by time, or (-1) the differential."""
        _bounded(tree)
        terms = []
        for name in sorted(symbols_in(tree)):
            step = {"t": ONE if order == 1 else symbol("dt")}.get(name)
            if name in self.names.coordinates:
                step = symbol(f"{name}dot" if order == 1 else f"d{name}")
            elif name.endswith("dot") and name[:-3] in self.names.coordinates and order == 1:
                step = symbol(f"{name[:-3]}ddot")
            if step is not None:
                terms.append(times(derivative(tree, name), step))
        return add(*terms)

    def derivative(self, token: Lexeme) -> Tree:
        """``diff(h(s), s)``, ``diff(h(s), s, 2)``, ``partial(h(x, t), 2)``; ``diff`` by t is total."""
        found, *steps = self.arguments()
        total = 0
        for i, step in enumerate(steps):
            by_place = token.name == "partial" and step.head == "number"
            if step.head == "number" and not by_place:
                continue
            after = steps[i + 1] if i + 1 < len(steps) and not by_place else ONE
            times_over = int(after.value) if isinstance(after.value, Fraction) and after.value.denominator == 1 else 1
            total += times_over
            if total > MOST_ORDERS or times_over < 1:
                raise CheckError("a derivative of this order is not read")
            for _ in range(times_over):
                found = self.once(found, step, token.name)
        if not total:
            raise CheckError(f"`{token.name}` needs what to differentiate and by what")
        return found

    def once(self, tree: Tree, step: Tree, name: str) -> Tree:
        """One derivative, by a symbol or by the place of an argument."""
        _bounded(tree)
        if step == symbol("t") and name == "diff":
            return self.total(tree, 1)
        if step.head == "symbol":
            return derivative(tree, str(step.value))
        place = int(step.value) - 1 if isinstance(step.value, Fraction) else -1
        if tree.head != "apply" or not 0 <= place < len(tree.below) or number(place + 1) != step:
            raise CheckError(f"`{name}` differentiates by a symbol, or a declared function by its argument")
        return Tree("apply", tree.below, tree.value, tuple(k + (i == place) for i, k in enumerate(tree.orders)))


def _power(base: Tree, exponent: Tree) -> Tree:
    """A power within the bounds; powers of numbers are carried out."""
    value = exponent.value
    if base == EULER:
        return call("exp", exponent)
    if not isinstance(value, Fraction):
        return power(base, exponent)
    if abs(value.numerator) > LARGEST_EXPONENT or value.denominator > LARGEST_EXPONENT:
        raise CheckError("an exponent is too large")
    if abs(value) > 1 and _nested(base) * abs(value) > LARGEST_EXPONENT:
        raise CheckError("powers of powers are too large")
    if isinstance(base.value, Fraction):
        if base == ZERO and value <= 0:
            raise CheckError("0 stands in a denominator")
        if base.value < 0 and value.denominator != 1:
            raise CheckError("a root of a negative number is not real")
        if value.denominator == 1:
            found = base.value ** int(value)
            if max(found.numerator.bit_length(), found.denominator.bit_length()) > 8192:
                raise CheckError("a number is too large")
            return number(found)
    return power(base, exponent)


def _bounded(tree: Tree) -> None:
    """Refuse a tree that is too large to be differentiated."""
    stack, count = [tree], 0
    while stack:
        stack.extend(stack.pop().below)
        count += 1
        if count > LARGEST:
            raise CheckError("this is too long to be differentiated here")


def _nested(tree: Tree) -> Fraction:
    """The largest product of exponents within each other."""
    inner = max((_nested(part) for part in tree.below), default=Fraction(1))
    if tree.head == "power" and isinstance(tree.below[1].value, Fraction):
        return inner * max(Fraction(1), abs(tree.below[1].value))
    return inner
