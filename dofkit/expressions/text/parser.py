"""The grammar: tokens -> expressions, by precedence climbing.

An LALR table (lark) reads the plain part of this grammar in 0.06 ms warm, but costs 0.1 s at the
first text, a third of what `import sympy` does; and most rules here depend on more than the kind of
the next token: on what a name means (``x(t)``, ``dx/dt``), on the space around a sign
(``sin theta/2``), on what was read just before (``1/2x``), and each doubtful place asks its own
question. So the rules are the methods below, from loosest to tightest:

    relation  sum (sign sum)*          sum      term (+|- term)*
    term      factor (*|/ factor | factor written side by side)*
    factor    (+|-)* power             power    primary (^ factor | superscript)?
    primary   number, name, group, |..|, root, function, derivative
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, NoReturn, cast

from dofkit.expressions.domains import Requirement, of_power
from dofkit.expressions.text.arithmetic import UndefinedError, check_numbers, inverse, product, raised
from dofkit.expressions.text.derivatives import is_differential, over_dt
from dofkit.expressions.text.limits import MAX_DEPTH
from dofkit.expressions.text.names import AmbiguousError
from dofkit.expressions.text.primaries import PrimaryReader
from dofkit.expressions.text.tokens import Token
from dofkit.expressions.tree import DT, MINUS_ONE, ZERO, Expr, add, mul, num

RelationSign = Literal["=", "<=", ">=", "<", ">"]
#: The kinds of tokens that begin a factor which may stand right after another one.
STARTS = frozenset({"value", "motion", "function", "call", "operator", "(", "|", "frac", "root"})


@dataclass(frozen=True)
class Comparison:
    """One relation; ``column`` is where its sign stands (where the text begins, if it has none).

    ``domain``: what has to be so where the text, as it was written, has a value.
    """

    left: Expr
    relation: RelationSign
    right: Expr
    column: int
    domain: tuple[Requirement, ...] = ()


class Parser(PrimaryReader):
    """Reads relations, sums, products and powers."""

    # Relations and sums

    def relations(self) -> tuple[Comparison, ...]:
        """The whole text: a value, a relation or a chain of them."""
        first = self.next
        left = self.bounded(self.sum(), first)
        token = self.take()
        found = []
        if token.kind == "end":
            return (Comparison(left, "=", ZERO, self.columns[first.start], tuple(self.domain)),)
        while token.kind == "relation":
            right = self.bounded(self.sum(), token)
            found.append(Comparison(left, cast(RelationSign, token.name), right, self.columns[token.start]))
            left, token = right, self.take()
        if token.kind != "end":
            self.unexpected(token)
        return tuple(replace(c, domain=tuple(self.domain)) for c in found)

    def value(self) -> Expr:
        """The whole text as one value."""
        found = self.bounded(self.sum(), self.tokens[0])
        token = self.next
        if token.kind == "relation":
            self.fail(f"a value is needed here, and `{token.name}` makes a relation", token, "write one side only")
        if token.kind != "end":
            self.unexpected(token)
        return found

    def sum(self) -> Expr:
        """Terms with signs between them."""
        self.deeper(self.next)
        terms = [self.term()]
        while (kind := self.tokens[self.at].kind) in ("+", "-"):
            self.at += 1
            term = self.term()
            terms.append(term if kind == "+" else mul(MINUS_ONE, term))
        self.depth -= 1
        return terms[0] if len(terms) == 1 else add(*terms)

    def bounded(self, e: Expr, token: Token) -> Expr:
        """``e``, if its numbers and powers are small enough."""
        try:
            check_numbers(e)
        except UndefinedError as fault:
            self.fail(fault.message, token, fault.hint)
        return e

    # Products

    def term(self) -> Expr:
        """Factors with signs between them or side by side; after a quotient a space decides: `1/2 x` is (1/2) x."""
        first = self.next
        factors = [self.factor()]
        slash: Token | None = None
        while True:
            token = self.tokens[self.at]
            kind = token.kind
            if kind == "*":
                self.at += 1
                factors.append(self.factor())
                slash = None
            elif kind == "/":
                self.at += 1
                slash = None if self.divide(factors) else token
            elif kind in STARTS and not (kind == "|" and self.bars):
                if slash is not None and token.start == self.last.end:
                    self.ask_quotient(first, slash)
                factors.append(self.power())
                slash = None
            elif kind == "number":
                self.ask_number(token)
            else:
                return product(factors)

    def divide(self, factors: list[Expr]) -> bool:
        """Divide by the next factor; True for a derivative such as dx/dt, which is one unit."""
        token = self.next
        divisor = self.factor()
        if divisor == DT:
            moved = over_dt(factors[-1])
            if moved is not None:
                factors[-1] = moved
                return True
        unit = is_differential(divisor) and is_differential(factors[-1])
        try:
            factors.append(inverse(divisor))
            self.domain |= dict.fromkeys(of_power(divisor, MINUS_ONE))
        except UndefinedError as fault:
            self.fail(fault.message, token, fault.hint)
        return unit

    def ask_quotient(self, first: Token, slash: Token) -> NoReturn:
        """`1/2x`: which of the two?"""
        above = self.source(first.start, slash.start)
        below = self.source(slash.end, self.last.end)
        token = self.next
        self.power()
        beside = self.source(token.start, self.last.end)
        whole = self.source(first.start, self.last.end)
        readings = (f"({above}/{below})*{beside}", f"{above}/({below}*{beside})")
        hint = f"write `{readings[0]}` or `{readings[1]}`"
        start, end = self.columns[first.start], self.columns[self.last.end]
        column = self.columns[token.start]
        raise AmbiguousError(f"`{whole}` can be read in two ways", column, hint, readings, (start, end))

    def ask_number(self, token: Token) -> NoReturn:
        """A number right after a factor: a product, a power or an index?"""
        before, number = self.last, self.source(token.start, token.end)
        if before.kind == "number":
            self.fail("two numbers stand side by side", token, "write the sign between them")
        left = self.source(before.start, before.end) if before.kind in ("value", "motion") else "(...)"
        hint = f"write `{left}*{number}` or `{left}^{number}`"
        self.fail(f"the number {number} stands right after `{left}`", token, hint)

    def factor(self) -> Expr:
        """A power with any signs before it."""
        negative = False
        signs = 0
        while (token := self.tokens[self.at]).kind in ("-", "+"):
            negative ^= token.kind == "-"
            signs += 1
            if signs + self.depth > MAX_DEPTH:
                self.fail(f"more than {MAX_DEPTH} signs stand in a row", token, "write one sign")
            self.at += 1
        found = self.power()
        return mul(MINUS_ONE, found) if negative else found

    def power(self) -> Expr:
        """A primary, perhaps raised to a power; `x^y^z` is x^(y^z)."""
        base = self.primary()
        token = self.tokens[self.at]
        if token.kind == "superscript":
            self.at += 1
            if self.next.kind in ("^", "superscript"):
                self.fail("a power is raised to another power here", self.next, "write parentheses")
            return self.raise_to(base, num(token.amount), token)
        if token.kind != "^":
            return base
        self.at += 1
        self.deeper(token)
        exponent = self.factor()
        self.depth -= 1
        return self.raise_to(base, exponent, token)

    def raise_to(self, base: Expr, exponent: Expr, token: Token) -> Expr:
        """``base^exponent`` within the bounds."""
        self.domain |= dict.fromkeys(of_power(base, exponent))
        try:
            return raised(base, exponent)
        except UndefinedError as fault:
            self.fail(fault.message, token, fault.hint)
