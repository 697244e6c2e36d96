"""Stress families: every truth is of its kind, both kinds occur, and what can be counted in another way agrees."""

from __future__ import annotations

import random
from collections import defaultdict
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.benchmark import record
from dofkit.benchmark.runner import outcome_of
from dofkit.benchmark.trials import FAMILIES
from dofkit.benchmark.trials.construction import Trial, few, kind
from dofkit.benchmark.trials.frameworks import Framework, dependent
from dofkit.methods.ask import answered
from dofkit.methods.table import MethodName

#: Families meant for cost against size.
LADDERS = (
    "cliques", "double bananas", "Henneberg", "links on a line", "doors", "cranks", "loops of hinges",
    "braced grids", "chains of links", "chains of bodies", "trees of bodies", "rolling",
    "chained forms", "trailers",
    "chains of equations", "many blocks", "rates of rates",
    "sums of squares",
)  # fmt: skip
#: Families whose scenes are links between particles, and how many joints are still checked by the rank.
GRAPHS = ("cliques", "complete bipartite", "double bananas", "Henneberg", "links on a line")
DRAWN = ("braced grids", "chains of links")
JOINTS = 30


@cache
def trials(family: str) -> tuple[Trial, ...]:
    return tuple(FAMILIES[family]())


@pytest.mark.parametrize("family", FAMILIES)
def test_trials_are_told_apart_and_of_their_kind(family: str) -> None:
    made = trials(family)
    assert len({trial.name for trial in made}) == len(made)
    assert [trial.name for trial in made if trial.family != family or not trial.because] == []
    assert [trial.name for trial in made if not _of_its_kind(trial)] == []


def _of_its_kind(trial: Trial) -> bool:
    truth, question = trial.truth, trial.question
    names = [
        c["name"] if isinstance(c, dict) and "name" in c else f"c{i + 1}"
        for i, c in enumerate(trial.scene.get("constraints", ()))
    ]
    if question == "dof":
        return isinstance(truth, int) and not isinstance(truth, bool) and truth >= -1
    if question == "redundancy":
        return isinstance(truth, list) and truth == sorted(truth) and set(truth) <= set(names)
    if question == "integrability":
        return isinstance(truth, dict) and set(truth) == set(names)
    return isinstance(truth, bool) and trial.answer is not None and trial.answer["constraint"] in names


@pytest.mark.parametrize("family", FAMILIES)
def test_no_answer_is_always_right(family: str) -> None:
    """Both kinds occur: who always says the same is wrong somewhere."""
    kinds = defaultdict(set)
    for trial in trials(family):
        kinds[trial.question].add(kind(trial))
    mixed = {question for question, found in kinds.items() if len(found) > 1 or (False, True) in found}
    assert kinds.keys() - mixed == set()


@pytest.mark.parametrize("family", LADDERS)
def test_sizes_make_a_ladder(family: str) -> None:
    assert len({trial.size for trial in trials(family)}) >= 4


def test_there_are_many_and_all_questions() -> None:
    made = [trial for family in FAMILIES for trial in trials(family)]
    assert len(made) >= 2000
    assert {trial.question for trial in made} == {"dof", "integrability", "redundancy", "equivalence"}
    assert sum(1 for family in FAMILIES for _ in few(FAMILIES[family]())) <= 160


#: The lines of the chart that took fewer seconds, by the method.
QUICK: dict[MethodName, float] = {"auto": 0.02, "field": 0.004, "balls": 0.004}
LINES = record.read(Path(__file__).parents[1] / "charts").lines


@pytest.mark.parametrize("family", FAMILIES)
def test_quick_trials_are_answered_as_in_the_chart(family: str) -> None:
    """Right, or undecided where the chart has it: a mechanism that no longer decides shows here too."""
    made = {(trial.name, trial.question): trial for trial in trials(family)}
    quick = [line for line in LINES if line.family == family and line.seconds < QUICK.get(line.method, 0)]
    other = []
    for line in quick:
        trial = made[line.trial, line.question]
        reply = answered(dict(trial.scene), trial.question, line.method, answer=trial.answer)
        if outcome_of(trial.truth, reply.value) != line.outcome.replace("cannot", "undecided"):
            other.append((line.trial, line.method, reply.value, trial.truth, line.outcome))
    assert other == []


@pytest.mark.parametrize("family", FAMILIES)
def test_scenes_are_read(family: str) -> None:
    for trial in trials(family)[::17]:
        assert dofkit.load(dict(trial.scene)).constraints is not None


# The rank, at random places or at the drawing


def framework(scene: Any, rng: random.Random) -> Framework:
    """Links between particles; those without a place at random ones."""
    d = scene["dimension"]
    joints = {}
    for particle in scene["particles"]:
        at = particle["at"] if isinstance(particle, dict) else [rng.randrange(10**6) for _ in range(d)]
        joints[particle["name"] if isinstance(particle, dict) else particle] = tuple(map(Fraction, at))
    ground: list[tuple[Fraction, ...]] = []
    bars: list[tuple[str | int, str | int]] = []
    for link in scene["constraints"]:
        ends: list[str | int] = []
        for end in link["between"]:
            if isinstance(end, str):
                ends.append(end)
            else:
                ground.append(tuple(map(Fraction, end)))
                ends.append(len(ground) - 1)
        bars.append((ends[0], ends[1]))
    return Framework(joints, tuple(ground), tuple(bars))


@pytest.mark.parametrize("family", [*GRAPHS, *DRAWN])
def test_links_are_counted_by_the_rank_over_the_rationals(family: str) -> None:
    rng = random.Random(family)
    for trial in trials(family):
        if len(trial.scene["particles"]) > JOINTS:
            continue
        drawn = framework(trial.scene, rng)
        if trial.question == "dof":
            assert drawn.by_rank() == trial.truth, trial.name
        if trial.question == "redundancy":
            names = [c.get("name", f"c{i + 1}") for i, c in enumerate(trial.scene["constraints"])]
            assert sorted(names[i] for i in dependent(drawn)) == trial.truth, trial.name
