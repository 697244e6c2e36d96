"""One constraint's entry in the report: its labels, how sure they are, and sentences for a student."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from dofkit.base.verdicts import VERDICTS, Verdict, weakest
from dofkit.classification.labels.reasons import Labels, Others, joined, reason_of
from dofkit.exact.engines import BOTH
from dofkit.expressions import tree as ex
from dofkit.expressions.tree import Expr
from dofkit.integrability.single_form import Integrability, integrability
from dofkit.integrability.traits import Traits
from dofkit.relations.answer import Answer, HolonomyLabel
from dofkit.relations.blocks import Block, Row
from dofkit.relations.normal.normal_form import (
    Finite,
    Inequality,
    Nonlinear,
    Normal,
    Pfaffian,
    Piece,
    Still,
    with_constants,
)
from dofkit.relations.setting import Setting
from dofkit.report import FORMS, ConstraintEntry, Form
from dofkit.system import Constraint


@dataclass(frozen=True)
class LabelledRow:
    """A row, its label in the system (None: finite or nonlinear), and its block's answer.

    ``reduced``: a nonlinear row that the others make linear, or imply.
    """

    row: Row
    label: HolonomyLabel | None
    answer: Answer
    block: Block | None = None
    reduced: bool = False


def form_of(piece: Piece) -> Form:
    """The report's word for a piece."""
    if isinstance(piece, Finite):
        return "finite"
    if isinstance(piece, Pfaffian):
        return "pfaffian"
    return "nonlinear" if isinstance(piece, Nonlinear) else "inequality"


def entry(
    constraint: Constraint,
    normals: Sequence[Normal],
    inequalities: Sequence[Inequality],
    told: Sequence[LabelledRow],
    by_itself: Answer | None,
    setting: Setting,
    independent: int | None,
    circuit: list[str] | None,
    consistent: bool | None,
    constants: Mapping[str, Expr],
    told_of: Callable[[Piece], Traits],
    with_others: Callable[[bool], Others],
) -> ConstraintEntry:
    """Everything that is told of one constraint.

    ``constants`` of integration that the system fixes have values; ``told_of`` gives the labels that a piece carries
    by itself, ``with_others`` what the other constraints do for a form that is holonomic in the system, or is not.
    """
    pieces: list[Piece] = [p for normal in normals for p in normal.pieces] + list(inequalities)
    form: Form = max((form_of(p) for p in pieces), key=FORMS.index, default="finite")
    forms = [p for p in pieces if isinstance(p, Pfaffian)]
    own_constants = {c: constants.get(c, ex.parameter(c)) for normal in normals for c in normal.constants}
    shown = [with_constants(p, own_constants) for p in pieces]
    proofs = _proofs(form, [p for p in shown if isinstance(p, Pfaffian)], by_itself, setting)
    traits = [told_of(p) for p in shown]
    times = [t.scleronomic for t in traits]
    in_system, sure = label_in_system(told, inequalities, proofs, forms)
    own, sure_own = _alone(form, by_itself, proofs, forms, inequalities)
    if consistent is False and in_system is None:
        in_system, sure = own, sure_own
    still = [t.catastatic for t in traits if t.catastatic is not None and form == "pfaffian"]
    closed = [t.exact for t in traits if t.exact is not None and form == "pfaffian"]
    equations = len(normals)
    integral = joined([p.integral for p in proofs])
    others = Others()
    if form == "pfaffian" and in_system is not None and consistent and not (own and integral):
        others = with_others(in_system)
    if own and integral is None:
        integral = others.integral
    verdict = weakest(sure, sure_own, *(v for _, v in (*times, *still, *closed)), *(t.answer.verdict for t in told))
    return ConstraintEntry(
        name=constraint.name,
        type=constraint.type,
        text=constraint.text,
        form=form,
        holonomic=in_system,
        holonomic_alone=own,
        scleronomic=_together([t for t, _ in times]),
        catastatic=_together([c for c, _ in still]) if form == "pfaffian" else None,
        bilateral=not inequalities,
        exact=_together([c for c, _ in closed]) if form == "pfaffian" else None,
        integrating_factor=joined([p.factor for p in proofs]),
        integral=integral if own else others.integral if in_system else None,
        circuit=circuit,
        equations=equations,
        independent=None if independent is None else min(independent, equations),
        verdict=verdict,
        reason=_once(normals) + reason_of(form, _labels(in_system, own, told), proofs, circuit, others),
    )


