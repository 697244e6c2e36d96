"""What `print` and a notebook show of reports, constraints, scenes, linkages, results and equations of motion."""

from __future__ import annotations

import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from typing import Any
from xml.etree import ElementTree

import pytest
from shared.notebook import CELLS

import dofkit
from dofkit.interface.show.page import as_html
from dofkit.interface.show.sheet import Fact, Formula, Remark, Sheet, SheetSection
from dofkit.pictures import still
from dofkit.report import Report

DISC = "disc-rolling-on-plane"


def shown(value: Any) -> str:
    """What a notebook shows, without its style; it is well formed."""
    html: str = value._repr_html_()
    body = re.sub(r"<style>.*?</style>", "", html, flags=re.DOTALL)
    ElementTree.fromstring(body.replace("&#8289;", "").replace("&#160;", " "))
    return body


def words(html: str) -> str:
    """The text of a page, in one line."""
    return " ".join(re.sub(r"<[^>]*>", " ", html).split())


@pytest.mark.sweep
@pytest.mark.parametrize(("command", "asked"), [("classify", dofkit.classify), ("lagrange", dofkit.lagrange)])
def test_print_writes_what_the_command_line_does(command: str, asked: Callable[[str], object]) -> None:
    name = "mass-on-spring"
    process = subprocess.run(
        [sys.executable, "-m", "dofkit", command, name], capture_output=True, text=True, check=True
    )
    assert f"{asked(name)}\n\n" == process.stdout


def test_the_text_has_a_width_and_says_how_where_it_is_asked() -> None:
    report = dofkit.classify(DISC)
    assert max(map(len, report.text(width=50).splitlines())) <= 50
    assert "\nHow\n" not in report.text()
    assert "\nHow\n" in report.text(how=True)
    assert "\x1b" not in report.text()


def test_a_report_is_the_same_with_and_without_what_it_is_about() -> None:
    report = dofkit.classify(DISC)
    again = Report.model_validate(report.model_dump(mode="json"))
    assert again == report
    assert pickle.loads(pickle.dumps(report)) == report
    assert str(again).splitlines()[1:] == str(report).splitlines()[1:]
    assert str(report).startswith(f"{DISC}  Upright disc rolling on a plane\n")
    assert str(again).startswith(f"{DISC}\n")
    assert repr(report).startswith("Report(scene=")


def test_what_a_notebook_offers_of_a_report_are_its_fields() -> None:
    report = dofkit.classify(DISC)
    offered = {name for name in dir(report) if not name.startswith("_")}
    methods = {"with_scene", "table", "text", "to_dict"}
    methods |= {"model_copy", "model_dump", "model_dump_json", "model_validate", "model_validate_json"}
    assert offered == {*Report.model_fields, *methods}
    assert {"constraints", "title", "parse_raw"} - set(dir(dofkit.load(DISC))) == {"parse_raw"}


def test_reprs_are_short_and_name_the_answer() -> None:
    report = dofkit.classify(DISC)
    assert repr(report) == f"Report(scene={DISC!r}, dof=4, velocity_dof=2, verdict='proved')"
    assert repr(report.constraints[0]).startswith("ConstraintEntry(name=")
    for value in (dofkit.load(DISC), report.constraints[0], dofkit.draw(DISC), dofkit.animate(DISC)):
        assert len(repr(value)) < 400


def test_a_report_as_a_mapping_and_as_a_table() -> None:
    report = dofkit.classify("five-particles-ten-links")
    assert Report.model_validate(report.to_dict()) == report
    rows = report.table()
    assert [row["name"] for row in rows] == [entry.name for entry in report.constraints]
    assert {type(value) for row in rows for value in row.values()} <= {str, int, bool, type(None)}
    (redundant,) = [row for row in rows if row["circuit"]]
    assert (redundant["name"], redundant["scene"]) == ("DF", "five-particles-ten-links")


def test_an_error_in_a_notebook_is_one_panel_with_the_location() -> None:
    with pytest.raises(dofkit.SceneError) as caught:
        dofkit.classify({"coordinates": ["x"], "constraints": ["dz = 0"]})
    lines = caught.value._render_traceback_()
    assert lines[0].endswith("SceneError")
    assert lines[1] == '│ in  dofkit.classify({"coordinates": ["x"], "constraints": ["dz = 0"]})'
    assert lines[2] == "│ constraints[0]: `dz` is not declared"
    assert lines[3].startswith("│     hint: ")
    assert lines[4:] == ["│     see: dofkit explain equation", "╰─"]
    assert dofkit.TextError("a term is missing")._render_traceback_()[1] == "│ a term is missing"


def test_a_report_in_a_notebook() -> None:
    html = shown(dofkit.classify(DISC))
    assert "<math" in html
    assert "http" not in html.replace("http://www.w3.org/2000/svg", "")
    assert "non-holonomic, scleronomic" in words(html)
    assert "degrees of freedom 4 dimension of the configuration space" in words(html)
    style = dofkit.classify(DISC)._repr_html_().partition("</style>")[0]
    assert "light-dark(" in style
    assert "[data-jp-theme-light=false] .dofkit" in style


