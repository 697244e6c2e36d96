"""A page as SVG, with its title and its alternative text."""

from __future__ import annotations

import re
from collections.abc import Iterator
from xml.sax.saxutils import escape, quoteattr

from dofkit.base.display import schemes
from dofkit.pictures.looks import ON_DARK, Ink
from dofkit.pictures.paper import Mark, Page, Spot

#: Of everything that is drawn, for its style.
CLASS = "dofkit-picture"
FONT = "DejaVu Sans, Verdana, Arial, sans-serif"
#: Typesetters that do not know the colours of style sheets would take them for black: they pass over this.
_AS_MODERN = "@supports (color:light-dark(#fff,#000))"
_COLOUR = re.compile('(fill|stroke)="(#[0-9A-F]{6})"')
_HATCH = (
    '<pattern id="hatch" width="6" height="6" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
    '<line x1="0" y1="0" x2="0" y2="6" stroke="#6E6E6E" stroke-width="0.9"/></pattern>'
)


def svg_of(page: Page, width: float | None = None, script: str = "") -> str:
    """The page as an ``svg`` element, ``width`` wide on a screen (by default its own); ``script`` runs in it.

    Where it is shown in the dark its colours are those of dark paper; what knows of no style sheets has light paper.
    """
    shown = page.width if width is None else width
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="{CLASS}" viewBox="0 0 {page.width:g} {page.height:g}" '
        f'width="{shown:g}" height="{shown * page.height / page.width:g}" role="img" font-family="{FONT}">'
    )
    told = f"<title>{escape(page.title)}</title><desc>{escape(page.alternative)}</desc>"
    ground = f'<rect width="{page.width:g}" height="{page.height:g}" fill="#FFFFFF"/>'
    body = "\n".join(_element(mark, page.height) for mark in page.marks)
    parts = f"<defs>{_HATCH}</defs>{ground}\n{body}"
    ending = f"<script>//<![CDATA[\n{script}\n//]]></script>" if script else ""
    return f"{head}\n{told}{dark_style(parts)}{parts}\n{ending}</svg>\n"


def dark_style(parts: str) -> str:
    """The style that gives each colour in parts of a picture its tone on dark paper; they are of its class."""
    rules = (
        f'.{CLASS} [{paint}="{colour}"]{{{paint}:light-dark({colour},{ON_DARK[colour]})}}'
        for paint, colour in sorted(set(_COLOUR.findall(parts)))
        if colour in ON_DARK
    )
    return f"<style>{_AS_MODERN}{{{schemes('.' + CLASS)}{''.join(rules)}}}</style>"


def _element(mark: Mark, height: float) -> str:
    owner = f" data-owner={quoteattr(mark.owner)}" if mark.owner else ""
    if mark.text:
        x, y = mark.spots[0]
        weight = ' font-weight="bold"' if mark.bold else ""
        return (
            f'<text x="{x:.1f}" y="{height - y:.1f}" font-size="{mark.size:g}" text-anchor="{mark.align}"{weight}'
            f' fill="{mark.ink.line}" stroke="#FFFFFF" stroke-width="2.4" stroke-linejoin="round" '
            f'paint-order="stroke"{owner}>{escape(mark.text)}</text>'
        )
    path = _path(mark.spots, mark.closed, height)
    return "".join(f'<path d="{path}" {attributes}{owner}/>' for attributes in _paints(mark.ink, mark.closed))


def _path(spots: tuple[Spot, ...], closed: bool, height: float) -> str:
    told = "L".join(f"{x:.1f} {height - y:.1f}" for x, y in spots)
    return f"M{told}{'Z' if closed else ''}"


def _paints(ink: Ink, closed: bool) -> Iterator[str]:
    dash = f' stroke-dasharray="{" ".join(f"{d:g}" for d in ink.dash)}"' if ink.dash else ""
    line = f'stroke="{ink.line}" stroke-width="{ink.width:g}" stroke-linejoin="round"{dash}'
    fill = f'fill="{ink.fill}" fill-opacity="{ink.dense:g}"' if closed and ink.fill else 'fill="none"'
    yield f"{fill} {line}"
    if closed and ink.hatch:
        yield 'fill="url(#hatch)" fill-opacity="0.5"'
