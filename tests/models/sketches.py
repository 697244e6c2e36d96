"""Random SolveSpace sketches: their files, and the rank of what SolveSpace solves, by its own formulas in floats."""

from __future__ import annotations

import cmath
import math
import random
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np

Values = list[complex]
Residual = Callable[[Values], list[complex]]
PLANE = 0x80020000


@dataclass
class RandomSketch:
    """A sketch in the making: records of its file, unknowns as drawn, and what must be zero."""

    records: list[str] = field(default_factory=list)
    drawn: list[float] = field(default_factory=list)
    points: list[tuple[int, int]] = field(default_factory=list)
    lines: list[tuple[int, int, int]] = field(default_factory=list)
    circles: list[tuple[int, int, int]] = field(default_factory=list)
    arcs: list[tuple[int, int, int, int]] = field(default_factory=list)
    residuals: list[Residual] = field(default_factory=list)
    constraints: int = 0
    requests: int = 3

    def __post_init__(self) -> None:
        self.record("Group", h_v="00000001", type="5000", name="#references")
        self.record(
            "Group", h_v="00000002", type="5001", subtype="6000", predef_origin_v="00010001", name="sketch-in-plane"
        )
        self.record("Request", h_v="00000001", type="100", group_v="00000001")
        self.record("Entity", h_v="00010001", type="2000")
        self.record("Entity", h_v=f"{PLANE:08x}", type="10000", point_0="80020002", normal_v="80020001")
        self.record("Entity", h_v="80020001", type="3010", actNormal_w="1.0")
        self.record("Entity", h_v="80020002", type="2012")

    def record(self, kind: str, **values: str) -> None:
        spelled = {"point_0": "point[0].v", "point_1": "point[1].v", "point_2": "point[2].v", "point_3": "point[3].v"}
        lines = [f"{kind}.{spelled.get(key, key.replace('_', '.'))}={value}" for key, value in values.items()]
        self.records.append("\n".join([*lines, f"Add{kind}\n"]))

    def text(self) -> str:
        return "\xb1\xb2\xb3SolveSpaceREVa\n\n\n" + "\n".join(self.records)

    def request(self, kind: int) -> int:
        self.requests += 1
        self.record("Request", h_v=f"{self.requests:08x}", type=str(kind), group_v="00000002")
        return self.requests << 16

    def point(self, handle: int, x: float, y: float) -> int:
        place = {"actPoint_x": f"{x:.20f}", "actPoint_y": f"{y:.20f}"}
        self.record("Entity", h_v=f"{handle:08x}", type="2001", workplane_v=f"{PLANE:08x}", **place)
        self.points.append((handle, len(self.drawn)))
        self.drawn += [x, y]
        return len(self.drawn) - 2

    def line(self, a: tuple[float, float], b: tuple[float, float]) -> None:
        base = self.request(200)
        ends = self.point(base + 1, *a), self.point(base + 2, *b)
        self.record("Entity", h_v=f"{base:08x}", type="11000", point_0=f"{base + 1:08x}", point_1=f"{base + 2:08x}")
        self.lines.append((base, *ends))

    def circle(self, centre: tuple[float, float], radius: float) -> None:
        base = self.request(400)
        at = self.point(base + 1, *centre)
        self.record("Entity", h_v=f"{base + 64:08x}", type="4000", actDistance=f"{radius:.20f}")
        self.record("Entity", h_v=f"{base:08x}", type="13000", point_0=f"{base + 1:08x}", distance_v=f"{base + 64:08x}")
        self.circles.append((base, at, len(self.drawn)))
        self.drawn.append(radius)

    def arc(self, centre: tuple[float, float], radius: float, angles: tuple[float, float]) -> None:
        base = self.request(500)
        ends = [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]
        c, s, f = (self.point(base + 1 + k, *at) for k, at in enumerate((centre, *ends)))
        names = {f"point_{k}": f"{base + 1 + k:08x}" for k in range(3)}
        self.record("Entity", h_v=f"{base:08x}", type="14000", **names)
        self.arcs.append((base, c, s, f))
        self.residuals.append(lambda q: [_squared(q, c, s) - _squared(q, c, f)])

    def add(self, kind: int, residual: Residual, value: float = 0.0, **mentions: int) -> bool:
        """Add a constraint where the drawing satisfies it."""
        if max(abs(r) for r in residual([complex(v) for v in self.drawn])) > 1e-9:
            return False
        self.constraints += 1
        told = {f"{key}_v": f"{handle:08x}" for key, handle in mentions.items() if not key.startswith("other")}
        told |= {key: str(handle) for key, handle in mentions.items() if key.startswith("other")}
        self.record("Constraint", h_v=f"{self.constraints:08x}", type=str(kind), valA=f"{value:.20f}", **told)
        self.residuals.append(residual)
        return True

    def jacobian(self) -> np.ndarray:
        """By complex steps."""
        columns = []
        for k in range(len(self.drawn)):
            q = [complex(v) for v in self.drawn]
            q[k] += 1e-30j
            columns.append([r.imag / 1e-30 for residual in self.residuals for r in residual(q)])
        return np.array(columns).T.reshape(-1, len(self.drawn))


