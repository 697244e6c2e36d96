"""The commands `assignment` and `export`: first assignments, handouts, variants, and files for course platforms."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from dofkit.base.wording import format_of_path
from dofkit.interface import options
from dofkit.interface.output import failures_of

assignment_app = typer.Typer(
    help="Write assignments, handouts and a variant per student.", no_args_is_help=True, rich_markup_mode="rich"
)
export_app = typer.Typer(help="Export assignments for course platforms.", no_args_is_help=True, rich_markup_mode="rich")

Runtime = Annotated[
    Path | None,
    typer.Option(
        "--runtime", metavar="FILE", help="The runtime.js of a bench, for pages with fields; by default of this clone."
    ),
]


@assignment_app.command("new")
def new(
    scenes: Annotated[list[str], typer.Argument(metavar="SCENE...", help="Scenes: paths or catalog names.")],
) -> None:
    """Print a first assignment with a question of each kind that fits the scenes."""
    with failures_of(None):
        from dofkit.homework.starting import starting

        typer.echo(starting(scenes), nl=False)


@assignment_app.command("handout")
def handout(
    assignment: options.Assignment,
    form: Annotated[
        str | None,
        typer.Option("--format", metavar="NAME", help="html (default), md, or page: with a field for each answer."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="PATH", help="The file, whose ending decides the format; with --roster a folder."
        ),
    ] = None,
    student: Annotated[
        str | None, typer.Option("--student", metavar="NAME", help="The student whose sheet is written.")
    ] = None,
    roster: Annotated[
        Path | None, typer.Option("--roster", metavar="TABLE.csv", help="Write a sheet for everyone in the course.")
    ] = None,
    runtime: Runtime = None,
) -> None:
    """Write the handout for students, with pictures and notation.

    It states the problems, the names and how answers are written. A `page`
    shows how each answer is read as it is typed, and saves the file to submit.
    """
    from dofkit.homework.answers.roster import load_roster
    from dofkit.homework.assignment import load_assignment
    from dofkit.homework.handout.class_sheets import write_handout, write_sheets
    from dofkit.homework.handout.sheets import remarks
    from dofkit.homework.variants import first_variant, sheet_of

    with failures_of(assignment):
        prepared = load_assignment(assignment)
        if roster is not None:
            form, target = form or "html", out or Path(assignment).with_suffix("")
            write_sheets(prepared, load_roster(roster), form, drawing(), target)
        else:
            form, target = handout_file(Path(assignment), form, out)
            sheet = first_variant(prepared) if student is None else sheet_of(prepared, student)
            write_handout(sheet, form, drawing(), target, student)
    for remark in remarks(prepared, is_preview=student is None and roster is None):
        typer.echo(f"{assignment}: {remark}", err=True)
    with_runtime(form, target if roster else target.parent, runtime)
    typer.echo(target)


def handout_file(assignment: Path, form: str | None, out: Path | None) -> tuple[str, Path]:
    """Return (format, path) of a handout; without a format the path's extension decides. Raises BadParameter."""
    from dofkit.homework.handout.class_sheets import ENDINGS

    ending = ENDINGS.get(form or "html", form or "html")
    if out is not None:
        ending = format_of_path(out, ("html", "md"), ending if form else None)
    path = assignment.with_suffix(f".{ending}") if out is None else out
    if path.resolve() == assignment.resolve():
        raise typer.BadParameter("it would overwrite the assignment", param_hint="--out")
    return form or ending, path


def with_runtime(form: str, folder: Path, runtime: Path | None) -> None:
    """Copy the script that reads answers beside pages with fields; if it is missing, print why."""
    from dofkit.homework.handout.page_sheets import BUILT, RuntimeMissingError, put_runtime

    if form == "page":
        try:
            put_runtime(folder, runtime or BUILT)
        except RuntimeMissingError as error:
            typer.echo(error, err=True)


