"""Grading: a pure function of an assignment and a submission."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import islice
from pathlib import Path
from typing import Any

from flint import ctx

from dofkit.base.deadline import OutOfTimeError, by_processor
from dofkit.base.errors import TextError
from dofkit.exact.points.balls import PRECISION
from dofkit.homework.answers.prose import says_nothing
from dofkit.homework.answers.sources import read_submission
from dofkit.homework.answers.submission import Submission
from dofkit.homework.answers.words import shown_text
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.judgement import (
    FULL,
    NOTHING,
    DoubtError,
    Given,
    Judgement,
    needs_review,
    partly,
    shown_text_of,
    unreadable,
    verdict,
)
from dofkit.homework.key.key import Key
from dofkit.homework.problem import Problem
from dofkit.homework.questions import Earlier, NumberQuestion, QuestionBase
from dofkit.homework.result import Item, PossibleReading, Result
from dofkit.homework.review import Decision, answer_id, read_table
from dofkit.homework.sentences import Said, in_language, say
from dofkit.homework.variants import NobodysVariantError, sheet_of
from dofkit.scene.fields import suggestion

#: Seconds of processor time for one answer; what is not decided then needs a review.
ANSWER_SECONDS = 5.0
#: The most judgements that are kept, each for an answer of fewer characters than this.
MOST_REMEMBERED, LONGEST_REMEMBERED = 10_000, 4000
#: The most answers to other questions that are listed, and the most characters of their names.
MOST_UNASKED, LONGEST_NAME = 100, 200

#: The key of a judgement: a text of problem, question, answer, earlier numbers and variant.
Identity = str


class Grader:
    """Grades submissions of one assignment; equal answers are judged once.

    ``condemned``: {identity: reason} of answers that are not judged, because they broke a worker; they need a review.
    ``check_only``: whether answers are only read, so that there are no points.
    """

    def __init__(self, prepared: Prepared, seconds: float = ANSWER_SECONDS, check_only: bool = False) -> None:
        self.prepared = prepared
        self.seconds = seconds
        self.check_only = check_only
        self.condemned: Mapping[Identity, str] = {}
        self._judgements: dict[Identity, Judgement] = {}
        self._variants: dict[str, Grader] = {}

    def grade(self, submission: Submission) -> Result:
        """Return the result: all questions in the assignment's order, then answers to other questions."""
        return next(step for step in self.steps(submission) if isinstance(step, Result))

    def steps(self, submission: Submission) -> Iterator[Identity | Result]:
        """Yield the identity of every new answer before it is judged, and at the end the result.

        A failure outside of an answer becomes the error of this submission, and does not affect others.
        """
        error = submission.error
        try:
            if error is None:
                yield from self._of_variant(submission.student)._graded(submission)
        except NobodysVariantError as nobody:
            error = str(nobody)
        except MemoryError:
            raise
        except Exception as failure:
            error = f"an internal error occurred ({type(failure).__name__})"
        if error is not None:
            yield Result.refused(submission.student, self.prepared.max_score, error)

    def _of_variant(self, student: str) -> Grader:
        """Return the grader of a student's variant."""
        if not self.prepared.combinations:
            return self
        sheet = sheet_of(self.prepared, student)
        grader = self._variants.setdefault(sheet.variant, Grader(sheet, self.seconds, self.check_only))
        grader.condemned = self.condemned
        return grader

    def _graded(self, submission: Submission) -> Iterator[Identity | Result]:
        items: list[Item] = []
        for problem in self.prepared.assignment.problems:
            for step in self._problem(problem, submission.answers.get(problem.id, {})):
                if isinstance(step, Item):
                    items.append(step)
                else:
                    yield step
        items += unasked(self.prepared, submission)
        score = float(sum((Fraction(item.score) for item in items if item.score is not None), Fraction(0)))
        yield Result(
            student=submission.student,
            score=None if self.check_only else score,
            max_score=self.prepared.max_score,
            items=items,
            needs_review=0 if self.check_only else sum(item.score is None for item in items),
        )

    def _problem(self, problem: Problem, answers: Mapping[str, Given]) -> Iterator[Identity | Item]:
        """Yield the item of each question, and before a new answer is judged its identity."""
        earlier: dict[str, Fraction] = {}
        for question in problem.questions:
            answer = answers.get(question.id)
            if answer is None or says_nothing(answer):
                yield item_of(self.prepared, problem, question, _MISSING)
                continue
            if (decision := self._decision(problem, question, answer)) is not None:
                yield self._decided(problem, question, decision, answer)
            else:
                mark = self.prepared.marks.get((problem.id, question.id), "")
                identity = repr((problem.id, question.id, answer, *sorted(earlier.items()), mark))
                if identity not in self._judgements and identity not in self.condemned:
                    yield identity
                judgement = self._judged(identity, problem, question, answer, earlier)
                yield item_of(self.prepared, problem, question, judgement, answer)
                if identity in self.condemned:
                    continue
            if (claimed := self._number(question, answer, self.prepared.keys[problem.id])) is not None:
                earlier.setdefault(question.kind(), claimed)

    def _decision(self, problem: Problem, question: QuestionBase, answer: Given) -> Decision | None:
        """Return the decision of a person about equal answers of any student, or None."""
        if self.check_only or not self.prepared.decisions:
            return None
        variant = self.prepared.marks.get((problem.id, question.id), "")
        return self.prepared.decisions.get(answer_id(problem.id, question.id, shown_text(answer), variant))

    def _decided(self, problem: Problem, question: QuestionBase, decision: Decision, answer: Given) -> Item:
        """Return the item of an answer with the points that a person gave."""
        share = decision.points / question.points if question.points else FULL
        judgement = partly(share, "", why=decision.remark or "A person has reviewed this answer.")
        item = item_of(self.prepared, problem, question, judgement, answer)
        return item.model_copy(update={"score": float(decision.points), "decided_by": decision.by})

    def _judged(
        self, identity: Identity, problem: Problem, question: QuestionBase, answer: Given, earlier: Earlier
    ) -> Judgement:
        """Return the judgement of an answer, which is kept for equal answers."""
        if identity in self.condemned:
            return needs_review("", self.condemned[identity])
        judgement = self._judgements.get(identity)
        if judgement is None:
            judgement = self._judgement(problem, question, answer, earlier)
            if len(self._judgements) < MOST_REMEMBERED and len(identity) < LONGEST_REMEMBERED:
                self._judgements[identity] = judgement
        return judgement

    def _judgement(self, problem: Problem, question: QuestionBase, answer: Given, earlier: Earlier) -> Judgement:
        key = self.prepared.keys[problem.id]
        try:
            with by_processor(self.seconds), ctx.workprec(PRECISION):
                judgement = self._read(question, answer, key, earlier)
            if self.prepared.assignment.feedback == "full" and judgement.status in ("wrong", "partly"):
                return judgement.saying(question.solution(key))
            return judgement
        except OutOfTimeError:
            return needs_review("", "the time limit was reached.")
        except MemoryError:
            raise
        except Exception as error:
            return needs_review("", say("an internal error occurred ({error}).", error=type(error).__name__))

    def _read(self, question: QuestionBase, answer: Given, key: Key, earlier: Earlier) -> Judgement:
        """Return the judgement of all readings of an answer, or that it cannot be read."""
        try:
            readings = question.readings(answer, key.declared)
        except DoubtError as error:
            return replace(needs_review("", error.message), certain=False)
        except TextError as error:
            return self._unread(error, answer)
        understood, certain = shown_text_of(readings), all(reading.certain for reading in readings)
        if self.check_only:
            return Judgement("read", None, understood, certain=certain)
        try:
            judgement = verdict(readings, lambda reading: question.judged(reading, key, earlier))
        except DoubtError as error:
            judgement = needs_review(understood, error.message)
        except TextError as error:  # no scene can hold what it says
            return self._unread(error, answer)
        several = len({reading.text for reading in readings}) > 1
        return replace(judgement, read_as=understood, certain=certain and not several)

    def _number(self, question: QuestionBase, answer: Given, key: Key) -> Fraction | None:
        """Return the number that an answer claims, on which later answers may be based, or None."""
        if not isinstance(question, NumberQuestion):
            return None
        try:
            with by_processor(self.seconds):
                return Fraction(question.readings(answer, key.declared)[0].value)
        except MemoryError:
            raise
        except Exception:  # the judgement says what is wrong with it
            return None

    def _unread(self, error: TextError, answer: Given) -> Judgement:
        """Return the judgement that an answer could not be read, with the column for a text."""
        judgement = unreadable(error if isinstance(answer, str) else TextError(error.message, 1, error.hint))
        return judgement if self.prepared.assignment.unreadable == "review" else replace(judgement, share=NOTHING)


