"""Frameworks of bars and joints at exact positions, and random frameworks, trees and loops of bodies."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from typing import Any

from flint import fmpq, fmpq_mat

Position = tuple[Fraction, ...]
#: A name of a free joint, or the number of a joint on the ground.
End = str | int


@dataclass(frozen=True)
class Framework:
    """Free joints by name, joints on the ground by number, all with exact positions, and bars between them."""

    joints: Mapping[str, Position]
    ground: tuple[Position, ...]
    bars: tuple[tuple[End, End], ...]

    @property
    def dimension(self) -> int:
        return len(next(iter(self.joints.values())))

    def at(self, end: End) -> Position:
        return self.joints[end] if isinstance(end, str) else self.ground[end]

    def moved(self, to: Callable[[Position], Position]) -> Framework:
        """Return the framework with the map ``to`` applied to every position."""
        joints = {name: to(p) for name, p in self.joints.items()}
        return replace(self, joints=joints, ground=tuple(to(p) for p in self.ground))

    def rows(self) -> list[list[Fraction]]:
        """Return the rigidity matrix: a row for every bar, d columns for every free joint."""
        d = self.dimension
        column = {name: d * i for i, name in enumerate(self.joints)}
        rows = []
        for a, b in self.bars:
            row = [Fraction(0)] * (d * len(column))
            for k, (x, y) in enumerate(zip(self.at(a), self.at(b), strict=True)):
                if isinstance(a, str):
                    row[column[a] + k] += x - y
                if isinstance(b, str):
                    row[column[b] + k] += y - x
            rows.append(row)
        return rows

    @property
    def coordinates(self) -> int:
        return self.dimension * len(self.joints)

    def by_rank(self) -> int:
        """Return the instantaneous freedom at the positions, by the exact rank."""
        return self.coordinates - exact_rank(self.rows())

    def scene(self, drawn: bool = True, **more: Any) -> dict[str, Any]:
        """Return the scene of links, with positions if ``drawn`` (needed with ground), else in general position."""
        particles: list[Any] = list(self.joints)
        if drawn:
            particles = [{"name": name, "at": written(p)} for name, p in self.joints.items()]
        ends = [[e if isinstance(e, str) else written(self.ground[e]) for e in bar] for bar in self.bars]
        links = [{"name": f"bar{i}", "type": "link", "between": pair} for i, pair in enumerate(ends)]
        return {"dimension": self.dimension, "particles": particles, "constraints": links, **more}


def written(position: Position) -> list[str]:
    """Return the exact coordinates of a position as texts."""
    return [str(x) for x in position]


def bars(text: str) -> tuple[tuple[End, End], ...]:
    """Return the bars of a text such as ``AB B0``: letters are free joints, digits are joints on the ground."""
    return tuple((_end(pair[0]), _end(pair[1])) for pair in text.split())


def _end(letter: str) -> End:
    return int(letter) if letter.isdigit() else letter


def framework(joints: dict[str, Sequence[Any]], ground: Sequence[Sequence[Any]], text: str) -> Framework:
    """Return the framework with these positions (numbers or texts) and the bars of ``text`` (see `bars`)."""
    placed = {name: tuple(map(Fraction, p)) for name, p in joints.items()}
    return Framework(placed, tuple(tuple(map(Fraction, p)) for p in ground), bars(text))


def hinged_loop(hinges: Sequence[tuple[Position, Position]], bodies: int) -> dict[str, Any]:
    """Return a scene: a loop of hinges (place, axis) through the ground and ``bodies``; one body has all hinges."""
    names = ["ground", *(f"link{i}" for i in range(bodies))]
    joints = []
    for i, (place, axis) in enumerate(hinges):
        pair = [names[i % len(names)], names[(i + 1) % len(names)]] if bodies > 1 else names
        about = {"at": written(place), "axis": written(axis)}
        joints.append({"name": f"hinge{i}", "type": "revolute", "between": pair, **about})
    return {"bodies": names[1:], "constraints": joints}


# Random frameworks, trees and loops of bodies

Vector = tuple[Fraction, Fraction, Fraction]
#: {joint type: its freedom in space}.
FREEDOMS = {"revolute": 1, "prismatic": 1, "cylindrical": 2, "universal": 2, "spherical": 3, "planar": 3, "weld": 0}
PLANE = ("revolute", "prismatic", "weld")
ZERO = (Fraction(0),) * 3


def graph(rng: random.Random, dimension: int, joints: int, twice: bool = False) -> Framework:
    """Return random bars between joints at random places; ``twice``: at times one pair has two bars."""
    names = [f"J{i}" for i in range(joints)]
    pairs = list(combinations(names, 2))
    rank = dimension * joints - dimension * (dimension + 1) // 2
    number = min(len(pairs), max(1, rank + rng.randrange(-3, 4)))
    chosen = rng.sample(pairs, number)
    if twice and rng.random() < 1 / 4:
        chosen.insert(rng.randrange(number + 1), rng.choice(chosen))
    bars = tuple(pair[:: rng.choice((1, -1))] for pair in chosen)
    return Framework({name: place(rng, dimension) for name in names}, (), tuple((b[0], b[1]) for b in bars))


def place(rng: random.Random, dimension: int, size: int = 10**6) -> Position:
    """Return a random point with coordinates of three decimals, up to ``size``/1000."""
    return tuple(Fraction(rng.randrange(-size, size + 1), 1000) for _ in range(dimension))


def dependent(drawn: Framework) -> list[int]:
    """Return the numbers of the bars whose rows depend on earlier rows, by exact elimination at the positions."""
    rows = drawn.rows()
    columns = [[fmpq(row[k].numerator, row[k].denominator) for row in rows] for k in range(drawn.coordinates)]
    reduced, rank = fmpq_mat(columns).rref()
    pivots = {next(c for c in range(len(rows)) if reduced[r, c] != 0) for r in range(rank)}
    return [i for i in range(len(rows)) if i not in pivots]


@dataclass(frozen=True)
class RandomBodies:
    """A scene of random bodies: ``first`` is its instantaneous freedom, ``dof`` the freedom if that implies it."""

    scene: dict[str, Any]
    equations: int
    coordinates: int
    first: int
    dof: int | None


def tree(rng: random.Random, dimension: int, bodies: int) -> RandomBodies:
    """Return a random tree, each body joined to an earlier one or the ground; the freedoms of the joints add up."""
    kinds = list(FREEDOMS) if dimension == 3 else list(PLANE)
    chosen = [rng.choice(kinds) for _ in range(bodies)]
    joints = []
    for i, kind in enumerate(chosen):
        onto = "ground" if i == 0 else rng.choice(["ground", *(f"b{j}" for j in range(i))])
        joints.append(_joint(rng, kind, dimension, f"j{i}", onto, f"b{i}")[0])
    freedom = sum(FREEDOMS[kind] for kind in chosen)
    freedom_of_body = dimension * (dimension + 1) // 2
    names = [f"b{i}" for i in range(bodies)]
    rng.shuffle(joints)
    scene = {"dimension": dimension, "bodies": names, "constraints": joints}
    return RandomBodies(scene, bodies * freedom_of_body - freedom, bodies * freedom_of_body, freedom, freedom)


def loop(rng: random.Random, dimension: int, bodies: int) -> RandomBodies:
    """Return a random closed loop with the ground: its velocities are the joints' rates whose screws sum to 0.

    If the screws are independent nothing moves; if they span all screws the loop's equations are independent.
    """
    kinds = [k for k in (FREEDOMS if dimension == 3 else PLANE) if k != "weld"]
    names = ["ground", *(f"b{i}" for i in range(bodies)), "ground"]
    joints, screws = [], []
    for i in range(bodies + 1):
        joint, allowed = _joint(rng, rng.choice(kinds), dimension, f"j{i}", names[i], names[i + 1])
        joints.append(joint)
        screws += allowed
    freedom_of_body = dimension * (dimension + 1) // 2
    rank = exact_rank(screws)
    first = len(screws) - rank
    dof = first if first == 0 or rank == freedom_of_body else None
    equations = (bodies + 1) * freedom_of_body - len(screws)
    scene = {"dimension": dimension, "bodies": names[1:-1], "constraints": joints}
    return RandomBodies(scene, equations, bodies * freedom_of_body, first, dof)


def _joint(
    rng: random.Random, kind: str, dimension: int, name: str, first: str, second: str
) -> tuple[dict[str, Any], list[list[Fraction]]]:
    """Return a joint at a random place, and the screws (angular velocity, velocity of the origin) that it allows."""
    at, u = (_vector(rng, dimension) for _ in range(2))
    scene: dict[str, Any] = {"name": name, "type": kind, "between": [first, second]}
    if kind not in ("weld", "prismatic"):
        scene["at"] = [str(x) for x in at[:dimension]]
    if dimension == 2:
        if kind == "prismatic":
            scene["axis"] = [str(x) for x in u[:2]]
        turn: Vector = (Fraction(0), Fraction(0), Fraction(1))
        return scene, {"revolute": [_turn(turn, at)], "prismatic": [_slide(u)], "weld": []}[kind]
    v = _across(u)
    w = cross(u, v)
    if kind == "universal":
        scene["axes"] = [[str(x) for x in u], [str(x) for x in v]]
    elif kind not in ("spherical", "weld"):
        scene["axis"] = [str(x) for x in u]
    return scene, {
        "revolute": [_turn(u, at)],
        "prismatic": [_slide(u)],
        "cylindrical": [_turn(u, at), _slide(u)],
        "universal": [_turn(u, at), _turn(v, at)],
        "spherical": [_turn(u, at), _turn(v, at), _turn(w, at)],
        "planar": [_turn(u, at), _slide(v), _slide(w)],
        "weld": [],
    }[kind]


def _vector(rng: random.Random, dimension: int) -> Vector:
    x, y, z = (Fraction(rng.choice([n for n in range(-9, 10) if n])) for _ in range(3))
    return (x, y, z if dimension == 3 else Fraction(0))


def _across(u: Vector) -> Vector:
    return (-u[1], u[0], Fraction(0))


def cross(a: Vector, b: Vector) -> Vector:
    """Return a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _turn(axis: Vector, at: Vector) -> list[Fraction]:
    return [*axis, *cross(at, axis)]


def _slide(axis: Vector) -> list[Fraction]:
    return [*ZERO, *axis]


def exact_rank(rows: Sequence[Sequence[Fraction]]) -> int:
    """Return the rank over the rationals."""
    return int(fmpq_mat([[fmpq(x.numerator, x.denominator) for x in row] for row in rows]).rank()) if rows else 0
