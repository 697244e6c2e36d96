"""A place in a text: moving through its tokens, and what the parts of the grammar ask of each other."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NoReturn

from dofkit.base.errors import TextError
from dofkit.expressions.domains import Requirement
from dofkit.expressions.text.limits import MAX_DEPTH
from dofkit.expressions.text.names import Names
from dofkit.expressions.text.tokens import Token, Tokens
from dofkit.expressions.tree import Expr

_OPEN = frozenset("(+-*/^,|") | {"relation"}


class TextReader(ABC):
    """Reads one text; every method takes the tokens it needs from where the last one stopped."""

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
            self.fail(
                f"this text is nested more than {MAX_DEPTH} levels deep", token, "write it with fewer parentheses"
            )

    def unexpected(self, token: Token) -> NoReturn:
        """Say why ``token`` cannot stand where it does."""
        kind = token.kind
        if kind == "end" and len(self.tokens) == 1:
            self.fail("the text is empty", token, "write an equation, such as `x^2 + y^2 = L^2`")
        before = self.tokens[self.tokens.index(token) - 1] if token.start else token
        shown = self.source(before.start, before.end)
        if kind == "end":
            self.fail(f"something is missing after `{shown}`", token, "complete the expression")
        if kind == ")":
            message = "something is missing before this `)`" if before.kind in _OPEN else "this `)` closes nothing"
            self.fail(message.replace(")", self.text[token.start]), token, "check the parentheses")
        if kind == ",":
            self.unexpected_comma(token)
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

    def unexpected_comma(self, token: Token) -> NoReturn:
        """Say why a comma cannot stand where it does: between two relations, or in a decimal."""
        place = self.tokens.index(token)
        if all(any(t.kind == "relation" for t in side) for side in (self.tokens[:place], self.tokens[place:])):
            first, second = self.source(0, token.start), self.source(token.end, len(self.text))
            hint = f"give each its own text: `{first}` and `{second}`"
            self.fail("this comma separates two relations, and a text holds one", token, hint)
        hint = "write decimals with a point; a comma stands between the arguments of a function"
        self.fail("a comma cannot stand here", token, hint)

    # The parts of the grammar

    @abstractmethod
    def sum(self) -> Expr:
        """Terms with signs between them."""

    @abstractmethod
    def power(self) -> Expr:
        """A primary, perhaps raised to a power."""

    @abstractmethod
    def raise_to(self, base: Expr, exponent: Expr, token: Token) -> Expr:
        """``base^exponent`` within the bounds."""

    @abstractmethod
    def primary(self) -> Expr:
        """A number, name, group or application."""

    @abstractmethod
    def group(self) -> Expr:
        """A sum in parentheses, brackets or braces."""

    @abstractmethod
    def close(self, opening: Token) -> None:
        """Take the parenthesis that closes ``opening``."""

    @abstractmethod
    def check_allowed(self, found: Expr, token: Token) -> None:
        """Refuse time, velocities or accelerations where the names do not allow them."""
