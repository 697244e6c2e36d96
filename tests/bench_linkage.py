"""How fast graphs of links are answered, and in how much memory, against PyRigi and numpy where those are tried.

python tests/bench_linkage.py [rounds]
"""

from __future__ import annotations

import gc
import math
import multiprocessing
import random
import resource
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from importlib.util import find_spec
from itertools import product
from typing import Any
from unittest.mock import patch

import numpy as np

import dofkit
from dofkit.mobility.graph import compiled

Links = list[tuple[int, int]]
#: Seconds that one row may take, with what it needs.
PATIENCE = 300.0
NUMBA = find_spec("numba") is not None


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


def seconds(work: Callable[[], object], rounds: int) -> float:
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


def every_circuit(links: Links) -> object:
    """The redundant links and a circuit for each."""
    return dofkit.linkage(links, 2).circuit_places


def last_circuit(links: Links) -> object:
    """The circuit of the last redundant link alone."""
    told = dofkit.linkage(links, 2)
    return told.circuit(told.redundant[-1])


def by_svd(links: Links, d: int) -> int:
    """The rank at random positions, by numpy."""
    n = 1 + max(map(max, links))
    at = np.random.default_rng(0).standard_normal((n, d))
    matrix = np.zeros((len(links), n * d))
    for row, (a, b) in zip(matrix, links, strict=True):
        row[a * d : a * d + d] = at[a] - at[b]
        row[b * d : b * d + d] = at[b] - at[a]
    return int(np.linalg.matrix_rank(matrix))


def by_pyrigi(links: Links) -> int:
    """The rank by PyRigi's pebble game."""
    import pyrigi

    return int(pyrigi.Graph(links).spanning_kl_sparse_subgraph(2, 3).number_of_edges())


def scene(links: Links, d: int) -> dofkit.Scene:
    """The same as a scene whose lengths are left out."""
    names = [f"P{v}" for v in range(1 + max(map(max, links)))]
    written = [{"type": "link", "between": [names[a], names[b]]} for a, b in links]
    return dofkit.load({"dimension": d, "particles": names, "constraints": written})


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


def discs(number: int) -> dict[str, Any]:
    """Equal discs, each rolling by itself: two texts each."""
    places = [name for k in range(number) for name in (f"x{k}", f"y{k}", f"theta{k}", f"phi{k}")]
    rolls = [f"d{q}{k} = R {f}(theta{k}) dphi{k}" for k in range(number) for q, f in (("x", "cos"), ("y", "sin"))]
    return {"parameters": {"R": "positive"}, "coordinates": places, "constraints": rolls}


def whole(what: str, written: dict[str, Any], dof: int, wanted: str, rounds: int = 1) -> None:
    """From the mapping to the whole report, checked; the least of some rounds, in processor time."""
    taken = []
    for _ in range(rounds):
        gc.collect()
        start = time.process_time()
        report = dofkit.classify(dofkit.load(written))
        taken.append(time.process_time() - start)
        if report.dof != dof or report.verdict != "proved":
            raise SystemExit(f"{what}: dof {report.dof} ({report.verdict}), not {dof}")
    line(what, min(taken), wanted)


def scenes() -> None:
    """Scenes of many constraints: equal blocks, and one block."""
    dofkit.classify(dofkit.load(discs(2)))
    whole("1 000 equal discs in one scene", discs(1000), 4000, "0.3 s", 3)
    whole("10^4 equal discs in one scene", discs(10_000), 40_000, "3 s")
    whole("10^5 constraints: triangles of links apart", linked(apart_triangles(99_999)), 99_999, "10 s")
    whole("10^5 constraints: one truss of links", linked(truss(100_000)), 4, "10 s")


def plain() -> AbstractContextManager[object]:
    """Nothing compiled."""
    return patch.multiple(compiled, WORTH_COMPILING=10**9, WORTH_CALLING=10**9)


def apart(work: Callable[[], float]) -> tuple[float | None, float]:
    """(what it tells, the memory of a process of its own in MB); None where it does not finish."""
    receiver, sender = multiprocessing.Pipe(False)
    process = multiprocessing.get_context("fork").Process(target=_told, args=(sender, work))
    process.start()
    found: tuple[float | None, float] = receiver.recv() if receiver.poll(PATIENCE) else (None, 0.0)
    process.kill()
    process.join()
    return found


