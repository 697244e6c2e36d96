"""Whose each result is, and which of several submissions of one student counts: nobody is displaced.

What a platform or a file's own name confirms goes before what a file only claims.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from dofkit.homework.answers.roster import Roster, attributed
from dofkit.homework.answers.sources import Handed
from dofkit.homework.result import one_line
from dofkit.homework.runs.batch import Orders, ResultLine


@dataclass(frozen=True)
class OwnedLine:
    """A result's line, where it was submitted, and whether its owner is confirmed."""

    line: ResultLine
    place: str
    confirmed: bool


def named_by(roster: Roster, one: Handed) -> Handed:
    """Return a submission under its owner's name, if the roster knows one by the names of its file and folders."""
    user = one.users[0] if len(one.users) == 1 else None
    more = () if user is None else tuple(name for name in user.called() if roster.find(name))
    owners = roster.owners((*one.claims, *more))
    return replace(one, name=owners[-1].student) if len(owners) == 1 else one


def owned(roster: Roster | None, one: Handed, lines: Sequence[ResultLine]) -> list[OwnedLine]:
    """Return the lines of one place under the names of their owners, with the doubt there is."""
    return [_owned(roster, one, line) for line in lines]


def _owned(roster: Roster | None, one: Handed, line: ResultLine) -> OwnedLine:
    inside = isinstance(one.data, Mapping) and "student" in one.data
    by_default = not inside and line.student == one.name
    student, confirmed, doubt = attributed(roster, one.claims, one.users, line.student, by_default)
    if (student, doubt) != (line.student, None):
        line = _changed(line, student, None if doubt is None else f"{one.place}: {doubt}")
    return OwnedLine(line, str(one.place), confirmed or one.listed)


def _changed(line: ResultLine, student: str, doubt: str | None) -> ResultLine:
    said = json.loads(line.text)
    said["student"] = student
    if doubt is not None:
        said["doubt"] = doubt
    text = one_line(json.dumps(said, ensure_ascii=False, separators=(",", ":")))
    return ResultLine(student, line.failed, text, doubt is not None or line.doubted)


def settled(orders: Orders, lines: Iterable[OwnedLine]) -> list[ResultLine]:
    """Return the lines in their order; every submission of a student but the first is an error that names both places.

    A confirmed submission counts before those that only claim to be the student's. The first keeps its points with a
    doubt if another of the same standing has other answers.
    """
    submitted = list(lines)
    of_student: defaultdict[str, list[int]] = defaultdict(list)
    for n, one in enumerate(submitted):
        if not (one.line.failed or one.line.doubted):
            of_student[one.line.student].append(n)
    result = [one.line for one in submitted]
    for student, numbers in of_student.items():
        first, *others = sorted(numbers, key=lambda n: not submitted[n].confirmed)
        counted = submitted[first]
        for other in (submitted[n] for n in reversed(others)):
            if other.confirmed == counted.confirmed and other.line.text != counted.line.text:
                why = f"{counted.place}: '{student}' also submitted {other.place}: a person has to decide which counts"
                result[first] = _changed(counted.line, student, why)
        for n in others:
            why = f"{submitted[n].place}: '{student}' also submitted {counted.place}: only that submission is graded"
            result[n] = orders.refused(student, why)
    return result
