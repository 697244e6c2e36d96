"""What the bench and the practice sheets ask of Python: each function takes texts, and returns what JSON can hold.

Nothing returned is HTML. A formula is `{"text", "math"}`, its MathML as a text of which a page takes known elements
only; everything else is shown as text.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from dofkit.base.errors import DofkitError, Fault, SceneError
from dofkit.homework.sentences import Language
from dofkit.interface.show.decimals import as_the_scene
from dofkit.interface.show.page import mathematics_of
from dofkit.interface.show.report import changed, sheet_of_report
from dofkit.interface.show.sheet import Content, Formula, Grid, Sheet, SheetSection
from dofkit.methods.classify import classify
from dofkit.scene.names import coordinate_table
from dofkit.scene.reading import loads
from dofkit.scene.scene import Scene, without

Json = dict[str, Any]
#: Seconds for one report.
BUDGET = 60.0


def answer(call: str, arguments: str) -> str:
    """Return what the function called ``call`` says, as JSON; what is no scene or was not read gives its faults."""
    try:
        value = CALLS[call](*json.loads(arguments))
    except SceneError as error:
        value = {"faults": [_fault(fault) for fault in error.faults]}
    except DofkitError as error:
        value = {"faults": [_fault(Fault(str(error)))]}
    return json.dumps(value)


def check(text: str) -> Json:
    """Return the names that a scene declares, for completion."""
    scene = loads(text)
    names = [c.name for c in coordinate_table(scene).coordinates]
    names += [*scene.parameters, *scene.functions, *(p.name for p in scene.particles), *(b.name for b in scene.bodies)]
    return {"faults": [], "names": names}


def report(text: str, left_out: Sequence[str]) -> Json:
    """Return the report on a scene without the constraints that are left out, and what that changes."""
    whole = loads(text)
    names = _constraint_names(whole)
    dropped = [name for name in left_out if name in names]
    scene = without(whole, dropped) if dropped else whole
    found = classify(scene, budget=BUDGET)
    sections = [changed(classify(whole, budget=BUDGET), found, dropped)] if dropped else []
    sheet = sheet_of_report(as_the_scene(found, scene), whole.title)
    return {
        "faults": [],
        "sheet": _sheet(sheet._replace(sections=(*sections, *sheet.sections))),
        "constraints": names,
        "report": found.model_dump(mode="json"),
    }


def _constraint_names(scene: Scene) -> list[str]:
    return [constraint.name or f"c{i}" for i, constraint in enumerate(scene.constraints, 1)]


def picture(text: str) -> Json:
    """Return the picture of a scene as SVG, and what it says in words. Raises ImportError without numpy."""
    from dofkit.pictures.still import draw  # it needs numpy

    drawn = draw(loads(text))
    return {"svg": drawn.svg(), "alternative": drawn.alternative}


def motion(text: str) -> Json:
    """Return what the player shows of a scene. Raises ImportError without numpy."""
    from dofkit.pictures.animation import animate
    from dofkit.pictures.player import player_data

    moving = animate(loads(text))
    data = player_data(moving.sketch, moving.clips)
    return {"data": data, "alternative": moving.sketch.alternative, "notes": list(moving.sketch.notes)}


def equations(text: str) -> Json:
    """Return the equations of motion. Raises ImportError without SymPy."""
    from dofkit.interface.show.motion import sheet_of_motion
    from dofkit.motion.lagrange.equations import lagrange

    scene = loads(text)
    return {"sheet": _sheet(sheet_of_motion(as_the_scene(lagrange(scene), scene), scene.title))}


def as_json(text: str) -> Json:
    """Return a scene as a mapping, without what is at its default."""
    return {"scene": loads(text).model_dump(mode="json", exclude_defaults=True, exclude_none=True)}


def read(declared: str, question: str, text: str, language: Language) -> Json:
    """Return how an answer of a sheet is read, set as a formula where it is one, or why it cannot be read."""
    from dofkit.homework.handout.page_sheets import read_answer

    reading = read_answer(declared, question, text, language)
    if "read_as" in reading:
        text = reading["read_as"]
        reading["shown"] = _content(Formula(text)) if reading["formula"] else text
    return reading


def judge(assignment: str, answers: Mapping[str, Mapping[str, str]]) -> Json:
    """Return the judgement of each answer of a practice sheet."""
    from dofkit.homework.handout.page_sheets import judge_answers

    return {"items": judge_answers(assignment, answers)}


def _fault(fault: Fault) -> Json:
    return {
        "message": fault.message,
        "line": fault.line or 1,
        "column": fault.column or 1,
        "hint": fault.hint or "",
    }


def _sheet(sheet: Sheet) -> Json:
    """Return a printed sheet, its formulas with their MathML."""
    return {
        "name": sheet.name,
        "title": _content(sheet.title),
        "alarm": sheet.alarm,
        "facts": [[fact.label, _content(fact.value), fact.note, fact.tone] for fact in sheet.facts],
        "sections": [_section(section) for section in sheet.sections],
    }


def _section(section: SheetSection) -> Json:
    parts = []
    for part in section.content:
        if isinstance(part, Grid):
            heads = [[column.head, column.numbers] for column in part.columns]
            parts.append({"heads": heads, "rows": [[_content(cell) for cell in row] for row in part.rows]})
        else:
            parts.append({"label": _content(part.label), "text": _content(part.text), "note": part.note})
    return {"heading": section.heading, "parts": parts, "more": section.more}


def _content(content: Content) -> str | Json:
    math = None if isinstance(content, str) else mathematics_of(content)
    return str(content) if math is None else {"text": str(content), "math": math}


CALLS: Mapping[str, Callable[..., Json]] = {
    call.__name__: call for call in (check, report, picture, motion, equations, as_json, read, judge)
}
