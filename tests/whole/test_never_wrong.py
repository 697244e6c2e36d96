"""Random scenes whose answer is known by the way they are made; none of it comes from dofkit.

An answer may be undecided (None) where that is said; it may never be wrong, and it is seldom left open.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from itertools import combinations
from typing import Any

import numpy as np
import pytest
import sympy

import dofkit
from dofkit.report import Report

Matrix = np.ndarray[Any, Any]
Form = list[sympy.Expr]
Link = tuple[int, int]

T = sympy.Symbol("t")


def classified(**scene: Any) -> Report:
    return dofkit.classify(dofkit.load(scene))


def seeds(n: int) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("seed", range(n))


def rank(matrix: Matrix) -> int:
    return (
        0 if matrix.size == 0 else int(np.linalg.matrix_rank(matrix, tol=1e-8 * max(1.0, float(np.abs(matrix).max()))))
    )


def first_dependent(rows: Matrix, owners: Sequence[int]) -> list[int]:
    """Owners all of whose rows depend on those before."""
    found = []
    for owner in dict.fromkeys(owners):
        before = rows[[i for i, o in enumerate(owners) if o < owner]]
        upto = rows[[i for i, o in enumerate(owners) if o <= owner]]
        if rank(before) == rank(upto):
            found.append(owner)
    return found


# Differential forms


class Draw:
    """Random functions of some coordinates."""

    def __init__(self, seed: int, n: int) -> None:
        self.rng = random.Random(seed)
        self.q = list(sympy.symbols(f"q1:{n + 1}"))

    def polynomial(self, symbols: Sequence[sympy.Symbol], degree: int = 2) -> sympy.Expr:
        terms = [
            self.rng.choice((-3, -2, -1, 1, 2))
            * sympy.prod(self.rng.choice(symbols) for _ in range(self.rng.randint(1, degree)))
            for _ in range(2)
        ]
        return sympy.Add(*terms)

    def function(self, symbols: Sequence[sympy.Symbol]) -> sympy.Expr:
        if not symbols:
            return sympy.Integer(0)
        inner = self.polynomial(symbols, 1)
        outer = [sympy.sin(inner), sympy.cos(inner), sympy.exp(inner / 2), sympy.sqrt(1 + inner**2), inner**2, inner]
        return self.rng.choice(outer) + self.polynomial(symbols)

    def mixing(self, m: int, symbols: Sequence[sympy.Symbol]) -> list[list[sympy.Expr]]:
        """An invertible matrix of functions: lower times upper triangular, with a diagonal that never vanishes."""
        entry = [
            [self.polynomial(symbols, 1) if self.rng.random() < 0.7 else sympy.Integer(0) for _ in range(m)]
            for _ in range(m)
        ]
        diagonal = [
            self.rng.choice((sympy.Integer(2), 1 + self.rng.choice(symbols) ** 2, 2 + sympy.sin(symbols[0])))
            for _ in range(m)
        ]
        lower = sympy.Matrix(m, m, lambda i, j: diagonal[i] if i == j else entry[i][j] if i > j else 0)
        upper = sympy.Matrix(m, m, lambda i, j: 1 if i == j else entry[i][j] if i < j else 0)
        found: list[list[sympy.Expr]] = (lower * upper).tolist()
        return found

    def shear(self, *, time: bool = False) -> dict[sympy.Symbol, sympy.Expr]:
        """A polynomial change of coordinates with a polynomial inverse."""
        order = self.rng.sample(self.q, len(self.q))
        moved = {order[0]: order[0]}
        for k, s in enumerate(order[1:], 1):
            moved[s] = s + self.polynomial([*order[:k], *([T] if time else [])])
        return moved


def differential(f: sympy.Expr, symbols: Iterable[sympy.Symbol]) -> Form:
    return [sympy.diff(f, s) for s in symbols]


def mixed(matrix: Sequence[Sequence[sympy.Expr]], forms: Sequence[Form]) -> list[Form]:
    return [
        [sympy.Add(*(a * form[c] for a, form in zip(row, forms, strict=True))) for c in range(len(forms[0]))]
        for row in matrix
    ]


def pulled_back(form: Form, columns: Sequence[sympy.Symbol], change: dict[sympy.Symbol, sympy.Expr]) -> Form:
    """The form in new coordinates: sum a_i(change) d(change_i)."""
    total = [sympy.Integer(0)] * len(columns)
    for s, a in zip(columns, form, strict=True):
        slope = differential(change.get(s, s), columns)
        total = [old + a.subs(change, simultaneous=True) * part for old, part in zip(total, slope, strict=True)]
    return total


def shown(form: Form, columns: Sequence[sympy.Symbol]) -> str:
    return " + ".join(f"({a}) d{s}" for s, a in zip(columns, form, strict=True) if a != 0) + " = 0"


def pfaffian(forms: Sequence[Form], columns: Sequence[sympy.Symbol]) -> Report:
    names = [str(s) for s in columns if s != T]
    return classified(coordinates=names, constraints=[shown(form, columns) for form in forms])


@seeds(15)
def test_differentials_mixed_by_functions_are_holonomic(seed: int) -> None:
    """sum_j M_ij df_j with f_j = q_j + g_j(the q after the first m): rank m, and all of it integrates."""
    n, m = random.Random(seed).choice(((3, 1), (3, 2), (4, 2), (5, 2), (5, 3)))
    draw = Draw(seed, n)
    timed = seed % 3 == 0
    columns = [*draw.q, T] if timed else draw.q
    free = [*draw.q[m:], *([T] if timed else [])]
    forms = [differential(q + draw.function(free), columns) for q in draw.q[:m]]
    report = pfaffian(mixed(draw.mixing(m, draw.q), forms), columns)
    assert (report.consistent, report.dof, report.velocity_dof) == (True, n - m, n - m)
    assert [entry.holonomic for entry in report.constraints] == [True] * m
    assert (report.holonomic, report.redundant_equations) == (True, 0)


def chained(q: Sequence[sympy.Symbol]) -> list[Form]:
    """dx_k = x_k+1 dx_1 for k = 2, 3, ..., n - 1: nothing of it integrates, the flag grows by one a step."""
    return [
        [-q[k + 1] if i == 0 else sympy.Integer(1 if i == k else 0) for i in range(len(q))]
        for k in range(1, len(q) - 1)
    ]


@seeds(20)
def test_chained_forms_in_any_coordinates_are_non_holonomic(seed: int) -> None:
    n = 3 + seed % 3
    draw = Draw(seed, n)
    timed = seed % 4 == 3
    change, columns = draw.shear(time=timed), [*draw.q, *([T] if timed else [])]
    forms = [[*form, *([sympy.Integer(0)] if timed else [])] for form in chained(draw.q)]
    moved = [pulled_back(form, columns, change) for form in forms]
    report = pfaffian(mixed(draw.mixing(n - 2, draw.q), moved) if seed % 2 else moved, columns)
    assert (report.consistent, report.dof, report.velocity_dof) == (True, n, 2)
    assert [entry.holonomic for entry in report.constraints] == [False] * (n - 2)
    assert [entry.holonomic_alone for entry in report.constraints] == [False] * (n - 2)
    if not timed:
        assert report.growth_vector in (list(range(2, n + 1)), None)


@pytest.mark.sweep
@seeds(6)
def test_one_contact_form_among_differentials(seed: int) -> None:
    """dz - y dx with m differentials of functions of other coordinates: a row that holds none of it integrates."""
    m = 1 + seed % 2
    draw = Draw(seed, 3 + m)
    x, y, z, *others = draw.q
    contact: Form = [-y, sympy.Integer(0), sympy.Integer(1), *[sympy.Integer(0)] * m]
    exact = [differential(other + draw.function([x, y, z]), draw.q) for other in others]
    matrix = draw.mixing(m, draw.q)
    rows = [[sympy.Integer(seed % 4 == 3 and i == 0), *row] for i, row in enumerate(matrix)]
    change = draw.shear()
    forms = [pulled_back(form, draw.q, change) for form in (contact, *mixed(rows, [contact, *exact]))]
    report = pfaffian(forms, draw.q)
    assert (report.dof, report.velocity_dof) == (3, 2)
    assert [entry.holonomic for entry in report.constraints] == [False, *(row[0] == 0 for row in rows)]


@seeds(10)
def test_a_combination_of_forms_is_redundant(seed: int) -> None:
    """As many forms as before and one more, in their span."""
    n = 4 + seed % 2
    draw = Draw(seed, n)
    forms = [pulled_back(form, draw.q, draw.shear()) for form in chained(draw.q)[:1]] + [
        differential(draw.q[2] + draw.function(draw.q[3:]), draw.q)
    ]
    extra = mixed([[draw.polynomial(draw.q), 1 + draw.q[0] ** 2]], forms)
    alone, report = pfaffian(forms, draw.q), pfaffian([*forms, *extra], draw.q)
    assert (report.velocity_dof, report.redundant_equations, report.redundant) == (n - 2, 1, ["c3"])
    assert (report.dof, report.holonomic) == (alone.dof, alone.holonomic)


# Finite relations through a known point


@seeds(16)
def test_relations_through_a_given_point(seed: int) -> None:
    """g_i(q) - g_i(q0), and combinations of them with functions: the Jacobian at q0 by hand."""
    rng = random.Random(seed)
    n, m, extra = rng.choice(((3, 1, 0), (4, 2, 0), (4, 2, 1), (5, 3, 1), (3, 2, 2)))
    draw = Draw(seed, n)
    at = {q: sympy.Rational(rng.randint(-4, 4), rng.choice((1, 2, 3))) for q in draw.q}
    bases = [sympy.Add(draw.polynomial(draw.q, 3), q) for q in draw.q[:m]]
    relations = [sympy.expand(g - g.subs(at)) for g in bases]
    relations += [sympy.Add(*((1 + draw.polynomial(draw.q) ** 2) * g for g in relations[:m])) for _ in range(extra)]
    slopes = np.array(sympy.Matrix([differential(g, draw.q) for g in relations]).subs(at).tolist(), dtype=float)
    report = classified(
        coordinates=[str(q) for q in draw.q],
        configuration={str(q): str(value) for q, value in at.items()},
        constraints=[f"{g} = 0" for g in relations],
    )
    found = n - rank(slopes)
    assert report.instantaneous_dof == found
    if found == n - m:
        assert (report.dof, report.velocity_dof, report.singular) == (n - m, n - m, False)
        assert report.redundant_equations == extra
        assert len(report.redundant) == extra
    else:
        assert report.dof is None or report.dof <= found


# Frameworks of links


def rigidity_matrix(positions: Matrix, links: Sequence[Link]) -> Matrix:
    """A row a link: (p_i - p_j) . (v_i - v_j)."""
    n, d = positions.shape
    rows = np.zeros((len(links), n * d))
    for row, (i, j) in zip(rows, links, strict=True):
        row[d * i : d * i + d] = positions[i] - positions[j]
        row[d * j : d * j + d] = positions[j] - positions[i]
    return rows


def random_links(rng: random.Random, n: int, d: int) -> list[Link]:
    every = list(combinations(range(n), 2))
    wanted = max(1, d * n - d * (d + 1) // 2 + rng.randint(-3, 2))
    return rng.sample(every, min(len(every), wanted))


def written(links: Sequence[Link]) -> list[dict[str, Any]]:
    return [{"name": f"l{k}", "type": "link", "between": [f"P{i}", f"P{j}"]} for k, (i, j) in enumerate(links)]


@seeds(24)
def test_frameworks_in_general_position(seed: int) -> None:
    """The rank of the rigidity matrix at random places."""
    rng, d = random.Random(seed), 1 + seed % 3
    n = rng.randint(2, 7)
    links = random_links(rng, n, d)
    matrix = rigidity_matrix(np.random.default_rng(seed).standard_normal((n, d)), links)
    freedom = n * d - rank(matrix)
    report = classified(dimension=d, particles=[f"P{i}" for i in range(n)], constraints=written(links))
    assert (report.consistent, report.dof, report.velocity_dof, report.instantaneous_dof) == (
        True,
        freedom,
        freedom,
        None,
    )
    assert report.redundant_equations == len(links) - rank(matrix)
    dependent = first_dependent(matrix, range(len(links)))
    assert report.redundant == [f"l{k}" for k in dependent]
    assert dofkit.redundant_links(links, d) == [links[k] for k in dependent]


@seeds(20)
def test_redundant_links_of_large_graphs(seed: int) -> None:
    rng, d = random.Random(1000 + seed), 1 + seed % 3
    n = rng.randint(8, 16)
    links = random_links(rng, n, d)
    matrix = rigidity_matrix(np.random.default_rng(seed).standard_normal((n, d)), links)
    assert dofkit.redundant_links(links, d) == [links[k] for k in first_dependent(matrix, range(len(links)))]


def displacements(positions: Matrix) -> Matrix:
    """Translations and rotations of all points together."""
    n, d = positions.shape
    found = [np.tile(np.eye(d)[a], n) for a in range(d)]
    for a, b in combinations(range(d), 2):
        turn = np.zeros((n, d))
        turn[:, a], turn[:, b] = -positions[:, b], positions[:, a]
        found.append(turn.ravel())
    return np.array(found)


@seeds(40)
def test_frameworks_drawn_at_whole_numbers(seed: int) -> None:
    """Few places on a small grid: collinear, parallel and coplanar ones are common."""
    rng, d = random.Random(2000 + seed), 1 + seed % 3
    n = rng.randint(3, 6)
    side = {1: 12, 2: 3, 3: 2}[d]
    grid = np.stack(np.meshgrid(*[np.arange(side)] * d, indexing="ij"), axis=-1).reshape(-1, d)
    positions = grid[rng.sample(range(len(grid)), n)].astype(float)
    links = random_links(rng, n, d)
    matrix = rigidity_matrix(positions, links)
    particles = [{"name": f"P{i}", "at": [int(v) for v in p]} for i, p in enumerate(positions)]
    report = classified(dimension=d, particles=particles, constraints=written(links))
    first_order = n * d - rank(matrix)
    assert (report.consistent, report.instantaneous_dof) == (True, first_order)
    if rank(matrix) == len(links) or first_order == rank(displacements(positions)):
        assert (report.dof, report.singular) == (first_order, False)
        assert report.redundant_equations == len(links) - rank(matrix)
        assert report.redundant == [f"l{k}" for k in first_dependent(matrix, range(len(links)))]
    elif report.dof is not None:
        assert rank(displacements(positions)) <= report.dof <= first_order


# Bodies with joints: the velocity of a body is (w, v), its turning and the velocity of its point at the origin


def planar_rows(kind: str, at: Sequence[int], axis: Sequence[int]) -> Matrix:
    """What a joint of the plane forbids of the relative (w, vx, vy)."""
    pin = [[-at[1], 1, 0], [at[0], 0, 1]]
    slide = [[1, 0, 0], [0, -axis[1], axis[0]]]
    return np.array({"revolute": pin, "prismatic": slide, "weld": np.eye(3)}[kind], dtype=float)


def jacobian(joints: Sequence[tuple[int, int, Matrix]], bodies: int, size: int) -> tuple[Matrix, list[int]]:
    """Rows R (velocity of the second less that of the first), body -1 being the ground; and the joint of each row."""
    rows, owners = [], []
    for k, (a, b, forbidden) in enumerate(joints):
        block = np.zeros((len(forbidden), size * bodies))
        for body, sign in ((a, -1), (b, 1)):
            if body >= 0:
                block[:, size * body : size * body + size] += sign * forbidden
        rows.append(block)
        owners += [k] * len(forbidden)
    return np.vstack(rows), owners


def pairs(rng: random.Random, bodies: int, more: int) -> list[Link]:
    """A tree on the ground and some loops."""
    tree = [(rng.randint(-1, b - 1), b) for b in range(bodies)]
    every = list(combinations(range(-1, bodies), 2))
    return tree + rng.sample(every, min(len(every), more))


def named(body: int) -> str:
    return "ground" if body < 0 else f"b{body}"


def vector(rng: random.Random, d: int) -> list[int]:
    found = [rng.randint(-2, 2) for _ in range(d)]
    return found if any(found) else [1, *[0] * (d - 1)]


def check_linkage(report: Report, matrix: Matrix, total: int) -> None:
    first_order = total - rank(matrix)
    assert (report.consistent, report.instantaneous_dof) == (True, first_order)
    if rank(matrix) == len(matrix):
        assert (report.dof, report.velocity_dof, report.singular) == (first_order, first_order, False)
        assert (report.redundant_equations, report.redundant) == (0, [])
    elif first_order == 0:
        assert (report.dof, report.redundant_equations) == (0, len(matrix) - total)
    else:
        assert report.dof is None or report.dof <= first_order
        assert report.singular is (None if report.dof is None else report.dof != first_order)


@seeds(40)
def test_planar_linkages_drawn_at_whole_numbers(seed: int) -> None:
    rng = random.Random(3000 + seed)
    bodies = rng.randint(1, 5)
    joints, constraints = [], []
    for k, (a, b) in enumerate(pairs(rng, bodies, rng.randint(0, 2))):
        kind = rng.choice(("revolute", "revolute", "prismatic", "weld" if k >= bodies else "revolute"))
        at, axis = [rng.randint(-3, 3), rng.randint(-3, 3)], vector(rng, 2)
        joints.append((a, b, planar_rows(kind, at, axis)))
        drawn = {"revolute": {"at": at}, "prismatic": {"axis": axis}, "weld": {}}[kind]
        constraints.append({"type": kind, "between": [named(a), named(b)], **drawn})
    matrix, _ = jacobian(joints, bodies, 3)
    report = classified(dimension=2, bodies=[named(b) for b in range(bodies)], constraints=constraints)
    check_linkage(report, matrix, 3 * bodies)


#: Of each spatial joint: does it turn about the axis, about every axis, slide along the axis, slide across it?
FREEDOMS = {
    "revolute": ("turn",), "prismatic": ("slide",), "cylindrical": ("turn", "slide"), "spherical": ("every turn",),
    "planar": ("turn", "slide across"), "weld": (),
}  # fmt: skip


def twists(kind: str, at: Sequence[int], axis: Sequence[int]) -> Matrix:
    """What a joint of space allows: (w, v), v the velocity at the origin: p x w for a turn about a line through p."""
    place, n = np.array(at, dtype=float), np.array(axis, dtype=float)
    across = np.linalg.svd(n.reshape(1, 3))[2][1:]
    zero, found = np.zeros(3), []
    for freedom in FREEDOMS[kind]:
        turning = [n] if freedom == "turn" else list(np.eye(3)) if freedom == "every turn" else []
        sliding = [n] if freedom == "slide" else list(across) if freedom == "slide across" else []
        found += [np.concatenate([w, np.cross(place, w)]) for w in turning]
        found += [np.concatenate([zero, v]) for v in sliding]
    return np.array(found).reshape(-1, 6)


def forbidden(allowed: Matrix) -> Matrix:
    """Rows that vanish on what is allowed."""
    if not len(allowed):
        return np.eye(6)
    return np.linalg.svd(allowed)[2][len(allowed) :]


@seeds(30)
def test_spatial_linkages_drawn_at_whole_numbers(seed: int) -> None:
    rng = random.Random(4000 + seed)
    bodies = rng.randint(1, 4)
    joints, constraints = [], []
    for k, (a, b) in enumerate(pairs(rng, bodies, rng.randint(0, 1))):
        kind = rng.choice([*FREEDOMS][: 6 if k >= bodies else 5])
        at, axis = [rng.randint(-2, 2) for _ in range(3)], vector(rng, 3)
        joints.append((a, b, forbidden(twists(kind, at, axis))))
        drawn = {"spherical": {"at": at}, "weld": {}, "prismatic": {"axis": axis}}.get(kind, {"at": at, "axis": axis})
        constraints.append({"type": kind, "between": [named(a), named(b)], **drawn})
    matrix, _ = jacobian(joints, bodies, 6)
    report = classified(dimension=3, bodies=[named(b) for b in range(bodies)], constraints=constraints)
    check_linkage(report, matrix, 6 * bodies)


# Answers by hand where an easy way goes wrong


@pytest.mark.parametrize(
    ("constraints", "at", "freedom", "first_order"),
    [
        (["x y = 0", "x z = 0"], (1, 0, 0), 1, 1),  # near it x is not 0, so y = z = 0
        (["x y = 0", "x z = 0"], (0, 1, 0), 2, 2),  # the plane x = 0
        (["x y = 0", "z = 0"], (1, 0, 0), 1, 1),
        (["x y = 0", "z = 0"], (0, 0, 0), 1, 2),  # two lines cross
        (["x^2 - y^2 = 0", "z = 0"], (1, -1, 0), 1, 1),
        (["x^2 + y^2 + z^2 = 1"], (0, 0, 1), 2, 2),
        (["x^2 + y^2 + z^2 = 1", "z = 1"], (0, 0, 1), 0, 2),  # a tangent plane
        (["z = x y", "z = 0"], (0, 2, 0), 1, 1),
    ],
)
def test_the_configuration_says_which_branch(
    constraints: list[str], at: tuple[int, int, int], freedom: int, first_order: int
) -> None:
    configuration = dict(zip("xyz", at, strict=True))
    report = classified(coordinates=["x", "y", "z"], configuration=configuration, constraints=constraints)
    assert (report.consistent, report.dof, report.instantaneous_dof) == (True, freedom, first_order)
    assert report.singular is (freedom != first_order)


@pytest.mark.parametrize(
    ("constraints", "freedom"),
    [
        (["sqrt(-x) = 1"], 1),  # x = -1
        (["log(-x) = y"], 1),
        (["sqrt(x y) = 1", "x = -2"], 0),  # y = -1/2
        (["log(x y) = 0", "x = -2"], 0),
        (["sin(1e9 x) = y"], 1),
        (["x^(2/3) = x^(1/3)"], 1),  # x = 0 or x = 1
        (["x^(1/3) = -2"], 1),
        (["abs(x) + abs(y) = 1"], 1),
        (["abs(x) = x"], 2),
        (["x^3 = y^2"], 1),
        (["x^2 + x y + y^2 = 0"], 0),
        (["x^2 + y^2 = 1", "x + y = sqrt(2)"], 0),  # a tangent
        (["x^2 = 2", "x = sqrt(2)"], 1),
        (["(x^2 + y^2 - 1)^2 + (x - y)^2 = 0"], 0),
    ],
)
def test_real_sets_of_the_plane(constraints: list[str], freedom: int) -> None:
    report = classified(coordinates=["x", "y"], constraints=constraints)
    assert (report.consistent, report.dof) in ((True, freedom), (True, None), (None, None))


@pytest.mark.parametrize(
    "constraints",
    [
        ["exp(-200 x) = 0"],
        ["y = 0", "y + exp(-200 x) = 0"],
        ["y/x = 1", "x = 0"],
        ["x y = 1", "x = 0"],
        ["atan(x) = 2"],
        ["cosh(x) = 1/2"],
        ["x^2 + y^2 = 1", "x + y = 2"],
        ["x^2 + y^2 = 1", "x^2 + y^2 = 4"],
        ["x = 1", "x = 1 + 1e-30"],
        ["x^2 = 2", "x = 1.41421356"],
        ["exp(x) = x"],
        ["x = t", "x = 2 t"],
        ["x = t", "xdot = 2"],
        ["xdot^2 + ydot^2 = 1", "xdot = 2"],
        ["tanh(x) = 1"],
    ],
)
def test_what_no_motion_satisfies_is_never_called_consistent(constraints: list[str]) -> None:
    report = classified(coordinates=["x", "y"], constraints=constraints)
    assert report.consistent is not True
    assert report.dof is None


@pytest.mark.parametrize("size", ["1e-9", "1e-3", "1000", "5000", "1e6", "1e12"])
@pytest.mark.parametrize(
    ("constraints", "freedom"),
    [
        (["x = {0}"], 1),
        (["x + {0} t = 1"], 1),
        (["x^2 + y^2 = {0}"], 1),
        (["(x - {0})^2 + (y - 2*{0})^2 = {0}^2"], 1),
        (["x y = {0}"], 1),
        (["x = {0} sin(t)", "y = {0} cos(t)"], 0),
        (["exp(x) = {0}"], 1),
        (["{0} x + y = 1"], 1),
    ],
)
def test_units_do_not_matter(constraints: list[str], freedom: int, size: str) -> None:
    report = classified(coordinates=["x", "y"], constraints=[text.format(f"({size})") for text in constraints])
    assert (report.consistent, report.dof, report.velocity_dof) == (True, freedom, freedom)


@pytest.mark.parametrize("zero", ["atan(1) - pi/4", "cos(pi/5) - (1 + sqrt(5))/4", "sqrt(3 + 2 sqrt(2)) - 1 - sqrt(2)"])
def test_hidden_zeros_make_no_label_wrong(zero: str) -> None:
    """The coefficient is 0 in every case."""
    rolling = classified(coordinates=["x", "y"], constraints=[f"dx + ({zero}) dt = 0"]).constraints[0]
    closed = classified(coordinates=["x", "y"], constraints=[f"dx + (1 + ({zero}) x) dy = 0"]).constraints[0]
    finite = classified(coordinates=["x", "y"], constraints=[f"x + ({zero}) t = 1"]).constraints[0]
    assert rolling.scleronomic is not False
    assert rolling.catastatic is not False
    assert closed.exact is not False
    assert finite.scleronomic is not False
