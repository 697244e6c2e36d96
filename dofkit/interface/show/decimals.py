"""Formulas with decimals in place of fractions, for scenes that are written with decimals."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from typing import Any, TypeVar

from pydantic import BaseModel

from dofkit.scene.fields import decimal_of
from dofkit.scene.scene import Scene

#: The fields of a scene that contain numbers and formulas of the user.
_OF_SCENE = ("parameters", "particles", "bodies", "constraints", "forces", "energies", "configuration")
#: The fields of reports and of equations of motion that contain formulas of dofkit.
_FORMULAS = frozenset(
    (
        *("integral", "integrating_factor", "reason", "where", "what", "basis", "feasible_at"),
        *("lagrangian", "momenta", "forces", "equations", "conserved", "eliminated", "linearized"),
    )
)
#: A whole number after a fraction bar, alone or as first factor in parentheses; and a whole coefficient.
_DIVISOR = re.compile(r"/(?:(?P<alone>\d+)|\((?P<first>\d+)\*(?P<rest>[^()]*)\))(?![\w.^(])")
_COEFFICIENT = re.compile(r"(\d+)(?:\*|$)(?!\*)")
#: The most decimal places.
_LONGEST = 12
#: The characters that may precede a name of the user, which is not a formula.
_QUOTES = ("'", "`", '"')
_TEXT_WITH_DECIMAL = re.compile(r"\d\.\d|(?<![\w.])\.\d")

Shown = TypeVar("Shown", bound=BaseModel)


def as_the_scene(report: Shown, scene: Scene) -> Shown:
    """Return a report or equations of motion, with decimals in the formulas if the scene contains decimals."""
    if not any(_has_decimal(getattr(scene, name)) for name in _OF_SCENE):
        return report
    converted: Shown = _converted(report, False)
    return converted


def _has_decimal(value: Any) -> bool:
    """Return whether a value contains a decimal: in a text, or as a fraction that has a finite decimal."""
    if isinstance(value, BaseModel):
        return any(_has_decimal(part) for part in value.__dict__.values())
    if isinstance(value, Mapping):
        return any(_has_decimal(part) for part in value.values())
    if isinstance(value, (list, tuple)):
        return any(_has_decimal(part) for part in value)
    if isinstance(value, Fraction):
        return value.denominator > 1 and decimal_of(value, _LONGEST) is not None
    return isinstance(value, str) and _TEXT_WITH_DECIMAL.search(value) is not None


def _converted(value: Any, in_formula: bool) -> Any:
    """Return a value with decimals in its texts; of models only in the fields of `_FORMULAS` and below these."""
    if isinstance(value, BaseModel):
        fields = {name: _converted(part, in_formula or name in _FORMULAS) for name, part in value.__dict__.items()}
        return value.model_copy(update=fields)
    if isinstance(value, dict):
        return {name: _converted(part, in_formula) for name, part in value.items()} if in_formula else value
    if isinstance(value, list):
        return [_converted(part, in_formula) for part in value]
    return with_decimals(value) if in_formula and isinstance(value, str) else value


def with_decimals(text: str) -> str:
    """Return a formula with its terminating fractions as decimals.

    >>> with_decimals("13*x^2/800 - sin(y - 1/10)/10 + x/3")
    '0.01625*x^2 - 0.1*sin(y - 0.1) + x/3'
    """
    start = 0
    while match := _DIVISOR.search(text, start):
        begin = _product_start(text, match.start())
        product = _product(text[begin : match.start()], match)
        if product is None or text[begin - 1 : begin] in _QUOTES:
            start = match.end()
        else:
            text = text[:begin] + product + text[match.end() :]
            start = begin + len(product)
    return text


def _product(above: str, match: re.Match[str]) -> str | None:
    """Return a quotient with a decimal coefficient, or None if the coefficient has no finite decimal."""
    coefficient = _COEFFICIENT.match(above)
    factors = above[coefficient.end() :] if coefficient else above
    divisor = int(match["alone"] or match["first"])
    number = int(coefficient[1]) if coefficient else 1
    value = decimal_of(Fraction(number, divisor), _LONGEST) if divisor > 1 else None
    if value is None or not above:
        return None
    below = f"/{match['rest']}" if match["rest"] else ""
    if "*" in below:
        below = f"/({match['rest']})"
    if value == "1":
        return f"{factors or value}{below}"
    return f"{value}*{factors}{below}" if factors else f"{value}{below}"


def _product_start(text: str, end: int) -> int:
    """Return the index at which the product before ``end`` begins: after a space, an open parenthesis or a sign."""
    depth, start = 0, end
    while start:
        character = text[start - 1]
        if depth == 0 and character in " (,=+-'`\"[{;<>":
            break
        depth += (character == ")") - (character == "(")
        start -= 1
    return start
