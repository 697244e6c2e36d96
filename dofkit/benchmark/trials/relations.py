"""Finite relations: functions that depend on each other, mixed bases, rows that are combinations, gaps, scales."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations

from dofkit.benchmark.trials.construction import KnownScene, every, known_scene, numbered, scene_of

#: name, coordinates, rows that are independent, a row that follows from them, one that does not and takes one more
#: freedom, one that contradicts them (or None); the trait
HIDDEN: list[tuple[str, str, Sequence[str], str, str, str | None, str]] = [
    ("sine and cosine", "x y z", ["y = sin(x)", "z = cos(x)"], "y^2 + z^2 = 1", "y + z = x", "y^2 + z^2 = 1 + 1e-9",
     "hidden-relation"),
    ("sine of twice", "x y z w", ["y = sin(x)", "z = cos(x)", "w = sin(2 x)"], "w = 2 y z", "w = 2 y + z + 1/7",
     "w = 2 y z + 1e-9", "hidden-relation"),
    ("exp and its inverse", "x y z", ["y = exp(x)", "z = exp(-x)"], "y z = 1", "y + z = 3", "y z = 1 - 1e-9",
     "hidden-relation"),
    ("log of exp", "x y z", ["y = exp(x)", "z = log(y)"], "z = x", "z = 2 x + 1", "z = x + 1e-12", "hidden-relation"),
    ("hyperbolics", "x y z", ["y = sinh(x)", "z = cosh(x)"], "z^2 - y^2 = 1", "y + z = 2", "z^2 - y^2 = 1 + 1e-9",
     "hidden-relation"),
    ("arc tangent", "x y z", ["y = atan(x)", "z = tan(y)"], "z = x", "z = 2 x + 1", "z = x + 1e-12",
     "hidden-relation"),
    ("roots", "x y z", ["x = y^2 + 1", "z = sqrt(x - 1)"], "z^2 = y^2", "z = y + 1", "z^2 = y^2 + x",
     "hidden-relation"),
    ("sum, product, squares", "x y p q r", ["p = x + y", "q = x y", "r = x^2 + y^2"], "r = p^2 - 2 q",
     "r = p^2 - 3 q", "r = p^2 - 2 q - 1e-9", "hidden-relation"),
    ("sums of cubes", "x y p q r", ["p = x + y", "q = x y", "r = x^3 + y^3"], "r = p^3 - 3 p q", "r = p^3 - 2 p q",
     "r = p^3 - 3 p q + 1e-9", "hidden-relation"),
    ("minors of two rows", "a b c d u v w s p q r k l m",
     ["p = a v - b u", "q = a w - c u", "r = a s - d u", "k = b w - c v", "l = b s - d v", "m = c s - d w"],
     "p m - q l + r k = 0", "p m - q l + 2 r k = 1", "p m - q l + r k = 1e-9", "hidden-relation"),
    ("two squares of sums", "x y z w p q", ["p = x z - y w", "q = x w + y z"], "p^2 + q^2 = (x^2 + y^2)*(z^2 + w^2)",
     "p^2 + q^2 = x + 3", "p^2 + q^2 = (x^2 + y^2)*(z^2 + w^2) + 1e-6", "hidden-relation"),
    ("tangent and half angles", "x y z", ["y = tan(x/2)", "z = sin(x)"], "z (1 + y^2) = 2 y", "z + y = x + 1",
     "z (1 + y^2) = 2 y + (1 + y^2)*1e-9", "hidden-relation"),
    ("powers of 2 and 4", "x y z", ["y = 2^x", "z = 4^x"], "z = y^2", "z = y + 2", "z = y^2 + 1e-9", "mixed-bases"),
    ("2, 3 and 6", "x y z w", ["y = 2^x", "z = 3^x", "w = 6^x"], "w = y z", "w = y + z + 1/3", "w = y z - 1e-9",
     "mixed-bases"),
    ("2 and e", "x y z", ["y = 2^x", "z = exp(x log(2))"], "y = z", "y + z = 3", "y = z + 1e-9", "mixed-bases"),
    ("a half and 2", "x y z", ["y = 2^x", "z = (1/2)^x"], "y z = 1", "y + z = 3", "y z = 1 + 1e-9", "mixed-bases"),
    ("root of 2 and 2", "x y z", ["y = sqrt(2)^x", "z = 2^x"], "z = y^2", "z = y + 2", "z = y^2 + 1e-9",
     "mixed-bases"),
    ("10, 2 and 5", "x y z w", ["y = 10^x", "z = 2^x", "w = 5^x"], "y = z w", "y = z + w", "y = z w + 1e-9",
     "mixed-bases"),
    ("8 and 2, thrice", "x y z", ["y = 8^x", "z = 2^(3 x)"], "y = z", "y + z = x + 9", "y = z - 1e-12", "mixed-bases"),
    ("e to a sum", "x y z w", ["z = exp(x)*exp(y)", "w = exp(x + y + 1)"], "w = E z", "w = 2 z + y",
     "w = E z + 1e-9", "mixed-bases"),
    ("logs to bases", "x y z", ["y = log(x)/log(2)", "z = log(x)/log(4)"], "y = 2 z", "y = z + 1", "y = 2 z + 1e-9",
     "mixed-bases"),
]  # fmt: skip


def hidden_relations(quick: bool) -> Iterator[KnownScene]:
    """Relations whose functions depend on each other; with a row that does not, and one that contradicts them."""
    for number, (name, names, rows, implied, new, never, trait) in enumerate(HIDDEN[:: 6 if quick else 1]):
        n, k = len(names.split()), len(rows)
        members: list[tuple[str, str | None, int, list[str], str]] = [
            ("one that follows", implied, n - k, [f"c{k + 1}"], trait),
            ("one more", new, n - k - 1, [], "plain"),
            ("one that contradicts", never, -1, [], "tiny-gap"),
        ]
        for how, row, dof, over, main in members:
            if row is None or (dof < 0 and number % 2):
                continue
            yield known_scene(
                f"{name}, {how}",
                scene_of(names.split(), *rows, row),
                f"{implied} by the rows before",
                (main, trait) if main != trait else (trait,),
                size=k + 1,
                dof=dof,
                redundancy=over,
            )


def power_sums(quick: bool) -> Iterator[KnownScene]:
    """The power sums of n numbers are polynomials in the elementary symmetric ones [NewtonGirard]."""
    for n in (2,) if quick else (2, 3, 4, 5):
        x = [f"x{k}" for k in range(n)]
        elementary = [" + ".join("*".join(c) for c in combinations(x, k)) for k in range(1, n + 1)]
        rows = [f"e{k + 1} = {text}" for k, text in enumerate(elementary)]
        rows += [f"p{k} = " + " + ".join(f"{q}^{k}" for q in x) for k in range(1, n + 1)]
        names = [*x, *(f"e{k + 1}" for k in range(n)), *(f"p{k + 1}" for k in range(n))]
        last = f"p{n} = " + _newton(n)
        for how, row, dof, over in (
            ("Newton's identity", last, n, [f"c{2 * n + 1}"]),
            ("Newton's identity missed", last + f" + e{n}", n - 1, []),
        ):
            yield known_scene(
                f"{how} of {n}",
                scene_of(names, *rows, row),
                "p_n = e_1 p_n-1 - e_2 p_n-2 + ... up to n e_n (Newton); missed, it forces e_n = 0",
                ("hidden-relation",),
                size=n,
                dof=dof,
                redundancy=over,
            )


def _newton(n: int) -> str:
    terms = [f"{'+' if i % 2 else '-'} e{i}*p{n - i}" for i in range(1, n)]
    return f"{' '.join(terms)} {'+' if n % 2 else '-'} {n}*e{n}".lstrip("+ ")


def rotations(quick: bool) -> Iterator[KnownScene]:
    """R^T R = 1, then R R^T = 1 too: the second says nothing new, as a left inverse is a right one."""
    for n in (2,) if quick else (2, 3):
        entry = [[f"r{i}{j}" for j in range(n)] for i in range(n)]
        names = [name for row in entry for name in row]
        columns = [
            f"{' + '.join(f'{entry[k][i]}*{entry[k][j]}' for k in range(n))} = {int(i == j)}"
            for i in range(n)
            for j in range(i, n)
        ]
        rows = [
            f"{' + '.join(f'{entry[i][k]}*{entry[j][k]}' for k in range(n))} = {int(i == j)}"
            for i in range(n)
            for j in range(i, n)
        ]
        number = len(columns)
        for how, more, dof, over in (
            ("by columns", [], n * (n - 1) // 2, []),
            ("by columns and by rows", rows, n * (n - 1) // 2, numbered(number, number + 1)),
            ("that leave the first axis", ["r00 = 1"], (n - 1) * (n - 2) // 2, []),
            ("of trace beyond n", [" + ".join(f"r{i}{i}" for i in range(n)) + f" = {n} + 1e-9"], -1, []),
        ):
            yield known_scene(
                f"{n} by {n} {how}",
                scene_of(names, *columns, *more),
                "a left inverse is a right one; entries are at most 1",
                ("hidden-relation",) if over else ("real",) if "axis" in how or dof < 0 else ("plain",),
                size=n,
                dof=dof,
                redundancy=over,
            )


def linear_rows(quick: bool) -> Iterator[KnownScene]:
    """Rows of a linear system; the last a combination of the others, at a gap; scaled; with coefficients far apart."""
    sizes = (3, 6) if quick else (3, 6, 12)
    for n, digits in ((n, d) for n in sizes for d in ((6, 30) if quick else (6, 12, 30, 60))):
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
        for how, text, dof, over, traits in (
            ("off by", f"{_row(last)} = {value} + {step}", -1, None, ("tiny-gap", "contradiction")),
            ("tilted by", f"{_row(last)} + {step}*x{n - 1} = {value}", n - k - 1, [], ("tiny-gap",)),
            ("scaled by", f"{step}*({_row(last)} - ({value})) = 0", n - k, [f"c{k + 1}"], ("scale", "redundant")),
        ):
            yield known_scene(
                f"{n} coordinates, {how} 1e-{digits}",
                scene_of(names, *texts, text),
                "the first rows are in echelon form; the last is a combination of them, but for the gap",
                traits,
                size=n,
                swept={"gap": 10.0**-digits},
                dof=dof,
                redundancy=over,
            )


def _row(row: Sequence[Fraction]) -> str:
    return " + ".join(f"({v})*x{j}" for j, v in enumerate(row) if v)


#: name, coordinates, rows with {e}, dof and redundant where e > 0, e = 0, e < 0 (-1: no configuration)
Told = tuple[int, Sequence[str]]
TOUCHING: list[tuple[str, str, Sequence[str], tuple[Told, Told, Told]]] = [
    ("a square", "x y", ["x^2 + ({e}) = 0"], ((-1, []), (1, []), (1, []))),
    ("a circle", "x y z", ["x^2 + y^2 + ({e}) = 0"], ((-1, []), (1, []), (2, []))),
    ("two circles", "x y", ["x^2 + y^2 = 1", "(x - 2 - ({e}))^2 + y^2 = 1"], ((-1, []), (0, []), (0, []))),
    ("a circle and a tangent", "x y", ["x^2 + y^2 = 1", "x = 1 + ({e})"], ((-1, []), (0, []), (0, []))),
    ("a sphere and a plane", "x y z", ["x^2 + y^2 + z^2 = 1", "x = 1 + ({e})"], ((-1, []), (0, []), (1, []))),
    ("concentric circles", "x y", ["x^2 + y^2 = 1", "x^2 + y^2 = 1 + ({e})"], ((-1, []), (1, ["c2"]), (-1, []))),
    ("parallel planes", "x y z", ["x + 2 y = 3", "2 x + 4 y = 6 + ({e})"], ((-1, []), (2, ["c2"]), (-1, []))),
    ("a sine too large", "x y", ["sin(x) = 1 + ({e})"], ((-1, []), (1, []), (1, []))),
    ("an exponential", "x y", ["exp(x) + ({e}) = 0"], ((-1, []), (-1, []), (1, []))),
    ("mean and product", "x y", ["x + y = 2", "x y = 1 + ({e})"], ((-1, []), (0, []), (0, []))),
    ("a fourth power", "x y z", ["(x - y)^4 + ({e}) = 0"], ((-1, []), (2, []), (2, []))),
    ("means of three", "x y z", ["x + y + z = 3", "x^2 + y^2 + z^2 = 3 - ({e})"], ((-1, []), (0, []), (1, []))),
    ("a parabola under a line", "x y", ["y = x^2", "y + ({e}) = 0"], ((-1, []), (0, []), (0, []))),
    ("hyperbolic cosine", "x y", ["cosh(x) = 1 - ({e})"], ((-1, []), (1, []), (1, []))),
]  # fmt: skip


def touching(quick: bool) -> Iterator[KnownScene]:
    """Surfaces that miss each other by a gap, touch, or meet: none, a point, or more."""
    for name, names, rows, told in TOUCHING[:: 5 if quick else 1]:
        for digits in (9,) if quick else (0, 12, 30, 60):
            signs = (("apart", f"1e-{digits}", 0), ("meeting", f"-1e-{digits}", 2))
            for how, e, k in (*signs, ("touching", "0", 1)) if digits in (9, 12) else signs:
                dof, over = told[k]
                yield known_scene(
                    f"{name}, {how}" + (f" by 1e-{digits}" if k != 1 else ""),
                    scene_of(names.split(), *(row.replace("{e}", e) for row in rows)),
                    "real solutions are there on one side of the gap only",
                    ("tiny-gap", "contradiction") if dof < 0 else ("tiny-gap", "real") if k == 1 else ("tiny-gap",),
                    size=len(rows),
                    swept={"gap": float(e)},
                    dof=dof,
                    redundancy=over if digits in (0, 12) else None,
                )


SAME = "a unit, or a place, changes nothing"
#: Rows with {r} for a scale, and {a} for it or one over it, what is larger: name, coordinates, rows, dof, redundant,
#: whether each integrates (None: not asked), because, trait.
SCALES: list[tuple[str, str, Sequence[str], int, Sequence[str] | None, bool | None, str, str]] = [
    ("a circle, and again in another unit", "x y z", ["x^2 + y^2 = ({r})^2", "(x/({r}))^2 + (y/({r}))^2 = 1"], 2,
     ["c2"], None, SAME, "scale"),
    ("a circle far away, and multiplied out", "x y", ["(x - {a})^2 + y^2 = 1", "x^2 - 2*{a}*x + {a}^2 + y^2 = 1"], 1,
     ["c2"], None, SAME, "offset"),
    ("a circle far away and its axis", "x y", ["(x - {a})^2 + y^2 = 1", "y = 0"], 0, [], None, SAME, "offset"),
    ("two circles far away that touch", "x y", ["(x - {a})^2 + y^2 = 1", "(x - {a} - 2)^2 + y^2 = 1"], 0, [], None,
     SAME, "offset"),
    ("two circles far away that do not", "x y", ["(x - {a})^2 + y^2 = 1", "(x - {a} - 3)^2 + y^2 = 1"], -1, [], None,
     SAME, "offset"),
    ("planes of unlike coefficients", "x y z", ["x + ({r}) y = 0", "({r}) x + y = 0"], 1, [], None, SAME, "scale"),
    ("dependent planes of unlike coefficients", "x y z", ["x + y = 1", "({r}) y + z = 0", "x - z/({r}) = 1"], 1, ["c3"],
     None, SAME, "scale"),
    ("forms", "x y z", ["({r}) dz - y dx = 0"], 3, None, False, "a contact form in any unit", "scale"),
    ("exact forms", "x y z", ["(x - {a}) dy + (y + ({r})) dx + ({r}) dz = 0"], 2, None, True,
     "the differential of (x - a)(y + b) + b z", "offset"),
]  # fmt: skip
#: The powers of ten by which finite relations are moved away.
FAR = (3, 6, 9)


def scales(quick: bool) -> Iterator[KnownScene]:
    """Circles and planes of any size, anywhere, in any unit: what follows from what does not change."""
    for power in (-9, 9) if quick else (-30, -9, -6, 3, 6, 9, 30):
        r, a = f"1e{power}", f"1e{abs(power)}"
        for name, names, texts, dof, over, integrates, because, trait in SCALES:
            if trait == "offset" and integrates is None and power not in FAR:
                continue
            yield known_scene(
                f"{name}, {r}",
                scene_of(names.split(), *(text.format(r=r, a=a) for text in texts)),
                because,
                (trait,),
                swept={"scale": 10.0**power},
                dof=dof,
                integrability=None if integrates is None else {"c1": integrates},
                redundancy=over,
            )


def labels(quick: bool) -> Iterator[KnownScene]:
    """Relations without velocities are holonomic, inequalities never: nothing has to be computed."""
    for n in (2,) if quick else (2, 4, 8, 16):
        names = [f"x{k}" for k in range(n)]
        rows = [f"x{k}^2 + x{(k + 1) % n}^2 = {k + 2}" for k in range(0, n, 2)]
        walls = [f"x{k} >= {-k - 9}" for k in range(1, n, 2)]
        yield known_scene(
            f"{n} coordinates",
            scene_of(names, *rows, *walls),
            "inequalities reduce nothing and are not holonomic",
            ("inequality",),
            size=n,
            dof=n - len(rows) if n > 2 else 1,
            integrability=every(numbered(len(rows)), True) | every(numbered(len(walls), len(rows) + 1), False),
        )


FAMILIES = {
    "hidden relations": hidden_relations,
    "power sums": power_sums,
    "rotation matrices": rotations,
    "linear rows": linear_rows,
    "touching surfaces": touching,
    "scales": scales,
    "walls": labels,
}
