"""Whose each result is, and what becomes of several submissions of one student: nobody is displaced.

What a platform or a file's own name confirms goes before what a file only claims. Of confirmed submissions that differ
the later one counts where the platform's table has times; otherwise a person has to decide between them.
"""

from __future__ import annotations

import hashlib
import json
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from dofkit.homework.answers.roster import Roster, attributed
from dofkit.homework.answers.sources import Handed
from dofkit.homework.result import one_line
from dofkit.homework.runs.batch import Orders, ResultLine


@dataclass(frozen=True)
class OwnedLine:
    """A result's line, where it was submitted, whether its owner is confirmed, and a digest of its answers."""

    line: ResultLine
    place: str
    confirmed: bool
    digest: bytes
    order: int | None = None


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
    said = json.loads(line.text)
    given = [(item["problem"], item["question"], item.get("answer")) for item in said["items"]]
    digest = hashlib.blake2b(repr(given).encode("utf-8", "surrogatepass"), digest_size=16).digest()
    if (student, doubt) != (line.student, None):
        line = _changed(said, line, student, None if doubt is None else f"{one.place}: {doubt}")
    return OwnedLine(line, str(one.place), confirmed or one.listed, digest, one.order)


def _changed(said: dict[str, Any], line: ResultLine, student: str, doubt: str | None) -> ResultLine:
    said["student"] = student
    if doubt is not None:
        said["doubt"] = doubt
    text = one_line(json.dumps(said, ensure_ascii=False, separators=(",", ":")))
    return ResultLine(student, line.failed, text, doubt is not None or line.doubted)


def settled(orders: Orders, lines: Iterable[OwnedLine]) -> list[ResultLine]:
    """Return the lines in their order, at most one of each student without a doubt or an error."""
    found = list(lines)
    of_student: defaultdict[str, list[int]] = defaultdict(list)
    for n, one in enumerate(found):
        if not (one.line.failed or one.line.doubted):
            of_student[one.line.student].append(n)
    result = [one.line for one in found]
    for student, numbers in of_student.items():
        for n, (why, refused) in _conflicts(student, [found[n] for n in numbers]).items():
            place = numbers[n]
            if refused:
                result[place] = orders.refused(student, why)
            else:
                line = found[place].line
                result[place] = _changed(json.loads(line.text), line, student, why)
    return result


def _conflicts(student: str, lines: Sequence[OwnedLine]) -> dict[int, tuple[str, bool]]:
    """Return, of several submissions of a student, why those that do not count do not, and whether that is certain."""
    if len(lines) == 1:
        return {}
    confirmed = [n for n, one in enumerate(lines) if one.confirmed]
    rivals = confirmed or list(range(len(lines)))
    chosen = _latest(lines, rivals)
    found: dict[int, tuple[str, bool]] = {}
    for n, one in enumerate(lines):
        if n == chosen:
            continue
        other = lines[rivals[0] if chosen is None else chosen]
        if n in rivals and chosen is None:
            other = lines[next(m for m in rivals if m != n)]
            why = f"{one.place}: '{student}' also submitted {other.place}: a person has to decide which counts"
            found[n] = (why, False)
        elif one.digest == other.digest or n in rivals:
            found[n] = (f"{one.place}: '{student}' also submitted {other.place}, which counts", True)
        else:
            found[n] = (
                f"{one.place}: it claims to be '{student}'s, whose own submission is {other.place}: a person has to "
                "decide whose it is", False,
            )  # fmt: skip
    return found


def _latest(lines: Sequence[OwnedLine], rivals: Sequence[int]) -> int | None:
    """Return which of several submissions counts: the only one, the latest in one table, or one of equal ones."""
    if len({lines[n].digest for n in rivals}) == 1:
        return rivals[0]
    tables = {lines[n].place.rpartition(", line")[0] for n in rivals}
    if len(tables) == 1 and all(lines[n].order is not None for n in rivals):
        return max(rivals, key=lambda n: lines[n].order or 0)
    return None
