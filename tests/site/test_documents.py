"""Every block of code in the README and the site runs, and prints what is shown."""

from __future__ import annotations

from pathlib import Path

import pytest
from shared.documented import (
    DOCUMENTS,
    INSTALLS,
    ROOT,
    Block,
    Command,
    blocks_of,
    commands_of,
    holds,
    name_of,
    run,
    run_command,
    written_to,
)

import dofkit

#: Kinds of blocks: data, what runs, and what is shown.
KINDS = {"yaml", "xml", "csv", "python", "sh", "text"}
#: Files that are no scene, or one with faults.
NO_SCENES = ("sheet.yaml", "pendulum-sheet.yaml", "ada.yaml", "broken.yaml")
PROGRAMS = [(document, block) for document in DOCUMENTS for block in blocks_of(document) if block.kind == "python"]
COMMANDS = [(document, command) for document in DOCUMENTS for command in commands_of(document)]
SCENES = [
    (document, block.text)
    for document in DOCUMENTS
    for block in blocks_of(document)
    if block.kind == "yaml" and block.title not in NO_SCENES
]


def test_every_block_is_of_a_kind_that_is_tested() -> None:
    assert {block.kind for document in DOCUMENTS for block in blocks_of(document)} <= KINDS
    assert all("```" not in block.text for document in DOCUMENTS for block in blocks_of(document))


@pytest.mark.sweep
@pytest.mark.parametrize(
    "program", [block for _, block in PROGRAMS], ids=[name_of(document) for document, _ in PROGRAMS]
)
def test_python_runs(program: Block, tmp_path: Path) -> None:
    outcome = run(written_to(tmp_path), "-c", program.text)
    assert outcome.returncode == 0, outcome.stderr
    assert holds(outcome.stdout, program.printed), outcome.stdout


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("document", "command"), [pytest.param(document, command, id=command.line) for document, command in COMMANDS]
)
def test_commands_run(document: Path, command: Command, tmp_path: Path) -> None:
    folder = written_to(tmp_path)
    read = {word.partition("/")[0] for word in command.line.split() if not (folder / word).exists()}
    for line in [before.line for before in commands_of(document)][: list(commands_of(document)).index(command)]:
        if {*line.partition("--out ")[2].split()[:1], *line.partition("--certificate ")[2].split()[:1]} & read:
            run_command(folder, line)
    told = run_command(folder, command.line)
    assert told.returncode == command.status, told.stderr
    assert holds(told.stdout + told.stderr, command.printed), told.stdout + told.stderr
    words = command.line.split()
    assert told.stdout or told.returncode or (folder / words[words.index("--out") + 1]).exists()


@pytest.mark.parametrize("text", [text for _, text in SCENES], ids=[name_of(document) for document, _ in SCENES])
def test_scenes_load(text: str) -> None:
    scene = dofkit.loads(text)
    assert scene.constraints or scene.picture


def test_lines_that_install_are_what_is_run() -> None:
    ci = (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
    lines = [line for d in DOCUMENTS for b in blocks_of(d) if b.kind == "sh" for line in b.text.splitlines()]
    assert all(line in ci for line in lines if line.startswith(INSTALLS))
