"""One file of the command line, from its bytes to the lines that are printed; this runs in a worker."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from dofkit.base.documents import Document
from dofkit.base.errors import DofkitError, Fault, SceneError, TextError
from dofkit.base.workers import Json
from dofkit.classification.undecided import undecided
from dofkit.interface import show
from dofkit.interface.supervised import STDIN, Cut, Given
from dofkit.methods.classify import with_certificate
from dofkit.methods.stages import stages
from dofkit.motion import lagrange
from dofkit.report import Report
from dofkit.scene.found_files import find
from dofkit.scene.reading import SceneFile
from dofkit.scene.scene import Scene


def report_lines(given: Given) -> Iterator[Json]:
    """What is printed of the report on a file; before that a sketch of it as a ``report``."""
    return _answer_lines(given, _report_stages)


def motion_lines(given: Given) -> Iterator[Json]:
    """What is printed of the equations of motion of a file."""
    return _answer_lines(given, _equations)


def cut_lines(cut: Cut) -> Json:
    """What is printed where `report_lines` was cut short: of a scene that was read, that nothing was decided."""
    if cut.value is not None and "report" in cut.value:
        report = undecided(Report.model_validate(cut.value["report"]), cut.reason)
        return _streams(_report_text(report, cut.value["title"], cut.given))
    fault = Fault(f"it could not be read: {cut.reason}", hint="make the scene smaller, or split it")
    return _fault_streams(cut.given, cut.given.name, (fault,), None)


def _answer_lines(given: Given, answer: Callable[[Scene, Given], Iterator[Json]]) -> Iterator[Json]:
    """Read a file and give its answer, or else its faults, each in its place: no file stops those that follow."""
    name, document = given.name, None
    try:
        name, data = find(given.file) if given.data is None else (name, given.data)
        read = SceneFile.read(data, name)
        document = read.document
        scene = read.scene(checked=False)
        try:
            yield from answer(scene, given)
        except SceneError as error:
            raise read.with_places(error) from None
    except MemoryError:
        raise
    except Exception as error:
        yield _fault_streams(given, name, _faults_of_error(error), document)


def _report_stages(scene: Scene, given: Given) -> Iterator[Json]:
    reports = stages(scene, given.budget, given.method)
    first = next(reports)
    yield {"report": first.model_dump(mode="json"), "title": scene.title}
    report = next(reports, first)
    if given.certificate is not None:
        report = _written_certificate(scene, report, given.certificate)
    yield _streams(_report_text(report, scene.title, given))


def _written_certificate(scene: Scene, report: Report, path: str) -> Report:
    """The report with its certificate, which is written to a path; folders on the way are made."""
    report = with_certificate(scene, report)
    place = Path(path)
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(json.dumps(report.certificate, ensure_ascii=False) + "\n", encoding="utf-8")
    except OSError as error:
        raise DofkitError(f"the certificate cannot be written to '{path}': {error.strerror or error}") from None
    return report


def _equations(scene: Scene, given: Given) -> Iterator[Json]:
    report = lagrange.lagrange(scene, given.linearize, given.budget)
    if given.as_json:
        yield _streams(_line(report.model_dump(mode="json"), given))
    else:
        yield _streams(show.as_lines(report, scene.title) + "\n")


def _streams(out: str = "", err: str = "", failed: bool = False) -> Json:
    """What goes to standard output and to standard error."""
    return {"out": out, "err": err, "failed": failed}


def _report_text(report: Report, title: str | None, given: Given) -> str:
    if given.as_json:
        return _line(report.model_dump(mode="json"), given)
    from rich.console import Console

    console = Console()
    if given.terminal is not None:
        width, colours = given.terminal
        system: Any = colours
        console = Console(file=io.StringIO(), width=width, force_terminal=colours is not None, color_system=system)
    return show.as_text(report, title, console) + "\n\n"


def _line(value: Any, given: Given) -> str:
    """One line of JSON."""
    return json.dumps(value, ensure_ascii=given.ascii_only) + "\n"


def _fault_streams(given: Given, name: str, faults: tuple[Fault, ...], document: Document | None) -> Json:
    """What is printed of a file that could not be read, or not be answered."""
    if given.as_json:
        return _streams(out=_line({"scene": name, "error": _error_object(faults)}, given), failed=True)
    return _streams(
        err=show.complaint(STDIN if given.file == "-" else given.file, faults, document) + "\n", failed=True
    )


def _error_object(faults: Iterable[Fault]) -> dict[str, Any]:
    """The first fault, with all further ones under ``faults``."""
    first, *others = [
        {"message": fault.message, "line": fault.line, "column": fault.column, "hint": fault.hint} for fault in faults
    ] or [{"message": "unknown error", "line": None, "column": None, "hint": None}]
    return {**first, "faults": others}


def _faults_of_error(error: Exception) -> tuple[Fault, ...]:
    """What went wrong, as faults."""
    if isinstance(error, SceneError):
        return error.faults
    if isinstance(error, TextError):
        return (Fault(error.message, hint=error.hint),)
    return (Fault(str(error)) if isinstance(error, DofkitError) else _internal(error),)


def _internal(error: Exception) -> Fault:
    """A fault of dofkit's own, told in one line."""
    said = " ".join(str(error).split())[:200]
    message = f"internal error, {type(error).__name__}" + (f": {said}" if said else "")
    return Fault(message, hint="this is a fault of dofkit, please report it with this scene")
