"""Configuration-level equations: dependent functions, rows, gaps, scales, powers, branches, chains."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import product

from dofkit.benchmark.trials.construction import KnownScene, known_scene, labels, numbered, scene_of, tables

TABLES = tables("equations.yaml")


def hidden_relations() -> Iterator[KnownScene]:
    """Functionally dependent relations; with an independent one, and with one that contradicts them."""
    for number, row in enumerate(TABLES["hidden"]):
        n, k = len(row["coordinates"].split()), len(row["rows"])
        members: list[tuple[str, str | None, int, list[str]]] = [
            ("one that follows", row["implied"], n - k, [f"c{k + 1}"]),
            ("one more", row["new"], n - k - 1, []),
            ("one that contradicts", row.get("never"), -1, []),
        ]
        for how, last, dof, over in members:
            if last is None or (dof < 0 and number % 2):
                continue
            scene = scene_of(row["coordinates"], *row["rows"], last)
            about = f"{row['name']}, {how}", scene, f"{row['implied']} by the rows before", k + 1
            yield known_scene(*about, dof=dof, redundancy=over)


def rotations() -> Iterator[KnownScene]:
    """R^T R = 1, then R R^T = 1 too: the second says nothing new, as a left inverse is a right one."""
    for n in (2, 3):
        names = [f"r{i}{j}" for i in range(n) for j in range(n)]
        pairs = [(i, j) for i in range(n) for j in range(i, n)]
        columns = [f"{' + '.join(f'r{k}{i}*r{k}{j}' for k in range(n))} = {int(i == j)}" for i, j in pairs]
        rows = [f"{' + '.join(f'r{i}{k}*r{j}{k}' for k in range(n))} = {int(i == j)}" for i, j in pairs]
        trace = " + ".join(f"r{i}{i}" for i in range(n)) + f" = {n} + 1e-9"
        over = numbered(len(rows), len(columns) + 1)
        for how, more, dof, redundant in (
            ("by columns", [], n * (n - 1) // 2, []),
            ("by columns and by rows", rows, n * (n - 1) // 2, over),
            ("that leave the first axis", ["r00 = 1"], (n - 1) * (n - 2) // 2, []),
            ("of trace beyond n", [trace], -1, []),
        ):
            scene = scene_of(names, *columns, *more)
            about = f"{n} by {n} {how}", scene, "a left inverse is a right one; entries are at most 1", n
            yield known_scene(*about, dof=dof, redundancy=redundant)


def linear_rows() -> Iterator[KnownScene]:
    """Linear equations; the last is a combination of the others, exactly or up to a tiny gap, also scaled."""
    because = "the first rows are in echelon form; the last is a combination of them, but for the gap"
    sizes = (3, 6, 12)
    for n, digits in ((n, d) for n in sizes for d in (6, 12, 30, 60)):
        if n > 6 and digits > 30:
            continue
        rng = random.Random(f"rows {n}")
        names = [f"x{k}" for k in range(n)]
        k = n // 2 + 1
        rows = [[Fraction(rng.randint(-9, 9)) if j >= i else Fraction(0) for j in range(n)] for i in range(k)]
        for i in range(k):
            rows[i][i] = Fraction(rng.randint(1, 9))
        right = [Fraction(rng.randint(-9, 9)) for _ in range(k)]
        factors = [Fraction(rng.randint(1, 9), rng.randint(1, 9)) for _ in range(k)]
        last = [sum((f * row[j] for f, row in zip(factors, rows, strict=True)), Fraction(0)) for j in range(n)]
        value = sum((f * b for f, b in zip(factors, right, strict=True)), Fraction(0))
        texts = [f"{_row(row)} = {b}" for row, b in zip(rows, right, strict=True)]
        step = f"1e-{digits}"
        for how, text, dof, over in (
            ("off by", f"{_row(last)} = {value} + {step}", -1, None),
            ("tilted by", f"{_row(last)} + {step}*x{n - 1} = {value}", n - k - 1, []),
            ("scaled by", f"{step}*({_row(last)} - ({value})) = 0", n - k, [f"c{k + 1}"]),
        ):
            about = f"{n} coordinates, {how} 1e-{digits}", scene_of(names, *texts, text), because, n
            yield known_scene(*about, dof=dof, redundancy=over)


def _row(row: Sequence[Fraction]) -> str:
    return " + ".join(f"({v})*x{j}" for j, v in enumerate(row) if v)


def touching() -> Iterator[KnownScene]:
    """Surfaces that miss each other by a gap, touch, or meet: none, a point, or more."""
    because = "real solutions are there on one side of the gap only"
    for row in TABLES["touching"]:
        for digits in (0, 12, 30, 60):
            signs = (("apart", f"1e-{digits}", 0), ("meeting", f"-1e-{digits}", 2))
            for how, e, k in (*signs, ("touching", "0", 1)) if digits in (9, 12) else signs:
                dof, over = row["dof"][k], row["redundant"][k] if digits in (0, 12) else None
                name = f"{row['name']}, {how}" + (f" by 1e-{digits}" if k != 1 else "")
                scene = scene_of(row["coordinates"], *(text.replace("{e}", e) for text in row["rows"]))
                about = name, scene, because, len(row["rows"])
                yield known_scene(*about, dof=dof, redundancy=over)


#: The exponents of ten of the offsets of equations that are moved far away.
FAR = (3, 6, 9)


def scales() -> Iterator[KnownScene]:
    """Circles and planes of any size, anywhere, in any unit: the answers must not depend on the scale."""
    for power in (-30, -9, -6, 3, 6, 9, 30):
        radius, offset = f"1e{power}", f"1e{abs(power)}"
        for row in TABLES["scales"]:
            if row.get("offset") and "holonomic" not in row and power not in FAR:
                continue
            scene = scene_of(row["coordinates"], *(text.format(r=radius, a=offset) for text in row["rows"]))
            label = {"c1": row["holonomic"]} if "holonomic" in row else None
            about = f"{row['name']}, {radius}", scene, row["because"]
            over = row.get("redundant")
            yield known_scene(*about, dof=row["dof"], integrability=label, redundancy=over)


def branches() -> Iterator[KnownScene]:
    """Products: the set is the union of the branches, the freedom that of the largest."""
    for row in TABLES["branches"]:
        scene = scene_of(row["coordinates"], *row["rows"])
        about = row["name"], scene, row["because"], len(scene["coordinates"])
        yield known_scene(*about, dof=row["dof"], integrability=labels(row.get("holonomic")))


# Equations with multiple zeros: only the real set of zeros counts

POWERS = (1, 2, 3, 8, 16, 32, 64)
#: The largest power of a sum that a scene may contain, because nested powers are bounded.
LARGEST = 32


def high_powers() -> Iterator[KnownScene]:
    """Powers of an equation have its zeros, and no gradient there; x^k with y^k are curves, points or nothing."""
    because = "a power is 0 where its base is; real even powers are not negative"
    for k, row in product(POWERS, TABLES["powers"]):
        if k <= LARGEST or "(" not in "".join(row["rows"]):
            scene = scene_of(row["coordinates"], *(text.format(k=k) for text in row["rows"]))
            dof = row["dof"][k % 2 == 0]
            over = None if dof < 0 else row.get("redundant", [])
            yield known_scene(f"{row['name']}, k = {k}", scene, because, k, dof=dof, redundancy=over)


def power_forms() -> Iterator[KnownScene]:
    """Forms with powers in them, and powers of forms."""
    for k, row in product(POWERS, TABLES["power forms"]):
        text = row["text"].format(k=k, j=k - 1)
        if k <= LARGEST or not text.startswith("("):
            about = f"{row['name']}, k = {k}", scene_of("x y z", text), row["because"], k
            yield known_scene(*about, dof=2 if row["integrates"] else 3, integrability={"c1": row["integrates"]})


def sums_of_squares() -> Iterator[KnownScene]:
    """A sum of n squares that is 0, which is n equations in one; with a sign or a constant it is not."""
    for n in (2, 3, 4, 6, 8, 12):
        total, mixed = _sum(n, "(x{k} - {k})^2"), _sum(n, "(x{k} + 2 x{next})^2")
        rows: list[tuple[str, str, int, str]] = [
            ("a point", f"{total} = 0", 0, "every square is 0"),
            ("a sphere", f"{total} = 1", n - 1, "a sphere"),
            ("nothing", f"{total} + 1 = 0", -1, "squares are not negative"),
            ("a paraboloid", f"{total} = (x0 + 1)^2", n - 1, "a quadric with a regular point"),
            ("sums of two", f"{mixed} = 0", 0, "the matrix 1 + 2 shift is regular: x = 0"),
            ("fourth powers", f"{_sum(n, 'x{k}^4')} = 0", 0, "all 0"),
        ]
        names = [f"x{k}" for k in range(n)]
        for name, text, dof, because in rows:
            yield known_scene(f"{name} of {n}", scene_of(names, text), because, size=n, dof=dof)
        yield from _squared_forms(n, names)


def _squared_forms(n: int, names: list[str]) -> Iterator[KnownScene]:
    first = f"(x0dot - x1 ydot)^2 + {_sum(n, '(x{k}dot - y ydot)^2', 1)} = 0"
    second = f"{_sum(n, '(x{k}dot - z ydot)^2')} = 0"
    for name, coordinates, text, because, dof in (
        (f"{n} forms in one", ["y"], first,
         "each square is 0: dx_k = y dy, and dx_0 = x_1 dy with it; one direction is left: they integrate", 1),
        (f"{n - 1} forms in one, and one that does not integrate", ["y", "z"], second,
         "each square is 0: dx_k = z dy; differences integrate, the form does not", 3),
    ):  # fmt: skip
        about = name, scene_of([*names, *coordinates], text), because, n
        yield known_scene(*about, dof=dof, integrability={"c1": dof == 1})


def _sum(n: int, text: str, first: int = 0) -> str:
    """Return the sum of a text over k = first, ..., n - 1; {next} is the index after k, and 0 after the last."""
    return " + ".join(text.format(k=k, next=(k + 1) % n) for k in range(first, n))


# Long chains


def chained_equations() -> Iterator[KnownScene]:
    """Chains x_{i+1} = f(x_i), closed by a relation between the ends that is implied or not."""
    for n in (3, 6, 12, 24):
        names = [f"x{k}" for k in range(n)]
        sums = [f"x{k + 1} = 2 x{k} + 1" for k in range(n - 1)]
        factor = 2 ** (n - 1)
        rows: Sequence[tuple[str, str, int, list[str]]] = (
            ("tied rightly", f"x{n - 1} = {factor} x0 + {factor - 1}", 1, [f"c{n}"]),
            ("tied to another place", f"x{n - 1} = {factor} x0 + {factor}", -1, []),
            ("tied by another slope", f"x{n - 1} = {factor + 1} x0", 0, []),
        )
        for name, last, dof, over in rows:
            because = f"x_n-1 = {factor} x_0 + {factor - 1} by the chain"
            about = f"{n} coordinates, {name}", scene_of(names, *sums, last), because, n
            yield known_scene(*about, dof=dof, redundancy=over)


FAMILIES = {
    "hidden relations": hidden_relations,
    "rotation matrices": rotations,
    "linear rows": linear_rows,
    "touching surfaces": touching,
    "scales": scales,
    "branches": branches,
    "high powers": high_powers,
    "powers in forms": power_forms,
    "sums of squares": sums_of_squares,
    "chains of equations": chained_equations,
}
