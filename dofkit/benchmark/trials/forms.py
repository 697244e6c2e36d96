"""Forms that integrate, that do not, and that do so only together; mixed with functions for coefficients."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence

from dofkit.benchmark.trials.construction import KnownScene, Line, every, known_scene, numbered, scene_of, tabled

#: A form by coordinate: coefficients as text.
Form = Mapping[str, str]


def text(form: Form) -> str:
    """As an equation."""
    return " + ".join(f"({value}) d{q}" for q, value in form.items()) + " = 0"


def combined(rows: Sequence[Sequence[str]], forms: Sequence[Form]) -> list[Form]:
    """The forms multiplied by a matrix of functions (texts; an empty one is 0)."""
    found: list[Form] = []
    for row in rows:
        made: dict[str, list[str]] = {}
        for factor, form in zip(row, forms, strict=True):
            for q, value in form.items() if factor else ():
                made.setdefault(q, []).append(f"({factor})*({value})")
        found.append({q: " + ".join(values) for q, values in made.items()})
    return found


def mixed_forms(quick: bool) -> Iterator[KnownScene]:
    """n exact forms mixed by functions: none integrates alone, all do together; with a contact form among them, none.

    The matrix is lower times upper triangular with ones on both diagonals: determinant 1.
    """
    members = [(2, 0)] if quick else [(2, 0), (2, 1), (3, 0), (3, 1), (4, 0), (5, 0)]
    for n, seed in members:
        rng = random.Random(f"mixed {n} {seed}")
        names = [*(f"u{k}" for k in range(n)), *(f"v{k}" for k in range(n)), "w"]
        exact = [_exact(rng, k, n) for k in range(n)]
        matrix = _unimodular(rng, n)
        for name, forms, integrates, dof in (
            ("exact", exact, True, n + 1),
            ("one a contact form", [{"u0": "1", "v0": "-w"}, *exact[1:]], False, n + 2),
        ):
            rows = [text(form) for form in combined(matrix, forms)]
            whole = all(row[0] for row in matrix) or integrates
            yield known_scene(
                f"{n} forms in {2 * n + 1} coordinates, {name}, {seed}",
                scene_of(names, *rows),
                "what they span does not change with a regular matrix of functions",
                ("together" if integrates else "non-holonomic", "large"),
                size=n,
                dof=dof,
                integrability=every(numbered(n), integrates) if whole else None,
            )


def _exact(rng: random.Random, k: int, n: int) -> Form:
    """d(u_k + a function of the v) for a random one."""
    a, b, i, j = rng.randint(1, 5), rng.randint(1, 5), rng.randrange(n), rng.randrange(n)
    slopes = rng.choice(
        (
            {f"v{i}": f"{2 * a}*v{i}"},
            {f"v{i}": f"{a}*cos(v{i})"},
            {f"v{i}": f"{a}*exp({b}*v{i})"},
            {f"v{i}": f"v{j}", f"v{j}": f"v{i}"} if i != j else {f"v{i}": f"{3 * b}*v{i}^2"},
        )
    )
    return {f"u{k}": "1", **slopes}


def _unimodular(rng: random.Random, n: int) -> list[list[str]]:
    """(1 on the diagonal, f_i below) (1 on the diagonal, g_j above): entries sum_k L_ik U_kj."""

    def entry() -> str:
        return rng.choice((f"u{rng.randrange(n)}", f"v{rng.randrange(n)}^2", f"sin(u{rng.randrange(n)})", "w"))

    lower = [[entry() if j < i else "1" if i == j else "" for j in range(n)] for i in range(n)]
    upper = [[entry() if j > i else "1" if i == j else "" for j in range(n)] for i in range(n)]
    return [
        [
            " + ".join(f"({lower[i][k]})*({upper[k][j]})" for k in range(n) if lower[i][k] and upper[k][j])
            for j in range(n)
        ]
        for i in range(n)
    ]


TOGETHER: list[Line] = [
    ("one edge on a lamina", "x y th", ["sin(th) dx = cos(th) dy"], 3, [False], [], "a sleigh", "non-holonomic"),
    ("two edges one behind the other", "x y th", ["sin(th) dx = cos(th) dy", "sin(th) dx = cos(th) dy + dth"], 1,
     [True, True], [], "the difference is dth = 0", "together"),
    ("two edges side by side", "x y th", ["sin(th) dx = cos(th) dy", "2 sin(th) dx = 2 cos(th) dy"], 3,
     [False, False], ["c2"], "the same form twice", "redundant"),
    ("two edges across", "x y th", ["sin(th) dx = cos(th) dy", "cos(th) dx + sin(th) dy = 0"], 1,
     [True, True], [], "dx = dy = 0: it turns in its place", "together"),
    ("three edges", "x y th", ["sin(th) dx = cos(th) dy", "cos(th) dx + sin(th) dy = dth",
     "sin(th) dx = cos(th) dy + 2 dth"], 0, [True, True, True], [], "dth = 0, then dx = dy = 0", "together"),
    ("edges on a turning lamina", "x y th", ["sin(th) dx = cos(th) dy", "sin(th) dx - cos(th) dy = dth - dt"], 2,
     [False, False], [], "th - t integrates; the edge that turns with time does not", "rheonomic"),
    ("a contact form and its twin", "x y z w", ["dz = y dx", "dw = y dx"], 3, [False, False], [],
     "only z - w integrates", "non-holonomic"),
    ("a contact form and its multiple", "x y z", ["dz = y dx", "dz = 2 y dx"], 1, [True, True], [],
     "dz = 0 and dx = 0 (where y is not 0)", "together"),
    ("a contact form, and y held", "x y z", ["dz = y dx", "dy = 0"], 1, [True, True], [], "y = C, z = C x", "together"),
    ("a contact form, and x held", "x y z", ["dz = y dx", "dx = 0"], 1, [True, True], [], "x = C, z = C", "together"),
    ("a contact form on a cylinder", "x y z", ["y^2 + x^2 = 1", "dz = y dx"], 1, [True, True], [],
     "two directions less one", "together"),
    ("a contact form beside a cylinder", "x y z w", ["w^2 + x^2 = 1", "dz = y dx"], 3, [True, False], [],
     "y is free", "non-holonomic"),
    ("a sphere in differentials", "x y z", ["x dx + y dy + z dz = 0"], 2, [True], [], "x^2 + y^2 + z^2", "integrable"),
    ("a sphere, and its differential", "x y z", ["x^2 + y^2 + z^2 = 4", "x dx + y dy + z dz = 0"], 2, [True, True],
     ["c2"], "the differential says no more", "redundant"),
    ("a differential, then its sphere", "x y z", ["x dx + y dy + z dz = 0", "x^2 + y^2 + z^2 = 4"], 2, [True, True],
     ["c1"], "the finite one alone fixes the constant", "redundant"),
    ("Riccati", "x y z", ["dz = (x^2 + 3) dx + (2 y + y^2) dy"], 2, [True], [], "closed", "integrable"),
    ("with a factor", "x y z", ["y dz + 2 y z dx + z dy = 0"], 2, [True], [], "d(e^(2x) y z) = e^(2x) (...)",
     "integrable"),
    ("nearly with a factor", "x y z", ["y dz + 2 y z dx + 2 z dy + y dy = 0"], 3, [False], [],
     "its wedge with its differential is 2 y^2 dx dy dz", "non-holonomic"),
    ("a screw", "x y z", ["x dy - y dx + dz = 0"], 3, [False], [], "d of it is 2 dx dy", "non-holonomic"),
    ("a screw in polar angles", "r a z", ["r^2 da + dz = 0"], 3, [False], [], "d of it is 2 r dr da", "non-holonomic"),
    ("a screw on a cylinder", "x y z", ["x^2 + y^2 = 1", "x dy - y dx + dz = 0"], 1, [True, True], [],
     "the arc length plus z", "together"),
    ("a disc, its rows turned", "x y th ph", ["cos(th) dx + sin(th) dy = dph", "sin(th) dx = cos(th) dy"], 4,
     [False, False], [], "the rolling disc", "rolling"),
    ("a disc whose heading follows its roll", "x y th ph", ["dx = cos(th) dph", "dy = sin(th) dph", "dth = 3 dph"], 1,
     [True] * 3, [], "three forms in four coordinates", "together"),
    ("a disc, its heading follows its place", "x y th ph", ["dx = cos(th) dph", "dy = sin(th) dph", "th = x"], 1,
     [True] * 3, [], "one direction is left", "together"),
    ("a disc and its resultant", "x y th ph", ["dx = cos(th) dph", "dy = sin(th) dph",
     "cos(th) dx + sin(th) dy = dph"], 4, [False] * 3, ["c3"], "cos c1 + sin c2", "redundant"),
    ("a disc and a wrong resultant", "x y th ph", ["dx = cos(th) dph", "dy = sin(th) dph",
     "cos(th) dx + sin(th) dy = 2 dph"], 1, [True] * 3, [], "dph = 0, and so dx = dy = 0", "together"),
    ("Engel", "x y z w", ["dz = y dx", "dy = w dx"], 4, [False, False], [], "Goursat's normal form", "non-holonomic"),
    ("Engel with w held", "x y z w", ["dz = y dx", "dy = w dx", "w = 2"], 1, [True] * 3, [], "a line", "together"),
    # [Cartan1910]
    ("Cartan's five variables", "x y p q z", ["dy = p dx", "dp = q dx", "dz = q^2 dx"], 5, [False] * 3, [],
     "growth 2, 3, 5 (Cartan 1910)", "non-holonomic"),
    ("Cartan's with q in place of q^2", "x y p q z", ["dy = p dx", "dp = q dx", "dz = q dx"], 4, [False] * 3, [],
     "z - p integrates, neither form does", "non-holonomic"),
]  # fmt: skip


def together(quick: bool) -> Iterator[KnownScene]:
    """Forms with their system: the label of each is one of the whole."""
    return map(tabled, TOGETHER[: 9 if quick else None])


def near_integrable(quick: bool) -> Iterator[KnownScene]:
    """n exact forms, one with a step e x_k dx_l in it: it does not integrate, however small the step."""
    for n, digits in ((n, d) for n in ((1, 2) if quick else (1, 2, 4)) for d in (3, 6, 9, 12, 18, 30)):
        names = [*(f"z{k}" for k in range(n)), "x", "y"]
        exact = [f"dz{k} + {k + 1}*(y dx + x dy)" for k in range(n)]
        for name, step, holonomic in (("turned", f"1e-{digits}*x dy", False), ("curved", f"1e-{digits}*y dy", True)):
            rows = [*(f"{form} = 0" for form in exact[:-1]), f"{exact[-1]} + {step} = 0"]
            yield known_scene(
                f"{n} forms, the last {name} by 1e-{digits}",
                scene_of(names, *rows),
                "d of the last is e dx dy, which no other form holds" if not holonomic else "all are closed",
                ("near-integrable" if not holonomic else "integrable",),
                size=n,
                swept={"gap": 10.0**-digits},
                dof=2 if holonomic else 3,
                integrability={f"c{k + 1}": k < n - 1 or holonomic for k in range(n)},
            )


FAMILIES = {"mixed forms": mixed_forms, "forms together": together, "near-integrable forms": near_integrable}
