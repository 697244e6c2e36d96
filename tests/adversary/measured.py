"""Drawings rounded to some digits, with a tolerance, and with other relations attached: no less moves than in the
exact one."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene

from .circuits import bricard, dixon, parallel_cranks
from .draws import at, decimal

#: Exact drawings that move more than a count says.
EXACT: tuple[Callable[[random.Random, int], KnownScene], ...] = (parallel_cranks, dixon, bricard)
COUNTED = ("consistent", "dof", "velocity_dof", "redundant_equations")


def rounded(scene: Mapping[str, Any], digits: int, shift: int = 0) -> Mapping[str, Any]:
    """Every place with so many decimals, moved along all axes, and the tolerance that goes with them."""
    particles = [
        {
            **p,
            "at": [decimal(round(Fraction(x) + shift, digits)) for x in p["at"]],
        }
        for p in scene["particles"]
    ]
    return {**scene, "particles": particles, "tolerance": 10.0 ** (1 - digits)}


def _exact(rng: random.Random, size: int) -> KnownScene:
    """A drawing whose freedom is known."""
    while True:
        case = rng.choice(EXACT)(rng, size)
        if "dof" in case.truth:
            return case


def _with(scene: Mapping[str, Any], coordinates: list[str], constraints: list[Any]) -> Mapping[str, Any]:
    more = {"coordinates": coordinates} if coordinates else {}
    return {**scene, **more, "constraints": [*scene["constraints"], *constraints]}


def _counted(truth: Mapping[str, Any]) -> dict[str, Any]:
    return {key: truth[key] for key in COUNTED if key in truth}


def alone(rng: random.Random, size: int) -> KnownScene:
    """The drawing rounded: the exact one is within the tolerance, and what moves there is what was meant."""
    case, digits = _exact(rng, size), rng.randint(5, 9)
    return KnownScene(rounded(case.scene, digits, rng.choice((0, 0, 5))), _counted(case.truth))


def attached(rng: random.Random, size: int) -> KnownScene:
    """The same with a form dr = x_P dq on two more coordinates, or r = x_P + q^2: the first adds 2 freedoms and 1
    velocity, and is non-holonomic where x_P moves; the second adds 1 and 1. Without a reference for q and r the
    drawing is none for all: other assemblies of the same lengths, which are rigid, are parts of the set too."""
    case, digits = _exact(rng, size), rng.randint(5, 9)
    scene = rounded(case.scene, digits) if rng.random() < 0.8 else case.scene
    point, formed = scene["particles"][-1], rng.random() < 0.6
    text = f"rdot = x_{point['name']}*qdot" if formed else f"r = x_{point['name']} + q^2"
    scene = _with(scene, ["q", "r"], [text])
    counted, rigid = _counted(case.truth), case.truth["dof"] - 1
    known = counted | _freedoms(case.truth["dof"], formed)
    if rng.random() < 0.5:
        return KnownScene({**scene, "configuration": at({"q": 0, "r": point["at"][0]})}, known)
    elsewhere = {key: [value] for key, value in _freedoms(rigid, formed).items()} | {"redundant_equations": [0]}
    return KnownScene(scene, known, elsewhere)


def _freedoms(moving: int, formed: bool) -> dict[str, Any]:
    """With the form, or the relation, beside a drawing of so many freedoms."""
    if formed and moving:
        return {"dof": moving + 2, "velocity_dof": moving + 1, "holonomic": False}
    return {"dof": moving + 1, "velocity_dof": moving + 1, "holonomic": True}


def unmeasured(rng: random.Random, size: int) -> KnownScene:
    """A generic framework of triangles, rounded: rigid but for the 3 motions of the plane, and a form that has
    nothing to do with it: 3 more freedoms and 2 velocities."""
    many = 3 + size
    places = {f"P{k}": (Fraction(k), Fraction(k * k, 7) + Fraction(rng.randint(1, 9), 10)) for k in range(many)}
    links = [(f"P{k}", f"P{k + j}") for k in range(many) for j in (1, 2) if k + j < many]
    particles = [{"name": name, "at": [str(x) for x in place]} for name, place in places.items()]
    scene: Mapping[str, Any] = {
        "dimension": 2,
        "particles": particles,
        "constraints": [{"type": "link", "between": [*pair]} for pair in links],
    }
    known = {"consistent": True, "dof": 6, "velocity_dof": 5, "holonomic": False, "redundant_equations": 0}
    return KnownScene(_with(rounded(scene, rng.randint(4, 8)), ["u", "v", "w"], ["du = v*dw"]), known)


FAMILY = {"alone": alone, "attached": attached, "unmeasured": unmeasured}
