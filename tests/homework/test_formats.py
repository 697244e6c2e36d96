"""The forms in which results are written: every field by hand, and whatever a student may be called or write."""

from __future__ import annotations

import doctest
import importlib
import io
import json
import shutil
import subprocess
from collections.abc import Iterable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from dofkit.homework.assignment import Prepared, load_assignment
from dofkit.homework.formats import FORMATS, FormatError
from dofkit.homework.formats.base import MOST_CHARACTERS, cell
from dofkit.homework.formats.html import Submitted, overview
from dofkit.homework.formats.prairielearn import MOST_BYTES
from dofkit.homework.formats.review import queue_of, write_page
from dofkit.homework.formats.wording import identity
from dofkit.homework.result import Item, Result, Status

ROD = {
    "dimension": 2,
    "parameters": {"l": "positive"},
    "particles": ["A"],
    "constraints": [{"name": "rod", "type": "link", "between": [[0, 0], "A"], "length": "l"}],
}
DOCUMENTS = ["gradescope", "prairielearn", "coursera"]
MARKUP = "<script>alert(1)</script>"
FORMULA = "=cmd|'/C calc'!A0"


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    questions = [
        {"id": "f", "ask": "dof", "points": 2},
        {"id": "rod", "ask": "equation", "constraint": "rod", "points": 8},
    ]
    return load_assignment(
        {"title": "Sheet 1", "visibility": "visible", "problems": [{"id": "p", "scene": ROD, "questions": questions}]}
    )


def item(status: Status, question: str, score: float | None, most: float, **more: Any) -> Item:
    fields = {"problem": "p", "codes": [], "read_as": "", "feedback": "", **more}
    return Item(question=question, score=score, max_score=most, status=status, **fields)


def result(student: str, *items: Item) -> Result:
    score = sum(i.score or 0.0 for i in items)
    review = sum(i.status == "needs_review" for i in items)
    return Result(student=student, score=score, max_score=10.0, items=list(items), needs_review=review)


RIGHT = item("right", "f", 2.0, 2.0, read_as="1")
PARTLY = item("partly", "rod", 4.0, 8.0, codes=["IRREGULAR"], read_as="x = 0", feedback="It is a square.")
OPEN = item("needs_review", "rod", None, 8.0, read_as="x_A = 1", feedback="The time was not enough.")
UNCERTAIN = OPEN.model_copy(update={"certain": False})
UNREADABLE = item("unreadable", "rod", 0.0, 8.0, feedback="'zz' is no name.", column=3)
REFUSED = Result(student="ada", score=None, max_score=10.0, items=[], error="line 3: <b>no</b> JSON")


def streamed(name: str, prepared: Prepared, *results: Result) -> str:
    stream = io.StringIO()
    FORMATS[name].write(results, prepared, stream, None)
    return stream.getvalue()


def document(name: str, prepared: Prepared, *results: Result) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(streamed(name, prepared, *results))
    return found


DOCUMENTED = ["review", "formats.wording", "formats.base", "formats.gradebooks", "answers.words", "answers.roster",
              "answers.submission"]  # fmt: skip


@pytest.mark.parametrize("module", DOCUMENTED)
def test_documentation(module: str) -> None:
    outcome = doctest.testmod(importlib.import_module(f"dofkit.homework.{module}"))
    assert outcome.failed == 0
    assert outcome.attempted > 0


def test_gradescope(prepared: Prepared) -> None:
    assert document("gradescope", prepared, result("ada", RIGHT, PARTLY)) == {
        "score": 6.0,
        "output": "Points: 6 of 10.",
        "output_format": "text",
        "visibility": "visible",
        "extra_data": {"student": "ada", "needs_review": 0, "open_points": 0, "error": None, "doubt": None},
        "tests": [
            {
                "name": "p.f", "score": 2.0, "max_score": 2.0, "status": "passed",
                "output": "Correct.\nRead as: 1", "output_format": "text", "tags": [], "visibility": "visible",
                "extra_data": {"status": "right", "max_score": 2.0},
            },
            {
                "name": "p.rod", "score": 4.0, "max_score": 8.0, "status": "failed",
                "output": "Partly correct.\nRead as: x = 0\nIt is a square.", "output_format": "text",
                "tags": ["IRREGULAR"], "visibility": "visible",
                "extra_data": {"status": "partly", "max_score": 8.0},
            },
        ],
    }  # fmt: skip


def test_gradescope_leaves_open_answers_without_points(prepared: Prepared) -> None:
    found = document("gradescope", prepared, result("ada", RIGHT, OPEN))
    assert found["score"] == 2.0
    assert found["output"].startswith("Points so far: 2 of 10. This is not final")
    assert found["extra_data"]["open_points"] == 8.0
    assert not {"score", "max_score", "status"} & set(found["tests"][1])
    assert "The time was not enough." in found["tests"][1]["output"]
    assert "hidden" not in json.dumps(found)


