"""The code of documents: what it is, and what happens where a reader runs it.

A block with a title is a file of the reader's. What stands under `text` right after a block that runs is what it
prints; lines of `...` stand for any others.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
SITE = ROOT / "dofkit" / "site" / "pages"
DOCUMENTS = [README, *sorted(SITE.rglob("*.md"))]
_FENCE = re.compile(r"^```(\w+)(?: title=\"([^\"]+)\")?\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_STATUS = re.compile(r"# exit status (\d)$")
#: Commands of a shell that are no dofkit's, as they begin.
INSTALLS = ("python3 -m venv ",)


class Block(NamedTuple):
    """A fenced block: its language, the file that it is, its text, and what it is said to print."""

    kind: str
    title: str
    text: str
    printed: str = ""


class Command(NamedTuple):
    """A line of a shell, the status it ends with, and what it is said to print."""

    line: str
    status: int
    printed: str


def name_of(document: Path) -> str:
    """A document's name in reports of tests."""
    return document.name if document == README else str(document.relative_to(SITE))


def blocks_of(document: Path) -> list[Block]:
    """Every block of a document in order; what one prints is within it."""
    found: list[Block] = []
    for match in _FENCE.finditer(document.read_text(encoding="utf-8")):
        kind, title, text = match.groups()
        before = document.read_text(encoding="utf-8")[: match.start()].rstrip()
        if kind == "text" and found and before.endswith("```") and found[-1].kind in ("sh", "python"):
            found[-1] = found[-1]._replace(printed=text)
        else:
            found.append(Block(kind, title or "", text))
    return found


def files() -> dict[str, str]:
    """The reader's files, of all documents. A name belongs to one text."""
    named: dict[str, str] = {}
    for document in DOCUMENTS:
        for block in blocks_of(document):
            if block.title:
                assert named.setdefault(block.title, block.text) == block.text, block.title
    return named


def written_to(folder: Path) -> Path:
    """The folder with all files of the reader's in it."""
    for name, text in files().items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def commands_of(document: Path) -> Iterator[Command]:
    """Every line of a shell that is dofkit's; what is printed belongs to the last of a block."""
    for block in blocks_of(document):
        lines = [line for line in block.text.splitlines() if line] if block.kind == "sh" else []
        for number, line in enumerate(lines, 1):
            if not line.startswith(INSTALLS):
                told = _STATUS.search(line)
                yield Command(line, int(told[1]) if told else 0, block.printed if number == len(lines) else "")


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Python with these arguments where the reader's files are."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "80", "NO_COLOR": "1"}
    command = [sys.executable, *arguments]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def run_command(folder: Path, line: str) -> subprocess.CompletedProcess[str]:
    """A line that begins with `dofkit`; what would fetch wheels from a network leaves them out."""
    program, *arguments = shlex.split(line, comments=True)
    assert program == "dofkit", line
    return run(folder, "-m", "dofkit", *arguments)


def holds(told: str, shown: str) -> bool:
    """Does the output hold what is shown, piece by piece between lines of `...`?"""
    place = 0
    for piece in pieces(shown):
        place = told.find(piece, place)
        if place < 0:
            return False
        place += len(piece)
    return True


def pieces(shown: str) -> Sequence[str]:
    """What stands between the lines of `...`."""
    return [piece for piece in re.split(r"^\.\.\.$\n?", shown, flags=re.MULTILINE) if piece]
