"""Who has a sheet of their own: the students of a varied assignment, as a roster and under the names of one."""

from __future__ import annotations

from dataclasses import replace

from dofkit.homework.answers.roster import Participant, Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.problem import StudentSheet, Variants


def people_of(prepared: Prepared, roster: Roster | None) -> Roster | None:
    """Those whose submissions are told apart: of a roster, each with the names that go with the own sheet, too.

    Without a roster those who have sheets of their own; None where all have the same.
    """
    variants = prepared.assignment.variants
    if variants is None:
        return roster
    if roster is None:
        return Roster(tuple(Participant(one.student, others=one.known_as) for one in variants.students))
    found = [(member, _sheet(variants, member)) for member in roster.members]
    members = (m if one is None else replace(m, others=(one.student, *one.known_as)) for m, one in found)
    return replace(roster, members=tuple(members))


def _sheet(variants: Variants, member: Participant) -> StudentSheet | None:
    """The sheet of somebody in a roster; None for none, and where the names are those of two."""
    names = dict.fromkeys((member.student, *member.called()))
    known = {one.student: one for name in names if (one := variants.find(name)) is not None}
    return next(iter(known.values())) if len(known) == 1 else None


def with_names(prepared: Prepared, roster: Roster | None) -> Prepared:
    """The same, where students are found by all that a roster has of them, too: a course's table may have grown.

    Whose sheet is which stays as it is.
    """
    variants = prepared.assignment.variants
    if variants is None or roster is None:
        return prepared
    more: dict[str, list[str]] = {}
    for member in roster.members:
        if (sheet := _sheet(variants, member)) is not None:
            more[sheet.student] = [member.student, *member.called()]
    students = tuple(_known_as(one, more.get(one.student, ())) for one in variants.students)
    assignment = prepared.assignment.model_copy(
        update={"variants": Variants(seed=variants.seed, version=variants.version, students=students)}
    )
    return replace(prepared, assignment=assignment)


def _known_as(one: StudentSheet, names: list[str] | tuple[()]) -> StudentSheet:
    others = dict.fromkeys((*one.known_as, *(name for name in names if name != one.student)))
    return one.model_copy(update={"known_as": tuple(others)})
