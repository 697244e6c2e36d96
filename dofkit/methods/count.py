"""The textbook's methods: f = N d - k; a form is integrable if mixed partials agree; answers are compared as texts."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.base.verdicts import weakest
from dofkit.integrability.traits import exact
from dofkit.methods.as_written import Written, as_written, labelled
from dofkit.methods.table import Reply
from dofkit.scene.scene import Scene
from dofkit.system import GROUND, System

_BELOW = (
    "the textbook count is {}: some equations have to depend on others or to contradict them, "
    "and it does not tell which"
)


def naive(written: Written) -> int:
    """Return f = N d - k: the number of coordinates less that of geometric equations."""
    return len(written.coordinates) - len(written.finite)


def dof(scene: Scene | System) -> Reply:
    """Return f = N d - k, where each rigid body has d(d+1)/2 coordinates; no value if f < 0."""
    number = naive(as_written(scene))
    return Reply(None, reason=_BELOW.format(number)) if number < 0 else Reply(number)


def integrability(scene: Scene | System) -> Reply:
    """Return {name: label}: a form is called holonomic if it is closed (mixed partials agree), else not."""
    written = as_written(scene)
    answers = [exact(form, written.positive) for _, form in written.forms]
    sure = weakest(*(verdict for is_closed, verdict in answers if is_closed))
    return Reply(labelled(written, [bool(is_closed) for is_closed, _ in answers]), verdict=sure)  # [PoincareLemma]


def redundancy(scene: Scene | System) -> Reply:
    """Return no redundant constraint if the count is at least the certain freedom; else no value.

    The certain freedom is the rigid motion of a system without ground. A smaller count proves that some constraint is
    redundant, but does not say which.
    """
    written = as_written(scene)
    number, least = naive(written), least_freedom(written)
    if number >= least:
        return Reply([])
    why = f"the count leaves {number}, and at least {least} can move: something is redundant, but the count names none"
    return Reply(None, reason=why)


def least_freedom(written: Written) -> int:
    """Return d(d+1)/2 for links between at least d particles, none joined to the ground [Maxwell1864], else 0."""
    system, d = written.system, written.system.dimension
    linked = all(c.facts.bars and GROUND not in c.members for c in system.connections)
    if not linked or len(system.connections) < len(system.constraints) or len(system.particles) < d or system.bodies:
        return 0
    return d * (d + 1) // 2


def equivalence(scene: Scene, answer: Mapping[str, str]) -> Reply:
    """Return whether the texts are equal except for blanks, signs of multiplication and the order of the sides."""
    asked = next(c.text for c in as_written(scene).system.constraints if c.name == answer["constraint"])
    return Reply(plain(asked) == plain(answer["text"]))


def plain(text: str) -> tuple[str, ...]:
    """Return the sides of an equation without blanks and signs of multiplication, in alphabetical order."""
    bare = "".join(text.split()).replace("**", "^").replace("·", "").replace("*", "")
    sides = bare.split("=") if "=" in bare else [bare, "0"]
    return tuple(sorted(sides))
