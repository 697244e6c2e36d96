"""One problem of an assignment: its text and picture, its scene, what is asked, and what may differ by student."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Annotated, Any, Literal, get_args

from pydantic import BeforeValidator, Field, WrapValidator

from dofkit.base.errors import Fault
from dofkit.expressions.text import valid_name
from dofkit.homework.key.key import Key
from dofkit.homework.questions import KINDS, AnyQuestion, Identifier, QuestionBase
from dofkit.homework.questions.base import Points, identifier
from dofkit.scene.constraints import AnyConstraint
from dofkit.scene.constraints.equations import as_equation
from dofkit.scene.fields import Listed, TaggedUnion, Text, WrittenModel, suggestion

#: What may differ between the sheets of students.
Aspect = Literal["geometry", "names", "constraints", "supports", "rolling"]
ASPECTS: tuple[Aspect, ...] = get_args(Aspect)
#: A figure that is drawn from the scene, and none at all.
DRAWN, UNDRAWN = "scene", "none"

_QUESTION = TaggedUnion(
    base=QuestionBase,
    called="a question",
    key="ask",
    known=KINDS,
    names="questions",
    listing="the questions are: ",
    unknown="there is no question '{}'",
    otherwise=("a question is a mapping with `id` and `ask`", "write {id: f, ask: dof} or the like"),
)


def _varying(value: object) -> object:
    """A list of aspects, or false for none."""
    if value is False or isinstance(value, (list, tuple)):
        return {"what": value or ()}
    return {} if value is True else value


class Varying(WrittenModel):
    """What may differ between the sheets of students."""

    what: Annotated[tuple[Aspect, ...], Listed] = Field(
        ASPECTS, description="any of geometry, names, constraints, supports, rolling"
    )
    drop: Annotated[tuple[str, ...], Listed] = Field((), description="constraints of which one is omitted")
    add: Annotated[
        tuple[Annotated[AnyConstraint, BeforeValidator(as_equation, json_schema_input_type=str | AnyConstraint)], ...],
        Listed,
    ] = Field((), description="constraints of which one is added")


def _aliases(value: object) -> object:
    """One other name needs no list."""
    if not isinstance(value, Mapping):
        return {} if value is None else value
    return {name: (given,) if isinstance(given, str) else given for name, given in value.items()}


class Problem(WrittenModel):
    """A scene and what is asked of it."""

    id: Identifier = Field(description="its name, unique within the assignment")
    title: str | None = Field(None, description="its title")
    text: Text | None = Field(
        None,
        description="the problem statement: Markdown, formulas in $; [[rod]], [[rod.length]] insert parts of the scene",
    )
    figure: str | None = Field(
        None, description="a picture's file beside the assignment, `scene` (drawn) or `none`; by default drawn"
    )
    points: Points | None = Field(None, description="its total points; the points of its questions are shares of it")
    scene: str | dict[str, Any] = Field(description="a catalog name, a path beside the assignment, or a scene in place")
    also: dict[str, str] = Field(
        default_factory=dict, description="further coordinates that answers may use, by name: `theta: atan2(x, -y)`"
    )
    names: Annotated[
        dict[str, tuple[str, ...]],
        BeforeValidator(_aliases, json_schema_input_type=dict[str, str | list[str]]),
    ] = Field(default_factory=dict, description="other names that answers may use: `theta_A: [theta, phi]`")
    vary: Annotated[Varying, BeforeValidator(_varying)] | None = Field(
        None, description="what may differ between students: a list of aspects, or false for nothing; by default all"
    )
    questions: Annotated[
        tuple[Annotated[AnyQuestion, WrapValidator(_QUESTION.validated)], ...], Field(min_length=1)
    ] = Field(description="its questions")

    @property
    def other_names(self) -> dict[str, str]:
        """The declared name of every other one."""
        return {other: name for name, others in self.names.items() for other in others}


class StudentSheet(WrittenModel):
    """Whose sheet is which."""

    student: str = Field(min_length=1, description="the name of the student in results")
    known_as: Annotated[tuple[str, ...], Listed] = Field(
        (), description="other names, addresses and numbers of the student"
    )
    draw: int = Field(
        0, ge=0, description="which draw of the seed it is; 0 unless that gives another student's variant"
    )
    sheet: str = Field("", description="a mark that tells whether the variant is reproduced exactly")


class Variants(WrittenModel):
    """That every student has a sheet of their own, made from a seed."""

    seed: Annotated[str, BeforeValidator(identifier)] = Field(min_length=1, description="the seed of the variants")
    version: str = Field("", description="the version of dofkit that made them")
    students: tuple[StudentSheet, ...] = Field((), description="the students")

    def find(self, text: str) -> StudentSheet | None:
        """Whose name, address or number it is; None for nobody's, and for that of two."""
        found = [one for one in self.students if plain_name(text) in map(plain_name, (one.student, *one.known_as))]
        return found[0] if len(found) == 1 else None


def plain_name(text: str) -> str:
    """A name as names are compared: capitals and spaces make no difference."""
    return " ".join(unicodedata.normalize("NFC", text).casefold().split())


def weighted(problem: Problem) -> Problem:
    """The problem with its questions' points as shares of its own, where it has points."""
    whole = sum((q.points for q in problem.questions), Fraction(0))
    if problem.points is None or not whole or whole == problem.points:
        return problem
    shares = tuple(q.model_copy(update={"points": q.points * problem.points / whole}) for q in problem.questions)
    return problem.model_copy(update={"questions": shares})


def faults_of_names(problem: Problem, key: Key) -> Iterator[Fault]:
    """Other names that cannot be: of what the scene does not declare, or that mean something already."""
    declared = [*key.coordinates, *key.scene.parameters, *key.constraints]
    taken = {*declared, *key.scene.functions, *key.also}
    for name, others in problem.names.items():
        if name not in declared:
            yield Fault(f"the scene declares no '{name}'", ("names", name), hint=suggestion(name, declared, "names"))
        for n, other in enumerate(others):
            wrong = valid_name(other)
            if other in taken or wrong is not None:
                why = f"'{other}' already has a meaning" if other in taken else str(wrong)
                yield Fault(why, ("names", name, n), hint="choose a name that the scene does not use")
            taken.add(other)
    if problem.vary is not None:
        for fault in _faults_of_dropped(problem.vary, key):
            yield replace(fault, where=("vary", *fault.where))


def _faults_of_dropped(varying: Varying, key: Key) -> Iterator[Fault]:
    for n, name in enumerate(varying.drop):
        if name not in key.constraints:
            hint = suggestion(name, list(key.constraints), "constraints")
            yield Fault(f"the scene has no constraint '{name}'", ("drop", n), hint=hint)
