"""Whose each result is, and which of several submissions of one student counts: nobody is displaced.

What a platform or a file's own name confirms goes before what a file only claims.
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
    """A result under the name of its owner, where it was submitted, and whether its owner is confirmed."""

    outcome: Result
    place: str
    confirmed: bool


def named_by(roster: Roster, handed: Handed) -> Handed:
    """Return a submission under its owner's name, if the roster knows one by the names of its file and folders."""
    owners = roster.owners(handed.claims)
    return replace(handed, name=owners[-1].student) if len(owners) == 1 else handed


def owned(roster: Roster | None, handed: Handed, outcome: Result) -> OwnedResult:
    """Return a result under the name of its owner, with the doubt there is."""
    inside = isinstance(handed.data, Mapping) and "student" in handed.data
    by_default = not inside and outcome.student == handed.name
    student, confirmed, doubt = attributed(roster, handed.claims, outcome.student, by_default)
    doubt = outcome.doubt if doubt is None else f"{handed.place}: {doubt}"
    outcome = outcome.model_copy(update={"student": student, "doubt": doubt})
    return OwnedResult(outcome, str(handed.place), confirmed or handed.listed)


def settled(owned_outcomes: Iterable[OwnedResult], roster: Roster | None) -> list[Result]:
    """Return the results in their order; each of a student's but the first is an error that names both places.

    A confirmed submission counts before those that only claim to be the student's. The first keeps its points with a
    doubt if another of the same standing has other answers. A name that looks like another's is a doubt, too, unless
    the roster has it.
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
