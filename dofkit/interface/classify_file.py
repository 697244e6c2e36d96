"""One file of the command line, from its bytes to the lines that are printed; this runs in a worker."""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Iterator
from typing import Any

from dofkit.base.documents import Document
from dofkit.base.errors import DofkitError, Fault, SceneError, TextError
from dofkit.base.workers import Json
from dofkit.classification.undecided import undecided
from dofkit.interface.show.faults import complaint
from dofkit.interface.supervised import STDIN, Cut, Given
from dofkit.methods.stages import stages
from dofkit.report import Report
from dofkit.scene.reading import SceneFile, find


def told(given: Given) -> Iterator[Json]:
    """What is printed of a file: ``out``, ``err`` and whether it ``failed``; before that a sketch as a ``report``."""
    name, document = given.name, None
    try:
        name, data = find(given.file) if given.data is None else (name, given.data)
        read = SceneFile.read(data, name)
        document = read.document
        scene = read.scene(checked=False)
        try:
            reports = stages(scene, given.budget, given.method)
            first = next(reports)
            yield {"report": first.model_dump(mode="json"), "title": scene.title}
            report = next(reports, first)
        except SceneError as error:
            raise read.located(error) from None
        yield printed(_shown(report, scene.title, given))
    except MemoryError:
        raise
    except Exception as error:
        yield unread(given, name, faults_of_error(error), document)


def cut_short(cut: Cut) -> Json:
    """What is printed where `told` was cut short: of a scene that was read, that nothing was decided."""
    if cut.value is not None and "report" in cut.value:
        report = undecided(Report.model_validate(cut.value["report"]), cut.reason)
        return printed(_shown(report, cut.value["title"], cut.given))
    fault = Fault(f"it could not be read: {cut.reason}", hint="make the scene smaller, or split it")
    return unread(cut.given, cut.given.name, (fault,), None)


def printed(out: str = "", err: str = "", failed: bool = False) -> Json:
    """What goes to standard output and to standard error."""
    return {"out": out, "err": err, "failed": failed}


def _shown(report: Report, title: str | None, given: Given) -> str:
    if given.as_json:
        return line(report.model_dump(mode="json"), given)
    from rich.console import Console

    from dofkit.interface.show.terminal import as_text

    console = Console()
    if given.terminal is not None:
        width, colours = given.terminal
        system: Any = colours
        console = Console(file=io.StringIO(), width=width, force_terminal=colours is not None, color_system=system)
    return as_text(report, title, console) + "\n\n"


def line(value: Any, given: Given) -> str:
    """One line of JSON."""
    return json.dumps(value, ensure_ascii=given.ascii_only) + "\n"


def unread(given: Given, name: str, faults: tuple[Fault, ...], document: Document | None) -> Json:
    """What is printed of a file that could not be read, or not be answered."""
    if given.as_json:
        return printed(out=line({"scene": name, "error": error_object(faults)}, given), failed=True)
    return printed(err=complaint(STDIN if given.file == "-" else given.file, faults, document) + "\n", failed=True)


def error_object(faults: Iterable[Fault]) -> dict[str, Any]:
    """The first fault, with all further ones under ``faults``."""
    first, *others = [
        {"message": fault.message, "line": fault.line, "column": fault.column, "hint": fault.hint} for fault in faults
    ] or [{"message": "unknown error", "line": None, "column": None, "hint": None}]
    return {**first, "faults": others}


def faults_of_error(error: Exception) -> tuple[Fault, ...]:
    """What went wrong, as faults."""
    if isinstance(error, SceneError):
        return error.faults
    if isinstance(error, TextError):
        return (Fault(error.message, hint=error.hint),)
    return (Fault(str(error)) if isinstance(error, DofkitError) else internal(error),)


def internal(error: Exception) -> Fault:
    """A fault of dofkit's own, told in one line."""
    said = " ".join(str(error).split())[:200]
    message = f"internal error, {type(error).__name__}" + (f": {said}" if said else "")
    return Fault(message, hint="this is a fault of dofkit, please report it with this scene")
