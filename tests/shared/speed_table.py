"""The table of speed: what is measured against what, the data of a run, and the page that tells of them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Literal, NamedTuple

from dofkit.site.markdown import table

ROOT = Path(__file__).parents[2]
#: The data of the run that is shown, and the page that shows them.
DATA = ROOT / "tests" / "charts" / "speed.json"
PAGE = ROOT / "dofkit" / "site" / "pages" / "about" / "speed.md"
#: What is between these lines of the page is written by `shown`.
BEGIN, END = "<!-- the table of a run -->", "<!-- the end of the table -->"

#: ``times``: so many times faster than the rival; ``share``: at most so many times its time; ``seconds``: at most so
#: many; ``fold``: at most so many times as much as the least, or as linear.
GoalKind = Literal["times", "share", "seconds", "fold"]


class Goal(NamedTuple):
    """What a row should reach."""

    kind: GoalKind
    value: float

    def text(self) -> str:
        """As it stands in the table."""
        said = {"times": "{} x", "share": "at most {} x", "seconds": "{}", "fold": "at most {}-fold"}[self.kind]
        return said.format(seconds_text(self.value) if self.kind == "seconds" else f"{self.value:g}")


class Measured(NamedTuple):
    """What was measured: our seconds, the rival's (None: it did not finish), or how much more the worst takes.

    ``right``: was the answer the one that is known?
    """

    ours: float
    theirs: float | None = None
    fold: float | None = None
    right: bool = True


class SpeedRow(NamedTuple):
    """A row of a run; ``measured`` is None where it could not be run, and ``why`` then says so."""

    key: str
    work: str
    rival: str
    goal: Goal
    measured: Measured | None
    why: str = ""

    @property
    def figure(self) -> float | None:
        """What is held against the goal: a ratio or seconds; None where there is none."""
        found = self.measured
        if found is None:
            return None
        if self.goal.kind == "fold":
            return found.fold
        if self.goal.kind == "seconds":
            return found.ours
        if found.theirs is None:
            return None
        return found.theirs / found.ours if self.goal.kind == "times" else found.ours / found.theirs

    @property
    def met(self) -> bool | None:
        """Is the goal reached? None where nothing was measured."""
        if self.measured is None or self.figure is None:
            return None
        return self.measured.right and (
            self.figure >= self.goal.value if self.goal.kind == "times" else self.figure <= self.goal.value
        )


class Ran(NamedTuple):
    """Where and when it was run."""

    command: str
    date: str
    machine: str
    cores: int
    python: str
    minutes: float


class SpeedRun(NamedTuple):
    """All rows of a run."""

    ran: Ran
    rows: tuple[SpeedRow, ...]

    def write(self, path: Path) -> None:
        """Write it as JSON."""
        rows = [_told(row) for row in self.rows]
        path.write_text(json.dumps({"ran": self.ran._asdict(), "rows": rows}, indent=1) + "\n", encoding="utf-8")

    @classmethod
    def read(cls, path: Path) -> SpeedRun:
        """Read it again."""
        document = json.loads(path.read_text(encoding="utf-8"))
        return cls(Ran(**document["ran"]), tuple(_row(row) for row in document["rows"]))


def _told(row: SpeedRow) -> dict[str, object]:
    measured = None if row.measured is None else row.measured._asdict()
    return {**row._asdict(), "goal": row.goal._asdict(), "measured": measured}


def _row(told: Mapping[str, Any]) -> SpeedRow:
    measured = None if told["measured"] is None else Measured(**told["measured"])
    return SpeedRow(**{**told, "goal": Goal(**told["goal"]), "measured": measured})


# the page


def seconds_text(seconds: float) -> str:
    """A time as a person would say it, in two figures.

    >>> seconds_text(0.0123), seconds_text(0.4), seconds_text(12.3), seconds_text(240)
    ('12 ms', '0.4 s', '12 s', '240 s')
    """
    if seconds < 0.1:
        return f"{seconds * 1e3:.2g} ms"
    return f"{seconds:.2g} s" if seconds < 100 else f"{seconds:.0f} s"


def ratio_text(value: float) -> str:
    """A ratio in two figures.

    >>> ratio_text(0.98), ratio_text(57.3), ratio_text(123.4)
    ('0.98', '57', '123')
    """
    return f"{value:.0f}" if value >= 100 else f"{value:.2g}"


def _cells(row: SpeedRow) -> Iterator[str]:
    yield row.work
    found = row.measured
    if found is None:
        yield from ("-", row.rival or "-", "-", row.goal.text(), row.why)
        return
    yield seconds_text(found.ours)
    yield (
        "-"
        if not row.rival
        else f"{row.rival}: " + (row.why or "not finished" if found.theirs is None else seconds_text(found.theirs))
    )
    yield {"times": "{} x", "share": "{} x", "fold": "{}-fold", "seconds": "-"}[row.goal.kind].format(
        "-" if row.figure is None else ratio_text(row.figure)
    )
    yield row.goal.text()
    yield "-" if row.met is None else "yes" if row.met else "no" if found.right else "no: a wrong answer"


def sentence(run: SpeedRun) -> str:
    """What the table says, worked out from its rows."""
    held = [row for row in run.rows if row.met is not None]
    missed = [row.work for row in held if not row.met]
    left = [row.work for row in run.rows if row.met is None]
    said = f"{sum(bool(row.met) for row in held)} of {len(held)} rows reach their goal"
    if missed:
        said += f"; not yet: {'; '.join(missed)}"
    if left:
        said += f"; not measured: {'; '.join(left)}"
    wrong = sum(row.measured is not None and not row.measured.right for row in run.rows)
    answers = "every answer was the right one" if not wrong else f"{wrong} answers were not the right one"
    return f"{said}. In the same run {answers}."


def shown(run: SpeedRun) -> str:
    """The table and its sentences as Markdown."""
    head = ("work", "dofkit", "rival in the same run", "ratio", "goal", "reached")
    ran = run.ran
    about = (
        f"*Made by `{ran.command}` in {ran.minutes:.1f} minutes on {ran.date}, {ran.machine}, {ran.cores} cores, "
        f"Python {ran.python}; medians, from the scene to the whole report where nothing else is said. {sentence(run)}*"
    )
    return f"{table(head, ([*_cells(row)] for row in run.rows))}\n\n{about}"


def with_table(page: str, run: SpeedRun) -> str:
    """The page with the table of a run. Raises ValueError where it has no place for one."""
    before, _, rest = page.partition(BEGIN)
    _, found, after = rest.partition(END)
    if not found:
        raise ValueError("the page has no lines between which the table stands")
    return f"{before}{BEGIN}\n\n{shown(run)}\n\n{END}{after}"
