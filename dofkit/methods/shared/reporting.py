"""The report of one method that is no engine of dofkit's own: what it is sound for, and its other numbers as warnings.

What a method would answer without being sound for it stands nowhere but in a warning, with the assumption behind it.
"""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.base.deadline import OutOfTimeError
from dofkit.base.errors import PoleError
from dofkit.base.verdicts import OPEN as OPEN_CLAIM
from dofkit.base.verdicts import VERDICTS, About, Claim, Verdict, weakest
from dofkit.classification.undecided import sketch
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.methods.names import MethodName
from dofkit.methods.shared.reply import MethodFindings, MethodLabel
from dofkit.methods.shared.row import Method
from dofkit.relations.answer import BITS, GAP
from dofkit.report import ConstraintEntry, FieldVerdict, Report
from dofkit.system import Constraint, System

#: What a method may end with where a scene is not what it is for.
FAILURES = (ArithmeticError, OutOfTimeError, NotImplementedError, ValueError)
OPEN = " Whether it is implied by the others is undecided."
NONLINEAR = "It is nonlinear in the velocities as written; over the reals it may be equivalent to a simpler equation."
FINITE = "It relates coordinates (and possibly time) only, so it is holonomic."
UNILATERAL = "It is an inequality (a unilateral constraint), so it is not holonomic."


def report_alone(system: System, method: MethodName, row: Method) -> Report:
    """The report of a method by itself, which is a row of the table."""
    base = sketch(system, f"{method} on its own does not decide")
    try:
        found = row.findings(system)
    except OutOfTimeError:
        raise
    except FAILURES as error:
        found = MethodFindings({}, {}, [f"{method} on its own gave no answer: {str(error) or type(error).__name__}."])
    pairs = zip(system.constraints, base.constraints, strict=True)
    entries = [_entry(c, e, found, found.labels.get(i), row.best) for i, (c, e) in enumerate(pairs)]
    whole = {name: _all([getattr(e, name) for e in entries]) for name in ("holonomic", "scleronomic")}
    told = {
        "constraints": entries,
        **whole,
        "verdict": weakest(*(e.verdict for e in entries), found.verdict if "dof" in found.fields else "undecided"),
        "method": f"{method} alone: {row.cannot}",
        "modelled": "the equations as they are written",
        "warnings": [*system.warnings, *found.warnings],
    }
    fields = {name: _told(found.verdict, system) for name, value in found.fields.items() if value is not None}
    labels = {name: _of_entries(name, value, entries) for name, value in whole.items()}
    return base.model_copy(update={**told, **found.fields, "verdicts": {**base.verdicts, **fields, **labels}})


def _told(verdict: Verdict, system: System) -> FieldVerdict:
    """What a method tells of one field, at the reference where there is one."""
    about: About = "everywhere" if system.reference is None else "reference"
    open_ = verdict == "undecided"
    return FieldVerdict.of(OPEN_CLAIM if open_ else Claim(verdict, "one method alone", BITS, GAP, about))


def _of_entries(name: str, value: bool | None, entries: Sequence[ConstraintEntry]) -> FieldVerdict:
    """What is told of a label of the whole: the weakest where it is true, the surest that is not where it is false."""
    own = [e.verdicts[name] for e in entries if value or getattr(e, name) is False]
    if value is None:
        return FieldVerdict.of(OPEN_CLAIM)
    choose = max if value else min
    return choose(own, key=lambda v: VERDICTS.index(v.verdict), default=FieldVerdict.of(Claim("proved", "as written")))


def _all(labels: Sequence[bool | None]) -> bool | None:
    return False if False in labels else None if None in labels else True


def _entry(
    constraint: Constraint, entry: ConstraintEntry, found: MethodFindings, label: MethodLabel | None, best: Verdict
) -> ConstraintEntry:
    """An entry with what stands in the text itself, and what the method tells."""
    if label is None:
        label = MethodLabel(None, entry.reason, "undecided")
        if entry.form == "finite":
            label = MethodLabel(True, FINITE, alone=True)
        elif entry.form == "inequality":
            label = MethodLabel(False, UNILATERAL, alone=False)
        elif entry.form == "nonlinear":
            label = MethodLabel(None, f"{NONLINEAR} {entry.reason}", "undecided")
    still = True if without_time(constraint) else None
    known = found.independent and entry.bilateral
    told = [label.holonomic, still, *([True] if known or not entry.bilateral else [None])]
    sure = weakest(best, label.verdict, found.verdict if known else "proved")
    verdicts = {
        "holonomic": _label_told(label.holonomic, label.verdict),
        "holonomic_alone": _label_told(label.alone, label.verdict),
        "scleronomic": _label_told(still, "proved"),
        **({"independent": _label_told(True, sure)} if known else {}),
    }
    return entry.model_copy(
        update={
            "verdicts": verdicts,
            "holonomic": label.holonomic,
            "holonomic_alone": label.alone,
            "scleronomic": still,
            "exact": label.exact,
            "independent": entry.equations if known else None,
            "redundant_equations": [] if known else None,
            "verdict": "undecided" if None in told else sure,
            "reason": label.reason + (OPEN if label.holonomic is not None and entry.bilateral and not known else ""),
        }
    )


def _label_told(value: bool | None, verdict: Verdict) -> FieldVerdict:
    sure = verdict if value is not None else "undecided"
    return FieldVerdict.of(OPEN_CLAIM if sure == "undecided" else Claim(sure, "one method alone", BITS, GAP))


def without_time(constraint: Constraint) -> bool:
    """Does neither t nor dt occur, so that it is scleronomic? ``dt`` may be hidden: where not all terms hold rates."""
    return all(_without_time(r.expr) for r in constraint.relations)


def _without_time(e: Expr) -> bool:
    kinds = {s.args[0] for s in e.symbols}
    if "time" in kinds or "dt" in kinds:
        return False
    moving = [s for s in e.symbols if s.args[0] in ("velocity", "differential")]
    if "acceleration" in kinds:
        return False
    try:
        return not moving or substitute(e, dict.fromkeys(moving, ex.ZERO)).is_zero
    except PoleError:
        return False
