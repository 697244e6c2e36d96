"""Linear relations with rational coefficients are proved, by exact elimination: truths worked out by hand."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

METHOD = "exact elimination over the rationals"


def scene(coordinates: str, texts: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": coordinates.split(), "constraints": texts.split("; "), **more}


#: What it is, the scene, (dof, redundant), the circuit of the last redundant one (None: of what was written later).
PROVED: list[tuple[str, dict[str, Any], tuple[int, list[str]], list[str] | None]] = [
    ("a cycle", scene("x y z", "x = y; y = z; z = x"), (1, ["c3"]), ["c1", "c2"]),
    ("numbers", scene("x y", "x = y; y = 3; x = 3"), (0, ["c3"]), ["c1", "c2"]),
    ("two of five", scene("x y z", "x+y=1; y+z=2; x-z=-1; x+2 y+z=3; x=0"), (0, ["c3", "c4"]), ["c1", "c2"]),
    ("drives", scene("x y", "x = t; y = 2 t; y = 2 x"), (0, ["c3"]), ["c1", "c2"]),
    ("drives of time squared", scene("x y", "x = t^2; y = 2 t^2; y = 2 x"), (0, ["c3"]), ["c1", "c2"]),
    ("a drive by a sine", scene("x y", "x = sin(t); y = 2 x; y = 2 sin(t)"), (0, ["c3"]), ["c1", "c2"]),
    ("a length", scene("x y z", "x+y=l; y+z=l; x=z", parameters={"l": "positive"}), (1, ["c3"]), ["c1", "c2"]),
    ("a tackle", scene("x y z", "2 xdot + ydot = 0; ydot = zdot; 2 xdot + zdot = 0"), (1, ["c3"]), ["c1", "c2"]),
    ("a speed and its position", scene("x y", "2 xdot + ydot = 0; 2 x + y = 5"), (1, ["c1"]), None),
    ("given speeds", scene("x y", "xdot = 1; ydot = 2; xdot + ydot = 3"), (0, ["c3"]), ["c1", "c2"]),
    ("a speed that grows", scene("x y", "xdot = t; x = t^2/2; ydot = xdot"), (0, ["c1"]), None),
    ("gears", scene("a b c", "2 a + b = 0; b = 3 c; 2 a + 3 c = 0; adot = 0"), (0, ["c3"]), ["c1", "c2"]),
]


@pytest.mark.parametrize(("made", "numbers", "circuit"), [row[1:] for row in PROVED], ids=[row[0] for row in PROVED])
def test_what_is_linear_is_proved(
    made: dict[str, Any], numbers: tuple[int, list[str]], circuit: list[str] | None
) -> None:
    report = dofkit.classify(made)
    assert (report.dof, report.redundant) == numbers
    assert (report.velocity_dof, report.holonomic, report.consistent) == (report.dof, True, True)
    assert (report.verdict, {e.verdict for e in report.constraints}) == ("proved", {"proved"})
    entry = next(e for e in report.constraints if e.name == report.redundant[-1])
    assert entry.circuit == circuit


@pytest.mark.parametrize(
    ("made", "names"),
    [
        (scene("x", "x = 1; xdot = 1"), ["c1", "c2"]),
        (scene("x y", "xdot = 1; ydot = 2; xdot + ydot = 4"), ["c1", "c2", "c3"]),
        (scene("x y", "x = t; y = x; y = 2 t"), ["c1", "c2", "c3"]),
        (scene("x", "dt = 0"), ["c1"]),
    ],
)
def test_what_contradicts_itself_is_proved_to(made: dict[str, Any], names: list[str]) -> None:
    report = dofkit.classify(made)
    assert (report.consistent, report.dof, report.conflicting, report.verdict) == (False, None, names, "proved")


@pytest.mark.parametrize(
    "made",
    [
        scene("x y", "x = abs(t); y = 2 x; y = abs(t) + t"),  # holds from t = 0 on
        scene("x y", "x = sqrt(t); y = x; y = sqrt(t)"),  # real from t = 0 on
        scene("x y", "x = h(t); y = x; y = h(t)", functions={"h": ["s"]}),
        scene("x y", "x = y; sin(x) = sin(y)"),
        scene("x y z", "x = z y; 2 x = 2 z y + z - z"),
    ],
)
def test_what_is_not_linear_is_left_to_the_others(made: dict[str, Any]) -> None:
    report = dofkit.classify(made)
    assert METHOD not in report.method
    assert report.consistent is not False


def test_a_large_cycle_and_what_breaks_it() -> None:
    """x0 = x1 - 1, ..., and back: with the right sum one is too many, with another all of them contradict."""
    n = 300
    names = [f"x{k}" for k in range(n)]
    chain = [f"x{k + 1} = x{k} + 1" for k in range(n - 1)]
    closed = dofkit.classify({"coordinates": names, "constraints": [*chain, f"x0 = x{n - 1} - {n - 1}"]})
    assert (closed.dof, closed.redundant, closed.verdict, closed.method.split(";")[0]) == (
        1,
        ["c300"],
        "proved",
        METHOD,
    )
    assert closed.constraints[-1].circuit == [f"c{k}" for k in range(1, n)]
    assert closed.generalized_coordinates is not None
    assert len(closed.generalized_coordinates) == 1
    broken = dofkit.classify({"coordinates": names, "constraints": [*chain, f"x0 = x{n - 1}"]})
    assert (broken.consistent, broken.verdict, len(broken.conflicting)) == (False, "proved", n)


def test_constraints_of_several_rows() -> None:
    """Three particles stand on each other in the plane: the third pair of equations follows from the others."""
    pairs = [("A", "B"), ("B", "C"), ("C", "A")]
    made = {
        "dimension": 2,
        "particles": ["A", "B", "C"],
        "constraints": [{"type": "coincident", "between": [*pair]} for pair in pairs],
    }
    report = dofkit.classify(made)
    assert (report.dof, report.redundant, report.redundant_equations, report.verdict) == (2, ["c3"], 2, "proved")
