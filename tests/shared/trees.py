"""Trees of joints in space, drawn anyhow, with loops on them; their freedom is known."""

from __future__ import annotations

import random
from itertools import pairwise
from typing import Any

FREEDOMS = {"revolute": 1, "prismatic": 1, "cylindrical": 2, "universal": 2, "spherical": 3, "planar": 3}


def tree_with_loops(bodies: int, loops: int, seed: int) -> tuple[dict[str, Any], int]:
    """A tree of joints drawn anyhow, with planar four-bars on some bodies, in any order; and its freedom: that of
    every joint, and one for each four-bar, whose hinges are parallel and whose links are no parallelogram."""
    rng = random.Random(f"tree {seed}")
    names, places = ["ground"], {"ground": (0, 0, 0)}
    joints: list[dict[str, Any]] = []
    dof = loops
    for i in range(bodies):
        parent = rng.choice(names[-8:])
        at = tuple(v + rng.randint(-3, 3) for v in places[parent])
        kind = rng.choice(sorted(FREEDOMS))
        dof += FREEDOMS[kind]
        joint: dict[str, Any] = {"name": f"j{i}", "type": kind, "between": [parent, f"b{i}"]}
        if kind != "prismatic":
            joint["at"] = list(at)
        if kind == "universal":
            joint["axes"] = rng.choice([[[1, 0, 0], [0, 1, 0]], [[0, 0, 1], [3, 4, 0]]])
        elif kind != "spherical":
            joint["axis"] = rng.choice([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 2, 2], [3, 4, 0]])
        joints.append(joint)
        names.append(f"b{i}")
        places[f"b{i}"] = (at[0], at[1], at[2])
    for k in range(loops):
        host, origin = rng.choice(names[1:]), [rng.randint(-5, 5) for _ in range(3)]
        links = [f"q{k}{letter}" for letter in "abc"]
        pins = zip(pairwise([host, *links, host]), [(0, 0), (1, 2), (5, 3), (4, 0)], strict=True)
        for pair, (x, y) in pins:
            at_pin = [origin[0] + x, origin[1] + y, origin[2]]
            joints.append({"type": "revolute", "between": list(pair), "at": at_pin, "axis": [0, 0, 1]})
            joints[-1]["name"] = f"p{len(joints)}"
        names += links
    rng.shuffle(joints)
    return {"bodies": names[1:], "constraints": joints}, dof