def item_of(
    prepared: Prepared, problem: Problem, question: QuestionBase, judgement: Judgement, answer: Given | None = None
) -> Item:
    """Return the item of one answer in the result."""
    return Item(
        problem=problem.id,
        question=question.id,
        score=_points(judgement.share, question),
        max_score=float(question.points),
        status=judgement.status,
        codes=list(judgement.codes),
        read_as=judgement.read_as,
        feedback=judgement.feedback(prepared.assignment.language),
        column=judgement.column,
        answer=None if answer is None else shown_text(answer),
        variant=prepared.marks.get((problem.id, question.id)),
        certain=judgement.certain,
        readings=[PossibleReading(read_as=r.read_as, score=_points(r.share, question)) for r in judgement.readings],
    )


def _points(share: Fraction | None, question: QuestionBase) -> float | None:
    return None if share is None else float(share * question.points)


_MISSING = Judgement("missing", NOTHING, said=(Said("No answer was given."),))


_NO_PROBLEM = "There is no problem '{word}' ({hint})."
_NO_QUESTION = "There is no question '{word}' ({hint})."


def unasked(prepared: Prepared, submission: Submission) -> Iterator[Item]:
    """Yield items for answers to questions that do not exist: without points, with a hint on the name."""
    asked: dict[str, list[str]] = {}
    for problem, question in prepared.questions():
        asked.setdefault(problem.id, []).append(question.id)
    places = (
        (problem, question)
        for problem, answers in submission.answers.items()
        for question in answers
        if question not in asked.get(problem, ())
    )
    for problem_id, question_id in islice(places, MOST_UNASKED):
        kind, word, names = "question", question_id, asked.get(problem_id)
        if names is None:
            kind, word, names = "problem", problem_id, [*asked]
        hint = suggestion(word, names, f"{kind}s")
        sentence = _NO_PROBLEM if kind == "problem" else _NO_QUESTION
        yield Item(
            problem=problem_id[:LONGEST_NAME], question=question_id[:LONGEST_NAME], score=0.0, max_score=0.0,
            status="unreadable", codes=[], read_as="",
            feedback=in_language(prepared.assignment.language, sentence, word=word[:LONGEST_NAME], hint=hint),
        )  # fmt: skip


