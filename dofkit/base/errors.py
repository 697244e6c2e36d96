"""What can go wrong: faults of what a person gave, each with its place and a hint, and what has no value."""

from __future__ import annotations

from typing import ClassVar

from dofkit.base.records import dataclass


class DofkitError(Exception):
    """The base of every error that dofkit raises on purpose.

    >>> import dofkit
    >>> try:
    ...     dofkit.classify("no-such-scene")
    ... except dofkit.DofkitError as error:
    ...     print(type(error).__name__)
    SceneError
    """


class ArgumentError(DofkitError, TypeError, ValueError):
    """A function was given what it does not take: the message says what that was, and what is taken.

    It is a TypeError and a ValueError too, for those who expect one.
    """


class TextError(DofkitError):
    """A mathematical text that cannot be read.

    ``column`` counts from 1 within the text; ``hint`` says what to write instead.

    >>> error = TextError("a term is missing", 3, "write one after the sign")
    >>> str(error), error.column
    ('a term is missing', 3)
    """

    def __init__(self, message: str, column: int | None = None, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.column = column
        self.hint = hint

    def __reduce__(self) -> tuple[type[TextError], tuple[str, int | None, str | None]]:
        return (TextError, (self.message, self.column, self.hint))


@dataclass(frozen=True)
class Fault:
    """One fault of an input: what was asked, what was found, where, and what to do next.

    ``where`` is the path of keys and list positions from the top of the scene, ``line`` and
    ``column`` count from 1 (None where the input has no lines, such as a Python mapping).
    """

    message: str
    where: tuple[str | int, ...] = ()
    line: int | None = None
    column: int | None = None
    hint: str | None = None

    def __str__(self) -> str:
        place = f"line {self.line}, column {self.column}: " if self.line is not None else ""
        return place + self.message + (f" ({self.hint})" if self.hint else "")


class SceneError(DofkitError):
    """An input that is not a scene: all its ``faults`` at once, in the order of the file; ``source`` names it.

    >>> import dofkit
    >>> try:
    ...     dofkit.loads("coordinates: [x]\\nconstraints: [y = 1]")
    ... except dofkit.SceneError as error:
    ...     fault = error.faults[0]
    >>> fault.message, fault.line, fault.column, fault.where
    ('`y` is not declared', 2, 15, ('constraints', 0, 'text'))
    """

    def __init__(self, faults: tuple[Fault, ...], source: str | None = None) -> None:
        self.faults = faults
        self.source = source
        super().__init__("\n".join(str(fault) for fault in faults))

    def __reduce__(self) -> tuple[type[SceneError], tuple[tuple[Fault, ...], str | None]]:
        return (SceneError, (self.faults, self.source))


class NoValueError(DofkitError, ArithmeticError):
    """An expression or exact arithmetic has no value here; `dofkit.exact.errors` tells the other reasons."""

    reason: ClassVar[str] = "an expression has no value here"

    def __init__(self, message: str = "") -> None:
        super().__init__(message or self.reason)


class PoleError(NoValueError, ZeroDivisionError):
    """A division by zero: by a number, by a polynomial, or by a matrix that is singular."""

    reason = "division by zero"
