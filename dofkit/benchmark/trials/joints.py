"""Bodies with joints that are overconstrained, at work or blocked: doors, cranks, planar loops in space, Sarrus."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene, known_scene

Place = Sequence[Any]


def doors(quick: bool) -> Iterator[KnownScene]:
    """A door on n hinges: on one line it turns, and all but the first say nothing new; off the line it is held."""
    for n in (2, 3) if quick else (2, 3, 4, 8, 16):
        # name, the places and axes of the hinges, dof, how many of the first are needed, trait
        rows: list[tuple[str, list[tuple[Place, Place]], int, int, str]] = [
            ("on one line", [([0, 0, k], [0, 0, 1]) for k in range(n)], 1, 1, "overconstrained"),
            ("on a slanting line", [([k, 2 * k, -k], [1, 2, -1]) for k in range(n)], 1, 1, "overconstrained"),
            ("beside each other", [([k, 0, k], [0, 0, 1]) for k in range(n)], 0, 2, "joints"),
            ("each a little aside", [([f"{k}e-9", 0, k], [0, 0, 1]) for k in range(n)], 0, 2, "near-singular"),
            ("each a little tilted", [([0, 0, k], [f"{k}e-9", 0, 1]) for k in range(n)], 0, 2, "near-singular"),
        ]
        for name, hinges, dof, needed, trait in rows:
            names = [f"hinge{k}" for k in range(n)]
            joints = [
                {"name": name, "type": "revolute", "between": ["ground", "door"], "at": at, "axis": axis}
                for name, (at, axis) in zip(names, hinges, strict=True)
            ]
            yield known_scene(
                f"{n} hinges {name}",
                {"bodies": ["door"], "constraints": joints},
                "hinges on one line are one hinge; two that are not hold the door",
                (trait, "redundant") if n > needed else (trait,),
                size=n,
                dof=dof,
                redundancy=names[needed:],
            )


def cranks(quick: bool) -> Iterator[KnownScene]:
    """A platform on n parallel bars of one length moves; with one foot aside, or one bar longer, it does not."""
    for n in (3, 4) if quick else (3, 4, 8, 16):
        platform = [[k, 2 + k % 2] for k in range(n)]
        for name, feet, dof, needed, trait in (
            ("of one length", [[x, y - 2] for x, y in platform], 1, 2, "special-position"),
            ("the last foot aside", [*([x, y - 2] for x, y in platform[:-1]), [n + 1, 0]], 0, n, "plain"),
            ("the third foot aside", [[x + (k == 2) * 3, y - 2] for k, (x, y) in enumerate(platform)], 0, 3, "plain"),
            (
                "the third foot aside by 1e-9",
                [[f"{x}+1e-9" if k == 2 else x, y - 2] for k, (x, y) in enumerate(platform)],
                0,
                3,
                "near-singular",
            ),
        ):
            names = [f"bar{k}" for k in range(n)]
            bars = [
                {"name": name, "type": "link", "between": [foot, {"on": "platform", "at": top}]}
                for name, foot, top in zip(names, feet, platform, strict=True)
            ]
            last = n if needed == n else needed
            redundant = names[2 : n - 1] if needed == n else names[last:]
            yield known_scene(
                f"{n} bars, {name}",
                {"dimension": 2, "bodies": ["platform"], "constraints": bars},
                "parallel bars of one length: a circle for every point; three that are not through one point hold it",
                (trait,),
                size=n,
                dof=dof,
                redundancy=redundant,
            )


def loops(quick: bool) -> Iterator[KnownScene]:
    """A closed loop of n hinges in space: parallel ones move as in the plane, a tilted one is locked."""
    for n in (4, 5) if quick else (4, 5, 6, 8):
        places = [[k, k * (n - 1 - k), 0] for k in range(n)]
        bodies = ["ground", *(f"link{k}" for k in range(1, n))]
        for name, axis, dof, trait in (
            ("parallel", [0, 0, 1], n - 3, "overconstrained"),
            ("the last tilted", [1, 0, 1], n - 4, "overconstrained"),
            ("the last tilted by 1e-9", ["1e-9", 0, 1], n - 4, "near-singular"),
        ):
            names = [f"hinge{k}" for k in range(n)]
            joints = [
                {
                    "name": names[k],
                    "type": "revolute",
                    "between": [bodies[k], bodies[(k + 1) % n]],
                    "at": places[k],
                    "axis": axis if k == n - 1 else [0, 0, 1],
                }
                for k in range(n)
            ]
            yield known_scene(
                f"{n} hinges, {name}",
                {"bodies": bodies[1:], "constraints": joints},
                "parallel screws have rank 3; a tilted one is outside of them, and so does not turn",
                (trait,),
                size=n,
                dof=dof,
            )


#: name, hinges (place, axis) around the loop, dof, because, trait
KNOWN: list[tuple[str, list[tuple[Place, Place]], int, str, str]] = [
    ("Sarrus", [([1, 0, 0], [0, 1, 0]), ([3, 0, 1], [0, 1, 0]), ([1, 0, 2], [0, 1, 0]), ([0, 1, 2], [1, 0, 0]),
                ([0, 3, 1], [1, 0, 0]), ([0, 1, 0], [1, 0, 0])], 1,
     "either half leaves a plane motion; both together a straight line", "overconstrained"),
    ("Sarrus, one axis turned", [([1, 0, 0], [0, 1, 0]), ([3, 0, 1], [0, 1, 0]), ([1, 0, 2], [0, 1, 0]),
                                 ([0, 1, 2], [1, 0, 0]), ([0, 3, 1], [1, 0, 0]), ([0, 1, 0], [1, 0, 1])], 0,
     "six independent screws", "joints"),
    # [Bennett1903]
    ("Bennett", [([0, 0, 0], [0, 0, 1]), ([52, 0, 0], [0, -4, 3]), ([16, -9, -12], [-3, -4, 12]),
                 ([0, 39, 0], [3, 0, 4])], 1, "Bennett 1903: four screws of rank 3 all along", "overconstrained"),
    ("Bennett, a foot aside", [([0, 0, 0], [0, 0, 1]), ([52, 0, 0], [0, -4, 3]), ([16, -9, -12], [-3, -4, 12]),
                               ([0, 40, 0], [3, 0, 4])], 0, "four independent screws", "joints"),
    ("spherical four-bar", [([1, 0, 0], [1, 0, 0]), ([0, 1, 0], [0, 1, 0]), ([0, 0, 1], [0, 0, 1]),
                            ([1, 1, 1], [1, 1, 1])], 1, "axes through one point: rank 3", "overconstrained"),
    ("spherical five-bar", [([1, 0, 0], [1, 0, 0]), ([0, 1, 0], [0, 1, 0]), ([0, 0, 1], [0, 0, 1]),
                            ([1, 1, 1], [1, 1, 1]), ([1, 2, 3], [1, 2, 3])], 2, "axes through one point: rank 3",
     "overconstrained"),
    ("three hinges", [([0, 0, 0], [0, 0, 1]), ([2, 0, 0], [0, 0, 1]), ([0, 3, 0], [0, 0, 1])], 0,
     "a triangle", "overconstrained"),
    ("seven hinges", [([0, 0, 0], [0, 0, 1]), ([3, 0, 0], [0, 1, 2]), ([5, 1, 2], [1, 0, 1]), ([4, 4, 3], [2, 1, 0]),
                      ([1, 5, 4], [1, 1, 1]), ([-1, 3, 2], [0, 1, -1]), ([-2, 1, 1], [1, -2, 0])], 1,
     "seven screws that span all six", "joints"),
    ("six hinges", [([0, 0, 0], [0, 0, 1]), ([3, 0, 0], [0, 1, 2]), ([5, 1, 2], [1, 0, 1]), ([4, 4, 3], [2, 1, 0]),
                    ([1, 5, 4], [1, 1, 1]), ([-1, 3, 2], [0, 1, -1])], 0, "six independent screws", "joints"),
]  # fmt: skip


def known_loops(quick: bool) -> Iterator[KnownScene]:
    """Loops with a name."""
    for name, hinges, dof, because, trait in KNOWN[:: 2 if quick else 1]:
        n = len(hinges)
        bodies = ["ground", *(f"link{k}" for k in range(1, n))]
        names = [f"hinge{k}" for k in range(n)]
        joints = [
            {"name": names[k], "type": "revolute", "between": [bodies[k], bodies[(k + 1) % n]], "at": at, "axis": axis}
            for k, (at, axis) in enumerate(hinges)
        ]
        scene = {"bodies": bodies[1:], "constraints": joints}
        yield known_scene(name, scene, because, (trait,), size=n, dof=dof)


def braced_grids(quick: bool) -> Iterator[KnownScene]:
    """m by m squares drawn, some with a diagonal: rows and columns as a graph [BolkerCrapo1977].

    A row and a column are joined where their square is braced; a brace that closes a circle is redundant, and every
    part of the graph turns by itself.
    """
    for m in (2, 3) if quick else (2, 3, 4, 6, 8, 12):
        spots = [(i, j) for i in range(m) for j in range(m)]
        cycle = [(i, i) for i in range(m)] + [(i, (i + 1) % m) for i in range(m)]
        tree = [(i, 0) for i in range(m)] + [(0, j) for j in range(1, m)]
        for name, braced in (
            ("no", []),
            ("all", spots),
            ("a tree of", tree),
            ("a circle of", cycle),
            ("a diagonal of", cycle[:m]),
            ("a corner of", [(i, j) for i, j in spots if i < m // 2 and j < m // 2]),
        ):
            scene, redundant, parts = _grid(m, braced)
            yield known_scene(
                f"{m} by {m} squares, {name} braces",
                scene,
                "Bolker and Crapo 1977: 3 + (parts of the graph of rows and columns) - 1",
                ("special-position",) if redundant else ("plain",),
                size=m,
                dof=3 + parts - 1,
                redundancy=redundant,
            )


def _grid(m: int, braced: Sequence[tuple[int, int]]) -> tuple[dict[str, Any], list[str], int]:
    """(the scene, the braces that close a circle, the parts of the graph of rows and columns)."""
    particles = [{"name": f"p{i}_{j}", "at": [i, j]} for i in range(m + 1) for j in range(m + 1)]
    pairs = [(f"p{i}_{j}", f"p{i + 1}_{j}") for i in range(m) for j in range(m + 1)]
    pairs += [(f"p{i}_{j}", f"p{i}_{j + 1}") for i in range(m + 1) for j in range(m)]
    links: list[dict[str, Any]] = [{"type": "link", "between": list(pair)} for pair in pairs]
    part = {("row", i): ("row", i) for i in range(m)} | {("column", j): ("column", j) for j in range(m)}

    def top(v: tuple[str, int]) -> tuple[str, int]:
        return v if part[v] == v else top(part[v])

    redundant = []
    for i, j in braced:
        name = f"brace{i}_{j}"
        links.append({"name": name, "type": "link", "between": [f"p{i}_{j}", f"p{i + 1}_{j + 1}"]})
        row, column = top(("row", i)), top(("column", j))
        if row == column:
            redundant.append(name)
        part[row] = column
    scene = {"dimension": 2, "particles": particles, "constraints": links}
    return scene, redundant, sum(part[v] == v for v in part)


def triangulated(quick: bool) -> Iterator[KnownScene]:
    """Squares with a diagonal each, of any lengths: rigid, and every square off the border has a link too many."""
    for m in (2, 3) if quick else (2, 3, 4, 8, 16):
        links: list[tuple[str, tuple[int, int], tuple[int, int]]] = []
        first = [(i, j) for j in range(m + 1) for i in (0, 1)]
        for i, j in [*first, *((i, j) for i in range(2, m + 1) for j in range(m + 1))]:
            before = [(i - 1, j), (i, j - 1), (i - 1, j - 1)]
            links += [(f"l{i}_{j}_{k}", (i, j), (a, b)) for k, (a, b) in enumerate(before) if a >= 0 and b >= 0]
        redundant = [name for name, (i, j), _ in links if name.endswith("_2") and i >= 2 and j >= 2]
        for drawn in (False, True):
            for name, chosen, over in (
                ("a diagonal in each", links, redundant),
                ("no more than needed", [link for link in links if link[0] not in redundant], []),
                ("one link less", [link for link in links if link[0] not in redundant][:-1], []),
            ):
                joints = [(i, j) for i in range(m + 1) for j in range(m + 1)]
                particles = [{"name": f"p{i}_{j}", "at": [i, j]} if drawn else f"p{i}_{j}" for i, j in joints]
                constraints = [
                    {"name": label, "type": "link", "between": [f"p{a[0]}_{a[1]}", f"p{b[0]}_{b[1]}"]}
                    for label, a, b in chosen
                ]
                yield known_scene(
                    f"{m} by {m} squares, {name}, {'drawn' if drawn else 'of any lengths'}",
                    {"dimension": 2, "particles": particles, "constraints": constraints},
                    "each joint stands on two of a rigid framework; a third link to it is redundant",
                    ("redundant",) if over else ("plain",),
                    size=m,
                    dof=4 if name == "one link less" else 3,
                    redundancy=over,
                )


FAMILIES = {
    "doors": doors,
    "cranks": cranks,
    "loops of hinges": loops,
    "loops with a name": known_loops,
    "braced grids": braced_grids,
    "triangulated grids": triangulated,
}
