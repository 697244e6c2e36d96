"""The textbook: f = N d - k, a form integrates where its mixed partials are equal, answers are compared as texts."""

from __future__ import annotations

from collections.abc import Mapping

from dofkit.base.verdicts import weakest
from dofkit.base.wording import many
from dofkit.integrability.traits import exact
from dofkit.methods.shared.as_written import Written, as_written, labelled
from dofkit.methods.shared.reply import Knobs, MethodFindings, MethodLabel, MethodReply
from dofkit.scene.scene import Scene
from dofkit.system import GROUND, System

CLOSED = "It is closed as written (all mixed partial derivatives agree), so it integrates to a holonomic equation."
NOT_CLOSED = (
    "It is not closed as written: the classroom's test of mixed partial derivatives calls it non-holonomic, but a "
    "factor may make it integrable, which only Frobenius' condition tells."
)
_BELOW = (
    "the textbook count is {}: some equations have to depend on others or to contradict them, "
    "and it does not tell which"
)


def naive(written: Written) -> int:
    """f = N d - k: coordinates less every finite equation that was written."""
    return len(written.coordinates) - len(written.finite)


def dof(scene: Scene, knobs: Knobs) -> MethodReply:
    """f = N d - k, each rigid body with d(d+1)/2 coordinates."""
    del knobs
    number = naive(as_written(scene))
    return MethodReply(None, _BELOW.format(number)) if number < 0 else MethodReply(number)


def integrability(scene: Scene, knobs: Knobs) -> MethodReply:
    """Closed forms are called holonomic, all others are not: equality of mixed partials, which is exactness."""
    del knobs
    written = as_written(scene)
    closed: dict[int, bool] = {}
    for i, form in written.forms:
        closed[i] = closed.get(i, True) and bool(exact(form, written.positive)[0])
    return MethodReply(labelled(written, closed))


def redundancy(scene: Scene, knobs: Knobs) -> MethodReply:
    """None where as much is left as can move for certain: all of a frame that nothing holds to the ground."""
    del knobs
    written = as_written(scene)
    number, least = naive(written), least_freedom(written)
    if number >= least:
        return MethodReply([])
    why = f"the count leaves {number}, and at least {least} can move: something is redundant, but the count names none"
    return MethodReply(None, why)


def least_freedom(written: Written) -> int:
    """d(d+1)/2 for links between d particles or more that nothing joins to the ground [Maxwell1864], else 0."""
    system, d = written.system, written.system.dimension
    linked = all(c.facts.bars and GROUND not in c.members for c in system.connections)
    if not linked or len(system.connections) < len(system.constraints) or len(system.particles) < d or system.bodies:
        return 0
    return d * (d + 1) // 2


def equivalence(scene: Scene, knobs: Knobs, answer: Mapping[str, str]) -> MethodReply:
    """Are the texts the same, blanks and the sides' order aside?"""
    del knobs
    asked = next(c.text for c in as_written(scene).system.constraints if c.name == answer["constraint"])
    return MethodReply(plain(asked) == plain(answer["text"]))


def plain(text: str) -> tuple[str, ...]:
    """A text without blanks and signs of multiplication, its sides in alphabetical order."""
    bare = "".join(text.split()).replace("**", "^").replace("·", "").replace("*", "")
    sides = bare.split("=") if "=" in bare else [bare, "0"]
    return tuple(sorted(sides))


def findings(system: System) -> MethodFindings:
    """The count with its assumption; closed forms are holonomic [PoincareLemma], and no others are known to be."""
    written = as_written(system)
    labels: dict[int, MethodLabel] = {}
    for i, form in written.forms:
        closed, sure = exact(form, written.positive)
        label = (
            MethodLabel(True, CLOSED, sure, True, True)
            if closed
            else MethodLabel(None, NOT_CLOSED, "undecided", exact=closed)
        )
        labels[i] = label if i not in labels else _both(labels[i], label)
    return MethodFindings({}, {i: x for i, x in labels.items() if i not in written.others}, _sentences(written))


def _both(a: MethodLabel, b: MethodLabel) -> MethodLabel:
    worse = a if a.holonomic is None else b
    return MethodLabel(worse.holonomic, worse.reason, weakest(a.verdict, b.verdict), worse.alone, worse.exact)


def _sentences(written: Written) -> list[str]:
    number = naive(written)
    if number < 0:
        told = [f"T{_BELOW[1:].format(number)}."]
    else:
        told = [
            f"The textbook count gives {many(number, 'degree')} of freedom: it assumes that every holonomic "
            "equation is independent and removes one."
        ]
    differential = len(written.forms) + sum(why != "inequality" for why in written.others.values())
    if differential:
        told.append(
            f"It does not count {many(differential, 'differential equation')}, which may imply holonomic equations."
        )
    return told