def _told(sender: Any, work: Callable[[], float]) -> None:
    taken = work()
    sender.send((taken, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024))


def shown(taken: float | None) -> str:
    return f"over {PATIENCE:.0f} s" if taken is None else f"{taken * 1e3:.1f} ms"


def line(what: str, ours: float | None, wanted: str, rival: float | None = None) -> None:
    """Our time, the rival's where there is one and how many times faster."""
    ratio = "" if rival is None or not ours else f"{rival / ours:.0f} x"
    print(
        f"{what:<66} {shown(ours):>12} {'' if rival is None else shown(rival):>12} {ratio:>7}  ({wanted})", flush=True
    )


def large(what: str, make: Callable[[], Any], wanted: str, rounds: int = 1) -> None:
    """A graph in a process of its own, with its memory."""

    def work() -> float:
        links = make()
        gc.freeze()
        return seconds(redundant(links, 2), rounds)

    taken, memory = apart(work)
    line(f"{what}, {memory:.0f} MB with the graph", taken, wanted)


def growth(what: str, make: Callable[[int], Links], sizes: Sequence[int], rounds: int) -> None:
    """Time for each joint, against the smallest."""
    each = {}
    for n in sizes:
        links = make(n)
        joints = 1 + max(map(max, links))
        each[n] = seconds(redundant(links, 2), rounds) / joints
        number = len(dofkit.redundant_links(links, 2))
        grown = f"{each[n] / each[sizes[0]]:.2f} times linear from {sizes[0]}"
        line(f"{what}, {joints} joints, {number} redundant", each[n] * joints, grown)


def main(rounds: int = 3) -> None:
    """Print everything."""
    print(f"{'':<66} {'dofkit':>12} {'rival':>12} {'ratio':>7}  (asked)")
    thousand, many = rigid(1000, 2, 100), rigid(10_000, 2, 1000)
    pyrigi = seconds(partial(by_pyrigi, thousand), 1) if find_spec("pyrigi") else None
    line("plane, 1000 joints + 10 %, against PyRigi", seconds(redundant(thousand, 2), rounds), "100 x", pyrigi)
    if NUMBA:
        dofkit.redundant_links(rigid(30_000, 2, 0), 2)
        ready = seconds(redundant(thousand, 2), rounds)
        line("  where compiled code is ready, as after a large graph", ready, "100 x", pyrigi)
    with plain():
        line("plane, 10^4 joints, nothing compiled", seconds(redundant(many, 2), rounds), "1 s")
        line("  and a circuit for each redundant link", seconds(partial(every_circuit, many), 1), "5 s")
        line("  or for one of them", seconds(partial(last_circuit, many), 1), "5 s")
    if NUMBA:
        large("plane, 10^5 joints, pairs", partial(rigid, 10**5, 2, 10**4), "0.5 s", rounds)
        large("plane, 10^5 joints, an array", lambda: np.array(rigid(10**5, 2, 10**4)), "0.5 s", rounds)
        large("plane, 10^6 joints, pairs", partial(rigid, 10**6, 2, 10**5), "15 s, 1000 MB")
        large("plane, 10^6 joints, an array", lambda: np.array(rigid(10**6, 2, 10**5)), "15 s, 1000 MB")
        line("one circuit, 10^5 joints", seconds(partial(last_circuit, rigid(10**5, 2, 10**4)), 1), "5 s")
    for how, kept in (("", nullcontext()), (" (plain)", plain())):
        with kept:
            growth(f"triangles{how}", triangles, (1000, 10_000, 100_000), rounds)
            growth(f"kagome{how}", kagome, (1000, 10_000, 100_000), rounds)
            growth(f"braced kagome{how}", partial(kagome, braced=True), (1000, 10_000, 100_000), rounds)
    solid = rigid(1000, 3, 100)
    svd = seconds(partial(by_svd, solid, 3), 1)
    line("space, 1000 joints + 10 %, against numpy's SVD", seconds(redundant(solid, 3), rounds), "3 x", svd)
    scenes()
    for n, d in ((2000, 2), (1000, 3)):
        given = scene(rigid(n, d, n // 10), d)
        line(f"a scene of {n} joints in {d} dimensions", seconds(partial(dofkit.classify, given), 1), "seconds")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3)