def _squared(q: Values, a: int, b: int) -> complex:
    return (q[a] - q[b]) ** 2 + (q[a + 1] - q[b + 1]) ** 2


def _arm(q: Values, a: int, b: int) -> tuple[complex, complex]:
    return q[b] - q[a], q[b + 1] - q[a + 1]


def _length(q: Values, a: int, b: int) -> complex:
    return cmath.sqrt(_squared(q, a, b))


def _cross(u: tuple[complex, complex], v: tuple[complex, complex]) -> complex:
    return u[0] * v[1] - u[1] * v[0]


def _dot(u: tuple[complex, complex], v: tuple[complex, complex]) -> complex:
    return u[0] * v[0] + u[1] * v[1]


def _cosine(q: Values, one: tuple[int, ...], other: tuple[int, ...]) -> complex:
    u, v = _arm(q, *one[1:3]), _arm(q, *other[1:3])
    return _dot(u, v) / cmath.sqrt(_dot(u, u) * _dot(v, v))


def random_sketch(seed: int) -> RandomSketch:
    """Lines, circles and arcs on a grid, with constraints of every kind that is read."""
    rng = random.Random(f"sketch {seed}")
    sketch = RandomSketch()

    def place() -> tuple[float, float]:
        return float(rng.randrange(-3, 4)), float(rng.randrange(-3, 4))

    sketch.line((0.0, 0.0), (2.0, 1.0))
    for _ in range(rng.randrange(1, 5)):
        a, b = place(), place()
        if a != b:
            sketch.line(a, b)
    if rng.random() < 0.5:
        _cross_over(sketch, rng)
    for _ in range(rng.randrange(0, 3)):
        sketch.circle(place(), float(rng.randrange(1, 4)))
    for _ in range(rng.randrange(0, 3)):
        start = rng.choice((0.0, math.pi / 2))
        sketch.arc(place(), float(rng.randrange(1, 4)), (start, start + math.pi / 2))
    wanted = rng.randrange(1, 12)
    for _ in range(400):
        if sketch.constraints < wanted:
            rng.choice(KINDS)(sketch, rng)
    return sketch


def _cross_over(s: RandomSketch, rng: random.Random) -> None:
    """A line across the middle of another, as far to both sides, and one from the middle."""
    _, a, b = rng.choice(s.lines)
    (x, y), (u, v) = s.drawn[a : a + 2], s.drawn[b : b + 2]
    middle = (x + u) / 2, (y + v) / 2
    s.line((middle[0] + v - y, middle[1] + x - u), (middle[0] - v + y, middle[1] - x + u))
    s.line(middle, (4.0, 5.0))


def coincident(s: RandomSketch, rng: random.Random) -> None:
    (h, a), (k, b) = rng.sample(s.points, 2)
    s.add(20, lambda q: [q[a] - q[b], q[a + 1] - q[b + 1]], ptA=h, ptB=k)


def distance(s: RandomSketch, rng: random.Random) -> None:
    (h, a), (k, b) = rng.sample(s.points, 2)
    at = _length([complex(v) for v in s.drawn], a, b).real
    if at > 0:
        s.add(30, lambda q: [_length(q, a, b) - at], at, ptA=h, ptB=k)


def line_distance(s: RandomSketch, rng: random.Random) -> None:
    (h, a), line = rng.choice(s.points), _line(s, rng)
    if line is None or a in line[1:]:
        return

    def away(q: Values) -> complex:
        return _cross(_arm(q, *line[1:]), _arm(q, line[1], a)) / _length(q, *line[1:])

    at = away([complex(v) for v in s.drawn]).real
    if abs(at) > 1e-9:
        s.add(32, lambda q: [away(q) - at], -at, ptA=h, entityA=line[0])
    else:
        s.add(42, lambda q: [away(q)], ptA=h, entityA=line[0])


def between_lines(s: RandomSketch, rng: random.Random) -> None:
    if len(s.lines) < 2:
        return
    one, other = rng.sample(s.lines, 2)
    q = [complex(v) for v in s.drawn]
    cosine, lengths = _cosine(q, one, other).real, [_length(q, *line[1:]).real for line in (one, other)]
    both = {"entityA": one[0], "entityB": other[0]}
    pick = rng.randrange(6)
    if pick == 0:
        s.add(121, lambda q: [_cross(_arm(q, *one[1:]), _arm(q, *other[1:]))], **both)
    elif pick == 1:
        s.add(122, lambda q: [_cosine(q, one, other)], **both)
    elif pick == 2:
        s.add(50, lambda q: [_length(q, *one[1:]) - _length(q, *other[1:])], **both)
    elif pick == 3:
        ratio = lengths[0] / lengths[1]
        s.add(51, lambda q: [_length(q, *one[1:]) / _length(q, *other[1:]) - ratio], ratio, **both)
    elif pick == 4:
        less = lengths[0] - lengths[1]
        s.add(56, lambda q: [_length(q, *one[1:]) - _length(q, *other[1:]) - less], less, **both)
    elif abs(cosine) < 0.999 and abs(cosine) > 1e-9:
        s.add(120, lambda q: [_cosine(q, one, other) - cosine], math.degrees(math.acos(cosine)), **both)


