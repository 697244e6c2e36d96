"""Scenes of the table of speed, and what rivals do with them."""

from __future__ import annotations

import math
import multiprocessing
import random
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import partial
from itertools import combinations, product
from typing import Any

import dofkit

#: Seconds that a rival is given for one answer.
PATIENCE = 30.0
Scene = Mapping[str, Any]
Links = list[tuple[int, int]]


def sympy_car(n: int) -> list[bool]:
    """The rival on the car."""
    import sympy

    _, _, phi, *th = q = sympy.symbols(f"x y phi th0:{n + 1}")
    length, *arms = sympy.symbols(f"l:{n + 1}", positive=True)
    rows = [[sympy.sin(th[0] + phi), -sympy.cos(th[0] + phi), 0, -length * sympy.cos(phi), *([0] * n)]]
    for i, angle in enumerate(th):
        row = [sympy.sin(angle), -sympy.cos(angle), 0, 0]
        rows.append(row + [arms[j] * sympy.cos(angle - th[j + 1]) if j < i else 0 for j in range(n)])
    return frobenius(rows, q)


def frobenius(rows: Sequence[Sequence[Any]], q: Sequence[Any]) -> list[bool]:
    """d(omega_a) ^ omega_1 ^ ... ^ omega_r = 0 for each a: by coefficients, each simplified."""
    import sympy

    n, r = len(q), len(rows)
    matrix = sympy.Matrix([list(row) for row in rows])
    found = []
    for row in rows:
        curl = {(i, j): sympy.diff(row[j], q[i]) - sympy.diff(row[i], q[j]) for i, j in combinations(range(n), 2)}
        totals = []
        for columns in combinations(range(n), r + 2):
            total = sympy.Integer(0)
            for i, j in combinations(columns, 2):
                if curl[i, j] != 0:
                    others = [c for c in columns if c not in (i, j)]
                    sign = sympy.LeviCivita(*(columns.index(c) for c in (i, j, *others)))
                    total += sign * curl[i, j] * matrix[:, others].det(method="berkowitz")
            totals.append(total)
        found.append(all(sympy.simplify(total) == 0 for total in totals))
    return found


def patiently(work: Callable[..., object], *arguments: int) -> float | None:
    """The rival's seconds, warm, in a process of its own; None where it does not finish."""
    receiver, sender = multiprocessing.Pipe(False)
    process = multiprocessing.get_context("fork").Process(target=_timed, args=(sender, work, arguments))
    process.start()
    found = receiver.recv() if receiver.poll(PATIENCE) else None
    process.kill()
    process.join()
    return None if found is None else float(found)


def _timed(sender: Any, work: Callable[..., object], arguments: Sequence[int]) -> None:
    import sympy

    sympy.simplify(sympy.sin(sympy.Symbol("x")) ** 2)
    start = time.perf_counter()
    work(*arguments)
    sender.send(time.perf_counter() - start)


def rigid(n: int, d: int, extra: int) -> Links:
    """n joints, each linked to d before it, and more links at random: all in random order."""
    rng = random.Random(n)
    links = [(w, v) for v in range(1, n) for w in rng.sample(range(v), min(v, d))]
    known = set(links)
    while len(links) < n * d - d * (d + 1) // 2 + extra:
        a, b = sorted((rng.randrange(n), rng.randrange(n)))
        if a != b and (a, b) not in known:
            known.add((a, b))
            links.append((a, b))
    rng.shuffle(links)
    return links


def triangles(n: int) -> Links:
    """A square grid of about n joints with one diagonal in every square: about n redundant links."""
    m = math.isqrt(n)
    steps = ((1, 0), (0, 1), (1, 1))
    return [
        (i * m + j, (i + a) * m + j + b)
        for i, j in product(range(m), repeat=2)
        for a, b in steps
        if i + a < m and j + b < m
    ]


