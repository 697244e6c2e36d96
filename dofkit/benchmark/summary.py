"""The summary of a run from its lines, with a caption for each figure."""

from __future__ import annotations

from dofkit.benchmark import statistics
from dofkit.benchmark.record import ChartRun, Data, Ran
from dofkit.benchmark.sentences import sentences


def summary(data: Data) -> ChartRun:
    """All that is drawn and told."""
    found, points = statistics.scores(data.lines), statistics.points(data.lines)
    chart = ChartRun(
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
    return chart.model_copy(update={"sentences": sentences(chart)})


def provenance(ran: Ran) -> str:
    """What was run on what, and by which command."""
    return (
        f"{ran.trials} trials whose answers are known by construction, at most {ran.limit:g} s of processor time each; "
        f"dofkit {ran.version}, Python {ran.python}, {ran.machine}, {ran.cores} cores, {ran.date[:10]}. "
        f"Made by: {ran.command}"
    )


_CAPTIONS = {
    "fronts": (
        "Each square is a method at the median time of the trials that it can answer, the whisker goes from the 10th "
        "to the 90th of 100 of them (one that timed out counts with the limit). Upwards, logarithmically, the share "
        "of trials without the right answer; wrong answers are listed in red, and separately trials without an answer "
        "(undecided, timed out or not applicable). The grey steps are the Pareto front of the methods that were never "
        "wrong."
    ),
    "matrix": (
        "Every cell shows the shares of the outcomes of a method on the trials of a family (their number stands next "
        "to it). A red number is the percentage of wrong answers; a grey one, where none is wrong, that of trials "
        "without an answer; no number means that all are right. Under each heading the hardest families stand last, "
        "by the share that all methods together do not get right."
    ),
    "cost": (
        "Medians over the trials of a size. A cross marks a trial that timed out (dotted line); larger sizes are not "
        "run. The exponents are fitted by least squares on logarithms over the largest decade of sizes, and given "
        "where a power law fits (standard error below a tenth of the exponent). The other methods are grey; all "
        "families are in chart.json."
    ),
    "tolerance": (
        "Singular configurations with coordinates rounded to the given number of digits; the right answer is that of "
        "the unrounded geometry. Each bar shows the shares of ten trials. Left: ranks by singular values, where "
        "values below that fraction of the largest count as 0. Right: dofkit, with that tolerance written in the "
        "scene. The triangle marks the tolerance equal to the rounding; a smaller one is not true of the rounded "
        "geometry."
    ),
    "bits": (
        "Ball arithmetic of one precision on its own, on scenes that miss a special case by a gap: with too few bits "
        "no ball distinguishes the gap from 0, and taking it for 0 is wrong."
    ),
    "reductions": (
        "Each dot compares a scene answered with one reduction switched off with the same scene and all of them on, "
        "both after a first run. Blue: scenes made for the reduction, of growing size; grey: scenes of the catalog. "
        "The bar is the median of the blue dots."
    ),
}