def test_a_constraint_by_itself() -> None:
    entry = dofkit.classify({"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]}).constraints[0]
    assert str(entry).startswith("c1  x dy + y dx = 0\n")
    assert entry._repr_latex_() == (
        r"$\displaystyle \begin{aligned}x \mathrm{d} y + y \mathrm{d} x &= 0 \\ x y &= C\end{aligned}$"
    )
    assert "integral" in words(shown(entry))


def test_a_scene_says_what_it_is_made_of() -> None:
    scene = dofkit.load(
        {
            "name": "rod", "dimension": 2, "parameters": {"l": "positive", "b": 2}, "particles": ["A"],
            "constraints": [{"name": "rod", "type": "link", "between": [[0, 0], "A"], "length": "l"}, "y_A >= x_A"],
            "forces": [{"type": "gravity", "acceleration": "b"}],
        }
    )  # fmt: skip
    assert str(scene).splitlines() == [
        "rod",
        "  world        2 dimensions",
        "  particles    A",
        "  coordinates  x_A, y_A  (2)",
        "  parameters   l (positive), b = 2",
        "Constraints",
        "  name  text                     type",
        "  rod   link (0, 0)-A, length l  link",
        "  c2    y_A >= x_A               equation",
        "Forces",
        "  f1: gravity",
    ]
    assert "<mo>≥</mo>" in shown(scene)


def test_a_linkage_and_a_result() -> None:
    linkage = dofkit.linkage([("A", "B"), ("B", "C"), ("C", "A"), ("A", "C")], 2)
    assert "links 4 of which 3 are independent" in words(shown(linkage))
    assert "redundant : A-C" in words(shown(linkage))
    assert str(linkage) == (
        "3 joints in 2 dimensions, 4 links, 1 redundant: f = N d - rank = 6 - 3 = 3, 0: one rigid body (proved)"
    )
    sheet = {
        "title": "S",
        "problems": [{"id": "d", "title": "D", "scene": DISC, "questions": [{"id": "f", "ask": "dof"}]}],
    }
    result = dofkit.grade(sheet, {"student": "<b>ada</b>", "answers": {"d": {"f": 2}}})
    assert str(result).startswith("<b>ada</b>\n  points  0 of 1\n")
    assert "&lt;b&gt;ada&lt;/b&gt;" in shown(result)


def test_equations_of_motion_with_small_motions() -> None:
    report = dofkit.lagrange("pendulum-angle", linearize=True)
    html = shown(report)
    assert "<mtable>" in html
    assert html.count("<mtable>") == 3
    assert "angular frequency" in html
    assert report.text() == str(report)
    latex = report._repr_latex_()
    assert latex is not None
    assert latex.startswith(r"$\displaystyle \begin{aligned}L &= ")
    assert r"\ddot{\theta}" in latex


def test_nothing_that_is_shown_is_obeyed() -> None:
    bad = '</td><script>alert("1")</script>\x1b[2J'
    sheet = Sheet(
        bad, bad, (bad, "bad"), [Fact(bad, Formula(bad), bad)], [SheetSection(bad, [Remark(bad, bad, bad)], bad)]
    )
    html = as_html(sheet)
    assert "<script>" not in html
    assert "\x1b" not in html


def test_a_picture_is_folded_in_where_pictures_are_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    def svg(scene: dofkit.Scene, report: Report | None) -> str:
        return f"<svg><title>{scene.name} {report and report.dof}</title></svg>"

    monkeypatch.setattr(still, "svg", svg)
    assert "<svg><title>disc-rolling-on-plane 4</title></svg>" in shown(dofkit.classify(DISC))
    assert "<svg><title>disc-rolling-on-plane None</title></svg>" in shown(dofkit.load(DISC))
    monkeypatch.setitem(sys.modules, "dofkit.pictures.still", None)
    assert "<svg>" not in shown(dofkit.classify(DISC))


@pytest.mark.sweep
def test_a_notebook_of_ten_cells_shows_tables() -> None:
    nbformat = pytest.importorskip("nbformat", reason="a notebook needs jupyter")
    nbclient = pytest.importorskip("nbclient", reason="a notebook needs jupyter")
    pytest.importorskip("ipykernel", reason="a notebook needs a kernel")
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code) for code in CELLS])
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    assert len(notebook.cells) == 10
    for cell in notebook.cells:
        (output,) = cell.outputs
        if "print(" in cell.source:
            assert output["text"].startswith("disc-rolling-on-plane  Upright disc")
        else:
            assert output["output_type"] == "execute_result"
            assert '<div class="dofkit">' in output["data"]["text/html"]
            assert "Report(" not in output["data"]["text/plain"]
