"""Polyhedra of velocities that are joined in motion: what bends integrates no more than what the linear forms leave.

By hand: from rest at the origin |xdot| + |ydot| = zdot reaches every z >= |x| + |y|, so that no relation f(x, y, z) = 0
holds on all motions: 3 freedoms, and 2 velocities, a cone over a square.
"""

from __future__ import annotations

import pytest
from shared.known_scenes import swept

import dofkit
from dofkit.report import Report

#: Coordinates, constraints, freedoms, velocities, labels.
JOINED = [
    ("x y z", ["abs(xdot) + abs(ydot) = abs(zdot)"], (3, 2), [False]),
    ("x y", ["abs(xdot) = abs(ydot) + 1"], (2, 1), [False]),
    ("x y", ["abs(xdot) + abs(ydot) = 1"], (2, 1), [False]),
    swept("x y z", ["abs(xdot) - abs(ydot) = zdot"], (3, 2), [False]),
    swept("x y z", ["abs(abs(xdot) - ydot) = zdot"], (3, 2), [False]),
    ("x y", ["abs(dx) + abs(dy) = dt"], (2, 1), [False]),
    # a parabola on each side, which bends by itself
    ("x y", ["ydot = xdot*abs(xdot)"], (2, 1), [False]),
    swept("x y z", ["abs(xdot)*ydot = zdot^2"], (3, 2), [False]),
    # y - z stays; beside it two of the square's sides are joined
    ("x y z", ["ydot = zdot", "abs(xdot) + abs(zdot) = 1"], (2, 1), [True, False]),
    # dy = x dz does not integrate, and the square leaves it all of its two directions
    ("x y z", ["ydot = x*zdot", "abs(xdot) + abs(zdot) = 1"], (3, 1), [False, False]),
    # two at once: a smaller square over each point of a square
    swept(
        "x y z w",
        ["abs(xdot) + abs(ydot) = 1", "abs(zdot) + abs(wdot) = abs(xdot)"],
        (4, 2),
        [False, False],
    ),
]


def report_of(names: str, constraints: list[str], at: dict[str, object] | None = None) -> Report:
    scene: dict[str, object] = {"coordinates": names.split(), "constraints": constraints}
    return dofkit.classify(scene | ({} if at is None else {"configuration": at}))


@pytest.mark.parametrize(("names", "constraints", "numbers", "labels"), JOINED)
def test_pieces_that_are_joined_in_motion(
    names: str, constraints: list[str], numbers: tuple[int, int], labels: list[bool]
) -> None:
    report = report_of(names, constraints)
    assert (report.consistent, report.verdict) == (True, "proved")
    assert (report.dof, report.velocity_dof) == numbers
    assert [entry.holonomic for entry in report.constraints] == labels


def test_the_second_of_two_alike_is_redundant() -> None:
    assert report_of("x y", ["abs(xdot) + abs(ydot) = 1"] * 2).redundant == ["c2"]


@pytest.mark.parametrize(
    ("names", "constraints"),
    [
        # zdot - xdot = 1 where both are > 0: the pieces bend together, in a plane, and say something linear
        pytest.param("x y z", ["abs(xdot) = abs(ydot) + 1", "abs(zdot) = abs(ydot) + 2"], id="in one plane"),
        pytest.param("x y", ["abs(xdot) + xdot = abs(ydot) + ydot"], id="a quarter, and a half-line"),
        pytest.param("x y", ["xdot*abs(ydot) = ydot*abs(xdot)"], id="two quarters"),
        pytest.param("x y z", ["abs(xdot)*ydot = xdot*zdot"], id="planes, each whole or half"),
    ],
)
def test_what_is_left_open(names: str, constraints: list[str]) -> None:
    report = report_of(names, constraints)
    assert (report.verdict, report.dof, report.consistent is not False) == ("undecided", None, True)


SQUARE = "abs(xdot) + abs(ydot) = z"


def test_at_a_reference_configuration() -> None:
    above = report_of("x y z", [SQUARE], {"x": 0, "y": 0, "z": 2})
    assert (above.dof, above.velocity_dof, above.instantaneous_dof, above.singular) == (3, 2, 2, False)
    # at rest there, and nothing holds nearby on one side
    assert report_of("x y z", [SQUARE], {"x": 0, "y": 0, "z": 0}).dof is None


@pytest.mark.parametrize(
    ("equation", "z", "known"),
    [
        ("xdot^2 + ydot^2 = z*zdot^2", 1, (3, 2, 2, False)),
        ("xdot^2 + ydot^2 = z*zdot^2", 0, (None, None, None, None)),
        ("xdot^2 + ydot^2 = zdot^2", 0, (3, 2, 2, False)),
    ],
)
def test_velocities_to_first_order_where_one_relation_bends(
    equation: str, z: int, known: tuple[int | None, ...]
) -> None:
    """A cone of velocities has the dimension 2, and so it has at a reference where it is one."""
    report = report_of("x y z", [equation], {"x": 0, "y": 0, "z": z})
    assert (report.dof, report.velocity_dof, report.instantaneous_dof, report.singular) == known
