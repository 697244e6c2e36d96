"""Couplings of joints: their equations by hand, what they leave free, and what is wrong with one."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit
from dofkit.base.errors import SceneError
from dofkit.expressions.text import to_text
from dofkit.scene.lowering import lower

Z = [0, 0, 1]


def arm(*couplings: Any, dimension: int = 3, **more: Any) -> dict[str, Any]:
    """Two arms, one after the other, that turn about parallel axes; and a carriage on a rail."""
    turning = {"type": "revolute", **({"axis": Z} if dimension == 3 else {})}
    return {
        "dimension": dimension,
        "bodies": ["a", "b", "c"],
        "constraints": [
            {"name": "shoulder", "between": ["ground", "a"], "at": [0, 0, 0][:dimension], **turning},
            {"name": "elbow", "between": ["a", "b"], "at": [1, 0, 0][:dimension], **turning},
            {"name": "rail", "type": "prismatic", "between": ["ground", "c"], "axis": [3, 4, 0][:dimension]},
            *({"type": "coupling", **c} for c in couplings),
        ],
        **more,
    }


def texts(scene: dict[str, Any], index: int = 3) -> list[str]:
    return [f"{to_text(r.expr)} {r.sense} 0" for r in lower(dofkit.load(scene)).constraints[index].relations]


def test_planar_equations_by_hand() -> None:
    two = {"joints": ["shoulder", "elbow"], "text": "elbow = 2 shoulder"}
    assert texts(arm(two, dimension=2)) == ["theta_b - 3*theta_a = 0"]
    pinion = {"joints": {"q": "shoulder", "s": "rail"}, "text": "s = R q"}
    (text,) = texts(arm(pinion, dimension=2, parameters={"R": "positive"}))
    assert text == "3*x_c/5 + 4*y_c/5 - R*theta_a = 0"
    bounds = {"joints": ["elbow"], "text": "-1 <= elbow <= 2"}
    assert texts(arm(bounds, dimension=2)) == ["theta_b - theta_a + 1 >= 0", "2 - theta_b + theta_a >= 0"]


def test_angles_of_space_in_whole_ratios_have_no_arcs() -> None:
    """For the first arm s = 1 and v.n = psi_a; Im (1 - i psi_a)^2 (1 + i h) = 0 with h of the second against it."""
    two = {"joints": ["shoulder"], "text": "3 shoulder = 0"}
    assert texts(arm(two)) == ["psi_a = 0"]
    (text,) = texts(arm({"joints": ["shoulder", "elbow"], "text": "elbow = 2 shoulder"}))
    assert "atan" not in text
    (text,) = texts(arm({"joints": ["shoulder", "elbow"], "text": "elbow = 0.137 shoulder"}))
    assert "atan" in text


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("text", ["elbow = 2 shoulder", "elbow = 0.137 shoulder", "elbow = shoulder^2 + shoulder"])
def test_a_coupling_takes_one_freedom(dimension: int, text: str) -> None:
    report = dofkit.classify(arm({"name": "k", "joints": ["shoulder", "elbow"], "text": text}, dimension=dimension))
    assert (report.dof, report.velocity_dof, report.instantaneous_dof, report.singular) == (2, 2, 2, False)
    entry = report.constraints[3]
    assert (entry.holonomic, entry.scleronomic, entry.equations, entry.independent) == (True, True, 1, 1)
    assert report.verdict == "proved"


def test_a_multiple_of_a_coupling_is_redundant_and_another_ratio_locks() -> None:
    one = {"name": "one", "joints": ["shoulder", "elbow"], "text": "elbow = 2 shoulder"}
    again = {"name": "again", "joints": ["shoulder", "elbow"], "text": "3 elbow = 6 shoulder"}
    report = dofkit.classify(arm(one, again))
    assert (report.dof, report.redundant) == (2, ["again"])
    other = {"name": "other", "joints": ["shoulder", "elbow"], "text": "elbow = 3 shoulder"}
    report = dofkit.classify(arm(one, other))
    assert (report.dof, report.redundant) == (1, [])


def test_a_differential_couples_three_joints() -> None:
    sum_of_two = {"joints": {"p": "shoulder", "q": "elbow", "s": "rail"}, "text": "s = (p + q)/2"}
    assert dofkit.classify(arm(sum_of_two)).dof == 2


def test_a_coupling_that_is_driven_is_rheonomic() -> None:
    report = dofkit.classify(arm({"joints": ["shoulder", "elbow"], "text": "elbow + shoulder = sin(t)"}, dimension=2))
    assert report.constraints[3].scleronomic is False
    assert report.dof == 2


def test_a_sleeve_tells_which_of_its_two_is_meant() -> None:
    sleeve = {"name": "sleeve", "type": "cylindrical", "between": ["ground", "a"], "at": [1, 2, 3], "axis": [0, 0, 2]}
    thread = {"type": "coupling", "joints": {"q": "sleeve.angle", "s": "sleeve.displacement"}, "text": "s = q/3"}
    assert dofkit.classify({"bodies": ["a"], "constraints": [sleeve, thread]}).dof == 1


FAULTS = {
    "there is no joint 'elbo'": {"joints": ["elbo"], "text": "elbo = 0"},
    "is not an angle or a displacement": {"joints": {"q": "ball"}, "text": "q = 0"},
    "contradicts the relation by 0.5": {"joints": ["elbow"], "text": "elbow = 1/2"},
    "`shoulder` is not declared": {"joints": ["elbow"], "text": "elbow = shoulder"},
    "one equation or bounds": {"joints": ["elbow"], "text": "0 = elbow <= 1"},
    "has no value or no derivative in the reference configuration": {"joints": ["elbow"], "text": "1/elbow = 1"},
}


@pytest.mark.parametrize("message", FAULTS)
def test_faults(message: str) -> None:
    scene = arm(FAULTS[message])
    scene["constraints"].append({"name": "ball", "type": "spherical", "between": ["b", "c"], "at": [2, 0, 0]})
    with pytest.raises(SceneError) as raised:
        dofkit.load(scene)
    told = [f"{fault.message}; {fault.hint}" for fault in raised.value.faults]
    assert any(message in one for one in told), told


def test_a_joint_in_general_position_tells_no_angle() -> None:
    loose = {"name": "loose", "type": "revolute", "between": ["ground", "a"]}
    with pytest.raises(SceneError, match="general position"):
        dofkit.load(
            {"bodies": ["a"], "constraints": [loose, {"type": "coupling", "joints": ["loose"], "text": "loose = 0"}]}
        )


SPATIAL = {"name": "A", "type": "revolute", "between": ["ground", "a"], "at": [0, 0, 0], "axis": [0, 0, 1]}


def bounded(text: str, dimension: int = 3) -> dict[str, Any]:
    """A hinge whose angle p is bounded."""
    hinge = SPATIAL if dimension == 3 else {**SPATIAL, "at": [0, 0]}
    own = {key: part for key, part in hinge.items() if dimension == 3 or key != "axis"}
    coupling = {"type": "coupling", "joints": {"p": "A"}, "text": text}
    return {"dimension": dimension, "bodies": ["a"], "constraints": [own, coupling]}


@pytest.mark.parametrize("text", ["3.5 <= p <= 5", "3 <= p <= 4", "-4.1 <= p <= 2.1", "p >= 3.5"])
def test_bounds_beyond_half_a_turn_of_a_hinge_in_space_are_a_fault(text: str) -> None:
    """The hinge does turn there, by a bit over half a turn; an angle that is told between -pi and pi never does."""
    with pytest.raises(SceneError, match="between -pi and pi"):
        dofkit.load(bounded(text)) and dofkit.classify(bounded(text))
    assert dofkit.classify(bounded(text, 2)).feasible is True


@pytest.mark.parametrize("text", ["-3 <= p <= 3", "-7 <= p <= 7", "p <= 4", "-1 <= p"])
def test_bounds_within_half_a_turn_or_of_every_angle_are_read(text: str) -> None:
    report = dofkit.classify(bounded(text))
    assert report.consistent is True
    assert report.dof == 1


def turned_together(text: str) -> dict[str, Any]:
    """Two hinges, one after the other, and what is said of their angles p and q."""
    hinges = [SPATIAL, {**SPATIAL, "name": "B", "between": ["a", "b"]}]
    bound = {"type": "coupling", "joints": {"p": "A", "q": "B"}, "text": text}
    return {"bodies": ["a", "b"], "constraints": [*hinges, bound]}


def test_a_sum_of_angles_of_space_beyond_all_they_are_told_to_is_a_fault() -> None:
    """Two hinges turn by 7/2 each: more than they are told."""
    with pytest.raises(SceneError, match="between -pi and pi"):
        dofkit.classify(turned_together("p + q >= 7"))


@pytest.mark.sweep
def test_a_sum_of_angles_of_space_that_they_are_told_to_is_possible() -> None:
    """Two hinges turn by 3 each."""
    assert dofkit.classify(turned_together("p + q >= 6")).consistent is True
