"""A sheet for each student of a roster, in a folder with what grades them and a table of what each one tests."""

from __future__ import annotations

import csv
import os
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from dofkit.base import __version__
from dofkit.base.wording import many
from dofkit.homework.answers.label_words import word_of
from dofkit.homework.answers.roster import Roster
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.earlier_sheets import ASSIGNMENT, VaryError, earlier, followed
from dofkit.homework.formats.cells import cell
from dofkit.homework.formats.html.rendering import rendered
from dofkit.homework.formats.wording import FileNames
from dofkit.homework.handout.figures import Draw
from dofkit.homework.handout.markup import pictures_of
from dofkit.homework.handout.sheets import write_sheet, written_sheet
from dofkit.homework.own_sheets import OwnSheet, SheetDrawer, Variant, structure_told
from dofkit.homework.problem import DRAWN, UNDRAWN, Problem, StudentSheet, Variants
from dofkit.homework.variants.difficulty import Difficulty, difficulty_of, fit
from dofkit.homework.variants.structure import written_scene

#: Sheets that are drawn for a student before one that somebody else has is taken, and how many where that happened to
#: so many before.
MOST_DRAWS, FEWEST_DRAWS, MOST_IN_VAIN = 200, 4, 3
#: What stands in the folder.
TABLE, PAGE, SHEETS = "variants.csv", "variants.html", "sheets"


class VariantRow(NamedTuple):
    """What one problem of one student tests."""

    student: str
    problem: str
    structure: str
    numbers: str
    names: str
    size: str
    labels: str
    traps: str
    verdict: str


@dataclass(frozen=True)
class ClassSheets:
    """The varied assignment, and the sheet of each student; ``gone``: those who are not in the roster any more."""

    prepared: Prepared
    sheets: tuple[tuple[StudentSheet, OwnSheet], ...]
    gone: tuple[str, ...] = ()

    @property
    def rows(self) -> list[VariantRow]:
        """What is told of every problem of every student."""
        return [row_of(whose.student, variant) for whose, sheet in self.sheets for variant in sheet.variants]

    def remarks(self) -> Iterator[str]:
        """What a lecturer should know: problems that are alike for all, and students with the same sheet."""
        for problem in self.prepared.assignment.problems:
            key = self.prepared.keys[problem.id]
            if (why := fit(key, key)) is not None:
                yield f"problem '{problem.id}' is the same for everyone: its own key is {why}"
            elif len({v.mark for _, s in self.sheets for v in s.variants if v.problem.id == problem.id}) == 1:
                yield f"problem '{problem.id}' is the same for everyone: nothing of it can differ as it is written"
        for student in self.gone:
            yield f"'{student}' is not in the roster any more, and keeps the sheet"
        seen: dict[str, str] = {}
        for whose, sheet in self.sheets:
            other = seen.setdefault(sheet.digest, whose.student)
            if other != whose.student:
                yield f"'{whose.student}' and '{other}' have the same sheet: there are too few different ones"


def row_of(student: str, variant: Variant) -> VariantRow:
    """What a problem of a student tests, in words."""
    report = variant.key.report
    size = f"{many(len(variant.key.coordinates), 'coordinate')}, {many(len(report.constraints), 'constraint')}"
    found = difficulty_of(variant.problem, variant.key)
    labels, traps = labels_told(found), ", ".join(sorted(found.traps))
    told = variant.changed or "as given", variant.numbers, variant.names, size
    return VariantRow(student, variant.problem.id, *told, labels, traps, report.verdict)


def labels_told(found: Difficulty) -> str:
    """The right labels of each label that is asked for, and whether there is an integral or something redundant."""
    told = []
    for label in found.labels:
        if isinstance(label, tuple) and isinstance(label[0], str):
            told.append(f"{label[0]}: {'yes' if label[1] else 'no'}")
        elif isinstance(label, tuple):
            told.append(" ".join(word_of(part, bool(holds)) for part, holds in label))
    return "; ".join(told)


def class_sheets(source: str, roster: Roster, seed: str, out: Path, anew: bool = False) -> ClassSheets:
    """A sheet for everyone in a roster, no two alike where there are as many.

    Who has a sheet in the folder ``out`` keeps it, whatever has become of the roster since, unless all are drawn
    ``anew``. Raises AssignmentError, and VaryError for an assignment that was varied before, for a roster of nobody,
    and for a folder with sheets that come out another way.
    """
    given = load_assignment(source)
    if given.assignment.variants is not None:
        raise VaryError(f"{source} was made by `dofkit assignment vary`: vary what it was made from")
    if not roster.members:
        raise VaryError("there is nobody in the roster: a row for each student is needed")
    value = _standing_alone(given, out)
    before = () if anew else earlier(out, value, seed)
    students, gone = followed(before, roster)
    prepared = load_assignment(
        {**value, "variants": {"seed": seed, "students": [one.model_dump() for one in students]}}, base=out
    )
    draws = ClassDraws(SheetDrawer(prepared), seed)
    found = [draws.kept(one) if one.sheet else draws.different(one) for one in students]
    marked = tuple(whose.model_copy(update={"sheet": sheet.digest}) for whose, sheet in found)
    final = Variants(seed=seed, version=__version__, students=marked).model_dump(exclude_defaults=True)
    return ClassSheets(load_assignment({**value, "variants": final}, base=out), tuple(found), gone)


