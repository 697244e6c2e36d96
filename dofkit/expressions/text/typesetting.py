"""A text in the grammar of scenes as it is printed in a book: LaTeX, and MathML for a page.

The order of terms and factors is the writer's. Nothing is looked up: a text is set as it stands, and one that cannot
be set is told as text.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from dofkit.base.errors import TextError
from dofkit.expressions.text.bounds import MAX_CHARACTERS
from dofkit.expressions.text.characters import (
    DOT,
    FRACTIONS,
    GREEK,
    GREEK_LETTERS,
    LETTERS_OF_NAMES,
    SUPERSCRIPTS,
    TWO_DOTS,
    fold,
)
from dofkit.expressions.text.latex import unlatex
from dofkit.expressions.text.names import ELEMENTARY

_WORD = rf"[A-Za-z{GREEK_LETTERS}][A-Za-z0-9_{GREEK_LETTERS}{DOT}{TWO_DOTS}]*"
_TOKEN = re.compile(
    rf"[ \t]*(?:(?P<word>{_WORD})|(?P<number>(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?)|(?P<relation><=|>=|==?|[<>])"
    rf"|(?P<sign>\*\*|[-+*/^(),\[\]])|(?P<prime>'+)|(?P<superscript>[{''.join(SUPERSCRIPTS)}]+)"
    rf"|(?P<fraction>[{''.join(FRACTIONS)}])|(?P<end>$))"
)
_RATE = re.compile(rf"(?P<base>.+?)(?:(?P<two>ddot|{TWO_DOTS})|(?P<one>dot|{DOT}))(?P<below>_\w+)?")
_INDEXED = re.compile(rf"(?P<letter>[A-Za-z]+?|[{GREEK_LETTERS}])_?(?P<below>\d[A-Za-z0-9_]*|(?<=_)[A-Za-z0-9_]+)?")
_RELATIONS = {
    "and": (r"\text{ and }", "&#160;and&#160;"),
    "<=": (r"\le", "≤"),
    ">=": (r"\ge", "≥"),
    "==": ("=", "="),
    "<": ("<", "&lt;"),
    ">": (">", "&gt;"),
}
_LATEX_FUNCTIONS = frozenset(["sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "exp", "log"])
_INVERSE = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}
_LEAF = re.compile(r"<(m[in])(?: [^>]*)?>[^<]*</\1>")
#: What may stand right after a factor as the next one.
_BEGINNINGS = frozenset({"word", "number", "fraction"})
#: Texts nested deeper than this are told as text.
_DEEPEST = 60


class Typeset(NamedTuple):
    """A piece of mathematics twice; ``bare`` is what stands within its parentheses, where it has some."""

    latex: str
    mathml: str
    bare: tuple[str, str] | None = None


def typeset(text: str) -> Typeset | None:
    """``text`` as LaTeX and as MathML (the inside of ``<math>``), or None for what is no formula.

    >>> found = typeset("l^2 thetadot^2/2")
    >>> "" if found is None else found.latex
    '\\\\frac{l^{2} \\\\dot{\\\\theta}^{2}}{2}'
    >>> typeset("no formula; this") is None
    True
    """
    if len(text) > MAX_CHARACTERS:
        return None
    try:
        return _Setter(_tokens(unlatex(fold(text)).text)).whole()
    except (TextError, _NoFormulaError):
        return None


class _NoFormulaError(ValueError):
    """What was given is no formula."""


class _Piece(NamedTuple):
    kind: str
    text: str
    glued: bool


def _tokens(text: str) -> list[_Piece]:
    found: list[_Piece] = []
    position = 0
    while True:
        match = _TOKEN.match(text, position)
        if match is None:
            raise _NoFormulaError
        kind = "relation" if match["word"] == "and" else match.lastgroup or ""
        found.append(_Piece(kind, match[match.lastgroup or ""].strip(), match.start(match.lastgroup or "") == position))
        if kind == "end":
            return found
        position = match.end()


def _row(parts: list[Typeset], between: str = " ") -> Typeset:
    return Typeset(between.join(p.latex for p in parts), "".join(p.mathml for p in parts))


def _side_by_side(parts: list[Typeset]) -> Typeset:
    """A product: its factors a little apart."""
    if len(parts) == 1:
        return parts[0]
    return Typeset(" ".join(p.latex for p in parts), '<mspace width="0.14em"/>'.join(p.mathml for p in parts))


def _stripped(part: Typeset) -> Typeset:
    """Without the parentheses that a bar or an exponent makes needless."""
    return part if part.bare is None else Typeset(*part.bare)


def _fraction(above: Typeset, below: Typeset) -> Typeset:
    above, below = _stripped(above), _stripped(below)
    mathml = f"<mfrac>{_one(above.mathml)}{_one(below.mathml)}</mfrac>"
    return Typeset(rf"\frac{{{above.latex}}}{{{below.latex}}}", mathml)


def _raised(base: Typeset, exponent: Typeset) -> Typeset:
    exponent = _stripped(exponent)
    mathml = f"<msup>{_one(base.mathml)}{_one(exponent.mathml)}</msup>"
    return Typeset(f"{base.latex}^{{{exponent.latex}}}", mathml)


def _one(mathml: str) -> str:
    """One element: a letter or a number as it is, anything else as a row."""
    return mathml if _LEAF.fullmatch(mathml) else f"<mrow>{mathml}</mrow>"


def _in_parentheses(inner: Typeset) -> Typeset:
    if "<mfrac>" in inner.mathml:
        mathml = f"<mrow><mo>(</mo>{inner.mathml}<mo>)</mo></mrow>"
        return Typeset(rf"\left({inner.latex}\right)", mathml, (inner.latex, inner.mathml))
    mathml = f'<mrow><mo stretchy="false">(</mo>{inner.mathml}<mo stretchy="false">)</mo></mrow>'
    return Typeset(f"({inner.latex})", mathml, (inner.latex, inner.mathml))


def _operator(latex: str, shown: str) -> Typeset:
    return Typeset(latex, f"<mo>{shown}</mo>")


def _letter(name: str) -> Typeset | None:
    """A letter, a Greek one by its name too, perhaps with an index; None for any other word."""
    match = _INDEXED.fullmatch(name)
    if match is None:
        return None
    letter = match["letter"]
    greek = letter if letter in GREEK else LETTERS_OF_NAMES.get(letter)
    if greek is None and len(letter) > 1:
        return None
    latex = letter if greek is None else "\\varphi" if greek == "φ" else f"\\{GREEK[greek]}"
    plain = Typeset(latex, f"<mi>{greek or letter}</mi>")
    return plain if match["below"] is None else _indexed(plain, match["below"])


def _indexed(base: Typeset, below: str) -> Typeset:
    shown = LETTERS_OF_NAMES.get(below, below)
    slanted = len(shown) == 1 and shown.isalpha()
    style = "" if slanted else ' mathvariant="normal"'
    tag = "mn" if shown.isdigit() else "mi"
    latex = (f"\\{below}" if shown != below else below) if slanted or shown.isdigit() else rf"\mathrm{{{_safe(below)}}}"
    mathml = f"<msub>{base.mathml}<{tag}{style if tag == 'mi' else ''}>{shown}</{tag}></msub>"
    return Typeset(f"{base.latex}_{{{latex}}}", mathml)


def _safe(word: str) -> str:
    return word.replace("_", r"\_")


def _name(word: str) -> Typeset:
    """A name: a letter, a rate, a differential, else the word upright."""
    rate = _RATE.fullmatch(word)
    if rate is not None:
        base = _name(rate["base"] + (rate["below"] or ""))
        latex, mark = (r"\ddot", "¨") if rate["two"] else (r"\dot", "˙")
        return _dotted(base, latex, mark)
    plain = _letter(word)
    if plain is not None:
        return plain
    differential = _letter(word[1:]) if word[0] == "d" else None
    if differential is not None:
        d = Typeset(r"\mathrm{d}", '<mi mathvariant="normal">d</mi>')
        return _row([d, differential])
    head, _, below = word.partition("_")
    whole = Typeset(rf"\mathrm{{{_safe(head)}}}", f'<mi mathvariant="normal">{head}</mi>')
    return _indexed(whole, below) if below else whole


def _dotted(base: Typeset, latex: str, mark: str) -> Typeset:
    """The dot stands above the letter, not above its index."""
    letter, under, index = base.latex.partition("_")
    if base.mathml.startswith("<msub>"):
        inner = base.mathml.removeprefix("<msub>")
        end = inner.index(">", inner.index("</")) + 1
        mathml = f'<msub><mover accent="true">{inner[:end]}<mo>{mark}</mo></mover>{inner[end:]}'
        return Typeset(f"{latex}{{{letter}}}{under}{index}", mathml)
    return Typeset(
        f"{latex}{{{base.latex}}}", f'<mover accent="true"><mrow>{base.mathml}</mrow><mo>{mark}</mo></mover>'
    )


class _Setter:
    """Reads pieces from left to right; products by the rank that a space gives them."""

    def __init__(self, pieces: list[_Piece]) -> None:
        self.pieces, self.at, self.depth = pieces, 0, 0

    @property
    def next(self) -> _Piece:
        return self.pieces[self.at]

    def take(self) -> _Piece:
        piece = self.pieces[self.at]
        self.at += 1
        return piece

    def takes(self, *texts: str) -> bool:
        found = self.next.kind in ("sign", "relation") and self.next.text in texts
        self.at += found
        return found

    def whole(self) -> Typeset:
        """Sums with relations and commas between them."""
        parts = [self.sum()]
        while self.next.kind != "end":
            if self.next.kind == "relation":
                sign = self.take().text
                parts += [_operator(*_RELATIONS.get(sign, (sign, sign))), self.sum()]
            elif self.takes(","):
                parts += [_operator(",", ","), self.sum()]
            else:
                raise _NoFormulaError
        return _row(parts)

    def sum(self) -> Typeset:
        self.depth += 1
        if self.depth > _DEEPEST:
            raise _NoFormulaError
        parts: list[Typeset] = []
        while self.next.text in ("+", "-") or not parts:
            if self.next.text in ("+", "-"):
                sign = self.take().text
                parts.append(_operator(sign, "−" if sign == "-" else "+"))
            parts.append(self.product())
        self.depth -= 1
        return _row(parts)

    def product(self) -> Typeset:
        """Factors side by side; a quotient's numerator is what was read since the last one."""
        done: list[Typeset] = []
        parts = [self.factor()]
        while True:
            if self.takes("/"):
                above = _side_by_side(parts)
                done.append(_fraction(above, self.factor()))
                parts = []
            elif self.takes("*") or self.next.kind in _BEGINNINGS or self.next.text in ("(", "["):
                digits = bool(parts) and self.next.kind == "number"
                parts += [_operator(r"\cdot", "·"), self.factor()] if digits else [self.factor()]
            else:
                return _side_by_side([*done, *parts])

    def factor(self) -> Typeset:
        if self.takes("-"):
            return _row([_operator("-", "−"), self.factor()])
        base = self.atom()
        while self.next.kind == "prime":
            marks = self.take().text
            base = Typeset(base.latex + marks, f"<msup>{base.mathml}<mo>{'′' * len(marks)}</mo></msup>")
            if self.next.text == "(" and self.next.glued:
                base = _row([base, self.atom()], "")
        if self.next.kind == "superscript":
            digits = "".join(SUPERSCRIPTS[c] for c in self.take().text)
            return _raised(base, Typeset(digits, f"<mn>{digits}</mn>"))
        return _raised(base, self.factor()) if self.takes("^", "**") else base

    def atom(self) -> Typeset:
        piece = self.take()
        if piece.kind == "number":
            return Typeset(piece.text, f"<mn>{piece.text}</mn>")
        if piece.kind == "fraction":
            return _fraction(*(Typeset(str(n), f"<mn>{n}</mn>") for n in FRACTIONS[piece.text]))
        if piece.kind == "word":
            return self.word(piece.text)
        if piece.text in ("(", "["):
            inner = self.list_of_sums()
            if not self.takes(")", "]"):
                raise _NoFormulaError
            return _in_parentheses(inner)
        raise _NoFormulaError

    def list_of_sums(self) -> Typeset:
        parts = [self.sum()]
        while self.takes(","):
            parts += [_operator(",", ","), self.sum()]
        return _row(parts)

    def word(self, word: str) -> Typeset:
        called = self.next.text == "("
        if word == "sqrt" and called:
            inner = _stripped(self.atom())
            return Typeset(rf"\sqrt{{{inner.latex}}}", f"<msqrt>{inner.mathml}</msqrt>")
        if word == "abs" and called:
            inner = _stripped(self.atom())
            return Typeset(rf"\left|{inner.latex}\right|", f"<mrow><mo>|</mo>{inner.mathml}<mo>|</mo></mrow>")
        if word == "diff" and called:
            return self.derivative()
        if word not in ELEMENTARY:
            plain = _name(word)
            return _row([plain, self.atom()], "") if called and self.next.glued else plain
        shown = _INVERSE.get(word, word)
        latex = f"\\{shown}" if word in _LATEX_FUNCTIONS or word in _INVERSE else rf"\operatorname{{{shown}}}"
        head = Typeset(latex, f"<mi>{shown}</mi>")
        if self.takes("^", "**"):
            head = _raised(head, self.atom())
        return _row([head, Typeset("", "<mo>&#8289;</mo>"), self.factor()])

    def derivative(self) -> Typeset:
        """``diff(f, s)`` and ``diff(f, s, 2)``."""
        self.take()
        what = self.sum()
        if not self.takes(","):
            raise _NoFormulaError
        by, order = self.sum(), self.sum() if self.takes(",") else None
        if not self.takes(")"):
            raise _NoFormulaError
        d = _operator(r"\partial", "∂")
        above, below = (d, by) if order is None else (_raised(d, order), _raised(by, order))
        return _row([_fraction(above, _row([d, below])), what])
