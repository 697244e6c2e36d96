"""A scene that runs out of time: what is finished keeps its answer, what is not is undecided, and nothing is late.

Time is this process's processor time here: what else the machine does is of no account.
"""

from __future__ import annotations

import sys
import time
from types import FrameType, SimpleNamespace
from typing import Any

import pytest

import dofkit
from dofkit.base import deadline
from dofkit.base.deadline import (
    OutOfTimeError,
    affordable,
    check,
    expired,
    limited,
    part,
    remaining_seconds,
    unless_late,
)
from dofkit.methods import classify
from dofkit.report import Report


@pytest.fixture(autouse=True)
def _processor_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(classify, "time", SimpleNamespace(monotonic=time.process_time))


class Readings:
    """A clock that goes on with every look at it, and counts the functions called after it was looked at so often."""

    TICK = 1e-4

    def __init__(self, until: int) -> None:
        self.until = until
        self.looks = self.calls = 0

    def monotonic(self) -> float:
        """The time; at the end of it the counting begins."""
        self.looks += 1
        if self.looks == self.until:
            sys.setprofile(self._profile)
        return self.looks * self.TICK

    def _profile(self, frame: FrameType, event: str, argument: Any) -> None:
        self.calls += event in ("call", "c_call")


def within(budget: float, **made: Any) -> tuple[Report, float]:
    """The report, and the seconds it took."""
    scene = dofkit.load({"name": "late", **made})
    start = time.process_time()
    report = classify.classified(scene, budget)
    return report, time.process_time() - start


def coupled(n: int) -> dict[str, Any]:
    """A chain of forms that all share coordinates: contact forms of growing order."""
    return {
        "coordinates": [f"x{i}" for i in range(n + 2)],
        "constraints": [f"dx{i} = x{i + 1} dx{i + 2}" for i in range(n)],
    }


def complete(n: int, dimension: int) -> dict[str, Any]:
    names = [f"A{i}" for i in range(n)]
    return {"dimension": dimension, "particles": names, "constraints": [{"type": "rigid", "members": names}]}


def drawn(n: int, **more: Any) -> dict[str, Any]:
    """A triangulated square of n x n particles, as drawn."""
    places = [(i, j) for i in range(n) for j in range(n)]
    bars = [((i, j), (i + a, j + b)) for i, j in places for a, b in ((1, 0), (0, 1), (1, 1)) if max(i + a, j + b) < n]
    return {
        "dimension": 2,
        "particles": [{"name": f"P{i}a{j}", "at": [i, j]} for i, j in places],
        "constraints": [
            {"type": "link", "between": [f"P{i}a{j}", f"P{k}a{m}"]} for (i, j), (k, m) in bars
        ],
        **more,
    }  # fmt: skip


def test_time_is_shared_and_never_grows() -> None:
    assert remaining_seconds() > 1e9
    with limited(10):
        with limited(50):
            assert remaining_seconds() <= 10
        with part(0.5):
            assert 4 < remaining_seconds() <= 5
        assert remaining_seconds() > 9
        check()
    with limited(-1):
        assert expired()
        assert remaining_seconds() == 0
        with pytest.raises(OutOfTimeError):
            check()
    assert not expired()


def test_late_work_gives_way() -> None:
    def late() -> int:
        raise OutOfTimeError("late")

    assert unless_late(late, 3) == 3
    assert unless_late(lambda: 5, 3) == 5


def test_a_matrix_that_does_not_fit_in_the_time_is_not_begun() -> None:
    affordable(1000, 1000)
    with pytest.raises(OutOfTimeError, match="4000 rows"):
        affordable(4000, 4000)
    with limited(0.1), pytest.raises(OutOfTimeError):
        affordable(1000, 1000)


LARGE = {
    "coupled forms": coupled(150),
    "complete in space": complete(60, 3),
    "complete in the plane": complete(120, 2),
    "drawn": drawn(16),
    "measured": drawn(9, tolerance="1e-5"),
}