def test_prairielearn(prepared: Prepared) -> None:
    assert document("prairielearn", prepared, result("ada", RIGHT, PARTLY)) == {
        "gradable": True,
        "score": 0.6,
        "message": "Points: 6 of 10.",
        "tests": [
            {"name": "p.f", "description": "Read as: 1", "points": 2.0, "max_points": 2.0,
             "message": "Correct.\nRead as: 1", "output": ""},
            {"name": "p.rod", "description": "Read as: x = 0", "points": 4.0, "max_points": 8.0,
             "message": "Partly correct.\nRead as: x = 0\nIt is a square.", "output": ""},
        ],
    }  # fmt: skip


@pytest.mark.parametrize(
    ("second", "error"),
    [
        (UNREADABLE, "p.rod (column 3): 'zz' is no name."),
        (UNCERTAIN, "p.rod: It reads in several ways, or in names that are not declared: x_A = 1"),
    ],
)
def test_prairielearn_takes_no_attempt(second: Item, error: str, prepared: Prepared) -> None:
    found = document("prairielearn", prepared, result("ada", RIGHT, second))
    assert found["gradable"] is False
    assert "score" not in found
    assert found["format_errors"] == [error]
    assert found["tests"] == []
    assert "2" not in found["message"]
    assert found["message"].startswith("This submission was not graded and did not use an attempt.")


def test_prairielearn_takes_no_attempt_for_a_refused_submission(prepared: Prepared) -> None:
    found = document("prairielearn", prepared, REFUSED)
    assert (found["gradable"], found["format_errors"]) == (False, ["line 3: <b>no</b> JSON"])


@pytest.mark.parametrize("status", ["right", "unreadable"])
def test_prairielearn_stays_below_a_megabyte(status: Status, prepared: Prepared) -> None:
    long = [item(status, f"q{i}", 1.0, 1.0, read_as="ä" * 2000, feedback="é" * 9000) for i in range(20)]
    many = [item(status, f"q{i}", 1.0, 1.0, feedback="é" * 10) for i in range(7000)]
    for items in (long, many):
        text = streamed("prairielearn", prepared, result("ada", *items))
        assert len(text.encode()) <= MOST_BYTES
        assert json.loads(text)["gradable"] is (status == "right")


@pytest.mark.parametrize(
    ("items", "share", "start"),
    [
        ((RIGHT, PARTLY), 0.6, "Points: 6 of 10."),
        ((RIGHT, OPEN), 0.6, "This score is provisional: it includes half of the points (4 of 8)"),
        ((OPEN,), 0.4, "This score is provisional: "),
        ((RIGHT, UNREADABLE), 0.2, "Some answers could not be read (points: 8). Write them differently and submit"),
        ((RIGHT, UNCERTAIN), 0.2, "Some answers could not be read (points: 8). Write them differently and submit"),
        ((), 0.0, "Points: 0 of 10."),
    ],
)
def test_coursera(items: tuple[Item, ...], share: float, start: str, prepared: Prepared) -> None:
    found = document("coursera", prepared, result("ada", *items))
    assert sorted(found) == ["feedback", "fractionalScore"]
    assert found["fractionalScore"] == pytest.approx(share)
    assert found["feedback"].startswith(start)


HOSTILE = [
    MARKUP, FORMULA, "+1+cmd", "-2+3", "@SUM(A1)", "\t=1", " =1", "\r=1", "＝1", "a\nb,c\"d", "a\0b", "\u202eabc",
    "\ud800", "", "  ", "../../../etc/passwd", "con", "index", ".hidden", "x" * 5000, "אבג", "{{ 7*7 }}", "\x1b[31m",
    "</title><b>", "a\u2028=b", "|calc",
]  # fmt: skip


@pytest.mark.parametrize("text", HOSTILE)
def test_cells_hold_no_formula(text: str) -> None:
    shown = cell(text)
    assert not shown.lstrip().startswith(("=", "+", "-", "@", "\t", "\r", "＝", "|"))
    assert len(shown) <= MOST_CHARACTERS + 1


@pytest.mark.parametrize(
    "disguise", ["ada\u200e", "\u202eada", " ada", "ada ", "ada\n", "ada\0", "a\u200bda", "ada\u00a0"]
)
def test_no_student_is_taken_for_another(disguise: str) -> None:
    assert "\ufffd" in identity(disguise)


