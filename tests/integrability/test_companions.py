"""Forms that integrate with the help of others: whom they need, what they say then, derived by hand."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest
from shared.known_scenes import EVERY, report_of, scene_of, stem

import dofkit
from dofkit.classification.freedom import branches
from dofkit.classification.labels import companions
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, in_velocities
from dofkit.expressions.text import Names, parse_relations
from dofkit.expressions.tree import Expr
from dofkit.integrability import first_integrals
from dofkit.integrability.first_integrals import FirstIntegral
from dofkit.integrability.pfaffian_system import Codistribution
from dofkit.relations.normal.normal_form import linear_form
from dofkit.scene.lowering import lower


def classified(coordinates: str, *constraints: str, **more: Any) -> dofkit.Report:
    return dofkit.classify(dofkit.load({"coordinates": coordinates.split(), "constraints": list(constraints), **more}))


@pytest.mark.parametrize(
    ("coordinates", "constraints", "integrals"),
    [
        # theta is fixed by the difference; then sin(theta) dx - cos(theta) dy is d(x sin(theta) - y cos(theta))
        (
            "x y theta",
            ["sin(theta) dx - cos(theta) dy = 0", "sin(theta) dx - cos(theta) dy + 2 dtheta = 0"],
            {"x*sin(theta) - y*cos(theta) = C", "theta = C"},
        ),
        # x dx - y dy = x y dz - y x dz = 0
        ("x y z", ["dx = y dz", "dy = x dz"], {"x^2 - y^2 = C"}),
        # on x = y = u it reads dz = (x + x^2) dx
        ("x y z u", ["x = y", "u = y", "dz = u dx + x^2 dy"], {"3*x^2/2 + x^3 - 3*z = C"}),
        # d(x sin) = ..., with a heading that stays
        ("x y theta phi", ["dx = cos(theta) dphi", "dtheta = 0"], {"phi*cos(theta) - x = C", "theta = C"}),
        # du + x dv + v dx = d(u + x v), out of two forms in a mixed basis
        ("u v x y", ["du + x dv = dy", "v dx + dy = 0"], set()),
    ],
)
def test_what_forms_integrate_to_together(coordinates: str, constraints: list[str], integrals: set[str]) -> None:
    report = classified(coordinates, *constraints)
    assert {e.integral for e in report.constraints} - {None} == integrals


@pytest.mark.parametrize(
    ("coordinates", "constraints", "name", "needs"),
    [
        ("x y theta", ["sin(theta) dx = cos(theta) dy", "sin(theta) dx - cos(theta) dy + dtheta = 0"], "c1", ["c2"]),
        ("x y theta u", ["u = 1", "dx = cos(theta) dy", "dtheta = 0"], "c2", ["c3"]),
        ("x y z w", ["dz = y dx", "dw = 0", "dy = 0"], "c1", ["c3"]),
        ("x y z w", ["dz = y dx + w dy", "dw = 0", "w = 0", "y = 1"], "c1", ["c4"]),
        # a sphere leaves two coordinates, where every form integrates
        ("x y z", ["x^2 + y^2 + z^2 = 1", "dz = y dx"], "c2", ["c1"]),
    ],
)
def test_whom_a_form_needs(coordinates: str, constraints: list[str], name: str, needs: list[str]) -> None:
    entry = next(e for e in classified(coordinates, *constraints).constraints if e.name == name)
    assert entry.holonomic
    assert entry.holonomic_alone is False
    assert f"together with {' and '.join(repr(n) for n in needs)} it i" in entry.reason


@pytest.mark.parametrize(
    ("coordinates", "constraints", "modulo"),
    [
        ("x y z w", ["dz = y dx", "dw + dz = y dx"], {"c1": "w = C", "c2": "w = C"}),
        (
            "x y u v",
            ["y du + x dv = 0", "v dx + u dy + dv = 0"],
            {"c1": "u*y + v + v*x = C", "c2": "u*y + v + v*x = C"},
        ),
        ("x y z", ["dz = y dx"], {}),
        ("x y z u v w", ["dz = y dx", "dw = v du"], {}),
    ],
)
def test_what_a_form_says_modulo_the_others(coordinates: str, constraints: list[str], modulo: dict[str, str]) -> None:
    report = classified(coordinates, *constraints)
    assert not any(e.holonomic for e in report.constraints)
    assert all(e.integral is None for e in report.constraints)
    said = {e.name: e.reason.partition("together with them it implies ")[2].rstrip(".") for e in report.constraints}
    assert {name: text for name, text in said.items() if text} == modulo


# Every integral that is shown for a scene, held against the scene's own forms with floating point numbers

_FUNCTIONS = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "exp": math.exp, "log": lambda x: math.log(abs(x)),
    "sqrt": math.sqrt, "atan": math.atan, "asin": math.asin, "sinh": math.sinh, "cosh": math.cosh,
}  # fmt: skip


class UnknownError(Exception):
    """An expression that these tests do not evaluate."""


def value(e: Expr, at: Mapping[Expr, float]) -> float:
    """The value of an expression in floating point."""
    if e.op == "num":
        return float(e.args[0])
    if e.op == "sym":
        return at[e]
    if e.op == "const":
        return {"pi": math.pi, "E": math.e}[str(e.args[0])]
    parts = [value(child, at) for child in ex.children(e)]
    if e.op == "add":
        return sum(parts)
    if e.op == "mul":
        return math.prod(parts)
    if e.op == "pow":
        return parts[0] ** parts[1]
    if e.op == "fn" and e.args[0] in _FUNCTIONS:
        return _FUNCTIONS[str(e.args[0])](*parts)
    raise UnknownError(e.op)


def forms_of(path: Path) -> tuple[list[Expr], list[list[Expr]]] | None:
    """(columns, rows) of a scene whose relations are all differential and linear; else None."""
    system = lower(scene_of(path))
    columns = [ex.coordinate(c.name) for c in system.coordinates] + [ex.TIME]
    rows = []
    for relation in (r for c in system.constraints for r in c.relations):
        if relation.sense != "=":
            continue
        try:
            velocity_form, _ = in_velocities(relation.expr)
        except dofkit.TextError:
            return None
        form = linear_form(velocity_form)
        if form is None or not form.coefficients:
            return None
        items = dict(form.items())
        rows.append([items.get(s, ex.ZERO) for s in columns])
    return (columns, rows) if rows else None


def integrals_of(path: Path) -> list[str]:
    return [part for e in report_of(path).constraints if e.integral for part in e.integral.split("; ")]


@pytest.mark.parametrize("path", EVERY, ids=stem)
def test_the_differential_of_an_integral_lies_in_the_span_of_the_forms(path: Path) -> None:
    known = forms_of(path)
    if known is None:
        return
    columns, rows = known
    scene = scene_of(path)
    system = lower(scene)
    symbols_of_scene = (*system.parameters, *(p for p in scene.parameters or ()), "C", *(f"C{i}" for i in range(1, 9)))
    names = Names(frozenset(c.name for c in system.coordinates), {p: ex.parameter(p) for p in symbols_of_scene})
    for text in integrals_of(path):
        try:
            left = parse_relations(text, names)[0].left
        except dofkit.TextError:
            continue  # an unknown function
        rng = random.Random(3)
        symbols = {*columns, *left.symbols, *(s for row in rows for e in row for s in e.symbols)}
        at = {s: rng.uniform(0.3, 0.9) for s in sorted(symbols, key=repr)}
        try:
            matrix = np.array([[value(e, at) for e in row] for row in rows])
            slope = [value(diff(left, s), at) for s in columns]
        except UnknownError:
            continue
        scale = max(1.0, float(np.abs(matrix).max()))
        with_slope = np.vstack([matrix, slope])
        assert np.linalg.matrix_rank(with_slope, tol=1e-9 * scale) == np.linalg.matrix_rank(matrix, tol=1e-9 * scale)
        assert max(map(abs, slope)) > 1e-9


@pytest.mark.parametrize(
    ("coordinates", "constraints", "rank", "basis"),
    [
        (
            "x y theta",
            ["sin(theta) dx = cos(theta) dy", "sin(theta) dx - cos(theta) dy + 2 dtheta = 0"],
            2,
            ["theta = C1", "x*sin(theta) - y*cos(theta) = C2"],
        ),
        ("x y z w", ["dz = y dx", "dw + dz = y dx"], 1, ["w = C"]),
        ("x y z", ["x + y = t", "xdot + ydot = z"], 2, ["z - 1 = 0"]),
        ("x y", ["x dy + y dx = 0"], 1, ["x*y = C"]),
        ("x y z", ["dz = y dx"], 0, []),
        ("x y z", ["x^2 + y^2 = 1", "dz = x dy - y dx"], 2, None),  # z is an angle: no polynomial
    ],
)
def test_the_largest_integrable_part(
    coordinates: str, constraints: list[str], rank: int, basis: list[str] | None
) -> None:
    part = classified(coordinates, *constraints).integrable_part
    assert part is not None
    assert (part.rank, part.basis) == (rank, basis)


def test_finite_relations_alone_have_no_integrable_part_to_find() -> None:
    assert classified("x y z", "x = y").integrable_part is None


@pytest.mark.parametrize(
    ("constraints", "many"),
    [(["dy = x dx", "dz = y dx"], 2), (["dz = y dx", "y = 2"], 1), (["dz = y dx", "x^2 + y^2 = 1"], 1)],
)
def test_as_many_integrals_are_sought_as_there_are(
    constraints: list[str], many: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Three coordinates less the freedom, 1, and the finite relations."""
    sought: list[int] = []
    search = first_integrals.first_integrals

    def counted(forms: Codistribution, wanted: int) -> list[FirstIntegral]:
        sought.append(wanted)
        return search(forms, wanted)

    monkeypatch.setattr(companions.first_integrals, "first_integrals", counted)
    assert dofkit.classify({"coordinates": ["x", "y", "z"], "constraints": constraints}).dof == 1
    assert set(sought) == {many}