class ClassDraws:
    """Draws the sheets of a class one after the other."""

    def __init__(self, drawer: SheetDrawer, seed: str) -> None:
        self._drawer = drawer
        self._seed = seed
        self._taken: set[str] = set()
        self._in_vain = 0

    def kept(self, whose: StudentSheet) -> tuple[StudentSheet, OwnSheet]:
        """The sheet that a student has. Raises VaryError where it comes out another way."""
        sheet = self._drawer.sheet(self._seed, whose)
        if sheet.digest != whose.sheet:
            raise VaryError(
                f"the sheet of '{whose.student}' comes out another way than it did: vary with the version of dofkit "
                "that made it, name another folder, or draw all sheets anew with --anew"
            )
        self._taken.add(sheet.digest)
        return whose, sheet

    def different(self, whose: StudentSheet) -> tuple[StudentSheet, OwnSheet]:
        """The first draw of a sheet that nobody has; the very first where all are taken.

        Where nothing new came for several students there is little left, and few draws are tried.
        """
        most = MOST_DRAWS if self._in_vain < MOST_IN_VAIN else FEWEST_DRAWS
        first = sheet = self._drawer.sheet(self._seed, whose)
        draw = 0
        while sheet.digest in self._taken and draw < most:
            draw += 1
            whose = whose.model_copy(update={"draw": draw})
            sheet = self._drawer.sheet(self._seed, whose)
        if sheet.digest in self._taken:
            self._in_vain += 1
            return whose.model_copy(update={"draw": 0}), first
        self._in_vain = 0
        self._taken.add(sheet.digest)
        return whose, sheet


def _standing_alone(prepared: Prepared, out: Path) -> dict[str, Any]:
    """The assignment as it may be written in another folder: scenes in place, paths of pictures from there."""
    value = prepared.assignment.model_dump(mode="json", exclude_none=True, exclude_defaults=True)
    value["problems"] = [
        problem.model_dump(mode="json", exclude_none=True)
        | {"scene": written_scene(prepared.keys[problem.id].scene)}
        | _moved(problem, prepared.base, out)
        for problem in prepared.assignment.problems
    ]
    return value


def _moved(problem: Problem, base: Path, out: Path) -> dict[str, str]:
    """The problem's paths, from another folder."""
    found: dict[str, str] = {}
    if problem.figure not in (None, DRAWN, UNDRAWN):
        found["figure"] = os.path.relpath(base / str(problem.figure), out)
    if problem.text is not None and (pictures := pictures_of(problem.text)):
        text = problem.text
        for source in dict.fromkeys(pictures):
            text = text.replace(f"]({source}", f"]({os.path.relpath(base / source, out)}")
        found["text"] = text
    return found


def write_class(made: ClassSheets, form: str, draw: Draw, out: Path) -> None:
    """Write the assignment that grades them, the table, and everyone's sheet. Raises what `write_sheet` does."""
    out.mkdir(parents=True, exist_ok=True)
    assignment = made.prepared.assignment
    value = assignment.model_dump(mode="json", exclude_none=True, exclude_defaults=True)
    written = yaml.safe_dump(value, sort_keys=False, allow_unicode=True, width=110)
    (out / ASSIGNMENT).write_text(written, encoding="utf-8")
    rows = made.rows
    with (out / TABLE).open("w", encoding="utf-8-sig", newline="") as file:
        table = csv.writer(file)
        table.writerow(VariantRow._fields)
        table.writerows([cell(text) for text in row] for row in rows)
    (out / PAGE).write_text(rendered("variants.html", page=_page(made, rows)), encoding="utf-8")
    names = FileNames()
    for whose, sheet in made.sheets:
        told = written_sheet(sheet.prepared, draw, whose.student)
        write_sheet(told, form, out / SHEETS / f"{names.of(whose.student)}.{form}")


def _page(made: ClassSheets, rows: Sequence[VariantRow]) -> dict[str, Any]:
    """What the table's page shows."""
    problems = []
    for problem in made.prepared.assignment.problems:
        marks = [v.mark for _, sheet in made.sheets for v in sheet.variants if v.problem.id == problem.id]
        counts = Counter(map(structure_told, marks)).most_common()
        problems.append({"id": problem.id, "different": len(set(marks)), "structures": counts})
    return {
        "title": made.prepared.assignment.title,
        "students": len(made.sheets),
        "problems": problems,
        "rows": rows,
        "remarks": list(made.remarks()),
    }
