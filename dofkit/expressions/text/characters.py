"""Characters: a whitelist, and what each accepted character stands for.

`fold` turns a text into plain letters, digits and operators and keeps, for every character of the
result, the column at which the person wrote it. Nothing is normalised by compatibility (NFKC would
make ``x²`` into ``x2``): every replacement is listed here.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from typing import NamedTuple

from dofkit.base.errors import TextError

GREEK: dict[str, str] = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ζ": "zeta", "η": "eta",
    "θ": "theta", "ι": "iota", "κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi",
    "ρ": "rho", "σ": "sigma", "τ": "tau", "υ": "upsilon", "φ": "phi", "χ": "chi", "ψ": "psi", "ω": "omega",
    "Γ": "Gamma", "Δ": "Delta", "Θ": "Theta", "Λ": "Lambda", "Ξ": "Xi", "Π": "Pi", "Σ": "Sigma",
    "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega",
}  # fmt: skip
GREEK_LETTERS = "".join(GREEK)
LETTERS_OF_NAMES: dict[str, str] = {name: letter for letter, name in GREEK.items()}

#: One and two dots above a letter: its first and second derivative by time.
DOT, TWO_DOTS = "\u0307", "\u0308"
SUPERSCRIPTS: dict[str, str] = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-", strict=True))
FRACTIONS: dict[str, tuple[int, int]] = {
    "½": (1, 2), "⅓": (1, 3), "⅔": (2, 3), "¼": (1, 4), "¾": (3, 4), "⅕": (1, 5), "⅖": (2, 5), "⅗": (3, 5),
    "⅘": (4, 5), "⅙": (1, 6), "⅚": (5, 6), "⅐": (1, 7), "⅛": (1, 8), "⅜": (3, 8), "⅝": (5, 8), "⅞": (7, 8),
    "⅑": (1, 9), "⅒": (1, 10),
}  # fmt: skip

_SIGNS: dict[str, str] = {
    "−": "-", "–": "-", "‐": "-", "‑": "-", "﹣": "-", "·": "*", "⋅": "*", "∙": "*", "•": "*", "×": "*", "∗": "*",
    "÷": "/", "∕": "/", "⁄": "/", "≤": "<=", "⩽": "<=", "≦": "<=", "≥": ">=", "⩾": ">=", "≧": ">=",
    "′": "'", "’": "'", "‘": "'", "ʹ": "'", "″": "''", "‴": "'''", "√": "√", "∣": "|", "ǀ": "|",
}  # fmt: skip
_LETTERS: dict[str, str] = {"ϑ": "θ", "ϕ": "φ", "ϵ": "ε", "ϱ": "ρ", "ς": "σ", "ϰ": "κ", "µ": "μ", "∆": "Δ"}
_SPACES = dict.fromkeys("\u00a0\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u202f\u205f\u3000", " ")
SUBSCRIPTS: dict[str, str] = dict(zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True))
#: After a number: so many times pi/180.
DEGREE = "°"
_KEPT = frozenset(GREEK) | frozenset(SUPERSCRIPTS) | frozenset(FRACTIONS) | {DOT, TWO_DOTS, DEGREE}
_MARKS = {**dict.fromkeys("\u0358", DOT)}

#: Letters of other alphabets that look like Latin ones.
_LOOKALIKES: dict[str, str] = {
    **dict(zip("асеорухіјѕһԁӏԛԝкмтв", "aceopyxijshdlqwkmtb", strict=True)),
    **dict(zip("АВСЕНІЈКМОРЅТХУ", "ABCEHIJKMOPSTXY", strict=True)),
    **dict(zip("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧο", "ABEZHIKMNOPTYXo", strict=True)),
}
_REFUSED: dict[str, tuple[str, str]] = {
    "≠": ("`≠` is not a constraint that can be read", "write `=`, `<=`, `>=`, `<` or `>`"),
    "≈": ("`≈` does not state an exact relation", "write `=`"),
    "≡": ("`≡` is not read", "write `=`"),
    "±": ("`±` stands for two relations", "write each of the two as a text of its own"),
    "∓": ("`∓` stands for two relations", "write each of the two as a text of its own"),
    "∞": ("infinity is not a number", "leave that bound out"),
    "∂": ("`∂` is not read", "write a derivative as `diff(h(s), s)`"),
    "∛": ("`∛` is not read", "write `x^(1/3)`"),
    "∈": ("`∈` is not a relation that can be read", "write `0 <= x <= L` for an interval"),
    "ⁿ": ("a superscript letter is not read", "write `^n`"),
    "˙": ("a dot without a letter is not read", "write the velocity of `x` as `xdot`"),
    "¨": ("two dots without a letter are not read", "write the acceleration of `x` as `xddot`"),
    "∫": ("an integral is not read", "write the relation without the integral"),
    "∑": ("a sum sign is not read", "write out the terms"),
}


class Folded(NamedTuple):
    """A text in plain characters; ``columns[i]`` is where character ``i`` was written, from 1."""

    text: str
    columns: Sequence[int]


def fold(text: str) -> Folded:
    """``text`` in the plain characters that the tokenizer knows, or TextError at the first other one."""
    columns: Sequence[int] = range(1, len(text) + 2)
    if text.isascii():
        return Folded(text, columns)
    out: list[str] = []
    places: list[int] = []
    below = False
    for column, char in enumerate(text, 1):
        plain = char if char.isascii() else SUBSCRIPTS.get(char)
        if plain is None:
            plain = _plain(char, column)
        elif plain is not char and not below:
            plain = "_" + plain
        below = char in SUBSCRIPTS
        out.append(plain)
        places.extend([column] * len(plain))
    places.append(len(text) + 1)
    return Folded("".join(out), places)


def _plain(char: str, column: int) -> str:
    """What one character outside ASCII stands for."""
    if char in _KEPT:
        return char
    for table in (_SIGNS, _LETTERS, _SPACES, _MARKS):
        if char in table:
            return table[char]
    if char not in _LOOKALIKES and char not in _REFUSED:
        parts = unicodedata.decomposition(char).split()
        if len(parts) == 2 and (parts[0] == "<font>" or parts[0] in _BASES):
            plain = _composed(char, parts)
            if plain is not None:
                return plain
        if len(parts) == 1 and parts[0][0] != "<":  # one character with two codes, such as the sign for ohm
            return _plain_or_ascii(chr(int(parts[0], 16)), column)
    raise _refusal(char, column)


def _composed(char: str, parts: list[str]) -> str | None:
    """A letter in another type face, or a letter with dots above it."""
    if parts[0] == "<font>":
        base = chr(int(parts[1], 16))
        base = _LETTERS.get(base, base)
        return base if (base.isascii() and base.isalnum()) or base in GREEK else None
    base, mark = (chr(int(part, 16)) for part in parts)
    return base + mark if mark in (DOT, TWO_DOTS) else None


def _plain_or_ascii(char: str, column: int) -> str:
    return char if char.isascii() else _plain(char, column)


_BASES = frozenset(f"{ord(c):04X}" for c in "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ" + GREEK_LETTERS)


def _refusal(char: str, column: int) -> TextError:
    if char in _REFUSED:
        message, hint = _REFUSED[char]
        return TextError(message, column, hint)
    name = unicodedata.name(char, "unnamed character")
    shown = f"`{char}` " if char.isprintable() and not unicodedata.combining(char) else ""
    what = f"{shown}(U+{ord(char):04X}, {name.lower()})"
    latin = _LOOKALIKES.get(char) or _wide(char)
    if latin is not None:
        script = name.split()[0].capitalize()
        plain = f"the Latin `{latin}`" if latin.isalpha() else f"the plain `{latin}`"
        return TextError(f"{what} is a {script} character, not {plain}", column, f"type `{latin}` instead")
    if unicodedata.category(char) in ("Cf", "Cc", "Co", "Cn", "Cs"):
        return TextError(f"the text holds an invisible character, {what}", column, "delete it")
    if unicodedata.combining(char):
        hint = "name the quantity with letters, digits and `_`; dots above mean derivatives by time"
        return TextError(f"the mark {what} above a letter has no meaning here", column, hint)
    hint = "names are made of Latin and Greek letters, digits and `_`"
    return TextError(f"the character {what} has no meaning here", column, hint)


def _wide(char: str) -> str | None:
    """The ASCII character that a full-width one imitates."""
    return chr(ord(char) - 0xFEE0) if "！" <= char <= "～" else None


def spelled(name: str) -> str:
    """``name`` with its Greek letters spelled out: θ_1 and theta_1 are one name."""
    if name.isascii():
        return name
    return "".join([GREEK.get(c, c) for c in (_LETTERS.get(c, c) for c in name)])


def check_name_characters(name: str) -> str | None:
    """None if ``name`` is made of letters, digits and `_`, else the reason why not."""
    if name.isascii() and name.replace("_", "").isalnum():
        return None
    for char in name:
        plain = _LETTERS.get(char, char)
        if plain in GREEK or (plain.isascii() and (plain.isalnum() or plain == "_")):
            continue
        if not char.isascii() and (char in _LOOKALIKES or char in _REFUSED):
            return _refusal(char, 1).message
        return f"the name holds the character {char!r}, and names are made of Latin and Greek letters, digits and `_`"
    return None
