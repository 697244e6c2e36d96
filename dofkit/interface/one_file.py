"""One file of the command line, from its bytes to the lines that are printed; this runs in a worker."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from dofkit.base.documents import Document
from dofkit.base.errors import DofkitError, Fault, SceneError, TextError
from dofkit.base.workers import Json
from dofkit.classification.undecided import sketch, undecided
from dofkit.interface import show
from dofkit.interface.outcome import outcome_of
from dofkit.interface.selection import selected_line, selection_of
from dofkit.interface.show.changes import changed, unexpected
from dofkit.interface.show.decimals import as_the_scene
from dofkit.interface.show.sheet import SheetSection
from dofkit.interface.show.terminal import Screen
from dofkit.interface.supervised import STDIN, Cut, Given
from dofkit.methods.stages import classified, lowered, stages
from dofkit.report import Report
from dofkit.scene.catalog import FoundFile, find
from dofkit.scene.expectation import unmet
from dofkit.scene.reading import SceneFile
from dofkit.scene.scene import Scene, without


def report_lines(given: Given) -> Iterator[Json]:
    """What is printed of the report on a file; before that an empty mapping, as soon as the file is read."""
    return answer_lines(given, _report)


def motion_lines(given: Given) -> Iterator[Json]:
    """What is printed of the equations of motion of a file."""
    return answer_lines(given, _equations)


def cut_lines(cut: Cut) -> Json:
    """What is printed where `report_lines` was cut short: of a scene that was read, that nothing was decided."""
    if cut.is_read:
        *_, printed = answer_lines(cut.given, partial(_undecided, cut.reason))
        return printed
    fault = Fault(f"it could not be read: {cut.reason}", hint="make the scene smaller, or split it")
    return _fault_streams(cut.given, cut.given.name, (fault,), None)


def answer_lines(given: Given, answer: Callable[[Scene, Given], Iterator[Json]]) -> Iterator[Json]:
    """Read a file and give its answer, or else its faults, each in its place: no file stops those that follow."""
    name, document = given.name, None
    try:
        found = find(given.file) if given.data is None else FoundFile(name, given.data, _place(given.file))
        name = found.name
        read = SceneFile.read(found.data, name, found.path, given.telling.limits)
        document = read.document
        scene = read.scene(checked=False)
        try:
            yield from answer(scene, given)
        except SceneError as error:
            raise read.error(error.faults) from None
    except MemoryError:
        raise
    except Exception as error:
        yield _fault_streams(given, name, _faults_of_error(error), document)


def _place(file: str) -> Path | None:
    """Where a file stands whose bytes are known already: others may stand beside it."""
    return Path(file) if file != "-" and os.path.isfile(file) else None


def _report(scene: Scene, given: Given) -> Iterator[Json]:
    start = time.perf_counter()
    part = _part_of(scene, given)
    system = lowered(part, given.budget)
    yield {}
    left = given.budget - (time.perf_counter() - start)
    report = system if isinstance(system, Report) else classified(system, left, given.method)
    yield _told(scene, part, report, given, start)


def _undecided(reason: str, scene: Scene, given: Given) -> Iterator[Json]:
    """The report on a scene of which nothing could be decided, for that reason."""
    system = lowered(_part_of(scene, given), given.budget)
    report = undecided(system if isinstance(system, Report) else sketch(system, reason), reason)
    yield streams(_report_text(report, scene.title, given), outcome=outcome_of(report))


def _part_of(scene: Scene, given: Given) -> Scene:
    """What is asked about: the scene, or what is left of it without some constraints."""
    dropped = given.telling.without
    return without(scene, dropped) if dropped else scene


def _told(whole: Scene, scene: Scene, report: Report, given: Given, start: float) -> Json:
    if given.certificate is not None:
        report = _written_certificate(scene, report, given.certificate)
    changes = () if whole is scene or given.telling.as_json else _changes(whole, report, given)
    told = report.model_dump(mode="json") if scene.expect or given.telling.as_json else {}
    missed = unmet(scene, told) if scene.expect else []
    more = (*changes, *unexpected(missed)) if missed else changes
    if given.telling.as_json:
        text = _told_line(told, given)
    else:
        text = _report_text(as_the_scene(report, scene), scene.title, given, more)
    seconds = time.perf_counter() - start
    counted = {**outcome_of(report), "expects": bool(scene.expect), "unmet": missed, "seconds": seconds}
    return streams(text, outcome=counted)


def _changes(scene: Scene, report: Report, given: Given) -> Sequence[SheetSection]:
    """What is otherwise than with the constraints that were dropped."""
    *_, before = stages(scene, given.budget, given.method)
    return (changed(before, report, given.telling.without),)


def _written_certificate(scene: Scene, report: Report, path: str) -> Report:
    """The report with its certificate, which is written to a path; folders on the way are made."""
    from dofkit.methods.classify import with_certificate  # few ask for one

    report = with_certificate(scene, report)
    _write(report.certificate, path)
    return report


def _write(certificate: dict[str, Any] | None, path: str) -> None:
    place = Path(path)
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(json.dumps(certificate, ensure_ascii=False) + "\n", encoding="utf-8")
    except OSError as error:
        raise DofkitError(f"the certificate cannot be written to '{path}': {error.strerror or error}") from None


def _equations(scene: Scene, given: Given) -> Iterator[Json]:
    from dofkit.motion.lagrange.equations import lagrange  # only the command `lagrange`

    report = lagrange(scene, given.linearize, given.budget)
    if given.certificate is not None:
        from dofkit.methods.certificates.motion_evidence import certificate_of_motion  # few ask for one

        told = report.model_dump(mode="json")
        _write(certificate_of_motion(scene, told, report.classification), given.certificate)
    if given.telling.as_json:
        yield streams(_line(report.model_dump(mode="json"), given))
    else:
        sheet = show.sheet_of_motion(as_the_scene(report, scene), scene.title)
        yield streams(show.as_text(sheet, _screen(given)) + "\n\n")


def streams(out: str = "", err: str = "", errors: int = 0, outcome: Json = None) -> Json:
    """What goes to standard output and to standard error, and what a summary counts."""
    return {"out": out, "err": err, "errors": errors, "outcome": outcome}


def _report_text(report: Report, title: str | None, given: Given, more: Sequence[SheetSection] = ()) -> str:
    telling = given.telling
    if telling.as_json:
        return _told_line(report.model_dump(mode="json"), given)
    if telling.only:
        return selected_line(report, telling.only) + "\n"
    if telling.brief:
        return show.brief_line(report, given.widest, _screen(given)) + "\n"
    sheet = show.sheet_of_report(report, title, telling.how)
    return show.as_text(sheet._replace(sections=(*more, *sheet.sections)), _screen(given)) + "\n\n"


def _told_line(told: dict[str, Any], given: Given) -> str:
    """A report, or the fields of it that are asked for, as a line of JSON."""
    only = given.telling.only
    return _line(selection_of(told, only) if only else told, given)


def _screen(given: Given) -> Screen:
    return Screen(given.telling.columns, given.telling.colours)


def _line(value: Any, given: Given) -> str:
    """One line of JSON."""
    return json.dumps(value, ensure_ascii=given.telling.ascii_only) + "\n"


def _fault_streams(given: Given, name: str, faults: tuple[Fault, ...], document: Document | None) -> Json:
    """What is printed of a file that could not be read, or not be answered."""
    if given.telling.as_json:
        return streams(out=_line({"scene": name, "error": _error_object(faults)}, given), errors=len(faults))
    file = STDIN if given.file == "-" else given.file
    return streams(err=show.complaint(file, faults, document, given.telling.loud) + "\n", errors=len(faults))


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
