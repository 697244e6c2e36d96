"""How fast mechanisms are answered, with what a user has today: SymPy's rank, numpy's singular values.

python tests/bench_mechanisms.py [rounds]

numpy's and SymPy's times are those of the rank alone, of a Jacobian that is there already; dofkit's are from the scene
to the report.
"""

from __future__ import annotations

import random
import statistics
import sys
import time
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from shared.trees import tree_with_loops

import dofkit
from dofkit.mobility.placement import measured_placement
from dofkit.mobility.twists import rows_of
from dofkit.scene.lowering import lower

Scene = Mapping[str, Any]


def four_bar() -> Scene:
    """A plane four-bar linkage as drawn."""
    joints = [("ground", "a", [0, 0]), ("a", "b", [0, 1]), ("b", "c", [3, 2]), ("c", "ground", [4, 0])]
    return {"dimension": 2, "bodies": ["a", "b", "c"], "constraints": hinges(joints)}


def hinges(joints: list[tuple[str, str, list[int]]]) -> list[Scene]:
    """Hinges of the plane."""
    return [{"type": "revolute", "between": [a, b], "at": at} for a, b, at in joints]


def chain(n: int, dimension: int = 2) -> Scene:
    """n bodies hinged one to the next."""
    bodies = [f"b{i}" for i in range(n)]
    constraints = []
    for i, body in enumerate(bodies):
        joint: dict[str, Any] = {"type": "revolute", "between": [bodies[i - 1] if i else "ground", body]}
        joint["at"] = [i, 0, 0][:dimension]
        constraints.append(joint | ({"axis": [0, i % 3, 1]} if dimension == 3 else {}))
    return {"dimension": dimension, "bodies": bodies, "constraints": constraints}


def hung(n: int) -> Scene:
    """A rod on three parallel cranks, and n bodies in a chain under it."""
    joints = [("ground", "k1", [0, 0]), ("k1", "rod", [1, 2]), ("ground", "k2", [3, 0]), ("k2", "rod", [4, 2])]
    joints += [("ground", "k3", [7, 1]), ("k3", "rod", [8, 3])]
    names = [f"p{i}" for i in range(n)]
    joints += [(names[i - 1] if i else "rod", name, [4, 2 - i]) for i, name in enumerate(names)]
    return {"dimension": 2, "bodies": ["k1", "k2", "k3", "rod", *names], "constraints": hinges(joints)}


def grid(n: int, braced: float) -> Scene:
    """n x n squares of links drawn exactly; a part of them, drawn at random, with a diagonal."""
    rng = random.Random(1)
    particles = [{"name": f"p{i}_{j}", "at": [i, j]} for i in range(n + 1) for j in range(n + 1)]
    pairs = [(f"p{i}_{j}", f"p{i + 1}_{j}") for i in range(n) for j in range(n + 1)]
    pairs += [(f"p{i}_{j}", f"p{i}_{j + 1}") for i in range(n + 1) for j in range(n)]
    pairs += [(f"p{i}_{j}", f"p{i + 1}_{j + 1}") for i in range(n) for j in range(n) if rng.random() < braced]
    return {
        "dimension": 2,
        "particles": particles,
        "constraints": [{"type": "link", "between": list(pair)} for pair in pairs],
    }


def jacobian(scene: Scene) -> Any:
    """The relations between velocities in floating point."""
    system = lower(dofkit.load(dict(scene)))
    placement = measured_placement(system)
    rows = [row for found in placement.located for row in rows_of(found) or []] if placement else []
    matrix = np.zeros((len(rows), len(system.coordinates)))
    for i, row in enumerate(rows):
        for c, v in row.items():
            matrix[i, c] = v
    return matrix


def sympy_rank(scene: Scene) -> Callable[[], object]:
    """SymPy's rank of the same matrix in fractions."""
    import sympy

    exact = [[Fraction(v).limit_denominator(1000) for v in row] for row in jacobian(scene).tolist()]
    matrix = sympy.Matrix([[sympy.Rational(v.numerator, v.denominator) for v in row] for row in exact])
    return partial(matrix.rank, simplify=False)


