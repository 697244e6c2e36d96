"""dofkit's own format: one JSON object a line for every submission."""

from __future__ import annotations

from collections.abc import Iterator

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import Format, Target, opened
from dofkit.homework.result import Result


def write(results: Iterator[Result], prepared: Prepared, target: Target) -> None:
    """Every result on its line, as soon as it is there."""
    del prepared
    with opened(target) as stream:
        for result in results:
            stream.write(result.model_dump_json() + "\n")
            stream.flush()


NATIVE = Format("native", write, endings=("jsonl",))
