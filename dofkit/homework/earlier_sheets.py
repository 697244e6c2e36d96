"""Sheets that students of a class have already: nobody's changes when the roster does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from dofkit.base.documents import read_document
from dofkit.base.errors import DofkitError
from dofkit.homework.answers.roster import Participant, Roster
from dofkit.homework.assignment import Assignment
from dofkit.homework.problem import StudentSheet, Variants, plain_name

#: What grades a class, in its folder.
ASSIGNMENT = "assignment.yaml"


class VaryError(DofkitError):
    """An assignment that cannot be varied."""


def earlier(out: Path, value: Mapping[str, Any], seed: str) -> tuple[StudentSheet, ...]:
    """Whose sheet is which in a folder; nobody's in a new one. ``value``: the assignment to vary.

    Raises VaryError where the sheets were made of another assignment or from another seed.
    """
    path = out / ASSIGNMENT
    if not path.exists():
        return ()
    found = read_document(path.read_bytes(), str(path)).value
    variants = found.get("variants") if isinstance(found, Mapping) else None
    if not isinstance(found, Mapping) or not isinstance(variants, Mapping):
        raise VaryError(f"{path} is no assignment of sheets for a class: name another folder")
    known = Variants.model_validate(variants)
    of_another = _assignment(found) != _assignment(value)
    if of_another or known.seed != str(seed):
        what = "of another assignment" if of_another else f"from another seed, '{known.seed}'"
        raise VaryError(
            f"{out} holds sheets {what}, and students may have them: name another folder, or draw all sheets anew "
            "with --anew"
        )
    return known.students


def _assignment(value: Mapping[str, Any]) -> Assignment | None:
    """What is asked; None where that is no assignment."""
    try:
        return Assignment.model_validate({**value, "variants": None})
    except ValidationError:
        return None


def followed(before: Sequence[StudentSheet], roster: Roster) -> tuple[tuple[StudentSheet, ...], tuple[str, ...]]:
    """Those who have a sheet, then the others of a roster; and who of them are not in the roster any more.

    Raises VaryError where two in the roster go by the names of one the students.
    """
    known = Variants(seed="-", version="", students=tuple(before))
    heirs: dict[str, Participant] = {}
    fresh: list[StudentSheet] = []
    for member in roster.members:
        names = list(dict.fromkeys([member.student, *member.called()]))
        found = {one.student for name in names if (one := known.find(name)) is not None}
        if len(found) > 1 or (found and found & set(heirs)):
            raise VaryError(
                f"'{member.student}' goes by the names of {' and '.join(sorted(found))}: whose sheet is it? Give "
                "everyone in the roster an address or a number of their own"
            )
        if found:
            heirs[found.pop()] = member
        else:
            fresh.append(StudentSheet.model_validate({"student": member.student, "known_as": names[1:]}))
    kept = tuple(_named(one, heirs.get(one.student)) for one in before)
    _told_apart([*kept, *fresh])
    return (*kept, *fresh), tuple(one.student for one in before if one.student not in heirs)


def _named(one: StudentSheet, member: Participant | None) -> StudentSheet:
    """The same under the names that a roster has, too."""
    names = () if member is None else (member.student, *member.called())
    others = dict.fromkeys((*one.known_as, *(name for name in names if name != one.student)))
    return one.model_copy(update={"known_as": tuple(others)})


def _told_apart(students: Sequence[StudentSheet]) -> None:
    """Raise VaryError where two are called the same."""
    seen: set[str] = set()
    for one in students:
        if plain_name(one.student) in seen:
            raise VaryError(f"two students are called '{one.student}': give them addresses or numbers in the roster")
        seen.add(plain_name(one.student))
