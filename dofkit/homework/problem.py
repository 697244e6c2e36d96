"""One problem of an assignment: text, picture, scene, questions, and values that differ between students."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, WrapValidator

from dofkit.base.errors import Fault
from dofkit.expressions.text.typesetting import typeset
from dofkit.homework.answers.roster import plain_name
from dofkit.homework.questions import KINDS, AnyQuestion, Identifier, QuestionBase
from dofkit.homework.questions.base import Points
from dofkit.homework.sentences import Language, described
from dofkit.scene.constraints import ConstraintBase
from dofkit.scene.fields import Listed, TaggedUnion, Text, WrittenModel, as_written, fault_error, suggestion

#: {varying name: index of its value in a variant}.
Pick = dict[str, int]
#: The most variants of one problem.
MOST_COMBINATIONS = 64
#: The values of `figure` for a picture drawn from the scene, and for none.
DRAWN, UNDRAWN = "scene", "none"
_PLACE = re.compile(r"\[\[\s*([\w.-]+)\s*\]\]")

_QUESTION = TaggedUnion(
    base=QuestionBase,
    called="a question",
    key="ask",
    allowed=KINDS,
    names="questions",
    listing="the questions are: ",
    unknown="there is no question '{}'",
    otherwise=("a question is a mapping with `id` and `ask`", "write {id: f, ask: dof} or the like"),
)


def _varying(value: object) -> object:
    """Return ``vary`` ({name: values}) after checks, or None if nothing varies. Raises an error of pydantic."""
    if value is False or value is None:
        return None
    shape = "write `vary: {n: [2, 3, 5]}`, and `[[n]]` where a value stands in the scene and the text"
    if not isinstance(value, Mapping) or not value:
        raise fault_error("`vary` lists the values of each name", shape)
    count = 1
    for name, options in value.items():
        if not isinstance(options, list | tuple) or not options:
            raise fault_error(f"`vary` needs a list of values for '{name}'", shape)
        kinds = {frozenset(option) if isinstance(option, Mapping) else None for option in options}
        if len(kinds) > 1:
            raise fault_error(f"the values of '{name}' in `vary` do not all have the same fields", shape)
        count *= len(options)
    if count > MOST_COMBINATIONS:
        raise fault_error(f"`vary` has {count} combinations", f"at most {MOST_COMBINATIONS} can be proved")
    return {str(name): tuple(options) for name, options in value.items()}


def combinations_of(vary: Mapping[str, Sequence[Any]]) -> list[Pick]:
    """Return all combinations of values as indices, the first values first."""
    return [dict(zip(vary, chosen, strict=True)) for chosen in product(*(range(len(o)) for o in vary.values()))]


def pick_text(vary: Mapping[str, Sequence[Any]], pick: Pick) -> str:
    """Return a combination as text: `n = 3, support = driven`."""
    texts = []
    for name, options in vary.items():
        value = options[pick.get(name, 0)]
        label = next(iter(value.values()), "") if isinstance(value, Mapping) else value
        texts.append(f"{name} = {as_written(label)}")
    return ", ".join(texts)


def with_values(value: Any, vary: Mapping[str, Sequence[Any]], pick: Pick) -> Any:
    """Return texts and mappings with a combination's values in place of ``[[NAME]]`` and ``[[NAME.FIELD]]``."""
    table: dict[str, Any] = {}
    for name, options in vary.items():
        option = options[pick[name]]
        fields = isinstance(option, Mapping)
        table |= {f"{name}.{key}": part for key, part in option.items()} if fields else {name: option}
    return _with_values(value, table)


def _with_values(value: Any, table: Mapping[str, Any]) -> Any:
    if isinstance(value, Mapping):
        return {key: _with_values(part, table) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_with_values(part, table) for part in value]
    if not isinstance(value, str):
        return value
    whole = _PLACE.fullmatch(value.strip())
    if whole is not None and whole[1] in table:
        return table[whole[1]]
    return _PLACE.sub(lambda m: as_written(table[m[1]]) if m[1] in table else m[0], value)


class Problem(WrittenModel):
    """A scene and the questions about it."""

    id: Identifier = Field(description="its name, unique within the assignment")
    title: str | None = Field(None, description="its title")
    text: Text | None = Field(
        None,
        description="the problem statement: Markdown, formulas in $; [[n]] inserts a value that varies",
    )
    figure: str | None = Field(
        None, description="a picture's file beside the assignment, `scene` (drawn) or `none`; by default drawn"
    )
    points: Points | None = Field(None, description="its total points; the points of its questions are shares of it")
    scene: str | dict[str, Any] = Field(description="a catalog name, a path beside the assignment, or a scene in place")
    also: dict[str, str] = Field(
        default_factory=dict, description="further coordinates that answers may use, by name: `theta: atan2(x, -y)`"
    )
    vary: Annotated[dict[str, tuple[Any, ...]] | None, BeforeValidator(_varying)] = Field(
        None, description="what differs between students: lists of values, `n: [2, 3, 5]`, put in where `[[n]]` stands"
    )
    questions: Annotated[
        tuple[Annotated[AnyQuestion, WrapValidator(_QUESTION.validated)], ...], Field(min_length=1)
    ] = Field(description="its questions")


class StudentVariant(WrittenModel):
    """A student, and the variant of each problem."""

    student: str = Field(min_length=1, description="the name of the student in results")
    known_as: Annotated[tuple[str, ...], Listed] = Field(
        (), description="other names, addresses and numbers of the student"
    )
    picks: dict[str, Pick] = Field(
        default_factory=dict, description="by problem: the index of the value of each varying name, from 0"
    )


class Variants(WrittenModel):
    """The variants of all students."""

    students: tuple[StudentVariant, ...] = Field((), description="the students")

    def find(self, text: str) -> StudentVariant | None:
        """Return the student with a name, address or number; None if there is none or more than one."""
        matches = [
            member
            for member in self.students
            if plain_name(text) in map(plain_name, (member.student, *member.known_as))
        ]
        return matches[0] if len(matches) == 1 else None


def weighted(problem: Problem) -> Problem:
    """Return the problem with the points of its questions scaled to the problem's points, if it has points."""
    whole = sum((q.points for q in problem.questions), Fraction(0))
    if problem.points is None or not whole or whole == problem.points:
        return problem
    shares = tuple(q.model_copy(update={"points": q.points * problem.points / whole}) for q in problem.questions)
    return problem.model_copy(update={"questions": shares})


def constraint_text(constraint: ConstraintBase, language: Language = "en") -> str:
    """Return a constraint in Markdown for a sheet: its equations as formulas, else its description."""
    texts = list(constraint.texts()) if constraint.facts.written and not constraint.facts.lettered else []
    if texts and all(typeset(text) for text in texts):
        return ", ".join(f"${text}$" for text in texts)
    return marked(described(constraint.in_words, language))


def marked(text: str) -> str:
    """Return a text on one line that Markdown shows literally.

    >>> print(marked("x_A * 2"))
    x\\_A \\* 2
    """
    return re.sub(r"([\\`*_{}\[\]<>#|$~])", r"\\\1", " ".join(text.split()))


def faults_of_places(text: str, vary: Mapping[str, Any] | None) -> Iterator[Fault]:
    """Yield faults for placeholders ``[[NAME]]`` in a text that are not replaced by a value."""
    for match in _PLACE.finditer(text):
        yield Fault(f"[[{match[1]}]] is not a name in `vary`", (), hint=suggestion(match[1], list(vary or ()), "names"))
