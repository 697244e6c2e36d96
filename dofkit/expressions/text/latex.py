r"""The LaTeX that people paste: ``\theta``, ``\frac{a}{b}``, ``\cdot``, ``\dot{x}``, ``x_{1}``.

Commands are rewritten into the plain grammar, each character keeping the column where it was
written; a command that has no plain meaning is refused.
"""

from __future__ import annotations

import re

from dofkit.base.errors import TextError
from dofkit.expressions.text.characters import DEGREE, DOT, GREEK_LETTERS, LETTERS_OF_NAMES, TWO_DOTS, Folded

#: The mark that `\frac` leaves for the parser; no text can hold it otherwise.
FRACTION_MARK = "\\"

_COMMAND = re.compile(
    r"\\(?P<name>[A-Za-z]+|.|$)|_\s*\{\s*(?P<below>[A-Za-z0-9]+)\s*\}|_\s*\{(?P<odd>)", re.ASCII | re.DOTALL
)
_DOTTED = re.compile(
    rf"\s*(?:\{{\s*(?:\\(?P<a>[A-Za-z]+)|(?P<b>[A-Za-z{GREEK_LETTERS}]))"
    r"(?:_(?:(?P<i>[A-Za-z0-9])|\{\s*(?P<j>[A-Za-z0-9]+)\s*\}))?\s*\}"
    rf"|\\(?P<c>[A-Za-z]+)|(?P<d>[A-Za-z{GREEK_LETTERS}]))"
)
_UPRIGHT = re.compile(r"\s*\{\s*([A-Za-z]+)\s*\}")
_SPACE = re.compile(r"\s*")

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
_UPRIGHTS = ("mathrm", "text", "operatorname", "mathit", "textrm", "rm")
_REFUSED = {
    "ne": "`≠` is no constraint that is known here", "neq": "`≠` is no constraint that is known here",
    "pm": "`±` stands for two texts", "mp": "`±` stands for two texts", "infty": "infinity is no number",
    "partial": "`∂` is not read: write a derivative as `diff(h(s), s)`",
}  # fmt: skip


def unlatex(folded: Folded) -> Folded:
    """``folded`` with its LaTeX commands rewritten."""
    text, columns = folded
    if "\\" not in text and "{" not in text:
        return folded
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
            plain, position = _command(match["name"], text, start, match.end(), columns[start])
            put(plain, start)
    out.append(text[position:])
    places.extend(columns[position:])
    return Folded("".join(out), places)


def _command(name: str, text: str, start: int, end: int, column: int) -> tuple[str, int]:
    """What the command ``name`` stands for, and where the text goes on after it."""
    if name in ("dot", "ddot"):
        return _dots(name, text, end, column)
    if name in _UPRIGHTS:
        match = _UPRIGHT.match(text, end)
        if match is not None:
            word = match[1]
            after = _SPACE.match(text, match.end())
            glue = word == "d" and after is not None
            return word, after.end() if glue and after is not None else match.end()
    if name == "sqrt" and text[end : end + 1] == "[":
        raise TextError("a root with an index is not read", column, "write it as a power, such as `x^(1/3)`")
    plain = _PLAIN.get(name)
    if plain is None:
        known = _REFUSED.get(name, f"the LaTeX command `\\{name}` is not read")
        raise TextError(known, column, "write plain text, such as `2*x*cos(theta)`")
    if len(plain) == 1 and plain in GREEK_LETTERS and text[start - 1 : start] == "_":
        raise TextError("a Greek letter as a subscript is not read", column, f"write `_{name}` without the backslash")
    return plain, end


def _dots(name: str, text: str, end: int, column: int) -> tuple[str, int]:
    match = _DOTTED.match(text, end)
    if match is None:
        hint = "write the velocity of `x` as `xdot`"
        raise TextError(f"`\\{name}` is read over a single letter only", column, hint)
    letter = match["b"] or match["d"] or _PLAIN.get(match["a"] or match["c"], "")
    if letter not in GREEK_LETTERS and not (len(letter) == 1 and letter.isalpha()):
        raise TextError(f"`\\{name}` is read over a single letter only", column, "write the velocity of `x` as `xdot`")
    below = match["i"] or match["j"]
    return letter + (DOT if name == "dot" else TWO_DOTS) + (f"_{below}" if below else ""), match.end()
