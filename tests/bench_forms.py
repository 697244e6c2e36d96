"""How fast differential constraints are answered, against SymPy's wedge and simplify where that is tried.

python tests/bench_forms.py [rounds]
"""

from __future__ import annotations

import multiprocessing
import random
import resource
import statistics
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import combinations
from typing import Any

import dofkit

#: Seconds that the rival is given for one answer.
PATIENCE = 60.0
Scene = Mapping[str, Any]
Rival = tuple[Any, ...]


def discs(n: int) -> Scene:
    """n upright discs that roll on one plane, apart from each other."""
    names = [f"{q}{i}" for i in range(n) for q in ("x", "y", "theta", "phi")]
    forms = [f"d{q}{i} = R {f}(theta{i}) dphi{i}" for i in range(n) for q, f in (("x", "cos"), ("y", "sin"))]
    return {"parameters": {"R": "positive"}, "coordinates": names, "constraints": forms}


def car(n: int) -> Scene:
    """A car that steers, with n trailers hitched at the axles: n + 2 forms in n + 4 coordinates."""
    angles = [f"th{i}" for i in range(n + 1)]
    forms = ["sin(th0 + phi) dx - cos(th0 + phi) dy - l cos(phi) dth0 = 0"]
    for i, angle in enumerate(angles):
        arms = "".join(f" + l{j} cos({angle} - th{j}) dth{j}" for j in range(1, i + 1))
        forms.append(f"sin({angle}) dx - cos({angle}) dy{arms} = 0")
    lengths = {"l": "positive"} | {f"l{j}": "positive" for j in range(1, n + 1)}
    return {"parameters": lengths, "coordinates": ["x", "y", "phi", *angles], "constraints": forms}


def dense_terms(forms: int, n: int) -> list[list[tuple[int, str, int, int, int, int]]]:
    """Coefficients a + f(q_j) q_k + b q_l^2 of coupled forms: every form has every differential."""
    rng = random.Random(1)
    return [
        [
            (rng.randint(1, 5), rng.choice(("sin", "cos")), *rng.choices(range(n), k=2), rng.randint(1, 5), i)
            for i in range(n)
        ]
        for _ in range(forms)
    ]  # fmt: skip


def dense(forms: int, n: int) -> Scene:
    """Coupled forms with dense coefficients."""
    texts = [
        " + ".join(f"({a} + {f}(q{j}) q{k} + {b} q{m}^2) dq{i}" for i, (a, f, j, k, b, m) in enumerate(row)) + " = 0"
        for row in dense_terms(forms, n)
    ]
    return {"coordinates": [f"q{i}" for i in range(n)], "constraints": texts}


def holonomic(forms: int, n: int, seed: int) -> tuple[Sequence[Any], list[list[Any]]]:
    """Coordinates and coefficients of forms that integrate together and not alone, for SymPy.

    f_a is a sum of c q_i q_j, c sin(q_i) q_j or c q_i^2 q_j, a term for every i; each form mixes two differentials df_a
    by factors c + sin(q_j) or c + cos(q_j).
    """
    import sympy

    rng, q = random.Random(f"holonomic {forms} {n} {seed}"), sympy.symbols(f"q0:{n}")
    kinds = (lambda x: x, sympy.sin, lambda x: x**2)
    functions = [
        sum(rng.randint(1, 5) * rng.choice(kinds)(q[i]) * q[(i + rng.randrange(1, n)) % n] for i in range(n))
        for _ in range(forms)
    ]
    rows = []
    for a in range(forms):
        pair = [(rng.randint(1, 5) + rng.choice((sympy.sin, sympy.cos))(q[rng.randrange(n)]), b % forms)
                for b in (a, a + 1)]  # fmt: skip
        rows.append([sum(factor * sympy.diff(functions[b], x) for factor, b in pair) for x in q])
    return q, rows


def dense_holonomic(forms: int, n: int, seed: int = 1) -> Scene:
    """The same forms as texts."""
    q, rows = holonomic(forms, n, seed)
    texts = [
        " + ".join(f"({a}) d{x}".replace("**", "^") for a, x in zip(row, q, strict=True) if a != 0) + " = 0"
        for row in rows
    ]
    return {"coordinates": [str(x) for x in q], "constraints": texts}


def sympy_holonomic(forms: int, n: int, seed: int) -> list[bool]:
    """The rival on the same forms."""
    q, rows = holonomic(forms, n, seed)
    return frobenius(rows, q)


