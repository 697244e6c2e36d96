"""How things look: colours that the colour-blind tell apart (Okabe and Ito's), and a pattern beside each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from dofkit.pictures.shapes import Role, Shape, State

SKY, GREEN = "#56B4E9", "#009E73"
BLUE, VERMILLION, PURPLE, GREY, WHITE = "#0072B2", "#D55E00", "#CC79A7", "#6E6E6E", "#FFFFFF"
INK = "#222222"


#: Each colour as it is on dark paper; on light paper it is as named.
ON_DARK: Mapping[str, str] = {
    WHITE: "#151B23", "#F1F1F1": "#1E2630", "#EFEFEF": "#2A333D", "#A8A8A8": "#7D8792",
    "#8A8A8A": "#78828D", GREY: "#97A1AC", "#555555": "#A9B3BD", "#444444": "#C3CBD3", "#333333": "#CBD3DB",
    INK: "#E6EDF3", BLUE: "#6CB6F0", SKY: "#56B4E9", GREEN: "#2FC99E", "#8CCDB9": "#3E8A75",
    "#7A5C2E": "#CBA56A", "#B87A00": "#E8AC3C", "#FBE3B5": "#4B3B17", "#8A5A00": "#EDB44E",
    VERMILLION: "#FF8B45", "#F7CDB4": "#55321D", "#B34700": "#FF955A", PURPLE: "#E3A0C5",
}  # fmt: skip


class Ink(NamedTuple):
    """A line's colour, width and dashes in points; a fill, how dense it is, and its hatching; what lies above what."""

    line: str = INK
    width: float = 1.2
    dash: tuple[float, ...] = ()
    fill: str | None = None
    dense: float = 1.0
    hatch: bool = False
    layer: int = 3


_PLAIN: Mapping[Role, Ink] = {
    "body": Ink("#555555", 1.0, fill="#A8A8A8", dense=0.45, hatch=True, layer=1),
    "joint": Ink(INK, 1.3, fill=WHITE, layer=6),
    "guide": Ink("#555555", 1.0, layer=4),
    "bar": Ink("#333333", 2.6, layer=3),
    "rope": Ink("#7A5C2E", 1.5, layer=3),
    "ground": Ink(INK, 1.3, fill="#EFEFEF", layer=2),
    "hatch": Ink(INK, 0.8, layer=2),
    "axis": Ink(GREY, 0.9, layer=2),
    "locus": Ink(GREEN, 1.8, layer=2),
    "surface": Ink("#8CCDB9", 0.7, layer=2),
    "plane": Ink("#8A8A8A", 0.8, fill="#F1F1F1", layer=0),
    "node": Ink(INK, 0.8, fill="#333333", layer=7),
    "trace": Ink(PURPLE, 1.1, layer=2),
    "tie": Ink(GREY, 1.0, (5.0, 2.0, 1.0, 2.0), layer=2),
    "force": Ink(GREY, 1.1, layer=2),
    "point": Ink(INK, 0.8, fill="#333333", layer=7),
    "name": Ink(INK, layer=9),
    "field": Ink(BLUE, 0.8, fill=SKY, dense=0.3, layer=3),
    "bracket": Ink(VERMILLION, 2.0, (5.0, 2.0), layer=5),
    "further": Ink(PURPLE, 2.0, (1.5, 1.5), layer=5),
}
_LOUD: Mapping[State, Ink] = {
    "redundant": Ink("#B87A00", 2.2, (5.0, 2.5), fill="#FBE3B5", layer=6),
    "conflicting": Ink(VERMILLION, 3.2, (2.2, 1.4), fill="#F7CDB4", layer=6),
}


def ink_of(shape: Shape) -> Ink:
    """How a shape is drawn."""
    plain = _PLAIN[shape.role]
    if shape.kind == "ball" and shape.role == "joint":
        plain = plain._replace(layer=7)
    if shape.state == "moving" and shape.role == "body":
        return plain._replace(line=BLUE, fill=SKY, dense=0.35, hatch=False)
    if shape.state == "moving" and shape.role == "point":
        return plain._replace(line=BLUE, fill=BLUE)
    if shape.state in _LOUD and shape.role in ("joint", "guide", "bar", "rope", "locus", "tie", "surface"):
        loud = _LOUD[shape.state]
        thin = shape.role in ("guide", "joint", "surface")
        return loud._replace(
            fill=loud.fill if plain.fill else None, layer=plain.layer, width=1.9 if thin else loud.width
        )
    if shape.state in _LOUD and shape.role == "name":
        return plain._replace(line={"redundant": "#8A5A00", "conflicting": "#B34700"}[shape.state])
    return plain


def keys_of(shapes: Iterable[Shape], meanings: Mapping[State, str] | None) -> list[tuple[Ink, str]]:
    """What the legend explains: what occurs, and of states those that have a meaning; without meanings nothing."""
    if meanings is None:
        return []
    found: dict[str, Ink] = {}
    for shape in shapes:
        ink = ink_of(shape)
        if shape.role in ("body", "point") and shape.state in ("moving", "plain"):
            if shape.state not in meanings:
                continue
            box = _PLAIN["body"] if shape.state == "plain" else ink._replace(dense=0.5)
            found.setdefault(meanings[shape.state], box)
        elif shape.state in meanings and shape.state in _LOUD and ink.dash == _LOUD[shape.state].dash:
            found.setdefault(meanings[shape.state], ink._replace(fill=None, width=2.4))
        elif shape.role == "bracket":
            found.setdefault("bracket", ink)
        elif shape.role in ("locus", "surface") and shape.state == "plain":
            found.setdefault("set of an equation or inequality", _PLAIN["locus"])
        elif shape.role == "tie" and shape.state == "plain":
            found.setdefault("related by an equation", ink)
        elif shape.role == "force":
            found.setdefault("spring or damper (no constraint)", ink)
    return [(ink, text) for text, ink in found.items()]
