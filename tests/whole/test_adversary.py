"""The standing adversary: its truths are confirmed, its judge is right, and a short run finds nothing.

`python -m tests.adversary --minutes 30` goes on from here.
"""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from adversary import registry
from adversary.confirmation import confirmed
from adversary.disguises import DISGUISES
from adversary.judgement import judged, overall
from adversary.registry import FOUND, KINDS, OPEN, Trial, made
from adversary.running import Answer, answered, answered_apart, faults, outcome
from shared.known_scenes import spread, swept

import dofkit
from dofkit.base.runs import Pool
from dofkit.benchmark.trials.construction import KnownScene, scene_of, truths

KEPT = sorted(FOUND.glob("*.json"))
#: Those that take seconds.
SLOW = ("times-cancelled-311f4784", "primes-solved-17fd7e82")
#: Seconds of processor time for a case of the short run: what takes longer is undecided.
SECONDS = 3.0


def test_there_are_many_kinds() -> None:
    assert len(KINDS) > 90


def test_what_is_open_is_there() -> None:
    assert set(OPEN) <= {*KINDS, *(path.name for path in KEPT)}


@pytest.mark.parametrize("kind", KINDS)
def test_the_same_seed_draws_the_same_scene_and_it_is_one(kind: str) -> None:
    for size in range(4):
        first, again = (registry.drawn(kind, size, size) for _ in range(2))
        assert first == again
        dofkit.load(dict(first.scene))


CHARTED = [kind for kind in KINDS if any(registry.drawn(kind, seed, 0).chart for seed in range(4))]


@pytest.mark.parametrize("kind", CHARTED)
def test_the_chart_confirms_the_truth(kind: str) -> None:
    """Put into the equations: they hold on it, it has as many dimensions as is said, and the forms leave so many."""
    for seed in range(6):
        case = registry.drawn(kind, seed, seed % 3)
        if case.chart is not None:
            found = confirmed(case, seed)
            assert found.holds
            assert (found.dimension, found.velocities) == (case.truth["dof"], case.truth["velocity_dof"])
            assert found.regular >= found.dimension


@pytest.mark.parametrize("disguise", ["reordered", "scaled", "combined"])
@pytest.mark.parametrize("kind", CHARTED[::3])
def test_the_chart_fits_what_is_written_in_another_way(kind: str, disguise: str) -> None:
    case = registry.drawn(kind, 1, 1)
    worn = DISGUISES[disguise](random.Random(1), case)
    if worn is not None and worn.chart is not None:
        found = confirmed(worn)
        assert found.holds
        assert (found.dimension, found.velocities) == (worn.truth["dof"], worn.truth["velocity_dof"])


SIMPLE = KnownScene(
    scene_of("x y z", "x^2 + y^2 = 25", "dz = 3*dx", configuration={"x": "3", "y": "4", "z": "9"}),
    truths(1, instantaneous_dof=1, singular=False, holonomic=True, redundant=[], redundant_equations=0),
)
DRAWN = replace(registry.drawn("hinges/planar-loop", 1, 0), elsewhere={})


@pytest.mark.parametrize("disguise", spread(DISGUISES))
def test_a_disguise_keeps_what_is_true(disguise: str) -> None:
    """Of a simple system, whose answers are right in any disguise."""
    case = DRAWN if disguise == "turned" else SIMPLE
    for seed in range(3):
        worn = DISGUISES[disguise](random.Random(seed), case)
        assert worn is not None
        assert worn.scene != case.scene
        assert set(worn.truth) >= {"consistent", "dof", "velocity_dof", "instantaneous_dof"}
        answer = answered(worn.scene)
        assert outcome(worn, answer) == "right", faults(worn, answer)


def told(**fields: Any) -> dict[str, Any]:
    entry = {"name": "c1", "holonomic": True, "verdict": "proved", "circuit": ["a", "b"]}
    return {"dof": 2, "holonomic": True, "redundant": ["b", "a"], "verdict": "proved", "constraints": [entry], **fields}


@pytest.mark.parametrize(
    ("report", "expected"),
    [
        (told(), "right"),
        (told(dof=None), "undecided"),
        (told(dof=3), "wrong"),
        (told(dof=3, verdict="undecided"), "undecided"),
        (told(dof=3, verdict="undecided", verdicts={"dof": {"verdict": "probable", "about": "everywhere"}}), "wrong"),
        (told(dof=1, verdicts={"dof": {"verdict": "proved", "about": "component"}}), "right"),
        (told(dof=1, verdicts={"dof": {"verdict": "proved", "about": "everywhere"}}), "wrong"),
        (told(holonomic=1), "wrong"),
        (told(redundant=["a"]), "wrong"),
    ],
)
def test_a_report_is_held_against_the_truth(report: dict[str, Any], expected: str) -> None:
    truth = {"dof": 2, "holonomic": True, "redundant": ["a", "b"], "c1.circuit": ["b", "a"], "c1.holonomic": True}
    assert overall(judged(KnownScene({}, truth, {"dof": [1]}), report)) == expected


def test_no_report_is_a_finding() -> None:
    assert answered({"coordinates": ["x"], "constraints": ["x = nothing"]}).end == "refused"
    assert answered({"coordinates": ["x"], "constraints": [3]}).end in ("refused", "failed")
    assert outcome(SIMPLE, Answer("failed", None)) == "failed"
    assert faults(SIMPLE, Answer("killed", None, "9")) == {"killed": "9"}


def test_a_worker_answers_the_same() -> None:
    with Pool(1) as pool:
        assert answered_apart(pool, SIMPLE.scene) == answered(SIMPLE.scene)


#: Forms that integrate or do not, with others or alone.
FORMS = ("charts/chained forms", "charts/forms together")


def short() -> list[Any]:
    """Two of every kind that is not open: as it is made, and in a disguise (most of these in the sweep, as those of
    the charts' families, of which tests/benchmark asks, but for forms)."""
    worn = list(DISGUISES)
    kinds = [(k, kind) for k, kind in enumerate(KINDS) if kind not in OPEN]
    plainly = [(Trial(kind, 1, 0), k % 3) for k, kind in kinds]
    disguised = [(Trial(kind, 2, 0, ((worn[k % len(worn)], k),)), k % 4) for k, kind in kinds]
    trials = [*plainly, *disguised]
    return [
        swept(trial) if rare or (trial.kind.startswith("charts") and "forms" not in trial.kind) else trial
        for trial, rare in trials
    ] + [Trial(kind, seed, 2, (("moved", seed), ("sheared", seed))) for kind in FORMS for seed in range(4)]


@pytest.mark.parametrize("trial", short(), ids=str)
def test_nothing_is_answered_wrongly(trial: Trial) -> None:
    case = made(trial)
    answer = answered(case.scene, SECONDS / 2)
    assert outcome(case, answer) in ("right", "undecided", "refused"), (case.scene, faults(case, answer), case.truth)


@pytest.mark.parametrize(
    "path", [swept(path) if path.stem in SLOW else path for path in KEPT], ids=lambda path: path.stem
)
def test_what_was_found_is_not_answered_wrongly_again(path: Path) -> None:
    kind, case = registry.read(path)
    if kind in OPEN or path.name in OPEN:
        pytest.skip(OPEN.get(kind) or OPEN[path.name])
    answer = answered(case.scene, SECONDS)
    assert outcome(case, answer) in ("right", "undecided", "refused"), (case.scene, faults(case, answer), case.truth)