@pytest.mark.parametrize("looks", [10, 100, 1000])
@pytest.mark.parametrize("made", LARGE.values(), ids=LARGE)
def test_little_is_done_when_the_time_is_up(made: dict[str, Any], looks: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A million calls of functions are some 0.2 s."""
    clock = Readings(looks)
    monkeypatch.setattr(deadline, "time", clock)
    monkeypatch.setattr(classify, "time", clock)
    try:
        report, _ = within(looks * clock.TICK, **made)
    finally:
        sys.setprofile(None)
    assert len(report.constraints) == len(made["constraints"])
    assert report.verdict == "undecided"
    assert clock.calls < 1_000_000


@pytest.mark.sweep
@pytest.mark.parametrize("made", LARGE.values(), ids=LARGE)
def test_nothing_is_much_late(made: dict[str, Any]) -> None:
    budget = 0.6
    report, taken = within(budget, **made)
    assert len(report.constraints) == len(made["constraints"])
    assert taken < budget + 5


def test_what_is_finished_keeps_its_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """x dy + y dx = 0 is d(xy) = 0 whatever becomes of the part that shares nothing with it."""
    made = coupled(3)
    made["coordinates"] += ["x", "y"]
    made["constraints"].insert(0, {"name": "easy", "type": "equation", "text": "x dy + y dx = 0"})
    solving = sys.modules["dofkit.classification.freedom.branches"]
    real = solving.answer

    def late(block: Any, setting: Any) -> Any:
        if len(block.rows) > 1:
            raise OutOfTimeError(deadline.OUT_OF_TIME)
        return real(block, setting)

    monkeypatch.setattr(solving, "answer", late)
    report, _ = within(60, **made)
    assert (report.verdict, report.dof) == ("undecided", None)
    easy, hard = report.constraints[0], report.constraints[1]
    assert (easy.holonomic, easy.exact, easy.verdict, easy.integral) == (True, True, "proved", "x*y = C")
    assert (hard.holonomic, hard.verdict) == (None, "undecided")
    assert "time" in hard.reason


def test_a_branch_that_was_not_finished_is_not_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of x y = 0 and x z = 0 the branch x = 0 leaves two freedoms; y = z = 0 leaves one, and is not the answer."""
    made = {"coordinates": ["x", "y", "z"], "constraints": ["x y = 0", "x z = 0"]}
    solving = sys.modules["dofkit.classification.freedom.branches"]
    real = solving.answer

    def late(block: Any, setting: Any) -> Any:
        if len(block.rows) == 1:
            raise OutOfTimeError(deadline.OUT_OF_TIME)
        return real(block, setting)

    assert within(60, **made)[0].dof == 2
    monkeypatch.setattr(solving, "answer", late)
    report, _ = within(60, **made)
    assert (report.dof, report.verdict) == (None, "undecided")


def test_redundancy_that_there_was_no_time_for_is_not_denied(monkeypatch: pytest.MonkeyPatch) -> None:
    def late(*_: Any) -> Any:
        raise OutOfTimeError(deadline.OUT_OF_TIME)

    made = {"coordinates": ["x", "y", "z"], "constraints": ["x = y", "y = z", "x = z"]}
    assert within(60, **made)[0].redundant == ["c3"]
    monkeypatch.setattr(sys.modules["dofkit.classification.dependence.redundancy"], "analyse", late)
    report, _ = within(60, **made)
    assert (report.dof, report.redundant_equations, report.redundant) == (1, 1, None)
    assert report.verdict == "undecided"
    assert "Whether it is implied by the others was not decided" in report.constraints[2].reason


def test_no_time_at_all_is_a_report() -> None:
    report, _ = within(0, **coupled(3))
    assert [e.name for e in report.constraints] == ["c1", "c2", "c3"]
    assert {e.verdict for e in report.constraints} == {"undecided"}
    assert report.count.coordinates == 5
