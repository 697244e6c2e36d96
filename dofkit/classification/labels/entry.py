"""One constraint's entry in the report: its labels, how certain they are, and sentences for a student."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from dofkit.base.verdicts import OPEN, Claim, TraitAnswer, all_of, weakest
from dofkit.classification.labels.reasons import (
    ON_COMPONENT,
    EntryDependence,
    EntryLabels,
    EntryTraits,
    Ground,
    Others,
    branches_of_time,
    claim_of_dependence,
    declared_functions,
    joined,
    reason_of,
    reason_of_time,
    timed_in_system,
    traits_together,
)
from dofkit.exact.zero import BOTH
from dofkit.expressions.tree import TIME
from dofkit.integrability.traits import Integrability, Traits, proved_integrability, traits_of
from dofkit.relations.answer import GAP, Answer, HolonomyLabel
from dofkit.relations.blocks import Block, Row
from dofkit.relations.normal.domain import is_always_satisfied
from dofkit.relations.normal.pieces import Clause, Finite, JointEquation, Nonlinear, Normal, Pfaffian, Reduced
from dofkit.relations.setting import Setting
from dofkit.report import FORMS, ConstraintEntry, FieldVerdict, Form


class LabelledRow(NamedTuple):
    """A row, its label in the system (None for a finite or nonlinear row), and its block's answer.

    ``reduced``: it is a nonlinear row that the others make linear, or imply.
    """

    row: Row
    label: HolonomyLabel | None
    answer: Answer
    block: Block | None = None
    reduced: bool = False


def form_of(piece: Clause) -> Form:
    """Return the report's word for a clause; every condition is an inequality."""
    if isinstance(piece, Finite):
        return "finite"
    if isinstance(piece, Pfaffian):
        return "pfaffian"
    return "nonlinear" if isinstance(piece, Nonlinear) else "inequality"


@dataclass(frozen=True)
class Evidence:
    """The labelled ``rows`` of one constraint, its answer ``by_itself`` (None if finite), its dependence on others.

    ``companions_of(holonomic in the system)`` finds the companions of its form and the integral.
    """

    rows: Sequence[LabelledRow]
    by_itself: Answer | None
    dependence: EntryDependence
    companions_of: Callable[[bool], Others]


def entry(reduced: Reduced, evidence: Evidence, setting: Setting, consistent: bool | None) -> ConstraintEntry:
    """Return the entry of one constraint; ``consistent``: whether the system is."""
    constraint, normals, dependence = reduced.constraint, reduced.normals, evidence.dependence
    pieces: list[Clause] = [p for normal in normals for p in normal.pieces] + list(reduced.inequalities)
    form: Form = max((form_of(p) for p in pieces), key=FORMS.index, default="finite")
    forms = _integrable_forms(normals, evidence.rows)
    proofs = _proofs(form, forms, evidence.by_itself, setting)
    labels = _labels_of(reduced, evidence, form, proofs, forms, consistent)
    own_integral = _own_integral(normals, proofs)
    integral, others = _integral_of(form, labels, own_integral, evidence, bool(consistent))
    of_pieces = _traits_of(pieces, reduced, setting)
    of_pieces += branches_of_time(reduced, bool(consistent), setting.positive)
    single = evidence.rows[0] if len(evidence.rows) == len(pieces) == 1 else None
    timed = timed_in_system(pieces[0], single.block, single.answer, others, setting) if single else None
    traits = traits_together(of_pieces, form, _of_every_form(labels, evidence.rows, normals), timed)
    implied = dependence.implied(reduced)
    sentences = [reason_of(form, labels, proofs, dependence.circuit, others), reason_of_time(traits)]
    sentences += dependence.sentences(implied, reduced.equations)
    claims = _claims(form, labels, traits, integral, evidence, bool(proofs) and all(p.proved for p in proofs))
    sure = weakest(*(c.verdict for c in claims.values()), *(t.answer.verdict for t in evidence.rows))
    return ConstraintEntry(
        name=constraint.name,
        type=constraint.type,
        text=constraint.text,
        form=form,
        holonomic=labels.in_system,
        holonomic_alone=labels.alone,
        scleronomic=traits.scleronomic,
        catastatic=traits.catastatic,
        bilateral=not reduced.inequalities,
        exact=traits.exact,
        integrating_factor=joined([p.factor for p in proofs]),
        integral=integral,
        circuit=dependence.circuit,
        equations=reduced.equations,
        independent=dependence.of(reduced.equations),
        redundant_equations=implied,
        verdict=weakest(sure, dependence.claim.verdict if dependence.redundant else "proved"),
        verdicts={name: FieldVerdict.of(claim) for name, claim in claims.items()},
        reason="".join(dict.fromkeys([*sentences, _scope(claims)])),
    )