def level(s: RandomSketch, rng: random.Random) -> None:
    k = rng.randrange(2)
    line = _line(s, rng)
    if line is not None and rng.random() < 0.6:
        s.add((81, 80)[k], lambda q: [q[line[1] + k] - q[line[2] + k]], entityA=line[0])
        return
    (h, a), (i, b) = rng.sample(s.points, 2)
    s.add((81, 80)[k], lambda q: [q[a + k] - q[b + k]], ptA=h, ptB=i)


def symmetric(s: RandomSketch, rng: random.Random) -> None:
    (h, a), (i, b) = rng.sample(s.points, 2)
    line = _line(s, rng)
    k = rng.randrange(3)
    if k < 2:
        s.add(61 + k, lambda q: [q[a + 1 - k] - q[b + 1 - k], q[a + k] + q[b + k]], ptA=h, ptB=i)
    elif line is not None:
        off = [point for point in s.points if point[1] not in line[1:]]
        pairs = [(p, q) for p in off for q in off if p < q]
        for (h, a), (i, b) in rng.sample(pairs, min(40, len(pairs))):
            if s.add(63, partial(_mirrored, a=a, b=b, line=line), ptA=h, ptB=i, entityA=line[0]):
                return


def _mirrored(q: Values, a: int, b: int, line: tuple[int, ...]) -> list[complex]:
    along = _arm(q, *line[1:])
    apart = [_cross(along, _arm(q, line[1], p)) for p in (a, b)]
    return [_dot(along, _arm(q, a, b)), apart[0] + apart[1]]


def midpoint(s: RandomSketch, rng: random.Random) -> None:
    line = _line(s, rng)
    for h, a in rng.sample(s.points, len(s.points)):
        if line is None or a in line[1:]:
            continue
        middle = partial(_middle, line=line, a=a)
        if s.add(70, middle, ptA=h, entityA=line[0]):
            return


def _middle(q: Values, line: tuple[int, int, int], a: int) -> list[complex]:
    return [(q[line[1] + k] + q[line[2] + k]) / 2 - q[a + k] for k in (0, 1)]


def round_ones(s: RandomSketch, rng: random.Random) -> None:
    if s.circles:
        (base, c, r), (h, a) = rng.choice(s.circles), rng.choice(s.points)
        if rng.random() < 0.5:
            value = 2 * s.drawn[r]
            s.add(90, lambda q: [2 * q[r] - value], value, entityA=base)
        elif a != c:
            s.add(100, lambda q: [_squared(q, c, a) - q[r] ** 2], ptA=h, entityA=base)
    if len(s.circles) > 1:
        one, other = rng.sample(s.circles, 2)
        s.add(130, lambda q: [q[one[2]] - q[other[2]]], entityA=one[0], entityB=other[0])


def tangents(s: RandomSketch, rng: random.Random) -> None:
    line = _line(s, rng)
    if s.arcs and line is not None:
        arc, end = rng.choice(s.arcs), rng.randrange(2)
        s.add(123, lambda q: [_dot(_arm(q, *line[1:]), _arm(q, arc[1], arc[2 + end]))],
              entityA=arc[0], entityB=line[0], other=end)  # fmt: skip
    if len(s.arcs) > 1:
        one, two = rng.sample(s.arcs, 2)
        i, j = rng.randrange(2), rng.randrange(2)
        s.add(125, lambda q: [_cross(_arm(q, one[1], one[2 + i]), _arm(q, two[1], two[2 + j]))],
              entityA=one[0], entityB=two[0], other=i, other2=j)  # fmt: skip


def dragged(s: RandomSketch, rng: random.Random) -> None:
    h, a = rng.choice(s.points)
    x, y = s.drawn[a], s.drawn[a + 1]
    s.add(200, lambda q: [q[a] - x, q[a + 1] - y], ptA=h)


def _line(s: RandomSketch, rng: random.Random) -> tuple[int, int, int] | None:
    return rng.choice(s.lines) if s.lines else None


KINDS = (
    coincident, distance, line_distance, between_lines, between_lines, between_lines, level, level, symmetric, midpoint,
    round_ones, tangents, dragged,
)  # fmt: skip
