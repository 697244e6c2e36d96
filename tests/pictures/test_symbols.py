"""Every constraint type has a textbook symbol, and one scene of each is drawn with it."""

from __future__ import annotations

from typing import Any, get_args

import pytest

import dofkit
from dofkit.scene.constraints import TYPES
from dofkit.scene.symbols import Run, Symbol

O2, O3, X, Z = [0, 0], [0, 0, 0], [1, 0, 0], [0, 0, 1]
PLANE: dict[str, dict[str, Any]] = {
    "equation": {"text": "x_P^2 + y_P^2 = 25"},
    "on": {"members": ["P"], "surface": "x^2 + y^2 = 25"},
    "link": {"between": [O2, "P"]},
    "rigid": {"members": ["P", "Q"]},
    "fixed": {"point": "P"},
    "revolute": {"between": ["ground", "a"], "at": O2},
    "prismatic": {"between": ["ground", "a"], "axis": [1, 1]},
    "weld": {"between": ["ground", "a"]},
    "coincident": {"between": ["P", {"on": "a", "at": [3, 4]}]},
    "slot": {"point": "P", "body": "ground", "axis": [1, 1]},
    "roll": {"body": "a", "radius": 2},
    "string": {"along": [O2, [4, 0], "P"]},
    "gear": {"between": ["a", "b"], "ratio": -2},
    "cam": {"point": "P", "body": "a", "curve": "x^2 + y^2 = 25"},
    "coupling": {"joints": ["u", "v"], "text": "v = 2 u"},
}
SPACE: dict[str, dict[str, Any]] = {
    "equation": {"text": "x_P^2 + y_P^2 + z_P^2 = 25"},
    "on": {"members": ["P"], "curve": ["x^2 + y^2 + z^2 = 25", "z = 0"]},
    "link": {"between": [O3, "P"]},
    "rigid": {"members": ["P", "Q"]},
    "fixed": {"point": "P"},
    "revolute": {"between": ["ground", "a"], "at": O3, "axis": Z},
    "prismatic": {"between": ["ground", "a"], "axis": X},
    "weld": {"between": ["ground", "a"]},
    "cylindrical": {"between": ["ground", "a"], "at": O3, "axis": Z},
    "screw": {"between": ["ground", "a"], "at": O3, "axis": Z, "pitch": 1},
    "universal": {"between": ["ground", "a"], "at": O3, "axes": [X, Z]},
    "spherical": {"between": ["ground", "a"], "at": O3},
    "planar": {"between": ["ground", "a"], "at": O3, "axis": Z},
    "coincident": {"between": ["P", {"on": "a", "at": [3, 4, 0]}]},
    "slot": {"point": "P", "body": "ground", "axis": X},
    "roll": {"body": "a", "radius": 2},
    "string": {"along": [O3, [4, 0, 0], "P"]},
    "coupling": {"joints": ["u", "v"], "text": "v = 2 u"},
}
CASES = [(2, kind) for kind in PLANE] + [(3, kind) for kind in SPACE]


def scene(dimension: int, kind: str) -> dict[str, Any]:
    place = [3, 4, 0][:dimension]
    fields = (PLANE if dimension == 2 else SPACE)[kind]
    return {
        "dimension": dimension,
        "particles": [{"name": "P", "at": place}, {"name": "Q", "at": [4, 4, 0][:dimension]}],
        "bodies": ["a", "b"],
        "constraints": [{"name": "it", "type": kind, **fields}, *(_joints(dimension) if "joints" in fields else ())],
    }


def _joints(dimension: int) -> list[dict[str, Any]]:
    """Two hinges, named u and v."""
    turning = {"type": "revolute", **({"axis": Z} if dimension == 3 else {})}
    first, second = [0, 0, 0][:dimension], [2, 0, 0][:dimension]
    return [
        {"name": "u", "between": ["ground", "a"], "at": first, **turning},
        {"name": "v", "between": ["a", "b"], "at": second, **turning},
    ]


@pytest.mark.parametrize("kind", TYPES)
def test_every_type_declares_a_symbol(kind: str) -> None:
    symbol = getattr(TYPES[kind], "symbol", None)
    assert isinstance(symbol, Symbol), f"{TYPES[kind].__name__} says not how it is drawn: give it a `symbol`"
    assert symbol.run in get_args(Run)
    if not symbol.run:
        assert bool(symbol.plane) == (2 in TYPES[kind].dimensions)
        assert bool(symbol.space) == (3 in TYPES[kind].dimensions)


def test_every_type_is_drawn_here_in_every_dimension_of_it() -> None:
    assert {(d, kind) for kind, cls in TYPES.items() for d in cls.dimensions if d > 1} == set(CASES)


@pytest.mark.parametrize(("dimension", "kind"), CASES)
def test_a_scene_of_each_type_shows_its_symbol(dimension: int, kind: str) -> None:
    sketch = dofkit.draw(scene(dimension, kind)).sketch
    own = [s for s in sketch.shapes if s.owner == "it" and s.kind != "words"]
    wheels = [s for s in sketch.shapes if s.role == "body" and s.owner in ("a", "b") and s.kind == "area"]
    assert own or wheels


def test_symbols_stand_where_the_joints_are() -> None:
    sketch = dofkit.draw("four-bar-linkage").sketch
    pins = {s.owner: tuple(map(float, sketch.at(s.vertices[0]))) for s in sketch.shapes if s.kind == "ball"}
    assert pins == {"A": (0, 0, 0), "B": (0, 2, 0), "C": (4, 3, 0), "D": (5, 0, 0)}
