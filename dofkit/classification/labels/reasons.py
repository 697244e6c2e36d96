"""Why a constraint is called what it is: one or two sentences that a student can follow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.integrability.single_form import Integrability
from dofkit.report import Form
from dofkit.system import Relation

_INITIAL = "the constant is determined by the initial conditions"
_CHECKED = " (checked at random points)"


@dataclass(frozen=True)
class Others:
    """What the other constraints do for a form: the names of those it needs (None: not sought), and the integral.

    ``timed``: whether t occurs in the integral; None without one.
    """

    names: tuple[str, ...] | None = None
    integral: str | None = None
    identically: bool = True
    timed: bool | None = None

    @property
    def text(self) -> str:
        """The integral with how it was checked."""
        return f"{self.integral}{'' if self.identically else _CHECKED}"


@dataclass(frozen=True)
class Labels:
    """What is said of a constraint: in the system, alone, and why it was left open where it was.

    ``beside``: what the others make of one that is nonlinear in the velocities.
    """

    in_system: bool | None
    alone: bool | None
    undecided: str = ""
    relates: bool = True
    beside: str = ""


def joined(parts: Sequence[str | None]) -> str | None:
    """The parts in one text; None unless every one is there."""
    found = [p for p in parts if p is not None]
    return "; ".join(found) if found and len(found) == len(parts) else None


def reason_of(
    form: Form, labels: Labels, proofs: Sequence[Integrability], circuit: list[str] | None, others: Others
) -> str:
    """The sentences, by the constraint's form and labels."""
    if form == "pfaffian":
        reason = _pfaffian(labels, proofs, others)
    elif form == "nonlinear":
        reason = _nonlinear(labels)
    elif form == "inequality":
        reason = (
            "An inequality is a unilateral constraint: it is not holonomic and does not reduce the number of "
            "degrees of freedom."
        )
    elif labels.relates:
        reason = "It relates coordinates (and possibly time) only, so it is holonomic."
    else:
        reason = "It relates no coordinates: it is satisfied always, or everywhere within a region."
    if circuit:
        reason += f" It is implied by {', '.join(circuit)}."
    elif circuit is not None:
        reason += " It imposes no condition beyond the others."
    return reason


def _nonlinear(labels: Labels) -> str:
    if labels.in_system:
        return (
            "On its own it is not linear in the velocities; together with the other constraints it is "
            "integrable, so it is holonomic here."
        )
    if labels.in_system is None:
        flat = "the admissible velocities may form linear subspaces, so that it may be equivalent to linear equations"
        return f"Not decided: {labels.undecided or flat}."
    why = labels.beside or "It is not linear in the velocities and is not a consequence of geometric equations"
    return f"{why}: non-holonomic; it restricts the velocities, not the accessible configurations."


def _pfaffian(labels: Labels, proofs: Sequence[Integrability], others: Others) -> str:
    if labels.in_system is None:
        return f"Not decided: {labels.undecided or 'the engines found no regular point to decide at'}."
    if labels.in_system and labels.alone:
        return _integrable(proofs, others)
    if labels.in_system:
        with_whom = "the other constraints" if not others.names else " and ".join(others.names)
        integrates = "is integrable" if others.integral is None else f"integrates to {others.text}"
        return (
            f"It is not integrable on its own; together with {with_whom} it {integrates}. "
            f"In this system it is holonomic, and {_INITIAL}."
        )
    if labels.alone:
        return "It is integrable on its own."
    modulo = ""
    if others.integral is not None:
        modulo = f" It is integrable modulo the others: together with them it implies {others.text}."
    return (
        "It fails Frobenius' condition on the admissible velocities: it is not a consequence of any relation between "
        "coordinates (and time). It is non-holonomic: it restricts the velocities, not the accessible "
        f"configurations.{modulo}"
    )


def _integrable(proofs: Sequence[Integrability], others: Others) -> str:
    found = joined([p.integral for p in proofs]) or (others.integral and others.text)
    if found:
        return f"It integrates to {found}: holonomic; {_INITIAL}."
    how = next((p.reason for p in proofs if p.reason), "d(omega) ^ omega = 0")
    return f"It is integrable ({how}), though no integral was found in closed form: holonomic; {_INITIAL}."


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
