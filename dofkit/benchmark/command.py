"""``dofkit chart``: from the trials to the data, the figures and a table; or from such data to the figures."""

from __future__ import annotations

import os
import platform
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.util import find_spec
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from dofkit.base import __version__
from dofkit.base.runs import cores
from dofkit.base.workers import Job
from dofkit.benchmark import runner, storing, tasks
from dofkit.benchmark import trial_job as asking
from dofkit.benchmark.failures import explained
from dofkit.benchmark.figures import table
from dofkit.benchmark.record import ChartRun, Data, Ran, ReductionCost, TrialLine
from dofkit.benchmark.selecting import Selection
from dofkit.benchmark.storing import ChartError
from dofkit.benchmark.summary import summary
from dofkit.benchmark.table import tell
from dofkit.benchmark.trials import FAMILIES

#: Seconds of processor time for a trial, and in a quick run.
LIMIT, LIMIT_QUICK = 2.0, 0.5
#: Seconds that measuring one reduction on one scene may take.
REDUCTION_SECONDS = 120.0
NO_MATPLOTLIB = "nothing is drawn without matplotlib: pip install 'dofkit[chart]'"


@dataclass(frozen=True)
class ChartOptions:
    """What the command line says. ``source``: a folder with the data of a run, to be drawn again."""

    selection: Selection
    out: Path
    source: Path | None = None
    scheduler: str | None = None
    workers: int | None = None
    limit: float | None = None

    @property
    def seconds(self) -> float:
        """The limit for a trial."""
        return self.limit or (LIMIT_QUICK if self.selection.quick else LIMIT)

    def command(self) -> str:
        """What makes the same data again, wherever it is written."""
        limit = [] if self.limit is None else [f"--timeout {self.limit:g}"]
        return " ".join(["dofkit chart", *self.selection.options(), *limit])


@dataclass
class ChartFiles:
    """What was found so far."""

    lines: list[TrialLine] = field(default_factory=list)
    sweeps: list[TrialLine] = field(default_factory=list)
    reductions: list[ReductionCost] = field(default_factory=list)
    complete: bool = False


def chart(options: ChartOptions) -> bool:
    """Run, write, draw and tell; was it brought to its end? Raises ChartError, StoppedError and OSError."""
    writable(options.out)
    if options.source is not None:
        finish(storing.read(options.source), options.out)
        return True
    started, found = time.monotonic(), ChartFiles()
    date = f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}"
    chosen = options.selection.with_names(FAMILIES)
    trials = chosen.thinned(chosen.trials(FAMILIES))
    work = list(tasks.trial_tasks(trials, chosen.methods))
    swept = list(tasks.sweeps(chosen.swept(FAMILIES), chosen.methods, chosen.quick))
    try:
        _gather(options, work, swept, found)
    except KeyboardInterrupt:
        done, whole = len(found.lines) + len(found.sweeps), len(work) + len(swept)
        Console(stderr=True).print(f"interrupted after {done} of {whole} trials", highlight=False)
    if not found.complete and not found.lines:
        return False
    ran = Ran(
        version=__version__,
        command=options.command(),
        date=date,
        machine=machine(),
        cores=os.cpu_count() or 1,
        python=platform.python_version(),
        workers=options.workers or cores(),
        limit=options.seconds,
        quick=chosen.quick,
        trials=len(trials),
        lines=len(found.lines),
        sweeps=len(found.sweeps),
        seeds=sorted({task.knobs.seed for task in (*work, *swept)}),
        minutes=(time.monotonic() - started) / 60,
        complete=found.complete,
    )
    finish(Data(ran, found.lines, found.sweeps, found.reductions), options.out)
    return found.complete


def finish(data: Data, out: Path) -> None:
    """Write the data, draw them where that can be done, and tell what they say."""
    order = {key: i for i, key in enumerate(dict.fromkeys((line.family, line.question) for line in data.lines))}
    data.lines.sort(key=lambda line: (order[line.family, line.question], line.size, line.trial))
    chart = summary(data)
    storing.write(data, chart, out)
    able = find_spec("matplotlib") is not None
    drawn = list(draw(chart, out)) if able and data.ran.complete else []
    tell(chart, data, out, drawn)
    if not able:
        Console(stderr=True).print(NO_MATPLOTLIB, highlight=False, markup=False)


def draw(chart: ChartRun, out: Path) -> Iterator[Path]:
    """All figures. Raises OSError."""
    return table.write(chart, out)


def writable(out: Path) -> None:
    """Make the folder. Raises ChartError where nothing can be written there."""
    try:
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=out):
            pass
    except OSError as error:
        raise ChartError(f"nothing can be written to {out}: {error.strerror}") from None


def _gather(
    options: ChartOptions, work: Sequence[tasks.TrialTask], swept: Sequence[tasks.TrialTask], found: ChartFiles
) -> None:
    """Reductions are measured beside the trials: each of their runs needs the one before."""
    with _bench(options) as bench, _bar() as bar:
        job = Job(asking.ablation_rows, options.selection.quick, REDUCTION_SECONDS)
        reduced = bench.crew.submit(bench.ask, job) if _reduces(options.selection) else None
        for name, some, lines in (("trials", work, found.lines), ("sweeps", swept, found.sweeps)):
            shown = bar.add_task(name, total=len(some))
            for line in runner.run(some, bench):
                lines.append(line)
                bar.update(shown, advance=1)
        if reduced is not None:
            shown = bar.add_task("reductions", total=None)
            found.reductions += [ReductionCost.model_validate(row) for row in reduced.result().value or ()]
            bar.update(shown, total=1, completed=1)
    found.complete = True


def _reduces(selection: Selection) -> bool:
    """They are measured where everything is: they are about `auto` on scenes of their own."""
    return not (selection.questions or selection.families or selection.methods)


@contextmanager
def _bench(options: ChartOptions) -> Iterator[runner.Bench]:
    if options.scheduler is not None:
        with runner.cluster_bench(options.scheduler, options.seconds, explained) as bench:
            yield bench
        return
    with runner.local_bench(options.workers or cores(), options.seconds, explained) as bench:
        yield bench


def _bar() -> AbstractContextManager[Progress]:
    """A progress bar on standard error, where that is a terminal."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    shown = console.is_terminal and not console.is_jupyter
    return Progress(*columns, TimeRemainingColumn(), console=console, transient=True, disable=not shown)


def machine() -> str:
    """The processor as the system names it."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as told:
            names = [line.partition(":")[2].strip() for line in told if line.startswith("model name")]
    except OSError:
        names = []
    return names[0] if names else platform.processor() or platform.machine()
