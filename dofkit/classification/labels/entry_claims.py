"""How sure each label of an entry is, by which argument, and of which points it is told."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from dofkit.base.verdicts import OPEN, ArgumentKey, Claim, Verdict, least, together, weakest
from dofkit.relations.answer import BITS, GAP, Answer, HolonomyLabel
from dofkit.report import Form

#: The argument for a label that was found by itself, by the form of a constraint.
BY_FORM: Mapping[Form, ArgumentKey] = {
    "finite": "finite relation",
    "inequality": "inequality",
    "nonlinear": "curved velocities",
}


class FoundLabels(NamedTuple):
    """Labels by their fields, and how sure each is; of forms, whether all were proved to integrate by themselves."""

    values: Mapping[str, Any]
    verdicts: Mapping[str, Verdict]
    by_themselves: bool


class Ground(NamedTuple):
    """What the claims of one constraint rest on: the answers of its blocks, and the labels of its rows there."""

    form: Form
    answers: Sequence[Answer]
    labels: Sequence[HolonomyLabel]

    def claim(self, verdict: Verdict, argument: ArgumentKey, local: bool = True) -> Claim:
        """A claim with the bound that the blocks have; ``local``: of the points that they were answered at."""
        bits = min((a.bits for a in self.answers), default=BITS)
        gap = min((a.gap for a in self.answers), default=GAP)
        about = least(*(a.about for a in self.answers)) if local else "everywhere"
        return OPEN if verdict == "undecided" else Claim(verdict, argument, bits, gap, about)


def claims_of_labels(ground: Ground, found: FoundLabels) -> dict[str, Claim]:
    """The claims of the labels that were decided, and of those that are open."""
    claims = {}
    for name, value in found.values.items():
        verdict: Verdict = "undecided" if value is None else found.verdicts[name]
        claims[name] = ground.claim(verdict, _argument(ground, found, name, value), name in ("holonomic", "integral"))
    return claims


def _argument(ground: Ground, found: FoundLabels, name: str, value: Any) -> ArgumentKey:
    if name in ("scleronomic", "catastatic", "exact"):
        return "identity" if value else "zero with another derivative"
    if found.by_themselves and value:
        return "form by itself"
    if ground.form in BY_FORM:
        return BY_FORM[ground.form]
    if value is False:
        return "outside the integrable part"
    line = all(label.reason == "line" for label in ground.labels)
    return "line field" if ground.labels and line else "in the integrable part"


def claim_of_dependence(ground: Ground, all_needed: bool, copied: bool) -> Claim:
    """How sure it is how many equations are independent of those before, and of what the others follow."""
    own = together(*(a.claim for a in ground.answers))
    if not ground.answers or copied:
        return Claim("proved", "identity")
    if own.verdict == "undecided" or all_needed:
        return own
    if own.argument in ("links in general position", "exact elimination"):
        return own
    return ground.claim(weakest(own.verdict, "probable"), "rows at a point")
