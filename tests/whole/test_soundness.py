"""Scenes that were once answered wrongly, and sure: each right, or open, its truth worked out by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from shared.report_laws import agrees_with_itself

import dofkit
from dofkit.exact.points.field import prime_for
from dofkit.scene.expectation import unmet

H = {"h": ["s"]}


def scene(coordinates: str, *constraints: str, **more: Any) -> dict[str, Any]:
    return {"coordinates": coordinates.split(), "constraints": [*constraints], **more}


#: Each with its scene and the truth.
RIGHT = yaml.safe_load((Path(__file__).parent / "soundness.yaml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("row", RIGHT, ids=[row["case"] for row in RIGHT])
def test_right(row: dict[str, Any]) -> None:
    """What a row calls open is right or undecided; all else is right."""
    report = dofkit.classify(row["scene"])
    claims = {f"{key}_{k}": v for key, claim in report.verdicts.items() for k, v in claim.model_dump().items()}
    answers = {**report.to_dict(), **claims}
    undecided = {key: None for key in row.get("open", ()) if answers[key] is None}
    scene = dofkit.load(row["scene"]).model_copy(update={"expect": row["truth"] | undecided})
    assert unmet(scene, answers) == []
    if report.verdict != "undecided":
        agrees_with_itself(report)


#: What no order of writing changes.
NUMBERS = ("consistent", "feasible", "dof", "velocity_dof", "instantaneous_dof", "singular", "holonomic", "scleronomic",
           "redundant_equations")  # fmt: skip


@pytest.mark.parametrize("row", RIGHT[::3], ids=[row["case"] for row in RIGHT[::3]])
def test_the_order_of_coordinates_and_constraints_means_nothing(row: dict[str, Any]) -> None:
    turned = {key: row["scene"][key][::-1] for key in ("coordinates", "constraints") if key in row["scene"]}
    report = dofkit.classify({**row["scene"], **turned}).to_dict()
    truth = {k: row["truth"][k] for k in NUMBERS if k in row["truth"] and (report[k] is not None or "open" not in row)}
    assert {k: report[k] for k in truth} == truth


def test_a_coefficient_that_vanishes_modulo_public_primes_is_none_of_0() -> None:
    """dz = y dx, dw = (N u + z) dx: D has dimension 3, and [D, D] gives d/dz and d/dw at once for any N but 0."""
    large = "*".join(str(prime_for(1, (), k)) for k in range(3))
    report = dofkit.classify(scene("x y u z w", "zdot = y*xdot", f"wdot = ({large}*u + z)*xdot"))
    assert report.growth_vector == [3, 5]


@pytest.mark.parametrize("q", [2**61 - 1, prime_for(1, (), 0)])
def test_a_drawn_place_with_a_prime_below_the_line(q: int) -> None:
    places = [{"name": "A", "at": [f"1/{q}", 0]}, {"name": "B", "at": [1, 0]}]
    link = {"type": "link", "between": ["A", "B"]}
    assert dofkit.classify({"dimension": 2, "particles": places, "constraints": [link]}).dof == 3


def test_measured_links_with_a_relation_that_is_drawn_nowhere() -> None:
    """Nine links of K(3,3) on two lines move; decimals that are right to 10^-4 contradict nothing."""
    places = {"A0": (3, 0), "A1": (-6, 0), "A2": (5, 0), "B0": (0, -5), "B1": (0, -8), "B2": (0, -4)}
    links = [{"type": "link", "between": [a, b]} for a in places for b in places if (a[0], b[0]) == ("A", "B")]
    particles = [{"name": name, "at": [*at]} for name, at in places.items()]
    report = dofkit.classify(
        {
            "dimension": 2,
            "tolerance": 1e-4,
            "particles": particles,
            "coordinates": ["q", "r"],
            "constraints": [*links, "r = x_B2 + q^2"],
        }
    )
    assert report.consistent is not False
    assert (report.dof, report.verdict) in ((5, "numeric"), (None, "undecided"))


@pytest.mark.sweep
def test_an_exact_form_with_arguments_in_two_writings_is_not_called_inexact() -> None:
    """It is d(x sin(1/(1+y)))."""
    entry = dofkit.classify(scene("x y", "sin(1/(1+y))*xdot + x*cos(2/(2+2*y))*(-1)/(1+y)^2*ydot = 0")).constraints[0]
    assert entry.exact or entry.verdict == "undecided"


# Measured geometry with everything else attached

#: Three cranks, parallel and of one length within 1e-3: they move, and one link is redundant.
CRANKS = {"A": (0, 0), "B": (1, 0), "C": (2, 0), "D": (0.333, 0.943), "E": (1.333, 0.943), "F": (2.3334, 0.9427)}


def three_cranks(coordinates: str, *constraints: str, **more: Any) -> dict[str, Any]:
    """The cranks, and more."""
    links = [{"type": "link", "between": [*pair]} for pair in ("AD", "BE", "CF", "DE", "EF", "DF")]
    return {
        "dimension": 2,
        "tolerance": 1e-3,
        "particles": [{"name": name, "at": [*at]} for name, at in CRANKS.items()],
        "coordinates": coordinates.split(),
        "constraints": [*({"type": "fixed", "point": p} for p in "ABC"), *links, *constraints],
        **more,
    }


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("made", "dof", "velocity_dof"),
    [
        (three_cranks(""), 1, 1),
        # dr - x_D dq on the turn of the cranks, q and r: d of it is -dx_D dq, and x_D turns
        (three_cranks("q r", "rdot = x_D*qdot"), 3, 2),
        (three_cranks("q r", "rdot = x_D*qdot", configuration={"q": 0, "r": 0}), 3, 2),
        # along the one motion of the cranks everything integrates
        (three_cranks("r", "rdot = x_D*ydot_D"), 1, 1),
    ],
)
def test_measured_cranks_with_a_form(made: dict[str, Any], dof: int, velocity_dof: int) -> None:
    """With a form the whole may be undecided; the cranks by themselves are measured, and one link is redundant."""
    report = dofkit.classify(made)
    if len(made["constraints"]) > 9 and report.verdict == "undecided":
        assert (report.dof in (dof, None), report.velocity_dof in (velocity_dof, None)) == (True, True)
        return
    assert (report.dof, report.velocity_dof, report.verdict) == (dof, velocity_dof, "numeric")
    assert report.holonomic == (dof == velocity_dof)
    assert report.redundant is not None
    assert "c9" in report.redundant


@pytest.mark.parametrize(
    ("made", "truth"),
    [
        # x_E - x_D is 1 on the cranks' motion, 1.0004 - 1e-4 ... as measured: r - q is constant, dof 2
        (three_cranks("q r", "rdot = (x_E - x_D)*qdot"), 2),
        # q is free, r is constant: A stands still
        (three_cranks("q r", "rdot = x_A*qdot"), 2),
        (three_cranks("q r", "rdot = h(x_D)*qdot", functions=H), 3),
        (three_cranks("u", "u = x_D^2"), 1),
    ],
)
def test_what_the_tolerance_may_hide_is_open(made: dict[str, Any], truth: int) -> None:
    report = dofkit.classify(made)
    assert (report.dof, report.verdict) in ((truth, "numeric"), (None, "undecided"))


@pytest.mark.parametrize(
    ("made", "dof", "velocity_dof"),
    [
        (three_cranks("u v", "u = v^2"), 2, 2),
        (three_cranks("u v", "u = v^2", configuration={"u": 1, "v": 1}), 2, 2),
        (three_cranks("u v", "u^2 + v^2 = 1", "2*u^2 + 2*v^2 = 2"), 2, 2),
        (three_cranks("u v w", "udot = v*wdot"), 4, 3),
    ],
)
def test_equations_beside_measured_geometry_stay_proved_and_it_stays_measured(
    made: dict[str, Any], dof: int, velocity_dof: int
) -> None:
    """Once it was put to exact arithmetic, and said to be rigid, where other coordinates were given no values."""
    report = dofkit.classify(made)
    assert (report.dof, report.velocity_dof, report.verdict) == (dof, velocity_dof, "numeric")
    own = [e for e in report.constraints if e.type == "equation"]
    assert {e.verdict for e in own} == {"proved"}


def test_relations_that_a_measured_drawing_does_not_meet_are_open() -> None:
    report = dofkit.classify(three_cranks("", "x_E = x_D + 2"))
    assert (report.dof, report.verdict) == (None, "undecided")
    assert dofkit.classify(three_cranks("", "x_E = x_D + 1")).dof == 1


def test_what_no_measured_number_enters_is_proved() -> None:
    ball = {"bodies": ["ball"], "parameters": ["R"], "constraints": ["z_ball = R"], "tolerance": 1e-6}
    report = dofkit.classify(ball)
    assert (report.dof, report.verdict) == (5, "proved")
    pendulum = {"dimension": 2, "particles": ["A"], "tolerance": 1e-3}
    link = {"type": "link", "between": [[0, 0], "A"], "length": "0.333"}
    assert dofkit.classify({**pendulum, "constraints": [link]}).dof == 1


def test_three_and_three_on_two_lines_measured() -> None:
    """(sqrt(a^2 + c), 0) and (0, sqrt(b^2 - c)) keep all nine lengths."""
    places = {"A": (1, 0), "B": (3, 0), "C": (-5, 0), "D": (0, 2), "E": (0, 4), "F": (0, -3)}
    made = {
        "dimension": 2,
        "tolerance": 1e-6,
        "particles": [{"name": name, "at": [*at]} for name, at in places.items()],
        "constraints": [{"type": "link", "between": [a, b]} for a in "ABC" for b in "DEF"],
    }
    report = dofkit.classify(made)
    assert (report.dof, report.verdict) == (4, "numeric")


# Flat contacts among many coordinates


MANY = [f"q{i}" for i in range(70)]
SQUARES = "+".join(f"{q}^2" for q in MANY)
#: Flat at 0: x^9/9! - ..., and -x^10/10! + ...
SINE = "(sin(x) - x + x^3/6 - x^5/120 + x^7/5040)"
COSINE = "(cos(x) - 1 + x^2/2 - x^4/24 + x^6/720 - x^8/40320)"


def flat(*constraints: str) -> dict[str, Any]:
    """Relations on x, y and seventy more, drawn at 0."""
    names = ["x", "y", *MANY]
    return scene(" ".join(names), *constraints, configuration=dict.fromkeys(names, 0))


@pytest.mark.parametrize(
    ("constraints", "truth"),
    [
        # y = 0 leaves SINE^3 (1 + ...) + COSINE^3 q0 = 0, or x^27 (1/9!^3 - x^3 q0/10!^3 + ...) = 0: near 0 x = 0
        (["y = 0", f"y = {SINE}^3*(1 + {SQUARES}) + {COSINE}^3*q0"], 70),
        (["y = 0", f"y = {COSINE}*(1 + {SQUARES})"], 70),
        (["y = 0", f"y = {SINE}^2*(2 + cos(q3))"], 70),
        # the second follows: x and all others are free
        (["y = 0", f"y*(2 + cos(x) + {SQUARES}) = y^3*sin(q0)"], 71),
        (["y = sin(x)", f"y*(1 + {SQUARES}) = sin(x)*(1 + {SQUARES})"], 71),
    ],
)
def test_flat_relations_among_many_coordinates(constraints: list[str], truth: int) -> None:
    report = dofkit.classify(flat(*constraints))
    assert report.dof in ((truth,) if truth == 71 else (truth, None))
    assert (report.dof is None) == (report.verdict == "undecided")


# what depends on what


def cranks(*order: str, measured: bool = False, more: int = 0) -> dict[str, Any]:
    """Parallel cranks A D, B E, ... of one length, the pins D, E, ... on one line, ``order`` of the links."""
    pivots = {name: [k, 0] for k, name in enumerate("ABCI"[: 3 + more])}
    pins: dict[str, list[Any]] = {name: [f"{5 * k + 3}/5", "4/5"] for k, name in enumerate("DEFG"[: 3 + more])}
    if measured:
        pins = {"D": [0.333, 0.943], "E": [1.333, 0.943], "F": [2.3334, 0.9427]}
    fixed = [{"type": "fixed", "point": p} for p in pivots]
    links = [{"type": "link", "between": [*pair]} for pair in order]
    particles = [{"name": name, "at": at} for name, at in {**pivots, **pins}.items()]
    tolerance = {"tolerance": 1e-3} if measured else {}
    return {"dimension": 2, "particles": particles, "constraints": [*fixed, *links], **tolerance}


def before(number: int) -> list[str]:
    """c1, ..., as many."""
    return [f"c{k + 1}" for k in range(number)]


#: What makes it hard, the scene, the constraint that follows, and the least set from which it does.
CIRCUITS: list[tuple[str, dict[str, Any], str, list[str]]] = [
    (
        "D, E, F on a line have freedom 4 without DF and 3 with it: it takes the cranks",
        cranks("AD", "BE", "CF", "DE", "EF", "DF"),
        "c9",
        before(8),
    ),
    ("the same measured", cranks("AD", "BE", "CF", "DE", "EF", "DF", measured=True), "c9", before(8)),
    ("dx = y dz where y = 0", scene("x y z", "x = 0", "y = 0", "dx = y dz"), "c3", ["c1", "c2"]),
    ("a coefficient u - 1 where u = 1", scene("u x z", "u = 1", "x = 0", "dx = (u - 1) dz"), "c3", ["c1", "c2"]),
    ("two of them", scene("x y z w", "x = 0", "y = 0", "dx = y dz + y^2 dw"), "c3", ["c1", "c2"]),
    (
        "a knife edge along a circle whose tangent it keeps: x dx + y dy = 0 takes all three",
        scene("x y a", "x^2 + y^2 = 1", "x cos(a) + y sin(a) = 0", "sin(a) dx - cos(a) dy = 0"),
        "c3",
        ["c1", "c2"],
    ),
]


@pytest.mark.parametrize(("made", "name", "circuit"), [row[1:] for row in CIRCUITS], ids=[row[0] for row in CIRCUITS])
def test_a_circuit_implies_what_it_is_of(made: dict[str, Any], name: str, circuit: list[str]) -> None:
    report = dofkit.classify(made)
    assert report.redundant == [name]
    assert next(e.circuit for e in report.constraints if e.name == name) == circuit
    assert [group.members for group in report.redundancies] == [[*circuit, name]]


def test_an_integral_stands_beside_all_other_constraints() -> None:
    """z is free where y = 0, though beside x = 0 alone dx = y dz makes it constant."""
    entry = dofkit.classify(scene("x y z", "x = 0", "y = 0", "dx = y dz")).constraints[2]
    assert entry.integral is None
    assert entry.holonomic


def hinges(*axes: list[Any], at: Any = None) -> dict[str, Any]:
    """A closed loop of hinges in space, each through the origin or ``at`` so far along x."""
    bodies = [f"b{k}" for k in range(len(axes) - 1)]
    ends = ["ground", *bodies, "ground"]
    places = [[0, 0, 0] for _ in axes] if at is None else [[x, 0, 0] for x in at]
    joints = [
        {"type": "revolute", "between": ends[k : k + 2], "at": place, "axis": axis}
        for k, (axis, place) in enumerate(zip(axes, places, strict=True))
    ]
    return {"bodies": bodies, "constraints": joints}


@pytest.mark.parametrize(
    "axes",
    [
        [[1, 0, 0], [0, 1, 0], [-1, -1, 0]],
        [[1, 0, 0], [3, 4, 0], [-1, 2, 0]],
        [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]],
        [[1, 0, 0], [3, 4, 0], [-1, 0, 0], [3, -4, 0]],
    ],
    ids=["three hinges", "three others", "a cross", "a flat vertex"],
)
def test_a_hinge_of_a_flat_spherical_loop_is_needed(axes: list[list[int]]) -> None:
    """To first order one of their equations is too many, but without a hinge its two bodies are free to turn."""
    report = dofkit.classify(hinges(*axes))
    assert report.redundant == []
    assert all(e.circuit is None for e in report.constraints)
    for name in [e.name for e in report.constraints]:
        left = hinges(*axes)
        left["constraints"] = [c | {"name": f"c{k + 1}"} for k, c in enumerate(left["constraints"])]
        left["constraints"] = [c for c in left["constraints"] if c["name"] != name]
        assert report.dof is not None
        assert (dofkit.classify(left).dof or 0) > report.dof


Z = [0, 0, 1]


@pytest.mark.parametrize(
    "places", [(0, 1, 3, 2), (0, 2, 4, 2), (0, 3, 1, -2)], ids=["parallelogram", "kite", "crossed"]
)
def test_bars_in_line_on_parallel_hinges(places: tuple[int, ...]) -> None:
    """Out of the plane 4 parallel hinges say 12 things of three bodies' 9; in the plane nothing is too many."""
    report = dofkit.classify(hinges(Z, Z, Z, Z, at=places))
    assert (report.dof, report.redundant_equations, report.redundant) == (1, 3, [])
    assert [group.nullity for group in report.redundancies] == [3]
    assert [e.independent for e in report.constraints] == [5, 5, 5, 2]


