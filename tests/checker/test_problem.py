"""Scenes -> problems: relations derived by hand, charts, references, and documents with one hash however written."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from checker.certified import document_of
from checker.values import of_tree, rows_of_trees
from shared.known_scenes import SCENES, few, scene_of, stem

import dofkit
from dofkit.checker.grammar import KnownNames, parse
from dofkit.checker.problem import CheckedProblem as Problem
from dofkit.checker.problem import canonical, problem_of_canonical, sha256_of
from dofkit.checker.trees import CheckError, number


def read(text: str, *cayley: str) -> Problem:
    return problem_of_canonical(canonical(document_of(text)), frozenset(cayley))


def said(problem: Problem) -> dict[str, str]:
    return {relation.name: relation.kind for relation in problem.relations}


def agrees(problem: Problem, name: str, text: str, factor: float = 1) -> None:
    """The relation is ``text`` times a number, at random places."""
    (relation,) = (relation for relation in problem.relations if relation.name == name)
    rates = [f"{q}dot" for q in problem.coordinates]
    names = [*problem.coordinates, *rates, *problem.world.signs, *problem.world.generic, "t", "tdot"]
    known = KnownNames(frozenset(names) - {"t"})
    for seed in range(4):
        values = {q: random.Random(f"{q} {seed}").uniform(0.2, 1.2) for q in names}
        assert of_tree(relation.tree, values) == pytest.approx(factor * of_tree(parse(text, known), values)), name


def test_texts_are_finite_relations_forms_velocities_and_inequalities() -> None:
    problem = read("""
parameters: {R: positive, v: real, b: 3/2}
coordinates: [x, y, phi]
constraints:
- {name: sphere, type: equation, text: "x^2 + y^2 = b^2"}
- dx = R cos(phi) dphi
- x dy + dt = 0
- xdot = v
- xdot^2 + ydot^2 = v^2
- dx^2 + dy^2 = v^2 dt^2
- dy/dx = tan(phi)
- 0 <= x < b
- dx/dt - v
- {name: twice, text: 1/xdot/xdot = 4}
- xdot + x - xdot = 0
""")
    assert said(problem) == {
        **{"sphere": "finite", "c2": "velocity", "c3": "velocity", "c4": "velocity", "c5": "velocity"},
        **{
            "c6": "velocity",
            "c7": "velocity",
            "c8.1": "inequality",
            "c8.2": "inequality",
            "c9": "velocity",
            "twice": "velocity",
            "c11": "finite",
        },
    }
    assert [relation.strict for relation in problem.relations if relation.kind == "inequality"] == [False, True]
    assert problem.world.signs == {"R": "positive", "v": "real"}
    texts = {
        **{"sphere": "x^2 + y^2 - 9/4", "c2": "xdot - R cos(phi) phidot", "c3": "x ydot + tdot", "c4": "xdot - v tdot"},
        **{"c5": "xdot^2 + ydot^2 - v^2", "c6": "xdot^2 + ydot^2 - v^2", "c7": "ydot - tan(phi) xdot"},
        **{"c8.1": "x", "c8.2": "3/2 - x", "c9": "xdot - v tdot", "c11": "x", "twice": "1/xdot^2 - 4"},
    }
    for name, text in texts.items():
        agrees(problem, name, text)


def test_links_take_their_length_from_the_text_the_drawing_or_nowhere() -> None:
    problem = read("""
