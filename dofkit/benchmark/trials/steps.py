"""Forms a tiny exact step away from integrable ones, each beside an integrable twin of the same size."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene, scene_of

#: The sizes of the step, as a person writes them.
STEPS = ("1e-6", "1e-12", "1e-30", "1/7000000000000000000")
XYZ = ("x", "y", "z")

#: One form: coordinates, the text with {e} for the step, integrable?
#: In three variables d(omega) ^ omega = (a (c_y - b_z) + b (a_z - c_x) + c (b_x - a_y)) dx dy dz.
FORMS: list[tuple[str, tuple[str, ...], str, bool]] = [
    ("a step to a contact form", XYZ, "dz + {e} y dx", False),
    ("a step that is exact", XYZ, "dz + {e} (y dx + x dy)", True),
    ("a step off d(xy + z)", XYZ, "y dx + x dy + dz + {e} x dy", False),
    ("a step along dz", XYZ, "y dx + x dy + dz + {e} z dz", True),
    ("a swirl on d(xy + z)", XYZ, "y dx + x dy + dz + {e} (x dy - y dx)", False),
    ("exp(x) dz and a step", XYZ, "exp(x) dz + {e} y dx", False),
    ("exp(x) dz and a step in x", XYZ, "exp(x) dz + {e} x dx", True),
    ("a swirl on a sphere", XYZ, "x dx + y dy + z dz + {e} (x dy - y dx)", False),
    ("an ellipsoid near a sphere", XYZ, "x dx + y dy + z dz + {e} (x dx + 3 z dz)", True),
    ("cyclic with a step", XYZ, "y z dx + x z dy + x y dz + {e} x^2 dy", False),
    ("cyclic with its own factor", XYZ, "(1 + {e} x)*(y z dx + x z dy + x y dz)", True),
    ("a pole of a tiny slope", XYZ, "sin(x) dy + {e} dz", False),
    ("sines that close", XYZ, "sin(x) dx + {e} cos(z) dz + {e} dy", True),
    ("Heisenberg with a tiny area", XYZ, "dz - {e} (x dy - y dx)", False),
    ("a helix of tiny pitch", ("x", "y", "theta"), "sin(theta) dx - cos(theta) dy + {e} dtheta", False),
    ("a sleigh on a nearly straight track", ("x", "y", "theta"), "dy - {e} theta dx", False),
    ("a sleigh on a fixed curve", ("x", "y", "theta"), "dy - {e} x^3 dx", True),
    ("five variables", ("x", "y", "z", "u", "v"), "dz - y dx - {e} v du", False),
    ("five variables, the step exact", ("x", "y", "z", "u", "v"), "dz - y dx - x dy - {e} v^2 dv - {e} du", True),
]  # fmt: skip

#: Several rows: coordinates, rows, dof, velocity_dof, whether every row is holonomic (None: not asked).
SYSTEMS: list[tuple[str, tuple[str, ...], tuple[str, ...], int, int, tuple[bool, ...]]] = [
    ("a disc of tiny radius", ("x", "y", "theta", "phi"),
     ("dx = {e} cos(theta) dphi", "dy = {e} sin(theta) dphi"), 4, 2, (False, False)),
    ("a tiny disc on a straight line", ("x", "y", "theta", "phi"),
     ("dx = {e} cos(1) dphi", "dy = {e} sin(1) dphi"), 2, 2, (True, True)),
    ("a tiny disc on a given curve", ("x", "y", "phi"),
     ("dx = {e} cos(phi) dphi", "dy = {e} sin(phi) dphi"), 1, 1, (True, True)),
    ("two contact forms with one curvature", ("x", "y", "z", "w"),
     ("dz - {e} y dx = 0", "dw - y dx = 0"), 3, 2, (False, False)),
    ("two exact forms", ("x", "y", "z", "w"), ("dz - {e} x dx = 0", "dw - y dy = 0"), 2, 2, (True, True)),
    ("two forms that part at third order", ("x", "y", "z", "w"),
     ("dz - y dx = 0", "dw - (1 + {e} x) y dx = 0"), 4, 2, (False, False)),
    ("the same without parting", ("x", "y", "z", "w"),
     ("dz - y dx = 0", "dw - (1 + {e}) y dx = 0"), 3, 2, (False, False)),
    ("a contact form on a tiny slope", XYZ, ("z = {e} x", "dz - y dx = 0"), 1, 1, (True, True)),
    ("planes that nearly coincide", XYZ, ("x = 0", "x + {e} y = 0"), 1, 1, (True, True)),
    ("planes that do coincide", XYZ, ("x = 0", "(1 + {e}) x = 0"), 2, 2, (True, True)),
    ("three nearly parallel planes", XYZ, ("x = 0", "x + {e} y = 0", "x + {e} z = 0"), 0, 0, (True, True, True)),
    ("a circle of tiny radius", XYZ, ("x^2 + y^2 = {e}^2",), 2, 2, (True,)),
    ("a tiny Chaplygin sleigh", ("x", "y", "theta"),
     ("dx = {e} cos(theta) dtheta", "dy = {e} sin(theta) dtheta"), 1, 1, (True, True)),
]  # fmt: skip

#: Relations that miss each other by the step.
GAPS: list[tuple[str, tuple[str, ...]]] = [
    ("parallel lines", ("x + y = 1", "x + y = 1 + {e}")),
    ("concentric circles", ("x^2 + y^2 = 1", "x^2 + y^2 = 1 + {e}")),
    ("a height that is and is not", ("z = 0", "z = {e}")),
    ("an angle that is and is not", ("sin(x) = 1/2", "sin(x) = 1/2 + {e}")),
]
#: Steps that can be told from 0 in the relations above as a person writes them.
TIMED: list[tuple[str, str, bool]] = [
    ("a drift", "dx + {e} dt = 0", False),
    ("a drift that cancels", "dx + {e} (sin(t)^2 + cos(t)^2 - 1) dt = 0", True),
    ("a tiny turn", "dx + {e} t dy = 0", False),
    ("a factor of time", "(1 + {e} t^2)*(dx + {e} y dy) = 0", True),
]


def tiny_steps() -> Iterator[KnownScene]:
    """Every base form and system with every step."""
    for step in STEPS:
        for name, coordinates, text, integrable in FORMS:
            n = len(coordinates)
            truth = {"dof": n - 1 if integrable else n, "velocity_dof": n - 1, "holonomic": integrable}
            label = {"c1.holonomic": integrable, "c1.holonomic_alone": integrable}
            yield _trial(name, step, coordinates, (f"{text} = 0",), {**truth, **label})
        for name, coordinates, rows, dof, velocity_dof, holonomic in SYSTEMS:
            truth = {"dof": dof, "velocity_dof": velocity_dof, "consistent": True}
            labels = {f"c{i + 1}.holonomic": value for i, value in enumerate(holonomic)}
            yield _trial(name, step, coordinates, rows, {**truth, **labels})
        for name, rows in GAPS:
            yield _trial(name, step, XYZ, rows, {"consistent": False, "dof": None, "conflicting": ["c1", "c2"]})
        for name, text, still in TIMED:
            yield _trial(name, step, XYZ, (text,), {"scleronomic": still, "c1.scleronomic": still})


def _trial(
    name: str,
    step: str,
    coordinates: tuple[str, ...],
    rows: tuple[str, ...],
    truth: dict[str, Any],
) -> KnownScene:
    texts = [row.replace("{e}", f"({step})") for row in rows]
    return KnownScene(scene_of(coordinates, *texts), truth, name=f"{name}, by {step}", group=name)