def sympy_dense(forms: int, n: int) -> list[bool]:
    """The rival on the same forms."""
    import sympy

    q = sympy.symbols(f"q0:{n}")
    rows = [
        [a + getattr(sympy, f)(q[j]) * q[k] + b * q[m] ** 2 for a, f, j, k, b, m in row]
        for row in dense_terms(forms, n)
    ]
    return frobenius(rows, q)


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


def median(work: Callable[[], object], rounds: int) -> float:
    """Seconds, warm."""
    taken = []
    for turn in range(rounds + 1):
        start = time.perf_counter()
        work()
        if turn:
            taken.append(time.perf_counter() - start)
    return statistics.median(taken)


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


def line(what: str, ours: float, wanted: str, rival: Rival | None = None) -> None:
    """Our time, the rival's where there is one and how many times faster."""
    theirs = None if rival is None else patiently(*rival)
    said = "" if rival is None else f"over {PATIENCE:.0f} s" if theirs is None else f"{theirs * 1e3:9.1f} ms"
    ratio = "" if theirs is None else f"{theirs / ours:8.0f} x"
    print(f"{what:<52} {ours * 1e3:9.1f} ms {said:>13} {ratio:>10}  ({wanted})")


def in_turns(rounds: int) -> None:
    """Holonomic forms 2 in 4 of several kinds, whole report and labels alone: medians of ratios taken in turns."""
    reports, labels = [], []
    for seed in range(1, max(4, rounds) + 1):
        scene = loaded(dense_holonomic(2, 4, seed))
        ours, asked, theirs = (
            min(seconds(work) for _ in range(turns))
            for work, turns in (
                (partial(dofkit.classify, scene), 4),
                (partial(dofkit.ask, scene, "integrability"), 4),
                (partial(sympy_holonomic, 2, 4, seed), 1),
            )
        )
        reports.append(theirs / ours)
        labels.append(theirs / asked)
    for what, found, wanted in (("whole report", reports, 50), ("labels alone", labels, 100)):
        shown = f"{statistics.median(found):8.0f} x  ({min(found):.0f} to {max(found):.0f}; {wanted} x)"
        print(f"{f'dense holonomic forms, 2 in 4 coordinates, {what}':<52} {shown}")


def seconds(work: Callable[[], object]) -> float:
    """Of processor time, however busy the machine is."""
    start = time.process_time()
    work()
    return time.process_time() - start


def loaded(scene: Scene) -> dofkit.Scene:
    """The scene read once, as a user has it."""
    return dofkit.load(dict(scene))


def classified(scene: Scene) -> Callable[[], object]:
    """From the scene to the whole report."""
    return partial(dofkit.classify, loaded(scene))


def main(rounds: int = 5) -> None:
    """Print everything."""
    print(f"{'':<52} {'dofkit':>12} {'SymPy':>13} {'ratio':>10}")
    rows: list[tuple[str, Scene, str, Rival | None]] = [
        ("dense coupled forms, 2 in 4 coordinates", dense(2, 4), "100 x", (sympy_dense, 2, 4)),
        ("dense coupled forms, 4 in 8", dense(4, 8), "under 0.1 s", (sympy_dense, 4, 8)),
        ("dense coupled forms, 8 in 16", dense(8, 16), "under 0.5 s", None),
        ("dense holonomic forms, 4 in 8", dense_holonomic(4, 8), "under 0.15 s", None),
        ("dense holonomic forms, 8 in 16", dense_holonomic(8, 16), "under 0.5 s", None),
        ("car with 6 trailers", car(6), "40 x", (sympy_car, 6)),
        ("car with 20 trailers", car(20), "under 0.4 s", None),
    ]
    for what, scene, wanted, rival in rows:
        line(what, median(classified(scene), rounds), wanted, rival)
    in_turns(rounds)
    for n, wanted in ((3, "0.1 s"), (6, "1 s"), (8, "10 s")):
        flag = partial(dofkit.derived_flag, loaded(car(n)))
        line(f"derived flag, car with {n} trailers", median(flag, rounds), wanted)
    each = {n: median(classified(discs(n)), rounds) / n for n in (10, 100, 1000)}
    for n, one in each.items():
        grown = f"{one / each[10]:.2f} times linear from 10 (1.2)"
        print(f"{f'{n} rolling discs in one scene':<52} {one * n * 1e3:9.1f} ms  {grown}")
    print(f"memory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB at most (500)")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
