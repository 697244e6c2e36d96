"""A page drawn by matplotlib: png, pdf, and the frames of gif and mp4."""

from __future__ import annotations

import io
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from dofkit.base.errors import DofkitError
from dofkit.pictures.paper import Mark, Page

#: Dots by an inch, of still pictures.
DOTS = 160
NO_MATPLOTLIB = "{} needs matplotlib: pip install 'dofkit[pictures]'"


class ExtraMissingError(DofkitError):
    """What was asked needs a package that is not installed; the message says which to install."""


def has_matplotlib() -> bool:
    """Is matplotlib installed?"""
    return find_spec("matplotlib") is not None


def require_matplotlib(what: str) -> None:
    """Raise ExtraMissingError where matplotlib is not installed; ``what`` needs it."""
    if not has_matplotlib():
        raise ExtraMissingError(NO_MATPLOTLIB.format(what))


def figure_of(page: Page) -> Any:
    """The page as a matplotlib figure."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(page.width / 72, page.height / 72), facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set_xlim(0, page.width)
    axes.set_ylim(0, page.height)
    draw_marks(axes, page)
    return figure


def draw_marks(axes: Any, page: Page) -> None:
    """Put all marks on axes whose units are points."""
    for k, mark in enumerate(page.marks):
        if mark.text:
            _draw_text(axes, mark, k)
        else:
            _draw_path(axes, mark, k)


def _draw_text(axes: Any, mark: Mark, order: int) -> None:
    from matplotlib.patheffects import withStroke

    x, y = mark.spots[0]
    align = {"start": "left", "middle": "center", "end": "right"}[mark.align]
    axes.text(
        x, y, mark.text.replace("$", r"\$"), fontsize=mark.size, ha=align, va="baseline", color=mark.ink.line,
        fontweight="bold" if mark.bold else "normal", zorder=order,
        path_effects=[withStroke(linewidth=2.4, foreground="white")],
    )  # fmt: skip


def _draw_path(axes: Any, mark: Mark, order: int) -> None:
    from matplotlib.colors import to_rgba
    from matplotlib.lines import Line2D
    from matplotlib.patches import Polygon

    ink = mark.ink
    style: Any = (0, tuple(d / max(ink.width, 0.1) for d in ink.dash)) if ink.dash else "-"
    if not mark.closed:
        x, y = zip(*mark.spots, strict=True)
        axes.add_line(
            Line2D(x, y, color=ink.line, linewidth=ink.width, linestyle=style, zorder=order, solid_joinstyle="round")
        )
        return
    face = to_rgba(ink.fill, ink.dense) if ink.fill else "none"
    axes.add_patch(
        Polygon(mark.spots, closed=True, facecolor=face, edgecolor=ink.line, linewidth=ink.width, linestyle=style,
                zorder=order, joinstyle="round")
    )  # fmt: skip
    if ink.hatch:
        hatched = {"facecolor": "none", "edgecolor": "#8A8A8A", "linewidth": 0.0, "hatch": "////"}
        axes.add_patch(Polygon(mark.spots, closed=True, zorder=order, **hatched))


def png_of(page: Page, dots: float = DOTS) -> bytes:
    """The page as a PNG, with its title and its alternative text as metadata."""
    require_matplotlib("a png")
    stream = io.BytesIO()
    told = {"Title": page.title, "Description": page.alternative, "Software": "dofkit"}
    figure_of(page).savefig(stream, format="png", dpi=dots, metadata=told)
    return stream.getvalue()


def write_pdf(page: Page, path: Path) -> None:
    """Write the page as a PDF, with its title and its alternative text as metadata. Raises OSError."""
    require_matplotlib("a pdf")
    told = {"Title": page.title, "Subject": page.alternative, "CreationDate": None}
    figure_of(page).savefig(path, format="pdf", metadata=told)
