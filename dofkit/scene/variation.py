"""What may differ between two scenes of one difficulty: of every constraint type its geometry, and what may replace it.

A type declares it on its class; whoever makes variants reads it there and knows no types.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple

#: What changes where a constraint is replaced: a support at rest or in motion, a body that rolls or slides.
Replaced = Literal["supports", "rolling"]


class TypeVariation(NamedTuple):
    """Fields of a type that hold ``places``, ``directions``, ``lengths``, other ``numbers``, or ``texts`` with numbers.

    A field that holds points or lists of them is one of places. Numbers keep their signs.
    """

    places: tuple[str, ...] = ()
    directions: tuple[str, ...] = ()
    lengths: tuple[str, ...] = ()
    numbers: tuple[str, ...] = ()
    texts: tuple[str, ...] = ()


class NamesAtHand(NamedTuple):
    """The names of a scene, for a constraint that may be replaced.

    ``owned``: the coordinates of each particle and body; ``parameters``: what is declared of them; ``fresh``: a new
    name like the one that is wished for.
    """

    dimension: int
    owned: Mapping[str, tuple[str, ...]]
    parameters: Mapping[str, Any]
    fresh: Callable[[str], str]


class Replacement(NamedTuple):
    """Another constraint in place of one: its fields as they are written, with the parameters that it brings."""

    aspect: Replaced
    fields: Mapping[str, Any]
    parameters: Mapping[str, str]
    description: str


def length_in_motion(written: Mapping[str, Any], names: NamesAtHand) -> Replacement | None:
    """Return the same constraint with its `length` drawn in at a steady speed, or at rest where it was so."""
    length = written.get("length")
    if length is None:
        return None
    still = re.fullmatch(r"(.+?)\s*[-+]\s*\w+\s*\*?\s*t", str(length))
    if still is not None:
        return Replacement("supports", {**written, "length": still[1]}, {}, "its length is constant")
    if re.search(r"\bt\b", str(length)):
        return None
    speed = names.fresh("v")
    description = f"its length grows at the speed {speed}"
    return Replacement("supports", {**written, "length": f"{length} + {speed}*t"}, {speed: "positive"}, description)


def angle_for_turning(text: str, names: NamesAtHand) -> tuple[str, str, str] | None:
    """Return a text with `omega t`: (with an angle instead, the rate, the angle); None where time enters otherwise."""
    rates_in_text = re.findall(r"\b([^\W\d]\w*)\s*\*?\s*\bt\b", text)
    rates = set(rates_in_text) & set(names.parameters)
    if len(rates) != 1 or len(rates_in_text) != len(re.findall(r"\bt\b", text)):
        return None
    (rate,) = rates
    angle = names.fresh("alpha")
    return re.sub(rf"\b{re.escape(rate)}\s*\*?\s*\bt\b", angle, text), rate, angle
