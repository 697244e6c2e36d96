"""A page as SVG, or drawn by matplotlib: png, pdf, and the frames of gif and mp4."""

from __future__ import annotations

import io
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape, quoteattr

from dofkit.base.display import schemes
from dofkit.base.errors import DofkitError
from dofkit.base.wording import format_of_path
from dofkit.pictures.paper import Mark, Page, Spot
from dofkit.pictures.shapes import ON_DARK, Sketch

#: The CSS class of all pictures.
CLASS = "dofkit-picture"
FONT = "DejaVu Sans, Verdana, Arial, sans-serif"
#: Dots per inch of still pictures.
DOTS = 160
NO_MATPLOTLIB = "{} needs matplotlib: pip install 'dofkit[pictures]'"
#: A condition by which programs that do not know ``light-dark`` ignore the rules (they would paint black).
_AS_MODERN = "@supports (color:light-dark(#fff,#000))"
_COLOUR = re.compile('(fill|stroke)="(#[0-9A-F]{6})"')
_HATCH = (
    '<pattern id="hatch" width="6" height="6" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
    '<line x1="0" y1="0" x2="0" y2="6" stroke="#6E6E6E" stroke-width="0.9"/></pattern>'
)


class ExtraMissingError(DofkitError):
    """A package or program that is needed is not installed; the message says which."""


Writer = Callable[[Path], object]


@dataclass(frozen=True)
class DrawnSketch(ABC):
    """The base class of pictures that notebooks show and `save` writes to files."""

    sketch: Sketch

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.alternative!r})"

    @property
    def alternative(self) -> str:
        """A description of the picture in words, with the answer."""
        return self.sketch.alternative

    @property
    @abstractmethod
    def page(self) -> Page:
        """The picture as a page of marks."""

    @abstractmethod
    def html(self) -> str:
        """Return an HTML page that needs no network."""

    def svg(self) -> str:
        """Return the picture as the text of an SVG."""
        return svg_of(self.page)

    def save(self, path: str | Path) -> Path:
        """Write a file whose format is the path's extension (svg, png, pdf, html, gif, mp4), and return the path.

        Only motions can be films (gif, mp4). Raises ArgumentError for any other extension, ExtraMissingError if
        matplotlib or ffmpeg is missing, OSError.
        """
        target = Path(path)
        writers = self.writers()
        writers[format_of_path(target, writers)](target)
        return target

    def writers(self) -> Mapping[str, Writer]:
        """Return {file extension: function that writes the file}."""
        return {
            "svg": lambda path: path.write_text(self.svg(), encoding="utf-8"),
            "png": lambda path: path.write_bytes(png_of(self.page)),
            "pdf": lambda path: write_pdf(self.page, path),
            "html": lambda path: path.write_text(self.html(), encoding="utf-8"),
        }


# SVG


def svg_of(page: Page, width: float | None = None, script: str = "") -> str:
    """Return the page as an ``svg`` element, ``width`` pixels wide (None: the page's width), with a ``script``.

    In a dark page its colours are those of dark paper; programs without style sheets show light paper.
    """
    on_screen = page.width if width is None else width
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="{CLASS}" viewBox="0 0 {page.width:g} {page.height:g}" '
        f'width="{on_screen:g}" height="{on_screen * page.height / page.width:g}" role="img" '
        f'font-family="{FONT}" stroke-linejoin="round">'
    )
    words = f"<title>{escape(page.title or page.alternative)}</title><desc>{escape(page.alternative)}</desc>"
    ground = f'<rect width="{page.width:g}" height="{page.height:g}" fill="#FFFFFF"/>'
    body = "\n".join(_element(mark, page.height) for mark in page.marks)
    drawing = f"<defs>{_HATCH}</defs>{ground}\n{body}"
    ending = f"<script>//<![CDATA[\n{script}\n//]]></script>" if script else ""
    return f"{head}\n{words}{dark_style(drawing)}{drawing}\n{ending}</svg>\n"


def dark_style(drawing: str) -> str:
    """Return the style that gives each colour of a drawing its tone on dark paper."""
    rules = (
        f'.{CLASS} [{paint}="{colour}"]{{{paint}:light-dark({colour},{ON_DARK[colour]})}}'
        for paint, colour in sorted(set(_COLOUR.findall(drawing)))
        if colour in ON_DARK
    )
    return f"<style>{_AS_MODERN}{{{schemes('.' + CLASS)}{''.join(rules)}}}</style>"


def _element(mark: Mark, height: float) -> str:
    """Return the SVG element of a mark on a page of this height."""
    owner = f" data-owner={quoteattr(mark.owner)}" if mark.owner else ""
    if mark.text:
        x, y = mark.positions[0]
        weight = ' font-weight="bold"' if mark.bold else ""
        return (
            f'<text x="{x:.1f}" y="{height - y:.1f}" font-size="{mark.size:g}" text-anchor="{mark.align}"{weight}'
            f' fill="{mark.ink.line}" stroke="#FFFFFF" stroke-width="2.4" '
            f'paint-order="stroke"{owner}>{escape(mark.text)}</text>'
        )
    path = f"M{_steps(mark.positions, height)}{'z' if mark.closed else ''}"
    return "".join(f'<path d="{path}" {attributes}{owner}/>' for attributes in _paints(mark))


