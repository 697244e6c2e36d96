"""Growth vectors held against brackets of polynomial fields, worked out symbolically with SymPy."""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any

import pytest
import sympy
from shared.known_scenes import spread
from sympy.polys.rings import ring

import dofkit

Field = list[Any]


def bracket(x: Field, y: Field, q: Sequence[Any]) -> Field:
    """[X, Y]^i = X(Y^i) - Y(X^i)."""
    return [
        sum((a * f.diff(v) for a, v in zip(x, q, strict=True)), q[0] * 0)
        - sum((b * g.diff(v) for b, v in zip(y, q, strict=True)), q[0] * 0)
        for f, g in zip(y, x, strict=True)
    ]


def growth_by_brackets(fields: Sequence[Field], q: Sequence[Any], point: Sequence[int]) -> list[int]:
    """dim D_k at a point: D_k+1 adds the brackets of the fields with what the last step added."""
    layer, vectors, found = list(fields), [], []
    while True:
        vectors += [[f.evaluate(list(zip(q, point, strict=True))) for f in y] for y in layer]
        rank = sympy.Matrix(vectors).rank()
        if found and found[-1] == rank:
            return found
        found.append(rank)
        if rank == len(q):
            return found
        layer = [bracket(x, y, q) for x in fields for y in layer]


def derived_by_brackets(fields: Sequence[Field], q: Sequence[Any], point: Sequence[int]) -> list[int]:
    """dim D^(j) at a point: D^(j+1) adds all brackets of a basis of D^(j)."""

    def at(y: Field) -> list[Any]:
        return [f.evaluate(list(zip(q, point, strict=True))) for f in y]

    basis, found = list(fields), [len(fields)]
    while True:
        for x, y in combinations(list(basis), 2):
            new = bracket(x, y, q)
            if sympy.Matrix([at(v) for v in [*basis, new]]).rank() > len(basis):
                basis.append(new)
        if len(basis) == found[-1]:
            return found
        found.append(len(basis))


def scene_of(names: Sequence[str], slopes: Sequence[Sequence[str]], free: Sequence[str]) -> dofkit.Scene:
    """The forms dx_i - sum_l slopes[l][i] dfree_l, whose kernel the fields d/dfree_l + slopes_l span."""
    dependent = [n for n in names if n not in free]
    forms = []
    for i, name in enumerate(dependent):
        forms.append(f"d{name} - " + " - ".join(f"({slopes[k][i]}) d{v}" for k, v in enumerate(free)) + " = 0")
    return dofkit.load({"coordinates": list(names), "constraints": forms})


def agree(names: Sequence[str], slopes: Sequence[Sequence[str]], free: Sequence[str]) -> list[int]:
    """The growth vector by brackets, once dofkit has said the same."""
    world, *q = ring(",".join(names), sympy.QQ)
    here = dict(zip(names, q, strict=True))
    dependent = [n for n in names if n not in free]
    fields = []
    for k, v in enumerate(free):
        row = {n: polynomial(slopes[k][i], here, world) for i, n in enumerate(dependent)}
        fields.append([world(1) if n == v else row.get(n, world(0)) for n in names])
    rng = random.Random(1)
    point = [rng.randrange(2, 99) for _ in q]
    expected = growth_by_brackets(fields, q, point)
    scene = scene_of(names, slopes, free)
    report = dofkit.classify(scene)
    assert (report.growth_vector, report.dof) == (expected, expected[-1])
    derived = dofkit.derived_flag(scene)
    assert derived is None or [len(q) - r for r in derived] == derived_by_brackets(fields, q, point)
    return expected


def polynomial(text: str, here: dict[str, Any], world: Any) -> Any:
    """A sum of products of numbers and names, as these tests write them."""
    total = world(0)
    for term in text.split(" + "):
        product = world(1)
        for factor in term.split():
            product = product * (here[factor] if factor in here else Fraction(factor))
        total = total + product
    return total


