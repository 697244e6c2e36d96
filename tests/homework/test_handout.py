"""Sheets for students: what they say, what they never tell, and each format."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

import dofkit
from dofkit.homework.assignment import AssignmentError, Prepared, load_assignment
from dofkit.homework.handout.class_sheets import write_handout
from dofkit.homework.handout.markup import FigureError, formula
from dofkit.homework.handout.reading import declared_of, read_answer
from dofkit.homework.handout.sheets import remarks, written_sheet
from dofkit.homework.questions import KINDS
from dofkit.interface import cli
from dofkit.interface.assignment_commands import drawing
from dofkit.pictures.still import unanswered

PENDULUM: dict[str, Any] = {
    "dimension": 2,
    "parameters": {"l": "positive"},
    "particles": ["A"],
    "constraints": [{"name": "rod", "type": "link", "between": [[0, 0], "A"], "length": "l"}],
}
CURVE: dict[str, Any] = {
    "coordinates": ["x", "y"],
    "constraints": [{"name": "wire", "type": "equation", "text": "y = x^4"}],
}


def sheet(*problems: dict[str, Any], **more: Any) -> Prepared:
    return load_assignment({"title": "Sheet 1", "problems": list(problems), **more})


def pendulum(**more: Any) -> dict[str, Any]:
    asked = [{"id": "f", "ask": "dof"}, {"id": "rod", "ask": "equation", "constraint": "rod", "points": 3}]
    return {"id": "pendulum", "scene": PENDULUM, "questions": asked, **more}


def test_points_of_a_problem_are_shared_as_its_questions_have_them() -> None:
    (problem,) = sheet(pendulum(points=10)).assignment.problems
    assert [float(q.points) for q in problem.questions] == [2.5, 7.5]


def test_a_place_that_no_value_fills_is_reported() -> None:
    with pytest.raises(AssignmentError, match=r"\[\[rodd\]\] is not a name in `vary`") as caught:
        sheet(pendulum(text="The rod is [[rodd]]."))
    assert all(fault.hint for fault in caught.value.faults)


def test_a_sheet_says_what_is_asked_and_what_things_are_called() -> None:
    text = "A rod of $\\frac{1}{2}$."
    told = written_sheet(sheet(pendulum(text=text, points=4)), drawing()).markdown
    assert "A rod of $\\frac{1}{2}$." in told
    assert "- `rod`: link (0, 0)-A, length l\n" in told
    assert "- $x_A$, $y_A$: position of A." in told
    assert "- $l$: positive constant." in told
    assert "1. How many degrees of freedom does the system have? (1 point) `pendulum.f`" in told
    assert "2. Which equation or equations express the constraint `rod`? (3 points) `pendulum.rod`" in told
    assert told.count("![Figure 1](figures/pendulum.svg)") == 1


def test_an_equation_that_is_asked_for_is_not_told() -> None:
    asked = [{"id": "e", "ask": "equation", "constraint": "wire"}]
    prepared = sheet({"id": "wire", "scene": CURVE, "questions": asked})
    told = written_sheet(prepared, drawing()).markdown
    assert "x^4" not in told
    assert [r for r in remarks(prepared) if "describe the system in `text`" in r]
    labelled = sheet({"id": "wire", "scene": CURVE, "questions": [{"id": "l", "ask": "label", "constraint": "wire"}]})
    assert "$y = x^4$" in written_sheet(labelled, drawing()).markdown


@pytest.mark.parametrize(
    "name", ["four-bar-linkage", "five-particles-ten-links", "simple-pendulum-link", "disc-rolling-on-plane"]
)
def test_a_picture_tells_nothing_of_the_answer(name: str) -> None:
    scene = dofkit.load(name)
    picture = unanswered(scene, dofkit.classify(scene), "Problem")
    assert picture is not None
    told = picture.svg()
    for word in ("freedom", "proved", "redundant", "moves", "held still", "contradict"):
        assert word not in told.lower()
    assert dofkit.draw(scene).svg().lower().count("freedom")


def test_a_set_of_coordinates_is_not_drawn() -> None:
    scene = dofkit.load("x-dy-plus-y-dx")
    assert unanswered(scene, dofkit.classify(scene), "Problem") is None


def test_a_lecturer_is_reported_what_a_sheet_does_not_say() -> None:
    scene = {"coordinates": ["x"], "parameters": ["m"], "energies": {"kinetic": "1/2 m xdot^2"}}
    asked = {"id": "p", "scene": scene, "questions": [{"id": "l", "ask": "lagrangian"}]}
    assert [r for r in remarks(sheet(asked)) if "state them in `text`" in r]
    assert not list(remarks(sheet({**asked, "text": "A free particle of mass $m$."})))
    assert "xdot^2" not in "".join(written_sheet(sheet(asked), drawing()).markdown.split("##")[1:2])


def test_every_kind_of_question_can_be_explained() -> None:
    for cls in KINDS.values():
        assert cls.words().wanted.endswith(("?", "."))
        assert cls.words().how.endswith(".")


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("l^2", "l^{2}"),
        (r"\frac{g}{l}", r"\frac{g}{l}"),
        (r"\dot x", r"\dot x"),
        ("thetadot", r"\dot{\theta}"),
        (r"\sqrt{2}", r"\sqrt{2}"),
        (r"\vec F", r"\vec F"),
    ],
)
def test_formulas(text: str, latex: str) -> None:
    found = formula(text)
    assert found.latex == latex
    assert found.mathml is not None
    ElementTree.fromstring(f"<math>{found.mathml}</math>")


def test_a_formula_that_cannot_be_set_is_shown_as_typed_and_told() -> None:
    prepared = sheet(pendulum(text=r"See $\frac{1$ and <script>alert(1)</script>."))
    assert [r for r in remarks(prepared) if r"$\frac{1$ cannot be typeset" in r]


def test_the_page_needs_no_network_and_runs_nothing(tmp_path: Path) -> None:
    out = tmp_path / "sheet.html"
    text = "See <script>alert(1)</script> and [this](javascript:alert(1)).\n\n![x](http://example.org/a.png)"
    with pytest.raises(FigureError):
        written_sheet(sheet(pendulum(text=text)), drawing())
    text = "See <script>alert(1)</script> and [this](javascript:alert(1))."
    write_handout(sheet(pendulum(text=text)), "html", drawing(), out)
    page = out.read_text(encoding="utf-8")
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    assert not re.search(r'(src|href)="(?!data:)', page)
    assert page.count("<math") == 3
    assert "prefers-color-scheme: dark" in page
    hostile = pendulum(text=text, title="</script><script>alert(2)</script>")
    write_handout(sheet(hostile), "page", drawing(), out, "</script><img src=x onerror=alert(3)>")
    page = out.read_text(encoding="utf-8")
    assert page.count("<script") == page.count("</script") == 2
    assert "<img src=x" not in page


def test_an_answer_is_read_by_the_names_of_the_sheet_as_grading_reads_it() -> None:
    more = [{"id": "q", "ask": "coordinates"}, {"id": "l", "ask": "label", "constraint": "rod"}]
    asked = [*pendulum()["questions"], *more]
    prepared = sheet(pendulum(questions=asked, also={"phi": "atan2(x_A, -y_A)"}))
    (problem,) = prepared.assignment.problems
    declared = json.dumps(declared_of(problem, prepared.keys["pendulum"].scene))
    given = {"f": "f = 1", "rod": "x_A² + y_A² = l²", "q": "phi", "l": "holonom, skleronom"}
    result = dofkit.grade(prepared, {"student": "ada", "answers": {"pendulum": given}})
    for item in result.items:
        assert read_answer(declared, item.question, given[item.question], "en")["read_as"] == item.read_as
        assert item.status == "right"
    unread = read_answer(declared, "rod", "x_A + zz = (1", "de")
    assert (unread["column"], "geschlossen" in unread["fault"]) == (12, True)


def test_a_figure_of_a_file(tmp_path: Path) -> None:
    (tmp_path / "own.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>')
    prepared = load_assignment({"title": "T", "problems": [pendulum(figure="own.svg")]}, base=tmp_path)
    found = written_sheet(prepared, drawing())
    assert found.figures["figures/pendulum.svg"].data.startswith(b"<svg")
    for wrong in ("own.txt", "nothing.png"):
        with pytest.raises(FigureError):
            written_sheet(load_assignment({"title": "T", "problems": [pendulum(figure=wrong)]}, tmp_path), drawing())
    assert not written_sheet(sheet(pendulum(figure="none")), drawing()).figures


def test_markdown_has_latex_for_other_readers(tmp_path: Path) -> None:
    write_handout(sheet(pendulum(text="angle $theta$, typed `$theta$`")), "md", drawing(), tmp_path / "s.md")
    told = (tmp_path / "s.md").read_text(encoding="utf-8")
    assert "angle $\\theta$, typed `$theta$`" in told
    assert (tmp_path / "figures" / "pendulum.svg").exists()


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = tmp_path / "sheet.yaml"
    made.write_text(
        "title: One\nproblems:\n- {id: p, scene: simple-pendulum-link, questions: [{id: f, ask: dof}]}\n",
        encoding="utf-8",
    )
    (tmp_path / "runtime.js").touch()
    page = ["--format", "page", "--out", str(tmp_path / "to" / "p.html"), "--runtime", str(tmp_path / "runtime.js")]
    for options in ([], ["--format", "md"], page):
        cli.app(["assignment", "handout", str(made), *options], standalone_mode=False)
    written = [made.with_suffix(".html"), made.with_suffix(".md"), tmp_path / "to" / "p.html"]
    assert capsys.readouterr().out.splitlines() == [str(path) for path in written]
    assert all(path.exists() for path in (*written, tmp_path / "to" / "runtime.js"))
    (tmp_path / "roster.csv").write_text("name,email\nAda,ada@x\nGrace,grace@x\n", encoding="utf-8")
    everyone = ["--roster", str(tmp_path / "roster.csv"), "--out", str(tmp_path / "all"), "--runtime", "nothing.js"]
    cli.app(["assignment", "handout", str(made), "--format", "page", *everyone], standalone_mode=False)
    assert {path.name for path in (tmp_path / "all").iterdir()} == {"ada@x.html", "grace@x.html"}
    assert "--runtime" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        cli.app(["assignment", "handout", str(made), "--format", "docx"])
    for wrong in (["--out", "sheet.pdf", "--format", "html"], ["--out", "sheet.docx"], ["--out", "sheet"]):
        with pytest.raises(SystemExit, match="2"):
            cli.app(["assignment", "handout", str(made), *wrong])
    sheet = made.with_name("sheet.md")
    cli.app(["assignment", "handout", str(made), "--out", str(sheet)], standalone_mode=False)
    assert sheet.read_text(encoding="utf-8").startswith("#")
    assert "docx" in capsys.readouterr().err
