"""The figures of a run, one function each: ``draw(chart)``, None where there is nothing to show. Needs matplotlib."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from matplotlib.figure import Figure

from dofkit.benchmark.figures import outcomes, speed
from dofkit.benchmark.figures.style import styled
from dofkit.benchmark.record import ChartRun

FIGURES: Mapping[str, Callable[[ChartRun], Figure | None]] = {
    "fronts": speed.fronts,
    "matrix": outcomes.matrix,
    "cost": speed.cost,
    "tolerance": outcomes.tolerance,
    "bits": outcomes.bits,
}


def write(chart: ChartRun, out: Path) -> Iterator[Path]:
    """Draw all figures into a folder, each as SVG and PNG. Raises OSError."""
    for name, draw in FIGURES.items():
        with styled():
            figure = draw(chart)
            if figure is None:
                continue
            figure.savefig(out / f"{name}.svg", metadata={"Date": None})
            figure.savefig(out / f"{name}.png", dpi=144, metadata={"Software": None})
        yield out / f"{name}.png"