def _traits_of(pieces: Sequence[Clause], reduced: Reduced, setting: Setting) -> list[Traits]:
    """Return the traits of the clauses of a constraint, except declared functions as factors (`declared_functions`)."""
    generic = declared_functions(reduced.normals)
    restricted = not all(is_always_satisfied(c, setting.positive) for c in reduced.domain())
    several = [n for n in reduced.normals if len(n.branches) > 1]
    outside = any(restricted or len(n.pieces) < sum(map(len, n.branches)) for n in several)  # a branch may be excluded
    traits = [
        Traits((True, "proved")) if _is_still(p) else traits_of(p, setting.positive, setting.engines)
        for p in pieces
        if p not in generic
    ]
    return [replace(t, timeless=(None, "undecided")) if outside and t.timeless[0] is False else t for t in traits]


def _is_still(piece: Clause) -> bool:
    """Return whether a clause is a geometric equation without time; unwritten joint equations are."""
    return isinstance(piece, JointEquation) or (isinstance(piece, Finite) and TIME not in piece.expr.symbols)


def _integrable_forms(normals: Sequence[Normal], rows: Sequence[LabelledRow]) -> list[Pfaffian]:
    """Return the forms whose integrability is tested, each once: of the branches of the same kind as those in ``rows``.

    The kind is (number of forms, whether there is a geometric equation): xdot^2 - 2 z xdot ydot + ydot^2 = 0 means
    xdot = ydot = 0 if abs(z) < 1, one form if abs(z) > 1. Without forms in ``rows``: kinds without equation, or all.
    """
    used = [t.row.piece for t in rows if isinstance(t.row.piece, Pfaffian)]
    chosen: list[Pfaffian] = []
    for n in normals:
        kinds = [(len(_forms([b])), any(isinstance(p, Finite) for p in b)) for b in n.branches]
        named = list(zip(kinds, n.branches, strict=True))
        equal = {kind for kind, b in named if any(f in used for f in _forms([b]))}
        wide = equal or {kind for kind in kinds if not kind[1]} or set(kinds)
        chosen += _forms([b for kind, b in zip(kinds, n.branches, strict=True) if kind in wide])
    return [f for k, f in enumerate(chosen) if f not in chosen[:k]]


def _forms(branches: Sequence[Sequence[Clause]]) -> list[Pfaffian]:
    return [p for b in branches for p in b if isinstance(p, Pfaffian)]


def _labels_of(
    reduced: Reduced,
    evidence: Evidence,
    form: Form,
    proofs: Sequence[Integrability],
    forms: Sequence[Pfaffian],
    consistent: bool | None,
) -> EntryLabels:
    """Return the labels of a constraint; in an inconsistent system, those on its own."""
    in_system, sure = label_in_system(evidence.rows, reduced.inequalities, proofs, forms)
    alone, sure_own = _alone(form, evidence.by_itself, proofs, forms, reduced.inequalities)
    if consistent is False and in_system is None:
        in_system, sure = alone, sure_own
    rows = evidence.rows
    undecided = [t.label.reason for t in rows if t.label and t.label.holonomic is None and t.label.reason]
    late = [why for t in rows if t.answer.late for why in t.answer.reasons]
    with_others = [t.label.reason for t in rows if t.label and t.label.holonomic is False and t.label.reason]
    sures = (sure, sure_own)
    first, reduced_by = (next(iter(texts), "") for texts in (late + undecided, with_others))
    return EntryLabels(in_system, alone, sures, first, bool(rows), reduced_by)


def _of_every_form(labels: EntryLabels, rows: Sequence[LabelledRow], normals: Sequence[Normal]) -> EntryLabels:
    """Return the labels, undecided in the system if it is not known that none of several forms is integrable.

    Contradictory branches (an equation between different numbers) do not count.
    """
    if labels.in_system is not False:
        return labels
    branches = [
        b for n in normals for b in n.branches if not any(isinstance(p, Finite) and p.expr.op == "num" for p in b)
    ]
    forms = [p for b in branches for p in b if isinstance(p, (Pfaffian, Nonlinear))]
    nonholonomic = [r for r in rows if r.label is not None and r.label.holonomic is False]
    every = len(forms) == 1 or len(forms) == len(nonholonomic)
    return labels if every else labels._replace(in_system=None)


def _claims(
    form: Form,
    labels: EntryLabels,
    traits: EntryTraits,
    integral: str | None,
    evidence: Evidence,
    on_their_own: bool,
) -> dict[str, Claim]:
    """Return the claim of every label; ``on_their_own``: all forms are proved to be integrable on their own.

    Claims about the system are about the points for which the answers of its blocks are valid.
    """
    ground = Ground(form, [t.answer for t in evidence.rows], [t.label for t in evidence.rows if t.label is not None])
    in_system, alone = labels.verdicts
    holonomy = {
        "holonomic": (labels.in_system, in_system),
        "holonomic_alone": (labels.alone, alone),
        **({} if integral is None else {"integral": (True, in_system)}),
    }
    claims = {}
    for name, (value, verdict) in holonomy.items():
        argument = ground.argument(value, on_their_own)
        claims[name] = OPEN if value is None else ground.claim(verdict, argument, name != "holonomic_alone")
    time = {"scleronomic": traits.scleronomic}
    time |= {"catastatic": traits.catastatic} if form in ("pfaffian", "nonlinear") else {}
    time |= {"exact": traits.exact} if form == "pfaffian" else {}
    for name, value in time.items():
        argument = "identity" if value else "zero with another derivative"
        claims[name] = OPEN if value is None else ground.claim(traits.verdicts[name], argument, False)
    if traits.by is not None and traits.scleronomic is not None:
        claims["scleronomic"] = ground.claim(traits.verdicts["scleronomic"], claims[traits.by].argument or "identity")
    dependence = evidence.dependence
    if dependence.independent is not None:
        all_needed = dependence.circuit is None and dependence.independent >= len(evidence.rows)
        claims["independent"] = claim_of_dependence(ground, dependence, all_needed)
    if dependence.circuit is not None:
        claims["circuit"] = claims.get("independent", OPEN)
    if dependence.open:
        claims["independent"] = OPEN
    elif dependence.seen:
        claims["independent"] = Claim("numeric", "leaving out", gap=GAP, about="reference")
    return claims


