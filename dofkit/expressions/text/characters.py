r"""Characters and LaTeX: a whitelist of characters and commands, each with its meaning.

`fold` turns a text into plain letters, digits and operators; `unlatex` rewrites commands that people paste (``\theta``,
``\frac{a}{b}``, ``\dot{x}``, ``x_{1}``) into the plain grammar. Both keep, for every character of the result, the
column at which the person wrote it. Nothing is normalised by compatibility (NFKC would make ``x²`` into ``x2``): every
replacement is listed here. In double quotes YAML and JSON make a control character of a backslash and the letter after
it (``"\theta"`` is a tab and ``heta``): such commands are read as they were meant.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from typing import NamedTuple

from dofkit.base.documents import package_table
from dofkit.base.errors import TextError

# Bounds of a text: a text beyond them is refused before anything is computed with it.

MAX_CHARACTERS = 2000
#: Numbers, names and signs in one text.
MAX_NODES = 1500
MAX_DEPTH = 60
MAX_NAME = 64
#: Digits of one number, and bits of all numbers of a text together.
MAX_DIGITS = 30
MAX_TEXT_BITS = 8192
#: An expression with more nodes than this is not differentiated while it is being read.
MAX_DIFFERENTIATED = 150
#: How often `diff` differentiates.
MAX_ORDER = 6

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
#: Other signs for a Greek letter.
LETTERS: dict[str, str] = {"ϑ": "θ", "ϕ": "φ", "ϵ": "ε", "ϱ": "ρ", "ς": "σ", "ϰ": "κ", "µ": "μ", "∆": "Δ"}
_SPACES = dict.fromkeys("\u00a0\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u202f\u205f\u3000", " ")
SUBSCRIPTS: dict[str, str] = dict(zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True))
#: The degree sign: the number before it is multiplied by pi/180.
DEGREE = "°"
_KEPT = frozenset(GREEK) | frozenset(SUPERSCRIPTS) | frozenset(FRACTIONS) | {DOT, TWO_DOTS, DEGREE}
_MARKS = {**dict.fromkeys("\u0358", DOT)}

#: Letters of other alphabets that look like Latin ones.
_LOOKALIKES: dict[str, str] = {
    **dict(zip("асеорухіјѕһԁӏԛԝкмтв", "aceopyxijshdlqwkmtb", strict=True)),
    **dict(zip("АВСЕНІЈКМОРЅТХУ", "ABCEHIJKMOPSTXY", strict=True)),
    **dict(zip("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧο", "ABEZHIKMNOPTYXo", strict=True)),
}


def refusals(kind: str) -> dict[str, tuple[str, str]]:
    """Return {character or command: (message, hint)} of those that are refused, by their ``kind`` in refusals.yaml."""
    refused: dict[str, tuple[str, str]] = package_table(__package__, "refusals.yaml")[kind]
    return refused


class Folded(NamedTuple):
    """A text in plain characters; ``columns[i]`` is where character ``i`` was written, from 1."""

    text: str
    columns: Sequence[int]


def fold(text: str) -> Folded:
    """Return ``text`` in plain characters. Raises TextError at the first character that has no meaning."""
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
    """Return what a non-ASCII ``char`` stands for, or ``char`` if it is in `_KEPT`. Raises TextError if nothing."""
    if char in _KEPT:
        return char
    for table in (_SIGNS, LETTERS, _SPACES, _MARKS):
        if char in table:
            return table[char]
    codes = unicodedata.decomposition(char).split()
    if len(codes) == 2 and (codes[0] == "<font>" or codes[0] in _BASES):
        plain = _composed(codes)
        if plain is not None:
            return plain
    if len(codes) == 1 and codes[0][0] != "<":  # one character with two codes, such as the sign for ohm
        single = chr(int(codes[0], 16))
        return single if single.isascii() else _plain(single, column)
    raise _refusal(char, column)


def _composed(decomposition: list[str]) -> str | None:
    """Return the letter of a Unicode ``decomposition``: of another type face, or with dots above; None for others."""
    if decomposition[0] == "<font>":
        base = chr(int(decomposition[1], 16))
        base = LETTERS.get(base, base)
        return base if (base.isascii() and base.isalnum()) or base in GREEK else None
    base, mark = (chr(int(part, 16)) for part in decomposition)
    return base + mark if mark in (DOT, TWO_DOTS) else None


_BASES = frozenset(f"{ord(c):04X}" for c in "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ" + GREEK_LETTERS)


def _refusal(char: str, column: int) -> TextError:
    """Return the error for a character that is refused: what the character is, and what to type instead."""
    if char in refusals("characters"):
        message, hint = refusals("characters")[char]
        return TextError(message, column, hint)
    name = unicodedata.name(char, "unnamed character")
    quoted = f"`{char}` " if char.isprintable() and not unicodedata.combining(char) else ""
    what = f"{quoted}(U+{ord(char):04X}, {name.lower()})"
    latin = _LOOKALIKES.get(char) or _wide(char)
    if latin is not None:
        script = name.split()[0].capitalize()
        plain = f"the Latin `{latin}`" if latin.isalpha() else f"the plain `{latin}`"
        return TextError(f"{what} is a {script} character, not {plain}", column, f"type `{latin}` instead")
    if unicodedata.category(char) in ("Cf", "Cc", "Co", "Cn", "Cs"):
        return TextError(f"the text contains an invisible character, {what}", column, "delete it")
    if unicodedata.combining(char):
        hint = "name the quantity with letters, digits and `_`; dots above mean derivatives by time"
        return TextError(f"the mark {what} above a letter has no meaning here", column, hint)
    hint = "names are made of Latin and Greek letters, digits and `_`"
    return TextError(f"the character {what} has no meaning here", column, hint)


def _wide(char: str) -> str | None:
    """Return the ASCII character that a full-width character imitates, None for other characters."""
    return chr(ord(char) - 0xFEE0) if "！" <= char <= "～" else None


def check_name_characters(name: str) -> str | None:
    """Return None if ``name`` consists of letters, digits and `_`, else why it does not."""
    for char in name:
        plain = LETTERS.get(char, char)
        if plain in GREEK or (plain.isascii() and (plain.isalnum() or plain == "_")):
            continue
        if not char.isascii() and (char in _LOOKALIKES or char in refusals("characters")):
            return _refusal(char, 1).message
        return f"the name has the character {char!r}, and names are made of Latin and Greek letters, digits and `_`"
    return None


#: The mark by which `unlatex` replaces `\frac`; no other text contains it.
FRACTION_MARK = "\\"

#: The control characters that stand for a backslash and a letter, and the commands that are looked for after them.
CONTROLS = {"\x07": "a", "\x08": "b", "\t": "t", "\n": "n", "\x0b": "v", "\x0c": "f", "\r": "r", "\x1b": "e"}
COMMANDS = frozenset({
    "alpha", "approx", "beta", "begin", "bar", "bigl", "bigr", "tau", "tan", "tanh", "text", "textrm", "theta", "tfrac",
    "times", "to", "nu", "nabla", "ne", "neq", "newline", "nonumber", "varphi", "vartheta", "varepsilon", "vec", "frac",
    "forall", "rho", "right", "rm", "rightarrow", "rvert", "eta", "end", "ell", "equiv", "epsilon", "exp",
})  # fmt: skip


def _broken_commands() -> str:
    ends = {sign: sorted((c[1:] for c in COMMANDS if c[0] == a), key=len, reverse=True) for sign, a in CONTROLS.items()}
    return "|".join(f"{re.escape(sign)}(?:{'|'.join(words)})(?![a-z])" for sign, words in ends.items() if words)


#: A command whose backslash and first letter have become a control character.
BROKEN_COMMAND = re.compile(_broken_commands())
_COMMAND = re.compile(
    rf"\\(?P<name>[A-Za-z]+|.|$)|(?P<broken>{BROKEN_COMMAND.pattern})"
    r"|_\s*\{\s*(?P<below>[A-Za-z0-9]+)\s*\}|_\s*\{(?P<odd>)",
    re.ASCII | re.DOTALL,
)
#: The signs that enclose mathematics in LaTeX.
_DELIMITED = re.compile(r"\s*(\$\$?|\\\(|\\\[)(?P<inner>[^$]*?)(\$\$?|\\\)|\\\])\s*", re.DOTALL)
_CLOSING = {"$": "$", "$$": "$$", "\\(": "\\)", "\\[": "\\]"}
_DOTTED = re.compile(
    rf"\s*(?:\{{\s*(?:\\(?P<a>[A-Za-z]+)|(?P<b>[A-Za-z{GREEK_LETTERS}]))"
    r"(?:_(?:(?P<i>[A-Za-z0-9])|\{\s*(?P<j>[A-Za-z0-9]+)\s*\}))?\s*\}"
    rf"|\\(?P<c>[A-Za-z]+)|(?P<d>[A-Za-z{GREEK_LETTERS}]))"
)
_UPRIGHT = re.compile(r"\s*\{\s*(\\?[A-Za-z]+)\s*\}")
_SPACE = re.compile(r"\s*")
#: Digits without braces, of which TeX takes one for each argument: `\frac12`, `\sqrt2`.
_DIGITS = {FRACTION_MARK: re.compile(r"\s*(\d)\s*(\d)(?![\d.,])"), " sqrt ": re.compile(r"\s*(\d)(?![\d.,])")}

_PLAIN: dict[str, str] = {
    **{name: f" {name} " for name in ("sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "exp", "log")},
    "ln": " log ", "arcsin": " asin ", "arccos": " acos ", "arctan": " atan ", "sqrt": " sqrt ",
    "cdot": "*", "times": "*", "ast": "*", "div": "/", "le": "<=", "leq": "<=", "leqslant": "<=", "ge": ">=",
    "geq": ">=", "geqslant": ">=", "lt": "<", "gt": ">", "lvert": "|", "rvert": "|", "vert": "|", "prime": "'",
    "circ": DEGREE, "frac": FRACTION_MARK, "dfrac": FRACTION_MARK, "tfrac": FRACTION_MARK, "quad": " ", "qquad": " ",
    ",": " ", ";": " ", ":": " ", "!": " ", " ": " ",
    **dict.fromkeys(("left", "right", "big", "Big", "bigl", "bigr", "Bigl", "Bigr"), ""),
    **LETTERS_OF_NAMES,
    "varphi": "φ", "vartheta": "θ", "varepsilon": "ε", "varrho": "ρ", "varsigma": "σ",
}  # fmt: skip
#: Commands for the type face of a name; `\mathrm{d}` belongs to the name after it.
_TYPE_FACES = ("mathrm", "text", "operatorname", "mathit", "textrm", "rm", "mathbf", "boldsymbol", "bm", "textbf")
_PLAIN_HINT = "write plain text, such as `2*x*cos(theta)`"


def unlatex(folded: Folded) -> Folded:
    """Return ``folded`` with its LaTeX commands rewritten into plain characters."""
    text, columns = _undelimited(folded.text), folded.columns
    out: list[str] = []
    places: list[int] = []

    def put(plain: str, place: int) -> None:
        out.append(plain)
        places.extend([columns[place]] * len(plain))

    position = 0
    while (match := _COMMAND.search(text, position)) is not None:
        start = match.start()
        out.append(text[position:start])
        places.extend(columns[position:start])
        if match["below"] is not None:
            put("_" + match["below"], start)
            position = match.end()
        elif match["odd"] is not None:
            raise TextError("this subscript cannot be part of a name", columns[start], "write it as `x_1` or `x_{AB}`")
        else:
            broken = match["broken"]
            name = match["name"] if broken is None else CONTROLS[broken[0]] + broken[1:]
            plain, position = _command(name, text, start, match.end(), columns[start])
            put(plain, start)
    out.append(text[position:])
    places.extend(columns[position:])
    return Folded("".join(out), places)


def _undelimited(text: str) -> str:
    r"""Return the text with spaces in place of the ``$``, ``\\(`` or ``\\[`` that enclose all of it, if any do."""
    match = _DELIMITED.fullmatch(text)
    if match is None or _CLOSING[match[1]] != match[3]:
        return text
    start, end = match.span("inner")
    return " " * start + text[start:end] + " " * (len(text) - end)


def _command(name: str, text: str, start: int, end: int, column: int) -> tuple[str, int]:
    """Return the plain text of the LaTeX command ``name`` (at ``start`` to ``end``), and where the text continues."""
    if name in ("dot", "ddot"):
        return _dots(name, text, end, column)
    if name in _TYPE_FACES:
        match = _UPRIGHT.match(text, end)
        if match is not None:
            word = match[1] if match[1][0] != "\\" else _PLAIN.get(match[1][1:], match[1])
            after = _SPACE.match(text, match.end())
            glue = word == "d" and after is not None
            return word, after.end() if glue and after is not None else match.end()
    if name == "sqrt" and text[end : end + 1] == "[":
        raise TextError("a root with an index is not read", column, "write it as a power, such as `x^(1/3)`")
    plain = _PLAIN.get(name)
    if plain is None:
        message, hint = refusals("commands").get(name, (f"the LaTeX command `\\{name}` is not read", _PLAIN_HINT))
        raise TextError(message, column, hint)
    if plain in _DIGITS and (digits := _DIGITS[plain].match(text, end)):
        return plain + "".join(f"{{{digit}}}" for digit in digits.groups()), digits.end()
    if len(plain) == 1 and plain in GREEK_LETTERS and text[start - 1 : start] == "_":
        raise TextError("a Greek letter as a subscript is not read", column, f"write `_{name}` without the backslash")
    return plain, end


def _dots(name: str, text: str, end: int, column: int) -> tuple[str, int]:
    r"""Return the name under `\\dot` or `\\ddot` with its dots, such as ``ẋ_i``, and where the text continues."""
    match = _DOTTED.match(text, end)
    if match is None:
        hint = "write the velocity of `x` as `xdot`"
        raise TextError(f"`\\{name}` is read over a single letter only", column, hint)
    letter = match["b"] or match["d"] or _PLAIN.get(match["a"] or match["c"], "")
    if letter not in GREEK_LETTERS and not (len(letter) == 1 and letter.isalpha()):
        raise TextError(f"`\\{name}` is read over a single letter only", column, "write the velocity of `x` as `xdot`")
    below = match["i"] or match["j"]
    return letter + (DOT if name == "dot" else TWO_DOTS) + (f"_{below}" if below else ""), match.end()
