"""The sheets of a class: the assignment with variants, the table of variants, and a handout for each student."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from pathlib import Path

import yaml

from dofkit.base.errors import ArgumentError
from dofkit.base.wording import no_such
from dofkit.homework.answers.roster import Roster
from dofkit.homework.assignment import Prepared
from dofkit.homework.formats.base import cell
from dofkit.homework.formats.wording import FileNames
from dofkit.homework.handout.markup import Draw
from dofkit.homework.handout.page_sheets import write_page
from dofkit.homework.handout.portable import standing_alone
from dofkit.homework.handout.sheets import write_html, write_markdown
from dofkit.homework.problem import Variants
from dofkit.homework.variants import rows_of, sheet_of

#: The files of a class with variants.
ASSIGNMENT, TABLE = "assignment.yaml", "variants.csv"
#: {format: function that writes a sheet}, and {format: file extension} if the two differ.
HANDOUTS: Mapping[str, Callable[[Prepared, Draw, Path, str | None], None]] = {
    "html": write_html,
    "md": write_markdown,
    "page": write_page,
}
ENDINGS = {"page": "html"}


def write_variants(prepared: Prepared, variants: Variants, out: Path) -> None:
    """Write the assignment with the variants, by which the class is graded, and the table of variants and answers."""
    out.mkdir(parents=True, exist_ok=True)
    value = standing_alone(prepared, out) | {"variants": variants.model_dump(mode="json", exclude_defaults=True)}
    written = yaml.safe_dump(value, sort_keys=False, allow_unicode=True, width=110)
    (out / ASSIGNMENT).write_text(written, encoding="utf-8")
    with (out / TABLE).open("w", encoding="utf-8-sig", newline="") as file:
        table = csv.writer(file)
        table.writerow(["student", "problem", "variant", "right answers"])
        table.writerows(map(cell, row) for row in rows_of(prepared, variants))


def write_sheets(prepared: Prepared, roster: Roster, form: str, draw: Draw, folder: Path) -> None:
    """Write the sheet of each student of a roster to a folder, under the student's name.

    Raises NobodysVariantError for a student without a variant, and the errors of `write_handout`.
    """
    names = FileNames()
    for member in roster.members:
        sheet = sheet_of(prepared, (member.student, *member.called()))
        path = folder / f"{names.of(member.student)}.{ENDINGS.get(form, form)}"
        write_handout(sheet, form, draw, path, member.student)


def write_handout(prepared: Prepared, form: str, draw: Draw, out: Path, student: str | None = None) -> None:
    """Write a sheet to ``out``, whose folder is created.

    Raises ArgumentError for an unknown format, FigureError, and OSError.
    """
    if form not in HANDOUTS:
        raise ArgumentError(no_such(form, list(HANDOUTS), "format"))
    out.parent.mkdir(parents=True, exist_ok=True)
    HANDOUTS[form](prepared, draw, out, student)