def _once(normals: Sequence[Normal]) -> str:
    """What was integrated once before anything else was asked, as sentences."""
    return "".join(f"{n.once[:1].upper()}{n.once[1:]}. " for n in normals if n.once)


def unfinished(
    constraint: Constraint, normals: Sequence[Normal], inequalities: Sequence[Inequality], why: str
) -> ConstraintEntry:
    """An entry without labels: there was no time for them."""
    pieces: list[Piece] = [p for normal in normals for p in normal.pieces] + list(inequalities)
    return ConstraintEntry(
        name=constraint.name,
        type=constraint.type,
        text=constraint.text,
        form=max((form_of(p) for p in pieces), key=FORMS.index, default="finite"),
        holonomic=None,
        holonomic_alone=None,
        scleronomic=None,
        catastatic=None,
        bilateral=not inequalities,
        exact=None,
        integrating_factor=None,
        integral=None,
        circuit=None,
        equations=len(normals),
        independent=None,
        verdict="undecided",
        reason=f"Not decided: {why}.",
    )


def _proofs(form: Form, forms: Sequence[Pfaffian], by_itself: Answer | None, setting: Setting) -> list[Integrability]:
    if form != "pfaffian" or by_itself is None:
        return []
    if setting.engines != BOTH:
        return [Integrability(False) for _ in forms]
    labels = [label.holonomic for label in by_itself.labels.values()]
    single = labels[0] if len(labels) == 1 else None
    return [integrability(f, setting.positive, single) for f in forms]


def _together(labels: Sequence[bool | None]) -> bool | None:
    if any(label is False for label in labels):
        return False
    return None if any(label is None for label in labels) else True


def _labels(in_system: bool | None, own: bool | None, told: Sequence[LabelledRow]) -> Labels:
    undecided = [t.label.reason for t in told if t.label and t.label.holonomic is None and t.label.reason]
    late = [why for t in told if t.answer.late for why in t.answer.reasons]
    reduced = (t.label.reason for t in told if t.reduced and t.label and t.label.holonomic is False)
    return Labels(in_system, own, next(iter(late + undecided), ""), bool(told), next(reduced, ""))


def label_in_system(
    told: Sequence[LabelledRow],
    inequalities: Sequence[Inequality],
    proofs: Sequence[Integrability],
    forms: Sequence[Pfaffian],
) -> tuple[bool | None, Verdict]:
    """(holonomic, verdict): all rows are consequences of finite relations; an inequality never is."""
    if inequalities:
        return False, "proved"
    proved = {id(f) for f, p in zip(forms, proofs, strict=False) if p.proved}
    labels: list[bool | None] = []
    verdicts: list[Verdict] = []
    for t in told:
        if isinstance(t.row.piece, (Finite, Still)) or id(t.row.piece) in proved:
            labels.append(True)
        elif isinstance(t.row.piece, Nonlinear) and not t.reduced:
            labels.append(False if t.answer.curved else None)
            verdicts.append("proved" if t.answer.curved else "undecided")
        elif t.label is None:
            labels.append(None)
            verdicts.append("undecided")
        else:
            labels.append(t.label.holonomic)
            verdicts.append(t.label.verdict)
    together = _together(labels)
    if together is False:
        return False, _strongest(told, proved)
    return together, weakest(*verdicts)


def _strongest(told: Sequence[LabelledRow], proved: set[int]) -> Verdict:
    """How sure the surest row is that it is not holonomic."""
    found: list[Verdict] = []
    for t in told:
        if isinstance(t.row.piece, Nonlinear) and t.answer.curved:
            found.append("proved")
        elif t.label is not None and t.label.holonomic is False and id(t.row.piece) not in proved:
            found.append(t.label.verdict)
    return min(found, key=VERDICTS.index, default="proved")


def _alone(
    form: Form,
    by_itself: Answer | None,
    proofs: Sequence[Integrability],
    forms: Sequence[Pfaffian],
    inequalities: Sequence[Inequality],
) -> tuple[bool | None, Verdict]:
    if inequalities:
        return False, "proved"
    if form == "nonlinear":
        curved = by_itself is not None and by_itself.curved
        return (False, "proved") if curved else (None, "undecided")
    if by_itself is None or (forms and all(p.proved for p in proofs)):
        return True, "proved"
    labels = list(by_itself.labels.values())
    if by_itself.consistent is not True or not labels:
        return None, "undecided"
    together = _together([label.holonomic for label in labels])
    if together is False:
        return False, min((x.verdict for x in labels if x.holonomic is False), key=VERDICTS.index, default="proved")
    return together, weakest(*(x.verdict for x in labels))
