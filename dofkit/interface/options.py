"""The arguments and options of the commands, each with its line of help."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from pathlib import Path
from typing import Annotated, Any

import typer

from dofkit.base.arguments import format_of_path, is_folder_path
from dofkit.base.errors import ArgumentError
from dofkit.base.wording import no_such
from dofkit.interface.help_panels import ADVANCED
from dofkit.interface.outcome import FAILURES
from dofkit.methods.table import METHODS

# completion by the shell


def explained(incomplete: str) -> list[str]:
    """Return the words that `explain` knows."""
    from dofkit.interface.explanations import all_explanations

    known = all_explanations()
    return list(dict.fromkeys(told.word for told in known if told.word.casefold().startswith(incomplete.casefold())))


def catalogued(incomplete: str) -> list[str]:
    """Return the names of the catalog; where none fits the shell completes files."""
    from dofkit.scene.catalog import catalog_names

    return [name for name in catalog_names() if incomplete and name.startswith(incomplete)]


# of several commands


def _named(arguments: list[str]) -> list[str]:
    """Return every file that the arguments name; folders and patterns stand for the files in them."""
    from dofkit.interface.named_files import named_files

    return named_files(arguments)


def folder(path: Path | None) -> Path | None:
    """Return the path of a folder. Raises BadParameter for a path with the ending of a file."""
    return path if path is None or is_folder_path(path) else _of_format(path, ())


def file_of(*known: str) -> Callable[[Path | None], Path | None]:
    """Return what checks that a path has one of the endings of the files that can be written."""
    return lambda path: path if path is None else _of_format(path, known)


def _of_format(path: Path, known: Collection[str]) -> Path:
    try:
        format_of_path(path, known)
    except ArgumentError as error:
        raise typer.BadParameter(str(error)) from None
    return path


Files = Annotated[
    list[str],
    typer.Argument(
        metavar="FILE",
        help="Scenes or models: paths, folders, patterns, catalog names, or - for standard input.",
        autocompletion=catalogued,
        callback=_named,
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object per line, in the order given.")]
Budget = Annotated[
    float | None,
    typer.Option(
        "--budget",
        metavar="SECONDS",
        min=0,
        help="Time limit per scene; what is unfinished then is undecided.",
        rich_help_panel=ADVANCED,
    ),
]


def _one_of(known: Collection[str]) -> Callable[[str | None], str | None]:
    """Return what checks that an option is one of the known words."""

    def checked(word: str | None) -> str | None:
        if word is not None and word not in known:
            raise typer.BadParameter(f"'{word}' is none of {', '.join(known)}")
        return word

    return checked


Brief = Annotated[bool, typer.Option("--brief", help="Print one line per scene (the default for more than three).")]
Full = Annotated[bool, typer.Option("--full", help="Print full reports, however many scenes there are.")]
How = Annotated[bool, typer.Option("--how", help="Show the argument behind each answer and how certain it is.")]
Only = Annotated[
    list[str] | None,
    typer.Option("--only", metavar="FIELD,...", help="Print these fields of the report only, such as dof."),
]
Without = Annotated[
    list[str] | None,
    typer.Option("--without", metavar="NAME,...", help="Drop these constraints, and show what changes."),
]
FailOn = Annotated[
    list[str] | None,
    typer.Option("--fail-on", metavar="WHAT,...", help=f"Exit with status 1 if a scene is {', '.join(FAILURES)}."),
]
SceneWorkers = Annotated[
    int | None,
    typer.Option(
        "--workers",
        metavar="N",
        min=1,
        help="Number of processes; with --out the default is one per core.",
        rich_help_panel=ADVANCED,
    ),
]
ReportFolder = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        callback=folder,
        help="Write the reports to DIR/reports.jsonl; a later run answers only what is new or changed.",
    ),
]
Limits = Annotated[bool, typer.Option("--limits", help="Include the joint limits of models as inequalities.")]
ModelPath = Annotated[str, typer.Argument(metavar="FILE", help="A MJCF or URDF file, or a SolveSpace sketch.")]
ScenePath = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="SCENE.yaml",
        callback=file_of("yaml", "yml"),
        help="The file to write; without it the scene is printed.",
    ),
]
NewPath = Annotated[
    Path | None,
    typer.Argument(
        metavar="[FILE]", callback=file_of("yaml", "yml"), help="The file to write; without it the scene is printed."
    ),
]
Watch = Annotated[bool, typer.Option("--watch", help="Run again whenever a file changes, until Ctrl-C.")]


def listed(given: list[str] | None) -> tuple[str, ...]:
    """Return the names in lists with commas."""
    return tuple(name for text in given or () for name in text.replace(",", " ").split())


def fields(only: list[str] | None) -> tuple[str, ...]:
    """Return names of fields of a report. Raises BadParameter for any other name."""
    if not only:
        return ()
    from dofkit.report import Report

    return _known(listed(only), Report.model_fields, "field", "--only")


def failures(fail_on: list[str] | None) -> tuple[str, ...]:
    """Return the findings that a command fails on. Raises BadParameter for any other name."""
    return _known(listed(fail_on), FAILURES, "failure", "--fail-on")


def _known(names: tuple[str, ...], known: Iterable[str], what: str, option: str) -> tuple[str, ...]:
    for name in names:
        if name not in known:
            raise typer.BadParameter(no_such(name, known, what), param_hint=option)
    return names


Method = Annotated[
    str,
    typer.Option(
        "--method",
        metavar="NAME",
        callback=_one_of(METHODS),
        help=f"Answer by one method only: {', '.join(METHODS)}.",
        rich_help_panel=ADVANCED,
    ),
]


Assignment = Annotated[str, typer.Argument(metavar="ASSIGNMENT", help="The assignment: YAML or JSON.")]
Workers = Annotated[
    int | None,
    typer.Option(
        "--workers",
        metavar="N",
        min=1,
        help="Number of processes; the default is one per core.",
        rich_help_panel=ADVANCED,
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler", metavar="ADDRESS", help="Run on the Dask cluster at this address.", rich_help_panel=ADVANCED
    ),
]

# of certificates


def _certificate(path: str | None) -> str | None:
    """Return the path of a certificate or of a folder. Raises BadParameter for a file that does not end in .json."""
    if path is not None and not is_folder_path(Path(path)):
        _of_format(Path(path), ("json",))
    return path


CertificatePath = Annotated[
    str | None,
    typer.Option(
        "--certificate",
        metavar="OUT.json",
        callback=_certificate,
        help="Write a certificate that `dofkit verify` can check; for several files name a folder.",
    ),
]
CertificateFiles = Annotated[
    list[str],
    typer.Argument(metavar="[SCENE] CERT", help="A scene and its certificate, or a certificate that holds its scene."),
]
Strict = Annotated[bool, typer.Option("--strict", help="Fail if a claim is not covered by evidence, too.")]

# of pictures

PicturePath = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="PATH", help="The file, whose ending decides the format; or a folder for several scenes."
    ),
]


STILL_KINDS, MOVING_KINDS = ("svg", "png", "pdf", "html"), ("html", "gif", "mp4")
DRAWN_AS = ("mechanism", "graph", "directions")


def _format(kinds: Collection[str]) -> Any:
    """Return the option for the format of the pictures in a folder."""
    about = f"The format in a folder: {', '.join(kinds)}; the default is {next(iter(kinds))}."
    return typer.Option("--format", metavar="KIND", callback=_one_of(kinds), help=about)


StillKind = Annotated[str | None, _format(STILL_KINDS)]
MovingKind = Annotated[str | None, _format(MOVING_KINDS)]
DrawnAs = Annotated[
    str,
    typer.Option(
        "--as",
        metavar="KIND",
        callback=_one_of(DRAWN_AS),
        help="mechanism; graph: constraints and what they constrain; directions: those of a growth vector.",
    ),
]

# of `lagrange`

Linearize = Annotated[
    bool, typer.Option("--linearize", help="Add the matrices M, C and K of small motions about an equilibrium.")
]

# of `grade`

Submissions = Annotated[
    list[str],
    typer.Argument(
        metavar="SUBMISSION",
        help="YAML, JSON, JSON lines or CSV files, folders of them, or - for standard input.",
    ),
]
ResultFormat = Annotated[
    str, typer.Option("--format", metavar="NAME", help="native, html, or the format of a gradebook.")
]
ResultPath = Annotated[
    Path | None,
    typer.Option("--out", metavar="PATH", help="The file or folder to write; an interrupted run resumes there."),
]
ReviewTable = Annotated[
    Path | None,
    typer.Option("--reviewed", metavar="CSV", help="A review.csv in which a person has filled in points."),
]
CheckOnly = Annotated[bool, typer.Option("--check-only", help="Show how every answer is read, without grading.")]

RosterPath = Annotated[
    Path | None,
    typer.Option("--roster", metavar="TABLE.csv", help="The students of the course: names, addresses, ids."),
]

# of `chart`

Questions = Annotated[
    list[str] | None, typer.Option("--question", metavar="Q", help="dof, integrability, redundancy or equivalence.")
]
Families = Annotated[
    list[str] | None, typer.Option("--families", metavar="NAME,...", help="Families of trials; the default is all.")
]
Methods = Annotated[
    list[str] | None, typer.Option("--methods", metavar="NAME,...", help="Methods to compare; the default is all.")
]
ChartFolder = Annotated[
    Path, typer.Option("--out", metavar="DIR", callback=folder, help="The folder for data and figures.")
]
ChartSource = Annotated[
    Path | None, typer.Option("--from", metavar="DIR", help="Redraw the figures from the data of an earlier run.")
]
Quick = Annotated[bool, typer.Option("--quick", help="Run a few small trials of each family, in under a minute.")]
Most = Annotated[
    int | None,
    typer.Option("--most", metavar="N", min=0, help="The number of trials per family and question; 0 for all."),
]
Timeout = Annotated[
    float | None,
    typer.Option("--timeout", metavar="SECONDS", min=0.01, help="Processor time per trial and method."),
]
