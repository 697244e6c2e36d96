"""The record of a run: a line for every trial and method, what is worked out from them, and the files of a run."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any, Literal, NamedTuple

from dofkit.base.errors import DofkitError

#: ``cannot``: the method never answers such a question or scene; ``undecided``: it tried, or failed on the way.
Outcome = Literal["right", "wrong", "undecided", "timed out", "cannot"]
OUTCOMES: tuple[Outcome, ...] = ("right", "wrong", "undecided", "timed out", "cannot")
#: The method that is held against all others.
AUTO = "auto"
#: What stands for a family where a row is about all of them.
ALL = "all"


@dataclass(frozen=True)
class TrialLine:
    """A trial answered by a method: a line of ``trials.csv``, or of ``sweeps.csv``.

    ``answer`` is None where there was none; ``seconds`` of processor time, of what was cut short the limit; ``why``
    says in a sentence why it is not right. ``knob`` and ``value``: what was turned on the method, in sweeps.
    """

    family: str
    trial: str
    question: str
    method: str
    size: int
    swept: Mapping[str, Any]
    truth: Any
    answer: Any
    outcome: Outcome
    seconds: float
    why: str = ""
    knob: str = ""
    value: float = 0.0
    group: str = ""


@dataclass(frozen=True)
class Ran:
    """What was run, where and when. Run again, the command gives the same answers; seconds depend on the machine.

    ``version``: dofkit's; ``date``: in UTC, when it began; ``machine``: the processor, as the system names it;
    ``limit``: seconds of processor time for a trial and method; ``lines``: trials times methods, ``sweeps``: the same
    in sweeps; ``minutes`` by the clock; ``complete``: false where it was interrupted.
    """

    version: str
    command: str
    date: str
    machine: str
    cores: int
    python: str
    workers: int
    limit: float
    quick: bool
    trials: int
    lines: int
    sweeps: int
    minutes: float
    complete: bool


@dataclass(frozen=True)
class Score:
    """How a method did on the trials of a family, or of all of them.

    Seconds are the median and the tenth and ninetieth percentiles of all but ``cannot``.
    """

    question: str
    family: str
    method: str
    trials: int
    right: int
    wrong: int
    undecided: int
    timed_out: int
    cannot: int
    median_seconds: float | None
    low_seconds: float | None
    high_seconds: float | None

    @property
    def share_right(self) -> float:
        """Right answers among all trials."""
        return self.right / self.trials

    @property
    def share_wrong(self) -> float:
        """Wrong answers among all trials."""
        return self.wrong / self.trials


class Front(NamedTuple):
    """The methods that no other one beats: as fast, as often right, as seldom wrong, and in one of these better.

    ``never_wrong``: the same among those that were never wrong. Both with the fastest first.
    """

    question: str
    methods: list[str]
    never_wrong: list[str]


class MedianTime(NamedTuple):
    """The median seconds of a method on the trials of one size; ``timed_out`` of them only give a lower bound."""

    question: str
    family: str
    method: str
    size: int
    seconds: float
    trials: int
    timed_out: int


class Fit(NamedTuple):
    """seconds = factor * size^exponent, by least squares on the logarithms of the points of the largest decade.

    ``error`` is the standard error of the exponent.
    """

    question: str
    family: str
    method: str
    exponent: float
    error: float
    factor: float
    points: int


class Step(NamedTuple):
    """The outcomes of a method in a sweep, at one value of its knob; ``group`` is a curve; late is undecided."""

    sweep: str
    method: str
    group: str
    value: float
    trials: int
    right: int
    wrong: int
    undecided: int


class Against(NamedTuple):
    """``auto`` against the fastest method that is right on all trials of a family.

    ``ratio`` is the median over trials of the ratio of their seconds; ``sound``: the fastest of them that is never
    wrong on the question, with the same ratio for that one.
    """

    question: str
    family: str
    fastest: str
    ratio: float
    sound: str | None
    sound_ratio: float | None


@dataclass(frozen=True)
class ChartRun:
    """What is drawn and printed of a run; ``captions`` of every figure, by its name."""

    ran: Ran
    scores: list[Score]
    fronts: list[Front]
    points: list[MedianTime]
    fits: list[Fit]
    steps: list[Step]
    against: list[Against]
    captions: dict[str, str]


@dataclass(frozen=True)
class Data:
    """All lines of a run, and how it was made."""

    ran: Ran
    lines: list[TrialLine] = field(default_factory=list)
    sweeps: list[TrialLine] = field(default_factory=list)


# Files

TRIALS, SWEEPS, RAN = "trials.csv", "sweeps.csv", "run.json"
#: Columns that hold JSON, and those that hold numbers; the others are plain text.
_JSON = ("swept", "truth", "answer")
_NUMBERS: dict[str, Callable[[str], Any]] = {"size": int, "seconds": float, "value": float}
_COLUMNS = [column.name for column in fields(TrialLine)]


class ChartError(DofkitError):
    """What was asked for cannot be charted, read or written."""


def write(data: Data, out: Path) -> None:
    """Write all data of a run into an existing folder. Raises OSError."""
    _write_table(out / TRIALS, _COLUMNS, map(_cells, data.lines))
    _write_table(out / SWEEPS, _COLUMNS, map(_cells, data.sweeps))
    (out / RAN).write_text(json.dumps(asdict(data.ran), indent=1) + "\n", encoding="utf-8")


def read(folder: Path) -> Data:
    """Return the data of a run. Raises ChartError where they are missing or incomplete."""
    try:
        ran = Ran(**json.loads((folder / RAN).read_text(encoding="utf-8")))
        lines, swept = (list(_read_lines(folder / name)) for name in (TRIALS, SWEEPS))
    except OSError as error:
        raise ChartError(f"there is no run in {folder}: {error.strerror} ({error.filename})") from None
    except (ValueError, KeyError, TypeError) as error:
        first = str(error).splitlines()[0]
        raise ChartError(f"the files in {folder} are not those of a run of this version: {first}") from None
    return Data(ran, lines, swept)


def _write_table(path: Path, columns: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        table.writerows(rows)


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
