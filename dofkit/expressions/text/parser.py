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

from dataclasses import dataclass
from typing import Literal, NoReturn, cast

from dofkit.base.errors import TextError
from dofkit.expressions.text import applications
from dofkit.expressions.text.arithmetic import UndefinedError, check_numbers, inverse, product, raised
from dofkit.expressions.text.derivatives import is_differential, over_dt
from dofkit.expressions.text.limits import MAX_DEPTH
from dofkit.expressions.text.names import Names, derivative
from dofkit.expressions.text.tokens import Token, Tokens
from dofkit.expressions.tree import DT, MINUS_ONE, PI, TIME, ZERO, E, Expr, add, fn, mul, num

RelationSign = Literal["=", "<=", ">=", "<", ">"]
#: The kinds of tokens that begin a factor which may stand right after another one.
STARTS = frozenset({"value", "motion", "function", "call", "operator", "(", "|", "frac", "root"})
_OPEN = frozenset("(+-*/^,|") | {"relation"}
_PAIRS = {"(": ")", "[": "]", "{": "}"}


@dataclass(frozen=True)
class Comparison:
    """One relation; ``column`` is where its sign stands (where the text begins, if it has none)."""

    left: Expr
    relation: RelationSign
    right: Expr
    column: int


class Parser:
    """Reads one text; every method takes the tokens it needs from where the last one stopped."""

    def __init__(self, tokens: Tokens, names: Names) -> None:
        self.tokens, self.text, self.columns = tokens
        self.names = names
        self.at = 0
        self.depth = 0
        self.bars = 0

    # Moving through the tokens

    @property
    def next(self) -> Token:
        """The token that comes next."""
        return self.tokens[self.at]

    @property
    def last(self) -> Token:
        """The token that was taken last."""
        return self.tokens[self.at - 1]

    def take(self) -> Token:
        """Take the next token."""
        token = self.tokens[self.at]
        self.at += 1
        return token

    def source(self, start: int, end: int) -> str:
        """What the person wrote there."""
        return self.text[start:end].strip()

    def fail(self, message: str, token: Token, hint: str) -> NoReturn:
        """Raise a TextError at ``token``."""
        raise TextError(message, self.columns[token.start], hint)

    def deeper(self, token: Token) -> None:
        """Count one more level of nesting."""
        self.depth += 1
        if self.depth > MAX_DEPTH:
            self.fail(f"this is nested more than {MAX_DEPTH} deep", token, "write it with fewer parentheses")

    # Relations and sums

    def relations(self) -> tuple[Comparison, ...]:
        """The whole text: a value, a relation or a chain of them."""
        first = self.next
        left = self.bounded(self.sum(), first)
        token = self.take()
        found = []
        if token.kind == "end":
            return (Comparison(left, "=", ZERO, self.columns[first.start]),)
        while token.kind == "relation":
            right = self.bounded(self.sum(), token)
            found.append(Comparison(left, cast(RelationSign, token.name), right, self.columns[token.start]))
            left, token = right, self.take()
        if token.kind != "end":
            self.unexpected(token)
        return tuple(found)

    def value(self) -> Expr:
        """The whole text as one value."""
        found = self.bounded(self.sum(), self.tokens[0])
        token = self.next
        if token.kind == "relation":
            self.fail(f"a value is asked for, and `{token.name}` makes a relation", token, "write one side only")
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
        """Factors with signs between them or side by side."""
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
                if slash is not None:
                    self.ask_quotient(first, slash)
                factors.append(self.power())
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
        except UndefinedError as fault:
            self.fail(fault.message, token, fault.hint)
        return unit

    def ask_quotient(self, first: Token, slash: Token) -> NoReturn:
        """`1/2x`: which of the two?"""
        token = self.next
        above = self.source(first.start, slash.start)
        below = self.source(slash.end, self.last.end)
        self.power()
        beside = self.source(token.start, self.last.end)
        whole = self.source(first.start, self.last.end)
        hint = f"write `({above}/{below})*{beside}` or `{above}/({below}*{beside})`"
        self.fail(f"`{whole}` can be read in two ways", token, hint)

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
                self.fail("one power stands on another here", self.next, "write parentheses")
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
        try:
            return raised(base, exponent)
        except UndefinedError as fault:
            self.fail(fault.message, token, fault.hint)

    # The smallest parts

    def primary(self) -> Expr:
        """A number, name, group or application."""
        token = self.tokens[self.at]
        kind = token.kind
        if kind == "number" and token.expr is not None:
            self.at += 1
            return token.expr
        if kind in ("value", "motion") and token.expr is not None:
            self.at += 1
            return self.named(token, token.expr)
        if kind == "(":
            return self.group()
        if kind == "|":
            return self.bar_group()
        read = applications.READERS.get(kind)
        if read is None:
            self.unexpected(token)
        self.at += 1
        self.deeper(token)
        found = read(self, token)
        self.depth -= 1
        return found

    def group(self) -> Expr:
        """A sum in parentheses, brackets or braces."""
        opening = self.take()
        bars, self.bars = self.bars, 0
        found = self.sum()
        self.bars = bars
        self.close(opening)
        return found

    def close(self, opening: Token) -> None:
        """Take the parenthesis that closes ``opening``."""
        token = self.take()
        sign = self.text[opening.start]
        if token.kind == "end":
            self.fail(f"this `{sign}` is never closed", opening, f"write `{_PAIRS[sign]}` where it ends")
        if token.kind != ")":
            self.unexpected(token)
        if self.text[token.start] != _PAIRS[sign]:
            self.fail(f"`{sign}` is closed by `{self.text[token.start]}`", token, f"write `{_PAIRS[sign]}`")

    def bar_group(self) -> Expr:
        """`|x|`, the absolute value."""
        opening = self.take()
        self.bars += 1
        found = self.sum()
        self.bars -= 1
        token = self.take()
        if token.kind == "end":
            self.fail("this `|` is never closed", opening, "write `|` where it ends, or `abs(...)`")
        if token.kind != "|":
            self.unexpected(token)
        return fn("abs", found)

    def named(self, token: Token, found: Expr) -> Expr:
        """A name with its primes, and `x(t)` for x."""
        if self.next.kind == "prime" and self.next.start == token.end:
            found = self.primed(token, found)
        if found.op == "sym":
            self.check_allowed(found, token)
        after = self.next
        if after.kind == "(" and found not in (TIME, PI, E, DT):
            self.check_call(token, found, after.start == self.last.end)
        return found

    def primed(self, token: Token, found: Expr) -> Expr:
        """`x'` and `x''`."""
        primes = self.take()
        name = self.source(token.start, token.end)
        if found.op != "sym" or found.args[0] != "coordinate":
            hint = "a prime means the derivative of a coordinate by time or of a declared function"
            self.fail(f"`{name}` is no coordinate, so `{name}'` has no meaning", primes, hint)
        moved = derivative(found.args[1], primes.amount)
        if moved is None:
            self.fail("derivatives higher than the second are not read", primes, "write at most two primes")
        return moved

    def check_allowed(self, found: Expr, token: Token) -> None:
        """Refuse time, velocities or accelerations where the names do not allow them."""
        kind, names = found.args[0], self.names
        if kind == "acceleration" and not names.allow_accelerations:
            what = "an acceleration"
        elif kind in ("velocity", "differential", "dt") and not names.allow_velocities:
            what = "a velocity or differential"
        elif kind in ("time", "dt") and not names.allow_time:
            what = "time"
        else:
            return
        shown = self.source(token.start, self.last.end)
        self.fail(f"`{shown}` is {what}, which has no place here", token, "write it without")

    def check_call(self, token: Token, found: Expr, touching: bool) -> None:
        """After a name, `(t)` is read over; `(2)`, `(y)` right after it are questions; `(y + 1)` is a product."""
        inside, closing = self.tokens[self.at + 1], self.tokens[min(self.at + 2, len(self.tokens) - 1)]
        if closing.kind != ")":
            return
        name, shown = self.source(token.start, self.last.end), self.source(inside.start, inside.end)
        moves = found.op == "sym" and found.args[0] != "parameter"
        if moves and inside.expr == TIME:
            self.at += 3
        elif inside.expr == TIME:
            hint = f"write `{name}*{shown}`, or declare `{name}` under functions, with the argument t"
            self.fail(f"`{name}` is a constant, so `{name}({shown})` has no meaning", token, hint)
        elif touching and inside.kind == "number":
            hint = f"write `{name}*{shown}`; a value at one time is no part of a relation"
            self.fail(f"`{name}({shown})` may be a product or a value at {shown}", token, hint)
        elif touching and inside.kind == "value":
            hint = f"write `{name}*{shown}`, or declare `{name}` under functions"
            self.fail(f"`{name}({shown})` may be a product or a function", token, hint)

    def unexpected(self, token: Token) -> NoReturn:
        """Say why ``token`` cannot stand where it does."""
        kind = token.kind
        if kind == "end" and len(self.tokens) == 1:
            self.fail("the text is empty", token, "write an equation, such as `x^2 + y^2 = L^2`")
        before = self.tokens[self.tokens.index(token) - 1] if token.start else token
        shown = self.source(before.start, before.end)
        if kind == "end":
            self.fail(f"something is missing after `{shown}`", token, "write what belongs there")
        if kind == ")":
            message = "something is missing before this `)`" if before.kind in _OPEN else "this `)` closes nothing"
            self.fail(message.replace(")", self.text[token.start]), token, "check the parentheses")
        if kind == ",":
            hint = "write decimals with a point; a comma stands between the arguments of a function"
            self.fail("a comma cannot stand here", token, hint)
        if kind == "prime":
            hint = "a prime follows the name of a coordinate or of a declared function; text needs no quotes"
            self.fail("a prime or quote cannot stand here", token, hint)
        if kind == "relation":
            if before.kind in _OPEN or before is token:
                self.fail(f"something is missing before `{token.name}`", token, "write both sides")
            self.fail(f"`{token.name}` cannot stand inside parentheses", token, "write one relation, outside them")
        self.fail(
            f"something is missing before `{self.source(token.start, token.end)}`", token, "write a number or name"
        )
