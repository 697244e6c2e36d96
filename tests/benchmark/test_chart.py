"""The charts: trials bounded in their own workers, Pareto fronts and exponents by hand, files that are read back."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from shared import chart_methods
from typer.testing import CliRunner

from dofkit.base.runs import Pool
from dofkit.benchmark import command, record, runner, statistics, tasks
from dofkit.benchmark.figures import table as figures_table
from dofkit.benchmark.record import AUTO, Data, Outcome, Ran, Score, TrialLine
from dofkit.benchmark.runner import outcome_of
from dofkit.benchmark.sentences import summary
from dofkit.benchmark.tasks import Selection
from dofkit.benchmark.trials.construction import Trial
from dofkit.interface.cli import app
from dofkit.methods.table import Knobs

RAN = Ran(
    version="0",
    command="dofkit chart --quick",
    date="2026-01-02T03:04:05Z",
    machine="a machine",
    cores=2,
    python="3.11",
    workers=2,
    limit=4.0,
    quick=True,
    trials=8,
    lines=0,
    sweeps=0,
    minutes=1.5,
    complete=True,
)


def ran(methods: Sequence[str], limit: float = 0.3) -> list[TrialLine]:
    """The trials of the family by these methods, in two workers."""
    with Pool(2, modules=("dofkit.benchmark.runner", "shared.chart_methods")) as pool:
        bench = runner.Bench(pool, limit, "shared.chart_methods:answered")
        return list(runner.run(tasks.trial_tasks(chart_methods.family(False), methods), bench))


# -- running ---------------------------------------------------------------------------------------


@pytest.mark.sweep
def test_every_trial_has_its_line_whatever_the_method_does() -> None:
    methods = ("right", "wrong", "undecided", "cannot", "raises", "crashes", "hangs")
    lines = ran(methods)
    assert len(lines) == 7 * 8
    found = {m: {(line.size, line.outcome) for line in lines if line.method == m} for m in methods}
    for method, outcome in (("right", "right"), ("wrong", "wrong"), ("undecided", "undecided"), ("cannot", "cannot")):
        assert found[method] == {(size, outcome) for size in (1, 2, 4, 8)}
    assert found["raises"] == found["undecided"]
    assert found["crashes"] == {(1, "right"), (2, "undecided"), (4, "right"), (8, "right")}
    assert found["hangs"] == {(1, "right"), (2, "right"), (4, "timed out"), (8, "timed out")}
    why = {(line.method, line.size): line.why for line in lines}
    assert why["right", 1] == ""
    assert why["wrong", 1] == "Wrong does not answer this."
    assert why["raises", 8] == "It failed: KeyError: 'x'."
    assert "SIGSEGV" in why["crashes", 2]
    assert why["hangs", 4] == "Not done after 0.3 s."
    assert why["hangs", 8].startswith("Timed out at a smaller size.")
    assert all(line.seconds == 0.3 for line in lines if line.outcome == "timed out")
    assert all(line.seconds < 0.1 for line in lines if line.outcome in ("right", "wrong", "cannot"))


@pytest.mark.sweep
def test_workers_stay_warm() -> None:
    lines = ran(["process", "hangs"])
    told = [line.answer for line in lines if line.method == "process"]
    assert len(told) == 8
    assert len(set(told)) <= 2
    assert any(line.outcome == "timed out" for line in lines)


@pytest.mark.sweep
def test_what_hears_no_signal_is_killed() -> None:
    lines = ran(["deaf"])
    assert [line.outcome for line in lines] == ["right"] * 7 + ["timed out"]


@pytest.mark.sweep
def test_ladders_climb_by_size_and_other_ladders_go_on() -> None:
    lines = ran(["hangs", "right"])
    sizes = [line.size for line in lines if line.method == "hangs"]
    assert sizes[:4] == [1, 1, 2, 2]
    assert sizes[4:].index(4) < sizes[4:].index(8)
    trial = next(chart_methods.family(True))
    one, other = tasks.TrialTask(trial, "m"), tasks.TrialTask(replace(trial, size=7, name="b"), "m")
    assert one.ladder == other.ladder
    swept = tasks.TrialTask(replace(trial, swept={"digits": 3}), "m")
    assert (
        len(
            {one.ladder, swept.ladder, tasks.TrialTask(trial, "n").ladder, tasks.TrialTask(trial, "m", knob="k").ladder}
        )
        == 4
    )


@pytest.mark.parametrize(
    ("truth", "told", "outcome"),
    [
        (2, 2, "right"),
        (2, 3, "wrong"),
        (-1, None, "undecided"),
        (True, 1, "wrong"),
        (["a", "b"], ["b", "a"], "right"),
        (["a"], [], "wrong"),
        ({"a": True}, {"a": None}, "undecided"),
        ({"a": True, "b": False}, {"b": True}, "wrong"),
        ({"a": True}, {"a": True, "z": True}, "wrong"),
    ],
)
def test_answers_are_judged(truth: Any, told: Any, outcome: Outcome) -> None:
    assert outcome_of(truth, told) == outcome


def test_sweeps_turn_what_the_trials_sweep() -> None:
    base = next(chart_methods.family(True))
    told = {**base.scene, "tolerance": "1e-3"}
    rounded = [
        replace(base, name=f"r{d}-{k}", scene=told, swept={"digits": d, "tolerance": 10.0**-d})
        for d in (3, 9)
        for k in range(40)
    ]
    near = [replace(base, name=name, swept={"gap": gap}) for name, gap in (("n", -1e-3), ("m", "1/1000"), ("far", 1))]
    near.append(replace(base, name="large", size=99, swept={"gap": 1e-3}))
    rounded.append(replace(base, name="exact as written", swept={"digits": 5}))
    found = list(tasks.sweeps([*rounded, *near], ["auto", "numeric", "balls"], False))
    tolerances = [task for task in found if task.knob == "tolerance"]
    assert {task.knobs.tolerance for task in tolerances} == {task.value for task in tolerances} == set(tasks.TOLERANCES)
    assert len(tolerances) == 2 * tasks.MOST_SWEPT * len(tasks.TOLERANCES)
    assert {task.group for task in tolerances} == {"3", "9"}
    assert not any("tolerance" in task.trial.scene for task in tolerances)
    tolerant = [task for task in found if task.knob == "scene tolerance"]
    assert all(task.trial.scene["tolerance"] == task.value and task.knobs == Knobs() for task in tolerant)
    balls = [task for task in found if task.knob == "bits"]
    assert {(task.trial.name, task.group) for task in balls} == {("n", "0.001"), ("m", "0.001")}
    assert not [task for task in found if task.method == "field"]


def test_of_many_trials_some_are_taken_from_the_smallest_to_the_largest() -> None:
    trials = [replace(t, name=f"{t.name}{k}") for t in chart_methods.family(False) for k in range(3)]
    assert [t.size for t in Selection(most=4).thinned(trials)] == [1, 2, 4, 8]
    assert len(Selection(most=0).thinned(trials)) == len(trials) == 24
    assert [t.size for t in Selection(quick=True).thinned(trials)] == [1, 8]
    assert list(Selection(["dof"], [], ["auto", "field"], True, 7).options()) == [
        "--question dof",
        "--methods auto,field",
        "--quick",
        "--most 7",
    ]


# -- what the lines say ----------------------------------------------------------------------------


def score(method: str, seconds: float | None, right: int, wrong: int) -> Score:
    """Of ten trials."""
    return Score(
        question="dof",
        family="all",
        method=method,
        trials=10,
        right=right,
        wrong=wrong,
        undecided=10 - right - wrong,
        timed_out=0,
        cannot=0,
        median_seconds=seconds,
        low_seconds=seconds,
        high_seconds=seconds,
    )


def test_the_pareto_front_by_hand() -> None:
    fast = score("fast", 1, 5, 5)
    sound = score("sound", 2, 4, 0)
    best = score(AUTO, 3, 10, 0)
    slow = score("slow", 4, 10, 0)  # beaten by auto: as right, slower
    worse = score("worse", 2.5, 4, 1)  # beaten by sound
    none = score("none", 0.1, 0, 0)  # never right
    members = [best, slow, fast, worse, none, sound]
    assert statistics.front(members) == ["fast", "sound", AUTO]
    (front,) = statistics.fronts(members)
    assert (front.methods, front.never_wrong) == (["fast", "sound", AUTO], ["sound", AUTO])
    assert statistics.beats(best, slow)
    assert not statistics.beats(best, best)


def test_exact_power_laws_are_found() -> None:
    assert statistics.power_law([(1, 2.0), (2, 16.0)]) is None
    exponent, error, factor = statistics.power_law([(n, 0.5 * n**3) for n in (1, 2, 4, 8)]) or (0.0, 1.0, 0.0)
    assert (round(exponent, 12), round(factor, 12)) == (3, 0.5)
    assert error < 1e-12
    # ln y = 0, 1, 0, 1 over ln x = 0, 1, 2, 3: the slope is 1/5, what is left 4/5, so its error sqrt(4/5 / 2 / 5)
    curve = [(math.exp(u), math.exp(v)) for u, v in ((0, 0), (1, 1), (2, 0), (3, 1))]
    exponent, error, factor = statistics.power_law(curve) or (0.0, 0.0, 0.0)
    assert (exponent, error, factor) == pytest.approx((0.2, math.sqrt(0.08), math.exp(0.2)))


def line(trial: str, method: str, outcome: Outcome, seconds: float, size: int = 1) -> TrialLine:
    """A line about a family of boxes."""
    told = {"right": 2, "wrong": 3}.get(outcome)
    why = "" if outcome == "right" else 'because, he said, "no"; θ'
    return TrialLine("boxes", trial, "dof", method, size, {"gap": "1/9"}, 2, told, outcome, seconds, why)


LINES = [
    *(line(f"b{n}", AUTO, "right", 0.002 * n, n) for n in (1, 2, 4, 8)),
    *(line(f"b{n}", "graph", "right", 0.0005 * n, n) for n in (1, 2, 4, 8)),
    *(line(f"b{n}", "symbolic", "right" if n < 8 else "timed out", min(4.0, 0.1 * n**2), n) for n in (1, 2, 4, 8)),
    line("b1", "count", "right", 0.0001),
    line("b2", "count", "wrong", 0.0001),
    line("b4", "count", "undecided", 0.0001),
    line("b8", "count", "cannot", 0.0001),
]
_STEPS: list[tuple[float, Outcome]] = [(1e-9, "wrong"), (1e-3, "right"), (1e-1, "undecided")]
SWEEPS = [
    replace(line("b1", "numeric", outcome, 0.001), knob="tolerance", value=value, group=group)
    for group in ("3", "9")
    for value, outcome in _STEPS
]
DATA = Data(RAN, LINES, SWEEPS)


def test_scores_points_and_auto_against_the_fastest() -> None:
    chart = summary(DATA)
    whole = {row.method: row for row in chart.scores if row.family == "all"}
    count = whole["count"]
    assert (count.trials, count.right, count.wrong, count.undecided, count.timed_out, count.cannot) == (
        4,
        1,
        1,
        1,
        0,
        1,
    )
    assert count.median_seconds == 0.0001
    assert whole["symbolic"].timed_out == 1
    assert whole[AUTO].median_seconds == pytest.approx(0.006)
    assert {(p.method, p.size, p.timed_out) for p in chart.points} >= {("symbolic", 8, 1), (AUTO, 8, 0)}
    fits = {fit.method: fit for fit in chart.fits}
    assert fits["symbolic"].exponent == pytest.approx(2)
    assert fits["symbolic"].points == 3  # not that which timed out
    assert fits[AUTO].exponent == pytest.approx(1)
    (against,) = chart.against
    assert against.fastest == "graph"
    assert against.ratio == pytest.approx(4)
    assert (against.sound, against.sound_ratio) == ("graph", pytest.approx(4))
    assert [(s.group, s.value, s.right, s.wrong, s.undecided) for s in chart.steps][:3] == [
        ("3", 1e-9, 0, 1, 0),
        ("3", 1e-3, 1, 0, 0),
        ("3", 1e-1, 0, 0, 1),
    ]
    assert list(command.auto_sentences(chart)) == [
        "8 trials by 4 methods, at most 4 s each: of the answers of `auto` none is wrong and 0 % are undecided.",
        "On 0 of 1 families `auto` takes at most twice the time of the fastest method that is right there and wrong "
        "nowhere; with those that are right there by luck it does on 0 of 1.",
        "  dof, boxes: 4.0 times graph",
    ]
    assert all(text.endswith("Made by: dofkit chart --quick") for text in chart.captions.values())


# -- files -----------------------------------------------------------------------------------------


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    chart = summary(DATA)
    record.write(DATA, tmp_path)
    back = record.read(tmp_path)
    assert back == DATA
    assert summary(back) == chart
    header, first = (tmp_path / "trials.csv").read_text(encoding="utf-8").splitlines()[:2]
    assert header.startswith("family,trial,question,method,size,swept,truth,answer,outcome,seconds,why")
    assert first.startswith('boxes,b1,dof,auto,1,"{""gap""')
    (tmp_path / record.RAN).write_text(json.dumps({"ran": 1}))
    with pytest.raises(record.ChartError, match="are not those of a run"):
        record.read(tmp_path)
    with pytest.raises(record.ChartError, match="there is no run in"):
        record.read(tmp_path / "none")


@pytest.mark.sweep
def test_every_figure_is_drawn(tmp_path: Path) -> None:
    chart = summary(DATA)
    bits = replace(SWEEPS[0], knob="bits", method="balls", value=16.0, group="1/9")
    more = [bits, replace(bits, value=64.0), *SWEEPS]
    chart = summary(replace(DATA, sweeps=more))
    drawn = [path.stem for path in figures_table.write(chart, tmp_path)]
    assert drawn == list(figures_table.FIGURES)
    assert all((tmp_path / f"{name}.{end}").stat().st_size > 5000 for name in drawn for end in ("png", "svg"))
    assert set(chart.captions) == set(figures_table.FIGURES)
    assert figures_table.FIGURES["cost"](summary(Data(RAN, LINES[:1]))) is None


# -- the command -----------------------------------------------------------------------------------


@pytest.fixture
def tiny(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two families of our own, answered by methods of our own."""
    families = {"boxes": chart_methods.family, "crates": chart_methods.family}
    monkeypatch.setattr(command, "FAMILIES", families)
    monkeypatch.setattr(runner, "MODULES", ("shared.chart_methods",))
    monkeypatch.setattr(runner, "ANSWERING", "shared.chart_methods:answered")
    monkeypatch.setattr(command, "find_spec", lambda name: None)


