"""The charts: trials bounded in their own workers, Pareto fronts and exponents by hand, files that are read back."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from shared import chart_methods
from typer.testing import CliRunner

from dofkit.base.runs import Pool
from dofkit.benchmark import command, figures, record, runner, statistics, tasks
from dofkit.benchmark.record import AUTO, Data, Outcome, Ran, TrialLine
from dofkit.benchmark.runner import outcome_of
from dofkit.benchmark.sentences import caption
from dofkit.benchmark.statistics import Score
from dofkit.benchmark.tasks import ChartOptions
from dofkit.benchmark.trials import FAMILIES
from dofkit.benchmark.trials.construction import Trial
from dofkit.interface.cli import app

RAN = Ran(
    version="0",
    command="dofkit chart --quick",
    date="2026-01-02T03:04:05Z",
    machine="a machine",
    cores=2,
    python="3.11",
    workers=2,
    limit=4.0,
    trials=8,
    minutes=1.5,
    complete=True,
)


def ran(methods: Sequence[str], limit: float = 0.3) -> list[TrialLine]:
    """The trials of the family by these methods, in two workers."""
    with Pool(2, modules=("dofkit.benchmark.runner", "shared.chart_methods")) as pool:
        bench = runner.Bench(pool, limit, "shared.chart_methods:answered")
        work = [tasks.TrialTask(trial, method) for trial in chart_methods.family() for method in methods]
        return list(runner.run(work, bench))


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
    assert sorted(sizes[:4]) == [1, 1, 2, 2]
    assert sizes[4:].index(4) < sizes[4:].index(8)
    trial = next(chart_methods.family())
    one, other = tasks.TrialTask(trial, "m"), tasks.TrialTask(replace(trial, size=7, name="box-7-0"), "m")
    assert one.ladder == other.ladder
    another = tasks.TrialTask(replace(trial, name="box-1-0, 3 digits"), "m")
    assert len({one.ladder, another.ladder, tasks.TrialTask(trial, "n").ladder}) == 3


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


def asked(methods: Sequence[str] = ("auto",), quick: bool = False) -> ChartOptions:
    return ChartOptions(Path(), questions=["dof"], methods=methods, quick=quick)


def test_of_many_trials_some_are_taken_from_the_smallest_to_the_largest() -> None:
    trials = [replace(t, name=f"{t.name}{k}") for t in chart_methods.family() for k in range(8)]
    chosen = [task.trial for task in asked().tasks({"boxes": lambda: iter(trials)})]
    assert (len(trials), len(chosen), chosen[0].size, chosen[-1].size) == (64, tasks.MOST, 1, 8)
    assert [t.size for t in chosen] == sorted(t.size for t in chosen)
    assert [t.trial.size for t in asked(quick=True).tasks({"boxes": chart_methods.family})] == [1]
    command = asked(methods=["auto", "field"], quick=True).command()
    assert command == "dofkit chart --question dof --methods auto,field --quick"


@pytest.mark.sweep
def test_sweeps_set_what_the_method_computes_with() -> None:
    families = {"rounded, with tolerance": FAMILIES["rounded, with tolerance"]}
    found = ChartOptions(Path(), methods=["numeric,balls"]).sweeps(families)
    assert {task.method for task in found} == {"numeric"}
    assert {task.value for task in found} == set(tasks.TOLERANCES)
    drawn = [task for task in found if task.trial.name.startswith("two bars in line, 6 digits")]
    with Pool(1) as pool:
        lines = list(runner.run(drawn, runner.Bench(pool, 2.0, runner.ANSWERING)))
    # the joint 1e-6 off the line: the smaller singular value is some 1e-6 of the larger, and rigid is right
    assert {line.value: line.answer for line in lines if line.value in (1e-8, 1e-4)} == {1e-8: 0, 1e-4: 1}


# -- what the lines say ----------------------------------------------------------------------------


def score(method: str, seconds: float | None, right: int, wrong: int) -> Score:
    """Of ten trials."""
    return Score(method, {"right": right, "wrong": wrong, "undecided": 10 - right - wrong}, 10, *[seconds] * 3)


def test_the_pareto_front_by_hand() -> None:
    fast = score("fast", 1, 5, 5)
    sound = score("sound", 2, 4, 0)
    best = score(AUTO, 3, 10, 0)
    slow = score("slow", 4, 10, 0)  # beaten by auto: as right, slower
    worse = score("worse", 2.5, 4, 1)  # beaten by sound
    none = score("none", 0.1, 0, 0)  # never right
    members = [best, slow, fast, worse, none, sound]
    assert statistics.front(members) == [fast, sound, best]
    assert statistics.front([score for score in members if not score.share("wrong")]) == [sound, best]
    assert statistics.beats(best, slow)
    assert not statistics.beats(best, best)


def line(trial: str, method: str, outcome: Outcome, seconds: float, size: int = 1) -> TrialLine:
    """A line about a family of boxes."""
    told = {"right": 2, "wrong": 3}.get(outcome)
    why = "" if outcome == "right" else 'because, he said, "no"; θ'
    return TrialLine("boxes", trial, "dof", method, size, 2, told, outcome, seconds, why)


LINES = [
    *(line(f"b{n}", AUTO, "right", 0.002 * n, n) for n in (1, 2, 4, 8)),
    *(line(f"b{n}", "graph", "right", 0.0005 * n, n) for n in (1, 2, 4, 8)),
    *(line(f"b{n}", "symbolic", "right" if n < 8 else "timed out", min(4.0, 0.1 * n**2), n) for n in (1, 2, 4, 8)),
    line("b1", "count", "right", 0.0001),
    line("b2", "count", "wrong", 0.0001),
    line("b4", "count", "undecided", 0.0001),
    line("b8", "count", "cannot", 0.0001),
]
SWEPT = [
    replace(line(f"b, {digits} digits", "numeric", outcome, 0.1), setting="tolerance", value=value)
    for digits, outcome, value in ((3, "right", 1e-9), (3, "wrong", 0.1), (9, "undecided", 0.1), (9, "right", 1e-9))
]
DATA = Data(RAN, LINES, SWEPT)


def test_scores_and_auto_against_the_fastest() -> None:
    by_method = statistics.scores(LINES)
    assert by_method["count"].counts == {"right": 1, "wrong": 1, "undecided": 1, "cannot": 1}
    assert (by_method["count"].median, by_method["count"].share_unanswered) == (0.0001, 0.5)
    assert by_method["symbolic"].counts["timed out"] == 1
    assert by_method[AUTO].median == pytest.approx(0.006)
    (against,) = statistics.against(LINES)
    assert against.fastest == "graph"
    assert against.ratio == pytest.approx(4)
    assert (against.sound, against.sound_ratio) == ("graph", pytest.approx(4))
    assert list(command.auto_sentences(DATA)) == [
        "8 trials by 4 methods, at most 4 s each: of the answers of `auto` none is wrong and 0 % are undecided.",
        "On 0 of 1 families `auto` takes at most twice the time of the fastest method that is right there and wrong "
        "nowhere; with those that are right there by luck it does on 0 of 1.",
        "  dof, boxes: 4.0 times graph",
    ]
    assert all(caption(name, DATA).endswith("Made by: dofkit chart --quick") for name in figures.FIGURES)


# -- files -----------------------------------------------------------------------------------------


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    record.write(DATA, tmp_path)
    back = record.read(tmp_path)
    assert back == DATA
    header, first = (tmp_path / "trials.csv").read_text(encoding="utf-8").splitlines()[:2]
    assert header.startswith("family,trial,question,method,size,truth,answer,outcome,seconds,why,setting,value")
    assert first.startswith("boxes,b1,dof,auto,1,2,2,right,0.002,")
    (tmp_path / record.RAN).write_text(json.dumps({"ran": 1}))
    with pytest.raises(record.ChartError, match="are not those of a run"):
        record.read(tmp_path)
    with pytest.raises(record.ChartError, match="there is no run in"):
        record.read(tmp_path / "none")


@pytest.mark.sweep
def test_every_figure_is_drawn(tmp_path: Path) -> None:
    lines = [replace(row, family=family) for row in LINES for family in ("trailers", "boxes")]
    drawn = [path.stem for path in figures.write(Data(RAN, lines, SWEPT), tmp_path)]
    assert drawn == list(figures.FIGURES)
    assert all((tmp_path / f"{name}.{end}").stat().st_size > 5000 for name in drawn for end in ("png", "svg"))
    assert figures.FIGURES["cost"](Data(RAN, LINES[:1])) is None


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
    assert len(data.lines) == 2
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
def test_what_cannot_be_charted_is_reported(arguments: list[str], told: str, tmp_path: Path) -> None:
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
    assert isinstance(next(chart_methods.family()), Trial)
