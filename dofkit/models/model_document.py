"""A model's file, and the scene that it describes: its mapping, the line of each entry, and what was left out."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path
from typing import Any, NamedTuple

from dofkit.base.wording import first_of
from dofkit.expressions.text import why_invalid
from dofkit.models.joint_relations import DECIMALS, OVER, JointSum, bounds, whole_turns
from dofkit.system import BINDING, GROUND

#: The least and the largest tolerance; the numbers of a file with fewer than `FEW` decimals are taken as exact.
FINEST, COARSEST, FEW = 1e-9, 1e-3, 3
#: The most entries of one kind that are named.
MOST_NAMED = 4

_NUMBER = re.compile(r"[-+]?\d*\.?(\d*)(?:[eE]([-+]?\d+))?", re.ASCII)


class ModelFile(NamedTuple):
    """A file of a model: its content, the scene's name, and its path (None for a text).

    ``limits``: whether ranges of joints become inequalities.
    """

    data: bytes | str
    name: str
    path: Path | None = None
    limits: bool = False

    @property
    def text(self) -> str:
        """The content as text."""
        return self.data if isinstance(self.data, str) else self.data.decode("utf-8-sig", "replace")


@dataclass(frozen=True)
class ModelDocument:
    """The mapping of a scene, and {path in the scene: line of the model}.

    ``tolerance``: the precision of the file's digits; the scene has it only if its freedom may depend on them.
    """

    value: dict[str, Any]
    lines: Mapping[tuple[str | int, ...], int]
    tolerance: float | None = None


class JointRange(NamedTuple):
    """The range ``between`` of a joint's value: its constraint, whether it is an angle, its reference value."""

    joint: str
    turns: bool
    reference: float
    between: Sequence[float]
    line: int | None


@dataclass
class SceneDraft:
    """A scene that is being written; the model's names are kept as far as a scene allows them."""

    title: str
    dimension: int = 3
    bodies: list[dict[str, Any]] = field(default_factory=list)
    particles: list[dict[str, Any]] = field(default_factory=list)
    parameters: dict[str, Any] = field(default_factory=dict)
    coordinates: list[str] = field(default_factory=list)
    constraints: list[Any] = field(default_factory=list)
    forces: list[dict[str, Any]] = field(default_factory=list)
    configuration: dict[str, Any] = field(default_factory=dict)
    left_out: list[str] = field(default_factory=list)
    lines: dict[tuple[str | int, ...], int] = field(default_factory=dict)
    _bodies: set[str] = field(default_factory=lambda: {"ground", "t"})
    _constraints: set[str] = field(default_factory=set)

    def body(self, name: str, line: int | None, **fields: Any) -> str:
        """Add a body and return its name in the scene."""
        unique_name = identifier(name, self._bodies)
        self._at(("bodies", len(self.bodies)), line)
        self.bodies.append({"name": unique_name, **fields})
        return unique_name

    def place(self, body: str, at: Iterable[float]) -> None:
        """Set the reference position of a body, and the orientation in which `inertia_of` writes its inertia."""
        self.configuration |= {f"{c}_{body}": number(v) for c, v in zip("xyz", at, strict=False)}
        self.configuration[f"theta_{body}"] = "pi/2"

    def particle(self, name: str, line: int | None, at: Iterable[float]) -> str:
        """Add a particle and return its name in the scene."""
        unique_name = identifier(name, self._bodies)
        self._at(("particles", len(self.particles)), line)
        self.particles.append({"name": unique_name, "at": vector(at)})
        return unique_name

    def coordinate(self, name: str, reference: float) -> str:
        """Add a further coordinate with its reference value, unless it exists already, and return its name."""
        if name not in self.configuration:
            self.coordinates.append(name)
            self.configuration[name] = number(reference)
        return name

    def constraint(self, name: str, kind: str, line: int | None, **fields: Any) -> str:
        """Add a constraint and return its name in the scene."""
        unique_name = unique(name, self._constraints)
        self._at(("constraints", len(self.constraints)), line)
        self.constraints.append({"name": unique_name, "type": kind, **fields})
        return unique_name

    def ranges(self, ranged: Sequence[JointRange], limits: bool) -> None:
        """Add the ranges of joints as inequalities with ``limits``, else note them as left out."""
        if ranged and not limits:
            named = listed(f"{r.joint} from {r.between[0]:.4g} to {r.between[1]:.4g}" for r in ranged)
            self.leave_out(f"the ranges of joints ({named}): with `--limits` they become inequalities")
            return
        for joint, turns_about, reference, between, line in ranged:
            turns = whole_turns(reference, between) if turns_about else 0.0
            if turns is None:
                self.leave_out(f"the range of {joint}: {OVER}")
            else:
                fields = bounds(JointSum(((joint, 1.0),), reference + turns), between)
                self.constraint(f"{joint} range", "coupling", line, **fields)

    def leave_out(self, what: str, binding: bool = False) -> None:
        """Note what was left out, and why, once. ``binding``: it is a constraint, which might reduce the freedom."""
        what = f"{BINDING}{what}" if binding else what
        if what not in self.left_out:
            self.left_out.append(what)

    def document(self, tolerance: float | None, special: bool) -> ModelDocument:
        """Return the scene, with the tolerance if its geometry may be ``special``."""
        tolerance = None if tolerance is None else float(f"{tolerance:.2g}")
        value: dict[str, Any] = {"title": self.title, "dimension": self.dimension}
        for key in ("parameters", "particles", "bodies", "coordinates", "constraints", "forces"):
            if getattr(self, key):
                value[key] = getattr(self, key)
        self._give_rational_lengths()
        if special and tolerance is not None:
            value["tolerance"] = tolerance
        if self.configuration:
            value["configuration"] = self.configuration
        if self.left_out:
            value["left_out"] = self.left_out
        return ModelDocument(value, self.lines, tolerance)

    def _give_rational_lengths(self) -> None:
        """Replace the axes of coupled joints by vectors of rational length, so that their angles need no roots."""
        coupled = {joint for c in self.constraints for joint in c.get("joints", {}).values()}
        for constraint in self.constraints:
            if constraint["name"] in coupled and "axis" in constraint:
                constraint["axis"] = with_rational_length(constraint["axis"])

    def _at(self, path: tuple[str | int, ...], line: int | None) -> None:
        if line is not None:
            self.lines[path] = line


