"""How fast dofkit is against SymPy on this machine: ratios of medians, taken in turns. Run it; it is no test.

python tests/bench.py [repeats]

It ends with the rows of the table of speed, which `bench_speed.py` measures: a ratio or a bound each.
"""

from __future__ import annotations

import random
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from pathlib import Path

import dofkit

ROUNDS = int(sys.argv[1]) if sys.argv[1:] and sys.argv[1].isdigit() else 7
DISC = {
    "parameters": {"R": "positive"},
    "coordinates": ["x", "y", "theta", "phi"],
    "constraints": ["dx = R cos(theta) dphi", "dy = R sin(theta) dphi"],
}
HEAVY = ("sympy", "numpy", "networkx", "pydantic")


def seconds(work: Callable[[], object]) -> float:
    """How long ``work`` takes."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def medians(*works: Callable[[], object], rounds: int = ROUNDS) -> list[float]:
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


def told(what: str, ours: float, theirs: float, wanted: str) -> None:
    """One line: both times and their ratio."""
    print(f"{what:<58} {ours * 1e3:9.1f} ms {theirs * 1e3:9.1f} ms  {ours / theirs:7.3f}  ({wanted})")


def imports(arguments: Sequence[str]) -> None:
    """Whether a cold start leaves the heavy packages alone."""
    command = [sys.executable, "-X", "importtime", *arguments]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    names = {line.rpartition("|")[2].strip().partition(".")[0] for line in said.splitlines()}
    found = [name for name in HEAVY if name in names]
    print(f"{' '.join(arguments):<58} imports {', '.join(found) or 'none of ' + ', '.join(HEAVY)}")


def wedges() -> list[bool]:
    """What a user of SymPy does for each form: is d(omega_a) ^ omega_1 ^ omega_2 zero, by coefficients, simplified?"""
    import sympy

    q = sympy.symbols("x y theta phi")
    radius = sympy.Symbol("R", positive=True)
    forms = [[1, 0, 0, -radius * sympy.cos(q[2])], [0, 1, 0, -radius * sympy.sin(q[2])]]
    found = []
    for form in forms:
        total = sympy.Integer(0)
        for i, j in combinations(range(4), 2):
            k, m = (n for n in range(4) if n not in (i, j))
            minor = forms[0][k] * forms[1][m] - forms[0][m] * forms[1][k]
            curl = sympy.diff(form[j], q[i]) - sympy.diff(form[i], q[j])
            total += sympy.LeviCivita(i, j, k, m) * curl * minor
        found.append(sympy.simplify(total) == 0)
    return found


def rolling_disc() -> object:
    """From the scene to the whole report."""
    return dofkit.classify(dofkit.load(DISC))


def discs(number: int) -> dict[str, object]:
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


def bounded(what: str, scene: Mapping[str, object], dof: int, bound: float) -> None:
    """One line: the whole report from the mapping on, in processor time, against its bound."""
    start = time.process_time()
    report = dofkit.classify(dofkit.load(scene))
    spent = time.process_time() - start
    right = "right" if report.dof == dof else f"{report.dof}, not {dof}"
    print(f"{what:<58} {spent:9.2f} s  {right}  (at most {bound:g} s)")


def large() -> None:
    """What grows: open trees, many loops on one tree, equal blocks; and one mechanism told in fifty ways."""
    from shared.trees import tree_with_loops

    dofkit.classify(tree_with_loops(3, 1, 0)[0])
    rows = [("open tree, 62 bodies", 62, 0, 0.3), ("open tree, 1 000 bodies", 1000, 0, 3.0)]
    rows += [("tree of 43 bodies with 10 four-bars", 43, 10, 4.0), ("tree of 100 with 40 four-bars", 100, 40, 10.0)]
    for what, bodies, loops, bound in rows:
        scene, dof = tree_with_loops(bodies, loops, 7)
        bounded(what, scene, dof, bound)
    bounded("1 000 equal discs", discs(1000), 4000, 1.5)
    spent = []
    for seed in range(50):
        scene = dofkit.load(turned(seed))
        spent.append(min(seconds(lambda scene=scene: dofkit.classify(scene)) for _ in range(3)))
    ratio = max(spent) / min(spent)
    print(f"{'a delta robot, 50 orders, places, turns and sizes':<58} {ratio:9.2f}-fold  (at most 2)")


def table_of_speed() -> None:
    """The rows of the table in the site, each in a process of its own; the page is left as it is."""
    print("\nthe table of speed: measured, (goal), reached?", flush=True)
    subprocess.run([sys.executable, str(Path(__file__).with_name("bench_speed.py")), "--dry"], check=True)


def main() -> None:
    """Print everything."""
    imports(["-c", "import dofkit"])
    imports(["-m", "dofkit", "--help"])
    imports(["-m", "dofkit", "classify", "disc-rolling-on-plane"])
    scene = ("-m", "dofkit", "classify", "--json", "disc-rolling-on-plane")
    catalog = ("-m", "dofkit", "classify", "--json", *dofkit.catalog_names())
    print(f"{'':<58} {'dofkit':>12} {'sympy':>12}    ratio")
    one, everything, sympy = medians(python(*scene), python(*catalog), python("-c", "import sympy"))
    told("one lecture scene, cold, against `import sympy`", one, sympy, "at most 1")
    told(f"the whole catalog ({len(catalog) - 4}), cold, against the same", everything, sympy, "at most 6")
    report, wedge = medians(rolling_disc, wedges, rounds=10 * ROUNDS)
    told("rolling disc, warm: whole report against wedge, simplify", report, wedge, "below 1")
    large()
    table_of_speed()


if __name__ == "__main__":
    main()