dimension: 2
parameters: {l: positive}
particles: [{name: A, at: [0, 0]}, {name: B, at: [3, 4]}, C]
constraints:
- {type: link, between: [A, B]}
- {type: link, between: [A, B], length: l + t}
- {type: link, between: [B, C]}
- {type: link, between: [[1, 2], C], length: "sqrt(3)/2"}
- {type: rigid, members: [A, B, C]}
""")
    agrees(problem, "c1", "(x_B - x_A)^2 + (y_B - y_A)^2 - 25")
    agrees(problem, "c2", "(x_B - x_A)^2 + (y_B - y_A)^2 - (l + t)^2")
    agrees(problem, "c3", "(x_B - x_C)^2 + (y_B - y_C)^2 - square_c3")
    agrees(problem, "c4", "(x_C - 1)^2 + (y_C - 2)^2 - 3/4")
    agrees(problem, "c5.1", "(x_B - x_A)^2 + (y_B - y_A)^2 - 25")
    agrees(problem, "c5.3", "(x_B - x_C)^2 + (y_B - y_C)^2 - square_c5_2")
    assert tuple(problem.world.generic) == ("square_c3", "square_c5", "square_c5_2")
    assert problem.reference == {}


def test_a_string_a_curve_and_fixed_points() -> None:
    problem = read("""
dimension: 2
parameters: {L: positive}
particles: [{name: A, at: [0, 3]}, {name: B, at: [4, 0]}]
constraints:
- {type: string, along: [A, [0, 0], B]}
- {type: string, along: [A, B], length: L - t}
- {type: "on", members: [A, B], curve: ["y = x^2 + t"]}
- {type: fixed, point: A}
- {type: coincident, between: [A, B]}
""")
    agrees(problem, "c1", "sqrt(x_A^2 + y_A^2) + sqrt(x_B^2 + y_B^2) - 7")
    agrees(problem, "c2", "sqrt((x_A - x_B)^2 + (y_A - y_B)^2) - L + t")
    agrees(problem, "c3.2", "y_B - x_B^2 - t")
    agrees(problem, "c4.2", "y_A - 3")
    agrees(problem, "c5.1", "x_B - x_A")
    assert problem.reference == {"x_A": number(0), "y_A": number(3), "x_B": number(4), "y_B": number(0)}


def test_joints_of_the_plane() -> None:
    problem = read("""
dimension: 2
bodies: [A, {name: B, coordinates: [u, v, w]}]
constraints:
- {type: revolute, between: [ground, A], at: [1, 2], drive: 3 t}
- {type: revolute, between: [A, B], at: [0, 1]}
- {type: prismatic, between: [ground, B], axis: [3, 4], drive: t^2}
- {type: weld, between: [A, B]}
- {type: slot, point: {on: B, at: [2, 0]}, body: A, at: [0, 0], axis: [1, 0]}
- {type: gear, between: [A, B], ratio: -2}
- {type: roll, body: A, radius: 1/2}
""")
    agrees(problem, "c1.1", "x_A + cos(theta_A) - 2 sin(theta_A) - 1")
    agrees(problem, "c1.2", "y_A + sin(theta_A) + 2 cos(theta_A) - 2")
    agrees(problem, "c1.3", "theta_A - 3 t")
    agrees(problem, "c2.1", "u - sin(w) - x_A + sin(theta_A)")
    agrees(problem, "c3.1", "w")
    agrees(problem, "c3.2", "-4 u + 3 v")
    agrees(problem, "c3.3", "(3 u + 4 v)/5 - t^2")
    agrees(problem, "c4.1", "w - theta_A")
    agrees(problem, "c4.2", "u - x_A")
    agrees(problem, "c5", "-sin(theta_A) (u + 2 cos(w) - x_A) + cos(theta_A) (v + 2 sin(w) - y_A)")
    agrees(problem, "c6", "w + 2 theta_A")
    agrees(problem, "c7.1", "y_A - 1/2")
    agrees(problem, "c7.2", "x_Adot + theta_Adot/2")
    assert problem.reference == dict.fromkeys(problem.coordinates, number(0))


def test_a_body_is_drawn_where_the_configuration_puts_it() -> None:
    problem = read("""
