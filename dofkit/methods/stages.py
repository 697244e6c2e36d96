"""A scene classified in stages: first a report in which everything is undecided, then the finished one.

`supervised` does the same in a process that can be killed.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from typing import Any

from dofkit.base.deadline import OUT_OF_TIME, OutOfTimeError, gc_rarely, limited
from dofkit.base.errors import PoleError
from dofkit.base.verdicts import OPEN, About, Claim, Verdict, weakest
from dofkit.base.wording import many
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.passes import PASSES, PLAIN, examined
from dofkit.classification.undecided import open_entry, open_report, sketch, why_nothing
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.methods.table import ENGINES, MethodName, Question, Reply, function_of, methods
from dofkit.relations.answer import BITS, GAP, Answer
from dofkit.relations.blocks import Block
from dofkit.report import ConstraintEntry, Count, FieldVerdict, ForceEntry, Report
from dofkit.scene.lowering import lower
from dofkit.scene.names import names_by_position
from dofkit.scene.scene import Scene
from dofkit.system import BODY_ROLES, Constraint, System


def stages(scene: Scene | System, seconds: float, method: MethodName = "auto") -> Iterator[Report]:
    """Yield a report in which everything is undecided, then the one that is finished within so many seconds.

    Raises SceneError where the scene cannot be read as mathematics.
    """
    until = time.monotonic() + seconds
    system = lowered(scene, seconds)
    if isinstance(system, Report):
        yield system
        return
    yield sketch(system, OUT_OF_TIME)
    yield _classified(system, until - time.monotonic(), method)


@gc_rarely()
def classified(scene: Scene | System, seconds: float, method: MethodName = "auto") -> Report:
    """Return the last of the `stages`."""
    until = time.monotonic() + seconds
    system = lowered(scene, seconds)
    return system if isinstance(system, Report) else _classified(system, until - time.monotonic(), method)


def lowered(scene: Scene | System, seconds: float) -> System | Report:
    """Return the scene's equations, or a report that says that there was no time even for reading them."""
    if isinstance(scene, System):
        return scene
    try:
        with limited(seconds):
            return lower(scene)
    except OutOfTimeError as error:
        return blank(scene, str(error))


def _classified(system: System, seconds: float, method: MethodName) -> Report:
    engines = ENGINES.get(method)
    try:
        if engines is None:
            with limited(seconds):
                return report_of_method(system, method)
        study = examined(system, seconds, engines, passes=PASSES if method == "auto" else PLAIN)
        return study.report if method == "auto" else report_of_engine(study.report, study.outcome, method)
    except OutOfTimeError as error:
        return sketch(system, str(error))


def blank(scene: Scene, why: str) -> Report:
    """Return a report on a scene whose equations could not be read in time: they are not counted."""
    d, particles, bodies = scene.dimension, len(scene.particles), len(scene.bodies)
    coordinates = d * particles + len(BODY_ROLES[d]) * bodies + len(scene.coordinates)
    count = Count(
        particles=particles,
        bodies=bodies,
        dimension=d,
        coordinates=coordinates,
        constraints=0,
        independent=None,
        naive_dof=coordinates,
        formula=f"f = n - k = {coordinates} - k",
        errs="the equations were not counted",
    )
    names = names_by_position("c", [c.name for c in scene.constraints])
    constraints = [
        Constraint(name, c.kind(), c.facts, c.in_words, ()) for name, c in zip(names, scene.constraints, strict=True)
    ]
    forces = [
        ForceEntry(name=name, reason=f.reason)
        for name, f in zip(names_by_position("f", [f.name for f in scene.forces]), scene.forces, strict=True)
    ]
    return open_report(scene.name, count, [open_entry(c, why) for c in constraints], forces, [why_nothing(why)])


#: The questions that a report answers, and how each is called in a warning.
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
    """Return the report of a method that is no engine of dofkit. Raises OutOfTimeError."""
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
    whole = {name: _all_of([getattr(e, name) for e in entries]) for name in ("holonomic", "scleronomic")}
    about: About = "everywhere" if system.reference is None else "reference"
    verdicts = {
        **base.verdicts,
        **{name: _verdict(redundancy.verdict if name == "redundant" else dof.verdict, about) for name in fields},
        **{name: _of_entries(name, value, entries) for name, value in whole.items()},
    }
    changes = {
        "constraints": entries,
        "verdict": weakest(*(e.verdict for e in entries), dof.verdict),
        "method": f"{method} alone: {methods()[method].cannot}",
        "modelled": "the equations as they are written",
        "warnings": [*system.warnings, *(w for q, r in replies.items() if (w := _warning(method, q, r)))],
        "verdicts": verdicts,
    }
    return base.model_copy(update={**changes, **fields, **whole})


def _reply(system: System, method: MethodName, question: Question) -> Reply:
    try:
        reply: Reply = function_of(method, question)(system)
    except OutOfTimeError:
        raise
    except (ArithmeticError, NotImplementedError, ValueError) as error:
        return Reply(None, reason=str(error) or type(error).__name__)
    return reply


def _warning(method: MethodName, question: Question, reply: Reply) -> str:
    """Return a sentence about an answer that is not certain, or the empty text."""
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


def _all_of(labels: list[bool | None]) -> bool | None:
    return False if False in labels else None if None in labels else True


def _of_entries(name: str, value: bool | None, entries: list[ConstraintEntry]) -> FieldVerdict:
    """Return the verdict of a label of the system: the weakest of the entries that it rests on."""
    if value is None:
        return _verdict("undecided")
    return _verdict(weakest(*(e.verdicts[name].verdict for e in entries if getattr(e, name) is value)))


def _entry(constraint: Constraint, entry: ConstraintEntry, holonomic: Verdict | None, best: Verdict) -> ConstraintEntry:
    """Return an entry with what its text itself shows; ``holonomic``: how certainly the method shows that it is."""
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
    """Return whether neither t nor dt occurs; dt is hidden where not all terms hold rates."""
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
    """Return the report of one engine on its own: no surer than the engine is, and undecided where it cannot know."""
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
