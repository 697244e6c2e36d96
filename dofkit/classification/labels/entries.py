"""The report's entries, one for each constraint, from the blocks' answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import replace
from functools import partial

from dofkit.base.deadline import OutOfTimeError, check
from dofkit.base.verdicts import Claim, Verdict, together, weakest
from dofkit.classification.freedom.branches import AnsweredBlocks, Outcome, solve
from dofkit.classification.labels.companions import Companionship
from dofkit.classification.labels.entry import Evidence, LabelledRow, entry, label_in_system
from dofkit.classification.labels.reasons import EntryDependence, Others
from dofkit.classification.undecided import open_entry
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.expressions.text import to_text
from dofkit.integrability.rewritten_rows import label_modulo_others
from dofkit.relations.answer import IDENTITY, Answer, HolonomyLabel, Redundancies
from dofkit.relations.blocks import Block, Row, coordinates_of, depends_on_time
from dofkit.relations.normal.pieces import Nonlinear, Normal, Pfaffian, Reduced, piece_shape
from dofkit.relations.setting import Setting
from dofkit.report import ConstraintEntry, IntegrablePart

#: Sentences about undecided dependence.
OPEN = "Whether it is implied by the others was not decided."
UNCOUNTED = "The number of its equations that are independent of the preceding ones was not decided."


def entries_of(
    reduced: Sequence[Reduced],
    setting: Setting,
    outcome: Outcome,
    dependent: Sequence[Redundancies],
    company: Companionship,
) -> list[ConstraintEntry]:
    """Return the entries of all constraints, in order; undecided ones after time has run out.

    ``company`` finds what differential constraints integrate to together with others.
    """
    labelled = _labelled_rows(len(reduced), outcome, setting)
    dependences = _dependences([r.constraint.name for r in reduced], dependent, outcome, labelled)
    entries, by_kind = list[ConstraintEntry](), dict[Hashable, ConstraintEntry]()
    for i, (r, dependence) in enumerate(zip(reduced, dependences, strict=True)):
        try:
            check()
            likeness = None if dependence.has_dependence else _likeness(r, labelled[i], setting)
            kind = None if likeness is None else (likeness, dependence)
            like = by_kind.get(kind)
            if like is not None:
                entries.append(like.model_copy(update={"name": r.constraint.name, "text": r.constraint.text}))
                continue
            companions_of = partial(_with_others, i, labelled[i], company)
            alone = by_itself(r, labelled[i], company.answered)
            evidence = Evidence(labelled[i], alone, dependence, companions_of)
            entries.append(entry(r, evidence, setting, outcome.consistent))
            if kind is not None and _is_nameless(entries[-1]):
                by_kind[kind] = entries[-1]
        except OutOfTimeError as error:
            entries.append(open_entry(r.constraint, str(error)))
    return entries


def _likeness(r: Reduced, rows: Sequence[LabelledRow], setting: Setting) -> Hashable:
    """Return a key that is equal only for constraints whose entries differ just in name and text; None if not clear.

    For geometric equations without time their number and answers are enough, forms are compared up to names.
    """
    pieces = [*(p for n in r.normals for p in n.pieces), *(t.row.piece for t in rows)]
    branched = any(len(n.branches) > 1 for n in r.normals)
    modulo_others = any(t.reduced or (t.label is not None and t.label.modulo) for t in rows)
    clauses = (*pieces, *r.inequalities)
    if branched or modulo_others or any(isinstance(p, Nonlinear) or depends_on_time(p) for p in clauses):
        return None
    shapes: list[Hashable] = [type(p).__name__ for p in clauses]
    if any(isinstance(p, Pfaffian) for p in pieces):
        places: dict[str, int] = {}
        for p in pieces:
            shape = piece_shape(p)
            names = [n if n[0] == "_" or n in setting.tilts else places.setdefault(n, len(places)) for n in shape.names]
            shapes.append((shape.key, *names))
    answers = [t.answer for t in rows]
    return (
        r.constraint.type,
        tuple([n.notes for n in r.normals]),
        r.equations,
        tuple(shapes),
        tuple([t.label for t in rows]),
        tuple([(a.verdict, a.argument, a.bits, a.gap, a.about, a.late, a.consistent) for a in answers]),
    )


def _is_nameless(entry: ConstraintEntry) -> bool:
    """Return whether an entry is decided, and none of its texts contains a coordinate."""
    decided = None not in (entry.holonomic, entry.holonomic_alone, entry.scleronomic)
    plain = entry.form in ("finite", "inequality") or (entry.form == "pfaffian" and entry.holonomic is False)
    return decided and plain and entry.integral is None and entry.integrating_factor is None


def _dependences(
    names: Sequence[str], dependent: Sequence[Redundancies], outcome: Outcome, labelled: Sequence[Sequence[LabelledRow]]
) -> Iterator[EntryDependence]:
    """Yield the dependence of each constraint, collected from the results ``dependent``."""
    independent: Counter[int] = Counter()
    implied: dict[int, frozenset[int]] = {}
    for result in dependent:
        independent.update(result.independent)
        implied |= {i: implied.get(i, frozenset()).union(more) for i, more in result.equations.items()}
    uncounted = {i for result in dependent for i in result.uncounted}
    unmeasured = {r.constraint for block, a in outcome.answered_parts if a.velocity_dof is None for r in block.rows}
    counted = independent.keys() - unmeasured - uncounted
    circuits = {i: c for result in dependent for i, c in result.circuits.items() if all(j < i for j in c)}
    redundant = {i for result in dependent for i in result.redundant}
    undecided = dict.fromkeys(uncounted, UNCOUNTED) | {i: OPEN for result in dependent for i in result.undecided}
    seen = {i for result in dependent for i in result.seen}
    claims: dict[int, list[Claim]] = {}
    for result in dependent:
        for i in () if result.claim == IDENTITY else {*result.independent, *result.undecided, *result.redundant}:
            claims.setdefault(i, []).append(result.claim)
    unknown = None if outcome.consistent is False else 0
    for i, rows in enumerate(labelled):
        number = independent[i] if i in counted else None if rows else unknown
        circuit = [names[j] for j in circuits[i]] if i in circuits else None
        claim = together(*claims[i]) if i in claims else IDENTITY
        sentence = undecided.get(i, "")
        yield EntryDependence(number, circuit, i in redundant, sentence, implied.get(i), i in seen, claim)


def labels_in_system(
    reduced: Sequence[Reduced], setting: Setting, outcome: Outcome
) -> list[tuple[bool | None, Verdict]]:
    """Return, for each constraint, (whether it is holonomic in the system, verdict), without searching integrals."""
    labelled = _labelled_rows(len(reduced), outcome, setting)
    if not outcome.consistent:
        return [(None, "undecided")] * len(reduced)
    return [label_in_system(rows, r.inequalities, (), ()) for rows, r in zip(labelled, reduced, strict=True)]


def _with_others(i: int, rows: Sequence[LabelledRow], company: Companionship, in_system: bool) -> Others:
    """Return the companions of a form in its block; empty if its rows are in several blocks or not integrable."""
    blocks = {id(t.block): t for t in rows if t.block is not None}
    only = next(iter(blocks.values())) if len(blocks) == 1 else None
    if only is None or only.block is None or not (in_system or any(t.label and t.label.modulo for t in rows)):
        return Others()
    return (company.of if in_system else company.modulo)(i, only.block, only.answer)


def _labelled_rows(number: int, outcome: Outcome, setting: Setting) -> list[list[LabelledRow]]:
    """Return every constraint's rows with their labels; a copy has those of its original.

    Rows that the other constraints reduce are labelled as they were written.
    """
    labelled: list[list[LabelledRow]] = [[] for _ in range(number)]
    replaced = {id(row) for slot in outcome.reduced for row in slot.rows}
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        linear = [r for r in block.rows if not isinstance(r.piece, Nonlinear)]
        for i, row in enumerate(linear):
            if id(row) not in replaced:
                labelled[row.constraint].append(LabelledRow(row, a.labels.get(i), a, block))
        for row in block.rows:
            if isinstance(row.piece, Nonlinear):
                labelled[row.constraint].append(LabelledRow(row, None, a, block))
    for slot in outcome.reduced:
        result, a = label_modulo_others(slot, outcome.blocks, outcome.answers, setting)
        labelled[slot.written.constraint].append(LabelledRow(slot.written, result, a, reduced=True))
    for i, original in outcome.copies.items():
        labelled[i] = [t._replace(row=Row(i, t.row.piece)) for t in labelled[original]]
    return labelled


def by_itself(r: Reduced, labelled: Sequence[LabelledRow], answered: AnsweredBlocks) -> Answer | None:
    """Return the answer of a constraint as a system of its own; None if its largest branch is finite.

    ``labelled``: its rows in the system, whose labels are used if they do not depend on the other constraints.
    """
    pieces = {type(p) for n in r.normals for p in n.pieces}
    if pieces.isdisjoint({Pfaffian, Nonlinear}):
        return None
    if Nonlinear in pieces:
        curved = next((t.answer for t in labelled if isinstance(t.row.piece, Nonlinear) and t.answer.curved), None)
        if curved is not None:
            return curved
    elif not any(isinstance(t.row.piece, Pfaffian) for t in labelled) and all(len(n.branches) < 2 for n in r.normals):
        return None
    label = labelled[0].label if Nonlinear not in pieces and len(labelled) == 1 else None
    sure = label is not None and label.holonomic is False and label.verdict == "proved"
    match r.normals:
        case (Normal(branches=((Pfaffian() as form,),)),) if labelled and not sure and answered.is_curved(form):
            label = HolonomyLabel(False, "proved")
    if label is not None and label.holonomic is False:
        return Answer(labels={0: label})
    mentioned = {name for n in r.normals for b in n.branches for p in b for name in coordinates_of(p)}
    setting = replace(answered.setting, roles=tuple(c for c in answered.setting.roles if c.name in mentioned))
    try:
        alone = solve([r], setting, answered)
    except (OutOfTimeError, ArithmeticError):
        return Answer(None, verdict="undecided")
    if not any(isinstance(row.piece, Pfaffian | Nonlinear) for row in alone.rows):
        return None if alone.consistent is not None else Answer(None, verdict="undecided")
    labels_alone = [label for a in alone.answers for label in a.labels.values()]
    return Answer(
        alone.consistent,
        verdict=weakest(*(a.verdict for a in alone.answers)),
        labels=dict(enumerate(labels_alone)),
        curved=any(a.curved for a in alone.answers),
    )


def integrable_part(
    outcome: Outcome, entries: Sequence[ConstraintEntry], company: Companionship
) -> IntegrablePart | None:
    """Return the geometric equations implied by the constraints; None if there are no forms, or it is undecided.

    ``rank`` is that of I^(inf), the last system of the derived flag, over all coordinates; ``basis``: hidden equations
    and independent integrals that complete the geometric equations of the scene, None if too few are known.
    """
    blocks = [(b, a) for b, a in zip(outcome.blocks, outcome.answers, strict=True) if b.forms]
    if not blocks or outcome.dof is None:
        return None
    coordinates = len(outcome.untouched) + sum(len(b.coordinates) for b in outcome.blocks)
    basis: list[str] | None = []
    for block, a in blocks:
        number_finite = len(block.finite) + len(a.hidden)
        finite = rank_of_rows(a.matrix[:number_finite], a.modulus) if a.matrix else number_finite
        remaining = len(block.coordinates) - (a.dof or 0) - finite
        result = _integrals(block, a, remaining, entries, company) if remaining > 0 else []
        if result is None or basis is None:
            basis = None
        else:
            basis += [f"{to_text(g)} = 0" for g in a.hidden] + result
    return IntegrablePart(rank=coordinates - outcome.dof, basis=basis)


def _integrals(
    block: Block, a: Answer, number: int, entries: Sequence[ConstraintEntry], company: Companionship
) -> list[str] | None:
    """Return ``number`` independent integrals of a block, as text; None if fewer are known."""
    owners = {r.constraint for r in block.rows if isinstance(r.piece, Pfaffian)}
    alone = [entries[i].integral for i in owners]
    if number == len(alone) == 1 and alone[0] is not None:
        return [alone[0]]
    result = company.basis(block, a)
    return result if len(result) == number else None
