"""The grammar: tokens -> expressions, by precedence climbing.

Most rules depend on more than the kind of the next token, as an LALR table (lark) does: on what a name means (``x(t)``,
``dx/dt``), on the space around a sign (``sin theta/2``), on what was read just before (``1/2x``); and each ambiguous
text has its own message. So the rules are the methods below, from loosest to tightest:

    relation  sum (sign sum)*          sum      term (+|- term)*
    term      factor (*|/ factor | factor written side by side)*
    factor    (+|-)* power             power    primary (^ factor | superscript)?
    primary   number, name, group, |..|, or an application: root, fraction, function, derivative
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, NoReturn, cast

from dofkit.base.errors import TextError
from dofkit.expressions.calculus import is_differential, over_dt
from dofkit.expressions.real_values import Comparison, RelationSign, Requirement, bounded, inverse, of_power, raised
from dofkit.expressions.text.characters import FRACTION_MARK, MAX_DEPTH
from dofkit.expressions.text.names import AmbiguousError, Names, derivative, unknown_name
from dofkit.expressions.text.tokens import Token, Tokens
from dofkit.expressions.tree import DT, MINUS_ONE, PI, TIME, ZERO, E, Expr, add, fn, mul, num

#: The kinds of tokens that may begin the next factor of a product that is written without a sign.
STARTS = frozenset({"value", "motion", "function", "call", "operator", "(", "|", "frac", "root"})
_PAIRS = {"(": ")", "[": "]", "{": "}"}


_OPEN = frozenset("(+-*/^,|") | {"relation"}


class TextReader:
    """Moves through the tokens of one text; ``domain`` collects the conditions under which it has a real value."""

    def __init__(self, tokens: Tokens, names: Names) -> None:
        self.tokens, self.text, self.columns = tokens
        self.names = names
        self.at = 0
        self.depth = 0
        self.bars = 0
        self.domain: dict[Requirement, None] = {}

    @property
    def next(self) -> Token:
        """The token that comes next."""
        return self.tokens[self.at]

    @property
    def last(self) -> Token:
        """The token that was taken last."""
        return self.tokens[self.at - 1]

    def comes(self, kind: str) -> bool:
        """Return whether a token of this kind follows."""
        return any(token.kind == kind for token in self.tokens[self.at :])

    def take(self) -> Token:
        """Return the next token and move past it."""
        token = self.tokens[self.at]
        self.at += 1
        return token

    def source(self, start: int, end: int) -> str:
        """Return the characters from ``start`` to ``end`` of the folded text."""
        return self.text[start:end].strip().replace(FRACTION_MARK, "\\frac")

    def fail(self, message: str, token: Token, hint: str | None) -> NoReturn:
        """Raise a TextError at ``token``."""
        raise TextError(message, self.columns[token.start], hint)

    def deeper(self, token: Token) -> None:
        """Enter one more level of nesting; raise TextError at ``token`` beyond `MAX_DEPTH` levels."""
        self.depth += 1
        if self.depth > MAX_DEPTH:
            message = f"this text is nested more than {MAX_DEPTH} levels deep"
            self.fail(message, token, "write it with fewer parentheses")

    def computed(
        self, token: Token, operation: Callable[..., Expr], *arguments: Any, needs: Iterable[Requirement] = ()
    ) -> Expr:
        """Return ``operation(*arguments)``, with ``needs`` added to the domain; a TextError is raised at ``token``."""
        self.domain |= dict.fromkeys(needs)
        try:
            return operation(*arguments)
        except TextError as fault:
            self.fail(fault.message, token, fault.hint)

    def check_allowed(self, e: Expr, token: Token) -> None:
        """Raise TextError at ``token`` if ``e`` is time, a velocity or an acceleration and not allowed here."""
        what = self.names.kind_refused(e)
        if what is not None:
            written = self.source(token.start, self.last.end)
            self.fail(f"`{written}` is {what}, which cannot be used here", token, f"write it without {what}")

    def unexpected(self, token: Token) -> NoReturn:
        """Raise TextError that says why ``token`` cannot stand where it does."""
        kind = token.kind
        if kind == "end" and len(self.tokens) == 1:
            self.fail("the text is empty", token, "write an equation, such as `x^2 + y^2 = L^2`")
        before = self.tokens[self.tokens.index(token) - 1] if token.start else token
        if kind == "end":
            message = f"something is missing after `{self.source(before.start, before.end)}`"
            self.fail(message, token, "complete the expression")
        if kind == ")":
            sign = self.text[token.start]
            missing = before.kind in _OPEN
            message = f"something is missing before this `{sign}`" if missing else f"this `{sign}` closes nothing"
            self.fail(message, token, "check the parentheses")
        if kind == ",":
            self._unexpected_comma(token)
        if kind == "prime":
            hint = "a prime follows the name of a coordinate or of a declared function; text needs no quotes"
            self.fail("a prime or quote cannot stand here", token, hint)
        if kind == "relation" and not (before.kind in _OPEN or before is token):
            self.fail(f"`{token.name}` cannot stand inside parentheses", token, "write one relation, outside them")
        hint = "write both sides" if kind == "relation" else "write a number or name"
        what = token.name if kind == "relation" else self.source(token.start, token.end)
        self.fail(f"something is missing before `{what}`", token, hint)

    def _unexpected_comma(self, token: Token) -> NoReturn:
        """Raise TextError for a comma that cannot stand: after an unknown function, between relations, in a decimal."""
        called = re.search(r"([^\W\d]\w*)\((?:[^()]|\([^()]*\))*$", self.text[: token.start])
        if called is not None and self.names.lookup.meaning(called[1]) is None:
            raise unknown_name(called[1], self.names.lookup, self.columns[called.start()], True)
        index = self.tokens.index(token)
        if all(any(t.kind == "relation" for t in side) for side in (self.tokens[:index], self.tokens[index:])):
            first, second = self.source(0, token.start), self.source(token.end, len(self.text))
            hint = f"give each its own text: `{first}` and `{second}`"
            self.fail("this comma separates two relations, and a text holds one", token, hint)
        hint = "write decimals with a point, and one relation for each component of a vector"
        self.fail("a comma cannot stand here", token, hint)


class Parser(TextReader):
    """Reads a text; ``applications`` maps a kind of token, such as a function's name, to what reads its arguments."""

    def __init__(
        self, tokens: Tokens, names: Names, applications: Mapping[str, Callable[[Parser, Token], Expr]]
    ) -> None:
        super().__init__(tokens, names)
        self.applications = applications

    # Relations and sums

    def relations(self) -> tuple[Comparison, ...]:
        """Return the relations of the text: one, or several of a chain such as 0 <= x <= L; a value e means e = 0."""
        first = self.next
        left_side = self.computed(first, bounded, self.sum())
        token = self.take()
        comparisons = list[Comparison]()
        while token.kind == "relation":
            right = self.computed(token, bounded, self.sum())
            comparisons.append(Comparison(left_side, cast(RelationSign, token.name), right, self.columns[token.start]))
            left_side, token = right, self.take()
        if token.kind != "end":
            self.unexpected(token)
        comparisons = comparisons or [Comparison(left_side, "=", ZERO, self.columns[first.start])]
        return tuple(replace(c, domain=tuple(self.domain)) for c in comparisons)

    def value(self) -> Expr:
        """Read the whole text and return its value. Raises TextError if there is a relation in it."""
        e = self.computed(self.tokens[0], bounded, self.sum())
        token = self.next
        if token.kind == "relation":
            self.fail(f"a value is needed here, and `{token.name}` makes a relation", token, "write one side only")
        if token.kind != "end":
            self.unexpected(token)
        return e

    def sum(self) -> Expr:
        """Read terms with signs between them and return their sum."""
        self.deeper(self.next)
        terms = [self.term()]
        while (kind := self.tokens[self.at].kind) in ("+", "-"):
            self.at += 1
            term = self.term()
            terms.append(term if kind == "+" else mul(MINUS_ONE, term))
        self.depth -= 1
        return terms[0] if len(terms) == 1 else add(*terms)

    # Products

    def term(self) -> Expr:
        """Read factors, with signs between them or side by side, and return their product; `1/2 x` needs its space."""
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
                    _ask_quotient(self, first, slash)
                factors.append(self.power())
                slash = None
            elif kind == "number":
                _ask_number(self, token)
            else:
                return factors[0] if len(factors) == 1 else mul(*factors)

    def divide(self, factors: list[Expr]) -> bool:
        """Append the inverse of the next factor to ``factors``; return True for a derivative as dx/dt, read as one."""
        token = self.next
        divisor = self.factor()
        if divisor == DT:
            velocity = over_dt(factors[-1])
            if velocity is not None:
                factors[-1] = velocity
                return True
        is_unit = is_differential(divisor) and is_differential(factors[-1])
        factors.append(self.computed(token, inverse, divisor, needs=of_power(divisor, MINUS_ONE)))
        return is_unit

    # Factors and powers

    def factor(self) -> Expr:
        """Read signs and a power, and return its value."""
        negative = False
        signs = 0
        while (token := self.tokens[self.at]).kind in ("-", "+"):
            negative ^= token.kind == "-"
            signs += 1
            if signs + self.depth > MAX_DEPTH:
                self.fail(f"more than {MAX_DEPTH} signs stand in a row", token, "write one sign")
            self.at += 1
        e = self.power()
        return mul(MINUS_ONE, e) if negative else e

    def power(self) -> Expr:
        """Read a primary, perhaps raised to a power; `x^y^z` is x^(y^z), `x^2(t)` is x(t)^2."""
        base = self.primary()
        token = self.tokens[self.at]
        if token.kind == "superscript":
            self.at += 1
            if self.next.kind in ("^", "superscript"):
                self.fail("a power is raised to another power here", self.next, "write parentheses")
            exponent = num(token.amount)
        elif token.kind == "^":
            self.at += 1
            self.deeper(token)
            exponent = self.factor()
            self.depth -= 1
        else:
            return base
        ahead = self.tokens[self.at : self.at + 3]
        moves = base.op == "sym" and base.args[0] not in ("parameter", "time")
        if moves and [t.kind for t in ahead] == ["(", "value", ")"] and ahead[0].start == self.last.end:
            self.at += 3 if ahead[1].expr == TIME else 0
        return self.raise_to(base, exponent, token)

    def raise_to(self, base: Expr, exponent: Expr, token: Token) -> Expr:
        """Return ``base^exponent``, its conditions added to ``domain``. Raises TextError at ``token`` if too large."""
        return self.computed(token, raised, base, exponent, needs=of_power(base, exponent))

    # Primaries

    def primary(self) -> Expr:
        """Read a number, a name, a group or an application, and return its value."""
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
        read = self.applications.get(kind)
        if read is None:
            self.unexpected(token)
        self.at += 1
        self.deeper(token)
        e = read(self, token)
        self.depth -= 1
        return e

    def group(self) -> Expr:
        """Read a sum in parentheses, brackets or braces, and return its value."""
        return self.enclosed()[0]

    def enclosed(self, commas: bool = False) -> list[Expr]:
        """Read sums in parentheses, with commas between them if ``commas`` is True, and return their values."""
        opening = self.take()
        bars, self.bars = self.bars, 0
        sums = [self.sum()]
        while commas and self.next.kind == ",":
            self.at += 1
            sums.append(self.sum())
        self.bars = bars
        token = self.take()
        sign = self.text[opening.start]
        if token.kind == "end" or (token.kind == "relation" and not self.comes(")")):
            self.fail(f"this `{sign}` is never closed", opening, f"write `{_PAIRS[sign]}` where it ends")
        if token.kind != ")":
            self.unexpected(token)
        if self.text[token.start] != _PAIRS[sign]:
            self.fail(f"`{sign}` is closed by `{self.text[token.start]}`", token, f"write `{_PAIRS[sign]}`")
        return sums

    def bar_group(self) -> Expr:
        """Read `|x|` and return the absolute value."""
        opening = self.take()
        self.bars += 1
        inside = self.sum()
        self.bars -= 1
        token = self.take()
        if token.kind == "end" or (token.kind == "relation" and not self.comes("|")):
            self.fail("this `|` is never closed", opening, "write `|` where it ends, or `abs(...)`")
        if token.kind != "|":
            self.unexpected(token)
        return fn("abs", inside)

    def named(self, token: Token, e: Expr) -> Expr:
        """Return the value ``e`` of the name at ``token``, differentiated by the primes that follow; `x(t)` is x."""
        if self.next.kind == "prime" and self.next.start == token.end:
            e = _primed(self, token, e)
        if e.op == "sym":
            self.check_allowed(e, token)
        after = self.next
        if after.kind == "(" and e not in (TIME, PI, E, DT):
            _check_call(self, token, e, after.start == self.last.end)
        return e


