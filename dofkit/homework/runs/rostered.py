"""Results under the names of a roster, and those of which a person has to say whose they are."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from dofkit.homework.answers.attribution import Attribution, by_platform, by_roster
from dofkit.homework.answers.roster import Roster
from dofkit.homework.answers.sources import Handed
from dofkit.homework.runs.batch import ResultLine


def rostered(
    roster: Roster | None, graded: Iterable[tuple[Handed, list[ResultLine]]]
) -> Iterator[tuple[Handed, list[ResultLine]]]:
    """Everything graded, each result under the name that the roster has for its student, with the doubt there is.

    Without a roster, or where it does not know them, those are held to it whom the platform says to have handed in.
    """
    for one, lines in graded:
        yield one, [_line(roster, one, line) for line in lines] if roster is not None or one.users else lines


def named_by(roster: Roster, one: Handed) -> Handed:
    """The same under its owner's name, where the roster knows one by the names of its file and folders."""
    owners = roster.owners(_claims(roster, one))
    return replace(one, name=owners[-1].student) if len(owners) == 1 else one


def _claims(roster: Roster, one: Handed) -> tuple[str, ...]:
    """The names that it comes under; a platform's one user by whatever the roster knows of them."""
    user = one.users[0] if len(one.users) == 1 else None
    return (*one.claims, *(name for name in (() if user is None else user.called()) if roster.find(name)))


def _attribution(roster: Roster | None, one: Handed, student: str) -> Attribution:
    """Whose a submission is that names ``student``."""
    inside = isinstance(one.data, Mapping) and "student" in one.data
    by_default = not inside and student == one.name
    claims = () if roster is None else _claims(roster, one)
    if roster is not None and (not one.users or roster.owners(claims)):
        return by_roster(roster, claims, student, by_default)
    named = ", ".join(user.student for user in one.users)
    return Attribution(named, None if by_default else by_platform(one.users, student))


def _line(roster: Roster | None, one: Handed, line: ResultLine) -> ResultLine:
    student, doubt = _attribution(roster, one, line.student)
    if (student, doubt) == (line.student, None):
        return line
    said = json.loads(line.text)
    said["student"] = student
    if doubt is not None:
        said["doubt"] = f"{one.place}: {doubt}"
    return ResultLine(
        student, line.failed, json.dumps(said, ensure_ascii=False, separators=(",", ":")), doubt is not None
    )
