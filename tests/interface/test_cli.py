"""The command line: its output, its exit status, and that nothing stops the files that follow."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from shared.command_line import called, interruptible
from shared.late import LONG

import dofkit
from dofkit.interface import options
from dofkit.methods.table import METHODS

GOOD = "coordinates: [x, y]\nconstraints:\n- x dy + y dx = 0\n"
BAD = "coordinates: [theta]\nconstraints:\n- theta = 1\n- thta = 1\n- 2 thtta = 1\n"
ENVIRONMENT = {**os.environ, "NO_COLOR": "1", "PYTHONHASHSEED": "1"}


def run(*arguments: str, stdin: bytes = b"", env: dict[str, str] | None = None) -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, "-m", "dofkit", *arguments]
    return subprocess.run(command, input=stdin, capture_output=True, check=False, env={**ENVIRONMENT, **(env or {})})


@pytest.fixture
def files(tmp_path: Path) -> Path:
    (tmp_path / "good.yaml").write_text(GOOD)
    (tmp_path / "bad.yaml").write_text(BAD)
    (tmp_path / "good.json").write_text(json.dumps({"name": "fromjson", "coordinates": ["x"]}))
    return tmp_path


def lines(text: str) -> list[dict[str, Any]]:
    return [json.loads(line) for line in text.splitlines()]


def test_one_object_a_line_in_the_order_given(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = ["bad.yaml", "good.yaml", "missing.yaml", "good.json"]
    status, out, err = called(capsys, "classify", "--json", *[str(files / name) for name in given])
    told = lines(out)
    assert (status, err) == (2, "")
    assert [line["scene"] for line in told] == ["bad", "good", "missing", "fromjson"]
    assert ["error" in line for line in told] == [True, False, True, False]
    assert told[1]["dof"] == 1
    error = told[0]["error"]
    assert (error["line"], error["column"], error["hint"]) == (4, 3, "did you mean `theta`?")
    assert [(fault["line"], fault["column"]) for fault in error["faults"]] == [(5, 5)]
    assert set(told[2]["error"]) == {"message", "line", "column", "hint", "faults"}
    assert told[2]["error"]["line"] is None


def test_readable_errors_show_the_line_with_a_mark(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(files / "bad.yaml")
    status, out, err = called(capsys, "classify", path)
    assert (status, out) == (2, "")
    assert err.splitlines()[:4] == [
        f"{path}:4:3: error: `thta` is not declared",
        "    4 | - thta = 1",
        "      |   ^",
        "    hint: did you mean `theta`?",
    ]
    assert err.splitlines()[-1] == "2 errors in 1 file"


def test_a_repeated_fault_hides_no_other_and_is_explained_once(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (files / "link.yaml").write_text("particles: [A]\njoints:\n" + 25 * "- {type: link, between: [A, B]}\n" + "- z=1")
    _, _, err = called(capsys, "classify", str(files / "link.yaml"), str(files / "bad.yaml"))
    assert err.count("    see: dofkit explain link\n") == err.count("no particle 'B'") == err.count(":28:3: error") == 1
    assert err.splitlines()[-1] == "28 errors in 2 files"
    assert called(capsys, "explain", "link")[0] == 0


def test_long_lines_are_cut_around_the_mark(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    entries = [f"x = {i}" for i in range(2000)]
    entries[1500] = "thta = 1\x7f"
    (tmp_path / "long.json").write_text(json.dumps({"coordinates": ["x", "theta"], "constraints": entries}))
    _, _, err = called(capsys, "classify", str(tmp_path / "long.json"))
    _, shown, mark, *_ = err.splitlines()
    assert len(shown) < 120
    assert "\x7f" not in shown
    assert shown[mark.index("^") :].startswith("thta")


@pytest.mark.sweep
def test_standard_input_is_a_file() -> None:
    outcome = run("classify", "--json", "-", stdin=GOOD.encode())
    assert (outcome.returncode, lines(outcome.stdout.decode())[0]["scene"]) == (0, "stdin")
    outcome = run("classify", "--json", "-", stdin=b"\xff")
    assert (outcome.returncode, lines(outcome.stdout.decode())[0]["scene"]) == (2, "stdin")
    outcome = run("classify", "-", stdin=BAD.encode())
    assert outcome.stderr.decode().startswith("stdin:4:3: error")


FAILING = """
import sys, dofkit.interface.answers as telling, dofkit.interface.entry
real = telling.lowered
def failing(scene, *others):
    if scene.name == "good":
        raise {error}
    return real(scene, *others)
