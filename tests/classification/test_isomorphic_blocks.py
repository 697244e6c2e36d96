"""Blocks and constraints that are the same up to names: each is told in its own, and what only looks alike is not."""

from __future__ import annotations

from typing import Any

import dofkit


def told(coordinates: str, *constraints: str, **more: Any) -> dofkit.Report:
    """The report of a scene of texts."""
    return dofkit.classify({"coordinates": coordinates.split(), "constraints": list(constraints), **more})


def test_every_block_is_reported_in_its_own_names() -> None:
    report = told("x1 y1 u v", "x1 dy1 + y1 dx1 = 0", "v du + u dv = 0")
    assert [e.integral for e in report.constraints] == ["x1*y1 = C", "u*v = C"]
    assert (report.dof, report.velocity_dof) == (2, 2)


def test_equal_discs_roll_each_by_itself() -> None:
    names = "x0 y0 th0 ph0 y1 th1 ph1 x1 a b c d"
    rolls = ["dx0 = R cos(th0) dph0", "dy0 = R sin(th0) dph0", "dx1 = R cos(th1) dph1", "dy1 = R sin(th1) dph1"]
    rolls += ["da = R cos(c) dd", "db = R sin(c) dd"]
    report = told(names, *rolls, parameters={"R": "positive"})
    assert (report.dof, report.velocity_dof, report.growth_vector) == (12, 6, [6, 9, 12])
    assert [e.holonomic for e in report.constraints] == [False] * 6
    assert [e.text for e in report.constraints] == rolls
    assert [e.name for e in report.constraints] == [f"c{k}" for k in range(1, 7)]


def test_a_disc_of_another_radius_or_with_one_name_for_two_is_another_block() -> None:
    """R = 0 would leave nothing to roll on: with the number 0 for the radius dx = 0 and dy = 0 integrate."""
    names = "x0 y0 th0 ph0 x1 y1 th1 ph1 x2 y2 th2"
    rolls = ["dx0 = R cos(th0) dph0", "dy0 = R sin(th0) dph0", "dx1 = S cos(th1) dph1", "dy1 = S sin(th1) dph1"]
    rolls += ["dx2 = R cos(th2) dth2", "dy2 = R sin(th2) dth2"]
    report = told(names, *rolls, parameters={"R": "positive", "S": 0})
    assert [e.holonomic for e in report.constraints] == [False, False, True, True, True, True]
    assert (report.dof, report.velocity_dof) == (11 - 4, 11 - 6)


def test_two_forms_of_one_constraint_are_compared_together() -> None:
    """da - b dc and dd - e df leave 4 of 6 velocities; with g, h, k shared they leave one, and a line integrates."""
    report = told("a b c d e f g h k", "da - b dc = 0 = dd - e df", "dg - h dk = 0 = dh - k dg")
    assert [e.holonomic for e in report.constraints] == [False, True]
    assert [e.holonomic_alone for e in report.constraints] == [False, True]
    assert (report.dof, report.velocity_dof) == (9 - 2, 9 - 4)


def test_what_is_chosen_is_chosen_of_every_block() -> None:
    report = told("x y u v p q", "y = x^2 + 1", "u = v^2 + 1", "q = p^2 + 1")
    assert report.generalized_coordinates == ["x", "v", "p"]


def test_links_of_one_length_and_of_others() -> None:
    """Each triangle is a rigid body, and the seventh point goes round a corner of one."""
    links = [("A", "B"), ("B", "C"), ("C", "A"), ("D", "E"), ("E", "F"), ("F", "D")]
    constraints: list[dict[str, Any]] = [{"type": "link", "between": list(pair), "length": "l"} for pair in links]
    constraints.append({"type": "link", "between": ["A", "G"], "length": 2})
    report = dofkit.classify(
        {"dimension": 2, "parameters": {"l": "positive"}, "particles": [*"ABCDEFG"], "constraints": constraints}
    )
    assert report.dof == 3 + 3 + 1
    assert report.constraints[-1].text == "link A-G, length 2"


def test_a_fault_of_a_text_like_others_is_reported_at_its_place() -> None:
    """The pattern of what was read is no pattern of what cannot be read."""
    texts = ["dx = R cos(y) dz", "du = R cos(v) dw", "du = R cos(w) dq", "du = R cos(v) + dw", "2u = v", "2e5x = v"]
    scene = {"parameters": ["R"], "coordinates": [*"xyzuvw"], "constraints": texts}
    try:
        dofkit.load(scene)
    except dofkit.SceneError as error:
        faults = [(f.where[1], f.column, f.message) for f in error.faults]
    assert [(place, column) for place, column, _ in faults] == [(2, 15), (3, None)]
    assert "`dq`" in faults[0][2]