dimension: 2
bodies: [A]
configuration: {x_A: 2, theta_A: 1/3}
constraints:
- {type: link, between: [[0, 0], {on: A, at: [2, 1]}]}
- {type: cam, point: [5, 0], body: A, curve: "x^2 + 4 y^2 = 9 + t"}
""")
    # the point stands 1 above the body's origin, turned by a third
    agrees(problem, "c1", "(x_A - sin(theta_A - 1/3))^2 + (y_A + cos(theta_A - 1/3))^2 - 5")
    own = "((5 - x_A) cos(theta_A) - y_A sin(theta_A))^2 + 4 (-(5 - x_A) sin(theta_A) - y_A cos(theta_A))^2"
    agrees(problem, "c2", f"{own} - 9 - t")
    assert problem.reference == {"x_A": number(2), "y_A": number(0), "theta_A": number(Fraction(1, 3))}


def test_a_ball_rolls_with_the_spin_of_its_euler_angles() -> None:
    problem = read("parameters: {r: positive}\nbodies: [B]\nconstraints: [{type: roll, body: B, radius: r}]")
    agrees(problem, "c1.1", "z_B - r")
    # angular velocity phi' e_z + theta' (cos phi, sin phi, 0) + psi' (sin phi sin theta, -cos phi sin theta, cos theta)
    agrees(problem, "c1.2", "x_Bdot - r (theta_Bdot sin(phi_B) - psi_Bdot cos(phi_B) sin(theta_B))")
    agrees(problem, "c1.3", "y_Bdot + r (theta_Bdot cos(phi_B) + psi_Bdot sin(phi_B) sin(theta_B))")
    assert problem.reference == {}


def test_a_hinge_of_space_with_cayley_parameters_is_rational() -> None:
    problem = read(
        "bodies: [D]\nconstraints: [{type: revolute, between: [ground, D], at: [0, 0, 0], axis: [0, 0, 1]}]", "D"
    )
    assert problem.coordinates == ("x_D", "y_D", "z_D", "D_a", "D_b", "D_c")
    agrees(problem, "c1.1", "x_D")
    agrees(problem, "c1.4", "D_a")  # no turn about an axis across z
    agrees(problem, "c1.5", "D_b")
    assert problem.reference == dict.fromkeys(problem.coordinates, number(0))


def test_names_may_be_greek() -> None:
    problem = read("coordinates: [θ, x_φ]\nconstraints: [θ̇ = 2 x_phi]")
    assert (problem.coordinates, said(problem)) == (("θ", "x_φ"), {"c1": "velocity"})


MISTAKEN: dict[str, str] = {
    "an unknown key": "constrants: [x]",
    "an unknown field": "coordinates: [x]\nconstraints: [{type: equation, text: x, lenght: 2}]",
    "an undeclared name": "coordinates: [x]\nconstraints: [x = y]",
    "a name given twice": "coordinates: [x, x]",
    "a name of a velocity": "coordinates: [x, xdot]",
    "a greek twin": "coordinates: [θ, theta]",
    "a name of a differential beside a chart": "coordinates: [A_a, dA_a]",
    "a reserved name": "coordinates: [t]",
    "a generic name": "coordinates: [square_c1]\nparticles: [A, B]\nconstraints: [{type: link, between: [A, B]}]",
    "two constraints of one name": "coordinates: [x]\nconstraints: [{name: c2, type: equation, text: x}, 0 <= x < 1]",
    "finite terms and differentials": "coordinates: [x]\nconstraints: [dx + x = 0]",
    "a second derivative": "coordinates: [x]\nconstraints: [xddot = 0]",
    "a zero direction": "bodies: [A]\nconstraints: [{type: prismatic, between: [ground, A], axis: [0, 0, 0]}]",
    "an axis that may be zero": "parameters: [a]\nbodies: [A]\n"
    "constraints: [{type: prismatic, between: [ground, A], axis: [a, 0, 0]}]",
    "a place without axis": "bodies: [A]\nconstraints: [{type: revolute, between: [ground, A], at: [0, 0, 0]}]",
    "a value with a coordinate": "coordinates: [x]\nparticles: [{name: A, at: [x, 0, 0]}]",
    "not finite": "configuration: {x: .inf}",
    "no mapping": "[1, 2]",
    "deep": "[" * 1000,
    "letters for arguments": "coordinates: [x, y]\nfunctions: {h: xy}",
    "letters for texts": "coordinates: [x]\nconstraints: [{type: 'on', members: [[0, 0, 0]], curve: xy}]",
    "planar in the plane": "dimension: 2\nbodies: [A]\nconstraints: [{type: planar, between: [ground, A]}]",
}


@pytest.mark.parametrize("what", MISTAKEN)
def test_what_is_no_scene_is_an_error(what: str) -> None:
    with pytest.raises(CheckError):
        read(MISTAKEN[what])


def test_a_text_that_mentions_an_angle_refuses_the_cayley_chart() -> None:
    text = "bodies: [B]\nconstraints: [phi_B = 0]"
    assert read(text).coordinates[3:] == ("phi_B", "theta_B", "psi_B")
    with pytest.raises(CheckError):
        read(text, "B")


def test_numbers_are_exact_and_words_are_words() -> None:
    found = canonical(document_of('{name: 0.5, y: [0.5, 1e-6, 017, "0.5", "6 / 4", on, yes, ~, "~", true, -3., 2.0]}'))
    assert found == {"y": ["1/2", "1/1000000", 17, "1/2", "3/2", "on", "yes", None, None, True, -3, 2]}
    assert canonical({"a": 0.1, "b": Fraction(4, 2), "c": True}) == {"a": "1/10", "b": 2, "c": True}
    assert canonical(document_of('{"y": [0.5, 1e-6, "on"]}')) == {"y": ["1/2", "1/1000000", "on"]}
    assert canonical({"bodies": [{"name": "1.0"}]}) == {"bodies": [{"name": "1.0"}]}


def test_one_scene_has_one_hash() -> None:
    flow = "{name: a, coordinates: [x], parameters: [R], constraints: [x = R], configuration: {x: 0.5}}"
    block = """
