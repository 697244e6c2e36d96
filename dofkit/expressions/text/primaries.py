"""The smallest parts of the grammar: numbers, names with their primes, groups, bars and applications."""

from __future__ import annotations

from dofkit.expressions.text import applications
from dofkit.expressions.text.names import derivative
from dofkit.expressions.text.reader import TextReader
from dofkit.expressions.text.tokens import Token
from dofkit.expressions.tree import DT, PI, TIME, E, Expr, fn

_PAIRS = {"(": ")", "[": "]", "{": "}"}


class PrimaryReader(TextReader):
    """Reads what stands between signs."""

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
            hint = "a prime means the time derivative of a coordinate, or the derivative of a declared function"
            self.fail(f"`{name}` is not a coordinate, so `{name}'` has no meaning", primes, hint)
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
        self.fail(f"`{shown}` is {what}, which cannot be used here", token, f"write it without {what}")

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
            hint = f"write `{name}*{shown}`; a value at one instant cannot stand in a relation"
            self.fail(f"`{name}({shown})` may be a product or a value at {shown}", token, hint)
        elif touching and inside.kind == "value":
            hint = f"write `{name}*{shown}`, or declare `{name}` under functions"
            self.fail(f"`{name}({shown})` may be a product or a function", token, hint)
