"""One question by the shortest way: it says what `classify` says."""

from __future__ import annotations

from typing import Any

import pytest

import dofkit

HINGES = [
    {"name": "A", "type": "revolute", "between": ["ground", "a"], "at": [0, 0]},
    {"name": "B", "type": "revolute", "between": ["ground", "b"], "at": [3, 0]},
]


def geared(*texts: str) -> dict[str, Any]:
    """Two arms whose angles p and q are coupled by texts."""
    joints = {"p": "A", "q": "B"}
    couplings = [{"name": f"c{k}", "type": "coupling", "joints": joints, "text": t} for k, t in enumerate(texts)]
    return {"dimension": 2, "bodies": ["a", "b"], "constraints": [*HINGES, *couplings]}


@pytest.mark.parametrize(
    ("texts", "dof", "redundant"),
    [
        (("p = q", "p = q + q^2"), 0, []),
        (("p = q", "p = sin(q)"), 0, []),
        (("p = q", "p = q + t q"), 0, []),
        (("p = q", "2 p = 2 q"), 1, ["c1"]),
    ],
)
def test_couplings_of_equal_rates_are_no_copies(texts: tuple[str, ...], dof: int, redundant: list[str]) -> None:
    """At the drawing their rates are the same; together they say q^2 = 0, q = sin q or t q = 0: only q = 0 is left."""
    scene = geared(*texts)
    assert dofkit.ask(scene, "dof").value == dofkit.classify(scene).dof == dof
    assert dofkit.ask(scene, "redundancy").value == dofkit.classify(scene).redundant == redundant


def test_couplings_that_part_in_time_are_not_told_to_move() -> None:
    """p = q and p = q + t^2 hold together at t = 0 only."""
    reply = dofkit.ask(geared("p = q", "p = q + t^2"), "dof")
    assert reply.verdict == "undecided" or reply.value == -1
