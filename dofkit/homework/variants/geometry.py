"""Other numbers in a scene: its drawing stretched along the axes, its lengths scaled, its other numbers exchanged.

A stretched drawing keeps what is parallel, collinear or in one place; whether it keeps the answers, the report tells.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from pydantic_core import PydanticCustomError

from dofkit.homework.variants.stream import Stream
from dofkit.scene.constraints import TYPES
from dofkit.scene.constraints.equations import Equation
from dofkit.scene.fields import as_written, exact
from dofkit.scene.names import coordinate_table
from dofkit.scene.scene import Scene

_FACTORS = tuple(Fraction(n, d) for n, d in ((1, 1), (2, 1), (3, 1), (4, 1), (3, 2), (5, 2), (1, 2)))
#: A whole number of a text that may be another: no exponent, no index, no part of a decimal.
_NUMBER = re.compile(r"(?<![\w.^*/'])(?<!\^\()([2-9]|[1-9]\d)(?![\w.]|\s*/)")
_AXES = "xyz"


class Stretch(NamedTuple):
    """``along``: the factor of each axis; ``length``: that of lengths; ``others``: whole number -> another one."""

    along: tuple[Fraction, ...]
    length: Fraction
    others: Mapping[int, int]

    def told(self, scene: Scene, written: Mapping[str, Any]) -> str:
        """What it does to a scene, in a few words."""
        moved = stretched(scene, written, self._replace(others={})) != dict(written)
        factors = ", ".join(map(as_written, self.along))
        exchanged = ", ".join(f"{a} for {b}" for b, a in sorted(self.others.items()) if a != b)
        return "; ".join(filter(None, [f"drawing x ({factors})" if moved else "", exchanged]))


def new_stretch(written: Mapping[str, Any], dimension: int, stream: Stream) -> Stretch:
    """A stretch by chance: every other time alike in all directions."""
    length = stream.choice(_FACTORS)
    along = (length,) * dimension
    if stream.below(2):
        along = tuple(stream.choice(_FACTORS) for _ in range(dimension))
    known = sorted({int(n) for text in _texts(written) for n in _NUMBER.findall(text)})
    fresh = stream.shuffled(range(2, 10 + len(known)))
    return Stretch(along, length, dict(zip(known, fresh, strict=False)))


def _texts(written: Mapping[str, Any]) -> list[str]:
    found: list[str] = []
    for constraint in written.get("constraints", ()):
        for name in TYPES[constraint.get("type", Equation.kind())].variation.texts:
            value = constraint.get(name, ())
            found += [value] if isinstance(value, str) else value
    return found


def stretched(scene: Scene, written: Mapping[str, Any], stretch: Stretch) -> dict[str, Any]:
    """What is written of a scene, with other numbers."""
    changed = dict(written)
    if "constraints" in written:
        changed["constraints"] = [_constraint(c, stretch) for c in written["constraints"]]
    for kind in ("particles", "bodies"):
        if kind in written:
            changed[kind] = [{**one, **_with(one, ("at",), stretch.along)} for one in written[kind]]
    if "configuration" in written:
        roles = {c.name: c.role for c in coordinate_table(scene).coordinates}
        changed["configuration"] = {
            name: _scaled(value, stretch.along[_AXES.index(roles[name])]) if roles.get(name, "free") in _AXES else value
            for name, value in written["configuration"].items()
        }
    return changed


def _constraint(written: Mapping[str, Any], stretch: Stretch) -> dict[str, Any]:
    variation = TYPES[written.get("type", Equation.kind())].variation
    found = dict(written) | _with(written, (*variation.places, *variation.directions), stretch.along)
    found |= {name: _scaled(written[name], stretch.length) for name in variation.lengths if name in written}
    found |= {name: _exchanged(written[name], stretch.others) for name in variation.texts if name in written}
    return found | {name: _scaled(written[name], stretch.length) for name in variation.numbers if name in written}


def _with(written: Mapping[str, Any], names: Sequence[str], along: Sequence[Fraction]) -> dict[str, Any]:
    return {name: _placed(written[name], along) for name in names if name in written}


def _placed(value: Any, along: Sequence[Fraction]) -> Any:
    """A place, a point of a body, a list of such; a name stays."""
    if isinstance(value, Mapping):
        return {key: _placed(part, along) if isinstance(part, list) else part for key, part in value.items()}
    if isinstance(value, list):
        deep = any(isinstance(part, (list, Mapping)) for part in value) or len(value) != len(along)
        if deep:
            return [_placed(part, along) for part in value]
        names = all(isinstance(part, str) and re.match(r"[^\W\d]", part) for part in value)
        return value if names else [_scaled(part, factor) for part, factor in zip(value, along, strict=True)]
    return value


def _scaled(value: Any, factor: Fraction) -> Any:
    """A number by a factor; a text with letters of the scene stays, as a symbol is any length."""
    try:
        found = exact(value) * factor
        return int(found) if found.denominator == 1 else as_written(found)
    except PydanticCustomError:
        pass
    known = re.sub(r"sqrt|sin|cos|tan|pi", "", str(value))
    return value if factor == 1 or re.search(r"[^\W\d]", known) else f"{as_written(factor)}*({value})"


def _exchanged(value: Any, others: Mapping[int, int]) -> Any:
    if isinstance(value, str):
        return _NUMBER.sub(lambda m: str(others.get(int(m[1]), m[1])), value)
    return [_exchanged(part, others) for part in value]
