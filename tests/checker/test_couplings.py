"""Couplings as the checker reads them, by hand; a type that it does not know."""

from __future__ import annotations

import pytest
from checker.certified import certificate
from checker.test_problem import agrees, read
from checker.values import of_tree

from dofkit.checker import CheckError, verify

ARM = """
dimension: 2
bodies: [A, B, C]
parameters: {R: positive}
constraints:
- {name: shoulder, type: revolute, between: [ground, A], at: [0, 0]}
- {name: elbow, type: revolute, between: [A, B], at: [1, 0]}
- {name: rail, type: prismatic, between: [ground, C], axis: [3, 4]}
"""
SLEEVE = """
bodies: [A]
constraints:
- {name: sleeve, type: cylindrical, between: [ground, A], at: [0, 0, 0], axis: [0, 0, 2]}
"""


def test_couplings_of_the_plane_count_from_the_drawing() -> None:
    problem = read(
        ARM
        + """
- {name: belt, type: coupling, joints: [shoulder, elbow], text: elbow = 2 shoulder}
- {name: rack, type: coupling, joints: {q: shoulder, s: rail}, text: "s = R q + t^2"}
- {name: stop, type: coupling, joints: [elbow], text: "-1 <= elbow <= 2"}
"""
    )
    agrees(problem, "belt", "theta_B - 3 theta_A")
    agrees(problem, "rack", "(3 x_C + 4 y_C)/5 - R theta_A - t^2")
    assert [(one.kind, one.strict) for one in problem.relations if one.owner == "stop"] == [("inequality", False)] * 2
    agrees(problem, "stop.1", "theta_B - theta_A + 1")
    agrees(problem, "stop.2", "2 - theta_B + theta_A")


def test_a_coupling_of_space_tells_angle_and_displacement() -> None:
    """A turns by psi_A about z where phi_A and theta_A rest, which is read at such places."""
    text = "\n- {name: k, type: coupling, joints: {q: sleeve.angle, s: sleeve.displacement}, text: s = q/3}"
    (left,) = (one.tree for one in read(SLEEVE + text).relations if one.name == "k")
    values = dict.fromkeys(("x_A", "y_A", "phi_A", "theta_A"), 0.0) | {"z_A": 0.7, "psi_A": 0.6}
    assert of_tree(left, values) == pytest.approx(0.7 - 0.6 / 3)


@pytest.mark.parametrize(
    "fields",
    [
        "joints: [sleeve], text: sleeve = 0",
        "joints: {q: sleeve.speed}, text: q = 0",
        "joints: {q: nothing.angle}, text: q = 0",
        "joints: {q: sleeve.angle}, text: q = w",
    ],
)
def test_a_coupling_that_is_unclear_is_an_error(fields: str) -> None:
    with pytest.raises(CheckError):
        read(SLEEVE + f"\n- {{type: coupling, {fields}}}")


def test_a_type_that_is_not_known_is_refused() -> None:
    """What it says is not known: nothing of the scene is verified."""
    document = {"coordinates": ["x"], "constraints": [{"name": "odd", "type": "revolut"}, "x = 0"]}
    with pytest.raises(CheckError, match="revolut"):
        verify(document, certificate(document, []))
