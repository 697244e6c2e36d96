"""The arguments and options of the commands: what each takes, and its line of help."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from pathlib import Path
from typing import Annotated, Any

import typer

from dofkit.base.surface import handed_on
from dofkit.interface.outcome import FAILURES
from dofkit.methods.table import METHODS

#: What is imported only where an option needs it.
_HEAVY = {
    "Report": "dofkit.report",
    "all_explanations": "dofkit.interface.explanations",
    "catalog_names": "dofkit.scene.catalog",
    "named_files": "dofkit.interface.named_files",
    "no_such": "dofkit.base.spelling",
}

# what a shell completes


def explained(incomplete: str) -> list[str]:
    """The words that `explain` knows."""
    known = handed_on(__name__, _HEAVY, "all_explanations")()
    return list(dict.fromkeys(told.word for told in known if told.word.casefold().startswith(incomplete.casefold())))


def catalogued(incomplete: str) -> list[str]:
    """The names of the catalog; files are completed by the shell where none fits."""
    names = handed_on(__name__, _HEAVY, "catalog_names")()
    return [name for name in names if incomplete and name.startswith(incomplete)]


# of several commands


def _named(arguments: list[str]) -> list[str]:
    """Every file that is named; folders and patterns stand for what is in them."""
    found: list[str] = handed_on(__name__, _HEAVY, "named_files")(arguments)
    return found


Files = Annotated[
    list[str],
    typer.Argument(
        metavar="FILE...",
        help="Scenes and models: paths, folders, catalog names, - for stdin.",
        autocompletion=catalogued,
        callback=_named,
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object a line, in the order given.")]
Budget = Annotated[
    float | None,
    typer.Option(
        "--budget", metavar="SECONDS", min=0, help="Seconds for each scene; what is not finished is undecided."
    ),
]


def _one_of(known: Collection[str]) -> Callable[[str], str]:
    """What checks that an option is one of some words."""

    def checked(word: str) -> str:
        if word not in known:
            raise typer.BadParameter(f"'{word}' is none of {', '.join(known)}")
        return word

    return checked


Brief = Annotated[bool, typer.Option("--brief", help="A line a scene; so it is for more than three.")]
Full = Annotated[bool, typer.Option("--full", help="Every report in full, however many there are.")]
How = Annotated[bool, typer.Option("--how", help="Also how sure each answer is, and by which argument; in full.")]
Only = Annotated[
    list[str] | None,
    typer.Option("--only", metavar="FIELD,...", help="These fields of the report and no others, such as dof."),
]
Without = Annotated[
    list[str] | None,
    typer.Option("--without", metavar="NAME,...", help="What if these constraints are dropped? What changes."),
]
FailOn = Annotated[
    list[str] | None,
    typer.Option("--fail-on", metavar="WHAT,...", help=f"Exit status 1 where a scene is {', '.join(FAILURES)}."),
]
SceneWorkers = Annotated[
    int | None,
    typer.Option("--workers", metavar="N", min=1, help="So many processes at once; with --out one for each core."),
]
ReportFolder = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Write JSON lines there; a later run answers only what is not there."),
]
Limits = Annotated[bool, typer.Option("--limits", help="Of models: ranges of joints as inequalities.")]
ModelPath = Annotated[str, typer.Argument(metavar="FILE", help="MJCF, URDF, or a SolveSpace sketch.")]
ScenePath = Annotated[
    Path | None, typer.Option("--out", metavar="SCENE.yaml", help="Where to write; else it is printed.")
]
Watch = Annotated[bool, typer.Option("--watch", help="Again whenever a file changes, until Ctrl-C.")]


def listed(given: list[str] | None) -> tuple[str, ...]:
    """The names in lists with commas."""
    return tuple(name for text in given or () for name in text.replace(",", " ").split())


def fields(only: list[str] | None) -> tuple[str, ...]:
    """Names of fields of a report."""
    if not only:
        return ()
    report = handed_on(__name__, _HEAVY, "Report")
    return _known(listed(only), report.model_fields, "field", "--only")


def failures(fail_on: list[str] | None) -> tuple[str, ...]:
    """Names of what a command is to fail on."""
    return _known(listed(fail_on), FAILURES, "failure", "--fail-on")


def _known(names: tuple[str, ...], known: Iterable[str], what: str, option: str) -> tuple[str, ...]:
    for name in names:
        if name not in known:
            said = handed_on(__name__, _HEAVY, "no_such")(name, known, what)
            raise typer.BadParameter(said, param_hint=option)
    return names


Method = Annotated[
    str,
    typer.Option(
        "--method", metavar="NAME", callback=_one_of(METHODS), help=f"One way to answer alone: {', '.join(METHODS)}."
    ),
]


Assignment = Annotated[str, typer.Argument(metavar="ASSIGNMENT", help="What was handed out: YAML or JSON.")]
Workers = Annotated[
    int | None, typer.Option("--workers", metavar="N", min=1, help="Processes; by default one for each core.")
]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="ADDRESS", help="A Dask cluster that does the work.")
]

# of certificates

CertificatePath = Annotated[
    str | None,
    typer.Option("--certificate", metavar="OUT.json", help="Write why: a certificate; a folder for several files."),
]
CertificateFiles = Annotated[
    list[str],
    typer.Argument(metavar="[SCENE] CERT", help="A scene and its certificate, or one that holds its scene."),
]
CertificateFolder = Annotated[
    Path | None,
    typer.Option(
        "--certificates",
        metavar="DIR",
        help="Write, for appeals, what keys rest on and what shows that equations are right or wrong.",
    ),
]
Strict = Annotated[bool, typer.Option("--strict", help="Nothing may be uncovered either.")]

# of pictures

PicturePath = Annotated[
    Path | None,
    typer.Option("--out", metavar="PATH", help="Where to write: a file by its ending, or a folder for several scenes."),
]


STILL_KINDS, MOVING_KINDS = ("svg", "png", "pdf", "html"), ("html", "gif", "mp4")


def _format(kinds: Collection[str]) -> Any:
    """The option for the format of pictures in a folder."""
    told = f"In a folder: {', '.join(kinds)}."
    return typer.Option("--format", metavar="KIND", callback=_one_of(kinds), help=told)


StillKind = Annotated[str, _format(STILL_KINDS)]
MovingKind = Annotated[str, _format(MOVING_KINDS)]

# of `lagrange`

Linearize = Annotated[bool, typer.Option("--linearize", help="Also M, C and K of small motions about an equilibrium.")]

# of `grade`

Submissions = Annotated[
    list[str],
    typer.Argument(metavar="SUBMISSION...", help="YAML, JSON, JSON lines, CSV, folders of these, - for stdin."),
]
ResultFormat = Annotated[str, typer.Option("--format", metavar="NAME", help="native, or what a gradebook reads.")]
ResultPath = Annotated[
    Path | None,
    typer.Option("--out", metavar="PATH", help="Where to write; an interrupted run goes on where it stopped."),
]
ReviewTable = Annotated[
    Path | None,
    typer.Option("--reviewed", metavar="CSV", help="A review.csv with points that a person filled in."),
]
CheckOnly = Annotated[bool, typer.Option("--check-only", help="Tell how every answer is read, and grade none.")]

RosterPath = Annotated[
    Path | None,
    typer.Option("--roster", metavar="TABLE.csv", help="Who is in the course: names, addresses, ids."),
]

# of `chart`

Questions = Annotated[
    list[str] | None, typer.Option("--question", metavar="Q", help="dof, integrability, redundancy, equivalence.")
]
Families = Annotated[
    list[str] | None, typer.Option("--families", metavar="NAME,...", help="Of the trials; by default all.")
]
Methods = Annotated[list[str] | None, typer.Option("--methods", metavar="NAME,...", help="By default all.")]
ChartFolder = Annotated[Path, typer.Option("--out", metavar="DIR", help="Where data and figures go.")]
ChartSource = Annotated[Path | None, typer.Option("--from", metavar="DIR", help="Draw again from the data of a run.")]
Quick = Annotated[bool, typer.Option("--quick", help="A few small trials of each family: under a minute.")]
Most = Annotated[
    int | None, typer.Option("--most", metavar="N", min=0, help="Trials of each family and question; 0: all.")
]
Timeout = Annotated[
    float | None,
    typer.Option("--timeout", metavar="SECONDS", min=0.01, help="Processor time for each trial and method."),
]
