"""Mechanisms near their singular poses, scaled, moved, rounded, renamed: truths by hand, or by the exact rank.

Each of `NEAR` and `JOINTED` is singular, or overconstrained, at step 0 and drawn exactly at every other step; the
freedom of both is derived in its comment, and does not depend on the size of the step.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene
from dofkit.benchmark.trials.frameworks import Framework, Position, framework, written

Move = Callable[[Position], Position]
#: (dof, instantaneous_dof); None where it was not derived.
Freedom = tuple[int | None, int]


@dataclass(frozen=True)
class Near:
    """``at`` a step from its singular pose; the freedom ``there`` and ``beside`` it."""

    name: str
    at: Callable[[Fraction], Framework]
    there: Freedom
    beside: Freedom


@dataclass(frozen=True)
class Jointed:
    """The same of bodies and hinges: (place, axis) of each, in a loop with ``bodies`` and the ground."""

    name: str
    hinges: Callable[[Fraction], Sequence[tuple[Sequence[Any], Sequence[Any]]]]
    bodies: int
    there: Freedom
    beside: Freedom

    def scene(self, step: Fraction, move: Move = lambda p: p, **more: Any) -> dict[str, Any]:
        """One loop of hinges; where there is one body, all of them hold it."""
        names = ["ground", *(f"link{i}" for i in range(self.bodies))]
        hinges = self.hinges(step)
        joints = []
        for i, (place, axis) in enumerate(hinges):
            pair = [names[i % len(names)], names[(i + 1) % len(names)]] if self.bodies > 1 else names
            at = written(move(tuple(map(Fraction, place))))
            axis_text = [str(Fraction(x)) for x in axis]
            joints.append({"name": f"hinge{i}", "type": "revolute", "between": pair, "at": at, "axis": axis_text})
        return {"bodies": names[1:], "constraints": joints, **more}


NEAR = [
    # 2 + 5 = 4 + 3: in line, where two branches cross (an indefinite second order); beside it B's bars are not parallel
    Near(
        "four-bar at its change point",
        lambda e: framework({"B": (-2, e), "C": (2, 0)}, [(0, 0), (5, 0)], "0B BC C1"),
        (1, 2),
        (1, 1),
    ),
    # flat, where the parallelogram and the antiparallelogram cross
    Near(
        "flat parallelogram",
        lambda e: framework({"B": (1, e), "C": (3, e)}, [(0, 0), (2, 0)], "0B BC C1"),
        (1, 2),
        (1, 1),
    ),
    # B is as far from both ends as it can be
    Near("two bars in line", lambda e: framework({"B": (1, e)}, [(0, 0), (2, 0)], "0B B1"), (0, 1), (0, 0)),
    # a third parallel crank: as long as the others it does no harm; longer, its circle touches the coupler's inside
    Near(
        "third crank longer",
        lambda e: framework({"B": (0, 1), "C": (2, 1), "F": (1, 3 + e)}, [(0, 0), (2, 0), (1, 2)], "0B 1C 2F BC CF FB"),
        (1, 1),
        (0, 1),
    ),
    # its foot aside: the three cranks are neither parallel nor through one point
    Near(
        "third crank aside",
        lambda e: framework({"B": (0, 1), "C": (2, 1), "F": (1, 3)}, [(0, 0), (2, 0), (1 + e, 2)], "0B 1C 2F BC CF FB"),
        (1, 1),
        (0, 0),
    ),
    # legs through the origin with stress 3, 2, 6: the second order of the turn is 3*3 + 2*4 + 6*4 = 41 > 0, rigid
    Near(
        "three legs through one point",
        lambda e: framework(
            {"P": (1, 0), "Q": (0, 1), "R": (-1, -1)}, [(3, 0), (0, 4), (-2, -2 + e)], "0P 1Q 2R PQ QR RP"
        ),
        (0, 1),
        (0, 0),
    ),
    # 1 + 1 = 2: on every configuration one line, rank 2
    Near(
        "three on a rod, plane",
        lambda e: framework({"A": (0, 0), "B": (1, 0), "C": (2, e)}, [], "AB BC CA"),
        (3, 4),
        (3, 3),
    ),
    Near(
        "three on a rod, space",
        lambda e: framework({"A": (0, 0, 0), "B": (1, 0, 0), "C": (2, e, 0)}, [], "AB BC CA"),
        (5, 7),
        (6, 6),
    ),
    # the tetrahedron's volume is 0: it stays flat, and all six bars lie in one plane, rank 5
    Near(
        "flat tetrahedron",
        lambda e: framework({"A": (0, 0, 0), "B": (2, 0, 0), "C": (0, 3, 0), "D": (1, 1, e)}, [], "AB AC AD BC BD CD"),
        (6, 7),
        (6, 6),
    ),
    # nine bars between three and three joints are dependent on a conic and nowhere else [BolkerRoth1980]
    Near(
        "three and three on a circle",
        lambda e: framework(
            {"A": (1, 0), "B": (0, 1), "C": (-1, 0), "D": ("3/5", "4/5"), "E": ("-3/5", "4/5"), "F": (0, e - 1)},
            [],
            "AD AE AF BD BE BF CD CE CF",
        ),
        (None, 4),
        (3, 3),
    ),
    # triangles in perspective: bars with stress 2, 1, 2, the turn's second order is 2*2 + 1*3 + 2*4 = 15 > 0, rigid
    Near(
        "three bars of a prism",
        lambda e: framework(
            {"A": (1, 0), "B": (0, 1), "C": (-1, -1), "P": (2, 0), "Q": (0, 3), "R": (-2, -2 + e)},
            [],
            "AB BC CA PQ QR RP AP BQ CR",
        ),
        (3, 4),
        (3, 3),
    ),
    # three legs in one plane, pulling at the apex with 3, 2, 4: it can leave the plane to first order only
    Near(
        "flat tripod",
        lambda e: framework({"T": (0, 0, e)}, [(2, 0, 0), (-1, 2, 0), (-1, -1, 0)], "0T 1T 2T"),
        (0, 1),
        (0, 0),
    ),
]

JOINTED = [
    # two hinges on one line are one; parallel lines apart, or a tilted one, hold the door
    Jointed(
        "door on hinges out of line", lambda e: [((0, 0, 0), (0, 0, 1)), ((e, 0, 2), (0, 0, 1))], 1, (1, 1), (0, 0)
    ),
    Jointed("door on tilted hinges", lambda e: [((0, 0, 0), (0, 0, 1)), ((0, 0, 2), (e, 0, 1))], 1, (1, 1), (0, 0)),
    # four parallel axes have rank 3, three of them not in one plane too; a tilted one brings a fourth direction
    Jointed(
        "four-bar with a tilted axis",
        lambda e: [((0, 0, 0), (0, 0, 1)), ((0, 1, 0), (0, 0, 1)), ((3, 2, 0), (0, 0, 1)), ((2, 0, 0), (e, 0, 1))],
        3,
        (1, 1),
        (0, 0),
    ),
    # axes through one point have rank 3; one that misses it is no combination of three that span all turns about it
    Jointed(
        "spherical four-bar off its centre",
        lambda e: [((1, 0, 0), (1, 0, 0)), ((0, 1, 0), (0, 1, 0)), ((0, 0, 1), (0, 0, 1)), ((1 + e, 1, 1), (1, 1, 1))],
        3,
        (1, 1),
        (0, 0),
    ),
    # Bennett's four screws have rank 3, any three of them too; a turned axis is outside of them
    Jointed(
        "Bennett, one axis turned",
        lambda e: [
            ((0, 0, 0), (0, 0, 1)),
            ((52, 0, 0), (0, -4, 3)),
            ((16, -9, -12), (-3, -4, 12)),
            ((0, 39, 0), (3, e, 4)),
        ],
        3,
        (1, 1),
        (0, 0),
    ),
]


STEPS = tuple(Fraction(1, 10**k) for k in range(1, 13))
#: Digits to which coordinates are rounded.
DIGITS = (12, 9, 6, 4, 3)
MILLION = 10**6
MOVES: dict[str, Move] = {
    "as drawn": lambda p: p,
    "a million times larger": lambda p: tuple(x * MILLION for x in p),
    "a million times smaller": lambda p: tuple(x / MILLION for x in p),
    "moved a hundred away": lambda p: tuple(x + 100 * (k + 1) for k, x in enumerate(p)),
    "moved a million away": lambda p: tuple(x + MILLION * (k + 1) for k, x in enumerate(p)),
    "small and far away": lambda p: tuple(x / MILLION + MILLION for x in p),
}
#: (scale, offset) of each.
MOVED: dict[str, tuple[float, float]] = {
    "as drawn": (1, 0),
    "a million times larger": (MILLION, 0),
    "a million times smaller": (1 / MILLION, 0),
    "moved a hundred away": (1, 100),
    "moved a million away": (1, MILLION),
    "small and far away": (1 / MILLION, MILLION),
}
SEEDS = range(2)
TOLERANCES = ("1e-4",)


def steps() -> Iterator[KnownScene]:
    """At its singular pose, and 10^-1 ... 10^-12 beside it."""
    for step in (Fraction(0), *STEPS):
        for near in NEAR:
            freedom = near.beside if step else near.there
            name = f"{near.name}, {float(step):g} beside"
            yield _drawn(name, near.at(step), freedom, {"step": float(step)})
        for jointed in JOINTED:
            yield _jointed(jointed, step, "as drawn")


def sizes() -> Iterator[KnownScene]:
    """A million times larger, smaller, and far away: at the singular pose and beside it."""
    for how, move in MOVES.items():
        for step in (Fraction(0), STEPS[0]):
            for near in NEAR:
                freedom = near.beside if step else near.there
                name = f"{near.name}, {float(step):g} beside, {how}"
                yield _drawn(name, near.at(step).moved(move), freedom, _swept(step, how))
            for jointed in JOINTED:
                yield _jointed(jointed, step, how)


def shuffles() -> Iterator[KnownScene]:
    """Renamed and in another order."""
    for seed in SEEDS:
        for near in NEAR:
            for step in (Fraction(0), STEPS[2]):
                freedom = near.beside if step else near.there
                drawn = near.at(step).shuffled(random.Random(f"{near.name} {seed}"))
                name = f"{near.name}, {float(step):g} beside, shuffled by {seed}"
                yield _drawn(name, drawn, freedom, {"step": float(step)})


def turned(position: Position) -> Position:
    """Turned by the angle of 5, 12, 13 about the origin, 10/7 as large, aside: no decimals are exact."""
    x, y, *rest = position
    a, b = Fraction(5, 13), Fraction(12, 13)
    return tuple(v * 10 / 7 + Fraction(1, 3) for v in (a * x - b * y, b * x + a * y, *rest))


def rounded(digits: int) -> Move:
    """To so many digits after the point."""
    return lambda p: tuple(Fraction(round(x * 10**digits), 10**digits) for x in p)


def roundings() -> Iterator[KnownScene]:
    """Singular poses with rounded coordinates: by themselves the truth is of what is written, exactly.

    Where the bars are independent then, so is every configuration near: the motion is as large as the rank says.
    """
    for digits in DIGITS:
        for near in NEAR:
            drawn = near.at(Fraction(0)).moved(turned).moved(rounded(digits))
            first = drawn.by_rank()
            regular = drawn.coordinates - first == len(drawn.bars)
            freedom = (first if regular else None, first)
            yield _drawn(f"{near.name}, {digits} digits", drawn, freedom, {"digits": digits})


def measured() -> Iterator[KnownScene]:
    """The same with a tolerance of the last digit: the truth is of what was rounded."""
    for digits in DIGITS:
        for near in NEAR:
            drawn = near.at(Fraction(0)).moved(turned).moved(rounded(digits))
            name = f"{near.name}, {digits} digits with tolerance"
            swept = {"digits": digits, "tolerance": 10.0**-digits}
            yield _drawn(name, drawn, near.there, swept, tolerance=f"1e-{digits}")


def measured_elsewhere() -> Iterator[KnownScene]:
    """Exact drawings with a tolerance, of any size and anywhere."""
    for tolerance in TOLERANCES:
        for how, move in MOVES.items():
            for step in (Fraction(0), Fraction(1, 2)):
                for near in NEAR:
                    freedom = near.beside if step else near.there
                    name = f"{near.name}, {float(step):g} beside, {how}, within {tolerance}"
                    swept = {**_swept(step, how), "tolerance": float(tolerance)}
                    yield _drawn(name, near.at(step).moved(move), freedom, swept, tolerance=tolerance)
                for jointed in JOINTED:
                    yield _jointed(jointed, step, how, tolerance=tolerance)


def _swept(step: Fraction, how: str) -> dict[str, Any]:
    scale, offset = MOVED[how]
    return {"step": float(step), "scale": scale, "offset": offset}


def _jointed(near: Jointed, step: Fraction, how: str, **more: Any) -> KnownScene:
    freedom = near.beside if step else near.there
    equations = 5 * len(near.hinges(step))
    scene = near.scene(step, MOVES[how], **more)
    swept = _swept(step, how) | {key: float(value) for key, value in more.items()}
    return _known(f"{near.name}, {float(step):g} beside, {how}", scene, 6 * near.bodies, equations, freedom, swept)


def _drawn(name: str, drawn: Framework, freedom: Freedom, swept: Mapping[str, Any], **more: Any) -> KnownScene:
    """A framework with what is known of its freedom."""
    return _known(name, drawn.scene(**more), drawn.coordinates, len(drawn.bars), freedom, swept)


def _known(
    name: str, scene: dict[str, Any], coordinates: int, equations: int, freedom: Freedom, swept: Mapping[str, Any]
) -> KnownScene:
    """Where the rows are independent at the reference configuration, no constraint can be dropped."""
    dof, first = freedom
    truth: dict[str, Any] = {"consistent": True, "instantaneous_dof": first}
    if dof is not None:
        truth |= {"dof": dof, "velocity_dof": dof, "singular": first != dof}
        truth["redundant_equations"] = max(0, equations - (coordinates - dof))
    if first == coordinates - equations:
        truth["redundant"] = []
    return KnownScene(scene, truth, name=name, group=name.partition(",")[0], swept=swept)


#: Every sweep by name.
SWEEPS: dict[str, Callable[[], Iterator[KnownScene]]] = {
    "beside a singular pose": steps,
    "scaled and moved": sizes,
    "renamed and reordered": shuffles,
    "rounded": roundings,
    "rounded, with tolerance": measured,
    "scaled and moved, with tolerance": measured_elsewhere,
}
