"""The sheets of a class: what grades them, who has which variant, and everyone's handout, in one folder."""

from __future__ import annotations

import csv
import os
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from dofkit.base.documents import read_document
from dofkit.homework.answers.roster import Roster
from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.formats.base import cell
from dofkit.homework.formats.wording import FileNames
from dofkit.homework.handout.markup import Draw, pictures_of
from dofkit.homework.handout.sheets import write_sheet, written_sheet
from dofkit.homework.problem import DRAWN, UNDRAWN, Problem, Variants
from dofkit.homework.variants import VaryError, differing_share, drawn, picked, rows_of

#: What the folder contains.
ASSIGNMENT, TABLE, SHEETS = "assignment.yaml", "variants.csv", "sheets"
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


def standing_alone(prepared: Prepared, out: Path) -> dict[str, Any]:
    """Return the assignment as it may be written in another folder: scenes in place, paths of pictures from there."""
    value = prepared.assignment.model_dump(mode="json", exclude_none=True, exclude_defaults=True)
    value["problems"] = [
        problem.model_dump(mode="json", exclude_none=True)
        | {"scene": _scene(problem, prepared)}
        | _moved(problem, prepared.base, out)
        for problem in prepared.assignment.problems
    ]
    return value


def _scene(problem: Problem, prepared: Prepared) -> Any:
    """Return the scene in place: one that varies with its places, any other as it was read."""
    if isinstance(problem.scene, dict):
        return problem.scene
    if problem.vary:
        path = prepared.base / problem.scene
        return read_document(path.read_bytes(), str(path)).value
    scene = prepared.keys[problem.id].scene.model_dump(mode="json", exclude_none=True)
    return {key: value for key, value in scene.items() if value not in ([], {}) and key != "expect"}


def _moved(problem: Problem, base: Path, out: Path) -> dict[str, str]:
    """Return the problem's paths, from another folder."""
    moved: dict[str, str] = {}
    if problem.figure not in (None, DRAWN, UNDRAWN):
        moved["figure"] = os.path.relpath(base / str(problem.figure), out)
    if problem.text is not None and (pictures := pictures_of(problem.text)):
        text = problem.text
        for source in dict.fromkeys(pictures):
            text = text.replace(f"]({source}", f"]({os.path.relpath(base / source, out)}")
        moved["text"] = text
    return moved


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
    names = FileNames()
    for member in made.variants.students:
        sheet = written_sheet(picked(made.prepared, member.picks), draw, member.student)
        write_sheet(sheet, form, out / SHEETS / f"{names.of(member.student)}.{form}")
