"""The record of a run: a line for every trial and method, and the files with these lines."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any, Literal

from dofkit.base.errors import DofkitError

#: ``cannot``: the method never answers such a question or scene; ``undecided``: it gave no answer, or failed.
Outcome = Literal["right", "wrong", "undecided", "timed out", "cannot"]
OUTCOMES: tuple[Outcome, ...] = ("right", "wrong", "undecided", "timed out", "cannot")
#: The method that is compared with all others.
AUTO = "auto"


@dataclass(frozen=True)
class TrialLine:
    """The answer of a method to a trial: a line of ``trials.csv`` or of ``sweeps.csv``.

    ``answer`` is None if there was none; ``seconds``: processor time (the limit, if timed out); ``why``: a sentence why
    the outcome is not ``right``; in sweeps, ``setting`` has this ``value``.
    """

    family: str
    trial: str
    question: str
    method: str
    size: int
    truth: Any
    answer: Any
    outcome: Outcome
    seconds: float
    why: str = ""
    setting: str = ""
    value: float | None = None


@dataclass(frozen=True)
class Ran:
    """The description of a run. The ``command`` reproduces its answers; times depend on the machine.

    ``version``: dofkit's; ``date``: of its beginning in UTC; ``machine``: the name of the processor; ``limit``: seconds
    of processor time for a trial and method; ``trials``: their number for one method; ``minutes``: wall-clock time;
    ``complete``: false if it was interrupted.
    """

    version: str
    command: str
    date: str
    machine: str
    cores: int
    python: str
    workers: int
    limit: float
    trials: int
    minutes: float
    complete: bool


@dataclass(frozen=True)
class Data:
    """The description of a run (``ran``), and the lines of its trials and its sweeps."""

    ran: Ran
    lines: list[TrialLine] = field(default_factory=list)
    sweeps: list[TrialLine] = field(default_factory=list)


# Files

TRIALS, SWEEPS, RAN = "trials.csv", "sweeps.csv", "run.json"
#: Columns that contain JSON, and columns that contain numbers; the others are plain text.
_JSON = ("truth", "answer")
_NUMBERS: dict[str, Callable[[str], Any]] = {
    "size": int,
    "seconds": float,
    "value": lambda text: float(text) if text else None,
}
_COLUMNS = [column.name for column in fields(TrialLine)]


class ChartError(DofkitError):
    """Trials that cannot be selected, or data that cannot be read or written."""


def write(data: Data, out: Path) -> None:
    """Write all data of a run into an existing folder. Raises OSError."""
    for name, lines in ((TRIALS, data.lines), (SWEEPS, data.sweeps)):
        with (out / name).open("w", encoding="utf-8", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(_COLUMNS)
            table.writerows(map(_cells, lines))
    (out / RAN).write_text(json.dumps(asdict(data.ran), indent=1) + "\n", encoding="utf-8")


def read(folder: Path) -> Data:
    """Return the data of the run in ``folder``. Raises ChartError if they are missing or not of this version."""
    try:
        ran = Ran(**json.loads((folder / RAN).read_text(encoding="utf-8")))
        lines, sweeps = (list(_read_lines(folder / name)) for name in (TRIALS, SWEEPS))
    except OSError as error:
        raise ChartError(f"there is no run in {folder}: {error.strerror} ({error.filename})") from None
    except (ValueError, KeyError, TypeError) as error:
        first = str(error).splitlines()[0]
        raise ChartError(f"the files in {folder} are not those of a run of this version: {first}") from None
    return Data(ran, lines, sweeps)


def _cells(line: TrialLine) -> list[Any]:
    cells = {name: getattr(line, name) for name in _COLUMNS} | {"seconds": f"{line.seconds:.6g}"}
    cells |= {name: json.dumps(cells[name], ensure_ascii=False, sort_keys=True) for name in _JSON}
    return list(cells.values())


def _read_lines(path: Path) -> Iterable[TrialLine]:
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            cells: dict[str, Any] = {name: row[name] for name in _COLUMNS}
            cells |= {name: json.loads(row[name]) for name in _JSON}
            cells |= {name: number(row[name]) for name, number in _NUMBERS.items()}
            yield TrialLine(**cells)
