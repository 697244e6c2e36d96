"""What the figures share: colours that the colour-blind tell apart, marks, captions, labels that do not overlap."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple, cast

import matplotlib as mpl
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from dofkit.benchmark.record import AUTO

#: The colour of words about wrong answers.
WRONG = "#B23A00"
#: The palette of Okabe and Ito; with a hatch and words wherever it matters.
OUTCOME_COLOURS: Mapping[str, str] = {
    "right": "#0072B2",
    "wrong": "#D55E00",
    "undecided": "#C9C9C9",
    "timed out": "#F0E442",
    "cannot": "#FFFFFF",
}
OUTCOME_HATCHES: Mapping[str, str] = {"wrong": "////", "timed out": "...."}
_COLOURS = ("#E69F00", "#56B4E9", "#009E73", "#CC79A7", "#D55E00", "#0072B2", "#7A7A00", "#8C564B")
_MARKS = ("o", "s", "D", "^", "v", "P", "X", "<")
#: Inches that a character of a caption takes, and a line of it.
_CHARACTER, _LINE = 0.0515, 0.145
QUESTIONS: Mapping[str, str] = {
    "dof": "How many degrees of freedom?",
    "integrability": "Which constraints are holonomic?",
    "redundancy": "Which constraints are redundant?",
    "equivalence": "Is the submitted equation the same constraint?",
}


class Look(NamedTuple):
    """How a method is drawn, in every figure alike."""

    colour: str
    mark: str
    width: float


def looks(methods: Iterable[str]) -> dict[str, Look]:
    """A look for each method: black and heavy for ``auto``."""
    found = {AUTO: Look("#000000", "*", 2.4)}
    for i, method in enumerate(m for m in methods if m != AUTO):
        found[method] = Look(_COLOURS[i % len(_COLOURS)], _MARKS[i % len(_MARKS)], 1.4)
    return found


@contextmanager
def styled() -> Iterator[None]:
    """Settings of all figures; the same data give the same files."""
    settings: dict[str, Any] = {
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.titleweight": "bold",
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.axisbelow": True,
        "axes.grid": True,
        "grid.color": "#E4E4E4",
        "grid.linewidth": 0.6,
        "hatch.linewidth": 0.7,
        "svg.hashsalt": "dofkit",
        "svg.fonttype": "path",
    }
    with mpl.rc_context(cast(Any, settings)):
        yield


def sheet(width: float, height: float, title: str, caption: str, keys: Sequence[Artist] = ()) -> Figure:
    """A figure of so many inches beside its title with a legend, on top, and its caption, at the bottom."""
    lines = textwrap.wrap(caption, max(40, int((width - 0.3) / _CHARACTER)))
    below, above = 0.14 + _LINE * len(lines), 0.66 if keys else 0.42
    whole = height + below + above
    figure = Figure(figsize=(width, whole), layout="constrained")
    FigureCanvasAgg(figure)
    engine: Any = figure.get_layout_engine()
    engine.set(rect=(0.005, below / whole, 0.99, height / whole), w_pad=0.06, h_pad=0.06)
    figure.text(0.15 / width, 1 - 0.12 / whole, title, fontsize=12.5, fontweight="bold", va="top")
    if keys:
        place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (0.08 / width, 1 - 0.36 / whole)}
        figure.legend(handles=keys, ncols=len(keys), frameon=False, fontsize=8.5, borderpad=0.2, **place)
    figure.text(
        0.15 / width, 0.08 / whole, "\n".join(lines), fontsize=7.2, color="#444444", va="bottom", linespacing=1.2
    )
    return figure


def settle(figure: Figure) -> None:
    """Lay everything out, once: what is added later moves nothing."""
    if figure.get_layout_engine() is not None:
        figure.draw_without_rendering()
        figure.set_layout_engine("none")


def spread(places: Sequence[float], gap: float) -> list[float]:
    """The places moved apart, as little as may be, so that neighbours are ``gap`` apart.

    >>> spread([0.0, 0.0, 5.0], 1.0)
    [-0.5, 0.5, 5.0]
    """
    order = sorted(range(len(places)), key=places.__getitem__)
    groups: list[list[float]] = []
    for i in order:
        groups.append([places[i], 1.0])
        while len(groups) > 1 and groups[-1][0] - groups[-2][0] < gap * (groups[-1][1] + groups[-2][1]) / 2:
            (b, m), (a, n) = groups.pop(), groups.pop()
            groups.append([(a * n + b * m) / (n + m), n + m])
    moved = [centre + gap * (k - (count - 1) / 2) for centre, count in groups for k in range(int(count))]
    found = [0.0] * len(places)
    for i, place in zip(order, moved, strict=True):
        found[i] = place
    return found


def seconds_text(seconds: float) -> str:
    """A time as one says it.

    >>> seconds_text(0.00042), seconds_text(0.0123), seconds_text(2.5)
    ('0.42 ms', '12 ms', '2.5 s')
    """
    return f"{1000 * seconds:.2g} ms" if seconds < 0.1 else f"{seconds:.2g} s" if seconds < 100 else f"{seconds:.0f} s"
