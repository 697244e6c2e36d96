"""Assignments: problems about scenes, each with questions."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import Field, ValidationError

from dofkit.base.documents import Document, read_document
from dofkit.base.errors import ArgumentError, DofkitError, Fault, FaultsError, SceneError
from dofkit.base.wording import description_of
from dofkit.homework.key.key import Convention, Key
from dofkit.homework.key.own_coordinates import faults_of_own
from dofkit.homework.problem import (
    Pick,
    Problem,
    Variants,
    combinations_of,
    faults_of_places,
    pick_text,
    weighted,
    with_values,
)
from dofkit.homework.questions import QuestionBase
from dofkit.homework.review import Decisions
from dofkit.homework.sentences import Language
from dofkit.scene.catalog import find
from dofkit.scene.fields import WrittenModel, faults_of
from dofkit.scene.hints import with_hint, without_echoes
from dofkit.scene.reading import load
from dofkit.scene.scene import Scene

#: The most constraints of a scene: every answer that a question may need is computed before grading.
MOST_CONSTRAINTS = 5000
#: A field with many correct values, with which no answer is compared.
UNASKED = "generalized_coordinates"
FeedbackLevel = Literal["hint", "full"]
Visibility = Literal["visible", "after_due_date", "after_published", "hidden"]
UnreadablePolicy = Literal["review", "zero"]


class AssignmentError(FaultsError):
    """An invalid assignment, with all its faults."""


class Assignment(WrittenModel):
    """An assignment as the lecturer writes it."""

    title: str = Field(description="its title")
    convention: Convention = Field(
        "configuration",
        description='what "degrees of freedom" means: `configuration` space dimension or `velocity` freedom',
    )
    feedback: FeedbackLevel = Field(
        "hint", description="`hint` says what went wrong, `full` also gives the correct answer"
    )
    unreadable: UnreadablePolicy = Field(
        "review",
        description="answers that cannot be read: `review` (by a person) or `zero` (no points; submit again)",
    )
    language: Language = Field("en", description="the language of the feedback: `en`, `de`, `fr` or `es`")
    visibility: Visibility = Field(
        "after_due_date",
        description="when students see points on Gradescope: `visible` (at once), `after_due_date`, `after_published`, "
        "`hidden`",
    )
    problems: Annotated[tuple[Problem, ...], Field(min_length=1)] = Field(description="the problems")
    variants: Variants | None = Field(
        None, description="written by `dofkit assignment vary`: the variant of each student"
    )


class Combination(NamedTuple):
    """One variant of a problem, with its key."""

    pick: Pick
    problem: Problem
    key: Key


@dataclass(frozen=True)
class Prepared:
    """An assignment with everything that grading needs. ``keys``: {problem: key}; ``base``: its folder.

    ``decisions``: points that a person gave, which replace those of dofkit. ``combinations``: {problem: its variants};
    ``marks``: in one student's sheet {(problem, question): variant} for questions whose right answer depends on it;
    ``variant``: what distinguishes the sheet from others.
    """

    assignment: Assignment
    keys: Mapping[str, Key]
    base: Path = Path()
    decisions: Decisions = field(default_factory=dict)
    combinations: Mapping[str, Sequence[Combination]] = field(default_factory=dict)
    marks: Mapping[tuple[str, str], str] = field(default_factory=dict)
    variant: str = ""

    def questions(self) -> Iterator[tuple[Problem, QuestionBase]]:
        """Yield (problem, question) for every question, in order."""
        for problem in self.assignment.problems:
            for question in problem.questions:
                yield problem, question

    def most_points(self) -> dict[tuple[str, str], Fraction]:
        """Return {(problem, question): points}."""
        return {(problem.id, question.id): question.points for problem, question in self.questions()}

    @cached_property
    def max_score(self) -> float:
        """The sum of the points of all questions."""
        return float(sum(self.most_points().values()))

    def columns(self) -> dict[str, tuple[str, str]]:
        """Return {PROBLEM.QUESTION: (problem, question)}, the columns of a table of answers."""
        return {f"{problem.id}.{question.id}": (problem.id, question.id) for problem, question in self.questions()}


def load_assignment(source: str | os.PathLike[str] | Mapping[str, Any], base: Path | None = None) -> Prepared:
    """Return the assignment of a YAML or JSON file, or of a mapping, with its scenes.

    Parameters
    ----------
    source
        A path or a mapping.
    base
        The folder that paths of scenes are relative to; by default that of the assignment's file.

    Returns
    -------
    Prepared
        What `grade` accepts as its assignment.

    Raises
    ------
    AssignmentError
        If it is not an assignment: with every fault of it, of its scenes and of its questions at once.
    ArgumentError
        If ``source`` is neither a path nor a mapping.

    Examples
    --------
    >>> import dofkit
    >>> problem = {"id": "bars", "scene": "four-bar-linkage", "questions": [{"id": "f", "ask": "dof", "points": 2}]}
    >>> dofkit.load_assignment({"title": "One", "problems": [problem]}).assignment.problems[0].id
    'bars'
    """
    if isinstance(source, Mapping):
        return _prepared(source, base or Path(), None)
    if not isinstance(source, str | os.PathLike):
        raise ArgumentError(f"an assignment is given as a path or a mapping, not {description_of(source)}")
    path = os.fspath(source)
    try:
        file = find(path)
    except SceneError as error:
        raise AssignmentError(error.faults, path) from None
    document = read_document(file.data, file.name)
    if document.faults or not isinstance(document.value, dict):
        hint = "begin with 'title:' and 'problems:'"
        faults = document.faults or (Fault("an assignment is a mapping of keys to values", hint=hint),)
        faults = tuple(replace(f, hint=hint) if "file is empty" in f.message else f for f in faults)
        raise AssignmentError(faults, path)
    return _prepared(document.value, Path(path).parent, document)


def _prepared(value: Mapping[str, Any], base: Path, document: Document | None) -> Prepared:
    """Return a checked assignment with its keys and variants. Raises AssignmentError with all faults."""
    try:
        assignment = Assignment.model_validate(value)
        assignment = assignment.model_copy(update={"problems": tuple(map(weighted, assignment.problems))})
    except ValidationError as error:
        raise _error(_without_shortness(without_echoes(faults_of(error), value)), document) from None
    faults: list[Fault] = list(_repeats(assignment))
    keys: dict[str, Key] = {}
    combinations: dict[str, list[Combination]] = {}
    for i, problem in enumerate(assignment.problems):
        for pick, variant in _variants(problem, base, faults, i):
            try:
                scene = _scene(variant, base)
                key = Key(scene, assignment.convention, variant.also)
            except SceneError as error:
                faults += [_within(fault, i, problem, pick) for fault in error.faults]
                break
            keys.setdefault(problem.id, key)
            if problem.vary:
                combinations.setdefault(problem.id, []).append(Combination(pick, variant, key))
            try:
                faults += [_of_variant(fault, problem, pick) for fault in _scene_faults(i, variant, key)]
            except (DofkitError, MemoryError):
                raise
            except Exception:  # It fails again at every answer to this problem, which then needs a review.
                continue
    if faults:
        raise _error(tuple(faults), document)
    return Prepared(assignment, keys, base, combinations=combinations)


def _variants(problem: Problem, base: Path, faults: list[Fault], i: int) -> Iterator[tuple[Pick, Problem]]:
    """Yield (values, problem with these values) for each variant; ({}, problem) if it does not vary."""
    if not problem.vary:
        yield {}, problem
        return
    written = problem.scene if isinstance(problem.scene, dict) else _written_scene(problem.scene, base)
    if not isinstance(written, dict):
        hint = "`vary` needs a scene in place, or the file of one"
        faults.append(Fault(f"'{problem.scene}' is not the file of a scene", ("problems", i, "scene"), hint=hint))
        return
    for pick in combinations_of(problem.vary):
        value = {"scene": written, "text": problem.text, "title": problem.title, "also": problem.also}
        yield pick, problem.model_copy(update=with_values(value, problem.vary, pick))


def _written_scene(source: str, base: Path) -> object:
    """Return the parsed document of a scene's file, or of a scene in the catalog."""
    file = find(base / source if (base / source).is_file() else source)
    return read_document(file.data, file.name).value


