"""Plain scalars by the core schema of YAML 1.2, exact: a decimal is never a float."""

from __future__ import annotations

import re
from decimal import Decimal
from typing import TypeAlias

#: A number is refused beyond this power of ten, up or down, and beyond this many characters.
LARGEST_EXPONENT = 1000
LONGEST_NUMBER = 400

Scalar: TypeAlias = bool | int | Decimal | str | None

_WORDS: dict[str, Scalar] = {
    "": None, "~": None, "null": None, "Null": None, "NULL": None,
    "true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False,
}  # fmt: skip
_NUMBER = re.compile(r"[-+]?(?:(?P<int>[0-9]+)|(?:\.[0-9]+|[0-9]+\.?[0-9]*)(?:[eE](?P<exp>[-+]?[0-9]+))?)", re.ASCII)
_OTHER_BASE = re.compile(r"0o(?P<octal>[0-7]+)|0x(?P<hex>[0-9a-fA-F]+)", re.ASCII)
_NOT_FINITE = re.compile(r"[-+]?(?:\.inf|\.Inf|\.INF|Infinity)|\.nan|\.NaN|\.NAN|NaN")
_NUMERIC_START = frozenset("0123456789+-.IN")


class BadScalarError(ValueError):
    """A number that cannot be taken; ``hint`` says what to write instead."""

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint


def plain(text: str) -> Scalar:
    """The value of an unquoted scalar.

    >>> plain("1e-6"), plain("017"), plain("0o17"), plain("on"), plain("~"), plain("1_000")
    (Decimal('0.000001'), 17, 15, 'on', None, '1_000')
    """
    if text in _WORDS:
        return _WORDS[text]
    if text[0] not in _NUMERIC_START:
        return text
    if _NOT_FINITE.fullmatch(text):
        raise BadScalarError(f"a finite number is needed, not {text}", "if it is meant as a name, put it in quotes")
    match = _NUMBER.fullmatch(text)
    if match is not None:
        return _number(text, match)
    match = _OTHER_BASE.fullmatch(text)
    if match is None:
        return text
    _bound(text)
    return int(match["octal"], 8) if match["octal"] else int(match["hex"], 16)


def _number(text: str, match: re.Match[str]) -> int | Decimal:
    _bound(text)
    if match["int"]:
        return int(text)
    exponent = match["exp"] or "0"
    if abs(int(exponent)) <= LARGEST_EXPONENT:
        value = Decimal(text)
        if not value or abs(value.adjusted()) <= LARGEST_EXPONENT:
            return value
    raise BadScalarError(f"the number {_short(text)} is too large or too small", f"stay within 1e±{LARGEST_EXPONENT}")


def _bound(text: str) -> None:
    if len(text) > LONGEST_NUMBER:
        message = f"the number {_short(text)} has {len(text)} characters"
        raise BadScalarError(message, f"write a number in at most {LONGEST_NUMBER} characters")


def _short(text: str) -> str:
    return text if len(text) <= 24 else text[:20] + "..."


def joined(text: str) -> str | None:
    """``text`` with pairs of surrogates (JSON's way to escape rare characters) joined; None where one stands alone."""
    if not any("\ud800" <= char <= "\udfff" for char in text):
        return text
    try:
        return text.encode("utf-16", "surrogatepass").decode("utf-16")
    except UnicodeDecodeError:
        return None
