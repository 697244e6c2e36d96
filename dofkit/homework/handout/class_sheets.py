"""The sheets of a class: the assignment that grades them, who has which variant, and everyone's handout."""

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
#: How a sheet is written, by the name of the format, and the endings of files that differ from it.
HANDOUTS: Mapping[str, Callable[[Prepared, Draw, Path, str | None], None]] = {
    "html": write_html,
    "md": write_markdown,
    "page": write_page,
}
ENDINGS = {"page": "html"}


def write_variants(prepared: Prepared, variants: Variants, out: Path) -> None:
    """Write the assignment that grades the class, and the table of variants with their right answers."""
    out.mkdir(parents=True, exist_ok=True)
    value = standing_alone(prepared, out) | {"variants": variants.model_dump(mode="json", exclude_defaults=True)}
    written = yaml.safe_dump(value, sort_keys=False, allow_unicode=True, width=110)
    (out / ASSIGNMENT).write_text(written, encoding="utf-8")
    with (out / TABLE).open("w", encoding="utf-8-sig", newline="") as file:
        table = csv.writer(file)
        table.writerow(["student", "problem", "variant", "right answers"])
        table.writerows(map(cell, row) for row in rows_of(prepared, variants))


def write_sheets(prepared: Prepared, roster: Roster, form: str, draw: Draw, folder: Path) -> None:
    """Write the sheet of everyone in a roster into a folder, called after the student.

    Raises NobodysVariantError for one without a variant, and as `write_handout`.
    """
    names = FileNames()
    for member in roster.members:
        sheet = sheet_of(prepared, (member.student, *member.called()))
        path = folder / f"{names.of(member.student)}.{ENDINGS.get(form, form)}"
        write_handout(sheet, form, draw, path, member.student)


def write_handout(prepared: Prepared, form: str, draw: Draw, out: Path, student: str | None = None) -> None:
    """Write a sheet; the folder of ``out`` is made.

    Raises ArgumentError for an unknown format, FigureError, and OSError.
    """
    if form not in HANDOUTS:
        raise ArgumentError(no_such(form, list(HANDOUTS), "format"))
    out.parent.mkdir(parents=True, exist_ok=True)
    HANDOUTS[form](prepared, draw, out, student)
