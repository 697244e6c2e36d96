"""Mechanisms drawn at random with joints of every type: counts that are found in different ways agree."""

from __future__ import annotations

import random
from typing import Any

import pytest

import dofkit
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.mobility.placement import reference_placement, rows_of
from dofkit.scene.lowering import lower

#: By dimension: the types, and which have a place and an axis.
TYPES = {
    2: ("revolute", "prismatic", "weld", "coincident", "slot", "link", "gear", "fixed"),
    3: ("revolute", "prismatic", "cylindrical", "screw", "universal", "spherical", "planar", "weld", "coincident",
        "slot", "link", "fixed"),
}  # fmt: skip
BETWEEN = ("revolute", "prismatic", "cylindrical", "screw", "universal", "spherical", "planar", "weld", "gear")
PLACED = ("revolute", "cylindrical", "screw", "universal", "spherical", "planar")
AXIAL = ("prismatic", "cylindrical", "screw", "planar")
PAIRS = ([[1, 0, 0], [0, 1, 0]], [[0, 1, 1], [1, 0, 0]], [[1, 1, 0], [1, -1, 2]])


def vector(rng: random.Random, d: int) -> list[int]:
    """Not 0."""
    found = [rng.randint(-2, 2) for _ in range(d)]
    return found if any(found) else vector(rng, d)


def joint(rng: random.Random, d: int, bodies: list[str]) -> dict[str, Any]:
    """A constraint of a random type on the drawing of small whole numbers, which makes special positions frequent."""
    kind, first = rng.choice(TYPES[d]), rng.choice(bodies)
    second = rng.choice([b for b in (*bodies, "ground") if b != first])
    at, other = ([rng.randint(-2, 2) for _ in range(d)] for _ in range(2))
    here = {"on": first, "at": at}
    there = [other if second == "ground" else {"on": second, "at": other}, at if second == "ground" else None]
    found: dict[str, Any] = {"type": kind}
    if kind in BETWEEN:
        found["between"] = [first, second]
    if kind in PLACED:
        found["at"] = at
    if kind in AXIAL or (kind == "revolute" and d == 3):
        found["axis"] = vector(rng, d)
    more: dict[str, dict[str, Any]] = {
        "screw": {"pitch": rng.randint(1, 3)},
        "gear": {"ratio": rng.choice((-2, 3))},
        "universal": {"axes": rng.choice(PAIRS)},
        "coincident": {"between": [here, there[1] or {"on": second, "at": at}]},
        "slot": {"point": here, "body": second, "at": at, "axis": vector(rng, d)},
        "link": {"between": [here, there[0]]},
        "fixed": {"point": here} if rng.random() < 0.7 else {"body": first},
    }
    return found | more.get(kind, {})


def mechanism(seed: int) -> dict[str, Any]:
    """One to three bodies and up to two joints more than bodies."""
    rng = random.Random(seed)
    d, bodies = 2 + seed % 2, [f"b{i}" for i in range(rng.randint(1, 3))]
    joints = [joint(rng, d, bodies) for _ in range(rng.randint(len(bodies), len(bodies) + 2))]
    return {"dimension": d, "bodies": bodies, "constraints": joints}


#: Draws that contradict their own drawing.
LEFT_OUT = frozenset({8, 23, 26, 29})


@pytest.mark.parametrize("seed", sorted(set(range(40)) - LEFT_OUT))
def test_counts_of_a_mechanism_agree(seed: int) -> None:
    scene = dofkit.load(mechanism(seed))
    report, system = dofkit.classify(scene), lower(scene)
    placement = reference_placement(system, frozenset())
    assert system.reference is not None
    assert placement is not None
    assert report.instantaneous_dof is not None
    p, n = placement.p, len(system.coordinates)
    rows = [row for found in placement.located for row in rows_of(found) or []]
    rank = rank_of_rows([{c: v % p for c, v in row.items() if v % p} for row in rows], p)
    assert report.instantaneous_dof == n - rank
    assert report.generic is not None
    assert report.generic.dof is not None
    assert report.generic.dof <= report.instantaneous_dof
    assert report.mobility is None or report.mobility.kutzbach == report.count.naive_dof
    named = [entry.redundant_equations for entry in report.constraints]
    if report.consistent and report.redundant_equations is not None and None not in named:
        assert sum(len(equations or []) for equations in named) == report.redundant_equations
