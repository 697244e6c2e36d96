"""The same system written in another way: the truth is carried along, and what may change with the writing is dropped.

A disguise takes a random generator and a case, and gives None where it does not fit.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import permutations
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene

from .draws import positive, substituted, texts, words

Disguise = Callable[[random.Random, KnownScene], KnownScene | None]
#: What depends on the order of the constraints: which of them are companions of another, so what it integrates to, too.
ORDERED = ("redundant", "circuit", "independent", "conflicting", "integral")
#: What one constraint alone says.
ALONE = ("exact", "integral", "integrating_factor", "holonomic_alone", "form", "catastatic")
#: Names that no family uses.
NAMES = ("alpha", "beta", "kappa", "xi", "eta", "chi", "r_1", "r_2", "k", "l", "m", "n", "B7", "x_A", "theta", "phi2")


def is_plain(scene: Mapping[str, Any]) -> bool:
    """Coordinates and equations as text, with nothing drawn."""
    return all(isinstance(c, str) or c.get("type") == "equation" for c in scene["constraints"]) and not (
        scene.get("particles") or scene.get("bodies")
    )


def named(scene: Mapping[str, Any], written: Sequence[str]) -> list[dict[str, str]]:
    """Equations under the names that the constraints have."""
    names = [f"c{k + 1}" if isinstance(c, str) else c["name"] for k, c in enumerate(scene["constraints"])]
    return [{"name": name, "type": "equation", "text": text} for name, text in zip(names, written, strict=True)]


def without(truth: Mapping[str, Any], *dropped: str, of: str | None = None) -> Mapping[str, Any]:
    """A truth without some fields: of one entry, or of the report and all entries."""
    return {
        key: value
        for key, value in truth.items()
        if key.rpartition(".")[2] not in dropped or (of is not None and key.rpartition(".")[0] != of)
    }


def speed(name: str) -> str:
    """The velocity of a coordinate: a subscript comes after the dot."""
    stem, underscore, rest = name.partition("_")
    return f"{stem}dot{underscore}{rest}"


def is_equation(text: str) -> bool:
    return "<" not in text and ">" not in text


def is_finite(scene: Mapping[str, Any], text: str) -> bool:
    """No velocity and no differential of a coordinate occurs."""
    moving = {word for c in scene["coordinates"] for word in (f"d{c}", speed(c))}
    return not words(text) & moving


def in_differentials(scene: Mapping[str, Any], text: str) -> bool:
    return bool(words(text) & {f"d{c}" for c in scene["coordinates"]})


# -- names and order -------------------------------------------------------------------------------


def renamed(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """Coordinates with other names."""
    scene = case.scene
    if not is_plain(scene):
        return None
    taken = set().union(*map(words, texts(scene)))
    pool = [name for name in (*NAMES, *(f"q_{k}" for k in range(100))) if name not in taken]
    table = dict(zip(scene["coordinates"], rng.sample(pool, len(scene["coordinates"])), strict=True))
    moving = {f"d{c}": f"d{new}" for c, new in table.items()} | {speed(c): speed(new) for c, new in table.items()}
    written = [substituted(text, {**table, **moving}) for text in texts(scene)]
    changed: dict[str, Any] = {"coordinates": [*table.values()], "constraints": named(scene, written)}
    if "configuration" in scene:
        changed["configuration"] = {table[name]: value for name, value in scene["configuration"].items()}
    return replace(case, scene={**scene, **changed}, chart=None)


def reordered(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """Constraints, and coordinates, in another order."""
    if not is_plain(case.scene):
        return None
    constraints = named(case.scene, texts(case.scene))
    coordinates = list(case.scene["coordinates"])
    rng.shuffle(constraints)
    rng.shuffle(coordinates)
    scene = {**case.scene, "constraints": constraints, "coordinates": coordinates}
    return replace(case, scene=scene, truth=without(case.truth, *ORDERED))


# -- equations -------------------------------------------------------------------------------------


def scaled(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """An equation times a function that is never 0."""
    if not is_plain(case.scene):
        return None
    written = texts(case.scene)
    chosen = [k for k, text in enumerate(written) if is_equation(text)]
    if not chosen:
        return None
    k = rng.choice(chosen)
    factor = rng.choice(
        (positive(rng, case.scene["coordinates"]), positive(rng, case.scene["coordinates"]), "(-5/3)", "exp(t)")
    )
    written[k] = f"{factor}*({_difference(written[k])}) = 0"
    constraints = named(case.scene, written)
    truth = without(case.truth, *ALONE, of=constraints[k]["name"])
    return replace(case, scene={**case.scene, "constraints": constraints}, truth=truth)


def _pairs(scene: Mapping[str, Any], written: Sequence[str]) -> list[tuple[int, int]]:
    """(j, i) where a multiple of equation i may be added to equation j: i is finite, or both are forms of one style."""
    found = []
    equations = [k for k, text in enumerate(written) if is_equation(text)]
    for j, i in permutations(equations, 2):
        alike = in_differentials(scene, written[j]) == in_differentials(scene, written[i])
        if is_finite(scene, written[i]) or (alike and not is_finite(scene, written[j])):
            found.append((j, i))
    return found


def combined(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """To one equation a multiple of another is added: a finite one to a finite one, or a form to a form, or a
    finite one times a differential to a form. The entry of the first then says something else of itself; the system
    does not."""
    scene = case.scene
    written = texts(scene) if is_plain(scene) else []
    pairs = _pairs(scene, written)
    if not pairs:
        return None
    j, i = rng.choice(pairs)
    c = rng.choice(scene["coordinates"])
    factor = rng.choice(("2", "(-1/3)", positive(rng, scene["coordinates"]), c))
    if is_finite(scene, written[i]) and not is_finite(scene, written[j]):
        factor += f"*d{c}" if in_differentials(scene, written[j]) else f"*{speed(c)}"
    written[j] = f"{_difference(written[j])} + {factor}*({_difference(written[i])}) = 0"
    constraints = named(scene, written)
    truth = without(without(case.truth, *ORDERED, "scleronomic"), *ALONE, "holonomic", of=constraints[j]["name"])
    if any("t" in words(text) for text in written):  # a factor of time is a factor no longer
        truth = without(truth, "growth_vector")
    return replace(case, scene={**scene, "constraints": constraints}, truth=truth)


def _difference(text: str) -> str:
    """Left less right."""
    left, _, right = text.partition("=")
    return f"{left.strip()} - ({right.strip() or '0'})"


# -- coordinates -----------------------------------------------------------------------------------


def _replaced(
    case: KnownScene, table: Mapping[str, str], speeds: Mapping[str, str], reference: Mapping[str, Fraction]
) -> KnownScene:
    """Coordinates replaced by functions of coordinates. ``speeds``: their velocities, in names that end in ``dot``; the
    reference in the new coordinates."""
    scene = case.scene
    every = {f"{c}dot": f"d{c}" for c in scene["coordinates"]}
    moving = {f"{c}dot": f"({text})" for c, text in speeds.items()}
    moving |= {f"d{c}": f"({substituted(text, every)})" for c, text in speeds.items()}
    inner = {c: f"({text})" for c, text in table.items()}
    written = [substituted(text, {**inner, **moving}) for text in texts(scene)]
    changed: dict[str, Any] = {"constraints": named(scene, written)}
    if "configuration" in scene:
        changed["configuration"] = {**scene["configuration"], **{c: str(v) for c, v in reference.items()}}
    return replace(case, scene={**scene, **changed}, chart=None)


def _two(rng: random.Random, case: KnownScene) -> tuple[str, str] | None:
    """Two coordinates of a plain scene without subscripts, of which something is written."""
    if (
        not is_plain(case.scene)
        or any("_" in c for c in case.scene["coordinates"])
        or len(case.scene["coordinates"]) < 2
    ):
        return None
    x, y = rng.sample(list(case.scene["coordinates"]), 2)
    return x, y


def _place(case: KnownScene, *names: str) -> list[Fraction]:
    configuration = case.scene.get("configuration", {})
    return [Fraction(str(configuration.get(name, 0))) for name in names]


def moved(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """Two coordinates turned by a rational angle, with another origin."""
    pair = _two(rng, case)
    if pair is None:
        return None
    (x, y), (a, b) = pair, (rng.randint(-2, 2), rng.randint(-2, 2))
    c, s = rng.choice(
        ((Fraction(3, 5), Fraction(4, 5)), (Fraction(5, 13), Fraction(-12, 13)), (Fraction(0), Fraction(1)))
    )
    table = {x: f"({c})*{x} - ({s})*{y} + ({a})", y: f"({s})*{x} + ({c})*{y} + ({b})"}
    speeds = {x: f"({c})*{x}dot - ({s})*{y}dot", y: f"({s})*{x}dot + ({c})*{y}dot"}
    u, v = (value - shift for value, shift in zip(_place(case, x, y), (a, b), strict=True))
    return _replaced(case, table, speeds, {x: c * u + s * v, y: c * v - s * u})


def sheared(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """x + k y^m for x."""
    pair = _two(rng, case)
    if pair is None:
        return None
    (x, y), k, m = pair, rng.choice((1, -2, 3)), rng.choice((1, 2, 3))
    slope = f"({k * m})*{y}^{m - 1}" if m > 1 else f"({k})"
    (u, v) = _place(case, x, y)
    return _replaced(case, {x: f"{x} + ({k})*{y}^{m}"}, {x: f"{x}dot + {slope}*{y}dot"}, {x: u - k * v**m})


def stretched(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """x (1 + y^2) for x."""
    pair = _two(rng, case)
    if pair is None:
        return None
    x, y = pair
    u, v = _place(case, x, y)
    speed = f"{x}dot*(1 + {y}^2) + 2*{x}*{y}*{y}dot"
    return _replaced(case, {x: f"{x}*(1 + {y}^2)"}, {x: speed}, {x: u / (1 + v * v)})


def split(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """A new coordinate s = x + k y, written first, and x in one of the equations given by it."""
    pair = _two(rng, case)
    if pair is None or "s0" in case.scene["coordinates"]:
        return None
    (x, y), k = pair, rng.choice((1, -1, 2))
    written = texts(case.scene)
    chosen = [i for i, text in enumerate(written) if {x, f"{x}dot", f"d{x}"} & words(text)]
    if not chosen:
        return None
    i = rng.choice(chosen)
    table = {x: f"(s0 - ({k})*{y})", f"{x}dot": f"(s0dot - ({k})*{y}dot)", f"d{x}": f"(ds0 - ({k})*d{y})"}
    written[i] = substituted(written[i], table)
    constraints = named(case.scene, written)
    truth = without(without(case.truth, *ORDERED), *ALONE, of=constraints[i]["name"])
    first = {"name": "splitting", "type": "equation", "text": f"s0 = {x} + ({k})*{y}"}
    scene = {**case.scene, "coordinates": [*case.scene["coordinates"], "s0"], "constraints": [first, *constraints]}
    if "configuration" in scene:
        u, v = _place(case, x, y)
        scene["configuration"] = {**case.scene["configuration"], "s0": str(u + k * v)}
    return replace(case, scene=scene, truth=without(truth, "growth_vector"), chart=None)


def turned(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """A drawing turned by a rational angle about z, in space about x too, and moved."""
    scene = case.scene
    if is_plain(scene) or scene.get("dimension", 1) == 1 or any(isinstance(c, str) for c in scene["constraints"]):
        return None
    d, shift = scene["dimension"], [rng.randint(-3, 3) for _ in range(3)]

    def placed(vector: Sequence[Any], by: Sequence[int]) -> list[str]:
        x, y, *rest = map(Fraction, vector)
        x, y = Fraction(3, 5) * x - Fraction(4, 5) * y, Fraction(4, 5) * x + Fraction(3, 5) * y
        if rest:
            y, rest = (
                Fraction(5, 13) * y - Fraction(12, 13) * rest[0],
                [Fraction(12, 13) * y + Fraction(5, 13) * rest[0]],
            )
        return [str(v + s) for v, s in zip((x, y, *rest), by, strict=False)]

    def drawn(part: Any) -> Any:
        if isinstance(part, str):
            return part
        moves = {"at": shift[:d], "axis": [0, 0, 0]}
        moved = {key: placed(value, moves[key]) if key in moves else value for key, value in part.items()}
        if "axes" in part:
            moved["axes"] = [placed(axis, [0, 0, 0]) for axis in part["axes"]]
        if "between" in part:
            moved["between"] = [placed(end, shift) if isinstance(end, list) else drawn(end) for end in part["between"]]
        return moved

    try:
        parts = {key: [drawn(part) for part in scene[key]] for key in ("particles", "constraints") if key in scene}
    except ValueError:  # a position is an expression
        return None
    return replace(case, scene={**scene, **parts})


# -- more beside it --------------------------------------------------------------------------------

#: Coordinates with a reference, constraints, and what they add: freedom, velocities, equations too many.
BESIDE: tuple[tuple[dict[str, int], tuple[str, ...], tuple[int, int, int]], ...] = (
    ({"e1": 1}, (), (1, 1, 0)),
    ({"e1": 3, "e2": 4}, ("e1^2 + e2^2 = 25",), (1, 1, 0)),
    ({"e1": 0, "e2": 1, "e3": 2}, ("e1dot = e2*e3dot",), (3, 2, 0)),
    ({"e1": 2, "e2": 2}, ("e1 = e2", "3*e1 = 3*e2"), (1, 1, 1)),
    ({"e1": 1, "e2": 1}, ("e1 = 1", "e2 = e1^2"), (0, 0, 0)),
)


def accompanied(rng: random.Random, case: KnownScene) -> KnownScene | None:
    """With a system beside it that has nothing to do with it."""
    scene, truth = case.scene, dict(case.truth)
    if "e1" in scene.get("coordinates", ()):
        return None
    place, written, (dof, velocities, extra) = rng.choice(BESIDE)
    more = [{"name": f"beside{k}", "type": "equation", "text": text} for k, text in enumerate(written)]
    changed: dict[str, Any] = {
        "coordinates": [*scene.get("coordinates", ()), *place],
        "constraints": [*scene["constraints"], *more],
    }
    if not is_plain(scene) or "configuration" in scene:
        given = scene.get("configuration", {})
        changed["configuration"] = {**given, **{name: str(value) for name, value in place.items()}}
    added = {"dof": dof, "velocity_dof": velocities, "instantaneous_dof": velocities, "redundant_equations": extra}
    if extra and truth.get("redundant_equations") == 0:
        # A count that is never below 0 may stand for one that would be: at a singular drawing more freedom is lost
        # than there are rows.
        del truth["redundant_equations"]
    if truth.get("consistent") is not False:
        truth = {key: value + added[key] if key in added else value for key, value in truth.items()}
        if "redundant" in truth and extra:
            truth["redundant"] = [*truth["redundant"], f"beside{len(written) - 1}"]
        if "holonomic" in truth:
            truth["holonomic"] = truth["holonomic"] and dof == velocities
    else:
        truth = {"consistent": False, "dof": None, "velocity_dof": None}
    elsewhere = {key: [v + added.get(key, 0) for v in values] for key, values in case.elsewhere.items()}
    return KnownScene({**scene, **changed}, without(truth, "growth_vector"), elsewhere)


DISGUISES: Mapping[str, Disguise] = {
    "renamed": renamed,
    "reordered": reordered,
    "scaled": scaled,
    "combined": combined,
    "moved": moved,
    "sheared": sheared,
    "stretched": stretched,
    "split": split,
    "turned": turned,
    "accompanied": accompanied,
}