def _of_variant(fault: Fault, problem: Problem, pick: Pick) -> Fault:
    """Return a fault with the values of its variant in the message."""
    if not problem.vary:
        return fault
    return replace(fault, message=f"for {pick_text(problem.vary, pick)}: {fault.message}")


def _without_shortness(faults: Sequence[Fault]) -> tuple[Fault, ...]:
    """Return the faults without "list too short" if the list only lost its faulty entries."""
    inside = {fault.where[:n] for fault in faults for n in range(len(fault.where))}
    return tuple(f for f in faults if not (f.where in inside and f.message.startswith("at least")))


def _scene(problem: Problem, base: Path) -> Scene:
    """Return the scene of a problem. Raises SceneError, also if it has too many constraints."""
    if isinstance(problem.scene, dict):
        scene = load(problem.scene, name=problem.id)
    else:
        path = base / problem.scene
        scene = load(path if path.is_file() else problem.scene)
    if len(scene.constraints) > MOST_CONSTRAINTS:
        count = f"the scene has {len(scene.constraints)} constraints"
        message = f"{count}, more than an assignment takes ({MOST_CONSTRAINTS})"
        raise SceneError((Fault(message, ("constraints",), hint="ask about a part of it; `dofkit classify` takes it"),))
    return scene


def _within(fault: Fault, i: int, problem: Problem, pick: Pick) -> Fault:
    """Return a fault of a scene as a fault of the assignment; a scene's own file is named in the message."""
    where = ("problems", i, "scene")
    fault = _of_variant(fault, problem, pick)
    if isinstance(problem.scene, dict):
        return replace(fault, where=(*where, *fault.where), line=None, column=fault.column)
    place = "" if fault.line is None else f" (line {fault.line}, column {fault.column} of {problem.scene})"
    return Fault(fault.message + place, where, hint=fault.hint)


