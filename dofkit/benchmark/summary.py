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
        "Each square is a method at the median time of the trials that it can answer, the whisker goes from the "
        "10th to the 90th of 100 of them (one that timed out counts with the limit). Upwards, logarithmically, the "
        "share of trials that are not answered rightly; of these wrong ones stand in red, and apart what is left "
        "open: undecided, too slow, or not answered by such a method. The grey stair joins the methods that were "
        "never wrong and that no other such one beats."
    ),
    "matrix": (
        "Every cell shows the shares of the outcomes of a method on the trials of a family (beside them their "
        "number). A number in red: so many per cent are wrong; in grey: none is, and so many are left open; none: "
        "all are right. Under each heading the hardest families stand last, by the share that all methods together "
        "do not get right."
    ),
    "cost": (
        "Medians over the trials of a size. A cross: timed out (dotted line), larger sizes are not run. The "
        "exponents are fitted by least squares on logarithms over the largest decade of sizes, and told where a "
        "power law fits: with a standard error below a tenth of it. In grey the other methods; all families are in "
        "chart.json."
    ),
    "tolerance": (
        "Singular drawings with coordinates rounded to so many digits; the truth is that of what was rounded. Each "
        "bar shows the shares of ten trials. Left: ranks by singular values, where what is below that share of the "
        "largest counts as 0. Right: dofkit, with that tolerance written in the scene. The triangle: the tolerance "
        "equal to the rounding; a smaller one says of the drawing what does not hold."
    ),
    "bits": (
        "Balls of one precision by themselves, on scenes that miss a special case by a gap: with too few bits no "
        "ball tells the gap from 0, and who then takes it for 0 is wrong."
    ),
    "reductions": (
        "Each dot is a scene answered with one reduction switched off, against the same scene with all of them on, "
        "both warm: blue, scenes made to have what the reduction leaves out, of growing size; grey, those of the "
        "catalog. The bar is the median of the blue ones."
    ),
}
