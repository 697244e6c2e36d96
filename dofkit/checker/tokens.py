"""Tokens: a text as numbers, words and signs, bounded."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import NamedTuple

from dofkit.checker.errors import CheckError
from dofkit.checker.trees import ONE, Tree, number
from dofkit.checker.words import DOT, GREEK, TWO_DOTS, VARIANTS, KnownNames

MOST_CHARACTERS = 20_000
MOST_TOKENS = 6_000
MOST_DIGITS = 400
MOST_BITS = 40_000
LARGEST_EXPONENT = 64

_SUPERSCRIPTS = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-", strict=True))
_SUBSCRIPTS = dict(zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True))
_HALVES = {
    "½": "1/2", "⅓": "1/3", "⅔": "2/3", "¼": "1/4", "¾": "3/4", "⅕": "1/5", "⅖": "2/5", "⅗": "3/5", "⅘": "4/5",
    "⅙": "1/6", "⅚": "5/6", "⅛": "1/8", "⅜": "3/8", "⅝": "5/8", "⅞": "7/8",
}  # fmt: skip
_COMPOSED = {
    **dict(zip("ȧḃċḋėḟġḣṁṅȯṗṙṡṫẇẋẏż", (f"{c}{DOT}" for c in "abcdefghmnoprstwxyz"), strict=True)),
    **dict(zip("äëïöüÿẍẅẗ", (f"{c}{TWO_DOTS}" for c in "aeiouyxwt"), strict=True)),
}
_SIGNS = {
    **dict.fromkeys("−–‐‑", "-"), **dict.fromkeys("·⋅∙×∗", "*"), **dict.fromkeys("÷∕", "/"), "≤": "<=", "≥": ">=",
    **dict.fromkeys("′’ʹ", "'"), "″": "''", "\u00a0": " ", "\u2009": " ", "\u202f": " ",
}  # fmt: skip
_PLAIN = str.maketrans({**_COMPOSED, **_SIGNS, **VARIANTS})
_LETTERS = "A-Za-z" + "".join(GREEK)
_WORD = rf"[{_LETTERS}][{_LETTERS}0-9_{DOT}{TWO_DOTS}]*"
_TOKEN = re.compile(
    rf"(?P<space>[ \t]+)|(?P<word>{_WORD})|(?P<number>(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?(?!_))"
    rf"|(?P<raised>[{''.join(_SUPERSCRIPTS)}]+)|(?P<part>[{''.join(_HALVES)}])"
    r"|(?P<relation><=|>=|==?|[<>])(?![=<>])|(?P<sign>\*\*(?!\*)|//|[-+*/^(),\[\]{}|])|(?P<prime>'+)",
    re.ASCII,
)
_LOWERED = re.compile(f"[{''.join(_SUBSCRIPTS)}]+")
_ALIKE = {"**": "^", "==": "=", "[": "(", "{": "(", "]": ")", "}": ")"}


class Lexeme(NamedTuple):
    """``kind``: ``number``, ``raised`` (a superscript), ``prime``, ``relation``, ``end``, that of a meaning, or a sign.

    A token touches the one before it where no space stands between: ``touching``.
    """

    kind: str
    touching: bool = False
    tree: Tree = ONE
    name: str = ""
    order: int = 0


def plain_characters(text: str) -> str:
    """A text with the signs that have a plain equivalent replaced."""
    if text.isascii():
        return text
    return _LOWERED.sub(lambda match: "_" + "".join(_SUBSCRIPTS[c] for c in match[0]), text.translate(_PLAIN))


def tokens_of(text: str, names: KnownNames) -> list[Lexeme]:
    """The tokens of a text, closed by one of kind ``end``."""
    if not isinstance(text, str) or len(text) > MOST_CHARACTERS:
        raise CheckError("a text of bounded length is needed")
    text = plain_characters(text.strip())
    found: list[Lexeme] = []
    place = bits = 0
    touching = False
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None or len(found) > MOST_TOKENS:
            raise CheckError(f"`{text[place : place + 12]}` cannot be read" if match is None else "a text is too long")
        place, kind = match.end(), match.lastgroup or ""
        more = _lexemes(kind, match[0], touching, names)
        bits += sum(_bits(token.tree) for token in more if token.kind == "number")
        found += more
        touching = kind != "space"
    if bits > MOST_BITS:
        raise CheckError("the numbers of a text have too many digits")
    return [*found, Lexeme("end")]


def _lexemes(kind: str, text: str, touching: bool, names: KnownNames) -> list[Lexeme]:
    if kind == "space":
        return []
    if kind == "number":
        return [Lexeme("number", touching, number(decimal_value(text, names)))]
    if kind == "word":
        parts = names.parts(text)
        return [Lexeme(m.kind, touching or i > 0, m.tree, m.name, m.order) for i, (m, _) in enumerate(parts)]
    if kind == "prime":
        return [Lexeme(kind, touching, ONE, "", len(text))]
    if kind == "part":
        return [Lexeme("number", touching, number(Fraction(_HALVES[text])))]
    if kind == "raised":
        digits = "".join(_SUPERSCRIPTS[c] for c in text)
        if not re.fullmatch(r"-?\d{1,3}", digits):
            raise CheckError(f"the superscript `{text}` is not read")
        return [Lexeme(kind, touching, number(int(digits)))]
    return [Lexeme(kind if kind == "relation" else _ALIKE.get(text, text), touching, ONE, text)]


def _bits(tree: Tree) -> int:
    value = tree.value
    return value.numerator.bit_length() + value.denominator.bit_length() if isinstance(value, Fraction) else 0


def decimal_value(text: str, names: KnownNames | None = None) -> Fraction:
    """The exact value of a decimal."""
    digits, letter, power = text.replace("E", "e").partition("e")
    if letter and names is not None and names.meaning("e" if "e" in text else "E") is not None and "e" in text:
        raise CheckError(f"`{text}` may be a power of ten or hold a declared name")
    whole, _, rest = digits.partition(".")
    if len(whole) + len(rest) > MOST_DIGITS or len(power) > 6 or abs(int(power or "0")) > 1000:
        raise CheckError("a number has too many digits")
    if len(whole) > 1 and whole[0] == "0":
        raise CheckError(f"a number does not begin with 0: `{text}`")
    return Fraction(int(whole + rest), 10 ** len(rest)) * Fraction(10) ** int(power or "0")
