"""Tokens: a text as numbers, words and signs, bounded."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import NamedTuple

from dofkit.checker.errors import CheckError
from dofkit.checker.trees import ONE, Tree, number
from dofkit.checker.words import DOT, GREEK, KnownNames

MOST_CHARACTERS = 20_000
MOST_DIGITS = 400
LARGEST_POWER = 1000
#: Digits of all numbers of a text together.
MOST_DIGITS_IN_ALL = 12_000

_PLAIN = str.maketrans({
    **dict(zip("ȧḃċḋėḟġḣṁṅȯṗṙṡṫẇẋẏż", (f"{c}{DOT}" for c in "abcdefghmnoprstwxyz"), strict=True)),
    **dict.fromkeys("−–", "-"), **dict.fromkeys("·⋅×", "*"), "≤": "<=", "≥": ">=", **dict.fromkeys("′’", "'"),
    "\u00a0": " ", "\u2009": " ",
})  # fmt: skip
_LETTERS = "A-Za-z" + "".join(GREEK)
_TOKEN = re.compile(
    rf"(?P<space>[ \t]+)|(?P<word>[{_LETTERS}][{_LETTERS}0-9_{DOT}]*)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,6})?(?!_))|(?P<relation><=|>=|==?|[<>])(?![=<>])"
    r"|(?P<sign>\*\*(?!\*)|/(?!/)|[-+*^(),\[\]{}])|(?P<raised>[²³])|(?P<prime>'+)",
    re.ASCII,
)
_ALIKE = {"**": "^", "==": "=", "[": "(", "{": "(", "]": ")", "}": ")"}


class Lexeme(NamedTuple):
    """``kind``: ``number``, ``raised`` (a superscript), ``prime``, ``relation``, ``end``, that of a meaning, or a sign.

    A token touches the one before it where no space stands between: ``touching``.
    """

    kind: str
    touching: bool = False
    tree: Tree = ONE
    name: str = ""


def tokens_of(text: str, names: KnownNames) -> list[Lexeme]:
    """The tokens of a text, closed by one of kind ``end``."""
    if not isinstance(text, str) or len(text) > MOST_CHARACTERS:
        raise CheckError("a text of bounded length is needed")
    text = text.strip().translate(_PLAIN)
    found: list[Lexeme] = []
    place, digits, touching = 0, 0, False
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None or digits > MOST_DIGITS_IN_ALL:
            raise CheckError(f"`{text[place : place + 12]}` cannot be read")
        place, kind, word = match.end(), match.lastgroup or "", match[0]
        if kind == "number":
            found.append(Lexeme(kind, touching, number(decimal_value(word, names))))
            digits += len(word) + abs(int(re.split("[eE]", f"{word}e0")[1]))
        elif kind == "word":
            found += [Lexeme(m.kind, touching or i > 0, m.tree, m.name) for i, m in enumerate(names.parts(word))]
        elif kind == "raised":
            found.append(Lexeme(kind, touching, number(2 if word == "²" else 3)))
        elif kind != "space":
            found.append(Lexeme(kind if kind != "sign" else _ALIKE.get(word, word), touching, ONE, word))
        touching = kind != "space"
    return [*found, Lexeme("end")]


def decimal_value(text: str, names: KnownNames | None = None) -> Fraction:
    """The exact value of a decimal, in bounded time."""
    digits, letter, power = text.replace("E", "e").partition("e")
    if letter and names is not None and ("e" if "e" in text else "E") in names.declared:
        raise CheckError(f"`{text}` may be a power of ten or hold a declared name")
    whole, _, rest = digits.partition(".")
    if len(whole) + len(rest) > MOST_DIGITS or abs(int(power or "0")) > LARGEST_POWER:
        raise CheckError("a number has too many digits")
    return Fraction(int(whole + rest), 10 ** len(rest)) * Fraction(10) ** int(power or "0")
