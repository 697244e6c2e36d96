"""What a scalar equation of a constraint says, in words."""

from __future__ import annotations

from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.system import Relation

#: Of a relation by the first word of its name; ``{}`` is the rest of the name.
_SAYS = {
    "point": "no displacement along {} of the common point",
    "origin": "no displacement along {}",
    "x": "no displacement along x",
    "y": "no displacement along y",
    "z": "no displacement along z",
    "axis": "no rotation across the axis",
    "orientation": "no rotation about {}",
    "angle": "no rotation",
    "across": "no displacement across the axis",
    "distance": "no displacement along the normal",
    "axes": "the axes stay perpendicular",
    "thread": "the advance by the pitch",
    "drive": "the prescribed motion",
    "length": "the distance {}",
}
#: Of those that are about a direction or a place of the drawing.
_ABOUT = {
    "point": " {}",
    "axis": "no rotation about {}",
    "across": "no displacement along {}",
    "distance": " {}",
}


def in_words(relation: Relation, otherwise: str) -> str:
    """A relation in words; ``otherwise`` for one without a name.

    >>> from dofkit.expressions.tree import ONE, ZERO
    >>> in_words(Relation(ZERO, part="axis", vector=(ONE, ZERO, ZERO)), "")
    'no rotation about (1, 0, 0)'
    """
    word, _, rest = relation.part.partition(" ")
    told = _SAYS[word].format(rest) if word in _SAYS else relation.part or otherwise
    if word not in _ABOUT or not relation.vector or not _given(relation.vector):
        return told
    about = _ABOUT[word].format(f"({', '.join(to_text(part) for part in relation.vector)})")
    return told + about if about.startswith(" ") else about


def _given(vector: tuple[Expr, ...]) -> bool:
    """Is nothing in general position?"""
    return not any(str(s.args[1]).startswith("_") for part in vector for s in part.symbols)