def test_a_slider_crank_at_its_dead_point() -> None:
    """Crank and rod of one length: the pin stands over the crank's pivot, and motions cross."""
    made = hinges(Z, Z, Z, at=(0, 0, 0))
    made["constraints"][1]["at"] = [0, 1, 0]
    made["bodies"] = ["b0", "b1", "b2"]
    made["constraints"][2]["between"] = ["b1", "b2"]
    made["constraints"].append({"type": "prismatic", "between": ["b2", "ground"], "axis": [1, 0, 0]})
    report = dofkit.classify(made)
    assert (report.dof, report.redundant_equations, report.redundant) == (1, 3, [])
    assert [group.nullity for group in report.redundancies] == [3]
    assert sum(e.independent or 0 for e in report.constraints) == 17


def test_where_a_singular_set_hides_how_many_equations_are_needed_it_is_said() -> None:
    """Three bars as long as the ground: rigid, and the equations hold at one place only."""
    report = dofkit.classify(hinges(Z, Z, Z, Z, at=(0, 1, 3, 6)))
    assert (report.dof, report.redundant) == (0, [])
    assert sum(g.nullity for g in report.redundancies) == report.redundant_equations or report.verdict == "undecided"


def test_of_what_follows_only_with_what_is_written_later_less_is_reported() -> None:
    """DF before the cranks does not follow from DE and EF; that it can go is known, and of which equation it is not."""
    report = dofkit.classify(cranks("DE", "EF", "DF", "AD", "BE", "CF"))
    assert (report.dof, report.redundant_equations) == (1, 1)
    assert len(report.redundant or ()) == 1
    entry = report.constraints[5]
    assert entry.independent in (1, None)
    assert entry.circuit is None


#: What can go, and of which points that is told.
SCOPES = [
    (scene("x y", "x = y", "x^2 = y^2"), "everywhere"),
    (scene("x y", "x = y", "2 x = 2 y", configuration={"x": 1, "y": 1}), "reference"),
    (scene("x y z", "x^2 = y^2", "dz = x dy", configuration={"x": 1, "y": 1, "z": 0}), "component"),
    (cranks("AD", "BE", "CF", "DE", "EF", "DF"), "reference"),
]


@pytest.mark.parametrize(("made", "about"), SCOPES, ids=["branches", "a copy", "a branch", "a drawing"])
def test_it_is_known_of_which_points_redundancy_is_reported(made: dict[str, Any], about: str) -> None:
    assert dofkit.classify(made).verdicts["redundant"].about == about