@pytest.mark.usefixtures("tiny")
def test_the_command_runs_tells_and_redraws(tmp_path: Path) -> None:
    arguments = ["chart", "--families", "boxes", "--methods", "auto,field", "--quick", "--workers", "1"]
    out = tmp_path / "new" / "folder"
    done = CliRunner().invoke(app, [*arguments, "--out", str(out)])
    assert done.exit_code == 0, done.output
    assert "of the answers of `auto` none is wrong and 0 % are undecided." in " ".join(done.output.split())
    assert "nothing is drawn without matplotlib: pip install 'dofkit[chart]'" in done.output
    data = record.read(out)
    assert len(data.lines) == 2 * 2
    assert {found.outcome for found in data.lines} == {"right"}
    assert data.ran.command == "dofkit chart --families boxes --methods auto,field --quick"
    again = CliRunner().invoke(app, ["chart", "--from", str(out), "--out", str(tmp_path / "again")])
    assert again.exit_code == 0, again.output
    assert record.read(tmp_path / "again") == data


@pytest.mark.usefixtures("tiny")
@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--question", "dofs"], "there is no question 'dofs': did you mean 'dof'?"),
        (["--families", "boxes,crate"], "there is no family 'crate': did you mean 'crates'?"),
        (["--methods", "autos"], "there is no method 'autos': did you mean 'auto'?"),
        (["--families", "zzzzzzzzzzzz"], "the families are boxes, crates"),
        (["--question", "equivalence"], "no trial of these families asks such a question"),
        (["--from", "nowhere"], "there is no run in nowhere"),
        (["--out", "/proc/none"], "nothing can be written to /proc/none"),
    ],
)
def test_what_cannot_be_charted_is_told(arguments: list[str], told: str, tmp_path: Path) -> None:
    if "--out" not in arguments:
        arguments = [*arguments, "--out", str(tmp_path)]
    elif sys.platform != "linux":
        pytest.skip("a folder that nobody may write to")
    done = CliRunner().invoke(app, ["chart", *arguments])
    assert done.exit_code == 2
    assert told in done.output


@pytest.mark.sweep
@pytest.mark.usefixtures("tiny")
def test_an_interrupted_run_keeps_what_it_has(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(work: Sequence[tasks.TrialTask], bench: runner.Bench) -> Any:
        yield bench.line(work[0], bench.submit(work[0]).result())
        raise KeyboardInterrupt

    monkeypatch.setattr(runner, "run", stopped)
    done = CliRunner().invoke(
        app, ["chart", "--families", "boxes", "--quick", "--workers", "1", "--out", str(tmp_path)]
    )
    assert done.exit_code == 130
    assert "interrupted after 1 of " in done.output
    assert "the run was interrupted: this is only a part of it" in done.output
    assert len(record.read(tmp_path).lines) == 1
    assert isinstance(next(chart_methods.family(True)), Trial)