coordinates:
- x
parameters:
  R: real
title: "T"
constraints:
- {type: equation, text: x = R}
configuration: {x: "1/2"}
"""
    assert sha256_of(document_of(flow)) == sha256_of(document_of(block))
    assert sha256_of(document_of(flow)) != sha256_of(document_of(flow.replace("0.5", "0.25")))
    assert sha256_of(document_of(flow)) != sha256_of(document_of(flow.replace("x = R", "x = 2 R")))


@pytest.mark.parametrize("path", few("readings", SCENES, 12), ids=stem)
def test_a_loaded_scene_has_the_hash_of_its_file(path: Path) -> None:
    written = document_of(path.read_text(encoding="utf-8"))
    loaded = scene_of(path).model_dump(mode="json")
    assert canonical(written) == canonical(loaded)
    assert (
        dofkit.loads(path.read_text(encoding="utf-8")).dimension
        == problem_of_canonical(canonical(loaded)).world.dimension
    )


def has_bodies_in_space(text: str) -> bool:
    """Return whether a scene's text has bodies, which are in space if nothing else is said: loading all takes long."""
    return bool(re.search(r"^bodies:", text, re.MULTILINE)) and not re.search(r"^dimension: [12]", text, re.MULTILINE)


SPATIAL = [path for path in SCENES if has_bodies_in_space(path.read_text(encoding="utf-8"))]


def euler_angles(turn: np.ndarray[Any, Any]) -> tuple[float, float, float]:
    """z-x-z angles of a rotation matrix whose axes are not in line."""
    return (
        math.atan2(turn[0, 2], -turn[1, 2]),
        math.acos(max(-1.0, min(1.0, turn[2, 2]))),
        math.atan2(turn[2, 0], turn[2, 1]),
    )