@assignment_app.command("practice")
def practice(
    assignment: options.Assignment,
    out: Annotated[Path, typer.Option("--out", metavar="FOLDER", callback=options.folder, help="The folder to write.")],
    runtime: Runtime = None,
) -> None:
    """Write a practice sheet: a page that reads answers as they are typed, and judges them on request.

    Nothing leaves the browser, and the source of the page contains the key.
    """
    from dofkit.homework.assignment import load_assignment
    from dofkit.homework.handout.page_sheets import BUILT, put_runtime, write_page
    from dofkit.homework.variants import first_variant

    with failures_of(assignment):
        prepared = first_variant(load_assignment(assignment))
        put_runtime(out, runtime or BUILT)
        write_page(prepared, drawing(), out / "index.html", judges=True)
    typer.echo(out / "index.html")


@assignment_app.command("template")
def template(
    assignment: options.Assignment,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="PATH", callback=options.file_of("yaml", "csv"), help="A .yaml or .csv file."),
    ] = None,
) -> None:
    """Print or write an empty submission for students to fill in."""
    from dofkit.homework.assignment import load_assignment
    from dofkit.homework.starting import template as empty

    with failures_of(assignment):
        text = empty(load_assignment(assignment), "yaml" if out is None else out.suffix[1:])
        if out is None:
            typer.echo(text, nl=False)
        else:
            out.write_text(text, encoding="utf-8")


@assignment_app.command("vary")
def vary(
    assignment: options.Assignment,
    roster: Annotated[Path, typer.Option("--roster", metavar="TABLE.csv", help="The students of the course.")],
    seed: Annotated[str, typer.Option("--seed", metavar="TEXT", help="The seed of the variants: keep it.")],
    out: Annotated[Path, typer.Option("--out", metavar="FOLDER", callback=options.folder, help="The folder to write.")],
) -> None:
    """Pick a variant for every student.

    A problem lists what varies (`vary: {n: [2, 3, 5]}`); every combination is
    proved, and a keyed hash picks one for each student. The folder gets an
    `assignment.yaml` for all, for `assignment handout --roster TABLE.csv` and
    `grade`, and a table of the variants. With the same seed everyone keeps
    their variant when the roster changes.
    """
    from dofkit.homework.answers.roster import load_roster
    from dofkit.homework.assignment import load_assignment
    from dofkit.homework.handout.class_sheets import ASSIGNMENT, write_variants
    from dofkit.homework.variants import LEAST_DIFFERING, differing_share, new_variants

    with failures_of(assignment):
        prepared = load_assignment(assignment)
        variants = new_variants(prepared, load_roster(roster), seed)
        write_variants(prepared, variants, out)
    if (share := differing_share(prepared)) < LEAST_DIFFERING:
        remark = (
            f"the right answers of two students differ for {100 * share:.0f} % of the points on average: more values "
            "in `vary`, or questions whose answers depend on them, make copying less useful"
        )
        typer.echo(f"{assignment}: {remark}", err=True)
    typer.echo(f"{out / ASSIGNMENT}: the variants of {len(variants.students)} students")


def drawing() -> Callable[[Any, Any, str], str | None]:
    """Return the function (scene, report, title) -> SVG or None that draws a scene for a handout."""
    from dofkit.pictures.still import unanswered

    def draw(scene: Any, report: Any, title: str) -> str | None:
        picture = unanswered(scene, report, title)
        return None if picture is None else picture.svg()

    return draw


@export_app.command("gradescope")
def export_gradescope(
    assignment: options.Assignment,
    out: Annotated[
        Path, typer.Option("--out", metavar="PATH", callback=options.file_of("zip"), help="The zip to upload.")
    ] = Path("autograder.zip"),
    reviewed: options.ReviewTable = None,
) -> None:
    """Write a Gradescope autograder as one zip to upload."""
    from dofkit.homework import export

    with failures_of(assignment):
        export.export_gradescope(assignment, out, reviewed)