@pytest.mark.parametrize(
    ("names", "slopes", "expected"),
    [
        # two fields; the slopes are those of the dependent coordinates
        ("u v a b c", [["0", "0", "a + 1"], ["u", "a + 1", "0"]], [2, 3, 5]),
        ("u v a", [["0"], ["u"]], [2, 3]),
        ("u v a b", [["0", "0"], ["u", "u u"]], [2, 3, 4]),
        ("u v a b", [["0", "0"], ["u", "u v"]], [2, 3, 4]),
        ("u v a b c", [["0", "0", "0"], ["u", "u u", "u v"]], [2, 3, 5]),
        # chained forms (Goursat)
        ("u v a b c", [["0", "0", "0"], ["u", "u u", "u u u"]], [2, 3, 4, 5]),
        ("u v a b c d", [["0", "a", "b", "c"], ["u", "0", "0", "0"]], [2, 3, 4, 5, 6]),
        # free nilpotent of step 4
        (
            "u v a b c d e f",
            [["0", "0", "0", "0", "0", "0"], ["u", "u u", "u v", "u u u", "u u v", "u v v"]],
            [2, 3, 5, 8],
        ),
    ],
)
def test_growth_of_fields_in_the_plane(names: str, slopes: list[list[str]], expected: list[int]) -> None:
    assert agree(names.split(), slopes, ["u", "v"]) == expected


def test_a_flag_that_one_curve_does_not_see() -> None:
    """[[u, v], [u, [u, v]]] has a direction of its own: length five, and no ad_X^4 Y."""
    slopes = [["0", "a", "b", "0"], ["u", "0", "0", "a a"]]
    assert agree(["u", "v", "a", "b", "c", "e"], slopes, ["u", "v"])[-1] == 6
    slopes = [["0"] * 5, ["x", "0", "x x", "x z", "x x z"], ["0", "x", "0", "x y", "x u"]]
    assert agree(list("xyzuvqpw"), slopes, ["x", "y", "z"]) == [3, 5, 7, 8]  # [U, V] is of length four, and in D''


@pytest.mark.parametrize("seed", spread(range(14)))
def test_growth_of_random_polynomial_fields(seed: int) -> None:
    rng = random.Random(seed)
    fields, n = rng.choice([(2, 5), (2, 6), (2, 7), (3, 6), (3, 7), (2, 8)])
    names = [f"q{i}" for i in range(n)]

    def term() -> str:
        return " ".join([str(rng.randint(1, 4)), *rng.choices(names, k=rng.randint(0, 2))])

    slopes = [[" + ".join(term() for _ in range(rng.choice([1, 1, 2]))) for _ in range(n - fields)]
              for _ in range(fields)]  # fmt: skip
    agree(names, slopes, names[:fields])


@pytest.mark.parametrize("seed", spread(range(16)))
def test_growth_of_random_nilpotent_fields(seed: int) -> None:
    """Each coordinate's slope mentions earlier ones only: long flags."""
    rng = random.Random(100 + seed)
    n = rng.choice([5, 6, 7])
    names = [f"q{i}" for i in range(n)]
    slopes = [[], []]
    for i in range(2, n):
        for row in slopes:
            row.append(
                " ".join([str(rng.randint(0, 2)), *rng.choices(names[: min(i, 3 + i // 2)], k=rng.choice([1, 1, 2]))])
            )
    agree(names, slopes, names[:2])


def test_the_derived_flag_of_a_car_with_trailers() -> None:
    """A Goursat flag: every derivation loses one form (Laumond 1993)."""
    for n in range(1, 5):
        angles = [f"th{i}" for i in range(n + 1)]
        forms = []
        for i, angle in enumerate(angles):
            arms = "".join(f" + cos({angle} - {a}) d{a}" for a in angles[1 : i + 1])
            forms.append(f"sin({angle}) dx - cos({angle}) dy{arms} = 0")
        scene = dofkit.load({"coordinates": ["x", "y", *angles], "constraints": forms})
        assert dofkit.derived_flag(scene) == list(range(n + 1, -1, -1))
        assert dofkit.classify(scene).growth_vector == list(range(2, n + 4))


@pytest.mark.parametrize(
    ("constraints", "ranks"),
    [
        (["x dx + y dy = 0"], [1]),
        (["dz - y dx = 0"], [1, 0]),
        (["dz - y dx = 0", "x^2 + y^2 = 1"], [2]),
        (["dx - cos(z) dw = 0", "dy - sin(z) dw = 0"], [2, 1, 0]),
        (["dz - y dx = 0", "dw = 0"], [2, 1]),
        (["dx = y dt"], [1, 0]),
        (["x = sin(t)"], [1]),
        (["xdot^2 + ydot^2 = zdot^2"], None),
    ],
)
def test_the_ranks_of_the_derived_flag(constraints: list[str], ranks: list[int] | None) -> None:
    assert dofkit.derived_flag({"coordinates": list("xyzw"), "constraints": constraints}) == ranks
