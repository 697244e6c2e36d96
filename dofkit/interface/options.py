"""The arguments and options of the commands, each with its line of help."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from pathlib import Path
from typing import Annotated, Any

from typer import Argument, BadParameter, Option

from dofkit.base.errors import ArgumentError
from dofkit.base.wording import format_of_path, is_folder_path, no_such
from dofkit.interface.output import FAILURES

#: The heading in the help above options that few people need.
ADVANCED = "Advanced"
STILL_KINDS, MOVING_KINDS = ("svg", "png", "pdf", "html"), ("html", "gif", "mp4", "svg", "png", "pdf")
DRAWN_AS = ("mechanism", "graph", "directions")
#: The names of the methods in `dofkit.methods.table`, which takes long to import.
METHODS = ("auto", "count", "graph", "field", "balls", "exact", "numeric", "symbolic")


# Completion by the shell


def _explained(incomplete: str) -> list[str]:
    """Return the words of `dofkit explain` that begin with the incomplete word."""
    from dofkit.interface.explanations import all_explanations  # only a shell that completes needs it

    words = (explanation.word for explanation in all_explanations())
    return list(dict.fromkeys(word for word in words if word.casefold().startswith(incomplete.casefold())))


def _catalogued(incomplete: str) -> list[str]:
    """Return the catalog names that begin with the incomplete word; if there is none, the shell completes files."""
    from dofkit.scene.catalog import catalog_names  # only a shell that completes needs it

    return [name for name in catalog_names() if incomplete and name.startswith(incomplete)]


# Checks. Each raises BadParameter.


def _files(arguments: list[str]) -> list[str]:
    """Return all files that the arguments name, with the files of folders and patterns."""
    from dofkit.interface.named_files import named_files  # which imports the readers of models

    return named_files(arguments)


def folder(path: Path | None) -> Path | None:
    """Return the path of a folder. Raises BadParameter if it has a file extension."""
    return path if path is None or is_folder_path(path) else _with_ending(path, ())


def file_of(*endings: str) -> Callable[[Path | None], Path | None]:
    """Return the check that a path has one of these file extensions."""
    return lambda path: path if path is None else _with_ending(path, endings)


def _certificate(path: str | None) -> str | None:
    """Return the path of a certificate or of a folder; a file must have the extension .json."""
    if path is not None and not is_folder_path(Path(path)):
        _with_ending(Path(path), ("json",))
    return path


def _with_ending(path: Path, endings: Collection[str]) -> Path:
    try:
        format_of_path(path, endings)
    except ArgumentError as error:
        raise BadParameter(str(error)) from None
    return path


def _one_of(words: Collection[str]) -> Callable[[str | None], str | None]:
    """Return the check that an option is one of the words."""

    def checked(word: str | None) -> str | None:
        if word is not None and word not in words:
            raise BadParameter(f"'{word}' is none of {', '.join(words)}")
        return word

    return checked


def listed(texts: list[str] | None) -> tuple[str, ...]:
    """Return the names in texts that separate names by commas or spaces."""
    return tuple(name for text in texts or () for name in text.replace(",", " ").split())


def fields(only: list[str] | None) -> tuple[str, ...]:
    """Return the names of fields of a report; empty without ``--only``."""
    if not only:
        return ()
    from dofkit.report import Report  # which imports pydantic

    return names_among(listed(only), Report.model_fields, "field", "--only")


def names_among(names: tuple[str, ...], allowed: Iterable[str], what: str, option: str) -> tuple[str, ...]:
    """Return the names, each of which must be one of ``allowed``; ``what`` and ``option`` are for the message."""
    for name in names:
        if name not in allowed:
            raise BadParameter(no_such(name, allowed, what), param_hint=option)
    return names


def _format(kinds: Collection[str]) -> Any:
    """Return the option for the format of the pictures in a folder."""
    about = f"The format in a folder: {', '.join(kinds)}; the default is {next(iter(kinds))}."
    return Option("--format", metavar="KIND", callback=_one_of(kinds), help=about)


def flag(name: str, help_text: str) -> Any:
    """Return the option of a flag; its help line shows no type."""
    return Option(name, metavar="", help=help_text)


def _workers(help_text: str) -> Any:
    return Option("--workers", metavar="N", min=1, help=help_text, rich_help_panel=ADVANCED)


# Of several commands

_FILES = "Scenes or models: paths, folders, patterns, catalog names, or - for standard input."
Files = Annotated[list[str], Argument(metavar="FILE", help=_FILES, autocompletion=_catalogued, callback=_files)]
AsJson = Annotated[bool, flag("--json", "Print one JSON object per line, in the order given.")]
_LIMIT = "Time limit per scene; what is unfinished then is undecided."
Budget = Annotated[float, Option("--budget", metavar="SECONDS", min=0, help=_LIMIT, rich_help_panel=ADVANCED)]
Limits = Annotated[bool, flag("--limits", "Include the joint limits of models as inequalities.")]
Workers = Annotated[int | None, _workers("Number of processes; the default is one per core.")]
_CLUSTER = "Run on the Dask cluster at this address."
Scheduler = Annotated[str | None, Option("--scheduler", metavar="ADDRESS", help=_CLUSTER, rich_help_panel=ADVANCED)]
Assignment = Annotated[str, Argument(metavar="ASSIGNMENT", help="The assignment: YAML or JSON.")]
_ROSTER = "The students of the course: names, addresses, ids."
RosterPath = Annotated[Path | None, Option("--roster", metavar="TABLE.csv", help=_ROSTER)]
_REVIEW = "A review.csv in which a person has filled in points."
ReviewTable = Annotated[Path | None, Option("--reviewed", metavar="CSV", help=_REVIEW)]

# Of `classify`

Brief = Annotated[bool, flag("--brief", "Print one line per scene (the default for more than three).")]
Full = Annotated[bool, flag("--full", "Print full reports, however many scenes there are.")]
How = Annotated[bool, flag("--how", "Show the argument behind each answer and how certain it is.")]
_ONLY = "Print these fields of the report only, such as dof."
Only = Annotated[list[str] | None, Option("--only", metavar="FIELD,...", help=_ONLY)]
_WITHOUT = "Drop these constraints, and show what changes."
Without = Annotated[list[str] | None, Option("--without", metavar="NAME,...", help=_WITHOUT)]
_FAIL_ON = f"Exit with status 1 if a scene is one of {', '.join(FAILURES)}."
FailOn = Annotated[list[str] | None, Option("--fail-on", metavar="WHAT,...", help=_FAIL_ON)]
SceneWorkers = Annotated[int | None, _workers("Number of processes; with --out the default is one per core.")]
_REPORTS = "Write the reports to DIR/reports.jsonl; a later run answers only what is new or changed."
ReportFolder = Annotated[Path | None, Option("--out", metavar="DIR", callback=folder, help=_REPORTS)]
_METHOD = f"Answer by one method only: {', '.join(METHODS)}."
Method = Annotated[
    str, Option("--method", metavar="NAME", callback=_one_of(METHODS), help=_METHOD, rich_help_panel=ADVANCED)
]

# Of certificates

_CERTIFICATE = "Write a certificate that `dofkit verify` can check; for several files name a folder."
CertificatePath = Annotated[
    str | None, Option("--certificate", metavar="OUT.json", callback=_certificate, help=_CERTIFICATE)
]
_SCENE_AND_CERTIFICATE = "A scene and its certificate, or a certificate that holds its scene."
CertificateFiles = Annotated[list[str], Argument(metavar="[SCENE] CERT", help=_SCENE_AND_CERTIFICATE)]
OnlyWithEvidence = Annotated[bool, flag("--strict", "Report what is proved without evidence as probable.")]
Strict = Annotated[bool, flag("--strict", "Fail if a claim is not covered by evidence, too.")]

# Of pictures and equations of motion

_PICTURE = "The file, whose ending decides the format; or a folder for several scenes."
PicturePath = Annotated[Path | None, Option("--out", metavar="PATH", help=_PICTURE)]
StillKind = Annotated[str | None, _format(STILL_KINDS)]
MovingKind = Annotated[str | None, _format(MOVING_KINDS)]
_LOOP = "Move free coordinates round a closed loop, and show whether the others return."
Loop = Annotated[bool, flag("--loop", _LOOP)]
_DRAWN_AS = "mechanism; graph: constraints and what they constrain; directions: those of a growth vector."
DrawnAs = Annotated[str, Option("--as", metavar="KIND", callback=_one_of(DRAWN_AS), help=_DRAWN_AS)]
_LINEARIZE = "Add the matrices M, C and K about the reference configuration, or about zero."
Linearize = Annotated[bool, flag("--linearize", _LINEARIZE)]

# Of `grade`

_SUBMISSION = "YAML, JSON, JSON lines or CSV files, folders of them, or - for standard input."
Submissions = Annotated[list[str], Argument(metavar="SUBMISSION", help=_SUBMISSION)]
_FORMAT = "native, html, or a platform: gradescope, prairielearn, coursera, canvas, moodle."
ResultFormat = Annotated[str, Option("--format", metavar="NAME", help=_FORMAT)]
_RESULT = "The file or folder to write; an interrupted run resumes there."
ResultPath = Annotated[Path | None, Option("--out", metavar="PATH", help=_RESULT)]
CheckOnly = Annotated[bool, flag("--check-only", "Show how every answer is read, without grading.")]

# Of `new`, `convert`, `explain`, `catalog` and `schema`

_WRITTEN = "The file to write; without it the scene is printed."
_YAML = file_of("yaml", "yml")
ModelPath = Annotated[str, Argument(metavar="FILE", help="An MJCF or URDF file, or a SolveSpace sketch.")]
ScenePath = Annotated[Path | None, Option("--out", metavar="SCENE.yaml", callback=_YAML, help=_WRITTEN)]
NewPath = Annotated[Path | None, Argument(metavar="FILE", callback=_YAML, help=_WRITTEN)]
_WORD = "A feedback code, report field, verdict, argument, theorem, constraint type or section of a scene."
Word = Annotated[list[str] | None, Argument(metavar="WORD", show_default=False, help=_WORD, autocompletion=_explained)]
_CATALOG = "Words that occur in a scene; or `show` and the name of a scene."
CatalogWords = Annotated[
    list[str] | None, Argument(metavar="WORD", show_default=False, help=_CATALOG, autocompletion=_catalogued)
]
SchemaName = Annotated[str, Argument(metavar="WHAT", help="scene, assignment, result or report.")]

# Of `chart`

_QUESTION = "dof, integrability, redundancy or equivalence."
Questions = Annotated[list[str] | None, Option("--question", metavar="Q", help=_QUESTION)]
_FAMILIES = "Families of trials; the default is all."
Families = Annotated[list[str] | None, Option("--families", metavar="NAME,...", help=_FAMILIES)]
_METHODS = "Methods to compare; the default is all."
Methods = Annotated[list[str] | None, Option("--methods", metavar="NAME,...", help=_METHODS)]
ChartFolder = Annotated[Path, Option("--out", metavar="DIR", callback=folder, help="The folder for data and figures.")]
_SOURCE = "Redraw the figures from the data of an earlier run."
ChartSource = Annotated[Path | None, Option("--from", metavar="DIR", help=_SOURCE)]
Quick = Annotated[bool, flag("--quick", "Run a few small trials of each family, in under a minute.")]
_TIMEOUT = "Processor time per trial and method."
Timeout = Annotated[float | None, Option("--timeout", metavar="SECONDS", min=0.01, help=_TIMEOUT)]
