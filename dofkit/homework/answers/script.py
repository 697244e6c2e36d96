"""A text that is rewritten step by step, every character keeping the column where a student wrote it."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from dofkit.base.errors import TextError

By = str | Callable[[re.Match[str]], str]


@dataclass(frozen=True)
class Script:
    """``columns``: of every character of ``text``, from 1, and of the end."""

    text: str
    columns: tuple[int, ...]

    @classmethod
    def of(cls, text: str) -> Script:
        """A text as it was written."""
        return cls(text, tuple(range(1, len(text) + 2)))

    def cut(self, start: int, end: int | None = None) -> Script:
        """The part between two places."""
        end = len(self.text) if end is None else end
        return Script(self.text[start:end], self.columns[start : end + 1])

    def stripped(self) -> Script:
        """Without the blanks around it."""
        start = len(self.text) - len(self.text.lstrip())
        return self.cut(start, max(start, len(self.text.rstrip())))

    def spliced(self, start: int, end: int, new: str) -> Script:
        """With other characters between two places; they keep the column where those began."""
        columns = (*self.columns[:start], *[self.columns[start]] * len(new), *self.columns[end:])
        return Script(self.text[:start] + new + self.text[end:], columns)

    def replaced(self, pattern: re.Pattern[str], by: By) -> Script:
        """With every match replaced; what stands for it keeps the column where the match began."""
        if pattern.search(self.text) is None:
            return self
        out: list[str] = []
        columns: list[int] = []
        place = 0
        for match in pattern.finditer(self.text):
            new = match.expand(by) if isinstance(by, str) else by(match)
            out += [self.text[place : match.start()], new]
            columns += [*self.columns[place : match.start()], *[self.columns[match.start()]] * len(new)]
            place = match.end()
        out.append(self.text[place:])
        return Script("".join(out), (*columns, *self.columns[place:]))

    def moved(self, error: TextError) -> TextError:
        """An error in this text with its column in what was written."""
        column = error.column
        if column is not None:
            column = self.columns[min(max(column - 1, 0), len(self.columns) - 1)]
        return TextError(error.message, column, error.hint)
