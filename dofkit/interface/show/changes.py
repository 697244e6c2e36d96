"""What changes in a report where constraints are dropped, and where it differs from what was expected."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from dofkit.interface.show.report import names_of, number, system_labels
from dofkit.interface.show.sheet import Remark, SheetSection
from dofkit.report import Report

#: An inequality may bound the motion all the same, and so no more is said.
SAME = "no degree of freedom, no count and no label changes"
#: The numbers that are compared, and what they are called.
_NUMBERS = (
    ("degrees of freedom", "dof"),
    ("velocity freedom", "velocity_dof"),
    ("instantaneous freedom", "instantaneous_dof"),
    ("redundant equations", "redundant_equations"),
)


def changed(before: Report, after: Report, names: Sequence[str]) -> SheetSection:
    """Return what changes where the constraints of these names are dropped."""
    told = [*_changes(before, after), *_open(before, after)]
    return SheetSection(f"Without {names_of(names)}", told or [Remark("", SAME)])


def _open(before: Report, after: Report) -> Iterator[Remark]:
    """What is not compared, since it is undecided before or after."""
    unsure = [
        label
        for label, name in (*_NUMBERS, ("consistent", "consistent"))
        if any((found := report.verdicts.get(name)) and found.verdict == "undecided" for report in (before, after))
    ]
    if unsure:
        yield Remark("undecided", f"it is undecided whether these change: {', '.join(unsure)}")


def _changes(before: Report, after: Report) -> Iterator[Remark]:
    for label, name in _NUMBERS:
        was, now = getattr(before, name), getattr(after, name)
        if was != now:
            yield Remark(label, f"{number(was)} -> {number(now)}")
    if before.consistent != after.consistent:
        yield Remark("consistent", f"{_yes(before.consistent)} -> {_yes(after.consistent)}")
    if system_labels(before) != system_labels(after):
        yield Remark("system", f"{system_labels(before)} -> {system_labels(after)}")
    kept = {e.name: e for e in after.constraints}
    for entry in before.constraints:
        now_entry = kept.get(entry.name)
        if now_entry is not None and entry.holonomic != now_entry.holonomic:
            yield Remark(entry.name, f"{_holonomic(entry.holonomic)} -> {_holonomic(now_entry.holonomic)}")


def _yes(value: bool | None) -> str:
    return {True: "yes", False: "no", None: "undecided"}[value]


def _holonomic(value: bool | None) -> str:
    return {True: "holonomic", False: "non-holonomic", None: "undecided"}[value]


def unexpected(missed: Sequence[str]) -> list[SheetSection]:
    """What the scene's own answers say otherwise."""
    return (
        [SheetSection("Differs from what the scene expects", [Remark("!", line) for line in missed])] if missed else []
    )
