"""The reasons for the labels of a constraint, in one or two sentences that a student can follow."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from dofkit.base.verdicts import OPEN, ArgumentKey, Claim, TraitAnswer, Verdict, all_of, least, together, weakest
from dofkit.base.wording import verb
from dofkit.classification.labels.relation_words import in_words
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.traits import Integrability, Traits, timeless, vanishes_on
from dofkit.relations.answer import BITS, GAP, Answer, HolonomyLabel
from dofkit.relations.blocks import Block
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.pieces import INSTANT_NOTE, Clause, Finite, Normal, Pfaffian, Piece, Reduced
from dofkit.relations.setting import Setting
from dofkit.report import Form

_INITIAL = "the constant is determined by the initial conditions"
_CHECKED = " (checked at random points)"


@dataclass(frozen=True)
class Others:
    """The ``names`` of the companions of a form (None if not searched), and the ``integral`` together with them.

    ``identically``: the integral was verified by an identity, not at points; ``timed``: whether t occurs in it.
    """

    names: tuple[str, ...] | None = None
    integral: str | None = None
    identically: bool = True
    timed: bool | None = None

    @property
    def text(self) -> str:
        """The integral, with a remark if it was checked at random points only."""
        return f"{self.integral}{'' if self.identically else _CHECKED}"


class EntryLabels(NamedTuple):
    """Whether a constraint is holonomic ``in_system`` and ``alone``, both verdicts, and why it is ``undecided``.

    ``relates``: it has a row; ``with_others``: the reason for a nonlinear row that the others reduce.
    """

    in_system: bool | None
    alone: bool | None
    verdicts: tuple[Verdict, Verdict]
    undecided: str = ""
    relates: bool = True
    with_others: str = ""


def joined(texts: Sequence[str | None], word: str = "; ") -> str | None:
    """Return the texts joined by ``word``; None if one is missing, or there is none."""
    result = [p for p in texts if p is not None]
    return word.join(result) if result and len(result) == len(texts) else None


def reason_of(
    form: Form, labels: EntryLabels, proofs: Sequence[Integrability], circuit: list[str] | None, others: Others
) -> str:
    """Return the sentences that give the reason for the labels of a constraint of this form."""
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


def _nonlinear(labels: EntryLabels) -> str:
    """Return the reason for the labels of a constraint that is nonlinear in the velocities."""
    if labels.in_system:
        return (
            "On its own it is not linear in the velocities; together with the other constraints it is "
            "integrable, so it is holonomic here."
        )
    if labels.in_system is None:
        flat = "the admissible velocities may form linear subspaces, so that it may be equivalent to linear equations"
        return f"Not decided: {labels.undecided or flat}."
    why = labels.with_others or "It is not linear in the velocities and is not a consequence of geometric equations"
    return f"{why}: non-holonomic; it restricts the velocities, not the accessible configurations."


def _pfaffian(labels: EntryLabels, proofs: Sequence[Integrability], others: Others) -> str:
    """Return the reason for the labels of a Pfaffian constraint."""
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
    if others.integral:
        return f"It integrates to {others.text}: holonomic; {_INITIAL}."
    how = next((p.reason for p in proofs if p.reason and p.integral is None), "d(omega) ^ omega = 0")
    return f"It is integrable ({how}), though no integral was found in closed form: holonomic; {_INITIAL}."


REDUNDANT = " It is redundant: the other constraints, including those written after it, allow the same motions."
ON_COMPONENT = " The claim is about the component of the configuration space that contains the report's witness."


class EntryDependence(NamedTuple):
    """The dependence of one constraint on those before it, or on all others.

    ``independent``: the number of equations independent of those before, None if unknown; ``circuit``: the names of the
    constraints that imply it; ``open``: a sentence on what is undecided; ``following``: the numbers of its implied
    equations, ``seen``: by numerical evidence; ``claim``: of all this, given the freedom.
    """

    independent: int | None
    circuit: list[str] | None
    redundant: bool
    open: str
    following: frozenset[int] | None
    seen: bool
    claim: Claim

    @property
    def has_dependence(self) -> bool:
        """Whether anything but the number of independent equations is stated."""
        return bool(self.circuit is not None or self.redundant or self.open or self.seen or self.following)

    def of(self, equations: int) -> int | None:
        """Return how many of so many equations are independent; None if undecided."""
        return None if self.independent is None or self.open else min(self.independent, equations)

    def implied(self, reduced: Reduced) -> list[str] | None:
        """Return the implied equations in words; None if they are not as many as are not independent."""
        independent = self.of(reduced.equations)
        if self.following is None or independent is None or len(self.following) != reduced.equations - independent:
            return None
        written = [r for r in reduced.constraint.relations if r.sense == "="] if self.following else []
        return [in_words(written[k], reduced.constraint.text) for k in sorted(self.following)]

    def sentences(self, implied: Sequence[str] | None, equations: int) -> Iterator[str]:
        """Yield that the constraint can be left out, which equations are implied, or what is undecided."""
        if self.redundant and self.circuit is None:
            yield REDUNDANT
        if self.redundant and self.claim.about == "component":
            yield ON_COMPONENT
        if self.open:
            yield f" {self.open}"
        elif implied and equations > 1:
            whole = len(implied) == equations
            few = f"All {equations} of its" if whole else f"{len(implied)} of its {equations}"
            yield f" {few} equations {verb(len(implied))} implied by the preceding ones: {'; '.join(implied)}."


class EntryTraits(NamedTuple):
    """The labels about time and exactness of a constraint, and their verdicts.

    ``by``: the field on which ``scleronomic`` depends (is it integrable?), if t does not occur in the constraint as
    written but a term without velocities does.
    """

    scleronomic: bool | None
    catastatic: bool | None
    exact: bool | None
    verdicts: Mapping[str, Verdict]
    by: str | None = None


def timed_in_system(
    piece: Clause, block: Block | None, answer: Answer, others: Others, setting: Setting
) -> TraitAnswer:
    """Return (whether t occurs in the integral of a form with the others, verdict): not if they make its dt term 0."""
    sure: Verdict = "proved" if others.identically else "probable"
    if others.timed is False or not isinstance(piece, Pfaffian) or block is None:
        return others.timed, sure
    finite = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)]
    for g in (*finite, *answer.hidden):
        still, result = vanishes_on(g, piece.dt, setting.positive)
        if still:
            return False, result if g in finite else weakest(result, answer.verdict)
    return others.timed, sure


def declared_functions(normals: Sequence[Normal]) -> list[Piece]:
    """Return the branches u = 0 of products with a declared function u, which are left out because u is generic."""
    return [
        b[0]
        for n in normals
        for b in n.branches
        if len(n.branches) > 1 and len(b) == 1 and isinstance(b[0], Finite) and b[0].expr.op == "call"
    ]


def traits_together(
    traits: Sequence[Traits], form: Form, labels: EntryLabels, timed: TraitAnswer | None
) -> EntryTraits:
    """Return the traits of a constraint from those of its equations; ``timed``: whether t occurs in its integral."""
    timeless = all_of([t.timeless for t in traits])
    still = all_of([t.catastatic for t in traits if t.catastatic is not None])
    closed = all_of([t.exact for t in traits if t.exact is not None])
    scleronomic, by = _scleronomic(timeless, still, form, labels, timed)
    return EntryTraits(
        scleronomic[0],
        still[0] if form in ("pfaffian", "nonlinear") else None,
        closed[0] if form == "pfaffian" else None,
        {"scleronomic": scleronomic[1], "catastatic": still[1], "exact": closed[1]},
        by,
    )


def branches_of_time(reduced: Reduced, consistent: bool, positive: frozenset[Expr]) -> Iterator[Traits]:
    """Yield traits for equations with branches on different intervals of time, or with one that fixes the time.

    A branch that fixes the time was left out, which changes nothing if motions satisfy the others.
    """
    for k, n in enumerate(reduced.normals):
        conditions = ([p.expr for p in b if isinstance(p, DomainCondition)] for b in n.branches)
        intervals = {frozenset(e for e in of_branch if ex.TIME in e.symbols) for of_branch in conditions}
        if len(intervals) > 1:
            timed = timeless(Finite(reduced.written[k].expr), positive)
            yield Traits(timed if timed[0] is False else (None, "undecided"))
        elif INSTANT_NOTE in n.notes and not consistent:
            yield Traits((None, "undecided"))


def _scleronomic(
    timeless: TraitAnswer, still: TraitAnswer, form: Form, labels: EntryLabels, timed: TraitAnswer | None
) -> tuple[TraitAnswer, str | None]:
    """Return whether t occurs neither in a constraint nor in its integral, and the field on which this depends.

    A constraint without t that is homogeneous in the velocities has an integral without t. If it is not homogeneous and
    integrable on its own, the integral has a nonzero derivative by t.
    """
    if timeless[0] is False or still[0]:
        return timeless, None
    in_system, alone = labels.verdicts
    if still[0] is False and form in ("pfaffian", "nonlinear"):
        if labels.alone:
            return (False, weakest(still[1], alone)), "holonomic_alone"
        if labels.in_system is False:
            return (timeless[0], weakest(timeless[1], in_system)), "holonomic"
        if labels.in_system and timed is not None and timed[0] is not None:
            sure = weakest(timeless[1], still[1], in_system, timed[1])
            return (False if timed[0] else timeless[0], sure), "holonomic"
    return (None, "undecided"), None


def reason_of_time(traits: EntryTraits) -> str:
    """Return a sentence about a constraint that is not homogeneous in the velocities, if it is one."""
    if traits.by is None or traits.scleronomic is None:
        return ""
    if traits.scleronomic:
        return " It is not homogeneous in the velocities: acatastatic."
    together = " together with the others" if traits.by == "holonomic" else ""
    return f" Time occurs in what it integrates to{together}: rheonomic."


#: The argument for a label of a constraint on its own, by its form.
BY_FORM: Mapping[Form, ArgumentKey] = {
    "finite": "finite relation",
    "inequality": "inequality",
    "nonlinear": "curved velocities",
}
#: The arguments for forms that are integrable only together with other constraints.
_IN_SYSTEM: tuple[ArgumentKey, ArgumentKey] = ("line field", "in the integrable part")


class Ground(NamedTuple):
    """The basis of the claims of one constraint: the answers of its blocks, and the labels of its rows there."""

    form: Form
    answers: Sequence[Answer]
    labels: Sequence[HolonomyLabel]

    def claim(self, verdict: Verdict, argument: ArgumentKey, local: bool = True) -> Claim:
        """Return a claim with the weakest bounds of the blocks; if ``local``, about the points of their answers.

        Integrability in the system is a claim about the branch that was analysed.
        """
        bits = min((a.bits for a in self.answers), default=BITS)
        gap = min((a.gap for a in self.answers), default=GAP)
        about = least(*(a.about for a in self.answers)) if local else "everywhere"
        if about == "everywhere" and argument in _IN_SYSTEM and any(a.one_branch for a in self.answers):
            about = "component"
        return OPEN if verdict == "undecided" else Claim(verdict, argument, bits, gap, about)

    def argument(self, value: bool | None, on_their_own: bool) -> ArgumentKey:
        """Return the argument by which the constraint is holonomic, or is not."""
        if on_their_own and value:
            return "form by itself"
        if self.form in BY_FORM and not (self.form == "nonlinear" and value):
            return BY_FORM[self.form]
        if value is False:
            return "outside the integrable part"
        is_line = all(label.reason == "line" for label in self.labels)
        return "line field" if self.labels and is_line else "in the integrable part"


def claim_of_dependence(ground: Ground, dependence: EntryDependence, all_needed: bool) -> Claim:
    """Return the claim of the number of independent equations and of what implies the others."""
    if dependence.claim.argument == "identity":
        return dependence.claim
    of_blocks = together(*(a.claim for a in ground.answers))
    return of_blocks if all_needed else together(of_blocks, dependence.claim)
