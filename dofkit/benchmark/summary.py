"""The summary of a run from its lines, with a caption for each figure."""

from __future__ import annotations

from dofkit.benchmark import statistics
from dofkit.benchmark.record import ChartRun, Data, Ran


def summary(data: Data) -> ChartRun:
    """All that is drawn and told."""
    found, points = statistics.scores(data.lines), statistics.points(data.lines)
    return ChartRun(
        ran=data.ran,
        scores=found,
        fronts=statistics.fronts(found),
        points=points,
        fits=statistics.fits(points),
        steps=statistics.steps(data.sweeps),
        against=statistics.against(data.lines),
        reductions=data.reductions,
        captions={name: f"{text} {provenance(data.ran)}" for name, text in _CAPTIONS.items()},
    )


def provenance(ran: Ran) -> str:
    """What was run on what, and by which command."""
    return (
        f"{ran.trials} trials whose answers are known by construction, at most {ran.limit:g} s of processor time each; "
        f"dofkit {ran.version}, Python {ran.python}, {ran.machine}, {ran.cores} cores, {ran.date[:10]}. "
        f"Made by: {ran.command}"
    )


_CAPTIONS = {
    "fronts": (
        "Each mark is a method; its wedges are the shares of its outcomes over all trials of the question. Time is the "
        "median over the trials that it can answer, one that timed out counting with the limit. The stair is the "
        "Pareto front of the methods that were never wrong; a black ring marks those that no other one beats in time, "
        "right and wrong answers at once."
    ),
    "matrix": (
        "Every cell shows the shares of the outcomes of a method on the trials of a family (their number in brackets), "
        "and says the worst of them."
    ),
    "cost": (
        "The families that grow most (all are in chart.json); medians over the trials of a size. A cross: timed out "
        "(dotted line), larger sizes are not run. The exponents are fitted by least squares on logarithms over the "
        "largest decade of sizes, ± the standard error."
    ),
    "tolerance": (
        "Share of right answers on coordinates rounded to so many digits. Left: ranks by singular values, where what "
        "is below that share of the largest counts as 0. Right: dofkit, with that tolerance written in the scene."
    ),
    "bits": (
        "Balls of one precision by themselves, on scenes that miss a special case by a gap: with too few bits no ball "
        "tells the gap from 0, and who then takes it for 0 is wrong."
    ),
    "primes": (
        "The field by itself with primes of so many bits, drawn anew for each seed: the smaller they are, the more "
        "often what is not 0 vanishes by chance, or no point is found."
    ),
    "reductions": (
        "Each dot is a scene answered with one reduction switched off, against the same scene with all of them on; "
        "the bar is the median."
    ),
}
