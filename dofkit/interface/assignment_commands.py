"""The commands about assignments: a first assignment, the handout for students, and a variant per student."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from dofkit.base.endings import format_of_path
from dofkit.base.surface import handed_on
from dofkit.interface import options
from dofkit.interface.failures import failures_of
from dofkit.interface.help_panels import PanelCommand

#: Names that are imported only where a command needs them.
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
    help="Write assignments, handouts and a variant per student.", no_args_is_help=True, rich_markup_mode=None
)


@assignment_app.command("new", cls=PanelCommand)
def new(
    scenes: Annotated[list[str], typer.Argument(metavar="SCENE...", help="Scenes: paths or catalog names.")],
    every: Annotated[bool, typer.Option("--all", help="Include every question that fits the scenes.")] = False,
) -> None:
    """Print a first assignment with five questions per scene."""
    with failures_of(None):
        typer.echo(_of("starting")(scenes, every), nl=False)


@assignment_app.command("handout", cls=PanelCommand)
def handout(
    assignment: options.Assignment,
    form: Annotated[
        str | None, typer.Option("--format", metavar="NAME", help="html (default), pdf, tex or md.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="PATH", help="The file, whose ending decides the format."),
    ] = None,
    student: Annotated[
        str | None, typer.Option("--student", metavar="NAME", help="The student whose variant is written.")
    ] = None,
) -> None:
    """Write the handout for students, with pictures and notation.

    It states the problems, the names and how answers are written, and gives no answer away.
    """
    with failures_of(assignment):
        form = form or "html" if out is None else format_of_path(out, _of("HANDOUTS"), form)
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


@assignment_app.command("vary", cls=PanelCommand)
def vary(
    assignment: options.Assignment,
    roster: Annotated[Path, typer.Option("--roster", metavar="TABLE.csv", help="The students of the course.")],
    seed: Annotated[str, typer.Option("--seed", metavar="TEXT", help="The seed of the variants: keep it.")],
    out: Annotated[Path, typer.Option("--out", metavar="FOLDER", callback=options.folder, help="The folder to write.")],
    form: Annotated[
        str, typer.Option("--format", metavar="NAME", help="The format of the handouts: html, pdf, tex or md.")
    ] = "html",
    anew: Annotated[bool, typer.Option("--anew", help="Replace the variants that the folder holds already.")] = False,
) -> None:
    """Write an equally hard variant for every student.

    The folder gets a handout per student, one assignment that grades all of them (`dofkit grade FOLDER/assignment.yaml
    ...`), and a table of the differences. The same seed gives a student the same variant everywhere, and every key is
    proved. Students who have a variant in the folder keep it when the roster changes.
    """
    with failures_of(assignment):
        made = _of("class_sheets")(assignment, _of("load_roster")(roster), seed, out, anew)
        _of("write_class")(made, form, drawing(), out)
    for remark in made.remarks():
        typer.echo(f"{assignment}: {remark}", err=True)
    typer.echo(f"{out}: {len(made.sheets)} sheets")


def drawing() -> Callable[[Any, Any, str], str | None]:
    """Return the function that draws a scene for a handout."""
    unanswered = _of("unanswered")

    def draw(scene: Any, report: Any, title: str) -> str | None:
        picture = unanswered(scene, report, title)
        return None if picture is None else picture.svg()

    return draw
