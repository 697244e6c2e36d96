"""The report of one method on its own: answers that the method's argument proves are fields, all others warnings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dofkit.base.deadline import OutOfTimeError
from dofkit.base.errors import PoleError
from dofkit.base.verdicts import OPEN, About, Claim, Verdict, weakest
from dofkit.base.wording import many
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.freedom.preparation import all_of
from dofkit.classification.undecided import sketch
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.methods.table import MethodName, Question, Reply, function_of, methods
from dofkit.relations.answer import BITS, GAP, Answer
from dofkit.relations.blocks import Block
from dofkit.report import ConstraintEntry, FieldVerdict, Report
from dofkit.system import Constraint, System

#: The questions that a report answers, with their names in a warning.
ASKED: Mapping[Question, str] = {
    "dof": "the number of degrees of freedom",
    "integrability": "which constraints are holonomic",
    "redundancy": "which constraints are redundant",
}
UNDECIDED = " Whether it is implied by the others is undecided."
FINITE = "It relates coordinates (and possibly time) only, so it is holonomic."
UNILATERAL = "It is an inequality (a unilateral constraint), so it is not holonomic."
PROVED = "It is holonomic by this method's own argument."


def report_of_method(system: System, method: MethodName) -> Report:
    """Return the report of a method that is not an engine of dofkit. Raises OutOfTimeError."""
    base = sketch(system, f"{method} on its own does not decide")
    replies = {question: _reply(system, method, question) for question in ASKED if question in methods()[method].uses}
    dof, redundancy, labels = (replies.get(q, Reply(None)) for q in ("dof", "redundancy", "integrability"))
    fields: dict[str, Any] = {}
    if dof.verdict != "undecided":
        fields |= {"consistent": True, "dof": dof.value}
    if redundancy.verdict != "undecided":
        fields |= {"redundant": redundancy.value}
    names = [c.name for c in system.constraints]
    holonomic = {n for n in names if labels.verdict != "undecided" and (labels.value or {}).get(n)}
    entries = [
        _entry(c, e, labels.verdict if c.name in holonomic else None, methods()[method].best)
        for c, e in zip(system.constraints, base.constraints, strict=True)
    ]
    labels_of_system = {name: all_of(getattr(e, name) for e in entries) for name in ("holonomic", "scleronomic")}
    about: About = "everywhere" if system.reference is None else "reference"
    verdicts = {
        **base.verdicts,
        **{name: _verdict(redundancy.verdict if name == "redundant" else dof.verdict, about) for name in fields},
        **{name: _of_entries(name, value, entries) for name, value in labels_of_system.items()},
    }
    changes = {
        "constraints": entries,
        "verdict": weakest(*(e.verdict for e in entries), dof.verdict),
        "method": f"{method} alone: {methods()[method].cannot}",
        "modelled": "the equations as they are written",
        "warnings": [*system.warnings, *(w for q, r in replies.items() if (w := _warning(method, q, r)))],
        "verdicts": verdicts,
    }
    return base.model_copy(update={**changes, **fields, **labels_of_system})


def _reply(system: System, method: MethodName, question: Question) -> Reply:
    """Return the method's reply, without a value if the method fails."""
    try:
        reply: Reply = function_of(method, question)(system)
    except OutOfTimeError:
        raise
    except (ArithmeticError, NotImplementedError, ValueError) as error:
        return Reply(None, reason=str(error) or type(error).__name__)
    return reply


def _warning(method: MethodName, question: Question, reply: Reply) -> str:
    """Return a sentence about an undecided reply, or an empty text for a decided one."""
    if reply.verdict != "undecided":
        return ""
    if reply.value is None:
        return f"{method} on its own does not answer {ASKED[question]}: {reply.reason}."
    sound = methods()[method].uses[question].sound
    return f"{method} on its own gives {_in_words(question, reply.value)}; it is sound only for: {sound}."


def _in_words(question: Question, value: Any) -> str:
    if question == "dof":
        return "a contradiction" if value < 0 else f"{many(value, 'degree')} of freedom"
    if question == "redundancy":
        return f"as redundant: {', '.join(value) or 'nothing'}"
    return f"as non-holonomic: {', '.join(n for n, holonomic in value.items() if not holonomic) or 'nothing'}"


def _verdict(verdict: Verdict, about: About = "everywhere") -> FieldVerdict:
    return FieldVerdict.of(OPEN if verdict == "undecided" else Claim(verdict, "one method alone", BITS, GAP, about))


def _of_entries(name: str, value: bool | None, entries: list[ConstraintEntry]) -> FieldVerdict:
    """Return the verdict of the system's label ``name``: the weakest verdict of the entries with the same value."""
    if value is None:
        return _verdict("undecided")
    return _verdict(weakest(*(e.verdicts[name].verdict for e in entries if getattr(e, name) is value)))


def _entry(constraint: Constraint, entry: ConstraintEntry, holonomic: Verdict | None, best: Verdict) -> ConstraintEntry:
    """Return a constraint's entry with its labels; ``holonomic``: the method's verdict that it is, or None."""
    label, reason, sure = None, entry.reason, holonomic or "proved"
    if entry.form == "finite":
        label, reason, sure = True, FINITE, "proved"
    elif entry.form == "inequality":
        label, reason, sure = False, UNILATERAL, "proved"
    elif holonomic is not None:
        label, reason = True, PROVED
    scleronomic = True if without_time(constraint) else None
    decided = label is not None and scleronomic and not entry.bilateral
    verdicts = {
        "holonomic": _verdict("undecided" if label is None else sure),
        "holonomic_alone": _verdict("undecided" if label is None else sure),
        "scleronomic": _verdict("proved" if scleronomic else "undecided"),
    }
    return entry.model_copy(
        update={
            "verdicts": verdicts,
            "holonomic": label,
            "holonomic_alone": label,
            "scleronomic": scleronomic,
            "verdict": weakest(best, sure) if decided else "undecided",
            "reason": reason + (UNDECIDED if label is not None and entry.bilateral else ""),
        }
    )


def without_time(constraint: Constraint) -> bool:
    """Return whether neither t nor dt occurs; a term without velocities among others with them contains dt."""
    return all(_without_time(r.expr) for r in constraint.relations)


def _without_time(e: Expr) -> bool:
    kinds = {s.args[0] for s in e.symbols}
    if kinds & {"time", "dt"}:
        return False
    moving = [s for s in e.symbols if s.args[0] in ("velocity", "differential")]
    try:
        return not moving or substitute(e, dict.fromkeys(moving, ex.ZERO)).is_zero
    except PoleError:
        return False


def report_of_engine(report: Report, outcome: Outcome, method: MethodName) -> Report:
    """Return the report of one engine on its own: no verdict is stronger than the best of this method."""
    row = methods()[method]
    entries = [e.model_copy(update={"verdict": weakest(e.verdict, row.best)}) for e in report.constraints]
    changes: dict[str, Any] = {
        "constraints": entries,
        "verdict": weakest(report.verdict, row.best),
        "method": f"{method} alone ({report.method}): {row.cannot}",
    }
    real = all(_is_surely_real(b, a) for b, a in zip(outcome.blocks, outcome.answers, strict=True))
    if method == "field" and report.consistent and not real:
        changes["consistent"] = None
    return report.model_copy(update=changes)


def _is_surely_real(block: Block, a: Answer) -> bool:
    """Return whether a real configuration certainly exists: there is no equation to satisfy, or one was supplied."""
    return a.instantaneous is not None or not (block.finite or block.nonlinear or a.hidden)
