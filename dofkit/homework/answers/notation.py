r"""Converts pasted notation to plain text: LaTeX, full-width digits, arrows, derivatives of whole sums.

``$\tfrac12 m \ell^2$`` becomes ``\frac{1}{2} m l^2``, which the grammar reads.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from dofkit.base.errors import TextError
from dofkit.expressions.text.characters import BROKEN_COMMAND, COMMANDS, CONTROLS
from dofkit.expressions.text.names import ELEMENTARY
from dofkit.homework.answers.prose import Rewriting, rewriting


@dataclass(frozen=True)
class Script:
    """A text with the original column of each character and of the end, counted from 1."""

    text: str
    columns: tuple[int, ...]

    @classmethod
    def of(cls, text: str) -> Script:
        """Return a text as it was written."""
        return cls(text, tuple(range(1, len(text) + 2)))

    def cut(self, start: int, end: int | None = None) -> Script:
        """Return the part from index ``start`` to ``end`` (None: the end of the text)."""
        end = len(self.text) if end is None else end
        return Script(self.text[start:end], self.columns[start : end + 1])

    def stripped(self) -> Script:
        """Return the script without leading and trailing blanks."""
        start = len(self.text) - len(self.text.lstrip())
        return self.cut(start, max(start, len(self.text.rstrip())))

    def spliced(self, start: int, end: int, new: str) -> Script:
        """Return the script with ``new`` in place of a part; all new characters have the column of its first one."""
        columns = (*self.columns[:start], *[self.columns[start]] * len(new), *self.columns[end:])
        return Script(self.text[:start] + new + self.text[end:], columns)

    def replaced(self, pattern: re.Pattern[str], by: Rewriting) -> Script:
        """Return the script with every match replaced; new characters have the column where the match began."""
        if pattern.search(self.text) is None:
            return self
        out: list[str] = []
        columns: list[int] = []
        place = 0
        for match in pattern.finditer(self.text):
            new = match.expand(by) if isinstance(by, str) else by(match)
            out += [self.text[place : match.start()], new]
            columns += [*self.columns[place : match.start()], *[self.columns[match.start()]] * len(new)]
            place = match.end()
        out.append(self.text[place:])
        return Script("".join(out), (*columns, *self.columns[place:]))

    def moved(self, error: TextError) -> TextError:
        """Return an error about this text with its column in the original text."""
        column = error.column
        if column is not None:
            column = self.columns[min(max(column - 1, 0), len(self.columns) - 1)]
        return TextError(error.message, column, error.hint)


#: The sign between equations of which the first implies the second.
ARROW = "⇒"
_WIDE = re.compile("[\uff01-\uff5e]")


def _braced(argument: str) -> str:
    """Return an argument of a command with braces around it if it is a single character."""
    return f"{{{argument}}}" if len(argument) == 1 else argument


def _dotted(name: str, mark: str) -> str:
    """Return the name of a derivative: `x_dot`, or `xdot_1` for a name with an index."""
    stem, _, index = re.sub(r"\\var|[{}\\]", "", name).partition("_")
    return f"{stem}{mark}_{index}" if index else f"{stem}_{mark}"


_RULES = rewriting(
    "notation: rules",
    {
        "fraction": lambda m: rf"\frac{_braced(m[1])}{_braced(m[2])}",
        "velocity": lambda m: f" {_dotted(m[1], 'dot')} ",
        "acceleration": lambda m: f" {_dotted(m[1], 'ddot')} ",
        "derivative": lambda m: f" {_dotted(m[2], m[1])} ",
        "small": lambda m: m[0].lower(),
    },
)
_JOINED = (
    (re.compile(r"(?<![\w\\])d\s*\\(?:var)?(?=[A-Za-z])"), " d"),
    (re.compile(rf"(?<![\w\\])d\s+(?!(?:{'|'.join(sorted(ELEMENTARY))})\b)(?=[A-Za-zα-ωΑ-Ω])"), "d"),
)
_WHOLE = re.compile(r"Ddt|(?<![\w\\])d(?=\()")
_BY_TIME = re.compile(r"\s*/\s*\(?d\s?t\)?(?!\w)")
_OTHER_FORM = re.compile(r"(?<![A-Za-z])d[A-Za-zα-ωΑ-Ω]")


def with_differentials(script: Script) -> Script:
    """Return the script with ``d theta`` as ``dtheta``, and ``d/dt (...)`` and ``d(...)`` as ``diff(..., t)``.

    With other differentials in the text, ``d(x y)`` is a differential itself and unchanged: ``d(x y) = z dz``.
    """
    for pattern, by in _JOINED:
        script = script.replaced(pattern, by)
    place = 0
    while (match := _WHOLE.search(script.text, place)) is not None:
        start = place = match.end()
        while script.text[start : start + 1] == " ":
            start += 1
        end = _closed(script.text, start)
        by_time = None if end is None or match[0] != "d" else _BY_TIME.match(script.text, end + 1)
        mixed = match[0] == "d" and by_time is None and _OTHER_FORM.search(script.text)
        if end is None or mixed:
            continue
        inside = script.text[start + 1 : end]
        script = script.spliced(match.start(), by_time.end() if by_time else end + 1, f"diff({inside}, t)")
    return script


def _closed(text: str, start: int) -> int | None:
    """Return the index at which the bracket that opens at ``start`` is closed, or None."""
    depth = 0
    for i in range(start, len(text)):
        depth += (text[i] in "([{") - (text[i] in ")]}")
        if depth <= 0:
            return i if i > start else None
    return None


_COMMAND = re.compile(
    rf"(?<!\\)\\(?=(?:{'|'.join(sorted(COMMANDS, key=len, reverse=True))})(?![a-z])|[^\\\s\"/abefnrtuvxNLPU_0-9])"
)


def backslashes_kept(text: str) -> str:
    """Return the text of a document with backslashes doubled if they begin LaTeX commands or no escape sequence."""
    return _COMMAND.sub(r"\\\\", text)


_ALIGNED = re.compile(r"(?<!\\)&")
_EQUALITY = re.compile(r"\A\s*(?:sp\.|sympy\.)?(?:Eq|Equality)(?=\()")


def _as_equation(script: Script) -> Script:
    """Return `a = b` for SymPy's `Eq(a, b)`; other scripts unchanged."""
    match = _EQUALITY.match(script.text)
    end = None if match is None else _closed(script.text, match.end())
    if match is None or end is None or script.text[end + 1 :].strip():
        return script
    depth = 0
    for i in range(match.end() + 1, end):
        depth += (script.text[i] in "([{") - (script.text[i] in ")]}")
        if script.text[i] == "," and depth == 0:
            left_side, right = script.cut(match.end() + 1, i), script.cut(i + 1, end)
            return Script(
                f"{left_side.text} = {right.text}",
                (*left_side.columns[:-1], *left_side.columns[-1:] * 3, *right.columns),
            )
    return script


