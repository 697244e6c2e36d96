"""Answers as they were typed: what a person sees who looks at one, and the place in it where reading stopped."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from dofkit.base.errors import TextError
from dofkit.homework.judgement import Given
from dofkit.scene.fields import as_written

#: Characters of an answer that are shown; and what stands between the parts of a list.
MOST_SHOWN = 2000
_BETWEEN = "; "


def typed_text(answer: Given) -> str:
    """An answer as one text; the parts of a list have semicolons between them.

    >>> typed_text("f = 2 "), typed_text(Fraction(1, 2)), typed_text(("x", ("y", 3)))
    ('f = 2 ', '0.5', 'x; y; 3')
    """
    if isinstance(answer, str):
        return answer
    if isinstance(answer, Fraction):
        return as_written(answer)
    if isinstance(answer, bool | int | float):
        return str(answer)
    return _BETWEEN.join(typed_text(part) for part in answer)


def shown_text(answer: Given) -> str:
    """The same, of which a person sees at most so many characters."""
    text = typed_text(answer)
    return text if len(text) <= MOST_SHOWN else text[: MOST_SHOWN - 3] + "..."


def in_whole(answer: Given, error: TextError, read: Callable[[Given], object]) -> TextError:
    """An error with its column in the text that is shown: of a list it is that of a part, which ``read`` tells."""
    if isinstance(answer, str | bool | int | float | Fraction) or len(answer) < 2:
        return error
    place = 0
    for part in answer:
        try:
            read(part)
        except TextError as found:
            if (found.message, found.column) == (error.message, error.column):
                return TextError(error.message, place + (error.column or 1), error.hint)
        place += len(typed_text(part)) + len(_BETWEEN)
    return error
