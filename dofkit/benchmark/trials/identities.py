"""Expressions that are zero by an identity that is hard to see, and near misses, in scenes that depend on the zero.

Each trap is put into several contexts, where the freedom, a label or a redundancy depends on whether it is zero. There
are also forms and equations a tiny exact step away from integrable, dependent or consistent ones.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene, Row, known_scene, labels, scene_of, tables

TABLES = tables("identities.yaml")


@dataclass(frozen=True)
class Trap:
    """An expression that vanishes identically where it is defined, in the coordinates and parameters ``names``.

    Each of ``misses`` differs from it by a constant that is not 0, or by a sign, and is zero at single points at most.
    ``never``: those near misses vanish nowhere, so that setting them to 0 is a contradiction.
    """

    name: str
    zero: str
    sign: str | None = None
    names: str = ""
    never: bool = True

    @property
    def tiny(self) -> tuple[str, ...]:
        """The identity plus constants that are too small for floating point."""
        return tuple(f"{self.zero} + {e}" for e in ("1e-9", "1e-25"))

    @property
    def misses(self) -> tuple[str, ...]:
        """Every near miss: by a tiny constant, and by a sign."""
        return (*self.tiny, *((self.sign,) if self.sign else ()))

    @property
    def everywhere(self) -> bool:
        """Whether the trap has a value for all coordinates; if not, an equation with it also restricts these."""
        return not self.coordinates or not any(f"{name}(" in self.zero for name in ("log", "asin", "acos"))

    @property
    def coordinates(self) -> list[str]:
        """The coordinates in the trap."""
        return [name for name in self.names if name in "wv"]

    @property
    def parameters(self) -> list[str]:
        """The positive parameters in the trap."""
        return [name for name in self.names if name in "ab"]


TRAPS = [Trap(**row) for row in (*TABLES["numbers"], *TABLES["functions"])]
#: Expressions that are not zero, but are easily taken for zero.
NOT_ZERO = [Trap(row["name"], row["zero"], None, row["names"], "^" not in row["zero"]) for row in TABLES["not zero"]]

# Contexts: T is the trap's text, n the number of coordinates

#: Returns the known scene with the text T of a trap, which is zero or not; None if the trap does not fit.
Context = Callable[[Trap, str, bool], KnownScene | None]


def _in_text(row: Row) -> Context:
    """Return the context of a table's row: equations with {T}, and the truth if T is zero and if it is not."""
    contradictory = row["other"].get("consistent") is False
    finite = not any("dz" in text for text in row["rows"])

    def scene_with_trap(trap: Trap, t: str, zero: bool) -> KnownScene | None:
        """Return the scene of the row with T = ``t``, which is 0 if ``zero``; None if T may contradict or not.

        Whole numbers in the table are counted from the number of coordinates.
        """
        if contradictory and not zero and not trap.never:
            return None
        n = 3 + len(trap.coordinates)
        truth = {
            key: n + value if isinstance(value, int) and not isinstance(value, bool) else value
            for key, value in row["zero" if zero else "other"].items()
        }
        if finite and not trap.everywhere:  # the equation also states that T has a value
            truth.pop("redundant", None)
        return _scene_of_trap(trap, t, [text.replace("{T}", t) for text in row["rows"]], truth)

    return scene_with_trap


def _scene_of_trap(trap: Trap, t: str, texts: Sequence[str], truth: Mapping[str, Any]) -> KnownScene:
    parameters = dict.fromkeys(trap.parameters, "positive") or None
    scene = scene_of(["x", "y", "z", *trap.coordinates], *texts, parameters=parameters)
    return KnownScene(scene, truth, name=f"{t} in {'; '.join(texts)}", group=trap.name)


def with_time(trap: Trap, t: str, zero: bool) -> KnownScene | None:
    """Return dx + T dt = 0, which is scleronomic where T = 0."""
    if trap.coordinates:
        return None
    truth = {"dof": 2, "velocity_dof": 2, "scleronomic": zero, "c1.scleronomic": zero, "c1.catastatic": zero}
    return _scene_of_trap(trap, t, [f"dx + ({t})*dt = 0"], truth)


