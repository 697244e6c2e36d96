"""Why a constraint is called what it is: one or two sentences that a student can follow."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.base.records import dataclass
from dofkit.integrability.single_form import Integrability
from dofkit.report import Form

_INITIAL = "the constant is set by the initial state"
_CHECKED = " (checked at random points)"


@dataclass(frozen=True)
class Others:
    """What the other constraints do for a form: the names of those it needs (None: not sought), and the integral."""

    names: tuple[str, ...] | None = None
    integral: str | None = None
    identically: bool = True

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
        reason = "An inequality keeps to one side (unilateral): it is not holonomic and takes no freedom away."
    elif labels.relates:
        reason = "A relation between coordinates (and time): holonomic."
    else:
        reason = "It relates no coordinates: it holds always, or everywhere within a region."
    if circuit:
        reason += f" It follows from {', '.join(circuit)}."
    elif circuit is not None:
        reason += " It takes nothing away."
    return reason


def _nonlinear(labels: Labels) -> str:
    if labels.in_system:
        return "Not linear in the velocities alone; with the other constraints it becomes integrable: holonomic here."
    if labels.in_system is None:
        flat = "the velocities it allows may form flat pieces, so that it is linear in disguise"
        return f"Not decided: {labels.undecided or flat}."
    why = labels.beside or "It is not linear in the velocities and no finite relation gives it"
    return f"{why}: non-holonomic; it limits velocities only."


def _pfaffian(labels: Labels, proofs: Sequence[Integrability], others: Others) -> str:
    if labels.in_system is None:
        return f"Not decided: {labels.undecided or 'the engines found no regular point to decide at'}."
    if labels.in_system and labels.alone:
        return _integrable(proofs, others)
    if labels.in_system:
        with_whom = "the other constraints" if not others.names else " and ".join(others.names)
        then = "" if others.integral is None else f", which gives {others.text}"
        return (
            f"Alone it is not integrable; it is integrable only together with {with_whom}{then}: "
            f"in this system it is holonomic, and {_INITIAL}."
        )
    if labels.alone:
        return "Alone it is integrable."
    modulo = ""
    if others.integral is not None:
        modulo = f" It is integrable modulo the others: with them it says {others.text}."
    return (
        "Its curvature does not vanish on the velocities that are left (Frobenius): no function of the coordinates "
        f"has it as a consequence, so it is non-holonomic and limits velocities only.{modulo}"
    )


def _integrable(proofs: Sequence[Integrability], others: Others) -> str:
    found = joined([p.integral for p in proofs]) or (others.integral and others.text)
    if found:
        return f"It integrates to {found}: holonomic; {_INITIAL}."
    how = next((p.reason for p in proofs if p.reason), "d(omega) ^ omega = 0")
    return f"It is integrable ({how}), though no integral was found in closed form: holonomic; {_INITIAL}."
