"""Formats that hold one student: a JSON document each, in a file of its own where there are several."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from dofkit.homework.formats.base import FormatError, Target, opened
from dofkit.homework.formats.wording import FileNames
from dofkit.homework.result import Result

Document = Callable[[Result], dict[str, Any]]


def write_documents(results: Iterator[Result], target: Target, document: Document) -> None:
    """One document a student.

    A stream, or a path that ends in ``.json``, holds one student; any other path is a folder, with a file for each.
    Raises FormatError where a second student does not fit, or where there is none at all for a file.
    """
    if isinstance(target, Path) and (target.is_dir() or target.suffix.lower() != ".json"):
        names = FileNames()
        target.mkdir(parents=True, exist_ok=True)
        for result in results:
            _write(document(result), target / f"{names.of(result.student)}.json")
        return
    first = next(results, None)
    if first is None:
        if isinstance(target, Path):
            raise FormatError(f"there is no submission to write to {target}")
        return
    _write(document(first), target)
    second = next(results, None)
    if second is not None:
        raise FormatError("this format holds one student: give --out a folder, to get one file per student")


def text(document: dict[str, Any]) -> str:
    """A document as ASCII JSON, which every reader takes."""
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def _write(document: dict[str, Any], target: Target) -> None:
    with opened(target) as stream:
        stream.write(text(document))
