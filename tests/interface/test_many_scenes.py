"""Many scenes, parts of a report, what if, what fails a run, what a word means: the command line for everyday use."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from shared.command_line import called
from shared.known_scenes import swept

import dofkit
from dofkit.interface import cli
from dofkit.interface.classification import Summary
from dofkit.interface.output import colours_of, progress
from dofkit.interface.show.report import changed
from dofkit.interface.show.sheet import Remark
from dofkit.report import FieldVerdict

FOUR = ("atwood-machine", "disc-rolling-on-plane", "five-particles-ten-links", "four-bar-linkage")
DOOR = """
bodies: [door]
constraints:
- {name: lower, type: revolute, between: [ground, door], at: [0, 0, 0], axis: [0, 0, 1]}
- {name: upper, type: revolute, between: [ground, door], at: [0, 0, 2], axis: [0, 0, 1]}
"""


@pytest.fixture(autouse=True)
def plain(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("FORCE_COLOR", "NO_COLOR", "COLORTERM"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("COLUMNS", "80")


@pytest.fixture
def door(tmp_path: Path) -> str:
    file = tmp_path / "door.yaml"
    file.write_text(DOOR, encoding="utf-8")
    return str(file)


# Many


@pytest.mark.sweep
def test_more_than_three_scenes_are_a_line_each_and_a_summary(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = called(capsys, "classify", *FOUR)
    lines = out.splitlines()
    assert (status, err) == (0, "")
    assert lines[0].split() == ["scene", "f", "v", "system", "verdict"]
    assert [line.split()[:3] for line in lines[1:5]] == [
        ["atwood-machine", "1", "1"],
        ["disc-rolling-on-plane", "4", "2"],
        ["five-particles-ten-links", "6", "6"],
        ["four-bar-linkage", "1", "1"],
    ]
    assert lines[3].endswith("proved     1 redundant")
    assert re.fullmatch(r"4 scenes in [\d.]+ s: 4 proved", lines[6])
    assert lines[7:9] == ["  agree with the answers in their files: 4 of 4", "  1 with redundant constraints"]
    assert lines[9].startswith("  slowest: ")


@pytest.mark.sweep
def test_three_are_in_full_and_so_are_all_that_are_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    assert called(capsys, "classify", *FOUR[:3])[1].count("degrees of freedom  ") == 3
    assert called(capsys, "classify", "--full", *FOUR)[1].count("degrees of freedom  ") == 4
    assert called(capsys, "classify", "--how", *FOUR)[1].count("\nHow\n") == 4
    assert called(capsys, "classify", "--brief", FOUR[0])[1].splitlines()[1].startswith("atwood-machine")
    assert "scenes in" not in called(capsys, "classify", FOUR[0])[1]


@pytest.mark.sweep
def test_what_cannot_be_read_and_what_is_otherwise_than_expected_is_counted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text("coordinates: [x, y]\nconstraints:\n- x = y\nexpect: {dof: 2, redundant: []}\n", encoding="utf-8")
    status, out, err = called(capsys, "classify", "--brief", str(wrong), "nonsense", FOUR[0])
    assert status == 2
    assert "3 scenes in" in out
    assert "2 proved, 1 could not be read" in out
    assert "agree with the answers in their files: 1 of 2\n  differ from the answers in their files: wrong\n" in out
    assert "there is no file 'nonsense'" in err
    assert (
        "Differs from what the scene expects\n  ! dof: 2 expected, but the report has 1\n"
        in called(capsys, "classify", str(wrong))[1]
    )


def test_the_summary_counts_and_names_the_slowest() -> None:
    summary = Summary()
    for name, verdict, seconds in (("a", "proved", 0.25), ("b", "numeric", 12.3), ("c", "undecided", 0.5)):
        found = ["undecided"] if verdict == "undecided" else []
        summary.add({"scene": name, "verdict": verdict, "is": found, "seconds": seconds}, seconds + 1)
    summary.add(None, 100.0)
    assert list(summary.lines()) == [
        "4 scenes in 116 s: 1 proved, 1 numeric, 1 undecided, 1 could not be read",
        "  slowest: b 12.3 s, c 0.5 s, a 0.25 s",
    ]
    assert summary.fails(("undecided",))
    assert not summary.fails(("redundant", "infeasible"))


def test_progress_is_for_a_terminal_and_goes_again(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setenv("TERM", "xterm")
    seen, unseen = Terminal(), io.StringIO()
    for stream in (seen, unseen):
        with progress("[2/2] \x1b[31m.yaml", stream):
            pass
    assert unseen.getvalue() == ""
    assert "[2/2] ?[31m.yaml" in seen.getvalue()
    assert "\x1b[2K" in seen.getvalue().partition(".yaml")[2]


# Parts of a report, and what if


def test_only_some_fields(capsys: pytest.CaptureFixture[str]) -> None:
    assert called(capsys, "classify", "--only", "dof", FOUR[1])[1] == "disc-rolling-on-plane  dof 4 (proved)\n"
    _, out, _ = called(capsys, "classify", "--only", "velocity_dof,growth_vector", "--only", "verdict", FOUR[1])
    assert out == "disc-rolling-on-plane  velocity_dof 2 (proved)  growth_vector [2, 3, 4] (proved)  verdict proved\n"
    _, out, _ = called(capsys, "classify", "--json", "--only", "dof,redundant", *FOUR[2:])
    assert [json.loads(line) for line in out.splitlines()] == [
        {"scene": FOUR[2], "dof": 6, "redundant": dofkit.classify(FOUR[2]).redundant},
        {"scene": FOUR[3], "dof": 1, "redundant": []},
    ]
    status, _, err = called(capsys, "classify", "--only", "doff", FOUR[1])
    assert status == 2
    assert "did you mean 'dof'?" in err


@pytest.mark.sweep
def test_without_a_constraint(door: str, capsys: pytest.CaptureFixture[str]) -> None:
    """A door on two hinges: of the second hinge's 5 equations none is needed."""
    _, out, _ = called(capsys, "classify", "--without", "upper", door)
    assert "Without upper\n  redundant equations: 5 -> 0\n" in out
    assert "lower" in out.partition("Constraints\n")[2].partition("Why")[0]
    assert "upper" not in out.partition("Constraints\n")[2].partition("Why")[0]
    _, out, _ = called(capsys, "classify", "--without", "upper,lower", door)
    assert "Without upper, lower\n  degrees of freedom: 1 -> 6\n  velocity freedom: 1 -> 6\n" in out
    _, out, _ = called(capsys, "classify", "--json", "--without", "lower", door)
    assert [entry["name"] for entry in json.loads(out)["constraints"]] == ["upper"]
    status, _, err = called(capsys, "classify", "--without", "uper", door)
    assert status == 2
    assert "there is no constraint 'uper' (did you mean 'upper'?)" in err


