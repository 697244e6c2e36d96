"""Why a constraint is called what it is: one or two sentences that a student can follow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from dofkit.integrability.single_form import Integrability
from dofkit.report import Form

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
