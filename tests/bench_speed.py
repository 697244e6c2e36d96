"""The table of speed, in one command: every row with its rival or its bound, in a process of its own.

python tests/bench_speed.py [ROW...] [--list] [--dry]

Writes tests/charts/speed.json and the table of dofkit/site/pages/about/speed.md; with names of rows only these are
measured again. It takes two to five minutes, and wants a machine that does nothing else.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import platform
import random
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parent))

from shared import speed_scenes
from shared.lecture_scenes import written_copies
from shared.speed_table import DATA, PAGE, Goal, Measured, Ran, SpeedRow, SpeedRun, with_table
from shared.trees import tree_with_loops

import dofkit
from dofkit.benchmark.command import machine
from dofkit.benchmark.trials.forms import car

#: Seconds that a row may take by the clock, what it needs included.
PATIENCE = 60.0
#: So many functions enter every form; a longer text than theirs is not read.
ALL_USED = 4
#: Scenes that are classified by workers, and those that the goal is about.
SCENES, MANY = 6000, 100_000


class Row(NamedTuple):
    """A row: what is measured, against whom, and what it should reach."""

    work: str
    goal: Goal
    measure: Callable[[], Measured]
    rival: str = ""


def seconds(value: float) -> Goal:
    """At most so many seconds."""
    return Goal("seconds", value)


def times(value: float) -> Goal:
    """So many times faster than the rival."""
    return Goal("times", value)


def median(work: Callable[[], object], rounds: int) -> float:
    """Seconds by the clock, the median; the first does not count."""
    taken = [speed_scenes.seconds(work) for _ in range(rounds + 1)]
    return statistics.median(taken[1:])


# open trees, and many loops on them


def of_scene(scene: Mapping[str, Any], dof: int, rounds: int) -> Measured:
    """From the mapping to the whole report; a small one of the kind is answered before."""
    right = []

    def work() -> None:
        right.append(dofkit.classify(dofkit.load(dict(scene))).dof == dof)

    dofkit.classify(tree_with_loops(5, 1, 0)[0])
    taken = [speed_scenes.seconds(work) for _ in range(rounds)]
    return Measured(statistics.median(taken), right=all(right))


def tree(bodies: int, loops: int, rounds: int) -> Measured:
    """A tree drawn anyhow, with four-bars on it."""
    return of_scene(*tree_with_loops(bodies, loops, 7), rounds)


def model(wheel: str, name: str, rounds: int = 3) -> Measured:
    """A model inside a wheel, read before; its freedom is MuJoCo's own."""
    from models.test_wheels import folder

    from dofkit.models.mjcf import compiled
    from dofkit.models.model_document import ModelFile

    path = next(folder(wheel).rglob(name))
    left = compiled(ModelFile(path.read_bytes(), path.stem, path)).content["left"]
    scene, told = dofkit.load(path), []
    dofkit.classify(tree_with_loops(5, 1, 0)[0])
    taken = [speed_scenes.seconds(lambda: told.append(dofkit.classify(scene))) for _ in range(rounds)]
    return Measured(statistics.median(taken), right=all(report.instantaneous_dof == left for report in told))


def delta() -> Measured:
    """A delta robot told in fifty ways: the slowest against the fastest."""
    spent = []
    for seed in range(50):
        scene = dofkit.load(speed_scenes.turned(seed))
        spent.append(min(speed_scenes.seconds(partial(dofkit.classify, scene)) for _ in range(3)))
    return Measured(statistics.median(spent), fold=max(spent) / min(spent))


# equal blocks, and large scenes


def discs(number: int, rounds: int) -> Measured:
    """Equal discs that roll apart from each other."""
    return of_scene(speed_scenes.discs(number), 4 * number, rounds)


def links(made: Callable[[int], speed_scenes.Links], number: int, dof: int) -> Measured:
    """As many links of the plane as one scene."""
    return of_scene(speed_scenes.linked(made(number)), dof, 1)


