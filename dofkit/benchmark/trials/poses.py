"""Mechanisms at and near singular poses: scaled, moved, rounded, with a tolerance.

The truth is derived by hand at the singular pose and near it (see ``poses.yaml``), for steps of every size; for rounded
positions it is the exact rank.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene, Row, tables
from dofkit.benchmark.trials.frameworks import Framework, Position, framework, hinged_loop

Move = Callable[[Position], Position]
#: (dof or None if it was not derived, instantaneous_dof).
Freedom = tuple[int | None, int]


def _stepped(position: Sequence[Any], direction: Sequence[Any], step: Fraction) -> Position:
    return tuple(Fraction(x) + step * Fraction(d) for x, d in zip(position, direction, strict=True))


@dataclass(frozen=True)
class FrameworkPose:
    """A framework that is singular at step 0, as a row of ``poses.yaml``."""

    row: Row

    @property
    def name(self) -> str:
        """The name of the pose."""
        return str(self.row["name"])

    def freedom(self, step: Fraction) -> Freedom:
        """Return (freedom, instantaneous freedom) at distance ``step`` from the singular pose."""
        dof, instantaneous = self.row["beside" if step else "there"]
        return dof, instantaneous

    def framework_at(self, step: Fraction) -> Framework:
        """Return the framework with its ``moved`` points displaced by ``step`` times the vector ``by``."""
        row = self.row
        joints, ground = dict(row["joints"]), list(row.get("ground", ()))
        for end in row["moved"]:
            positions: Any = joints if isinstance(end, str) else ground
            positions[end] = _stepped(positions[end], row["by"], step)
        return framework(joints, ground, row["bars"])

    def scene(self, name: str, drawn: Framework, freedom: Freedom, **more: Any) -> KnownScene:
        """Return the known scene of ``drawn``, a framework of this pose; ``more``: further fields of the scene."""
        return _scene_of_pose(name, drawn.scene(**more), drawn.coordinates, len(drawn.bars), freedom)

    def placed(self, name: str, step: Fraction, move: Move, **more: Any) -> KnownScene:
        """Return the known scene at distance ``step`` from the singular pose, with all positions moved by ``move``."""
        return self.scene(name, self.framework_at(step).moved(move), self.freedom(step), **more)


class HingedPose(FrameworkPose):
    """A loop of hinged bodies that is overconstrained at step 0; a single body is on all hinges."""

    def placed(self, name: str, step: Fraction, move: Move, **more: Any) -> KnownScene:
        """Return the known scene with one hinge displaced by ``step``, and ``move`` applied to all positions."""
        row = self.row
        number, part = row["moved"]
        hinges = []
        for i, (place, axis) in enumerate(row["hinges"]):
            by = {key: row["by"] if (i, key) == (number, part) else [0, 0, 0] for key in ("place", "axis")}
            hinges.append((move(_stepped(place, by["place"], step)), _stepped(axis, by["axis"], step)))
        scene = {**hinged_loop(hinges, row["bodies"]), **more}
        return _scene_of_pose(name, scene, 6 * row["bodies"], 5 * len(hinges), self.freedom(step))


NEAR = [FrameworkPose(row) for row in tables("poses.yaml")["frameworks"]]
JOINTED = [HingedPose(row) for row in tables("poses.yaml")["hinges"]]
STEPS = tuple(Fraction(1, 10**k) for k in range(1, 13))
ZERO = Fraction(0)
#: Digits to which coordinates are rounded.
DIGITS = (12, 9, 6, 4, 3)
MILLION = 10**6
MOVES: Mapping[str, Move] = {
    "as drawn": lambda p: p,
    "a million times larger": lambda p: tuple(x * MILLION for x in p),
    "a million times smaller": lambda p: tuple(x / MILLION for x in p),
    "moved a hundred away": lambda p: tuple(x + 100 * (k + 1) for k, x in enumerate(p)),
    "moved a million away": lambda p: tuple(x + MILLION * (k + 1) for k, x in enumerate(p)),
    "small and far away": lambda p: tuple(x / MILLION + MILLION for x in p),
}
#: The reason that is given for the truth.
DERIVED = "derived by hand at the singular pose and beside it; of rounded numbers the exact rank"
#: The tolerance for scenes with exact positions.
TOLERANCE = "1e-4"


def _moved(pose: FrameworkPose, step: Fraction, how: str, named: str = "", **more: Any) -> KnownScene:
    """Return the known scene of a pose at ``step``, moved by the entry ``how`` of `MOVES`."""
    return pose.placed(f"{pose.name}, {float(step):g} beside, {how}{named}", step, MOVES[how], **more)


def near_singular() -> Iterator[KnownScene]:
    """Yield mechanisms at singular poses, and 10^-1 ... 10^-12 from them."""
    for step in (ZERO, *STEPS):
        for pose in NEAR:
            name = f"{pose.name}, {float(step):g} beside"
            yield pose.placed(name, step, MOVES["as drawn"])
        yield from (_moved(pose, step, "as drawn") for pose in JOINTED)


def scaled() -> Iterator[KnownScene]:
    """Yield mechanisms at and near singular poses, a million times larger or smaller, or far away."""
    for how in MOVES:
        for step in (ZERO, STEPS[0]):
            yield from (_moved(pose, step, how) for pose in (*NEAR, *JOINTED))


def turned(position: Position) -> Position:
    """Return the position rotated by atan2(12, 5), scaled by 10/7 and moved: its decimals do not end."""
    x, y, *others = position
    a, b = Fraction(5, 13), Fraction(12, 13)
    return tuple(v * 10 / 7 + Fraction(1, 3) for v in (a * x - b * y, b * x + a * y, *others))


def rounded(digits: int) -> Move:
    """Return the map that rounds a position to ``digits`` decimals."""
    return lambda p: tuple(Fraction(round(x * 10**digits), 10**digits) for x in p)


def rounded_poses() -> Iterator[KnownScene]:
    """Yield mechanisms at singular poses with rounded positions, which count as exact.

    If the bars are independent after rounding, the freedom is the instantaneous one by rank; else it is not known.
    """
    for digits in DIGITS:
        for pose in NEAR:
            framework = pose.framework_at(ZERO).moved(turned).moved(rounded(digits))
            by_rank = framework.by_rank()
            regular = framework.coordinates - by_rank == len(framework.bars)
            name = f"{pose.name}, {digits} digits"
            yield pose.scene(name, framework, (by_rank if regular else None, by_rank))


def measured_poses() -> Iterator[KnownScene]:
    """Yield mechanisms at singular poses, rounded and with a tolerance: the truth is that of the exact positions."""
    for digits in DIGITS:
        for pose in NEAR:
            framework = pose.framework_at(ZERO).moved(turned).moved(rounded(digits))
            name = f"{pose.name}, {digits} digits with tolerance"
            yield pose.scene(name, framework, pose.freedom(ZERO), tolerance=f"1e-{digits}")


def measured_elsewhere() -> Iterator[KnownScene]:
    """Yield scenes with exact positions and a tolerance, scaled and moved by every entry of `MOVES`."""
    for how in MOVES:
        for step in (ZERO, Fraction(1, 2)):
            yield from (_moved(p, step, how, f", within {TOLERANCE}", tolerance=TOLERANCE) for p in NEAR)
            yield from (_moved(p, step, how, tolerance=TOLERANCE) for p in JOINTED)


def _scene_of_pose(name: str, scene: dict[str, Any], coordinates: int, equations: int, freedom: Freedom) -> KnownScene:
    dof, first = freedom
    truth: dict[str, Any] = {"consistent": True, "instantaneous_dof": first}
    if dof is not None:
        truth |= {"dof": dof, "velocity_dof": dof, "singular": first != dof}
        truth["redundant_equations"] = max(0, equations - (coordinates - dof))
    return KnownScene(scene, truth, name=name, group=name.partition(",")[0], because=DERIVED)


FAMILIES = {
    "near singular": near_singular,
    "size and place": scaled,
    "rounded": rounded_poses,
    "rounded, with tolerance": measured_poses,
}