def odd(text: str) -> Result:
    answers = [item("wrong", "f", 0.0, 2.0, read_as=text, feedback=text, codes=[text]),
               item("unreadable", text, 0.0, 0.0, problem=text, feedback=text)]  # fmt: skip
    return result(text, *answers)


@pytest.mark.parametrize("name", DOCUMENTS)
def test_documents_of_hostile_students(name: str, prepared: Prepared, tmp_path: Path) -> None:
    FORMATS[name].write([*map(odd, HOSTILE)], prepared, tmp_path / "out", None)
    files = list((tmp_path / "out").iterdir())
    assert len(files) == len(HOSTILE)
    assert list(tmp_path.iterdir()) == [tmp_path / "out"]
    for file in files:
        text = file.read_text(encoding="ascii")
        json.loads(text)
        assert "\\u001b" not in text
        assert "\\u0000" not in text
        assert "\\ud8" not in text


@pytest.mark.parametrize("name", DOCUMENTS)
def test_a_file_holds_one_student(name: str, prepared: Prepared, tmp_path: Path) -> None:
    target = tmp_path / "new" / "results.json"
    FORMATS[name].write([result("ada", RIGHT)], prepared, target, None)
    assert json.loads(target.read_text())
    with pytest.raises(FormatError, match="--out"):
        FORMATS[name].write([result("ada", RIGHT), result("bob", RIGHT)], prepared, target, None)
    with pytest.raises(FormatError, match="no submission"):
        FORMATS[name].write([], prepared, tmp_path / "none.json", None)


@pytest.mark.parametrize("name", FORMATS)
def test_an_empty_run(name: str, prepared: Prepared, tmp_path: Path) -> None:
    target = tmp_path / ("out.csv" if name in ("canvas", "moodle", "native") else "out")
    FORMATS[name].write([], prepared, target, None)
    expected = {"canvas": 2, "moodle": 1, "native": 0}
    if target.is_file():
        assert len(target.read_text().splitlines()) == expected[name]
    elif name == "html":
        assert "There are no submissions yet." in (target / "index.html").read_text()
    else:
        assert list(target.iterdir()) == []


