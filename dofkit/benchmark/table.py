"""What a run found, on a terminal: a table for each question, where the files are, and how ``auto`` did."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from dofkit.benchmark.record import ALL, AUTO, ChartRun, Data, Score


def tell(chart: ChartRun, data: Data, out: Path, drawn: Sequence[Path]) -> None:
    """Print it on standard output."""
    console = Console(highlight=False, markup=False)
    if chart.scores:
        console.print(table(chart))
        for sentence in sentences(chart):
            console.print(sentence, soft_wrap=True)
    console.print(f"data: {out}/ (trials.csv, sweeps.csv, reductions.csv, chart.json)", soft_wrap=True)
    if drawn:
        names = ", ".join(path.stem for path in drawn)
        console.print(f"figures, as .png and .svg: {names}", soft_wrap=True)
    if not data.ran.complete:
        console.print("the run was interrupted: this is only a part of it", soft_wrap=True)


def table(chart: ChartRun) -> Table:
    """Question by question, the fastest method first."""
    columns = ("question", "method", "right", "wrong", "undecided", "timed out", "cannot", "median", "Pareto")
    shown = Table(*columns, box=None, pad_edge=False)
    for column in shown.columns[2:8]:
        column.justify = "right"
    whole = [score for score in chart.scores if score.family == ALL]
    fronts = {front.question: front.methods for front in chart.fronts}
    for question in dict.fromkeys(score.question for score in whole):
        members = sorted((s for s in whole if s.question == question), key=lambda s: s.median_seconds or 0.0)
        for i, score in enumerate(members):
            mark = "yes" if score.method in fronts.get(question, ()) else ""
            style = "bold" if score.method == AUTO else None
            shown.add_row(
                question if i == 0 else "", *_cells(score), mark, style=style, end_section=score is members[-1]
            )
    return shown


def _cells(score: Score) -> tuple[str, ...]:
    counts = (score.right, score.wrong, score.undecided, score.timed_out, score.cannot)
    median = "" if score.median_seconds is None else f"{1000 * score.median_seconds:.3g} ms"
    return (score.method, *(str(count) if count else "-" for count in counts), median)


#: `auto` should take no more than so many times the fastest method that is right.
TWICE = 2


def sentences(chart: ChartRun) -> list[str]:
    """How ``auto`` did: how many of its answers are wrong, and where it is slower than the fastest that is right."""
    auto = [score for score in chart.scores if score.method == AUTO and score.family == ALL]
    if not auto:
        return []
    trials, wrong = sum(score.trials for score in auto), sum(score.wrong for score in auto)
    open_ = sum(score.undecided + score.timed_out + score.cannot for score in auto)
    found = [f"auto: {trials} trials, {wrong} wrong, {open_} without an answer"]
    if not chart.against:
        return found
    sound = [row for row in chart.against if row.sound_ratio is not None]
    slow = [row for row in sound if row.sound_ratio is not None and row.sound_ratio > TWICE]
    found.append(
        f"auto: at most twice the time of the fastest method that is right on a family and never wrong: "
        f"{len(sound) - len(slow)} of {len(sound)} families"
    )
    for row in sorted(slow, key=lambda row: -(row.sound_ratio or 0))[:5]:
        found.append(f"  {row.question}, {row.family}: {row.sound_ratio:.1f} times {row.sound}")
    within = sum(row.ratio <= TWICE for row in chart.against)
    found.append(f"auto: the same, with methods that are wrong elsewhere: {within} of {len(chart.against)} families")
    return found