@pytest.mark.parametrize(
    ("names", "texts", "dof", "velocity_dof"),
    [
        ("x y z w", ["dz = w (dx + dy)", "dw = z (dx + dy)"], 2, 2),  # z^2 - w^2 and (z + w) exp(-x - y) are constant
        ("x z w u", ["dz = w dx", "du = w dx"], 3, 2),  # u - z is constant, and no more
        ("x y z w u", ["dz = w dx + y dw", "du = w dx + y dw + dy"], 4, 3),  # u - z - y
    ],
)
def test_what_integrates_only_together_is_proved(names: str, texts: list[str], dof: int, velocity_dof: int) -> None:
    report = dofkit.classify({"coordinates": names.split(), "constraints": texts})
    assert (report.dof, report.velocity_dof) == (dof, velocity_dof)
    assert {report.verdicts[key].verdict for key in ("dof", "velocity_dof", "holonomic", "redundant")} == {"proved"}
    assert [entry.holonomic for entry in report.constraints] == [dof == velocity_dof] * 2
    assert {entry.verdicts["holonomic"].verdict for entry in report.constraints} == {"proved"}


def test_the_answer_of_the_system_is_used_again_for_a_label(monkeypatch: pytest.MonkeyPatch) -> None:
    analysed = Mock(wraps=branches.in_time)
    monkeypatch.setattr(branches, "in_time", analysed)
    dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]})
    analysed.assert_called_once()
