"""What a worker does for one file of the command line: from its bytes to the texts that are printed."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import dofkit
from dofkit.base.documents import Document
from dofkit.base.errors import DofkitError, Fault, SceneError, TextError
from dofkit.base.workers import Json
from dofkit.checker import CheckError, Verification
from dofkit.classification.undecided import sketch, undecided
from dofkit.interface.jobs import STDIN, Cut, Request
from dofkit.interface.output import FAILED
from dofkit.interface.show.decimals import as_the_scene
from dofkit.interface.show.faults import complaint
from dofkit.interface.show.motion import sheet_of_motion
from dofkit.interface.show.report import changed, sheet_of_report, unexpected
from dofkit.interface.show.sheet import SheetSection
from dofkit.interface.show.terminal import as_text, brief_line, outcome_of, selected_line
from dofkit.methods.classify import classified, lowered
from dofkit.report import Report
from dofkit.scene.catalog import FoundFile, find
from dofkit.scene.expectation import unmet
from dofkit.scene.reading import SceneFile
from dofkit.scene.scene import Scene, without

#: {kind of picture: public function that makes it}.
_PICTURES = {"mechanism": "draw", "graph": "graph", "directions": "phase", "motion": "animate", "loop": "animate"}


def cut_lines(cut: Cut) -> Json:
    """Return what is printed if the answer was cut short: an undecided report if the scene was read, else a fault."""
    if cut.is_read:
        *_, printed = answer_lines(cut.request, partial(_undecided, cut.reason))
        return printed
    fault = Fault(f"it could not be read: {cut.reason}", hint="make the scene smaller, or split it")
    return _fault_streams(cut.request, cut.request.name, (fault,), None)


def answer_lines(request: Request, answer: Callable[[Scene, Request], Iterator[Json]]) -> Iterator[Json]:
    """Read a file and yield what ``answer`` yields of its scene, or what is printed about its faults."""
    name, document = request.name, None
    try:
        path = Path(request.file) if request.file != "-" and os.path.isfile(request.file) else None
        file = find(request.file) if request.data is None else FoundFile(name, request.data, path)
        name = file.name
        read = SceneFile.read(file.data, name, file.path, request.limits)
        document = read.document
        scene = read.scene(checked=False)
        try:
            yield from answer(scene, request)
        except SceneError as error:
            raise read.error(error.faults) from None
    except MemoryError:
        raise
    except Exception as error:
        yield _fault_streams(request, name, _faults_of_error(error), document)


def streams(out: str = "", err: str = "", errors: int = 0, outcome: Json = None) -> Json:
    """Return the fields of `Printed`: texts for the two streams, the number of errors, and what a summary counts."""
    return {"out": out, "err": err, "errors": errors, "outcome": outcome}


def _report(whole: Scene, request: Request) -> Iterator[Json]:
    """Yield {} once the scene is read into equations, then the text of its report."""
    start = time.perf_counter()
    scene = without(whole, request.without) if request.without else whole
    system = lowered(scene, request.budget)
    yield {}
    remaining = request.budget - (time.perf_counter() - start)
    report = system if isinstance(system, Report) else classified(system, remaining, request.method)
    if request.certificate is not None or request.strict:
        report = _with_certificate(scene, report, request)
    as_json = request.output.as_json
    sections: tuple[SheetSection, ...] = ()
    if request.without and not as_json:
        before = classified(whole, request.budget, request.method)
        sections = (changed(before, report, request.without),)
    missed = unmet(scene, report.model_dump(mode="json")) if scene.expect else []
    printed = report if as_json else as_the_scene(report, scene)
    text = _report_text(printed, scene, request, (*sections, *unexpected(missed)))
    seconds = time.perf_counter() - start
    outcome = outcome_of(report) | {"expects": bool(scene.expect), "unmet": missed, "seconds": seconds}
    yield streams(text, outcome=outcome)


def _undecided(reason: str, scene: Scene, request: Request) -> Iterator[Json]:
    """Yield the text of a report in which everything is undecided, for the given reason."""
    part = without(scene, request.without) if request.without else scene
    system = lowered(part, request.budget)
    report = undecided(system if isinstance(system, Report) else sketch(system, reason), reason)
    yield streams(_report_text(report, scene, request), outcome=outcome_of(report))


def _report_text(report: Report, scene: Scene, request: Request, sections: Sequence[SheetSection] = ()) -> str:
    """Return a report as JSON, as the values of chosen fields, as one line, or in full."""
    output = request.output
    if output.as_json:
        fields = report.model_dump(mode="json")
        return _line({name: fields[name] for name in ("scene", *output.only)} if output.only else fields, request)
    if output.only:
        return selected_line(report, output.only) + "\n"
    if output.brief:
        return brief_line(report, output.name_width, output.colours) + "\n"
    sheet = sheet_of_report(report, scene.title, output.how)
    sheet = sheet._replace(sections=(*sections, *sheet.sections))
    return as_text(sheet, output.width, output.colours) + "\n\n"


def _with_certificate(scene: Scene, report: Report, request: Request) -> Report:
    """Return the report with its certificate, which is also written if the request names a path."""
    from dofkit.methods.certificates.lowering import (
        with_certificate,  # few runs ask for certificates, whose search is large
    )

    report = with_certificate(scene, report, request.strict)
    if request.certificate is not None:
        _write_certificate(report.certificate, request.certificate)
    return report


def _write_certificate(certificate: dict[str, Any] | None, path: str) -> None:
    target = Path(path)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(json.dumps(certificate, ensure_ascii=False) + "\n", encoding="utf-8")
    except OSError as error:
        raise DofkitError(f"the certificate cannot be written to '{path}': {error.strerror or error}") from None


def _equations(scene: Scene, request: Request) -> Iterator[Json]:
    report = dofkit.lagrange(scene, request.linearize, request.budget)
    if request.certificate is not None:
        from dofkit.methods.certificates.motion_evidence import certificate_of_motion  # few runs ask for certificates

        fields = report.model_dump(mode="json")
        _write_certificate(certificate_of_motion(scene, fields, report.classification), request.certificate)
    if request.output.as_json:
        yield streams(_line(report.model_dump(mode="json"), request))
    else:
        sheet = sheet_of_motion(as_the_scene(report, scene), scene.title)
        yield streams(as_text(sheet, request.output.width, request.output.colours) + "\n\n")


def _picture(scene: Scene, request: Request) -> Iterator[Json]:
    if request.picture is None:
        raise DofkitError("no picture was asked for")
    kind, path = request.picture
    try:
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        loop = {"loop": True} if kind == "loop" else {}
        getattr(dofkit, _PICTURES[kind])(scene, **loop).save(path)
    except OSError as error:
        raise DofkitError(f"the picture cannot be written to '{path}': {error.strerror or error}") from None
    yield streams(f"{path}\n")


def _line(value: Any, request: Request) -> str:
    """Return one line of JSON."""
    return json.dumps(value, ensure_ascii=request.output.ascii_only) + "\n"


def _fault_streams(request: Request, name: str, faults: tuple[Fault, ...], document: Document | None) -> Json:
    """Return the texts that are printed about the faults of a file."""
    if request.output.as_json:
        return streams(out=_line({"scene": name, "error": _error_object(faults)}, request), errors=len(faults))
    file = STDIN if request.file == "-" else request.file
    text = complaint(file, faults, document, request.output.coloured_errors)
    return streams(err=text + "\n", errors=len(faults))


def _error_object(faults: Iterable[Fault]) -> dict[str, Any]:
    """Return the fields of the first fault, with all further faults under ``faults``."""
    first, *others = [
        {"message": fault.message, "line": fault.line, "column": fault.column, "hint": fault.hint} for fault in faults
    ] or [{"message": "unknown error", "line": None, "column": None, "hint": None}]
    return {**first, "faults": others}


def _faults_of_error(error: Exception) -> tuple[Fault, ...]:
    """Return the faults of an error; an unexpected error becomes one fault, which asks for a report."""
    if isinstance(error, SceneError):
        return error.faults
    if isinstance(error, TextError):
        return (Fault(error.message, hint=error.hint),)
    if isinstance(error, DofkitError):
        return (Fault(str(error)),)
    detail = " ".join(str(error).split())[:200]
    message = f"internal error, {type(error).__name__}" + (f": {detail}" if detail else "")
    return (Fault(message, hint="this is a fault of dofkit, please report it with this scene"),)


#: What a worker calls for the report on a file (first yields {}, once the file is read), for its equations of motion,
#: and for its picture, whose path is printed.
report_lines = partial(answer_lines, answer=_report)
motion_lines = partial(answer_lines, answer=_equations)
picture_lines = partial(answer_lines, answer=_picture)

# certificates


def verification_lines(request: Request) -> Json:
    """Return what is printed about a certificate, with {"status": exit status} as the outcome."""
    try:
        alone = request.file == request.certificate
        checked = dofkit.verify(None if alone else request.file, Path(str(request.certificate)))
    except SceneError as error:
        return _fault_streams(request, request.name, error.faults, None)
    except OSError as error:
        fault = Fault(f"the certificate cannot be read: {error.strerror or error}")
    except (CheckError, DofkitError, ValueError) as error:
        fault = Fault(" ".join(str(error).split()))
    else:
        refused = bool(checked.failed) or (request.strict and bool(checked.uncovered))
        out = _line(checked._asdict(), request) if request.output.as_json else _verification_text(checked)
        return streams(out, outcome={"status": FAILED if refused else 0})
    return _fault_streams(replace(request, file=str(request.certificate)), request.name, (fault,), None)


def _verification_text(checked: Verification) -> str:
    lines = [f"{checked.scene}: {checked.verified} of {checked.claims} claims verified"]
    lines += [f"  failed     {f['path']} by {f['rule']}: {f['why']}" for f in checked.failed]
    lines += [f"  uncovered  {path}" for path in checked.uncovered]
    lines += [f"  trusted    `{written}` is read as `{plain}`" for written, plain in checked.trusted.items()]
    return "\n".join(lines) + "\n"
