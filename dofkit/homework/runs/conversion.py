"""Results that are there, written in another format: nothing is graded again."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from pydantic import ValidationError

from dofkit.homework.answers.roster import load_roster
from dofkit.homework.assignment import load_assignment
from dofkit.homework.formats import FORMATS, FormatError
from dofkit.homework.result import Result
from dofkit.homework.runs.review_files import PAGE, TABLE, ReviewPaths, RunReview
from dofkit.homework.runs.run import NATIVE, RESULTS, GradingOptions
from dofkit.homework.sheet_owners import with_names


def convert(assignment: str, results: Path, options: GradingOptions) -> int:
    """Write the results of a run, or those in its folder, in a format; how many there are.

    Raises AssignmentError, RosterError, OSError, and FormatError for what are no results of this assignment.
    """
    form, path = options.format, results / RESULTS if results.is_dir() else results
    if options.out is None or form.name == NATIVE:
        others = ", ".join(name for name in FORMATS if name != NATIVE)
        raise FormatError(f"--format must be one of {others}")
    read = [Path(given).resolve() for given in (assignment, path, options.roster or "")]
    if any(target.resolve() in read for target in options.written):
        raise FormatError(f"--out would overwrite an input file: {options.out}")
    prepared = load_assignment(assignment)
    roster = None if options.roster is None else load_roster(options.roster)
    most = float(sum(prepared.most_points().values()))
    found = list(_results(path, most))
    form.written(iter(found), prepared, options.out, roster)
    if (options.out / PAGE).exists():
        beside = ReviewPaths(path.parent / TABLE, options.out / PAGE, True)
        RunReview.read(prepared, None, beside).write_page(path, with_names(prepared, roster))
    return len(found)


def _results(path: Path, most: float) -> Iterator[Result]:
    with path.open(encoding="utf-8", newline="\n") as lines:
        for number, line in enumerate(lines, 1):
            try:
                result = Result.model_validate_json(line)
            except ValidationError:
                hint = "name the results.jsonl that `dofkit grade ... --out FOLDER` wrote"
                raise FormatError(f"{path}, line {number}: this is not a result of dofkit ({hint})") from None
            if abs(result.max_score - most) > 1e-9:
                raise FormatError(
                    f"{path}, line {number}: this result has {result.max_score:g} points, the assignment "
                    f"{most:g}: run `dofkit grade` again"
                )
            yield result