def kagome(n: int, braced: bool = False) -> Links:
    """Triangles that share corners, about n joints; ``braced``: with the links across, so that n are redundant."""
    m = math.isqrt(n // 3)
    links = []
    for i, j in product(range(m), repeat=2):
        a, b, c = (3 * (i * m + j) + k for k in range(3))
        right, up, across = 3 * m, 3, 3 * m - 3
        links += [(a, b), (b, c), (c, a)]
        links += [(b, a + right)] if i + 1 < m else []
        links += [(c, a + up)] if j + 1 < m else []
        links += [(b, c + across)] if i + 1 < m and j else []
        if braced and i + 1 < m and j + 1 < m:
            links += [(b, b + up), (c, c + right), (a, a + right)]
    return links


def least_seconds(work: Callable[[], object], rounds: int) -> float:
    """Time that passes, or the processor's where that is less as others work too; warm, the least of some rounds."""
    work()
    taken = []
    for _ in range(rounds):
        start, began = time.process_time(), time.perf_counter()
        work()
        taken += [time.process_time() - start, time.perf_counter() - began]
    return min(taken)


def redundant(links: Any, dimension: int) -> Callable[[], object]:
    """The public entry, the links read and all redundant ones told."""
    return partial(dofkit.redundant_links, links, dimension)


def by_pyrigi(links: Links) -> int:
    """The rank by PyRigi's pebble game."""
    import pyrigi

    return int(pyrigi.Graph(links).spanning_kl_sparse_subgraph(2, 3).number_of_edges())


def linked(links: Links) -> dict[str, Any]:
    """A scene of links in the plane as it is written."""
    names = [f"P{v}" for v in range(1 + max(map(max, links)))]
    written = [{"type": "link", "between": [names[a], names[b]]} for a, b in links]
    return {"dimension": 2, "particles": names, "constraints": written}


def truss(links: int) -> Links:
    """One strip of triangles, each on the one before."""
    return [(v, v + k) for v in range(links // 2) for k in (1, 2)]


def apart_triangles(links: int) -> Links:
    """Triangles that share nothing."""
    return [(3 * k + a, 3 * k + b) for k in range(links // 3) for a, b in ((0, 1), (1, 2), (0, 2))]


def seconds(work: Callable[[], object]) -> float:
    """How long ``work`` takes."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def medians(*works: Callable[[], object], rounds: int) -> list[float]:
    """The median time of each, all taken in turns; one round before does not count."""
    times: list[list[float]] = [[] for _ in works]
    for turn in range(rounds + 1):
        for work, taken in zip(works, times, strict=True):
            spent = seconds(work)
            if turn:
                taken.append(spent)
    return [statistics.median(taken) for taken in times]


def python(*arguments: str) -> Callable[[], object]:
    """A fresh Python with ``arguments``."""
    return lambda: subprocess.run([sys.executable, *arguments], check=True, capture_output=True)


def discs(number: int) -> dict[str, Any]:
    """Equal discs, each rolling by itself."""
    places = [name for k in range(number) for name in (f"x{k}", f"y{k}", f"theta{k}", f"phi{k}")]
    rolls = [f"d{q}{k} = R {f}(theta{k}) dphi{k}" for k in range(number) for q, f in (("x", "cos"), ("y", "sin"))]
    return {"parameters": {"R": "positive"}, "coordinates": places, "constraints": rolls}


def turned(seed: int) -> dict[str, object]:
    """A delta robot with its constraints in any order, turned, moved and scaled anyhow."""
    rng = random.Random(f"delta {seed}")
    c, s = rng.choice([(1, 0), (Fraction(3, 5), Fraction(4, 5)), (Fraction(-5, 13), Fraction(12, 13))])
    size, away = rng.choice([1, 7, Fraction(1, 10)]), rng.choice([0, 5, Fraction(-7, 3)])

    def moved(p: Sequence[Fraction | int], point: bool = True) -> list[str]:
        x, y, z = p[0] * c - p[1] * s, p[0] * s + p[1] * c, p[2]
        return [str(size * v + away) if point else str(v) for v in (x, y, z)]

    constraints: list[dict[str, object]] = []
    for k, (a, b) in enumerate([(1, 0), (Fraction(-3, 5), Fraction(4, 5)), (Fraction(-5, 13), Fraction(-12, 13))]):
        arm = f"arm{k}"
        pin = {"at": moved((3 * a, 3 * b, 0)), "axis": moved((-b, a, 0), False)}
        constraints.append({"type": "revolute", "between": ["ground", arm], **pin})
        for side in (1, -1):
            ends = [{"on": arm, "at": moved((5 * a - side * b, 5 * b + side * a, 0))}]
            ends.append({"on": "platform", "at": moved((2 * a - side * b, 2 * b + side * a, -4))})
            constraints.append({"type": "link", "between": ends})
    rng.shuffle(constraints)
    return {"bodies": ["arm0", "arm1", "arm2", "platform"], "constraints": constraints}
