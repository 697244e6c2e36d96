"""The README runs: its scenes, its Python, its commands; and the continuous integration runs the very same lines."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import dofkit

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
INSTALLS = [text.strip() for kind, text in BLOCKS if kind == "sh" and "-m venv" in text]
COMMANDS = [
    line for kind, text in BLOCKS if kind == "sh" and "-m venv" not in text for line in text.splitlines() if line
]
SCENES, SHEETS, SUBMISSIONS = (
    [
        text
        for kind, text in BLOCKS
        if kind == "yaml" and [key in text for key in ("\nproblems:", "\nanswers:")] == found
    ]
    for found in ([False, False], [True, False], [False, True])
)
DOOR = """
bodies: [door]
constraints:
- {name: lower, type: revolute, between: [ground, door], at: [0, 0, 0], axis: [0, 0, 1]}
- {name: upper, type: revolute, between: [ground, door], at: [0, 0, 2], axis: [0, 0, 1]}
"""
TABLE = "student,disc.f,disc.label\ngrace,4,non-holonomic and scleronomic\n"


def blocks(kind: str) -> list[str]:
    return [text for found, text in BLOCKS if found == kind]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    files = {
        "disc.yaml": SCENES[0],
        "door.yaml": DOOR,
        "sheet.yaml": SHEETS[0],
        "ada.yaml": SUBMISSIONS[0],
        "class.csv": TABLE,
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "80", "NO_COLOR": "1"}
    command = [sys.executable, *arguments]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def test_the_two_commands_are_one_line_each_and_are_what_is_run() -> None:
    ci = (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
    assert len(INSTALLS) == 2
    for line in INSTALLS:
        assert "\n" not in line
        assert line in ci


@pytest.mark.parametrize("text", blocks("python"))
def test_python_runs(folder: Path, text: str) -> None:
    told = run(folder, "-c", text)
    assert told.returncode == 0, told.stderr
    assert told.stdout


@pytest.mark.parametrize("line", COMMANDS)
def test_commands_run(folder: Path, line: str) -> None:
    program, *arguments = shlex.split(line, comments=True)
    assert program == "dofkit"
    if arguments[0] == "verify":  # what the line before it writes
        run(folder, "-m", "dofkit", *shlex.split(COMMANDS[COMMANDS.index(line) - 1])[1:])
    told = run(folder, "-m", "dofkit", *arguments, *(["--no-wheels"] if "gradescope" in arguments else []))
    assert told.returncode == 0, told.stderr
    assert told.stdout or (folder / arguments[arguments.index("--out") + 1]).exists()


@pytest.mark.parametrize("text", SCENES)
def test_scenes_load(text: str) -> None:
    assert dofkit.loads(text).constraints


def test_the_homework_is_graded_as_it_says(folder: Path) -> None:
    result = dofkit.grade(folder / "sheet.yaml", folder / "ada.yaml")
    assert (result.score, result.max_score) == (7, 9)
    assert "Ada gets 7 of 9: 2 is the number of the disc's velocities" in README
    assert result.items[0].codes[0] == "OTHER_CONVENTION"


def test_the_output_shown_is_what_is_printed(folder: Path) -> None:
    shown = blocks("text")[0]
    told = run(folder, "-m", "dofkit", "classify", "disc.yaml").stdout
    assert told.startswith(shown.removesuffix("...\n"))