def triangle(trap: Trap, t: str, zero: bool) -> KnownScene | None:
    """Return three links whose joints lie in a line where T = 0: rigid, with an infinitesimal motion."""
    if trap.names:
        return None
    places = {"A": [0, 0], "B": [1, 0], "C": [2, t]}
    scene = {
        "dimension": 2,
        "particles": [{"name": name, "at": at} for name, at in places.items()],
        "constraints": [{"type": "link", "between": pair} for pair in (["A", "B"], ["B", "C"], ["A", "C"])],
    }
    truth = {"dof": 3, "velocity_dof": 3, "instantaneous_dof": 4 if zero else 3, "singular": zero}
    return KnownScene(scene, truth, name=f"a triangle of height {t}", group=trap.name)


CONTEXTS: tuple[Context, ...] = (*map(_in_text, TABLES["contexts"]), with_time, triangle)


# Tiny steps

STEPPED = "a step is exact, however small"
#: The sizes of the step, as a person writes them.
STEPS = ("1e-6", "1e-12", "1e-30", "1/7000000000000000000")


def tiny_steps() -> Iterator[KnownScene]:
    """Forms and equations a tiny exact step away from integrable, dependent or consistent ones."""
    for step in STEPS:
        for row in TABLES["forms"]:
            n, integrable = len(row["coordinates"].split()), row["integrable"]
            truth = {"dof": n - 1 if integrable else n, "velocity_dof": n - 1, "holonomic": integrable}
            truth |= {"c1.holonomic": integrable, "c1.holonomic_alone": integrable}
            yield _stepped(row, step, [f"{row['text']} = 0"], truth)
        for row in TABLES["systems"]:
            truth = {"dof": row["dof"], "velocity_dof": row["velocity_dof"], "consistent": True}
            truth |= {f"{name}.holonomic": value for name, value in (labels(row["holonomic"]) or {}).items()}
            yield _stepped(row, step, row["rows"], truth)
        for row in TABLES["gaps"]:
            yield _stepped(row, step, row["rows"], {"consistent": False, "dof": None, "conflicting": ["c1", "c2"]})
        for row in TABLES["drifts"]:
            truth = {"scleronomic": row["scleronomic"], "c1.scleronomic": row["scleronomic"]}
            yield _stepped(row, step, [row["text"]], truth)


def _stepped(row: Mapping[str, Any], step: str, rows: Sequence[str], truth: dict[str, Any]) -> KnownScene:
    texts = [text.replace("{e}", f"({step})") for text in rows]
    scene = scene_of(row.get("coordinates", "x y z"), *texts)
    return KnownScene(scene, truth, name=f"{row['name']}, by {step}", group=row["name"], because=STEPPED)


# Families


def in_contexts(trap: Trap, text: str, zero: bool) -> Iterator[KnownScene]:
    """Yield the scenes of the trap in every context that fits."""
    because = "zero by an identity" if zero else "an identity missed by a constant, or by a sign"
    for context in CONTEXTS:
        if (scene := context(trap, text, zero)) is not None:
            yield replace(scene, because=because)


def identities() -> Iterator[KnownScene]:
    """Zero by an identity, or missed by a constant that floating point does not see, or by a sign."""
    for trap in TRAPS:
        yield from in_contexts(trap, trap.zero, True)
        yield from near_misses(trap)
    for trap in NOT_ZERO:
        yield from in_contexts(trap, trap.zero, False)


def near_misses(trap: Trap) -> Iterator[KnownScene]:
    """Yield the scenes of every near miss of the trap, which is not zero, in every context."""
    for text in trap.misses:
        yield from in_contexts(trap, text, False)


def bases() -> Iterator[KnownScene]:
    """Powers to different bases in the coefficients of forms."""
    for row in TABLES["bases"]:
        zero = row["zero"]
        trap = Trap(row["name"], zero, None, "w")
        for text in (zero, f"{zero} + 1e-12", f"{zero} + 1"):
            yield from in_contexts(trap, text, text == zero)
    for power in (2, 3, 5, 8, 12):
        for name, second, dof, because in (
            (f"a factor 2^({power} x)", "dy", 2, "dz + dy"),
            (f"a contact form by 2^({power} x)", "y dx", 3, "dz + y dx"),
        ):
            contact = scene_of("x y z", f"({2**power})^x dz + 2^({power} x) {second} = 0")
            about = name, contact, f"over the factor: {because}"
            yield known_scene(*about, dof=dof, integrability={"c1": dof == 2})


FAMILIES = {"identities": identities, "tiny steps": tiny_steps, "mixed bases": bases}
