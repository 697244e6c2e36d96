"""A value told in steps: `T = ..., V = ..., L = T - V` is one expression."""

from __future__ import annotations

import re

from dofkit.base.errors import TextError
from dofkit.expressions.text import Names
from dofkit.homework.answers.pieces import pieces_of
from dofkit.homework.judgement import Given

_ENERGY = r"(?:E_?\{?(?:kin|pot|k|p)\w{0,6}\}?|[TVUK](?:_\{?\w{1,4}\}?)?)"
_STEP = re.compile(rf"\A\s*(?P<name>{_ENERGY})\s*=(?!=)(?P<value>[^=<>]+)\Z")
_RESULT = re.compile(
    r"\A\s*(?:(?:so|also|hence|thus|then|therefore|donc|daher|luego|quindi|portanto|damit|folglich)\s*:?\s+)?(?:L|ℒ|\\mathcal\s*\{?L\}?|\\mathscr\s*\{?L\}?)(?:\s*\([^()=]*\))?\s*=(?!=)(?P<value>.+)\Z",
    re.DOTALL,
)
_NAME = re.compile(rf"(?<![\w\\]){_ENERGY}(?!\w)")


def with_energies(answer: Given, names: Names) -> Given:
    """An answer whose last step tells a value by energies that it names before; any other answer as it is."""
    try:
        *steps, last = [script.text for script in pieces_of(answer, names).scripts]
    except TextError:
        return answer
    told = [_STEP.match(step) for step in steps]
    result = _RESULT.match(last)
    if result is None or not told or None in told:
        return answer
    energies = {step["name"]: f"({step['value'].strip()})" for step in told if step is not None}
    if any(names.lookup.meaning(name) is not None for name in energies):
        return answer
    return _NAME.sub(lambda found: energies.get(found[0], found[0]), result["value"])