def wide(constraints: int) -> Measured:
    """A chain of hinges, discs that roll, and equations, a third each, all in one scene."""
    n = constraints // 3
    rolling = speed_scenes.discs(n // 2)
    more = [f"s{k}" for k in range(n + 1)]
    scene = {
        **rolling,
        "dimension": 2,
        "bodies": [f"b{i}" for i in range(n)],
        "coordinates": [*rolling["coordinates"], *more],
        "constraints": [
            *({"type": "revolute", "between": [f"b{i - 1}" if i else "ground", f"b{i}"], "at": [i, i % 7]}
              for i in range(n)),
            *rolling["constraints"],
            *(f"s{k + 1} = {1 + k % 5} s{k} + {k % 11}" for k in range(n)),
        ],
    }  # fmt: skip
    return of_scene(scene, n + 4 * (n // 2) + 1, 1)


# differential forms


class Letters(NamedTuple):
    """Coordinates and functions, as texts or as SymPy's."""

    q: list[Any]
    sin: Callable[[Any], Any]
    cos: Callable[[Any], Any]
    product: Callable[..., Any]
    total: Callable[[list[Any]], Any]


def integrable(forms: int, n: int, of: Letters) -> list[list[Any]]:
    """Coefficients of dense forms that integrate together: combinations of the differentials of functions f_a, the
    sums over i of c_ai sin(q_i) q_(i+1) + e_ai q_i^3; of all of them, or of two where there are many."""
    rng = random.Random(2)
    c, e = ([[rng.randint(1, 5) for _ in range(n)] for _ in range(forms)] for _ in "ce")

    def slope(a: int, i: int) -> Any:
        return of.total([
            of.product(c[a][i], of.cos(of.q[i]), of.q[(i + 1) % n]),
            of.product(c[a][i - 1], of.sin(of.q[i - 1])),
            of.product(3 * e[a][i], of.q[i], of.q[i]),
        ])  # fmt: skip

    def factor(row: int, a: int) -> Any:
        return of.total([2 + row, of.sin(of.q[row])]) if row == a else of.q[(row + a + 1) % n]

    return [
        [of.total([of.product(factor(row, a), slope(a, i)) for a in used]) for i in range(n)]
        for row in range(forms)
        if (used := range(forms) if forms <= ALL_USED else sorted({row, (row + 1) % forms}))
    ]


def dense(forms: int, n: int) -> dict[str, Any]:
    """Such forms as a scene: its freedom is n - forms."""
    names = [f"q{i}" for i in range(n)]
    written = Letters(
        names, "sin({})".format, "cos({})".format, lambda *parts: "*".join(map(str, parts)),
        lambda parts: f"({' + '.join(map(str, parts))})",
    )  # fmt: skip
    texts = [
        " + ".join(f"{text} d{name}" for name, text in zip(names, row, strict=True)) + " = 0"
        for row in integrable(forms, n, written)
    ]
    return {"coordinates": names, "constraints": texts}


def sympy_dense(forms: int, n: int) -> list[bool]:
    """SymPy on the same forms: their wedge products, by coefficients, each simplified."""
    import sympy

    q = list(sympy.symbols(f"q0:{n}"))
    rows = integrable(forms, n, Letters(q, sympy.sin, sympy.cos, lambda *parts: sympy.prod(parts), sum))
    return speed_scenes.frobenius(rows, q)


def forms(scene: Mapping[str, Any], dof: int, rounds: int, rival: tuple[Any, ...] = ()) -> Measured:
    """The whole report of a scene that was read."""
    loaded, right = dofkit.load(dict(scene)), []
    ours = median(lambda: right.append(dofkit.classify(loaded).dof == dof), rounds)
    return Measured(ours, speed_scenes.patiently(*rival) if rival else None, right=all(right))


def asked(scene: Mapping[str, Any], rounds: int, rival: tuple[Any, ...]) -> Measured:
    """One question: does everything integrate?"""
    loaded, right = dofkit.load(dict(scene)), []

    def ask() -> None:
        right.append(all((dofkit.ask(loaded, "integrability").value or {"": None}).values()))

    return Measured(median(ask, rounds), speed_scenes.patiently(*rival), right=all(right))


# graphs of links


def against_pyrigi() -> Measured:
    """1 000 joints in the plane and a tenth more links than they need."""
    links = speed_scenes.rigid(1000, 2, 100)
    theirs = speed_scenes.least_seconds(partial(speed_scenes.by_pyrigi, links), 1)
    return Measured(speed_scenes.least_seconds(speed_scenes.redundant(links, 2), 5), theirs)


def complete(n: int) -> list[tuple[int, int]]:
    """K(4, n - 4)."""
    return [(a, b) for b in range(4, n) for a in range(4)]


def growth(make: Callable[[int], list[tuple[int, int]]]) -> Measured:
    """Time for each joint of 10^5, against that of 10^3; every redundant link is told."""
    each = {}
    for n, rounds in ((1000, 20), (100_000, 1)):
        links = make(n)
        each[n] = speed_scenes.least_seconds(speed_scenes.redundant(links, 2), rounds) / (1 + max(map(max, links)))
    return Measured(each[100_000] * 1e5, fold=each[100_000] / each[1000])


# the command line


def cold(*arguments: str) -> Measured:
    """A fresh Python, against one that imports SymPy."""
    ours, theirs = speed_scenes.medians(
        speed_scenes.python("-m", "dofkit", *arguments), speed_scenes.python("-c", "import sympy"), rounds=9
    )
    return Measured(ours, theirs)


def many_scenes() -> Measured:
    """Lecture scenes, each with names of its own, by one worker for each core; scaled to 10^5."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        written_copies(folder / "scenes", SCENES)
        command = [sys.executable, "-m", "dofkit", "classify", str(folder / "scenes"), "--out", str(folder / "out")]
        start = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        taken = time.perf_counter() - start
        told = [json.loads(line) for line in (folder / "out" / "reports.jsonl").read_text().splitlines()]
    return Measured(taken * MANY / SCENES, right=len(told) == SCENES and all("error" not in one for one in told))


SYMPY, WEDGE = "`import sympy`", "SymPy, wedge and simplify"
ROWS = {
    "dog": Row("dm_control's dog, an open tree of 62 bodies", seconds(0.3),
               partial(model, "dm_control", "suite/dog.xml")),
    "tree-62": Row("a tree of 62 bodies", seconds(0.3), partial(tree, 62, 0, 5)),
    "tree-1000": Row("a tree of 1 000 bodies", seconds(1), partial(tree, 1000, 0, 3)),
    "tree-10000": Row("a tree of 10 000 bodies", seconds(10), partial(tree, 10_000, 0, 1)),
    "kitchen": Row("gymnasium-robotics' kitchen: 43 bodies, small loops", seconds(2),
                   partial(model, "gymnasium_robotics", "kitchen_env_model.xml")),
    "hand": Row("its hand with tendons", seconds(2), partial(model, "gymnasium_robotics", "hand/reach.xml")),
    "loops-43": Row("a tree of 43 bodies with 10 four-bars", seconds(2), partial(tree, 43, 10, 3)),
    "delta": Row("a delta robot described in 50 ways: the slowest", Goal("fold", 2), delta),
    "discs-1000": Row("1 000 equal discs", seconds(0.3), partial(discs, 1000, 3)),
    "discs-10000": Row("10 000 equal discs", seconds(3), partial(discs, 10_000, 1)),
    "dense-2-4": Row("two dense forms in 4 coordinates, holonomic", times(50),
                     partial(forms, dense(2, 4), 2, 9, (sympy_dense, 2, 4)), WEDGE),
    "dense-2-4-ask": Row("the same, one question (`ask`)", times(100),
                         partial(asked, dense(2, 4), 9, (sympy_dense, 2, 4)), WEDGE),
    "dense-4-8": Row("four in 8", seconds(0.15), partial(forms, dense(4, 8), 4, 5)),
    "dense-8-16": Row("eight in 16", seconds(0.5), partial(forms, dense(8, 16), 8, 3)),
    "trailers-6": Row("a car with 6 trailers", times(40),
                      partial(forms, car(6), 10, 5, (speed_scenes.sympy_car, 6)), WEDGE),
    "trailers-20": Row("a car with 20 trailers", seconds(0.4), partial(forms, car(20), 24, 3)),
    "truss": Row("10^5 constraints in one scene: a truss of links", seconds(10),
                 partial(links, speed_scenes.truss, 100_000, 4)),
    "apart": Row("the same: triangles of links", seconds(10),
                 partial(links, speed_scenes.apart_triangles, 99_999, 99_999)),
    "wide": Row("the same: hinges, rolling discs and equations, a third each", seconds(10), partial(wide, 100_000)),
    "links": Row("1 000 joints in the plane, pure Python", times(100), against_pyrigi, "PyRigi"),
    "growth-k": Row("K(4, n), 10^3 to 10^5 joints: time for a joint", Goal("fold", 1.3), partial(growth, complete)),
    "growth-triangles": Row("triangulated squares, the same", Goal("fold", 1.3),
                            partial(growth, speed_scenes.triangles)),
    "growth-kagome": Row("kagome, braced, the same", Goal("fold", 1.3),
                         partial(growth, partial(speed_scenes.kagome, braced=True))),
    "cold": Row("`dofkit classify disc-rolling-on-plane`, cold", Goal("share", 1.5),
                partial(cold, "classify", "disc-rolling-on-plane"), SYMPY),
    "many": Row("10^5 lecture scenes by a worker for each core (6 000, scaled)", seconds(240), many_scenes),
}  # fmt: skip


def measured(key: str) -> tuple[Measured | None, str]:
    """A row in a process of its own; where there is nothing, why."""
    receiver, sender = multiprocessing.Pipe(False)
    process = multiprocessing.get_context("spawn").Process(target=_told, args=(sender, key), daemon=False)
    process.start()
    sender.close()
    try:
        found = receiver.recv() if receiver.poll(PATIENCE) else (None, f"not done after {PATIENCE:.0f} s")
    except EOFError:
        found = None, "its process ended"
    process.kill()
    process.join()
    return (None if found[0] is None else Measured(*found[0])), found[1]


def _told(sender: Any, key: str) -> None:
    """In that process; `pytest.skip`, where a wheel is missing, is no error of this."""
    try:
        sender.send((tuple(ROWS[key].measure()), ""))
    except BaseException as error:
        sender.send((None, " ".join(str(error).split())[:120] or type(error).__name__))


def main() -> None:
    """Measure, write the data and the page, and say what it came to."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("rows", nargs="*", metavar="ROW", choices=[[], *ROWS], help="only these, by their names")
    parser.add_argument("--list", action="store_true", help="the names of the rows")
    parser.add_argument("--dry", action="store_true", help="write nothing")
    asked_for = parser.parse_args()
    if asked_for.list:
        print("\n".join(f"{key:<18} {row.work}" for key, row in ROWS.items()))
        return
    start, date = time.monotonic(), f"{datetime.now(UTC):%Y-%m-%d}"
    known = {row.key: row for row in SpeedRun.read(DATA).rows} if DATA.exists() else {}
    for key in asked_for.rows or ROWS:
        row = ROWS[key]
        found, why = measured(key)
        known[key] = SpeedRow(key, row.work, row.rival, row.goal, found, why)
        told = known[key]
        print(f"{key:<18} {'-' if told.figure is None else f'{told.figure:10.4g}'}  ({row.goal.text()})  "
              f"{'-' if told.met is None else 'yes' if told.met else 'NO'}  {why}", flush=True)  # fmt: skip
    minutes = (time.monotonic() - start) / 60
    ran = Ran("python tests/bench_speed.py", date, machine(), os.cpu_count() or 1, platform.python_version(), minutes)
    run = SpeedRun(ran, tuple(known[key] for key in ROWS if key in known))
    if not asked_for.dry:
        run.write(DATA)
        PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8"), run), encoding="utf-8")
    print(f"{minutes:.1f} minutes; {sum(bool(row.met) for row in run.rows)} of {len(run.rows)} rows reach their goal")


if __name__ == "__main__":
    main()
