"""``dofkit chart``: run the trials, and write data, figures and a table; or make the figures from existing data."""

from __future__ import annotations

import os
import platform
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from datetime import UTC, datetime
from importlib.util import find_spec
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Table

from dofkit.base import __version__
from dofkit.base.runs import cores
from dofkit.base.worker_process import function_named
from dofkit.benchmark import record, runner
from dofkit.benchmark.record import AUTO, OUTCOMES, ChartError, Data, Ran
from dofkit.benchmark.sentences import TWICE, sentences
from dofkit.benchmark.statistics import Score, against, front, grouped, scores
from dofkit.benchmark.tasks import ChartOptions
from dofkit.benchmark.trials import FAMILIES

#: The function that draws the figures; its module needs matplotlib.
FIGURES = "dofkit.benchmark.figures:write"
NO_MATPLOTLIB = "nothing is drawn without matplotlib: pip install 'dofkit[chart]'"


def chart(options: ChartOptions) -> bool:
    """Run the trials, write data and figures, print scores; return whether the run was completed. Raises ChartError."""
    writable(options.out)
    if options.source is not None:
        finish(record.read(options.source), options.out)
        return True
    work, swept = options.tasks(FAMILIES), options.sweeps(FAMILIES)
    started, data = time.monotonic(), Data(_provenance(options, sum(task.method == work[0].method for task in work)))
    try:
        with runner.bench_of(options.workers, options.seconds) as bench, _bar() as bar:
            for name, members, lines in (("trials", work, data.lines), ("sweeps", swept, data.sweeps)):
                progress = bar.add_task(name, total=len(members))
                for line in runner.run(members, bench):
                    lines.append(line)
                    bar.update(progress, advance=1)
        complete = True
    except KeyboardInterrupt:
        complete = False
        done, total = len(data.lines) + len(data.sweeps), len(work) + len(swept)
        Console(stderr=True).print(f"interrupted after {done} of {total} trials", highlight=False)
        if not data.lines:
            return False
    ran = replace(data.ran, minutes=(time.monotonic() - started) / 60, complete=complete)
    finish(replace(data, ran=ran), options.out)
    return complete


def _provenance(options: ChartOptions, trials: int) -> Ran:
    """Return the description of a run at its beginning, with 0 minutes and not complete."""
    return Ran(
        version=__version__,
        command=options.command(),
        date=f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}",
        machine=machine(),
        cores=os.cpu_count() or 1,
        python=platform.python_version(),
        workers=options.workers or cores(),
        limit=options.seconds,
        trials=trials,
        minutes=0,
        complete=False,
    )


def finish(data: Data, out: Path) -> None:
    """Sort and write the data, draw the figures of a complete run if matplotlib is installed, and print the scores."""
    order = {key: i for i, key in enumerate(dict.fromkeys((line.family, line.question) for line in data.lines))}
    data.lines.sort(key=lambda line: (order[line.family, line.question], line.size, line.trial))
    data.sweeps.sort(key=lambda line: (line.setting, line.family, line.trial, line.value))
    record.write(data, out)
    has_matplotlib = find_spec("matplotlib") is not None
    drawn = list(function_named(FIGURES)(data, out)) if has_matplotlib and data.ran.complete else []
    show(data, out, drawn)
    if not has_matplotlib:
        Console(stderr=True).print(NO_MATPLOTLIB, highlight=False, markup=False)


def writable(out: Path) -> None:
    """Make the folder ``out``. Raises ChartError if nothing can be written there."""
    try:
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=out):
            pass
    except OSError as error:
        raise ChartError(f"nothing can be written to {out}: {error.strerror}") from None


def _bar() -> AbstractContextManager[Progress]:
    """Return a progress bar on standard error, invisible if that is not a terminal."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    visible = console.is_terminal and not console.is_jupyter
    return Progress(*columns, TimeRemainingColumn(), console=console, transient=True, disable=not visible)


def machine() -> str:
    """Return the name of the processor."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as lines:
            names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    except OSError:
        names = []
    return names[0] if names else platform.processor() or platform.machine()


# On the terminal


def show(data: Data, out: Path, drawn: Sequence[Path]) -> None:
    """Print the table of scores, sentences about ``auto``, and the names of the files."""
    console = Console(highlight=False, markup=False)
    if data.lines:
        console.print(table(data))
        for sentence in auto_sentences(data):
            console.print(sentence, soft_wrap=True)
    console.print(f"data: {out}/ (trials.csv, sweeps.csv, run.json)", soft_wrap=True)
    if drawn:
        names = ", ".join(path.stem for path in drawn)
        console.print(f"figures, as .png and .svg: {names}", soft_wrap=True)
    if not data.ran.complete:
        console.print("the run was interrupted: this is only a part of it", soft_wrap=True)


def table(data: Data) -> Table:
    """Return the table of scores: for each question its methods by median time, those without a median first."""
    rows = Table("question", "method", *OUTCOMES, "median", "Pareto", box=None, pad_edge=False)
    for column in rows.columns[2:8]:
        column.justify = "right"
    for question, lines in grouped(data.lines, lambda line: line.question).items():
        members = sorted(scores(lines).values(), key=lambda score: score.median or 0.0)
        best = front(members)
        for i, score in enumerate(members):
            style, mark = "bold" if score.method == AUTO else None, "yes" if score in best else ""
            cells = (question if i == 0 else "", *_cells(score), mark)
            rows.add_row(*cells, style=style, end_section=score is members[-1])
    return rows


def _cells(score: Score) -> tuple[str, ...]:
    counts = (score.counts.get(outcome, 0) for outcome in OUTCOMES)
    median = "" if score.median is None else f"{1000 * score.median:.3g} ms"
    return (score.method, *(str(count) if count else "-" for count in counts), median)


def auto_sentences(data: Data) -> Iterator[str]:
    """Yield sentences about ``auto``, and up to five families on which a method that is never wrong is much faster."""
    yield from sentences(data)
    slow = [(row.sound_ratio or 0, row) for row in against(data.lines)]
    for ratio, row in sorted(slow, key=lambda pair: -pair[0])[:5]:
        if ratio > TWICE:
            yield f"  {row.question}, {row.family}: {ratio:.1f} times {row.sound}"
