"""Bodies with joints: overconstrained mechanisms that move or are locked, random trees and loops, rolling, chains."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene, known_scene, numbered, tables
from dofkit.benchmark.trials.frameworks import hinged_loop, loop, tree

Place = Sequence[Any]


def _loop(hinges: Sequence[tuple[Place, Place]], bodies: int) -> dict[str, Any]:
    """Return the scene of a loop of hinges (place, axis) through the ground and ``bodies`` moving bodies."""
    exact = [tuple(tuple(map(Fraction, vector)) for vector in hinge) for hinge in hinges]
    return hinged_loop([(at, axis) for at, axis in exact], bodies)


def doors() -> Iterator[KnownScene]:
    """A door on n hinges: on one line it turns, and all but the first say nothing new; off the line it is fixed."""
    for n in (2, 3, 4, 8, 16):
        # name, the places and axes of the hinges, dof, how many of the first are needed
        rows: list[tuple[str, list[tuple[Place, Place]], int, int]] = [
            ("on one line", [([0, 0, k], [0, 0, 1]) for k in range(n)], 1, 1),
            ("on a slanting line", [([k, 2 * k, -k], [1, 2, -1]) for k in range(n)], 1, 1),
            ("beside each other", [([k, 0, k], [0, 0, 1]) for k in range(n)], 0, 2),
            ("each a little aside", [([f"{k}e-9", 0, k], [0, 0, 1]) for k in range(n)], 0, 2),
            ("each a little tilted", [([0, 0, k], [f"{k}e-9", 0, 1]) for k in range(n)], 0, 2),
        ]
        for name, hinges, dof, needed in rows:
            redundant = [f"hinge{k}" for k in range(needed, n)]
            because = "hinges on one line are one hinge; two that are not hold the door"
            about = f"{n} hinges {name}", _loop(hinges, 1), because, n
            yield known_scene(*about, dof=dof, redundancy=redundant)


def cranks() -> Iterator[KnownScene]:
    """A platform on n parallel bars of one length moves; with one foot aside, or one bar longer, it does not."""
    because = "parallel bars of one length: a circle for every point; three that are not through one point hold it"
    for n in (3, 4, 8, 16):
        platform = [[k, 2 + k % 2] for k in range(n)]
        feet: list[list[Any]] = [[x, y - 2] for x, y in platform]
        names = [f"bar{k}" for k in range(n)]
        # name, the number of a foot and its place elsewhere, dof, what is redundant
        rows: list[tuple[str, int, list[Any], int, list[str]]] = [
            ("of one length", 0, feet[0], 1, names[2:]),
            ("the last foot aside", n - 1, [n + 1, 0], 0, names[2 : n - 1]),
            ("the third foot aside", 2, [5, feet[2][1]], 0, names[3:]),
            ("the third foot aside by 1e-9", 2, ["2+1e-9", feet[2][1]], 0, names[3:]),
        ]
        for name, moved, place, dof, redundant in rows:
            bars = [
                {
                    "name": bar,
                    "type": "link",
                    "between": [place if k == moved else feet[k], {"on": "platform", "at": top}],
                }
                for k, (bar, top) in enumerate(zip(names, platform, strict=True))
            ]
            scene = {"dimension": 2, "bodies": ["platform"], "constraints": bars}
            yield known_scene(f"{n} bars, {name}", scene, because, n, dof=dof, redundancy=redundant)


def loops() -> Iterator[KnownScene]:
    """A closed loop of n hinges in space: parallel ones move as in the plane, a tilted one is locked."""
    because = "parallel screws have rank 3; a tilted one is outside of them, and so does not turn"
    for n in (4, 5, 6, 8):
        hinges: list[tuple[Place, Place]] = [([k, k * (n - 1 - k), 0], [0, 0, 1]) for k in range(n)]
        rows: list[tuple[str, Place, int]] = [
            ("parallel", [0, 0, 1], n - 3),
            ("the last tilted", [1, 0, 1], n - 4),
            ("the last tilted by 1e-9", ["1e-9", 0, 1], n - 4),
        ]
        for name, axis, dof in rows:
            scene = _loop([*hinges[:-1], (hinges[-1][0], axis)], n - 1)
            yield known_scene(f"{n} hinges, {name}", scene, because, n, dof=dof)


def named_loops() -> Iterator[KnownScene]:
    """Overconstrained loops named after who found them [Bennett1903]; they move though the count denies it."""
    for row in tables("poses.yaml")["loops"]:
        n = len(row["hinges"])
        scene = _loop(row["hinges"], n - 1)
        yield known_scene(row["name"], scene, row["because"], n, dof=row["dof"])


def trees() -> Iterator[KnownScene]:
    """Joints of every type, each body on one before it; and one of the joints written twice."""
    because = "the freedoms of the joints of a tree add up; a joint written twice adds nothing"
    for d, n in ((d, n) for n in (1, 2, 4, 8, 16) for d in (2, 3)):
        for seed in range(1 if n > 4 else 2):
            rng = random.Random(f"tree {d} {n} {seed}")
            scene = tree(rng, d, n)
            joints = scene.scene["constraints"]
            doubled = {**rng.choice(joints), "name": "again"}
            for name, constraints, redundant in (
                ("", joints, []),
                (", one joint twice", [*joints, doubled], ["again"]),
            ):
                about = f"{n} bodies in dimension {d}, {seed}{name}", {**scene.scene, "constraints": constraints}
                yield known_scene(*about, because, n, dof=scene.dof, redundancy=redundant)


def random_loops() -> Iterator[KnownScene]:
    """Closed loops of random joints, where their screws span all motions or are independent."""
    because = "rates whose screws cancel, by the exact rank: regular where they span all, none where independent"
    for d, n in ((d, n) for n in (1, 2, 3, 4, 5, 6) for d in (2, 3)):
        for seed in range(4):
            scene = loop(random.Random(f"loop {d} {n} {seed}"), d, n)
            if scene.dof is not None:
                name = f"{n} bodies in dimension {d}, {seed}"
                yield known_scene(name, scene.scene, because, n, dof=scene.dof)


def rolling() -> Iterator[KnownScene]:
    """Balls that roll on a plane: no form is integrable; discs that roll on a line: all are."""
    because = "a ball reaches every place and every turn; a disc on a line is where its angle says"
    for n in (1, 2, 4, 8):
        bodies = [f"b{k}" for k in range(n)]
        rolls = [{"type": "roll", "body": body, "radius": f"{k + 1}"} for k, body in enumerate(bodies)]
        held = [{"type": "equation", "text": f"y_b{k} = {k}"} for k in range(n)]
        for name, d, constraints, dof, labels in (
            ("balls on a plane", 3, rolls, 5 * n, dict.fromkeys(numbered(n), False)),
            ("discs on a line", 2, rolls, n, dict.fromkeys(numbered(n), True)),
            ("balls along lines", 3, [*rolls, *held], 4 * n, None),
        ):
            scene = {"dimension": d, "bodies": bodies, "constraints": constraints}
            yield known_scene(f"{n} {name}", scene, because, n, dof=dof, integrability=labels)


# Long chains


def pendulums() -> Iterator[KnownScene]:
    """Links one after the other from the ground; closed on the ground; and with links written twice."""
    because = "each link takes one; a chain that is not straight is regular; a link written twice adds nothing"
    for d, n in ((d, n) for n in (2, 4, 8, 16, 32, 64, 128) for d in (2, 3)):
        places = [[k, k * k % 3, k % 2][:d] for k in range(n + 1)]
        ends: list[Any] = [places[0], *(f"P{k}" for k in range(1, n + 1))]
        particles = [{"name": name, "at": at} for name, at in zip(ends[1:], places[1:], strict=True)]
        links = [_link(f"l{k}", ends[k], ends[k + 1]) for k in range(n)]
        twice = [_link(f"again{k}", ends[k], ends[k + 1]) for k in range(0, n, 2)]
        closed = [*links[:-1], _link(f"l{n - 1}", ends[n - 1], places[n])]
        for name, members, constraints, over in (
            ("open", particles, links, []),
            ("written twice", particles, [*links, *twice], [t["name"] for t in twice]),
            ("closed", particles[:-1], closed, []),
        ):
            dof = d * len(members) - n
            scene = {"dimension": d, "particles": members, "constraints": constraints}
            about = f"{n} links in dimension {d}, {name}", scene, because, n
            if dof >= 0:
                yield known_scene(*about, dof=dof, redundancy=over)


def _link(name: str, a: Any, b: Any) -> dict[str, Any]:
    return {"name": name, "type": "link", "between": [a, b]}


def chained_bodies() -> Iterator[KnownScene]:
    """Bodies hinged one to the next, in the plane and in space; every third hinge welded too."""
    because = "an open chain: the freedoms of the joints add up; a hinge between welded bodies says nothing new"
    for d, n in ((d, n) for n in (2, 4, 8, 16, 32) for d in (2, 3)):
        names = ["ground", *(f"b{k}" for k in range(n))]
        hinges: list[dict[str, Any]] = []
        for k in range(n):
            hinge = {"name": f"h{k}", "type": "revolute", "between": names[k : k + 2], "at": [k, k % 2, 0][:d]}
            hinges.append(hinge | ({"axis": [k % 3, 1, k % 2]} if d == 3 else {}))
        welds = [{"name": f"w{k}", "type": "weld", "between": names[k : k + 2]} for k in range(0, n, 3)]
        for name, joints, dof, over in (
            ("hinged", hinges, n, []),
            ("every third welded first", [*welds, *hinges], n - len(welds), [f"h{k}" for k in range(0, n, 3)]),
        ):
            scene = {"dimension": d, "bodies": names[1:], "constraints": joints}
            yield known_scene(f"{n} bodies in dimension {d}, {name}", scene, because, n, dof=dof, redundancy=over)


FAMILIES = {
    "doors": doors,
    "cranks": cranks,
    "loops of hinges": loops,
    "loops with a name": named_loops,
    "trees of bodies": trees,
    "loops of bodies": random_loops,
    "rolling": rolling,
    "chains of links": pendulums,
    "chains of bodies": chained_bodies,
}
