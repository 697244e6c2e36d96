r"""The LaTeX that people paste: ``$\theta$``, ``\frac{a}{b}``, ``\cdot``, ``\dot{x}``, ``x_{1}``, ``\mathbf{x}``.

Commands are rewritten into the plain grammar, and each character keeps the column where it was written; a command
that has no plain meaning is refused. In double quotes YAML and JSON make a control character of a backslash and the
letter after it (``"\theta"`` is a tab and ``heta``): such commands are read as they were meant.
"""

from __future__ import annotations

import re

from dofkit.base.errors import TextError
from dofkit.expressions.text.characters import (
    DEGREE,
    DOT,
    GREEK_LETTERS,
    LETTERS_OF_NAMES,
    TWO_DOTS,
    Folded,
    fold,
    spelled,
)

#: The mark that `\frac` leaves for the parser; no text can hold it otherwise.
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
_UNUSUAL = re.compile(r"[\\{$\x00-\x1f]")
#: What stands around mathematics in LaTeX.
_DELIMITED = re.compile(r"\s*(\$\$?|\\\(|\\\[)(?P<inner>[^$]*?)(\$\$?|\\\)|\\\])\s*", re.DOTALL)
_CLOSING = {"$": "$", "$$": "$$", "\\(": "\\)", "\\[": "\\]"}
_DOTTED = re.compile(
    rf"\s*(?:\{{\s*(?:\\(?P<a>[A-Za-z]+)|(?P<b>[A-Za-z{GREEK_LETTERS}]))"
    r"(?:_(?:(?P<i>[A-Za-z0-9])|\{\s*(?P<j>[A-Za-z0-9]+)\s*\}))?\s*\}"
    rf"|\\(?P<c>[A-Za-z]+)|(?P<d>[A-Za-z{GREEK_LETTERS}]))"
)
_UPRIGHT = re.compile(r"\s*\{\s*(\\?[A-Za-z]+)\s*\}")
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
#: Commands for the type face of a name; `\mathrm{d}` belongs to the name after it.
_TYPE_FACES = ("mathrm", "text", "operatorname", "mathit", "textrm", "rm", "mathbf", "boldsymbol", "bm", "textbf")
_PLAIN_HINT = "write plain text, such as `2*x*cos(theta)`"
_SEVERAL = ("several equations stand in one text", r"give each line its own text, without `&` and `\\`")
_REFUSED: dict[str, tuple[str, str]] = {
    **dict.fromkeys(("ne", "neq"), ("`≠` is not a constraint that can be read", "write `=`, `<=`, `>=`, `<` or `>`")),
    **dict.fromkeys(("pm", "mp"), ("`±` stands for two relations", "write each of the two as a text of its own")),
    "infty": ("infinity is not a number", "leave that bound out"),
    "partial": ("`∂` is not read", "write a derivative as `diff(h(s), s)`"),
    **dict.fromkeys(("begin", "end", "\\", "newline"), _SEVERAL),
}  # fmt: skip


def unlatex(folded: Folded) -> Folded:
    """Return ``folded`` with its LaTeX commands rewritten into plain characters."""
    if not _UNUSUAL.search(folded.text):
        return folded
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


def without_latex(text: str) -> str | None:
    """Return a text in plain Latin letters and signs, or None where it holds what is not read."""
    try:
        return spelled(unlatex(fold(text)).text).strip()
    except TextError:
        return None


def _undelimited(text: str) -> str:
    """Return the text with spaces in place of the ``$``, ``\\(`` or ``\\[`` that enclose all of it."""
    match = _DELIMITED.fullmatch(text)
    if match is None or _CLOSING[match[1]] != match[3]:
        return text
    start, end = match.span("inner")
    return " " * start + text[start:end] + " " * (len(text) - end)


def _command(name: str, text: str, start: int, end: int, column: int) -> tuple[str, int]:
    """What the command ``name`` stands for, and where the text goes on after it."""
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
        message, hint = _REFUSED.get(name, (f"the LaTeX command `\\{name}` is not read", _PLAIN_HINT))
        raise TextError(message, column, hint)
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