def _primed(parser: Parser, token: Token, e: Expr) -> Expr:
    """Read the primes after a coordinate, and return its velocity or acceleration."""
    primes = parser.take()
    name = parser.source(token.start, token.end)
    if e.op != "sym" or e.args[0] != "coordinate":
        hint = "a prime means the time derivative of a coordinate, or the derivative of a declared function"
        parser.fail(f"`{name}` is not a coordinate, so `{name}'` has no meaning", primes, hint)
    rate = derivative(e.args[1], primes.amount)
    if rate is None:
        parser.fail("derivatives higher than the second are not read", primes, "write at most two primes")
    return rate


def _check_call(parser: Parser, token: Token, e: Expr, touching: bool) -> None:
    """Skip `(t)` after a name; raise TextError for `(2)` or `(y)` right after it, perhaps a function's argument."""
    inside, closing = parser.tokens[parser.at + 1], parser.tokens[min(parser.at + 2, len(parser.tokens) - 1)]
    if closing.kind != ")":
        return
    name, argument = parser.source(token.start, parser.last.end), parser.source(inside.start, inside.end)
    if e.op == "sym" and e.args[0] != "parameter" and inside.expr == TIME:
        parser.at += 3
    elif inside.expr == TIME:
        hint = f"write `{name}*{argument}`, or declare `{name}` under functions, with the argument t"
        parser.fail(f"`{name}` is a constant, so `{name}({argument})` has no meaning", token, hint)
    elif touching and inside.kind == "number":
        hint = f"write `{name}*{argument}`; a value at one instant cannot stand in a relation"
        parser.fail(f"`{name}({argument})` may be a product or a value at {argument}", token, hint)
    elif touching and inside.kind == "value":
        hint = f"write `{name}*{argument}`, or declare `{name}` under functions"
        parser.fail(f"`{name}({argument})` may be a product or a function", token, hint)