def timed(work: Callable[[], object], rounds: int) -> float:
    """Seconds of this processor, warm."""
    taken = []
    for turn in range(rounds + 1):
        start = time.process_time()
        work()
        if turn:
            taken.append(time.process_time() - start)
    return statistics.median(taken)


def classified(scene: Scene) -> Callable[[], object]:
    """From the mapping to the report."""
    return lambda: dofkit.classify(dofkit.load(dict(scene)))


def line(what: str, ours: float, wanted: str, rival: str = "", theirs: float | None = None) -> None:
    """Our time, and the rival's where there is one."""
    said = "" if theirs is None else f"{rival} {theirs * 1e3:9.1f} ms ({theirs / ours:.2f} x)"
    print(f"{what:<52} {ours * 1e3:9.1f} ms  ({wanted})  {said}")


def bounded(what: str, work: Callable[[], dofkit.Report], dof: int | None, bound: float, rounds: int = 1) -> None:
    """One line: the least processor time of some rounds from the scene to the report, against its bound."""
    times, found = [], None
    for _ in range(rounds):
        start = time.process_time()
        found = work().dof
        times.append(time.process_time() - start)
    right = "right" if dof is None or found == dof else f"{found}, not {dof}"
    kept = "kept" if min(times) <= bound else "NOT KEPT"
    print(f"{what:<52} {min(times):9.2f} s   {right}  (at most {bound:g} s: {kept})")


def trees(rounds: int) -> None:
    """Open trees, which leave no equations, and loops on them, each on its own joints; and models of robots."""
    dofkit.classify(tree_with_loops(3, 1, 0)[0])
    for bodies, loops, bound in ((62, 0, 0.3), (1000, 0, 1.0), (10_000, 0, 10.0), (43, 10, 2.0), (100, 40, 6.0)):
        scene, dof = tree_with_loops(bodies, loops, 7)
        what = f"a tree of {bodies} bodies" + (f" with {loops} four-bars" if loops else "")
        bounded(what, partial(_report, scene), dof, bound, 1 if bodies > 1000 else rounds)
    for what, wheel, name, dof, bound in (
        ("the dog of dm_control", "dm_control", "suite/dog.xml", 85, 0.5),
        ("the kitchen of gymnasium-robotics", "gymnasium_robotics", "**/kitchen_env_model.xml", None, 2.0),
    ):
        found = find_spec(wheel)
        if found is None or found.origin is None:
            print(f"{what:<52} {wheel} is not installed")
            continue
        path = next(Path(found.origin).parent.glob(name))
        bounded(what, partial(_report, path), dof, bound, rounds)


def _report(source: Any) -> dofkit.Report:
    return dofkit.classify(dofkit.load(source))


def main(rounds: int = 3) -> None:
    """Print everything."""
    trees(rounds)
    singular = partial(np.linalg.svd, compute_uv=False)
    line("a four-bar", timed(classified(four_bar()), 10 * rounds), "10 ms", "SymPy rank",
         timed(sympy_rank(four_bar()), rounds))  # fmt: skip
    rows: list[tuple[str, Scene, str]] = [
        ("a chain of 300 bodies in the plane", chain(300), "0.5 s"),
        ("a chain of 300 bodies in space", chain(300, 3), "no bound set"),
        ("30 x 30 squares, every tenth braced", grid(30, 0.1), "3 s"),
        ("30 x 30 squares, every fifth braced", grid(30, 0.2), "3 s"),
    ]
    for what, scene, wanted in rows:
        matrix = jacobian(scene)
        line(what, timed(classified(scene), rounds), wanted, "numpy SVD", timed(partial(singular, matrix), 1))
    base, more = (timed(classified(hung(n)), rounds) for n in (0, 100))
    bare = timed(classified(chain(100)), rounds)
    line("three parallel cranks", base, "-")
    line("the same with a chain of 100 bodies under the rod", more, f"the chain by itself {bare * 1e3:.1f} ms")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3)
