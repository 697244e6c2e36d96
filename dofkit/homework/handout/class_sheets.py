"""The sheets of a class: what grades them, who has which variant, and everyone's handout, in one folder."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from dofkit.base.errors import ArgumentError
from dofkit.base.wording import no_such
from dofkit.homework.answers.roster import Roster
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.formats.base import cell
from dofkit.homework.formats.wording import FileNames
from dofkit.homework.handout.markup import Draw
from dofkit.homework.handout.page_sheets import write_page
from dofkit.homework.handout.portable import standing_alone
from dofkit.homework.handout.sheets import write_html, write_markdown
from dofkit.homework.problem import Variants
from dofkit.homework.variants import VaryError, differing_share, drawn, picked, rows_of, sheet_of

#: What the folder contains.
ASSIGNMENT, TABLE, SHEETS = "assignment.yaml", "variants.csv", "sheets"
#: How a sheet is written, by the name of the format, and the endings of files that differ from it.
HANDOUTS: Mapping[str, Callable[[Prepared, Draw, Path, str | None], None]] = {
    "html": write_html,
    "md": write_markdown,
    "page": write_page,
}
ENDINGS = {"page": "html"}
#: The least share of the points whose right answers should differ between two students.
LEAST_DIFFERING = 0.5


@dataclass(frozen=True)
class ClassSheets:
    """The varied assignment as it is written, and who has which variant."""

    prepared: Prepared
    written: Mapping[str, Any]
    variants: Variants

    def remarks(self) -> Iterator[str]:
        """Yield what a lecturer should know before the sheets are handed out."""
        share = differing_share(self.prepared)
        if share < LEAST_DIFFERING:
            yield (
                f"the right answers of two students differ for {100 * share:.0f} % of the points on average: more "
                "values in `vary`, or questions whose answers depend on them, make copying less useful"
            )


def class_sheets(source: str, roster: Roster, seed: str, out: Path) -> ClassSheets:
    """Pick a variant for everyone in a roster.

    Raises AssignmentError, and VaryError for an assignment in which nothing varies and for a roster of nobody.
    """
    prepared = load_assignment(source)
    if prepared.assignment.variants is not None:
        raise VaryError(f"{source} was made by `dofkit assignment vary`: vary what it was made from")
    if not prepared.combinations:
        raise VaryError(f"nothing varies in {source}: write `vary: {{n: [2, 3, 5]}}` in a problem")
    return ClassSheets(prepared, standing_alone(prepared, out), drawn(prepared, roster, seed))


def write_class(made: ClassSheets, form: str, draw: Draw, out: Path) -> None:
    """Write the assignment that grades the class, the table of variants, and every handout."""
    out.mkdir(parents=True, exist_ok=True)
    value = {**made.written, "variants": made.variants.model_dump(mode="json", exclude_defaults=True)}
    written = yaml.safe_dump(value, sort_keys=False, allow_unicode=True, width=110)
    (out / ASSIGNMENT).write_text(written, encoding="utf-8")
    rows = list(rows_of(made.prepared, made.variants))
    counts = Counter((problem, variant) for _, problem, variant, _ in rows)
    with (out / TABLE).open("w", encoding="utf-8-sig", newline="") as file:
        table = csv.writer(file)
        table.writerow(["student", "problem", "variant", "students with it", "right answers"])
        for student, problem, variant, right in rows:
            table.writerow(map(cell, (student, problem, variant, str(counts[problem, variant]), right)))
    sheets = ((member.student, picked(made.prepared, member.picks)) for member in made.variants.students)
    write_sheets(sheets, form, draw, out / SHEETS)


def sheets_of(prepared: Prepared, roster: Roster) -> Iterator[tuple[str, Prepared]]:
    """Yield everyone in a roster with their sheet. Raises NobodysVariantError for one without a variant."""
    for member in roster.members:
        yield member.student, sheet_of(prepared, (member.student, *member.called()))


def write_sheets(sheets: Iterable[tuple[str, Prepared]], form: str, draw: Draw, folder: Path) -> None:
    """Write the sheet of every student into a folder, called after the student. Raises as `write_handout`."""
    names = FileNames()
    for student, sheet in sheets:
        write_handout(sheet, form, draw, folder / f"{names.of(student)}.{ENDINGS.get(form, form)}", student)


def write_handout(prepared: Prepared, form: str, draw: Draw, out: Path, student: str | None = None) -> None:
    """Write a sheet; the folder of ``out`` is made.

    Raises ArgumentError for an unknown format, FigureError, and OSError.
    """
    if form not in HANDOUTS:
        raise ArgumentError(no_such(form, list(HANDOUTS), "format"))
    out.parent.mkdir(parents=True, exist_ok=True)
    HANDOUTS[form](prepared, draw, out, student)
