"""Scenes whose truth is known by how they are made: no answer is wrong, and nearly all are right."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cache
from itertools import islice

import pytest
from adversary.running import answered, faults, outcome
from shared.known_scenes import swept

from dofkit.benchmark.trials.construction import KnownScene
from dofkit.benchmark.trials.identities import NOT_ZERO, TRAPS, Trap, in_contexts, near_misses, tiny_steps
from dofkit.benchmark.trials.poses import FAMILIES as POSES
from dofkit.benchmark.trials.poses import JOINTED, NEAR, FrameworkPose, measured_elsewhere
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import num


def identities() -> Iterator[KnownScene]:
    """Yield expressions that are zero by an identity, in every context."""
    for trap in TRAPS:
        yield from in_contexts(trap, trap.zero, True)


def misses() -> Iterator[KnownScene]:
    """Yield expressions that are nearly such an identity and are not zero, in every context."""
    for trap in TRAPS:
        yield from near_misses(trap)
    for trap in NOT_ZERO:
        yield from in_contexts(trap, trap.zero, False)


#: Scenes near singular poses.
SWEEPS = {**POSES, "scaled and moved, with tolerance": measured_elsewhere}
#: The scenes of each family, and the least share of right answers.
FAMILIES: Mapping[str, tuple[Callable[[], Iterator[KnownScene]], float]] = {
    "identities": (identities, 0.7),
    "near misses of identities": (misses, 0.97),
    "tiny steps from integrable": (tiny_steps, 0.97),
}
#: The same of scenes near singular poses. Far from the origin floating point tells little of measured positions, and a
#: spherical four-bar a millionth large, a million away, is not followed to a finite distance.
FLOORS = {"rounded, with tolerance": 0.85, "size and place": 0.99, "scaled and moved, with tolerance": 0.65}
#: Of the large families every third scene is answered in the sweep.
STEPS = {"near misses of identities": 3}


@cache
def groups(family: str) -> dict[str, list[KnownScene]]:
    found: dict[str, list[KnownScene]] = defaultdict(list)
    for known in FAMILIES[family][0]():
        found[known.group].append(known)
    return found


def share_right(scenes: Iterable[KnownScene]) -> float:
    """Return the share of scenes of which everything known is answered rightly; no answer may be wrong."""
    right = []
    for known in scenes:
        answer = answered(known.scene)
        assert faults(known, answer) == {}, (known.name, known.truth)
        right.append(outcome(known, answer) == "right")
    return sum(right) / len(right)


@pytest.mark.parametrize(("family", "group"), [(family, group) for family in FAMILIES for group in groups(family)])
def test_the_first_of_each_group_is_not_answered_wrongly(family: str, group: str) -> None:
    share_right(groups(family)[group][:1])


@pytest.mark.sweep
@pytest.mark.parametrize("family", FAMILIES)
def test_nothing_is_answered_wrongly_and_little_is_undecided(family: str) -> None:
    made, floor = FAMILIES[family]
    assert share_right(islice(made(), 0, None, STEPS.get(family, 1))) >= floor


@pytest.mark.parametrize(("sweep", "step"), [case for name in SWEEPS for case in ((name, 29), swept(name, 1))])
def test_near_singular_poses(sweep: str, step: int) -> None:
    """At singular poses and near them, of any size, anywhere, rounded and measured."""
    scenes = [*SWEEPS[sweep]()]
    assert share_right(scenes[step // 2 :: step]) >= (FLOORS.get(sweep, 1) if step == 1 else 0)


@pytest.mark.parametrize("pose", NEAR, ids=lambda pose: pose.name)
def test_the_velocities_by_hand_are_those_of_the_matrix(pose: FrameworkPose) -> None:
    """The rank over the rationals, at the singular pose and beside it."""
    for step in (Fraction(0), Fraction(1, 1000)):
        dof, first = pose.freedom(step)
        assert pose.framework_at(step).by_rank() == first
        assert dof is None or dof <= first


def test_there_are_many() -> None:
    assert len(TRAPS) >= 25
    assert len(NEAR) + len(JOINTED) >= 17
    assert sum(len(scenes) for family in FAMILIES for scenes in groups(family).values()) >= 3000
    assert sum(1 for sweep in SWEEPS.values() for _ in sweep()) >= 450


# The traps themselves, by nothing but interval arithmetic on the text

POINTS = (
    {"w": Fraction(3, 8), "v": Fraction(1, 4), "a": Fraction(7, 4), "b": Fraction(5, 8)},
    {"w": Fraction(13, 16), "v": Fraction(1, 2), "a": Fraction(3, 8), "b": Fraction(7, 2)},
)


@pytest.mark.parametrize("trap", TRAPS, ids=lambda trap: trap.name)
@pytest.mark.parametrize("at", POINTS, ids=("first", "second"))
def test_a_trap_is_zero_and_its_near_misses_are_not(trap: Trap, at: dict[str, Fraction]) -> None:
    names = Names(parameters={name: num(value) for name, value in at.items()})
    zero = interval_of(parse_expression(trap.zero, names))
    assert zero is not None
    assert zero.contains(0)
    assert zero.abs_upper() < 1e-60
    for text in trap.misses:
        near = interval_of(parse_expression(text, names))
        assert near is not None
        assert not near.contains(0)