def test_a_redundant_one_is_not_missed(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    file = tmp_path / "twice.yaml"
    file.write_text("coordinates: [x]\nconstraints: [x >= 0, 2 x >= 0]\n", encoding="utf-8")
    _, out, _ = called(capsys, "classify", "--without", "c2", str(file))
    assert "Without c2\n  no degree of freedom, no count and no label changes\n" in out
    _, out, _ = called(capsys, "classify", "--without", "c2,c1", str(file))
    assert "Without c2, c1\n  system: non-holonomic, scleronomic -> holonomic, scleronomic\n" in out


def test_what_is_undecided_is_not_said_to_be_the_same() -> None:
    report = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x = y"]})
    sure = {**report.verdicts, "dof": FieldVerdict(verdict="undecided")}
    unsure = report.model_copy(update={"dof": None, "verdicts": sure})
    said = changed(unsure, unsure, ["c1"]).content
    assert said == [Remark("undecided", "it is undecided whether these change: degrees of freedom")]


# Exit status


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("coordinates: [x]\nconstraints: [x = 1, x = 2]", "inconsistent"),
        swept("coordinates: [x]\nconstraints: [x >= 2, x <= 1]", "infeasible"),
        swept("coordinates: [x, y]\nconstraints: [x = y, x = y]", "redundant"),
    ],
)
def test_a_run_fails_on_what_it_is_reported(
    text: str, what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(text, encoding="utf-8")
    others = ",".join(name for name in ("inconsistent", "infeasible", "redundant") if name != what)
    assert called(capsys, "classify", str(file))[0] == 0
    assert called(capsys, "classify", "--fail-on", what, str(file))[0] == 1
    assert called(capsys, "classify", "--json", "--fail-on", f"undecided,{what}", str(file))[0] == 1
    assert called(capsys, "classify", "--fail-on", others, str(file))[0] == 0
    assert called(capsys, "classify", "--fail-on", what, str(file), "nonsense")[0] == 2
    status, _, err = called(capsys, "classify", "--fail-on", "inconsistant", str(file))
    assert status == 2
    assert "'inconsistent'" in err


# Words


@pytest.mark.parametrize(
    ("word", "kind", "said"),
    [
        ("NH_HALF", "feedback code", "Half of each"),
        ("nh-half", "feedback code", "Half of each"),
        ("velocity freedom", "term", "velocity_dof"),
        ("velocity_dof", "field of a report", "non-holonomic constraints reduce it"),
        ("circuit", "field of a constraint", "minimal set"),
        ("proved", "verdict", "exact arithmetic"),
        ("regular point", "argument", "ImplicitFunctions"),
        ("Laman1970", "theorem", "minimally rigid"),
        ("revolute", "constraint type", "between (the two bodies"),
        ("rheonomic", "term", "Time occurs explicitly"),
        ("hinge", "synonym", "`revolute`"),
    ],
)
def test_words_are_explained(word: str, kind: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = called(capsys, "explain", *word.split())
    assert (status, err) == (0, "")
    assert f": {kind}\n" in out
    assert said in " ".join(out.split())
    document = json.loads(called(capsys, "explain", word, "--json")[1].splitlines()[0])
    assert document["kind"] == kind


def test_an_unknown_word_has_near_ones(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = called(capsys, "explain", "holonmic")
    assert (status, out) == (2, "")
    assert "did you mean `holonomic`?" in err
    _, out, _ = called(capsys, "explain")
    assert "theorem\n" in out
    assert "velocity_dof" in out


def test_every_code_field_and_theorem_is_explained() -> None:
    """Codes are found in the sources, wherever a judgement names one."""
    from dofkit.interface.explanations import all_explanations
    from dofkit.report import ConstraintEntry, Report

    known = {told.word for told in all_explanations()}
    assert all(told.meaning.strip(". ") for told in all_explanations())
    assert set(Report.model_fields) | set(ConstraintEntry.model_fields) <= known
    root = Path(dofkit.__file__).parent
    theorems = re.findall(r"^\| `(\w+)`", (root / "THEOREMS.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert len(theorems) > 40
    assert set(theorems) <= known
    sources = [*(root / "homework").rglob("*.py"), root / "classification/equivalence.py"]
    pattern = re.compile(r'"([A-Z][A-Z]+(?:_[A-Z0-9]+)+)"')
    codes = {code for file in sources for code in pattern.findall(file.read_text(encoding="utf-8"))}
    assert "NOT_INTEGRATED" in codes
    environment = {code for code in codes if code.startswith(("DOFKIT_", "PL_"))}
    assert codes - environment <= known


def test_the_catalog_is_searched(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = called(capsys, "catalog", "rolling", "disc")
    assert status == 0
    assert any(
        re.fullmatch(r"disc-rolling-on-plane +Upright disc rolling on a plane", line) for line in out.splitlines()
    )
    told = [json.loads(line) for line in called(capsys, "catalog", "four-bar", "--json")[1].splitlines()]
    assert {"name": "four-bar-linkage", "title": "Planar four-bar linkage"} in told
    status, out, err = called(capsys, "catalog", "four-bar-linkige")
    assert (status, out) == (2, "")
    assert "did you mean 'four-bar-linkage'?" in err
    assert called(capsys, "catalog")[1].splitlines() == dofkit.catalog_names()


@pytest.mark.sweep
def test_shells_complete_names(capfd: pytest.CaptureFixture[str]) -> None:
    def completed(words: str) -> list[str]:
        asked = {"_DOFKIT_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
        code = "import sys; sys.argv = ['dofkit']; from dofkit.interface.entry import main; main()"
        process = subprocess.run(
            [sys.executable, "-c", code], env={**os.environ, **asked}, capture_output=True, text=True, check=False
        )
        return process.stdout.split()

    assert "disc-rolling-on-plane" in completed("dofkit classify disc-r")
    assert completed("dofkit explain velocity_d") == ["velocity_dof"]
    assert "--install-completion" in called_help(capfd)


def called_help(capfd: pytest.CaptureFixture[str]) -> str:
    with pytest.raises(SystemExit):
        cli.app(["--help"])
    return capfd.readouterr().out


# Colours


@pytest.mark.parametrize(
    ("terminal", "environment", "colours"),
    [
        (True, {"TERM": "xterm"}, "standard"),
        (True, {"TERM": "xterm-256color"}, "256"),
        (True, {"TERM": "xterm", "COLORTERM": "truecolor"}, "truecolor"),
        (True, {"TERM": "dumb"}, None),
        (False, {"TERM": "xterm"}, None),
        (False, {"TERM": "xterm", "FORCE_COLOR": "1"}, "standard"),
        (True, {"TERM": "xterm", "NO_COLOR": "1"}, None),
        (False, {"TERM": "xterm", "NO_COLOR": "1", "FORCE_COLOR": "1"}, None),
    ],
)
def test_who_gets_colours(
    terminal: bool, environment: dict[str, str], colours: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Stream(io.StringIO):
        def isatty(self) -> bool:
            return terminal

    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert colours_of(Stream()) == colours


@pytest.mark.sweep
def test_forced_colours_are_in_reports_lines_and_faults(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "bad.yaml").write_text("coordinates: [x]\nconstraints: [y = 1]\n", encoding="utf-8")
    monkeypatch.setenv("FORCE_COLOR", "1")
    for more in ([], ["--brief"]):
        command = [sys.executable, "-m", "dofkit", "classify", *more, FOUR[1], str(tmp_path / "bad.yaml")]
        process = subprocess.run(command, capture_output=True, text=True, check=False)
        assert "\x1b[32mproved" in process.stdout
        assert "\x1b[1;31merror\x1b[0m: `y` is not declared" in process.stderr
        assert "\x1b[1;31m^\x1b[0m" in process.stderr
    process = subprocess.run([*command[:4], "--json", FOUR[1]], capture_output=True, text=True, check=False)
    assert "\x1b" not in process.stdout
    monkeypatch.setenv("FORCE_COLOR", "0")
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "\x1b" not in process.stdout + process.stderr
