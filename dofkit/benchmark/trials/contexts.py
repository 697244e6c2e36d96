"""Traps in context: an expression T that is zero, or nearly is, decides something."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from dofkit.benchmark.trials.construction import KnownScene, scene_of
from dofkit.benchmark.trials.traps import NOT_ZERO, TRAPS, Trap

Context = Callable[[Trap, str, bool], KnownScene | None]


def _in(trap: Trap, texts: Sequence[str]) -> dict[str, Any]:
    """A scene in x, y, z and what the trap is made of."""
    more = {"parameters": dict.fromkeys(trap.parameters, "positive")} if trap.parameters else {}
    return scene_of(["x", "y", "z", *trap.coordinates], *texts, **more)


def _trial(trap: Trap, t: str, texts: Sequence[str], truth: Mapping[str, Any]) -> KnownScene:
    return KnownScene(_in(trap, texts), truth, name=f"{t} in {'; '.join(texts)}", group=trap.name)


def coefficient(trap: Trap, t: str, zero: bool) -> KnownScene:
    """dz + T y dx: closed where T = 0, else d(omega) ^ omega = T dy dx dz is not 0."""
    n = 3 + len(trap.coordinates)
    truth = {"dof": n - 1 if zero else n, "velocity_dof": n - 1, "consistent": True}
    truth |= {"c1.holonomic": zero, "c1.holonomic_alone": zero}
    return _trial(trap, t, [f"dz + ({t})*y*dx = 0"], truth)


def beside_an_exact_form(trap: Trap, t: str, zero: bool) -> KnownScene:
    """d(x y) + 10^-12 T x dz: its wedge with its differential is 10^-12 T x dx dy dz, up to the sign."""
    n = 3 + len(trap.coordinates)
    text = f"y dx + x dy + 1e-12*({t})*x*dz = 0"
    return _trial(trap, t, [text], _integrable(n, zero))


def times_a_contact_form(trap: Trap, t: str, zero: bool) -> KnownScene:
    """dx + 10^9 T (dz - y dx): dx = 0 where T = 0, else a contact form."""
    n = 3 + len(trap.coordinates)
    return _trial(trap, t, [f"dx + 1e9*({t})*(dz - y dx) = 0"], _integrable(n, zero))


def _integrable(n: int, zero: bool) -> Mapping[str, Any]:
    return {"dof": n - 1 if zero else n, "velocity_dof": n - 1, "c1.holonomic": zero}


def second_form(trap: Trap, t: str, zero: bool) -> KnownScene:
    """dx - y dz and T dz: a contact form alone where T = 0, else dx = dz = 0."""
    n = 3 + len(trap.coordinates)
    truth = {"dof": n if zero else n - 2, "velocity_dof": n - 1 if zero else n - 2, "redundant": ["c2"] if zero else []}
    return _trial(trap, t, ["dx - y dz = 0", f"({t})*dz = 0"], {**truth, "c1.holonomic": not zero})


def second_relation(trap: Trap, t: str, zero: bool) -> KnownScene:
    """z = 0 and z + T x = 0: the second says nothing new where T = 0; else x = 0 too, or a zero of T."""
    n = 3 + len(trap.coordinates)
    truth: dict[str, Any] = {"dof": n - 1 if zero else n - 2, "consistent": True}
    if trap.everywhere:
        truth["redundant"] = ["c2"] if zero else []
    return _trial(trap, t, ["z = 0", f"z + ({t})*x = 0"], truth)


def contradiction(trap: Trap, t: str, zero: bool) -> KnownScene | None:
    """z = 0 and z + T = 0 contradict each other where T has no zero."""
    n = 3 + len(trap.coordinates)
    if zero:
        truth: dict[str, Any] = {"consistent": True, "dof": n - 1}
        truth |= {"redundant": ["c2"]} if trap.everywhere else {}
    elif trap.never:
        truth = {"consistent": False, "dof": None}
    else:
        return None
    return _trial(trap, t, ["z = 0", f"z + ({t}) = 0"], truth)


def factor(trap: Trap, t: str, zero: bool) -> KnownScene:
    """T (x - 1) = 0 says nothing where T = 0."""
    n = 3 + len(trap.coordinates)
    truth = {"dof": n if zero else n - 1, "consistent": True}
    return _trial(trap, t, [f"({t})*(x - 1) = 0"], truth)


def factor_of_a_form(trap: Trap, t: str, zero: bool) -> KnownScene:
    """T (dz - y dx) = 0 says nothing where T = 0."""
    n = 3 + len(trap.coordinates)
    truth = {"dof": n, "velocity_dof": n if zero else n - 1}
    return _trial(trap, t, [f"({t})*(dz - y dx) = 0"], truth)


def beside_time(trap: Trap, t: str, zero: bool) -> KnownScene | None:
    """dx + T dt = 0 is scleronomic where T = 0."""
    if trap.coordinates:
        return None
    truth = {"dof": 2, "velocity_dof": 2, "scleronomic": zero, "c1.scleronomic": zero, "c1.catastatic": zero}
    return _trial(trap, t, [f"dx + ({t})*dt = 0"], truth)


def drawn(trap: Trap, t: str, zero: bool) -> KnownScene | None:
    """Three links whose joints are drawn in a line where T = 0: rigid, and free to bend to first order."""
    if trap.names:
        return None
    places = {"A": [0, 0], "B": [1, 0], "C": [2, t]}
    links = [{"type": "link", "between": pair} for pair in (["A", "B"], ["B", "C"], ["A", "C"])]
    made = {
        "dimension": 2,
        "particles": [{"name": name, "at": at} for name, at in places.items()],
        "constraints": links,
    }
    truth = {"dof": 3, "velocity_dof": 3, "instantaneous_dof": 4 if zero else 3, "singular": zero}
    return KnownScene(made, truth, name=f"a triangle of height {t}", group=trap.name)


CONTEXTS: tuple[Context, ...] = (
    coefficient,
    beside_an_exact_form,
    times_a_contact_form,
    second_form,
    second_relation,
    contradiction,
    factor,
    factor_of_a_form,
    beside_time,
    drawn,
)


def identities() -> Iterator[KnownScene]:
    """Expressions that are zero by an identity, in every context."""
    for trap in TRAPS:
        yield from (trial for context in CONTEXTS if (trial := context(trap, trap.zero, True)))


def near_misses() -> Iterator[KnownScene]:
    """Expressions that are nearly such an identity and are not zero, in every context."""
    for trap in TRAPS:
        for miss in trap.misses:
            yield from (trial for context in CONTEXTS if (trial := context(trap, miss, False)))
    for name, text, names in NOT_ZERO:
        other = Trap(name, text, None, names, "^" not in text)
        yield from (trial for context in CONTEXTS if (trial := context(other, text, False)))
