"""Results under the names of a roster, and those of which a person has to say whose they are."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping

from dofkit.homework.answers.attribution import by_roster
from dofkit.homework.answers.roster import Roster
from dofkit.homework.answers.sources import Handed
from dofkit.homework.runs.batch import ResultLine


def rostered(
    roster: Roster | None, graded: Iterable[tuple[Handed, list[ResultLine]]]
) -> Iterator[tuple[Handed, list[ResultLine]]]:
    """Everything graded, each result under the name that the roster has for its student, with the doubt there is."""
    for one, lines in graded:
        yield one, lines if roster is None else [_line(roster, one, line) for line in lines]


def _line(roster: Roster, one: Handed, line: ResultLine) -> ResultLine:
    by_default = not isinstance(one.data, Mapping) and line.student == one.name
    student, doubt = by_roster(roster, one.claims, line.student, by_default)
    if (student, doubt) == (line.student, None):
        return line
    said = json.loads(line.text)
    said["student"] = student
    if doubt is not None:
        said["doubt"] = f"{one.place}: {doubt}"
    return ResultLine(
        student, line.failed, json.dumps(said, ensure_ascii=False, separators=(",", ":")), doubt is not None
    )