_BOX = re.compile(r"\\(?:boxed|fbox|framebox|underline|ensuremath)\s*(?=\{)")


def _unboxed(script: Script) -> Script:
    """Return the script without boxes around results, `\\boxed{...}`."""
    while (match := _BOX.search(script.text)) is not None:
        end = _closed(script.text, match.end())
        if end is None:
            return script
        script = script.spliced(end, end + 1, " ").spliced(match.start(), match.end() + 1, " ")
    return script


def script_of(text: str) -> Script:
    """Return a text in plain notation; what no rule covers is unchanged, and may be rejected by the parser."""
    script = Script.of(text).replaced(BROKEN_COMMAND, lambda m: "\\" + CONTROLS[m[0][0]] + m[0][1:])
    script = script.replaced(_WIDE, lambda m: chr(ord(m[0]) - 0xFEE0))
    if script.text.isascii() and not _ODD.search(script.text):
        return script
    script = _unboxed(_as_equation(script))
    if "\\begin" in script.text:
        script = script.replaced(_ALIGNED, " ")
    for pattern, by in _RULES:
        script = script.replaced(pattern, by)
    return script


#: An ASCII text without any of these needs no rule.
_ODD = re.compile(
    r"Derivative|\bin\s*\[|Eq\(|Equality|[\\$&`\"{>]|:=|\bdd?ot\(|\bd\s*/|\bd\s*(?:\^|\*\*)\s*2\s*/|np\.|math\.|sympy\.|sp\.|numpy\.|<br"
    r"|\.[*/^]|\b(?:sen|tg|Sin|Cos|Tan|Sqrt|Exp|SIN|COS|TAN|SQRT|EXP)\b"
)
