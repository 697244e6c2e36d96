"""Scenes that are graphs of links in general position: told by the graph, as the links alone are."""

from __future__ import annotations

import random
from collections.abc import Sequence
from itertools import combinations
from typing import Any

import pytest
from shared.known_scenes import swept

import dofkit
from dofkit.mobility.general_position import METHOD

Pair = tuple[str, str]


def classified(dimension: int, *constraints: Any, **more: Any) -> dofkit.Report:
    named = {end for c in constraints if isinstance(c, dict) for end in (c.get("between") or c["members"])}
    scene = {"dimension": dimension, "particles": sorted(named), "constraints": list(constraints), **more}
    return dofkit.classify(dofkit.load(scene))


def link(a: str, b: str, **more: Any) -> dict[str, Any]:
    return {"type": "link", "between": [a, b], "name": f"{a}{b}", **more}


def links(pairs: Sequence[Pair]) -> list[dict[str, Any]]:
    return [link(a, b) for a, b in pairs]


def complete(names: str) -> list[Pair]:
    return list(combinations(names, 2))


@pytest.mark.parametrize(("d", "n"), [(1, 60), (2, 300), (3, 120)])
def test_a_large_scene_is_answered_as_its_graph_is(d: int, n: int) -> None:
    rng = random.Random(d)
    names = [f"P{i}" for i in range(n)]
    pairs = [(names[w], names[v]) for v in range(1, n) for w in rng.sample(range(v), min(v, d))]
    pairs += rng.sample([p for p in combinations(names, 2) if p not in set(pairs)], n // 10)
    rng.shuffle(pairs)
    told, report = dofkit.linkage(pairs, d), classified(d, *links(pairs))
    assert (report.consistent, report.dof, report.velocity_dof) == (True, told.freedom, told.freedom)
    assert (report.verdict, report.method) == ("proved", METHOD)
    assert report.redundant == ["".join(pair) for pair in told.redundant]
    assert {e.name: e.circuit for e in report.constraints if e.circuit is not None} == {
        "".join(pair): ["".join(member) for member in told.circuit(pair)] for pair in told.redundant
    }
    assert [(r.nullity, r.members) for r in report.redundancies] == [
        (group.nullity, ["".join(pair) for pair in group.members]) for group in told.redundancies
    ]
    assert report.generalized_coordinates is not None
    assert len(report.generalized_coordinates) == told.freedom


def test_a_double_banana() -> None:
    """18 links on 8 joints, as many as a rigid body needs; yet the halves turn about A and B."""
    pairs = [p for side in ("ABcde", "ABfgh") for p in complete(side) if p != ("A", "B")]
    report = classified(3, *links(pairs))
    assert (report.dof, report.redundant_equations, report.redundant, report.verdict) == (7, 1, ["gh"], "proved")
    assert (report.method, report.constraints[-1].independent) == (METHOD, 0)


def test_rigid_sets_and_links_together() -> None:
    """In the plane 5 particles have 7 independent distances; a sixth held by three links to them needs but two."""
    rigid = {"type": "rigid", "members": list("ABCDE"), "name": "plate"}
    report = classified(2, rigid, *links([("A", "F"), ("B", "F"), ("C", "F")]))
    assert (report.dof, report.redundant, report.method) == (3, ["CF"], METHOD)
    assert [e.independent for e in report.constraints] == [7, 1, 1, 0]


LENGTHS = {"parameters": {f"l{k}": "positive" for k in range(99)}}


def test_lengths_that_are_parameters() -> None:
    """A strip of 20 triangles, 41 bars of independent lengths: a rigid body, wherever such lengths can be had."""
    names = [f"P{i:02}" for i in range(22)]
    pairs = [(a, b) for i, b in enumerate(names) for a in names[max(0, i - 2) : i]]
    report = classified(2, *(link(a, b, length=f"l{k}") for k, (a, b) in enumerate(pairs)), **LENGTHS)
    assert (report.consistent, report.dof, report.redundant, report.method) == (True, 3, [], METHOD)


@pytest.mark.parametrize(
    "constraints",
    [
        # the graph does not know what these lengths say of each other
        [link("A", "B", length="l0"), {**link("B", "A"), "length": "l1"}],
        swept([link(a, b, length=f"l{k}") for k, (a, b) in enumerate(complete("ABCD"))]),
        # nor lengths that are used twice, or are given, or are more than a parameter
        [link("A", "B", length="l0"), link("B", "C", length="l0"), link("A", "C", length="2 l0")],
        [link("A", "B", length=3), link("B", "C", length=4), link("A", "C", length=5)],
        [link("A", "B", length="l0 + 1"), link("B", "C")],
        # nor what else is said of the coordinates
        [link("A", "B"), link("B", "C"), "x_A = x_C"],
    ],
)
def test_what_is_no_graph_in_general_position(constraints: list[Any]) -> None:
    report = classified(2, *constraints, **LENGTHS)
    assert METHOD not in (report.method or "")


def test_prescribed_lengths_that_close_on_one_left_out() -> None:
    """Five prescribed lengths are met by four points; the sixth distance, left out, is what it is then."""
    pairs = complete("ABCD")
    written = [link(a, b, **({"length": f"l{k}"} if k else {})) for k, (a, b) in enumerate(pairs)]
    report = classified(2, *written, **LENGTHS)
    assert (report.consistent, report.dof, report.redundant, report.verdict) == (True, 3, ["CD"], "proved")


def test_every_other_part_is_answered_as_ever() -> None:
    report = classified(2, *links(complete("ABCD")), "s = u^2", coordinates=["s", "u", "free"])
    assert (report.dof, report.redundant) == (5, ["CD"])
    assert METHOD in (report.method or "")