def _scene_faults(i: int, problem: Problem, key: Key) -> Iterator[Fault]:
    """Yield the faults of a problem's scene, variant, offered coordinates, placeholders and questions."""
    if key.report.consistent is False:
        message = f"the scene of problem '{problem.id}' is inconsistent: {', '.join(key.report.conflicting)}"
        yield Fault(message, ("problems", i, "scene"), hint="no motion satisfies its constraints; correct the scene")
        return
    verdicts = {name: v.verdict for name, v in key.report.verdicts.items() if name != UNASKED}
    if problem.vary and (unproved := [name for name, verdict in verdicts.items() if verdict != "proved"]):
        hint = "choose values for which everything is proved, or ask `dofkit classify --how` why it is not"
        yield Fault(f"the key is not proved ({', '.join(unproved)})", ("problems", i, "vary"), hint=hint)
    for fault in faults_of_own(key):
        yield replace(fault, where=("problems", i, "also", *fault.where))
    for fault in faults_of_places(problem.text or "", problem.vary):
        yield replace(fault, where=("problems", i, "text"))
    for j, question in enumerate(problem.questions):
        for fault in question.faults(key):
            yield replace(fault, where=("problems", i, "questions", j, *fault.where))


def _repeats(assignment: Assignment) -> Iterator[Fault]:
    seen: set[str] = set()
    for i, problem in enumerate(assignment.problems):
        if problem.id in seen:
            yield Fault(f"the problem '{problem.id}' is given twice", ("problems", i, "id"), hint="rename one of them")
        seen.add(problem.id)
        asked: set[str] = set()
        for j, question in enumerate(problem.questions):
            if question.id in asked:
                where = ("problems", i, "questions", j, "id")
                yield Fault(f"the question '{question.id}' is given twice", where, hint="rename one of them")
            asked.add(question.id)


def _error(faults: tuple[Fault, ...], document: Document | None) -> AssignmentError:
    faults = tuple(fault if fault.hint else with_hint(fault, {}) for fault in faults)
    if document is None:
        return AssignmentError(faults)
    placed = []
    for fault in faults:
        if fault.line is None:
            key = fault.message.startswith("unknown key")
            line, column = document.place(fault.where, key=key, column=fault.column)
            fault = replace(fault, line=line, column=column)
        placed.append(fault)
    return AssignmentError(tuple(sorted(placed, key=lambda f: (f.line or 0, f.column or 0))), document.name)
