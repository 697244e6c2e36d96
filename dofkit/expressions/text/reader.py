"""Arithmetic within bounds, and a position among the tokens of a text with the faults that stand there."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any, NoReturn

from dofkit.base.errors import TextError
from dofkit.expressions.calculus import Requirement
from dofkit.expressions.text.characters import MAX_BITS, MAX_DEPTH, MAX_EXPONENT
from dofkit.expressions.text.names import Names
from dofkit.expressions.text.tokens import Token, Tokens
from dofkit.expressions.tree import MINUS_ONE, Expr, children, fn, mul, nodes, num, power


class UndefinedError(Exception):
    """A value that does not exist or is too large; carries the sentence and the hint."""

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint


def raised(base: Expr, exponent: Expr) -> Expr:
    """Return ``base^exponent``. Raises UndefinedError."""
    if exponent.op == "num":
        _check_power(base, exponent.args[0])
    elif base.op == "num" and base.args[0] <= 0:
        message = f"`{base.args[0]}` to a power that is no number has no real value for most exponents"
        raise UndefinedError(message, "write a positive base, or `exp(...)`")
    result = power(base, exponent)
    for part in result.args if result.op == "mul" else (result,):
        unfolded = part.op == "pow" and part.args[0].op == part.args[1].op == "num"
        if (unfolded and part.args[1].args[0].denominator == 1) or _bits(part) > MAX_BITS:
            raise UndefinedError("this power is too large a number", "write it in other units")
    return result


def _bits(e: Expr) -> int:
    """Return the bits of a number, and 0 for other expressions."""
    return max(e.args[0].numerator.bit_length(), e.args[0].denominator.bit_length()) if e.op == "num" else 0


def _check_power(base: Expr, value: Fraction) -> None:
    if abs(value.numerator) > MAX_EXPONENT or value.denominator > MAX_EXPONENT:
        message = f"this exponent is too large; at most {MAX_EXPONENT} is read"
        raise UndefinedError(message, "choose a smaller exponent")
    if base.op == "num":
        if base.is_zero and value == 0:
            raise UndefinedError("`0^0` has no value", "write the number")
        if base.is_zero and value < 0:
            raise UndefinedError("this divides by zero", "check the denominator")
        if base.args[0] < 0 and value.denominator != 1:
            raise UndefinedError("a negative number has no real root", "write a real number")
    elif abs(value) > 1 and _degree(base, {}) * abs(value) > MAX_EXPONENT:
        message = f"these nested powers multiply to more than {MAX_EXPONENT}"
        raise UndefinedError(message, "choose smaller exponents")


def _degree(e: Expr, memo: dict[Expr, Fraction]) -> Fraction:
    """Return the largest product of nested constant exponents in ``e``."""
    if e not in memo:
        memo[e] = max((_degree(child, memo) for child in children(e)), default=Fraction(1))
        if e.op == "pow" and e.args[1].op == "num":
            memo[e] *= max(Fraction(1), abs(e.args[1].args[0]))
    return memo[e]


def inverse(divisor: Expr) -> Expr:
    """Return ``1/divisor``. Raises UndefinedError for zero."""
    if divisor.is_zero:
        raise UndefinedError("this divides by zero", "check the denominator")
    return power(divisor, MINUS_ONE)


def applied(name: str, *arguments: Expr) -> Expr:
    """Return the value of an elementary function. Raises UndefinedError where it does not exist."""
    first = arguments[0]
    if name == "sqrt":
        return raised(first, num(Fraction(1, 2)))
    if first.op == "num":
        value: Fraction = first.args[0]
        undefined = (
            (name == "log" and value <= 0)
            or (name in ("asin", "acos") and abs(value) > 1)
            or (name in ("cot", "csc") and value == 0)
            or (name == "atan2" and value == 0 and arguments[1].is_zero)
        )
        if undefined:
            where = ", ".join(str(e.args[0]) if e.op == "num" else "..." for e in arguments)
            raise UndefinedError(f"`{name}` has no real value at {where}", "check its argument")
    return fn(name, *arguments)


def product(factors: list[Expr]) -> Expr:
    """Return the product of ``factors``."""
    return factors[0] if len(factors) == 1 else mul(*factors)


def bounded(e: Expr) -> Expr:
    """Return ``e``. Raises UndefinedError where a number or a power in it has grown too large."""
    for node in nodes(e):
        if _bits(node) > MAX_BITS:
            raise UndefinedError("the numbers in this text multiply to one too large", "choose other units")
        if node.op == "pow" and node.args[1].op == "num" and abs(node.args[1].args[0].numerator) > MAX_EXPONENT:
            message = f"the powers in this text multiply to more than {MAX_EXPONENT}"
            raise UndefinedError(message, "choose smaller exponents")
    return e


_OPEN = frozenset("(+-*/^,|") | {"relation"}


class TextReader:
    """Moves through the tokens of one text; ``domain`` collects where the text, as it was written, has a value."""

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

    def take(self) -> Token:
        """Return the next token and move past it."""
        token = self.tokens[self.at]
        self.at += 1
        return token

    def source(self, start: int, end: int) -> str:
        """Return what the person wrote there."""
        return self.text[start:end].strip()

    def fail(self, message: str, token: Token, hint: str) -> NoReturn:
        """Raise a TextError at ``token``."""
        raise TextError(message, self.columns[token.start], hint)

    def deeper(self, token: Token) -> None:
        """Count one more level of nesting."""
        self.depth += 1
        if self.depth > MAX_DEPTH:
            message = f"this text is nested more than {MAX_DEPTH} levels deep"
            self.fail(message, token, "write it with fewer parentheses")

    def computed(
        self, token: Token, operation: Callable[..., Expr], *arguments: Any, needs: Iterable[Requirement] = ()
    ) -> Expr:
        """Return what an operation gives, whose domain ``needs`` is kept; a fault stands at ``token``."""
        self.domain |= dict.fromkeys(needs)
        try:
            return operation(*arguments)
        except UndefinedError as fault:
            self.fail(fault.message, token, fault.hint)

    def check_allowed(self, e: Expr, token: Token) -> None:
        """Refuse time, velocities or accelerations where the names do not allow them."""
        kind, names = e.args[0], self.names
        if kind == "acceleration" and not names.allow_accelerations:
            what = "an acceleration"
        elif kind in ("velocity", "differential", "dt") and not names.allow_velocities:
            what = "a velocity or differential"
        elif kind in ("time", "dt") and not names.allow_time:
            what = "time"
        else:
            return
        written = self.source(token.start, self.last.end)
        self.fail(f"`{written}` is {what}, which cannot be used here", token, f"write it without {what}")

    def unexpected(self, token: Token) -> NoReturn:
        """Say why ``token`` cannot stand where it does."""
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
        """Say why a comma cannot stand where it does: between two relations, or in a decimal."""
        index = self.tokens.index(token)
        if all(any(t.kind == "relation" for t in side) for side in (self.tokens[:index], self.tokens[index:])):
            first, second = self.source(0, token.start), self.source(token.end, len(self.text))
            hint = f"give each its own text: `{first}` and `{second}`"
            self.fail("this comma separates two relations, and a text holds one", token, hint)
        hint = "write decimals with a point; a comma stands between the arguments of a function"
        self.fail("a comma cannot stand here", token, hint)
