"""The commands about assignments: a first one over scenes, the sheet that students get, and one for each student."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from dofkit.base.surface import handed_on
from dofkit.interface import options
from dofkit.interface.failures import failures_of

#: What is imported only where a command needs it.
_HOMES = {
    "class_sheets": "dofkit.homework.class_sheets",
    "load_roster": "dofkit.homework.answers.roster",
    "own": "dofkit.homework.own_sheets",
    "write_class": "dofkit.homework.class_sheets",
    "HANDOUTS": "dofkit.homework.handout.sheets",
    "load_assignment": "dofkit.homework.assignment",
    "remarks": "dofkit.homework.handout.sheets",
    "starting": "dofkit.homework.starting",
    "unanswered": "dofkit.pictures.unanswered",
    "write_sheet": "dofkit.homework.handout.sheets",
    "written_sheet": "dofkit.homework.handout.sheets",
}


def _of(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)


assignment_app = typer.Typer(
    help="Write assignments, and the sheets that students get.", no_args_is_help=True, rich_markup_mode=None
)


@assignment_app.command("new")
def new(
    scenes: Annotated[list[str], typer.Argument(metavar="SCENE...", help="Paths or catalog names.")],
    every: Annotated[bool, typer.Option("--all", help="All the questions that the scenes can be asked.")] = False,
) -> None:
    """Print a starting assignment: of each scene the five questions most worth asking."""
    with failures_of(None):
        typer.echo(_of("starting")(scenes, every), nl=False)


@assignment_app.command("handout")
def handout(
    assignment: options.Assignment,
    form: Annotated[str, typer.Option("--format", metavar="NAME", help="html, pdf, tex or md.")] = "html",
    out: Annotated[
        Path | None, typer.Option("--out", metavar="PATH", help="The file; by default beside the assignment.")
    ] = None,
    student: Annotated[
        str | None, typer.Option("--student", metavar="NAME", help="Whose sheet, where everyone has another.")
    ] = None,
) -> None:
    """Write the sheet that students get: problems, pictures, names, how to write answers; it tells no answer."""
    with failures_of(assignment):
        prepared = _of("load_assignment")(assignment)
        target = Path(assignment).with_suffix(f".{form}") if out is None else out
        if target.resolve() == Path(assignment).resolve():
            raise typer.BadParameter("it would overwrite the assignment", param_hint="--out")
        if student is not None:
            prepared = _of("own")(prepared, student)
        _of("write_sheet")(_of("written_sheet")(prepared, drawing(), student), form, target)
    for remark in _of("remarks")(prepared):
        typer.echo(f"{assignment}: {remark}", err=True)
    typer.echo(target)


@assignment_app.command("vary")
def vary(
    assignment: options.Assignment,
    roster: Annotated[Path, typer.Option("--roster", metavar="TABLE.csv", help="Who is in the course.")],
    seed: Annotated[str, typer.Option("--seed", metavar="TEXT", help="What the sheets are made from: keep it.")],
    out: Annotated[Path, typer.Option("--out", metavar="FOLDER", help="Where everything goes.")],
    form: Annotated[
        str, typer.Option("--format", metavar="NAME", help="Of the sheets: html, pdf, tex or md.")
    ] = "html",
    anew: Annotated[bool, typer.Option("--anew", help="Draw all sheets again, though the folder has some.")] = False,
) -> None:
    """Write a sheet for each student, equally hard, an assignment that grades them all, and a table of what differs.

    `dofkit grade FOLDER/assignment.yaml ...` finds everyone's own variant from the seed. The same seed gives a student
    the same sheet everywhere; every key is proved. Who has a sheet in the folder keeps it when the roster changes.
    """
    with failures_of(assignment):
        made = _of("class_sheets")(assignment, _of("load_roster")(roster), seed, out, anew)
        _of("write_class")(made, form, drawing(), out)
    for remark in made.remarks():
        typer.echo(f"{assignment}: {remark}", err=True)
    typer.echo(f"{out}: {len(made.sheets)} sheets")


def drawing() -> Callable[[Any, Any, str], str | None]:
    """What draws a scene for a sheet."""
    unanswered = _of("unanswered")

    def draw(scene: Any, report: Any, title: str) -> str | None:
        picture = unanswered(scene, report, title)
        return None if picture is None else picture.svg()

    return draw
