"""Mathematics as people write it -> exact expressions, and back.

A text is data: nothing in it is ever run. It goes through a whitelist of characters and LaTeX commands (`characters`),
a tokenizer that knows the declared names (`tokens`, `names`) and a grammar (`grammar`, `applications`) whose arithmetic
is bounded (`reader`). Every refusal is a `TextError` with the column in the text as it was written. `printing` writes
expressions in the grammar, `typesetting` texts of it in LaTeX and MathML.
"""

from __future__ import annotations

from dofkit.expressions.text.applications import APPLICATIONS
from dofkit.expressions.text.characters import spelled
from dofkit.expressions.text.grammar import Comparison, Parser
from dofkit.expressions.text.names import AmbiguousError, Names, UnknownNameError, valid_name
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.text.tokens import tokenize
from dofkit.expressions.tree import Expr

__all__ = [
    "AmbiguousError",
    "Comparison",
    "Names",
    "UnknownNameError",
    "parse_expression",
    "parse_relations",
    "spelled",
    "to_text",
    "valid_name",
]


def parse_relations(text: str, names: Names) -> tuple[Comparison, ...]:
    """Return the relations in ``text``: one, or several for a chain such as ``0 <= x <= L``.

    A text without a relation means ``... = 0``. Raises TextError for what cannot be read.
    """
    return Parser(tokenize(text, names.lookup), names, APPLICATIONS).relations()


def parse_expression(text: str, names: Names) -> Expr:
    """Return the value of ``text``; a relation in it is an error. Raises TextError for what cannot be read."""
    return Parser(tokenize(text, names.lookup), names, APPLICATIONS).value()
