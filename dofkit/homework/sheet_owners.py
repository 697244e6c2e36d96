"""Who has a sheet of their own: the students of a varied assignment, as a roster and under the names of one."""

from __future__ import annotations

from dataclasses import replace

from dofkit.homework.answers.roster import Participant, Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.problem import StudentSheet, Variants


def sheet_owners(prepared: Prepared) -> Roster | None:
    """Those who have sheets of their own; None where all have the same."""
    variants = prepared.assignment.variants
    if variants is None:
        return None
    return Roster(tuple(Participant(one.student, others=one.known_as) for one in variants.students))


def with_names(prepared: Prepared, roster: Roster | None) -> Prepared:
    """The same, where students are found by all that a roster has of them, too: a course's table may have grown.

    Whose sheet is which stays as it is.
    """
    variants = prepared.assignment.variants
    if variants is None or roster is None:
        return prepared
    more: dict[str, list[str]] = {}
    for member in roster.members:
        names = list(dict.fromkeys([member.student, *member.called()]))
        known = {one.student for name in names if (one := variants.find(name)) is not None}
        if len(known) == 1:
            more[known.pop()] = names
    students = tuple(_known_as(one, more.get(one.student, ())) for one in variants.students)
    assignment = prepared.assignment.model_copy(
        update={"variants": Variants(seed=variants.seed, version=variants.version, students=students)}
    )
    return replace(prepared, assignment=assignment)


def _known_as(one: StudentSheet, names: list[str] | tuple[()]) -> StudentSheet:
    others = dict.fromkeys((*one.known_as, *(name for name in names if name != one.student)))
    return one.model_copy(update={"known_as": tuple(others)})