def number(value: float) -> float | int:
    """Return a number rounded to `DECIMALS`, as int if it is an integer."""
    rounded = round(float(value), DECIMALS)
    return int(rounded) if rounded == int(rounded) and abs(rounded) < 1e15 else rounded


def vector(values: Iterable[float]) -> list[float | int]:
    """Return numbers rounded as `number` does."""
    return [number(v) for v in values]


def point_of(body: str, at: Iterable[float]) -> Any:
    """Return the material point of ``body`` (or the ground) at a world position, as a scene writes it."""
    return vector(at) if body == GROUND else {"on": body, "at": vector(at)}


def with_rational_length(axis: Sequence[float | int]) -> list[float | int | Decimal]:
    """Return a vector of rational length, whose direction differs from the axis by at most about 1e-9.

    It is (2a, 2b, 1 - a^2 - b^2) of length 1 + a^2 + b^2, with rationals (a, b) near the other components over 1 + |c|,
    where c is the largest component of the unit axis.

    >>> with_rational_length([0, 0, 1]), [float(v) for v in with_rational_length([0.6, 0.0, 0.8])]
    ([0, 0, 1], [0.666666666, 0.0, 0.8888888891111111])
    """
    if sum(map(bool, axis)) == 1:
        return [*axis]
    k = max(range(3), key=lambda i: abs(axis[i]))
    size = math.sqrt(sum(v * v for v in axis))
    sign = 1 if axis[k] > 0 else -1
    a, b = (round(Decimal(sign * axis[i] / size / (1 + abs(axis[k]) / size)), 9) for i in range(3) if i != k)
    components: list[float | int | Decimal] = [sign * 2 * a, sign * 2 * b]
    components.insert(k, sign * (1 - a * a - b * b))
    return components


def inertia_of(rows: Sequence[Sequence[float]]) -> list[Any]:
    """Return an inertia in the axes x, z, -y of the world, its three moments if it is diagonal.

    These are the axes of a body with theta = pi/2 (see `SceneDraft.place`): at theta = 0 Euler angles are singular, so
    that no equations of motion could be derived.

    >>> inertia_of([[1, 0, 0], [0, 2, 0], [0, 0, 3]])
    [1, 3, 2]
    """
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = (vector(row) for row in rows)
    if not (xy or xz or yz):
        return [xx, zz, yy]
    return [[xx, xz, -xy], [xz, zz, -yz], [-xy, -yz, yy]]


def unique(name: str, taken: set[str]) -> str:
    """Return the name, with a number if it is in ``taken``, and add it to ``taken``."""
    unique_name, k = name, 2
    while unique_name in taken:
        unique_name, k = f"{name}_{k}", k + 1
    taken.add(unique_name)
    return unique_name


def identifier(name: str, taken: set[str]) -> str:
    """Return the name of a body or particle with letters, digits and _ only, and unique as in `unique`.

    >>> identifier("robot0:FF-J1", set()), identifier("9 mm", set())
    ('robot0_FF_J1', 'n9_mm')
    """
    plain = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_") or "part"
    plain = plain if plain[0].isalpha() else f"n{plain}"
    if why_invalid(f"x_{plain}") is not None:
        plain = f"{plain}_"
    return unique(plain, taken)


def decimals(texts: Iterable[str]) -> Iterator[int]:
    """Yield the number of decimals of each number in these texts."""
    for text in texts:
        for part in text.split():
            match = _NUMBER.fullmatch(part)
            if match:
                yield max(0, len(match[1] or "") - int(match[2] or 0))


def tolerance_of(texts: Iterable[str], size: float) -> float:
    """Return half a unit of the last digit of the number with most decimals, as a fraction of ``size``.

    If all numbers have fewer than `FEW` decimals they are exact, up to the rounding of a compiler (`FINEST`).

    >>> tolerance_of(["0.7071 0 0", "1.5"], 2.0)
    2.5e-05
    """
    longest = max(decimals(texts), default=0)
    if longest < FEW:
        return FINEST
    return min(COARSEST, max(FINEST, 0.5 * 10.0**-longest / (size or 1.0)))


def listed(names: Iterable[str]) -> str:
    """Return the first of several names, and how many more there are."""
    return first_of(names, MOST_NAMED)
