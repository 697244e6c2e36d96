"""A text in the grammar of scenes as it is printed in a book: LaTeX, and MathML for a page.

The order of terms and factors is the writer's. Nothing is looked up: a text is set as it stands, and one that is no
formula is shown as text.
"""

from __future__ import annotations

import re
from typing import NamedTuple
from xml.etree import ElementTree

from dofkit.base.errors import TextError
from dofkit.expressions.text.characters import (
    DOT,
    FRACTIONS,
    GREEK,
    GREEK_LETTERS,
    LETTERS_OF_NAMES,
    MAX_CHARACTERS,
    MAX_DEPTH,
    SUPERSCRIPTS,
    TWO_DOTS,
    fold,
    unlatex,
)
from dofkit.expressions.text.names import ELEMENTARY
from dofkit.expressions.text.tokens import TOKEN

_RATE = re.compile(rf"(?P<base>.+?)(?:(?P<two>ddot|{TWO_DOTS})|(?P<one>dot|{DOT}))(?P<below>_\w+)?")
_INDEXED = re.compile(rf"(?P<letter>[A-Za-z]+?|[{GREEK_LETTERS}])_?(?P<below>\d[A-Za-z0-9_]*|(?<=_)[A-Za-z0-9_]+)?")
_RELATIONS = {"and": r"\text{ and }", "or": r"\text{ or }", "<=": r"\le", ">=": r"\ge", "==": "="}
_LATEX_FUNCTIONS = frozenset(["sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "exp", "log"])
_INVERSE = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}
#: What may stand right after a factor as the next one.
_BEGINNINGS = frozenset({"word", "number", "fraction", "(", "["})


def typeset(text: str) -> str | None:
    """Return ``text`` in LaTeX, or None for what is no formula.

    >>> print(typeset("l^2 thetadot^2/2"))
    \\frac{l^{2} \\dot{\\theta}^{2}}{2}
    >>> typeset("no formula; this") is None
    True
    """
    if len(text) > MAX_CHARACTERS:
        return None
    try:
        return _Setter(_pieces(unlatex(fold(text)).text)).formula()
    except (TextError, _NoFormulaError):
        return None


def mathml(latex: str) -> str:
    """Return what stands within ``<math>``, without its name space, for mathematics in LaTeX.

    Raises one of `latex2mathml.exceptions` or ParseError for what is no LaTeX.
    """
    from latex2mathml.converter import convert  # heavy, and only pages and handouts need it

    element = ElementTree.fromstring(convert(latex))
    for part in element.iter():
        part.tag = part.tag.partition("}")[2] or part.tag
    return "".join(ElementTree.tostring(part, encoding="unicode") for part in element)


class _NoFormulaError(ValueError):
    """A text is no formula."""


class _Piece(NamedTuple):
    """A token; ``glued``: no space stands before it."""

    kind: str
    text: str
    glued: bool


def _pieces(text: str) -> list[_Piece]:
    """Return the tokens of a text up to its end. Raises _NoFormulaError for any other character."""
    pieces: list[_Piece] = []
    position = 0
    while True:
        match = TOKEN.match(text, position)
        if match is None:
            raise _NoFormulaError
        group = match.lastgroup or ""
        kind = "relation" if match["word"] in ("and", "or") else match[group] if group == "sign" else group
        pieces.append(_Piece(kind, match[group], match.start(group) == position))
        if kind == "end":
            return pieces
        position = match.end()


def _without_parentheses(latex: str) -> str:
    """Return what stands within the parentheses around all of ``latex``, which a bar or an exponent makes needless."""
    inside = latex.removeprefix(r"\left")
    depth = 0
    for i, char in enumerate(inside):
        depth += (char == "(") - (char == ")")
        if depth == 0:
            return inside[1:-1].removesuffix(r"\right") if i and i == len(inside) - 1 else latex
    return latex


def _fraction(above: str, below: str) -> str:
    return rf"\frac{{{_without_parentheses(above)}}}{{{_without_parentheses(below)}}}"


def _raised(base: str, exponent: str) -> str:
    return f"{base}^{{{_without_parentheses(exponent)}}}"


def _letter(name: str) -> str | None:
    """Return a letter, a Greek one by its name too, perhaps with an index; None for any other word."""
    match = _INDEXED.fullmatch(name)
    if match is None:
        return None
    letter = LETTERS_OF_NAMES.get(match["letter"], match["letter"])
    if len(letter) > 1:
        return None
    latex = rf"\{GREEK[letter]}" if letter in GREEK else letter
    latex = r"\varphi" if latex == r"\phi" else latex
    return latex if match["below"] is None else _indexed(latex, match["below"])


def _indexed(base: str, below: str) -> str:
    if below in LETTERS_OF_NAMES:
        return rf"{base}_{{\{below}}}"
    return f"{base}_{{{below}}}" if len(below) == 1 or below.isdigit() else f"{base}_{{{_upright(below)}}}"


def _upright(word: str) -> str:
    escaped = word.replace("_", r"\_")
    return rf"\mathrm{{{escaped}}}"


def _name(word: str) -> str:
    """Return the LaTeX of a name: a letter, a rate, a differential, else the word upright."""
    rate = _RATE.fullmatch(word)
    if rate is not None:  # the dot stands above the letter, not above its index
        letter, underscore, index = _name(rate["base"] + (rate["below"] or "")).partition("_")
        return rf"\{'ddot' if rate['two'] else 'dot'}{{{letter}}}{underscore}{index}"
    letter_or_none = _letter(word)
    if letter_or_none is not None:
        return letter_or_none
    differential = _letter(word[1:]) if word[0] == "d" else None
    if differential is not None:
        return rf"\mathrm{{d}} {differential}"
    head, _, below = word.partition("_")
    return _indexed(_upright(head), below) if below else _upright(head)


class _Setter:
    """Reads pieces from left to right; products by the rank that a space gives them."""

    def __init__(self, pieces: list[_Piece]) -> None:
        self.pieces, self.at, self.depth = pieces, 0, 0

    @property
    def next(self) -> _Piece:
        return self.pieces[self.at]

    def take(self) -> _Piece:
        self.at += 1
        return self.pieces[self.at - 1]

    def takes(self, *kinds: str) -> bool:
        """Return whether the next piece is one of these signs, and move past it if so."""
        taken = self.next.kind in kinds
        self.at += taken
        return taken

    def formula(self) -> str:
        """Return the LaTeX of a whole formula: sums with the signs of relations, or commas, between them."""
        pieces = [self.sums()]
        while self.next.kind == "relation":
            sign = self.take().text
            pieces += [_RELATIONS.get(sign, sign), self.sums()]
        if self.next.kind != "end":
            raise _NoFormulaError
        return " ".join(pieces)

    def sums(self) -> str:
        pieces = [self.sum()]
        while self.takes(","):
            pieces += [",", self.sum()]
        return " ".join(pieces)

    def sum(self) -> str:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise _NoFormulaError
        pieces: list[str] = []
        while self.next.kind in ("+", "-") or not pieces:
            if self.next.kind in ("+", "-"):
                pieces.append(self.take().text)
            pieces.append(self.product())
        self.depth -= 1
        return " ".join(pieces)

    def product(self) -> str:
        """Return factors side by side; a quotient's numerator is what was read since the last one."""
        quotients: list[str] = []
        factors = [self.factor()]
        while True:
            if self.takes("/"):
                quotients.append(_fraction(" ".join(factors), self.factor()))
                factors = []
            elif self.takes("*") or self.next.kind in _BEGINNINGS:
                if factors and self.next.kind == "number":
                    factors.append(r"\cdot")
                factors.append(self.factor())
            else:
                return " ".join([*quotients, *factors])

    def factor(self) -> str:
        if self.takes("-"):
            return f"- {self.factor()}"
        base = self.atom()
        while self.next.kind == "prime":
            base += self.take().text
            if self.next.kind == "(" and self.next.glued:
                base += self.atom()
        if self.next.kind == "superscript":
            return _raised(base, "".join(SUPERSCRIPTS[c] for c in self.take().text))
        return _raised(base, self.factor()) if self.takes("^", "**") else base

    def atom(self) -> str:
        piece = self.take()
        if piece.kind == "number":
            return piece.text
        if piece.kind == "fraction":
            return _fraction(*map(str, FRACTIONS[piece.text]))
        if piece.kind == "word":
            return self.word(piece.text)
        if piece.kind not in ("(", "["):
            raise _NoFormulaError
        inside = self.sums()
        if not self.takes(")", "]"):
            raise _NoFormulaError
        return rf"\left({inside}\right)" if r"\frac" in inside else f"({inside})"

    def word(self, word: str) -> str:
        called = self.next.kind == "("
        if called and word in ("sqrt", "abs"):
            inside = _without_parentheses(self.atom())
            return rf"\sqrt{{{inside}}}" if word == "sqrt" else rf"\left|{inside}\right|"
        if called and word == "diff":
            return self.derivative()
        if word not in ELEMENTARY:
            return _name(word) + (self.atom() if called and self.next.glued else "")
        name = _INVERSE.get(word, word)
        head = f"\\{name}" if word in _LATEX_FUNCTIONS or word in _INVERSE else _upright(name)
        if self.takes("^", "**"):
            head = _raised(head, self.atom())
        return f"{head} {self.factor()}"

    def derivative(self) -> str:
        """Return ``diff(f, s)`` or ``diff(f, s, 2)`` as a quotient of differentials."""
        self.take()
        function = self.sum()
        if not self.takes(","):
            raise _NoFormulaError
        variable, order = self.sum(), self.sum() if self.takes(",") else None
        if not self.takes(")"):
            raise _NoFormulaError
        d, below = (r"\partial", variable) if order is None else (rf"\partial^{{{order}}}", _raised(variable, order))
        return rf"\frac{{{d}}}{{\partial {below}}} {function}"
