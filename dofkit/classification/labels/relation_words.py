"""The relations of joints in words, for sentences on which of a constraint's equations are implied."""

from __future__ import annotations

from dofkit.expressions.text import to_text
from dofkit.system import Relation

#: A relation of a joint in words, by the first word of its name; ``{}`` is the rest of the name.
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
#: The addition, or the other text, for relations with a direction or point of the reference configuration.
_ABOUT = {
    "point": " {}",
    "axis": "no rotation about {}",
    "across": "no displacement along {}",
    "distance": " {}",
}


def in_words(relation: Relation, otherwise: str) -> str:
    """Return a relation in words; ``otherwise`` for a relation without a name.

    >>> from dofkit.expressions.tree import ONE, ZERO
    >>> in_words(Relation(ZERO, part="axis", vector=(ONE, ZERO, ZERO)), "")
    'no rotation about (1, 0, 0)'
    """
    word, _, remainder = relation.part.partition(" ")
    answer = _SAYS[word].format(remainder) if word in _SAYS else relation.part or otherwise
    general = any(str(s.args[1]).startswith("_") for part in relation.vector or () for s in part.symbols)
    if word not in _ABOUT or not relation.vector or general:
        return answer
    about = _ABOUT[word].format(f"({', '.join(to_text(part) for part in relation.vector)})")
    return answer + about if about.startswith(" ") else about
