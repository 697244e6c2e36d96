"""Assigns results to students, and decides which of several submissions of one student counts.

Platforms and file names are trusted more than the ``student`` in a file, so that nobody can replace another's result.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import NamedTuple

from dofkit.homework.answers.roster import Roster, attributed, lookalike
from dofkit.homework.answers.sources import Handed
from dofkit.homework.result import Result


class OwnedResult(NamedTuple):
    """A result with the student's name, the place of its file, and whether a platform or name confirms the student."""

    outcome: Result
    place: str
    confirmed: bool


def named_by(roster: Roster, handed: Handed) -> Handed:
    """Return a submission with the student's name if the names of its file and folders identify one in the roster."""
    owners = roster.owners(handed.claims)
    return replace(handed, name=owners[-1].student) if len(owners) == 1 else handed


def owned(roster: Roster | None, handed: Handed, outcome: Result) -> OwnedResult:
    """Return a result with the student to whom it belongs, and the doubt about it."""
    inside = isinstance(handed.data, Mapping) and "student" in handed.data
    by_default = not inside and outcome.student == handed.name
    student, confirmed, doubt = attributed(roster, handed.claims, outcome.student, by_default)
    doubt = outcome.doubt if doubt is None else f"{handed.place}: {doubt}"
    outcome = outcome.model_copy(update={"student": student, "doubt": doubt})
    return OwnedResult(outcome, str(handed.place), confirmed or handed.listed)


def settled(owned_outcomes: Iterable[OwnedResult], roster: Roster | None) -> list[Result]:
    """Return the results in their order; of several of one student only one counts, the others are errors.

    A confirmed submission counts before unconfirmed ones, otherwise the first. It gets a doubt if another one, equally
    confirmed, has a different result. A name that looks like another name also gives a doubt, unless it is in the
    roster.
    """
    submitted = list(owned_outcomes)
    of_student: defaultdict[str, list[int]] = defaultdict(list)
    for n, (outcome, _, _) in enumerate(submitted):
        if outcome.error is None and outcome.doubt is None:
            of_student[outcome.student].append(n)
    result = [submission.outcome for submission in submitted]
    for student, numbers in of_student.items():
        first, *others = sorted(numbers, key=lambda n: not submitted[n].confirmed)
        counted = submitted[first]
        for other in (submitted[n] for n in reversed(others)):
            if other.confirmed == counted.confirmed and other.outcome != counted.outcome:
                why = f"{counted.place}: '{student}' also submitted {other.place}: a person has to decide which counts"
                result[first] = counted.outcome.model_copy(update={"doubt": why})
        for n in others:
            why = f"{submitted[n].place}: '{student}' also submitted {counted.place}: only that submission is graded"
            result[n] = Result.refused(student, counted.outcome.max_score, why)
    alike = defaultdict[str, set[str]](set)
    for student in (*of_student, *(member.student for member in ([] if roster is None else roster.members))):
        alike[lookalike(student)].add(student)
    for n, outcome in enumerate(result):
        twins = sorted(alike[lookalike(outcome.student)] - {outcome.student})
        unknown = roster is None or roster.find(outcome.student) is None
        if twins and unknown and outcome.error is None and outcome.doubt is None:
            why = f"the name '{outcome.student}' looks like '{twins[0]}': a person has to decide whose it is"
            result[n] = outcome.model_copy(update={"doubt": f"{submitted[n].place}: {why}"})
    return result
