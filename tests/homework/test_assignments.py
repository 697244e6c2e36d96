"""Assignments that are none: every fault at once, with its place and what to do."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from dofkit.homework.assignment import AssignmentError, load_assignment

HEAD = "title: T\nproblems:\n"
#: A text -> what its faults say, each with line and column, in order.
BAD: list[tuple[str, list[str]]] = [
    ("", ["1:1 the file is empty"]),
    ("[1, 2]", ["an assignment is a mapping of keys to values"]),
    ("title: T", ["1:1 an assignment needs 'problems'"]),
    ("title: T\nproblem: []", ["2:1 unknown key 'problem' in an assignment"]),
    ("title: T\nproblems: []", ["2:11 at least 1 entry is needed, not 0"]),
    ("title: T\ntitle: U\nproblems: 3", ["2:1 the key 'title' is written twice"]),
    ("title: T\nproblems: [", ["2:12 a value is needed"]),
    (
        HEAD + "- {id: a, scene: simple-pendulum-lnk, questions: [{id: f, ask: dof}]}",
        ["3:18 there is no file 'simple-pendulum-lnk'"],
    ),
    (
        HEAD + "- id: a\n  scene: {coordinates: [x]}\n"
        "  questions: [{id: f, ask: dof, points: -1}, {id: g, ask: doff}, {ask: k}, 3, {id: h, ask: k, pionts: 3}]",
        [
            "5:41 points are not negative, as -1 is",
            "5:59 there is no question 'doff'",
            "5:66 a question that asks for 'k' needs 'id'",
            "5:76 a question is a mapping with `id` and `ask`",
            "5:95 unknown key 'pionts' in a question that asks for 'k'",
        ],
    ),
    (
        HEAD + "- id: a\n  scene: {coordinates: [x], constraints: ['x = 1']}\n  questions:\n"
        "  - {id: e, ask: equation, constraint: c2}\n  - {id: i, ask: integral, constraint: c1}\n"
        "  - {id: i, ask: label, constraint: c1}",
        [
            "6:40 the scene has no constraint 'c2'",
            "7:40 'c1' is not a differential constraint",
            "8:10 the question 'i' is given twice",
        ],
    ),
    (
        HEAD + "- id: a\n  scene: {coordinates: [x], constraints: ['x = 1', 'x = 2']}\n  questions: [{id: f, ask: k}]",
        ["4:10 the scene of problem 'a' is inconsistent: c1, c2"],
    ),
    (
        HEAD + "- id: a\n  scene: {coordinates: [x], constraints: ['x = z']}\n  questions: [{id: f, ask: k}]\n"
        "- id: a\n  scene: {coordinates: [x]}\n  questions: [{id: f, ask: k, points: .nan}]",
        ["8:39 a finite number is needed, not .nan"],
    ),
    (
        HEAD + "- id: a\n  scene: {coordinates: [x], constraints: ['x = z']}\n  questions: [{id: f, ask: k}]\n"
        "- id: a\n  scene: {coordinates: [x]}\n  questions: [{id: f, ask: k}]",
        ["4:48 `z` is not declared", "6:7 the problem 'a' is given twice"],
    ),
    (
        "convention: velocty\nfeedback: loud\ntitle: T\n"
        "problems: [{id: 1, scene: free-rigid-body-3d, questions: [{id: 1, ask: dof}]}]",
        ["1:13 'velocty' is not one of", "2:11 'loud' is not one of"],
    ),
]


@pytest.mark.parametrize(("text", "told"), BAD, ids=range(len(BAD)))
def test_every_fault_is_reported_with_its_place(text: str, told: list[str], tmp_path: Path) -> None:
    path = tmp_path / "assignment.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(AssignmentError) as caught:
        load_assignment(path)
    found = [f"{f.line}:{f.column} {f.message}" if f.line else f.message for f in caught.value.faults]
    assert [f[: len(t)] for f, t in zip(found, told, strict=True)] == told
    assert all(fault.hint for fault in caught.value.faults)


def test_scenes_by_name_by_path_and_in_place(tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text("coordinates: [x, y]\nconstraints: ['x = y']", encoding="utf-8")
    path = tmp_path / "assignment.yaml"
    questions = "questions: [{id: f, ask: dof}]"
    path.write_text(
        HEAD + f"- {{id: 1, scene: simple-pendulum-link, {questions}}}\n- {{id: 2, scene: own.yaml, {questions}}}\n"
        f"- {{id: 3, scene: {{coordinates: [x, y, z]}}, {questions}}}",
        encoding="utf-8",
    )
    prepared = load_assignment(path)
    assert {name: key.report.dof for name, key in prepared.keys.items()} == {"1": 1, "2": 1, "3": 3}


def test_a_fault_in_the_file_of_a_scene_says_where_it_is(tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text("coordinates: [x]\nconstraints: ['x = z']", encoding="utf-8")
    path = tmp_path / "assignment.yaml"
    path.write_text(HEAD + "- {id: 1, scene: own.yaml, questions: [{id: f, ask: dof}]}", encoding="utf-8")
    with pytest.raises(AssignmentError, match=r"`z` is not declared \(line 2, column 20 of own.yaml\)"):
        load_assignment(path)


def test_a_missing_file_beside_the_assignment(tmp_path: Path) -> None:
    with pytest.raises(AssignmentError, match="there is no file"):
        load_assignment(tmp_path / "none.yaml")


@pytest.mark.parametrize("points", ["1e400", "1e7", "1e-400", "0.0001", '"2/3000"', "-1"])
def test_points_that_nobody_can_give(points: str, tmp_path: Path) -> None:
    path = tmp_path / "sheet.yaml"
    path.write_text(
        "title: x\nproblems:\n- id: p\n  scene: spherical-pendulum\n  questions:\n"
        f"  - {{id: a, ask: dof}}\n  - {{id: b, ask: dof, points: {points}}}\n"
    )
    with pytest.raises(AssignmentError) as found:
        load_assignment(path)
    (fault,) = found.value.faults
    assert (fault.line, fault.column) == (7, 31)
    assert "points" in fault.message


@pytest.mark.sweep
def test_a_scene_of_too_many_constraints_is_refused_in_time(tmp_path: Path) -> None:
    rods = "".join(f"    - {{name: c{i}, type: link, between: [A, B], length: 1}}\n" for i in range(10**5))
    scene = f"  scene:\n    dimension: 2\n    particles: [A, B]\n    constraints:\n{rods}"
    (tmp_path / "sheet.yaml").write_text(f"title: x\nproblems:\n- id: p\n{scene}  questions: [{{id: f, ask: dof}}]\n")
    start = time.process_time()
    with pytest.raises(AssignmentError) as found:
        load_assignment(tmp_path / "sheet.yaml")
    assert time.process_time() - start < 30
    (fault,) = found.value.faults
    assert (fault.message, fault.line) == ("the scene has 100000 constraints, more than an assignment takes (5000)", 8)