def _ask_quotient(parser: Parser, first: Token, slash: Token) -> NoReturn:
    """Raise AmbiguousError that asks which of its two readings `1/2x` has."""
    above = parser.source(first.start, slash.start)
    below = parser.source(slash.end, parser.last.end)
    token = parser.next
    parser.power()
    factor = parser.source(token.start, parser.last.end)
    quotient = parser.source(first.start, parser.last.end)
    readings = (f"({above}/{below})*{factor}", f"{above}/({below}*{factor})")
    hint = f"write `{readings[0]}` or `{readings[1]}`"
    span = (parser.columns[first.start], parser.columns[parser.last.end])
    column = parser.columns[token.start]
    raise AmbiguousError(f"`{quotient}` can be read in two ways", column, hint, readings, span)


def _ask_number(parser: Parser, token: Token) -> NoReturn:
    """Raise TextError for a number right after a factor, which may mean a product or a power."""
    before, number = parser.last, parser.source(token.start, token.end)
    if before.kind == "number":
        parser.fail("two numbers stand side by side", token, "write the sign between them")
    factor = parser.source(before.start, before.end) if before.kind in ("value", "motion") else "(...)"
    hint = f"write `{factor}*{number}` or `{factor}^{number}`"
    parser.fail(f"the number {number} stands right after `{factor}`", token, hint)
