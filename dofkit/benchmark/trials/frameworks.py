"""Bars and joints with exact positions, apart from dofkit: their matrix, their scene, their pictures."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from typing import Any

import numpy as np
from flint import fmpq, fmpq_mat, nmod_mat

from dofkit.mobility.graph.linkage import redundant_links

Position = tuple[Fraction, ...]
#: A name of a free joint, or the number of a joint on the ground.
End = str | int


@dataclass(frozen=True)
class Framework:
    """Free joints by name, joints on the ground by number, and bars between them, all drawn."""

    joints: Mapping[str, Position]
    ground: tuple[Position, ...]
    bars: tuple[tuple[End, End], ...]

    @property
    def dimension(self) -> int:
        return len(next(iter(self.joints.values())))

    def at(self, end: End) -> Position:
        return self.joints[end] if isinstance(end, str) else self.ground[end]

    def moved(self, to: Callable[[Position], Position]) -> Framework:
        """Every position moved."""
        joints = {name: to(p) for name, p in self.joints.items()}
        return replace(self, joints=joints, ground=tuple(to(p) for p in self.ground))

    def shuffled(self, rng: random.Random) -> Framework:
        """Joints renamed, and everything in another order."""
        names = list(self.joints)
        rng.shuffle(names)
        new = {name: f"J{rng.randrange(10**6)}_{i}" for i, name in enumerate(names)}
        bars = [tuple(new[e] if isinstance(e, str) else e for e in bar)[:: rng.choice((1, -1))] for bar in self.bars]
        rng.shuffle(bars)
        joints = {new[name]: self.joints[name] for name in names}
        return Framework(joints, self.ground, tuple((a, b) for a, b in bars))

    def rows(self) -> list[list[Fraction]]:
        """The rigidity matrix: a row for every bar, d columns for every free joint."""
        d = self.dimension
        place = {name: d * i for i, name in enumerate(self.joints)}
        rows = []
        for a, b in self.bars:
            row = [Fraction(0)] * (d * len(place))
            for k, (x, y) in enumerate(zip(self.at(a), self.at(b), strict=True)):
                if isinstance(a, str):
                    row[place[a] + k] += x - y
                if isinstance(b, str):
                    row[place[b] + k] += y - x
            rows.append(row)
        return rows

    @property
    def coordinates(self) -> int:
        return self.dimension * len(self.joints)

    # ways to count its freedom

    def by_count(self) -> int:
        """f = N d - k, as if every bar took one away."""
        return self.coordinates - len(self.bars)

    def by_graph(self) -> int:
        """The freedom in general position: bars less those that are redundant there."""
        fixed = list(combinations(range(len(self.ground)), 2))
        redundant = redundant_links([*fixed, *self.bars], self.dimension)
        return self.coordinates - len(self.bars) + sum(link not in fixed for link in redundant)

    def by_rank(self) -> int:
        """Velocities allowed at the positions, exactly."""
        rows = self.rows()
        if not rows:
            return self.coordinates
        return self.coordinates - int(fmpq_mat([[fmpq(v.numerator, v.denominator) for v in r] for r in rows]).rank())

    def by_svd(self, tolerance: float = 1e-9) -> int:
        """The same in floating point: singular values below a fraction of the largest count as 0."""
        if not self.bars:
            return self.coordinates
        values = np.linalg.svd(np.array(self.rows(), dtype=float), compute_uv=False)
        return self.coordinates - int(np.sum(values > tolerance * values[0]))

    def by_prime(self, p: int) -> int:
        """The rank modulo a prime, at the positions modulo it."""
        rows = [[v.numerator * pow(v.denominator, -1, p) % p for v in row] for row in self.rows()]
        return self.coordinates - (int(nmod_mat(rows, p).rank()) if rows else 0)

    # scenes

    def scene(self, drawn: bool = True, **more: Any) -> dict[str, Any]:
        """A scene with links; without positions all is in general position (a framework with ground needs them)."""
        particles: list[Any] = list(self.joints)
        if drawn:
            particles = [{"name": name, "at": written(p)} for name, p in self.joints.items()]
        ends = [[e if isinstance(e, str) else written(self.ground[e]) for e in bar] for bar in self.bars]
        links = [{"name": f"bar{i}", "type": "link", "between": pair} for i, pair in enumerate(ends)]
        return {"dimension": self.dimension, "particles": particles, "constraints": links, **more}


def written(position: Position) -> list[str]:
    """Coordinates as a person writes them: exact."""
    return [str(x) for x in position]


def bars(text: str) -> tuple[tuple[End, End], ...]:
    """``AB B0``: letters are free joints, figures those on the ground."""
    return tuple((_end(pair[0]), _end(pair[1])) for pair in text.split())


def _end(letter: str) -> End:
    return int(letter) if letter.isdigit() else letter


def framework(joints: dict[str, Sequence[Any]], ground: Sequence[Sequence[Any]], text: str) -> Framework:
    """A framework from numbers."""
    placed = {name: tuple(map(Fraction, p)) for name, p in joints.items()}
    return Framework(placed, tuple(tuple(map(Fraction, p)) for p in ground), bars(text))
