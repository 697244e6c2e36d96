"""Whose a submission is: the names of its file, the platform's user, and the ``student`` it names must agree.

They need only agree where a roster or a platform knows them. Where they do not, nobody gains or loses a submission by
it: it is kept with both names, for a person to look at, and takes no one's place.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from dofkit.homework.answers.roster import Participant, Roster


class Attribution(NamedTuple):
    """``student``: what the result calls the one who handed in. ``doubt``: why a person has to look; else None."""

    student: str
    doubt: str | None = None


def by_roster(roster: Roster, claims: Sequence[str], student: str, by_default: bool = False) -> Attribution:
    """Whose it is by a roster; ``claims``: the names of its file and folders; ``student``: whom it names.

    ``by_default``: it names nobody, and ``student`` stands for that. One whom the roster does not know keeps the name.
    Of several owners the outermost is taken: platforms name folders.
    """
    named, owners = roster.find(student), roster.owners(claims)
    if not owners:
        return Attribution(student if named is None else named.student)
    owner = owners[-1]
    if len(owners) > 1:
        return Attribution(owner.student, doubt_of(owner.student, owners[0].student))
    by_default = by_default or student in claims
    if named is owner or (named is None and (by_default or owner.goes_by(student))):
        return Attribution(owner.student)
    return Attribution(owner.student, doubt_of(owner.student, student))


def by_platform(users: Sequence[Participant], student: str) -> str | None:
    """Why a person has to look at what users handed in, which names ``student``; None where they agree."""
    if not users or not student or any(user.goes_by(student) for user in users):
        return None
    return doubt_of(", ".join(user.student for user in users), student)


def doubt_of(owner: str, student: str) -> str:
    """What is said of a submission that names somebody else."""
    return f"it was submitted as {owner}'s, but names '{student}' as its student: a person has to decide whose it is"
