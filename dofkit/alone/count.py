"""The textbook: f = N d - k, a form integrates where its mixed partials are equal, answers are compared as texts."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.alone.told import Knobs, Told
from dofkit.alone.written import Written, as_written, labelled
from dofkit.labels import exact
from dofkit.parts import GROUND
from dofkit.scene import Scene

_BELOW = "the count is {}: some equations have to depend on others or to contradict them, and it does not tell which"


def naive(written: Written) -> int:
    """f = N d - k: coordinates less every finite equation that was written."""
    return len(written.coordinates) - len(written.finite)


def dof(scene: Scene, knobs: Knobs) -> Told:
    """f = N d - k, each rigid body with d(d+1)/2 coordinates."""
    del knobs
    number = naive(as_written(scene))
    return Told(None, _BELOW.format(number)) if number < 0 else Told(number)


def integrability(scene: Scene, knobs: Knobs) -> Told:
    """Closed forms are called holonomic, all others are not: equality of mixed partials, which is exactness."""
    del knobs
    written = as_written(scene)
    closed: dict[int, bool] = {}
    for i, form in written.forms:
        closed[i] = closed.get(i, True) and bool(exact(form, written.positive)[0])
    return Told(labelled(written, closed))


def redundancy(scene: Scene, knobs: Knobs) -> Told:
    """None where as much is left as can move for certain: all of a frame that nothing holds to the ground."""
    del knobs
    written = as_written(scene)
    number, least = naive(written), least_freedom(written)
    if number >= least:
        return Told([])
    why = f"the count leaves {number}, and at least {least} can move: something is redundant, but the count names none"
    return Told(None, why)


def least_freedom(written: Written) -> int:
    """d(d+1)/2 for links between d particles or more that nothing joins to the ground (Maxwell), else 0."""
    system, d = written.system, written.system.dimension
    linked = all(c.type in ("link", "rigid") and GROUND not in c.members for c in system.connections)
    if not linked or len(system.connections) < len(system.constraints) or len(system.particles) < d or system.bodies:
        return 0
    return d * (d + 1) // 2


def equivalence(scene: Scene, knobs: Knobs, answer: Mapping[str, str]) -> Told:
    """Are the texts the same, blanks and the sides' order aside?"""
    del knobs
    asked = next(c.text for c in as_written(scene).system.constraints if c.name == answer["constraint"])
    return Told(plain(asked) == plain(answer["text"]))


def plain(text: str) -> tuple[str, ...]:
    """A text without blanks and signs of multiplication, its sides in alphabetical order."""
    bare = "".join(text.split()).replace("**", "^").replace("·", "").replace("*", "")
    sides = bare.split("=") if "=" in bare else [bare, "0"]
    return tuple(sorted(sides))