def grade(assignment: Any, submission: Any, reviewed: str | os.PathLike[str] | None = None) -> Result:
    """Return the result of one submission: points, status, feedback codes and feedback for every question.

    Parameters
    ----------
    assignment
        A path, a mapping, or the value of `load_assignment`.
    submission
        A path or a mapping.
    reviewed
        A ``review.csv`` that a person filled in; its points replace those that dofkit gives.

    Returns
    -------
    Result
        A submission that cannot be read gives a result with its ``error``.

    Raises
    ------
    AssignmentError, ReviewError
        If the assignment or the table of reviews cannot be read.
    OSError
        If a file does not exist.

    Examples
    --------
    >>> scene = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1"]}
    >>> problem = {"id": "circle", "scene": scene, "questions": [{"id": "f", "ask": "dof", "points": 2}]}
    >>> grade({"title": "One", "problems": [problem]}, {"student": "Ana", "answers": {"circle": {"f": "f = 1"}}}).score
    2.0
    """
    prepared = assignment if isinstance(assignment, Prepared) else load_assignment(assignment)
    if reviewed is not None:
        decided = read_table(Path(reviewed), prepared.most_points()).decisions
        prepared = replace(prepared, decisions={**prepared.decisions, **decided})
    handed = submission if isinstance(submission, Submission) else read_submission(submission, prepared.columns())
    return Grader(prepared).grade(handed)
