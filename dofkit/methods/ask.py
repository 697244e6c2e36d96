"""One question about a scene, answered with no more work than needed: no special cases, circuits or integrals.

The answers agree with those of `classify`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from flint import ctx

from dofkit.base.deadline import DEFAULT_SECONDS, OUT_OF_TIME, OutOfTimeError, limited
from dofkit.base.errors import ArgumentError
from dofkit.base.verdicts import weakest
from dofkit.base.wording import description_of, require_one_of, seconds_of
from dofkit.classification.dependence.redundancy import all_needed, redundancies
from dofkit.classification.equivalence import Sameness, compare
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.freedom.preparation import prepared
from dofkit.classification.labels.entries import labels_in_system
from dofkit.classification.study import Study, study
from dofkit.exact.points.balls import precise_for, precision
from dofkit.exact.zero import BOTH, Engines
from dofkit.methods.table import (
    CONTRADICTORY,
    ENGINES,
    QUESTIONS,
    MethodName,
    Question,
    Reply,
    cannot,
    function_of,
    methods,
)
from dofkit.mobility.general_position import unprescribed_links
from dofkit.mobility.graph.linkage import linkage
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.pieces import Finite, Reduced
from dofkit.scene.added_equations import read_equations, with_equations
from dofkit.scene.lowering import lower
from dofkit.scene.names import names_by_position, vocabulary_of
from dofkit.scene.reading import SceneLike, load, scene_or_system
from dofkit.scene.scene import Scene
from dofkit.system import System

#: The name of the constraints for an answer's equations in the extended scene.
ANSWER = "the answer"


def ask(
    scene: SceneLike | System, question: Question, answer: Mapping[str, str] | None = None, budget: float | None = None
) -> Reply:
    """Return the answer to one question about a scene, with no more work than that question needs.

    Parameters
    ----------
    scene
        A Scene, a path, a catalog name, a mapping or (except for ``equivalence``) a System.
    question
        ``"dof"``, ``"integrability"``, ``"redundancy"`` or ``"equivalence"``.
    answer
        For ``equivalence``: ``{"constraint": NAME, "text": TEXT}``. Is the text equivalent to that constraint, given
        the others?
    budget
        Seconds, after which no new step begins.

    Returns
    -------
    Reply
        The value, its verdict, and the reason if there is no value.

    Raises
    ------
    SceneError, TextError
        If the scene or the text cannot be read.
    ArgumentError
        If an argument is no scene, question, answer or number of seconds.

    Examples
    --------
    >>> import dofkit
    >>> scene = {"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]}
    >>> dofkit.ask(scene, "dof").value
    1
    >>> dofkit.ask(scene, "equivalence", {"constraint": "c1", "text": "2 y dx + 2 x dy = 0"}).value
    True
    """
    require_one_of(question, QUESTIONS, "question")
    seconds = None if budget is None else seconds_of(budget)
    loaded = scene_or_system(scene)
    if question == "equivalence":
        _require_answer(loaded, answer)
    return answered_by(loaded, question, answer, seconds)


def _require_answer(scene: Scene | System, answer: object) -> None:
    """Raise ArgumentError for a System, which has no names for a text, and for a malformed answer."""
    if isinstance(scene, System):
        raise ArgumentError("equivalence is asked of a Scene, with whose names the text is read, not of a System")
    keys = ("constraint", "text")
    if not isinstance(answer, Mapping) or not all(isinstance(answer.get(key), str) for key in keys):
        wanted = "{'constraint': NAME, 'text': TEXT}, both texts"
        raise ArgumentError(f"for equivalence `answer` is {wanted}, not {description_of(answer)}")
    require_one_of(answer["constraint"], names_by_position("c", [c.name for c in scene.constraints]), "constraint")


def answered_by(
    scene: Scene | System,
    question: Question,
    answer: Mapping[str, str] | None = None,
    budget: float | None = None,
    engines: Engines = BOTH,
) -> Reply:
    """Return `ask`'s reply by the given engines; undecided if the budget (seconds) is used up."""
    try:
        with limited(DEFAULT_SECONDS if budget is None else budget), ctx.workprec(precision()):
            if question == "equivalence":
                if not isinstance(scene, Scene) or answer is None:
                    raise ValueError("equivalence is asked of a scene and an answer")
                return _equivalence(scene, answer, engines)
            system = scene if isinstance(scene, System) else lower(scene)
            with precise_for(system.longest):
                return _of_system(system, question, engines)
    except OutOfTimeError:
        return Reply(None, "undecided", OUT_OF_TIME)


def _of_system(system: System, question: Question, engines: Engines) -> Reply:
    """Return the reply about a system: by its graph or by its single constraints if these suffice, else by a study."""
    if engines == BOTH and question in ("dof", "redundancy"):
        reply = _by_graph(system, question)
        if reply is not None:
            return reply
    if question == "integrability" and all(map(_is_finite, prepared(system)[0])):
        return Reply({c.name: True for c in system.constraints}, "proved")
    return _QUESTIONS[question](study(system, engines, grows=False))


def _is_finite(r: Reduced) -> bool:
    """Return whether a constraint has only relations between coordinates and time, and so is holonomic (d(dg) = 0)."""
    pieces = [p for n in r.normals for b in n.branches for p in b]
    return bool(pieces) and not r.inequalities and all(isinstance(p, Finite | DomainCondition) for p in pieces)


def _by_graph(system: System, question: Question) -> Reply | None:
    """Return the reply that the graph of links gives if no length is prescribed, so that they are in general position.

    None for other systems, and for redundancy if a constraint has several links, of which some may be redundant.
    """
    pairs = unprescribed_links(system)
    if pairs is None:
        return None
    link_answer = linkage([pair for _, pair in pairs], system.dimension)
    verdict = link_answer.verdict
    if question == "dof":
        return Reply(len(system.coordinates) - link_answer.rank, verdict)
    names = [system.constraints[pairs[k][0]].name for k in link_answer.redundant_places]
    return Reply(names, verdict) if len({i for i, _ in pairs}) == len(pairs) else None


def _dof(studied: Study) -> Reply:
    outcome = studied.outcome
    sure = weakest(*(a.verdict for a in outcome.answers))
    if outcome.consistent is False:
        return Reply(CONTRADICTORY, sure, "no motion satisfies all constraints")
    if outcome.dof is None:
        return Reply(None, "undecided", _why(outcome))
    return Reply(outcome.dof, sure)


def _why(outcome: Outcome) -> str:
    """Return the first reason why a block is undecided."""
    reasons = (reason for a in outcome.answers if a.consistent is None or a.dof is None for reason in a.reasons)
    return next(reasons, "it was not decided")


def _integrability(studied: Study) -> Reply:
    """Return the reply {constraint: whether it is holonomic in the system, or None}."""
    labels_of_study = labels_in_system(studied.reduced, studied.setting, studied.outcome)
    labels = dict(zip(studied.names, (label for label, _ in labels_of_study), strict=True))
    sure = weakest(*(verdict for _, verdict in labels_of_study))
    reason = ""
    if None in labels.values():
        entries = studied.entries_beside([])
        labels = {e.name: e.holonomic for e in entries}
        sure = weakest(*(e.verdict for e in entries))
        reason = next((e.reason for e in entries if e.holonomic is None), "")
    return Reply(labels, "undecided" if None in labels.values() else sure, reason)


def _redundancy(studied: Study) -> Reply:
    """Return the reply with a maximal redundant set of constraints."""
    outcome = studied.outcome
    if not outcome.consistent or outcome.velocity_dof is None:
        return Reply(None, "undecided", _why(outcome))
    groups = redundancies(studied.reduced, studied.setting, outcome)
    if studied.redundant_equations == 0:
        groups = all_needed(groups, studied.reduced, outcome)
    undecided_rows = sorted({i for r in groups for i in r.undecided})
    if undecided_rows:
        name = studied.names[undecided_rows[0]]
        return Reply(None, "undecided", f"whether {name} is implied by the others was not decided")
    redundant = sorted({i for r in groups for i in r.redundant})
    claims = (*(a.claim for a in outcome.answers), *(r.claim for r in groups if r.redundant or r.groups))
    return Reply([studied.names[i] for i in redundant], weakest(*(claim.verdict for claim in claims)))


def _equivalence(scene: Scene, answer: Mapping[str, str], engines: Engines) -> Reply:
    """Return whether the answer's text and its constraint have the same solutions, given the other constraints."""
    read = read_equations(answer["text"], vocabulary_of(scene).names, constants=False)
    system = lower(with_equations(scene, read, ANSWER)).in_coordinates
    submitted = range(len(scene.constraints), len(system.constraints))
    comparison = compare(system, system.numbers_of(answer["constraint"]), submitted, read.constants, engines).sameness
    if comparison is Sameness.UNDECIDED:
        return Reply(None, "undecided", "it was not decided whether each implies the other")
    return Reply(comparison is Sameness.SAME, "probable", "" if comparison is Sameness.SAME else comparison.value)


_QUESTIONS: Mapping[Question, Callable[[Study], Reply]] = {
    "dof": _dof,
    "integrability": _integrability,
    "redundancy": _redundancy,
}


#: The exceptions by which a method fails on a scene that it cannot treat.
FAILURES = (ArithmeticError, OutOfTimeError, NotImplementedError, ValueError)


def answered(
    scene: Scene | Mapping[str, Any],
    question: Question,
    method: MethodName,
    answer: Mapping[str, str] | None = None,
) -> Reply:
    """Return the answer of one method on its own, right or wrong.

    ``answer``: for ``equivalence``, ``{"constraint": NAME, "text": TEXT}``. If the method cannot or does not
    answer, ``value`` is None and ``reason`` says why. Raises SceneError if the scene cannot be read.
    """
    row = methods()[method]
    if question not in row.uses:
        return cannot(f"{method} has no way to answer this: {row.cannot}")
    read = scene if isinstance(scene, Scene) else load(scene)
    try:
        if method in ENGINES:
            reply = answered_by(read, question, answer, engines=ENGINES[method])
            return replace(reply, value=sorted(reply.value)) if question == "redundancy" and reply.value else reply
        work = function_of(method, question)
        return work(read, answer) if question == "equivalence" else work(read)
    except OverflowError as error:
        return Reply(None, reason=f"a number that occurs is too large or too small to compute with ({error})")
    except FAILURES as error:
        return Reply(None, reason=str(error) or type(error).__name__)
