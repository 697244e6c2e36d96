"""A user's text is data: no name, title or equation is ever a format, a regular expression or markup."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import CATALOG, few, report_of, scene_of, stem
from shared.sources import nodes_of, one_process

import dofkit
from dofkit.expressions.text.typesetting import typeset
from dofkit.homework.handout.markup import page_of

#: What formats, patterns, the terminal's markup, HTML, Markdown, LaTeX and templates would each take for their own.
ODD = r"""{x} {0} {{body}} %s %(x)s \1 (a|b)* [red]b[/red] <script>alert(1)</script> "q" 'p' \d $z$ **b** `c` &lt;"""
#: An equation of which the second says the same, in LaTeX; the coordinates; the degrees of freedom.
DOUBLED = (
    (["x = 2", r"\frac{x}{2} = 1"], ["x"], 0),
    ([r"x = R \phi", r"\dot{x} = R\dot{\phi}"], ["x", "phi"], 1),
    (["x = 2", r"\sqrt{x} = \sqrt{2}"], ["x"], 0),
)


def shown(scene: dict[str, Any]) -> dofkit.Report:
    """The report, after it was written in every way: nothing of the user's text is lost or obeyed."""
    report = dofkit.classify(scene)
    lines = "".join(str(report).split())
    assert all("".join(entry.name.split()) in lines for entry in report.constraints)
    assert json.loads(report.model_dump_json())["constraints"][-1]["name"] == report.constraints[-1].name
    page = report._repr_html_() + dofkit.draw(scene).html() + dofkit.draw(scene).svg()
    assert "<script>alert" not in page
    return report


@pytest.mark.parametrize(("texts", "coordinates", "dof"), DOUBLED)
@pytest.mark.parametrize("names", [("c1", "c2"), (f"{ODD} 1", f"{ODD} 2")])
def test_an_equation_doubled_in_latex(
    texts: list[str], coordinates: list[str], dof: int, names: tuple[str, str]
) -> None:
    rows = [{"type": "equation", "text": text, "name": name} for text, name in zip(texts, names, strict=True)]
    kinetic = " + ".join(f"{q}dot^2/2" for q in coordinates)
    scene = {"title": ODD, "coordinates": coordinates, "parameters": {"R": "positive"}, "constraints": rows}
    assert str(dofkit.lagrange({**scene, "energies": {"kinetic": kinetic}}))
    report = shown(scene)
    assert (report.dof, report.redundant, report.redundant_equations) == (dof, [names[1]], 1)


@pytest.mark.parametrize("path", few("user text", CATALOG, 12), ids=stem)
def test_a_constraint_doubled_under_odd_names(path: Path) -> None:
    """The copy is redundant, and nothing else changes; every name and the title are shown as they were written."""
    document: dict[str, Any] = scene_of(path).model_dump(mode="json", exclude_unset=True)
    written = {key: value for key, value in document.items() if key not in ("expect", "energies", "name")}
    own = report_of(path)
    rows = [{**row, "name": f"{ODD} {i}"} for i, row in enumerate(written.get("constraints", []))]
    texts = [row for row in rows if row["type"] == "equation" and "=" in row["text"] and "<" not in row["text"]]
    copied = {**(texts or rows or [{"type": "equation", "text": "0 = 0"}])[0], "name": f"{ODD} copy"}
    if texts and (latex := typeset(copied["text"])) is not None:
        copied["text"] = re.sub(r"\\mathrm\{(\w+)\}\s*", r"\1", latex)
    report = shown({**written, "title": ODD, "constraints": [*rows, copied]})
    assert (report.consistent, report.dof, report.velocity_dof) == (own.consistent, own.dof, own.velocity_dof)
    assert report.redundant is None or own.redundant is None or len(report.redundant) >= len(own.redundant)
    assert [entry.name for entry in report.constraints] == [row["name"] for row in [*rows, copied]]


def test_a_sheet_with_an_odd_title() -> None:
    page = page_of("text", ODD, "en", {})
    assert "{{body}}" in page
    assert "<script>alert" not in page


#: Files that format templates which they or their tables hold, under a name that does not say so.
OWN_TEMPLATES = {
    "base/yaml_events.py",
    "expressions/text/printing.py",
    "homework/sentences/__init__.py",
    "scene/constraints/base.py",
    "scene/fields.py",
}


@one_process
def test_nothing_but_a_constant_is_a_format() -> None:
    """What stands before ``.format`` is a text in the code, or a constant by its name."""
    files = set()
    for name, call in nodes_of(ast.Call):
        function = call.func
        if isinstance(function, ast.Attribute) and function.attr in ("format", "format_map"):
            template = function.value.value if isinstance(function.value, ast.Subscript) else function.value
            if not (isinstance(template, ast.Constant) or (isinstance(template, ast.Name) and template.id.isupper())):
                files.add(name)
    assert {name for name in files if not name.startswith("benchmark/")} == OWN_TEMPLATES


def test_an_assignment_with_odd_texts_is_graded() -> None:
    scene = {"coordinates": ["x"], "constraints": [{"type": "equation", "name": ODD, "text": r"\frac{x}{2} = 1"}]}
    questions = [{"id": "f", "ask": "dof", "points": 1}, {"id": "c", "ask": "label", "constraint": ODD, "points": 1}]
    problem = {"id": "p", "title": ODD, "scene": scene, "questions": questions}
    answers = {"p": {"f": "0", "c": ODD}}
    result = dofkit.grade({"title": ODD, "problems": [problem]}, {"student": "Ada", "answers": answers})
    assert result.items[0].status == "right"
    assert result.items[1].answer == ODD