def _scope(claims: Mapping[str, Claim]) -> str:
    """Return the sentence about an integral that is valid on one component only, or an empty text."""
    return ON_COMPONENT if "integral" in claims and claims["integral"].about == "component" else ""


def _own_integral(normals: Sequence[Normal], proofs: Sequence[Integrability]) -> str | None:
    """Return the integrals of the forms on their own: joined by ";" with different constants, or by "or" for branches.

    None if an integral is missing, or if a branch has several forms.
    """
    branches = [len(_forms([b])) for n in normals for b in n.branches if len(n.branches) > 1]
    if len(proofs) < 2 or not branches:
        return joined([_numbered(p.integral, k if len(proofs) > 1 else 0) for k, p in enumerate(proofs, 1)])
    return joined([p.integral for p in proofs], " or ") if max(branches) == 1 and len(normals) == 1 else None


def _numbered(integral: str | None, number: int) -> str | None:
    """Return the integral `f = C` with the constant C1, C2, ...; unchanged for the number 0."""
    return f"{integral}{number}" if integral and number and integral.endswith("= C") else integral


def _integral_of(
    form: Form, labels: EntryLabels, own_integral: str | None, evidence: Evidence, consistent: bool
) -> tuple[str | None, Others]:
    """Return (the geometric equation that a constraint integrates to or None, its companions)."""
    others = Others()
    if form == "pfaffian" and labels.in_system is not None and consistent and not (labels.alone and own_integral):
        others = evidence.companions_of(labels.in_system)
    if labels.alone and own_integral is not None:
        return own_integral, Others(integral=own_integral)
    return others.integral if labels.alone or labels.in_system else None, others


def _proofs(form: Form, forms: Sequence[Pfaffian], by_itself: Answer | None, setting: Setting) -> list[Integrability]:
    """Return the integrability of each form on its own; none for other constraints."""
    if form != "pfaffian" or by_itself is None:
        return []
    if setting.engines != BOTH:
        return [Integrability(False) for _ in forms]
    labels = [label.holonomic for label in by_itself.labels.values()]
    single = labels[0] if len(labels) == 1 else None
    return [proved_integrability(f, setting, single) for f in forms]


def label_in_system(
    rows: Sequence[LabelledRow],
    inequalities: Sequence[Clause],
    proofs: Sequence[Integrability],
    forms: Sequence[Pfaffian],
) -> TraitAnswer:
    """Return (whether a constraint is holonomic in the system, verdict); inequalities are not.

    ``proofs``: the integrability of each of the ``forms`` on its own.
    """
    if inequalities:
        return False, "proved"
    integrable = [f for f, p in zip(forms, proofs, strict=False) if p.proved]
    return all_of([_label_of_row(t, integrable) for t in rows])


def _label_of_row(t: LabelledRow, integrable: Sequence[Pfaffian]) -> TraitAnswer:
    """Return (whether a row is holonomic in the system, verdict)."""
    if isinstance(t.row.piece, Finite) or t.row.piece in integrable:
        return True, "proved"
    if isinstance(t.row.piece, Nonlinear) and not t.reduced:
        line = t.answer.dof == 0 and not t.answer.curved
        return (False, "proved") if t.answer.curved else (True, t.answer.verdict) if line else (None, "undecided")
    return (None, "undecided") if t.label is None else (t.label.holonomic, t.label.verdict)


def _alone(
    form: Form,
    by_itself: Answer | None,
    proofs: Sequence[Integrability],
    forms: Sequence[Pfaffian],
    inequalities: Sequence[Clause],
) -> TraitAnswer:
    """Return (whether a constraint is holonomic on its own, verdict)."""
    if inequalities:
        return False, "proved"
    if form == "nonlinear":
        curved = by_itself is not None and by_itself.curved
        return (False, "proved") if curved else (None, "undecided")
    if by_itself is None or (forms and all(p.proved for p in proofs)):
        return True, "proved"
    labels = by_itself.labels.values() if by_itself.consistent else ()
    return all_of([(label.holonomic, label.verdict) for label in labels]) if labels else (None, "undecided")
