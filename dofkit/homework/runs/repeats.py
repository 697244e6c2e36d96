"""Of a student's submissions in one run only the first is graded."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from dofkit.homework.answers.sources import Handed
from dofkit.homework.runs.batch import Orders, ResultLine


def without_repeats(
    orders: Orders, graded: Iterable[tuple[Handed, list[ResultLine]]]
) -> Iterator[tuple[Handed, list[ResultLine]]]:
    """The same, but a student's second submission is refused, and both places are named.

    One of which a person has to say whose it is takes nobody's place.
    """
    first: dict[str, str] = {}
    for one, lines in graded:
        kept = []
        for line in lines:
            place = str(one.place)
            if not (line.failed or line.doubted) and (before := first.setdefault(line.student, place)) != place:
                why = f"{place}: '{line.student}' already submitted in {before}: only the first is graded"
                line = orders.refused(line.student, why)
            kept.append(line)
        yield one, kept
