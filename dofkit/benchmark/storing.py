"""The files of a run: lines as CSV, the summary as JSON, and back."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from dofkit.base.errors import DofkitError
from dofkit.benchmark.record import ChartRun, Data, ReductionCost, TrialLine

TRIALS, SWEEPS, REDUCTIONS, SUMMARY = "trials.csv", "sweeps.csv", "reductions.csv", "chart.json"
#: Columns that hold JSON; the others are plain text or numbers.
_JSON = ("traits", "swept", "truth", "told")
_PLAIN: dict[str, Callable[[str], Any]] = {"size": int, "seconds": float, "value": float}
_COLUMNS = [one.name for one in fields(TrialLine)]


class ChartError(DofkitError):
    """What was asked for cannot be charted, read or written."""


def write(data: Data, chart: ChartRun, out: Path) -> list[Path]:
    """Write all data of a run into a folder, which is there. Raises OSError."""
    paths = [_lines(out / TRIALS, data.lines), _lines(out / SWEEPS, data.sweeps)]
    paths.append(_rows(out / REDUCTIONS, data.reductions))
    (out / SUMMARY).write_text(chart.model_dump_json(indent=1) + "\n", encoding="utf-8")
    return [*paths, out / SUMMARY]


def read(folder: Path) -> Data:
    """The data of a run. Raises ChartError where they are not there, or not whole."""
    try:
        chart = ChartRun.model_validate_json((folder / SUMMARY).read_text(encoding="utf-8"))
        lines, swept = (list(_read_lines(folder / name)) for name in (TRIALS, SWEEPS))
    except OSError as error:
        raise ChartError(f"there is no run in {folder}: {error.strerror} ({error.filename})") from None
    except (ValidationError, ValueError, KeyError, TypeError) as error:
        said = str(error).splitlines()[0]
        raise ChartError(f"the files in {folder} are not those of a run of this version: {said}") from None
    return Data(chart.ran, lines, swept, chart.reductions)


def _lines(path: Path, lines: Iterable[TrialLine]) -> Path:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(_COLUMNS)
        for line in lines:
            cells = {name: getattr(line, name) for name in _COLUMNS}
            cells |= {name: json.dumps(cells[name], ensure_ascii=False, sort_keys=True) for name in _JSON}
            cells["seconds"] = f"{line.seconds:.6g}"
            table.writerow(cells.values())
    return path


def _read_lines(path: Path) -> Iterable[TrialLine]:
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            cells: dict[str, Any] = {name: row[name] for name in _COLUMNS}
            cells |= {name: json.loads(row[name]) for name in _JSON}
            cells |= {name: number(row[name]) for name, number in _PLAIN.items()}
            cells["traits"] = tuple(cells["traits"])
            yield TrialLine(**cells)


def _rows(path: Path, rows: Sequence[BaseModel]) -> Path:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(ReductionCost.model_fields)
        for row in rows:
            cells = row.model_dump()
            table.writerow(json.dumps(v, ensure_ascii=False) if isinstance(v, list) else v for v in cells.values())
    return path
