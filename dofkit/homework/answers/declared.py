"""The names that an assignment declares, and usual names of quantities: all that reading an answer may use.

The key is not used, so that an answer is read in the same way whether it is right or wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

from dofkit.expressions.text import Names
from dofkit.expressions.text.characters import GREEK
from dofkit.expressions.text.names import in_words
from dofkit.expressions.tree import Expr, coordinate, sym, velocity
from dofkit.scene.names import coordinate_table, vocabulary_of
from dofkit.scene.scene import Scene

#: Stems of names of angles; every other coordinate is regarded as a length.
_ANGLES = frozenset({"alpha", "beta", "gamma", "theta", "phi", "psi", "chi", "varphi", "vartheta"})
#: {usual name: (whether the coordinate is an angle, order of the derivative)}.
_USUAL = {"v": (False, 1), "a": (False, 2), "omega": (True, 1), "alpha": (True, 2)}
_WORD = re.compile(r"(?P<stem>omega|alpha|v|a)(?:_?(?P<index>\w+))?")
_DIFFERENCE = re.compile(r"(?:Δ|Delta)_?(?P<name>\w+)")


@dataclass(frozen=True)
class DeclaredNames:
    """The names that answers may contain.

    ``names``: for formulas; ``also``: further coordinates that the question offers; ``constants``: parameters without
    a value.
    """

    names: Names
    coordinates: tuple[str, ...]
    constraints: tuple[str, ...]
    also: tuple[str, ...]
    constants: tuple[str, ...]

    @classmethod
    def of(cls, scene: Scene, also: Iterable[str]) -> DeclaredNames:
        """Return the names of a scene, without its constraints; ``also``: further coordinates."""
        names = vocabulary_of(scene).names
        constraints = tuple(c.name or f"c{n}" for n, c in enumerate(scene.constraints, 1))
        return cls(
            names,
            tuple(c.name for c in coordinate_table(scene).coordinates),
            constraints,
            tuple(also),
            tuple(n for n, e in names.parameters.items() if e.op == "sym"),
        )

    @cached_property
    def with_also(self) -> Names:
        """`names` with the further coordinates, for which the same notations are allowed."""
        return replace(self.names, coordinates=self.names.coordinates | {*self.also})


def usual_name(word: str, names: Names) -> Expr | None:
    """Return the quantity that an undeclared word usually names, or None if there is none or more than one.

    `v_x` and `vx` are the velocity of x, `a_x` is its acceleration; `v` and `a` are those of the only coordinate if it
    is a length, `omega` and `alpha` those of the only angle; `omega_1` belongs to the only angle with the index 1.
    `Δx` is the differential of x, or the difference x_2 - x_1.
    """
    word = in_words(word)
    if (difference := _DIFFERENCE.fullmatch(word)) is not None:
        return _difference(difference["name"], names)
    match = _WORD.fullmatch(word)
    if match is None:
        return None
    angular, order = _USUAL[match["stem"]]
    index = match["index"] or ""
    fitting = [q for q in names.coordinates if _is_angle(q) == angular]
    if not index:
        chosen = fitting if angular or len(names.coordinates) == 1 else []
    elif index in names.coordinates:
        chosen = [index] if _is_angle(index) == angular else []
    else:
        chosen = [q for q in fitting if q.partition("_")[2] == index or _digits(q) == index]
    if len(chosen) != 1 or (order == 2 and not names.allow_accelerations):
        return None
    return velocity(chosen[0]) if order == 1 else sym("acceleration", chosen[0])


def _difference(name: str, names: Names) -> Expr | None:
    if name in names.coordinates:
        return sym("differential", name) if names.allow_velocities else None
    ends = sorted(q for q in names.coordinates if q.partition("_")[0] == name)
    return coordinate(ends[1]) - coordinate(ends[0]) if len(ends) == 2 else None


def _is_angle(name: str) -> bool:
    stem = in_words(name).partition("_")[0].rstrip("0123456789")
    return stem in _ANGLES or (stem in GREEK.values() and stem not in ("xi", "eta", "rho", "sigma", "lambda"))


def _digits(name: str) -> str:
    return name[len(name.rstrip("0123456789")) :]
