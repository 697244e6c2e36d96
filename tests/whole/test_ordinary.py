"""Ordinary things, a line of hand work each: what stands beside a mechanism, and what an equation says at once."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest
from shared.known_scenes import spread, swept
from shared.trees import FREEDOMS, tree_with_loops

import dofkit

Document = Mapping[str, Any]

FOUR_BAR = [
    {"name": "A", "type": "revolute", "between": ["ground", "crank"], "at": [0, 0]},
    {"name": "B", "type": "revolute", "between": ["crank", "rod"], "at": [1, 2]},
    {"name": "C", "type": "revolute", "between": ["rod", "rocker"], "at": [5, 3]},
    {"name": "D", "type": "revolute", "between": ["rocker", "ground"], "at": [4, 0]},
]
LINKS = ["crank", "rod", "rocker"]


def told(document: Document) -> dict[str, Any]:
    report = dofkit.classify(dofkit.load(document))
    return {key: getattr(report, key) for key in ("consistent", "dof", "velocity_dof", "instantaneous_dof", "singular")}


def moves(dof: int, first_order: int | None, singular: bool | None = False) -> dict[str, Any]:
    expected = {"consistent": True, "dof": dof, "velocity_dof": dof, "instantaneous_dof": first_order}
    return {**expected, "singular": singular}


@pytest.mark.parametrize(
    ("beside", "dof"),
    [
        ({"bodies": [*LINKS, "free"]}, 1 + 3),
        ({"particles": ["P"], "bodies": LINKS}, 1 + 2),
        ({"coordinates": ["s", "w"], "bodies": LINKS}, 1 + 2),
        ({"bodies": [*LINKS, "free"], "particles": ["P"], "coordinates": ["s"]}, 1 + 3 + 2 + 1),
    ],
)
def test_what_nothing_constrains_stands_anywhere_in_the_drawing(beside: Document, dof: int) -> None:
    assert told({"dimension": 2, "constraints": FOUR_BAR, **beside}) == moves(dof, dof)


def test_what_is_constrained_and_not_drawn_is_named() -> None:
    table = {"type": "equation", "text": "y_P = 1"}
    scene = {"dimension": 2, "bodies": LINKS, "particles": ["P"], "constraints": [*FOUR_BAR, table]}
    report = dofkit.classify(dofkit.load(scene))
    assert (report.dof, report.instantaneous_dof) == (2, None)
    assert "There is no reference configuration: the position of P is not given." in report.warnings


def test_a_configuration_of_some_coordinates_is_not_ignored_in_silence() -> None:
    scene = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1"], "configuration": {"x": 1}}
    report = dofkit.classify(scene)
    assert report.singular is None
    assert "There is no reference configuration: the position of y is not given." in report.warnings


def test_nothing_drawn_is_no_reference() -> None:
    assert told({"coordinates": ["x", "y"], "constraints": ["x = 1"]}) == moves(1, None, None)
    assert told({"coordinates": ["x", "y"]}) == moves(2, None, None)


def arm(*more: str) -> dict[str, Any]:
    """A mobile manipulator whose gripper is welded to the world: 4 sliders, 9 hinges and 2 fingers are 15 freedoms,
    less the 6 of the weld (three slides and three directions of axes in the chain to the gripper)."""
    chain: list[tuple[str, Sequence[float]]] = [
        ("shoulder_pan", (0.1195, 0.3486)), ("shoulder_lift", (0.117, 0.06)), ("upper_arm", (0.219, 0)),
        ("elbow", (0.133, 0)), ("forearm", (0.197, 0)), ("wrist_flex", (0.1245, 0)), ("wrist_roll", (0.1385, 0)),
    ]  # fmt: skip
    axes = [[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]]
    slides = ["ground", "base_x", "base_y", "base", "torso"]
    ways = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1]]
    joints: list[dict[str, Any]] = [
        {"type": "prismatic", "between": list(pair), "axis": axis}
        for pair, axis in zip(pairwise(slides), ways, strict=True)
    ]
    joints += [
        {"type": "revolute", "between": ["torso", "head_pan"], "at": [0.3711, 0.48, 0.9804], "axis": [0, 0, 1]},
        {"type": "revolute", "between": ["head_pan", "head_tilt"], "at": [0.5136, 0.48, 1.0384], "axis": [0, 1, 0]},
    ]
    x, z, before = 0.318, 0.3774, "torso"
    for (name, (dx, dz)), axis in zip(chain, axes, strict=True):
        x, z = round(x + dx, 6), round(z + dz, 6)
        joints.append({"type": "revolute", "between": [before, name], "at": [x, 0.48, z], "axis": axis})
        before = name
    joints += [{"type": "prismatic", "between": [before, f], "axis": [0, 1, 0]} for f in ("left", "right")]
    joints.append({"type": "weld", "between": ["ground", before]})
    bodies = [*slides[1:], "head_pan", "head_tilt", *(name for name, _ in chain), "left", "right", *more]
    return {"bodies": bodies, "constraints": joints}


@pytest.mark.sweep
def test_pick_and_place() -> None:
    assert told(arm()) == moves(9, 9)
    assert told(arm("block")) == moves(15, 15)
    lying = arm("block")
    lying["constraints"].append({"type": "equation", "text": "z_block = 1/2"})
    assert told(lying) == moves(14, None, None)


ISOLATED = [
    ("x y", ["y^2 = x^3", "y = 0"], 0, "x^3 = 0"),
    ("x y", ["exp(x) = 1 + x"], 1, "the exponential is convex and touches its tangent at 0 only"),
    ("x y", ["x = sin(x)"], 1, "abs(sin(x)) < abs(x) but at 0"),
    ("x y z", ["x = sin(x)", "y = x + z"], 1, "x = 0 and y = z"),
    ("x y", ["exp(x) = 1 + x", "exp(y) = 1 + y"], 0, "the origin"),
    ("x y", ["exp(x) = 1 + x", "exp(x) + x = 1 + y"], 0, "x = 0 and then y = 0"),
    ("x y", ["cos(x) = 1 - x^2/2", "y = x"], 0, "cos(x) >= 1 - x^2/2, and equal at 0 only"),
    ("x y", ["exp(x - 1/3) = x + 2/3"], 1, "the tangent at 1/3"),
    ("x y", ["cos(x - pi/4) = 1 + (x - pi/4)^2"], 1, "1 at most, and 1 at least"),
    ("x y z", ["x^2 = y^3", "x = z", "z = 0"], 0, "y^3 = 0"),
    ("x y", ["x = tan(x)"], 1, "0, and a value between any two poles"),
    ("x y", ["x = tan(x)", "y = x + 1"], 0, "the same, and y"),
    ("x y", ["sin(x)/x = 0", "x + y = 1"], 0, "multiples of pi but 0"),
]


@pytest.mark.parametrize(
    ("names", "written", "dof", "why"), spread(ISOLATED, 2, several=True), ids=[w for *_, w in ISOLATED]
)
def test_functions_of_one_coordinate_hold_it_where_they_vanish(
    names: str, written: Sequence[str], dof: int, why: str
) -> None:
    report = dofkit.classify(dofkit.load({"coordinates": names.split(), "constraints": list(written)}))
    answer = (report.consistent, report.dof, report.velocity_dof, report.redundant)  # where it touches 0, None is right
    assert answer in ((True, dof, dof, []), *[(None,) * 4] * any("(" in text for text in written)), why


@pytest.mark.parametrize(
    "written",
    [
        swept(["x = sin(x)", "y = log(x)"]),
        ["exp(x) = 1 + x", "x = 1"],
        ["exp(x) = x"],
        ["x^2 + exp(x) = 1 + x", "x y = 1"],
    ],
)
def test_what_holds_nowhere_is_not_told_to_hold(written: Sequence[str]) -> None:
    report = dofkit.classify(dofkit.load({"coordinates": ["x", "y"], "constraints": list(written)}))
    assert report.consistent is not True


#: Pairs of forms, or forms that vanish together, told as one relation.
RATES = [
    ("x y", "abs(xdot) = abs(ydot)", (1, 1, True), "xdot = ydot or xdot = -ydot, whole lines"),
    ("x y z", "abs(xdot) = abs(ydot + zdot)", (2, 2, True), "two planes"),
    ("x y z", "abs(xdot) = abs(ydot - x zdot)", (3, 2, False), "dx = +-(dy - x dz) are contact forms"),
    ("x y", "abs(xdot - 1) = abs(ydot)", (1, 1, True), "y = +-(x - t) + C"),
    ("x y z", "xdot^2 - 2 cos(z) xdot ydot + ydot^2 = 0", (1, 1, True), "(dx - cos(z) dy)^2 + sin(z)^2 dy^2 = 0"),
    ("x y z", "xdot^2 - 2 cosh(z) xdot ydot + ydot^2 = 0", (3, 2, False), "dx = exp(+-z) dy"),
]


@pytest.mark.parametrize(("names", "text", "expected", "why"), RATES, ids=[text for _, text, *_ in RATES])
def test_relations_between_velocities_that_are_forms(
    names: str, text: str, expected: tuple[int, int, bool], why: str
) -> None:
    report = dofkit.classify(dofkit.load({"coordinates": names.split(), "constraints": [text]}))
    (entry,) = report.constraints
    if "abs" in text and report.dof is None:
        assert entry.holonomic in (expected[2], None), why
        return
    assert (report.dof, report.velocity_dof, entry.holonomic) == expected, why
    assert entry.form == "pfaffian"


@pytest.mark.parametrize("text", ["abs(xdot) = ydot", "x abs(xdot) = abs(ydot)", "abs(xdot) = xdot"])
def test_half_lines_of_velocities_are_no_lines(text: str) -> None:
    report = dofkit.classify(dofkit.load({"coordinates": ["x", "y"], "constraints": [text]}))
    assert report.constraints[0].holonomic is not True


@pytest.mark.parametrize("seed", spread(range(6)))
def test_an_open_tree_has_the_freedom_of_its_joints(seed: int) -> None:
    scene, dof = tree_with_loops(12, 0, seed)
    report = dofkit.classify(dofkit.load(scene))
    assert told(scene) == moves(dof, dof)
    assert (report.verdicts["dof"].verdict, report.redundant, report.redundancies) == ("proved", [], [])
    assert len(report.generalized_coordinates or []) == dof
    for joint, entry in zip(scene["constraints"], report.constraints, strict=True):
        assert entry.equations == entry.independent == 6 - FREEDOMS[joint["type"]]
        assert (entry.form, entry.holonomic, entry.scleronomic, entry.circuit) == ("finite", True, True, None)


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("bodies", "loops", "seed"), [(8, 2, 0), (12, 3, 1), pytest.param(43, 10, 2, marks=pytest.mark.sweep)]
)
def test_loops_on_one_tree_are_each_looked_at_with_their_own_joints(bodies: int, loops: int, seed: int) -> None:
    scene, dof = tree_with_loops(bodies, loops, seed)
    report = dofkit.classify(dofkit.load(scene))
    assert told(scene) == moves(dof, dof)
    assert report.redundant_equations == 3 * loops
    assert sorted(group.nullity for group in report.redundancies) == [3] * loops
    assert {len(group.members) for group in report.redundancies} == {4}


def governor(*more: str, upper: str = "a", lower: str = "a", pivot: Sequence[int] = (0, 0, 0)) -> dict[str, Any]:
    """Landau and Lifshitz, Mechanics, section 5: two masses and a collar on the axis, joined by links."""
    ends = [("O", "A", upper), ("O", "B", upper), ("A", "M", lower), ("B", "M", lower)]
    links = [{"type": "link", "between": [[*pivot] if p == "O" else p, q], "length": a} for p, q, a in ends]
    axis = {"type": "on", "members": ["M"], "curve": [f"x = {pivot[0]}", f"y = {pivot[1]}"]}
    named = {name: "positive" for name in (upper, lower) if name.isalpha()}
    return {"particles": ["A", "B", "M"], "parameters": named, "constraints": [*links, axis, *more]}


def test_the_governor_without_a_drawing() -> None:
    """z_M (z_M - 2 z_A) = 0 by l1 - l3: with the collar at the pivot each mass has a sphere to itself, 4 freedoms; else
    the height and two angles, 3."""
    assert told(governor()) == moves(4, None, None)
    # In one rotating plane, x = 0: at the pivot two circles, else the height alone.
    assert told(governor("x_A = 0", "x_B = 0")) == moves(2, None, None)
    # Where the collar is not at the pivot the larger part is left out.
    assert told(governor("z_M = a")) == moves(2, None, None)


@pytest.mark.parametrize(
    ("order", "length", "pivot"), [swept([4, 2, 0, 3, 1], "a", (1, 2, 3)), ([3, 2, 1, 0, 4], "3/2", (0, 0, 0))]
)
def test_the_governor_elsewhere_of_any_size_and_in_any_order(
    order: list[int], length: str, pivot: Sequence[int]
) -> None:
    scene = governor(upper=length, lower=length, pivot=pivot)
    constraints = scene["constraints"]
    assert told({**scene, "constraints": [constraints[k] for k in order]}) == moves(4, None, None)


def test_the_governor_whose_arms_have_two_lengths() -> None:
    """z_M^2 - 2 z_A z_M = b^2 - a^2 keeps the collar from the pivot: its height and two angles."""
    assert told(governor(upper="a", lower="b")) == moves(3, None, None)


#: Columns of a rotation with rational entries.
TURN = [[Fraction(n, 3) for n in row] for row in ([2, -1, 2], [2, 2, -1], [-1, 2, 2])]


def vertex(creases: Sequence[tuple[int, int]], turned: bool, shift: Sequence[int], order: int | None) -> Document:
    """Panels around a point, flat, with creases in these directions: turned in space, moved, in any order."""
    names = ["ground", *(f"panel{k}" for k in range(1, len(creases)))]
    joints = []
    for k, (x, y) in enumerate(creases):
        axis = [row[0] * x + row[1] * y for row in TURN] if turned else [Fraction(x), Fraction(y), Fraction(0)]
        place = [str((k + 1) * v + s) for v, s in zip(axis, shift, strict=True)]
        between = [names[k], names[(k + 1) % len(names)]]
        joints.append({"type": "revolute", "between": between, "at": place, "axis": [str(v) for v in axis]})
    if order is not None:
        random.Random(order).shuffle(joints)
    return {"bodies": names[1:], "constraints": joints}


FIVE = [(1, 0), (3, 4), (-5, 12), (-4, -3), (5, -12)]
#: Creases of a flat vertex: of n of them n - 2 velocities, and n - 3 motions.
VERTICES = [FIVE, [(1, 0), (3, 4), (-3, 4), (-5, -12), (5, -12)], [*FIVE[:4], (-1, -7), FIVE[4]]]


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("turned", "shift", "order"), [(False, (0, 0, 0), None), (True, (7, -3, 2), 1), (False, (70, -30, 20), 2)]
)
@pytest.mark.parametrize("creases", VERTICES)
def test_flat_vertices_of_creases_moved_and_shuffled(
    creases: list[tuple[int, int]], turned: bool, shift: Sequence[int], order: int | None
) -> None:
    """The fold angles close a loop of turns by 3 conditions; flat, one of them is of the second order.

    A crease that closes the loop has 5 equations, of which the ways of two of them, in and out of the plane, are left.
    """
    n = len(creases)
    scene = vertex(creases, turned, shift, order)
    report = dofkit.classify(dofkit.load(scene))
    assert (report.dof, report.instantaneous_dof, report.singular) == (n - 3, n - 2, True)
    assert (report.redundant_equations, report.redundant) == (3, [])
    assert [e.independent for e in report.constraints] == [5] * (n - 1) + [2]
    assert report.verdict == "numeric"


@pytest.mark.parametrize(
    ("names", "written", "dof", "why"),
    [
        ("x y", "exp(x - y) = 1 + x - y", 1, "x = y"),
        ("x y", "x - y = sin(x - y)", 1, "x = y"),
        ("x y", "exp(2 x - y + 1) = 2 x - y + 2", 1, "y = 2 x + 1"),
        swept("x y z", "x - 2 y + z = sin(x - 2 y + z)", 2, "a plane"),
        ("x y z w", "xdot^2 - 2 cos(z - w) xdot ydot + ydot^2 = 0", 2, "x and y are constant: z and w are free"),
        ("x y z", "xdot^2 - 2 cos(z - t) xdot ydot + ydot^2 = 0", 1, "z is free"),
    ],
)
def test_coordinates_that_occur_in_one_sum_only(names: str, written: str, dof: int, why: str) -> None:
    report = dofkit.classify(dofkit.load({"coordinates": names.split(), "constraints": [written]}))
    assert report.consistent is not False, why
    assert report.dof in (dof, None), why
    assert report.holonomic in (True, None), why


@pytest.mark.parametrize("more", [[], ["dx_b/dt = v"]])
def test_what_is_not_drawn_where_it_stands_is_not_told_of_the_drawing(more: list[str]) -> None:
    """A ladder along the floor, whose end is not on the wall where it is drawn."""
    ends = ([0, 0], "y = 0"), ([2, 0], "x = 0")
    walls = [{"type": "on", "members": [{"on": "b", "at": at}], "curve": [line]} for at, line in ends]
    report = dofkit.classify({"dimension": 2, "bodies": ["b"], "parameters": ["v"], "constraints": [*walls, *more]})
    assert (report.dof, report.consistent, report.instantaneous_dof) == (1 - len(more), True, None)
    assert "reference" not in {told.about for told in report.verdicts.values()}
    assert any("reference configuration does not satisfy" in warning for warning in report.warnings)