class Page(HTMLParser):
    """What is in a page: its tags, and what they refer to."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.attributes: set[str] = set()
        self.links: list[str] = []
        self.shown = ""
        self.scripts = 0
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.scripts += tag == "script"
        self.attributes |= {name for name, _ in attrs}
        self.links += [value or "" for name, value in attrs if name in ("href", "src", "action", "data", "srcset")]

    def handle_data(self, data: str) -> None:
        self.shown += f" {data}"


def pages(prepared: Prepared, folder: Path, results: Iterable[Result]) -> dict[str, Page]:
    given = list(results)
    FORMATS["html"].write(given, prepared, folder, None)
    if (queue := queue_of(given, prepared)).open_answers():
        write_page(queue, [], prepared, folder / "review.html", "review.csv")
    files = sorted(folder.rglob("*.html"))
    return {str(file.relative_to(folder)): Page(file.read_text(encoding="utf-8")) for file in files}


def test_pages_of_hostile_students(prepared: Prepared, tmp_path: Path) -> None:
    reviews = [odd(text).model_copy(update={"student": f"{text}!"}) for text in HOSTILE]
    for given in reviews:
        given.items[0] = item("needs_review", "f", None, 2.0, read_as=MARKUP, feedback=MARKUP)
    refused = [REFUSED.model_copy(update={"student": text, "error": text or "?"}) for text in HOSTILE]
    found = pages(prepared, tmp_path, [*map(odd, HOSTILE), *reviews, *refused])
    assert len(found) == 3 * len(HOSTILE) + 2
    for name, page in found.items():
        assert not page.tags & {"img", "iframe", "object", "embed", "link", "base", "form", "b"}
        assert page.scripts == (name == "review.html")  # the form, which saves what a person decides
        assert not {name for name in page.attributes if name.startswith("on")}
        assert "\0" not in page.shown
        assert "\u202e" not in page.shown
        assert "49" not in page.shown.replace("{{ 7*7 }}", "").split()
    index = found.pop("index.html")
    assert sorted(set(index.links)) == sorted(found)
    assert all(not page.links for page in found.values())
    assert MARKUP in index.shown
    assert any(page.shown.count(MARKUP) >= 3 for page in found.values())


def test_a_students_page(prepared: Prepared, tmp_path: Path) -> None:
    unasked = item("unreadable", "g", 0.0, 0.0, feedback="There is no question 'g'")
    found = pages(prepared, tmp_path, [result("ada", RIGHT, OPEN, unasked), result("bob", RIGHT, PARTLY)])
    ada, bob = (" ".join(found[f"students/{name}.html"].shown.split()) for name in ("ada", "bob"))
    assert "Points so far 2 / 10" in ada
    assert (
        "This is not final. A person will review the answers that could not be graded automatically (points: 8)." in ada
    )
    assert "rod Which equation or equations express the constraint rod? – / 8 … awaiting review" in ada
    assert "questions that were not asked g" in ada
    assert "Points 6 / 10" in bob
    assert "f How many degrees of freedom does the system have? 2 / 2 ✓ correct Read as 1" in bob
    assert "4 / 8 ◐ partly correct Read as x = 0 It is a square." in bob
    assert "IRREGULAR" not in bob
    assert "Not final" not in bob


def test_relations_and_products_are_formulas(prepared: Prepared, tmp_path: Path) -> None:
    read = item("wrong", "rod", 0.0, 8.0, read_as="x_A^2 = 1 or m*g*l or <b>x</b> = 1")
    pages(prepared, tmp_path, [result("ada", RIGHT, read)])
    text = (tmp_path / "students" / "ada.html").read_text(encoding="utf-8")
    assert text.count("<math>") == 2
    assert "<msubsup>" in text or "<msup>" in text
    assert " or &lt;b&gt;x&lt;/b&gt; = 1" in text


def test_the_overview(prepared: Prepared, tmp_path: Path) -> None:
    wrong = item("wrong", "f", 0.0, 2.0, codes=["PLANE_TWICE"])
    given = [result("a", RIGHT, PARTLY), result("b", wrong, PARTLY), result("c", wrong, UNREADABLE),
             result("d", RIGHT, OPEN), REFUSED]  # fmt: skip
    shown = " ".join(pages(prepared, tmp_path, given)["index.html"].shown.split())
    assert "5 submissions 3.33 mean of 10 points 4 median 1 answer to review 1 not gradable" in shown
    assert "3 submissions by points. 1 with answers awaiting review is not included" in shown
    assert "p.f How many degrees of freedom does the system have? 1 / 2 ✓ 2 correct ✗ 2 incorrect" in shown
    assert " 2.67 / 8 ◐ 2 partly correct ? 1 not readable … 1 awaiting review" in shown
    assert "2 × The solutions are correct, but the gradient vanishes on all of them" in shown
    assert "p.rod 8 points The time was not enough. d Points" in shown


def test_whose_it_is_stands_on_the_pages(prepared: Prepared, tmp_path: Path) -> None:
    given = [result("ada", RIGHT), result("bob", RIGHT).model_copy(update={"doubt": f"it names {MARKUP}"})]
    found = pages(prepared, tmp_path, given)
    shown = " ".join(found["index.html"].shown.split())
    assert f"Submissions whose student is uncertain Student Why bob it names {MARKUP}" in shown
    assert "1 submission by points" in shown
    assert f"It is not certain whose submission this is. it names {MARKUP}" in " ".join(
        found["students/bob.html"].shown.split()
    )
    assert "whose" not in found["students/ada.html"].shown


CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FRAME = """<iframe id=f src="{page}" width={width} height=900></iframe><p id=o></p><script>
onload = () => {{
  const d = f.contentDocument, e = d.documentElement;
  o.textContent = "fits:" + (e.scrollWidth <= e.clientWidth) + " shown:" + d.body.innerText.includes("Points");
}}</script>"""


@pytest.mark.sweep
@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium")
@pytest.mark.parametrize("page", ["index.html", "students/long.html"])
def test_pages_fit_a_telephone(page: str, prepared: Prepared, tmp_path: Path) -> None:
    assert CHROMIUM is not None
    review = item("needs_review", "rod", None, 8.0, read_as="x" * 400, feedback="y" * 400)
    long = [review, RIGHT, odd("z" * 300).items[1]]
    given = [result("long", *long), result("n" * 300, RIGHT, PARTLY), REFUSED.model_copy(update={"error": "e" * 300})]
    pages(prepared, tmp_path, given)
    (tmp_path / "frame.html").write_text(FRAME.format(page=page, width=360))
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files", "--dump-dom"]
    command = [CHROMIUM, *options, f"--user-data-dir={tmp_path / 'profile'}", (tmp_path / "frame.html").as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    assert "fits:true shown:true" in done.stdout


def test_the_distribution_of_points(prepared: Prepared) -> None:
    scores = (0.0, 0.99, 1.0, 5.0, 9.0, 10.0)
    given = [Submitted("a", "", Result(student="a", score=score, max_score=10.0, items=[])) for score in scores]
    page = overview(given, prepared)
    assert [count for _, count, _ in page["bars"]] == [2, 1, 0, 0, 0, 1, 0, 0, 0, 2]
    assert (page["bars"][0][0], page["bars"][9][0]) == ("0–1", "9–10")
    assert page["median"] == 3.0