telling.lowered = failing
sys.argv = ["dofkit", "classify", "--json", *sys.argv[1:]]
dofkit.interface.entry.main()
"""


@pytest.mark.sweep
@pytest.mark.skipif(not hasattr(os, "fork"), reason="what is changed here is not seen by a process of its own")
@pytest.mark.parametrize("error", ["ValueError('boom\\nboom')", "RecursionError()", "DofkitError('no')"])
def test_an_internal_error_does_not_stop_the_others(files: Path, error: str) -> None:
    given = [str(files / "good.yaml"), str(files / "good.json")]
    command = [sys.executable, "-c", FAILING.replace("{error}", error), *given]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    told = lines(done.stdout)
    assert (done.returncode, done.stderr) == (2, "")
    assert told[1]["dof"] == 1
    if not error.startswith("DofkitError"):
        assert error.partition("(")[0] in told[0]["error"]["message"]
        assert "report" in told[0]["error"]["hint"]


def test_a_budget_is_taken(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = called(capsys, "classify", "--json", "--budget", "30", str(files / "good.yaml"))
    assert (status, lines(out)[0]["dof"]) == (0, 1)
    assert called(capsys, "classify", "--budget", "-1", str(files / "good.yaml"))[0] == 2


def test_catalog_lists_and_shows(capsys: pytest.CaptureFixture[str]) -> None:
    assert called(capsys, "catalog")[1].splitlines() == dofkit.catalog_names()
    titles = lines(called(capsys, "catalog", "--json")[1])
    assert [row["name"] for row in titles] == dofkit.catalog_names()
    assert all(row["title"] for row in titles)
    name = dofkit.catalog_names()[0]
    assert called(capsys, "catalog", "show", name)[1] == dofkit.catalog_text(name)
    status, out, err = called(capsys, "catalog", "show", "disc-rolling-on-plain")
    assert (status, out) == (2, "")
    assert "disc-rolling-on-plane" in err


def test_methods_are_those_of_the_table() -> None:
    assert tuple(METHODS) == options.METHODS


def test_the_schema_is_json_schema(capsys: pytest.CaptureFixture[str]) -> None:
    schema = json.loads(called(capsys, "schema")[1])
    assert "constraints" in schema["properties"]
    assert schema["additionalProperties"] is False


def test_version_and_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert called(capsys, "--version")[1].strip() == dofkit.__version__
    status, out, _ = called(capsys, "--help")
    assert status == 0
    first, more = out[out.index(" Commands ") :].split(" More commands ")
    assert re.findall(r"^. (\w+) ", first, re.M) == ["classify", "draw", "animate", "lagrange", "grade"]
    assert all(f" {command} " in more for command in ("new", "catalog", "schema", "assignment"))
    assert "..." not in first + more


@pytest.mark.parametrize(
    "arguments", [["-c", "import dofkit"], ["-m", "dofkit", "--help"], ["-m", "dofkit", "--version"]]
)
def test_little_is_imported_before_it_is_needed(arguments: Sequence[str]) -> None:
    process = subprocess.run(
        [sys.executable, "-X", "importtime", *arguments], capture_output=True, text=True, check=True
    )
    imported = {line.rpartition("|")[2].strip().partition(".")[0] for line in process.stderr.splitlines()}
    assert not imported & {"sympy", "numpy", "pydantic", "scipy", "networkx", "flint", "lark"}


def test_a_misspelt_command_has_a_near_one() -> None:
    for words, meant in (("clasify", "classify"), ("export gradscope", "gradescope")):
        outcome = run(*words.split())
        assert (outcome.returncode, f"Did you mean '{meant}'" in outcome.stderr.decode()) == (2, True)


def test_the_public_names_are_there() -> None:
    assert set(dofkit.__all__) <= set(dir(dofkit))
    code = "import dofkit.methods, dofkit; assert not isinstance(dofkit.classify, type(dofkit))"
    subprocess.run([sys.executable, "-c", code], check=True)
    with pytest.raises(AttributeError, match="attribute clasify"):
        _ = dofkit.clasify


def test_a_terminal_without_utf8_is_no_failure(tmp_path: Path) -> None:
    (tmp_path / "été.yaml").write_text("title: θ → ∞\ncoordinates: [x]\nconstraints: [θ = 1]\n", encoding="utf-8")
    (tmp_path / "ok.yaml").write_text("title: θ → ∞\ncoordinates: [θ]\nconstraints: [θ = 1]\n", encoding="utf-8")
    ascii_only = {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0", "LC_ALL": "C"}
    for extra in ([], ["--json"]):
        outcome = run("classify", *extra, str(tmp_path / "été.yaml"), str(tmp_path / "ok.yaml"), env=ascii_only)
        assert outcome.returncode == 2
        assert b"Traceback" not in outcome.stderr + outcome.stdout
        assert b"is not declared" in outcome.stdout + outcome.stderr


def test_a_closed_pipe_is_no_failure(files: Path) -> None:
    command = f"{sys.executable} -m dofkit classify --json {' '.join([str(files / 'good.yaml')] * 50)} | head -c 10"
    process = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert process.stderr == ""


@pytest.mark.skipif(os.name == "nt", reason="Windows cannot interrupt one process alone")
def test_an_interrupt_is_no_traceback() -> None:
    """It comes while the standard input is read: more is written than a pipe holds, and still more is waited for."""
    with interruptible("classify", "-") as process:
        assert process.stdin is not None
        process.stdin.write(b"#" * (1 << 20))
        process.stdin.flush()
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=LONG)
    assert process.returncode != 0
    assert b"Traceback" not in err