def _steps(positions: Sequence[Spot], height: float) -> str:
    """Return an SVG path: the first position and the steps to the next ones, rounded to tenths of a point."""
    tenths = [(round(10 * x), round(10 * (height - y))) for x, y in positions]
    pairs = [tenths[0], *((c - a, d - b) for (a, b), (c, d) in pairwise(tenths))]
    first, *others = (f"{x / 10:g}{'' if y < 0 else ' '}{y / 10:g}" for x, y in pairs)
    return f"{first}l{' '.join(others)}"


def _paints(mark: Mark) -> Iterator[str]:
    ink = mark.ink
    dash = f' stroke-dasharray="{" ".join(f"{d:g}" for d in ink.dash)}"' if ink.dash else ""
    line = f'stroke="{ink.line}" stroke-width="{ink.width:g}"{dash}'
    fill = f'fill="{ink.fill}" fill-opacity="{ink.dense:g}"' if mark.closed and ink.fill else 'fill="none"'
    yield f"{fill} {line}"
    if mark.closed and ink.hatch:
        yield 'fill="url(#hatch)" fill-opacity="0.5"'


# Matplotlib


def has_matplotlib() -> bool:
    """Return whether matplotlib is installed."""
    return find_spec("matplotlib") is not None


def require_matplotlib(what: str) -> None:
    """Raise ExtraMissingError if matplotlib, which ``what`` needs, is not installed."""
    if not has_matplotlib():
        raise ExtraMissingError(NO_MATPLOTLIB.format(what))


def figure_of(page: Page) -> Any:
    """Return the page as a matplotlib figure."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(page.width / 72, page.height / 72), facecolor="white")
    FigureCanvasAgg(figure)
    draw_marks(figure.add_axes((0.0, 0.0, 1.0, 1.0)), page)
    return figure


def draw_marks(axes: Any, page: Page) -> None:
    """Draw all marks on axes whose units are points."""
    axes.set_axis_off()
    axes.set(xlim=(0, page.width), ylim=(0, page.height))
    for order, mark in enumerate(page.marks):
        (_draw_text if mark.text else _draw_path)(axes, mark, order)


def _draw_text(axes: Any, mark: Mark, order: int) -> None:
    from matplotlib.patheffects import withStroke

    x, y = mark.positions[0]
    align = {"start": "left", "middle": "center", "end": "right"}[mark.align]
    axes.text(
        x, y, mark.text.replace("$", r"\$"), fontsize=mark.size, ha=align, va="baseline", color=mark.ink.line,
        fontweight="bold" if mark.bold else "normal", zorder=order, snap=False,
        path_effects=[withStroke(linewidth=2.4, foreground="white")],
    )  # fmt: skip


def _draw_path(axes: Any, mark: Mark, order: int) -> None:
    """Add a line or a polygon to matplotlib's ``axes``."""
    from matplotlib.colors import to_rgba
    from matplotlib.lines import Line2D
    from matplotlib.patches import Polygon

    ink = mark.ink
    dash: Any = (0, tuple(d / max(ink.width, 0.1) for d in ink.dash)) if ink.dash else "-"
    style = {"linewidth": ink.width, "linestyle": dash, "zorder": order}
    if not mark.closed:
        axes.add_line(Line2D(*zip(*mark.positions, strict=True), color=ink.line, solid_joinstyle="round", **style))
        return
    face = to_rgba(ink.fill, ink.dense) if ink.fill else "none"
    axes.add_patch(Polygon(mark.positions, closed=True, facecolor=face, edgecolor=ink.line, joinstyle="round", **style))
    if ink.hatch:
        hatched = {"facecolor": "none", "edgecolor": "#8A8A8A", "linewidth": 0.0, "hatch": "////"}
        axes.add_patch(Polygon(mark.positions, closed=True, zorder=order, **hatched))


def png_of(page: Page, dots: float = DOTS) -> bytes:
    """Return the page as a PNG, with its title and its alternative text as metadata."""
    require_matplotlib("a png")
    stream = io.BytesIO()
    metadata = {"Title": page.title, "Description": page.alternative, "Software": "dofkit"}
    figure_of(page).savefig(stream, format="png", dpi=dots, metadata=metadata)
    return stream.getvalue()


def write_pdf(page: Page, path: Path) -> None:
    """Write the page as a PDF, with its title and its alternative text as metadata. Raises OSError."""
    require_matplotlib("a pdf")
    metadata = {"Title": page.title, "Subject": page.alternative, "CreationDate": None}
    figure_of(page).savefig(path, format="pdf", metadata=metadata)