def turned_by(g: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    x, y, z = g
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * (skew + skew @ skew) / (1 + g @ g)


def turned_by_angles(phi: float, theta: float, psi: float) -> np.ndarray[Any, Any]:
    def about_z(a: float) -> np.ndarray[Any, Any]:
        return np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])

    about_x = np.array([[1, 0, 0], [0, math.cos(theta), -math.sin(theta)], [0, math.sin(theta), math.cos(theta)]])
    return about_z(phi) @ about_x @ about_z(psi)


@pytest.mark.parametrize("path", few("charts", SPATIAL, 12), ids=stem)
def test_both_charts_of_a_body_say_the_same(path: Path) -> None:
    """Constraint by constraint: zeros of the Cayley reading are zeros of the one in angles, with as many directions.

    The bodies are drawn turned, where their angles are regular.
    """
    document = dict(document_of(path.read_text(encoding="utf-8")))
    names = {body.name: body.coordinates or [f"{q}_{body.name}" for q in ROLES] for body in scene_of(path).bodies}
    turned = {q: value for own in names.values() for q, value in zip(own[3:], START, strict=True)}
    document["configuration"] = {**turned, **(document.get("configuration") or {})}
    angles = problem_of_canonical(canonical(document))
    try:
        cayley = problem_of_canonical(canonical(document), frozenset(names))
    except CheckError:
        assert path.stem in ANGLES_IN_TEXTS
        return
    for owner in dict.fromkeys(relation.owner for relation in cayley.relations):
        ours = [r.tree for r in cayley.relations if r.owner == owner and r.kind == "finite"]
        others = [r.tree for r in angles.relations if r.owner == owner and r.kind == "finite"]
        point = solved(ours, cayley, random.Random(f"{path.stem} {owner}"))
        same = {**point, **in_angles(point, names, document["configuration"])}
        assert [of_tree(tree, same) for tree in others] == pytest.approx([0.0] * len(others), abs=1e-7)
        ranks = [
            np.linalg.matrix_rank(rows_of_trees(ours, cayley.coordinates, point), tol=1e-6),
            np.linalg.matrix_rank(rows_of_trees(others, angles.coordinates, same), tol=1e-6),
        ]
        assert ranks[0] == ranks[1], owner


#: Scenes whose texts mention angles, so that these bodies have no other chart.
ANGLES_IN_TEXTS = ("rubber-ball",)
ROLES = ("x", "y", "z", "phi", "theta", "psi")
START = ("3/10", "7/5", "1/5")


def solved(trees: list[Any], problem: Problem, rng: random.Random) -> dict[str, float]:
    """A zero of the trees near a random place, parameters and generic symbols held."""
    held = {name: rng.uniform(0.5, 1.5) for name in (*problem.world.signs, *problem.world.generic)}
    for attempt in range(50):
        values = {q: rng.uniform(-0.8, 0.8) for q in problem.coordinates} | held | {"t": 0.1 * (attempt % 2)}
        for _ in range(40):
            found = np.array([of_tree(tree, values) for tree in trees])
            if np.abs(found).max(initial=0) < 1e-11:
                return values
            rows = rows_of_trees(trees, problem.coordinates, values)
            step = np.linalg.lstsq(rows, -found, rcond=1e-9)[0]
            values |= {q: values[q] + float(d) for q, d in zip(problem.coordinates, step, strict=True)}
    raise AssertionError("no zero was found")


def in_angles(point: Mapping[str, float], names: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, float]:
    """The angles of every body, at poses given by Cayley parameters."""
    found: dict[str, float] = {}
    for body, own in names.items():
        initial = [of_tree(parse(str(given[q]), KnownNames()), dict(point)) for q in own[3:]]
        g = np.array([point[f"{body}_{letter}"] for letter in "abc"])
        found |= dict(zip(own[3:], euler_angles(turned_by(g) @ turned_by_angles(*initial)), strict=True))
    return found
