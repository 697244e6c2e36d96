"""The record of a run: a line for every trial and method, and the files that hold them."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any, Literal

from dofkit.base.errors import DofkitError

#: ``cannot``: the method never answers such a question or scene; ``undecided``: it tried, or failed on the way.
Outcome = Literal["right", "wrong", "undecided", "timed out", "cannot"]
OUTCOMES: tuple[Outcome, ...] = ("right", "wrong", "undecided", "timed out", "cannot")
#: The method that is compared with all others.
AUTO = "auto"


@dataclass(frozen=True)
class TrialLine:
    """A trial answered by a method: a line of ``trials.csv``, or of ``sweeps.csv``.

    ``answer`` is None where there was none; ``seconds`` of processor time, of what was cut short the limit; ``why``
    says in a sentence why it is not right. In sweeps, ``setting`` of the method had this ``value``.
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
    """What was run, where and when. Run again, the command gives the same answers; seconds depend on the machine.

    ``version``: dofkit's; ``date``: in UTC, when it began; ``machine``: the processor, as the system names it;
    ``limit``: seconds of processor time for a trial and method; ``minutes`` by the clock; ``complete``: false where it
    was interrupted.
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
    """All lines of a run, and how it was made."""

    ran: Ran
    lines: list[TrialLine] = field(default_factory=list)
    sweeps: list[TrialLine] = field(default_factory=list)


# Files

TRIALS, SWEEPS, RAN = "trials.csv", "sweeps.csv", "run.json"
#: Columns that hold JSON, and those that hold numbers; the others are plain text.
_JSON = ("truth", "answer")
_NUMBERS: dict[str, Callable[[str], Any]] = {
    "size": int,
    "seconds": float,
    "value": lambda text: float(text) if text else None,
}
_COLUMNS = [column.name for column in fields(TrialLine)]


class ChartError(DofkitError):
    """What was asked for cannot be charted, read or written."""


def write(data: Data, out: Path) -> None:
    """Write all data of a run into an existing folder. Raises OSError."""
    for name, lines in ((TRIALS, data.lines), (SWEEPS, data.sweeps)):
        with (out / name).open("w", encoding="utf-8", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(_COLUMNS)
            table.writerows(map(_cells, lines))
    (out / RAN).write_text(json.dumps(asdict(data.ran), indent=1) + "\n", encoding="utf-8")


def read(folder: Path) -> Data:
    """Return the data of a run. Raises ChartError where they are missing or incomplete."""
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
