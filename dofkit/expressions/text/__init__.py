"""Mathematics as people write it -> exact expressions, and back.

A text is a formula as a string: data, nothing in it is ever run. It goes through a whitelist of characters and LaTeX
commands (`characters`), a tokenizer with the declared names (`tokens`, `names`) and a grammar (`grammar`,
`applications`) whose arithmetic is bounded (`real_values`). Every refusal is a `TextError` with the column in the text
as it was written. `printing` writes expressions in the grammar, `typesetting` writes texts of the grammar in LaTeX and
MathML.
"""

from __future__ import annotations

from dofkit.expressions.real_values import Comparison
from dofkit.expressions.text.applications import parse_expression, parse_relations
from dofkit.expressions.text.names import AmbiguousError, Names, UnknownNameError, spelled, why_invalid
from dofkit.expressions.text.printing import to_text

__all__ = [
    "AmbiguousError",
    "Comparison",
    "Names",
    "UnknownNameError",
    "parse_expression",
    "parse_relations",
    "spelled",
    "to_text",
    "why_invalid",
]
