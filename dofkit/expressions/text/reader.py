"""A position in a text: the tokens one after another, and the faults that a reader of them meets."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NoReturn

from dofkit.base.errors import TextError
from dofkit.expressions.domains import Requirement
from dofkit.expressions.text.bounds import MAX_DEPTH, UndefinedError
from dofkit.expressions.text.names import Names
from dofkit.expressions.text.tokens import Token, Tokens
from dofkit.expressions.tree import Expr

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
