"""Mechanisms drawn at random: trees add their freedoms up, loops and bars are counted by an exact rank."""

from __future__ import annotations

import random
from collections.abc import Iterator

from dofkit.benchmark.trials.construction import KnownScene, every, known_scene, numbered
from dofkit.benchmark.trials.random_systems import dependent, graph, loop, tree


def trees(quick: bool) -> Iterator[KnownScene]:
    """Joints of every type, each body on one before it; and one of the joints written again."""
    for d, n in ((d, n) for n in ((1, 2) if quick else (1, 2, 4, 8, 16)) for d in (2, 3)):
        for seed in range(1 if quick or n > 4 else 2):
            rng = random.Random(f"tree {d} {n} {seed}")
            made = tree(rng, d, n)
            joints = made.scene["constraints"]
            again = {**rng.choice(joints), "name": "again"}
            for name, constraints, over in (("", joints, []), (", one joint twice", [*joints, again], ["again"])):
                yield known_scene(
                    f"{n} bodies in dimension {d}, {seed}{name}",
                    {**made.scene, "constraints": constraints},
                    "the freedoms of the joints of a tree add up; a joint written again adds nothing",
                    ("redundant",) if over else ("joints",),
                    size=n,
                    dof=made.dof,
                    redundancy=over,
                )


def loops(quick: bool) -> Iterator[KnownScene]:
    """Closed loops of joints of every type, where their screws span all or are independent."""
    for d, n in ((d, n) for n in ((1, 2) if quick else (1, 2, 3, 4, 5, 6)) for d in (2, 3)):
        for seed in range(2 if quick else 4):
            made = loop(random.Random(f"loop {d} {n} {seed}"), d, n)
            if made.dof is not None:
                yield known_scene(
                    f"{n} bodies in dimension {d}, {seed}",
                    made.scene,
                    "rates whose screws cancel, by the exact rank: regular where they span all, none where independent",
                    ("joints",),
                    size=n,
                    dof=made.dof,
                )


def bars(quick: bool) -> Iterator[KnownScene]:
    """Random bars between joints at random places, some pairs twice: the exact rank."""
    for d, n in ((d, n) for n in ((4, 5) if quick else (4, 6, 8, 12, 16)) for d in (1, 2, 3)):
        for seed in range(1 if quick else 2):
            drawn = graph(random.Random(f"bars {d} {n} {seed}"), d, n, twice=True)
            yield known_scene(
                f"{n} joints in dimension {d}, {seed}",
                drawn.scene(),
                "the rank of the rigidity matrix over the rationals, at places in general position",
                ("redundant",) if dependent(drawn) else ("plain",),
                size=n,
                dof=drawn.by_rank(),
                redundancy=[f"bar{i}" for i in dependent(drawn)],
            )


def rolling(quick: bool) -> Iterator[KnownScene]:
    """Balls that roll on a plane, where nothing integrates, and discs that roll on a line, where all does."""
    for n in (1, 2) if quick else (1, 2, 4, 8):
        bodies = [f"b{k}" for k in range(n)]
        rolls = [{"type": "roll", "body": body, "radius": f"{k + 1}"} for k, body in enumerate(bodies)]
        held = [{"type": "equation", "text": f"y_b{k} = {k}"} for k in range(n)]
        for name, d, constraints, dof, labels in (
            ("balls on a plane", 3, rolls, 5 * n, every(numbered(n), False)),
            ("discs on a line", 2, rolls, n, every(numbered(n), True)),
            ("balls along lines", 3, [*rolls, *held], 4 * n, None),
        ):
            yield known_scene(
                f"{n} {name}",
                {"dimension": d, "bodies": bodies, "constraints": constraints},
                "a ball reaches every place and every turn; a disc on a line is where its angle says",
                ("rolling", "many-blocks") if n > 1 else ("rolling",),
                size=n,
                dof=dof,
                integrability=labels,
            )


FAMILIES = {"trees of bodies": trees, "loops of bodies": loops, "random bars": bars, "rolling": rolling}
