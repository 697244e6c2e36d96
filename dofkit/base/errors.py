"""Errors: faults of an input, each with its location and a hint, and expressions without a value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from dofkit.base.display import panel_of


class DofkitError(Exception):
    """The base class of all errors that dofkit raises on purpose.

    Examples
    --------
    >>> import dofkit
    >>> try:
    ...     dofkit.classify("no-such-scene")
    ... except dofkit.DofkitError as error:
    ...     print(type(error).__name__)
    SceneError
    """

    def _render_traceback_(self) -> list[str]:
        """Return the lines that IPython shows instead of a traceback."""
        return panel_of(self)


class ArgumentError(DofkitError, TypeError, ValueError):
    """An argument that a function does not accept: the message says what it was, and what is accepted.

    It is also a TypeError and a ValueError.
    """


class TextError(DofkitError):
    """A mathematical text that cannot be read.

    Attributes
    ----------
    message, column, hint
        What is wrong; where in the text, counted from 1; and what to write instead.

    Examples
    --------
    >>> error = TextError("a term is missing", 3, "write one after the sign")
    >>> str(error), error.column
    ('a term is missing', 3)
    """

    def __init__(self, message: str, column: int | None = None, hint: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.column = column
        self.hint = hint


@dataclass(frozen=True)
class Fault:
    """One fault of an input: what is wrong, its location, and what to do next.

    ``where`` is the path of keys and list positions from the top of the scene, ``line`` and
    ``column`` count from 1 (None for input without lines, such as a Python mapping). ``see`` is a word that
    `dofkit explain` explains.

    >>> print(Fault("`dz` is not declared", ("constraints", 0, "text")))
    constraints[0]: `dz` is not declared
    """

    message: str
    where: tuple[str | int, ...] = ()
    line: int | None = None
    column: int | None = None
    hint: str | None = None
    see: str | None = None

    def __str__(self) -> str:
        location = f"{self.location}: " if self.location else ""
        return location + self.message + (f" ({self.hint})" if self.hint else "")

    @property
    def location(self) -> str:
        """Line and column as text, else the path; that of a constraint's ``text`` ends with the constraint."""
        if self.line is not None:
            return f"line {self.line}, column {self.column}"
        keys = self.where[:-1] if self.where[-1:] == ("text",) else self.where
        return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in keys).removeprefix(".")


class FaultsError(DofkitError):
    """An input that cannot be used, with all its faults at once."""

    def __init__(self, faults: tuple[Fault, ...], source: str | None = None) -> None:
        super().__init__(faults, source)
        self.faults = faults
        self.source = source

    def __str__(self) -> str:
        return "\n".join(map(str, self.faults))


class SceneError(FaultsError):
    r"""An input that is not a scene.

    Attributes
    ----------
    faults
        All faults at once, in the order of the file: with ``message``, ``where``, ``line``, ``column`` and ``hint``.
    source
        The name of the input.

    Examples
    --------
    >>> import dofkit
    >>> try:
    ...     dofkit.loads("coordinates: [x]\nconstraints: [y = 1]")
    ... except dofkit.SceneError as error:
    ...     fault = error.faults[0]
    >>> fault.message, fault.line, fault.column, fault.where
    ('`y` is not declared', 2, 15, ('constraints', 0, 'text'))
    """


class NoValueError(DofkitError, ArithmeticError):
    """An expression or exact arithmetic has no value at a point; `dofkit.exact.ring.program` defines more reasons."""

    reason: ClassVar[str] = "an expression has no value here"

    def __init__(self, message: str = "") -> None:
        super().__init__(message or self.reason)


class PoleError(NoValueError, ZeroDivisionError):
    """A division by zero: by a number, by a polynomial, or by a matrix that is singular."""

    reason = "division by zero"
