"""The text of a sheet as Markdown: problems with pictures, names and questions, and how to write answers.

It shows no answers: equations that are asked for are left out, and the examples are about another system.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import groupby

from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.wording import number
from dofkit.homework.handout.markup import SheetFigure
from dofkit.homework.key.key import Key
from dofkit.homework.problem import Problem, constraint_text, marked
from dofkit.homework.questions import QuestionBase
from dofkit.homework.questions.equations import EquationQuestion
from dofkit.homework.sentences import Language, described, say
from dofkit.scene.fields import as_written
from dofkit.scene.names import coordinate_table
from dofkit.scene.parts import Force, show_point

_SIGNED = {
    "real": "{names}: constant.",
    "positive": "{names}: positive constant.",
    "nonzero": "{names}: nonzero constant.",
}
_FREEDOM = {
    "configuration": "The number of degrees of freedom is the dimension of the configuration space.",
    "velocity": "The number of degrees of freedom is the number of independent generalized velocities.",
}


@dataclass(frozen=True)
class SheetComposer:
    """Writes one sheet. ``figures``: {problem: picture}; ``whose``: the student, or None for a sheet for all.

    ``has_fields``: whether answers are typed into the page, not into a file.
    """

    prepared: Prepared
    figures: dict[str, SheetFigure]
    whose: str | None = None
    has_fields: bool = False

    @property
    def language(self) -> Language:
        """The language of the sheet."""
        return self.prepared.assignment.language

    def _text(self, sentence: str, **values: object) -> str:
        """Return a sentence in the sheet's language."""
        return say(sentence, **values).translated(self.language)

    def markdown(self) -> str:
        """Return the whole sheet."""
        assignment = self.prepared.assignment
        blocks = [f"# {marked(assignment.title)}"]
        if self.whose is not None:
            whose = self._text("Assignment for {student}", student=marked(self.whose))
            blocks.append(f"**{whose}**")
        for n, problem in enumerate(assignment.problems, 1):
            blocks += self._problem(n, problem)
        heading = self._text("How to write answers")
        blocks += [f"## {heading}", "\n".join(f"- {notation}" for notation in self._notations())]
        return "\n\n".join(blocks) + "\n"

    def _problem(self, n: int, problem: Problem) -> Iterator[str]:
        key = self.prepared.keys[problem.id]
        whole = sum((q.points for q in problem.questions), Fraction(0))
        yield f"## {n}. {marked(problem.title or problem.id)} ({self._points(whole)})"
        if problem.text is not None:
            yield problem.text.strip()
        figure = self.figures.get(problem.id)
        if figure is not None:
            caption = self._text("Figure {number}", number=n)
            yield f"![{caption}]({figure.path})"
        names = list(self._names(problem, key))
        if names:
            yield "\n".join(f"- {entry}" for entry in names)
        yield "\n".join(
            f"{i}. {self._asked(q)} ({self._points(q.points)}) `{problem.id}.{q.id}`"
            for i, q in enumerate(problem.questions, 1)
        )

    def _points(self, points: Fraction) -> str:
        sentence = "{number} point" if points == 1 else "{number} points"
        return self._text(sentence, number=number(float(points)))

    def _asked(self, question: QuestionBase) -> str:
        constraint = getattr(question, "constraint", None) is not None
        about = ", ".join(f"`{name}`" if constraint else f"${name}$" for name in question.about)
        return question.asked(about).translated(self.language)

    def _names(self, problem: Problem, key: Key) -> Iterator[str]:
        """Yield the entries on coordinates, parameters, functions, constraints and forces of a problem."""
        table = coordinate_table(key.scene)
        for owner, group in groupby(table.coordinates, key=lambda c: c.owner):
            symbols = ", ".join(f"${c.name}$" for c in group)
            if owner is None:
                yield self._text("{names}: coordinates.", names=symbols)
            elif owner in table.bodies and key.scene.dimension > 1:
                yield self._text("{names}: position and orientation of the body {owner}.", names=symbols, owner=owner)
            else:
                yield self._text("{names}: position of {owner}.", names=symbols, owner=owner)
        for name, value in key.scene.parameters.items():
            sign = _SIGNED.get(str(value))
            yield self._text(sign, names=f"${name}$") if sign else f"${name} = {as_written(value)}$"
        for name, arguments in key.scene.functions.items():
            yield self._text("{names}: unknown smooth function.", names=f"${name}({', '.join(arguments)})$")
        yield from self._constraints(key, asked_equations(problem))
        yield from map(self._force, key.scene.forces)
        for name, text in problem.also.items():
            yield self._text("You may also use {names}.", names=f"${name} = {text}$")

    def _constraints(self, key: Key, hidden: set[str]) -> Iterator[str]:
        for constraint, name in zip(key.scene.constraints, key.constraints, strict=True):
            if constraint.facts.written and name in hidden:
                yield self._text("{names}: constraint.", names=f"`{name}`")
            else:
                yield f"`{name}`: {constraint_text(constraint, self.language)}"

    def _force(self, force: Force) -> str:
        if force.type == "gravity" and isinstance(force.acceleration, str):
            sentence = "Gravity acts on all masses, with the acceleration {value}."
            return self._text(sentence, value=f"${force.acceleration}$")
        if force.type == "gravity":
            return self._text("Gravity acts on all masses.")
        ends = [*(force.between or ()), *([] if force.point is None else [force.point])]
        where = "-".join(show_point(end) for end in ends) or force.body or ""
        sizes = {"stiffness": force.stiffness, "rest length": force.rest_length, "damping": force.damping}
        measures = "".join(f", {word} {as_written(value)}" for word, value in sizes.items() if value is not None)
        return marked(described(f"{force.type} {where}{measures}".strip(), self.language))

    def _notations(self) -> Iterator[str]:
        """Yield the notes on how answers are written, for every kind of question on the sheet."""
        asked = [question for _, question in self.prepared.questions()]
        kinds = {question.kind(): type(question) for question in asked}
        if {"dof", "k"} & set(kinds):
            yield self._text(_FREEDOM[self.prepared.assignment.convention])
        if not self.has_fields:
            (first, question), *_ = self.prepared.columns().values()
            yield self._text(
                "Submit a file such as answers.yaml with a line for each answer, as in {line}, or a filled-in "
                "template.",
                line=f"`{first}.{question}: ...`",
            )
        for cls in kinds.values():
            lead = self._text("Example (for a different system):")
            _, how, example = cls.words()
            yield self._text(how) + (f" {lead} `{example}`" if example else "")
        yield self._text("Greek letters may be typed directly or as words such as theta and omega. LaTeX is accepted.")
        decimals = "Decimals are written with a point or a comma; exact numbers such as 1/3 or sqrt(2) are preferred."
        yield self._text(decimals)


def asked_equations(problem: Problem) -> set[str]:
    """Return the names of the constraints whose equations are asked for."""
    return {name for q in problem.questions if isinstance(q, EquationQuestion) for name in q.constraint}
