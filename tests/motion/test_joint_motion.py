"""Equations of motion of trees in space, in the angles and displacements of their joints, against MuJoCo's own."""

from __future__ import annotations

import math
import random
import re
from fractions import Fraction
from typing import Any

import pytest
from shared.known_scenes import swept

import dofkit
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.text import parse_expression
from dofkit.expressions.text.names import Names
from dofkit.motion.lagrange.model import NoEquationsError
from dofkit.scene.reading import SceneFile

MASS = {"mass": 2, "inertia": [1, 1, 1]}
Y = [0, 1, 0]
SHOULDER = {"name": "shoulder", "type": "revolute", "between": ["ground", "a"], "at": [0, 0, 0], "axis": Y}
SLEEVE = {"name": "sleeve", "type": "prismatic", "between": ["b", "a"], "axis": [0, 0, 2]}
BODIES = [{"name": "a", **MASS}, {"name": "b", **MASS}]
DOWN = [{"type": "gravity", "acceleration": 10}]


def scene(*constraints: Any, **more: Any) -> dict[str, Any]:
    return {"bodies": BODIES, "constraints": [*constraints], "forces": DOWN, "configuration": {"z_b": 1}, **more}


def test_a_hinge_and_a_sleeve_by_hand() -> None:
    """a turns about its centre by p; b, 1 above, slides along a's z. The sleeve tells of a against b: b is at 1 - s.

    T = (1 + 1 + 2 (1 - s)^2)/2 pdot^2 + sdot^2, V = 20 (1 - s) cos p.
    """
    report = dofkit.lagrange(scene(SHOULDER, SLEEVE))
    assert report.coordinates == ["shoulder_angle", "sleeve_displacement"]
    assert any("shoulder_angle is shoulder.angle" in note for note in report.notes)
    p, s, pd, sd, pdd, sdd = 0.3, 0.2, 0.5, -0.7, 1.1, -1.3
    told = [value(e, report.coordinates, (p, s), (pd, sd), (pdd, sdd)) for e in report.equations]
    r = 1 - s
    by_hand = [
        (2 + 2 * r * r) * pdd - 4 * r * sd * pd - 20 * r * math.sin(p),
        2 * sdd + 2 * r * pd * pd - 20 * math.cos(p),
    ]
    assert told == pytest.approx(by_hand)
    assert report.verdict == "proved"


def value(equation: str | ex.Expr, names: list[str], *states: tuple[float, ...]) -> float:
    """The left side where coordinates, velocities and accelerations have these values."""
    kinds: tuple[ex.Kind, ...] = ("coordinate", "velocity", "acceleration")
    known = {
        ex.sym(kind, name): ex.num(Fraction(one))
        for kind, state in zip(kinds, states, strict=True)
        for name, one in zip(names, state, strict=True)
    }
    left = equation
    if isinstance(left, str):
        left = parse_expression(left.removesuffix(" = 0"), Names(frozenset(names), allow_accelerations=True))
    found = approximate(substitute(left, known))
    assert found is not None
    return found


def test_what_is_coupled_has_one_equation() -> None:
    elbow = {**SHOULDER, "name": "elbow", "between": ["a", "b"], "at": [0, 0, 1]}
    coupling = {"type": "coupling", "joints": {"u": "elbow", "v": "shoulder.angle"}, "text": "u = 2 v"}
    bound = {"type": "coupling", "joints": ["elbow"], "text": "elbow <= 1"}
    report = dofkit.lagrange(scene(SHOULDER, elbow, coupling, bound))
    assert len(report.equations) == 1
    assert report.eliminated == {"elbow_angle": "2*shoulder_angle"}
    assert report.multipliers == []


NOT_BY_JOINTS: dict[str, dict[str, Any]] = {
    "one body": {"bodies": BODIES[:1], "configuration": {"theta_a": "pi/2"},
                 "constraints": [{"type": "spherical", "between": ["ground", "a"], "at": [0, 0, 1]}]},
    "a spring": {**scene(SHOULDER), "forces": [
        {"type": "spring", "between": [[0, 0, 1], {"on": "a", "at": [0, 0, 0]}], "stiffness": 1, "rest_length": 0}]},
    "what floats": scene({"type": "weld", "between": ["a", "b"]}),
    "a screw": scene(SHOULDER, {"type": "screw", "between": ["a", "b"], "at": [0, 0, 0], "axis": Y, "pitch": 1}),
}  # fmt: skip


@pytest.mark.parametrize("name", NOT_BY_JOINTS)
def test_other_scenes_keep_their_own_coordinates(name: str) -> None:
    from dofkit.motion.lagrange.equations import read
    from dofkit.motion.lagrange.joint_motion import joint_motion

    source = read(dofkit.load(NOT_BY_JOINTS[name]))
    assert joint_motion(source.scene, source.drawing, source.system) is None


def test_a_tree_that_is_too_large_says_so_at_once() -> None:
    bodies = [{"name": f"b{k}", **MASS} for k in range(12)]
    axes = ([1, 0, 0], [0, 1, 0], [0, 0, 1])
    joints = [
        {"type": "revolute", "between": [f"b{k - 1}" if k else "ground", f"b{k}"], "at": [k, 1, 0], "axis": axes[k % 3]}
        for k in range(12)
    ]
    with pytest.raises(NoEquationsError, match=r"of 12 joints the Lagrangian has .* weld some of the joints"):
        dofkit.lagrange({"bodies": bodies, "constraints": joints, "forces": DOWN})


def chain(n: int, seed: int) -> str:
    """Bodies one in another, each on a hinge or a slide whose axis and place are anyhow."""
    rng = random.Random(seed)
    parts = []
    for k in range(n):
        kind, axis = rng.choice(["hinge", "slide"]), rng.choice(["1 0 0", "0 1 0", "0 0 1", "0 0.6 0.8"])
        parts.append(
            f"<body name='b{k}' pos='{k} 0 0.5'><joint name='j{k}' type='{kind}' axis='{axis}' pos='0 0.25 0'/>"
            f"<inertial pos='0.5 0 0.25' mass='{1 + k}' diaginertia='0.5 0.25 0.5'/>"
        )
    inner = "".join(parts) + "</body>" * n
    return f"<mujoco><option gravity='0 0 -9.81'/><worldbody>{inner}</worldbody></mujoco>"


@pytest.mark.parametrize(("n", "seed"), [(2, 1), *(swept(n, seed) for n in (2, 3) for seed in range(2, 6))])
def test_equations_are_those_of_mujocos_inverse_dynamics(n: int, seed: int) -> None:
    import mujoco

    library: Any = mujoco
    text = chain(n, seed)
    report = dofkit.lagrange(SceneFile.read(text, "m").scene())
    names = [re.sub(r"_(angle|displacement)$", "", name) for name in report.coordinates]
    assert names == [f"j{k}" for k in range(n)]
    model = library.MjModel.from_xml_string(text)
    data, rng = library.MjData(model), random.Random(f"state {seed}")
    states = [tuple(rng.uniform(-1, 1) for _ in range(n)) for _ in range(3)]
    data.qpos[:], data.qvel[:], data.qacc[:] = states
    library.mj_inverse(model, data)
    derived = report._derived
    assert derived is not None
    told = [value(e, report.coordinates, *states) for e in derived.equations.values()]
    assert told == pytest.approx(list(data.qfrc_inverse), rel=1e-6, abs=1e-6)
