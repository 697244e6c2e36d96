"""How questions did: shares, discrimination, errors, texts, classes and variants; figures worked out by hand."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import pytest

from dofkit.homework.item_analysis import ItemAnalysis, QuestionFigures
from dofkit.homework.result import Item, Result
from dofkit.interface import cli


def item(question: str, score: float | None, most: float = 1.0, **more: object) -> Item:
    told: dict[str, object] = {"problem": "p", "question": question, "score": score, "max_score": most}
    told["status"] = "unreadable" if score is None else "right" if score == most else "wrong"
    return Item.model_validate({**told, "codes": [], "read_as": "", "feedback": "", **more})


def result(*items: Item) -> Result:
    return Result(student="s", score=0.0, max_score=float(len(items)), items=list(items))


def analysed(pairs: list[tuple[float, float]]) -> QuestionFigures:
    analysis = ItemAnalysis()
    for x, y in pairs:
        analysis.add(result(item("a", x), item("b", y)))
    return analysis.figures("p", "a")


def test_discrimination_is_the_correlation_with_the_rest() -> None:
    """Of six: n = 6, sum x = sum y = sum x^2 = sum y^2 = 3, sum x y = 2: r = (12 - 9) / 9."""
    x, y = [0, 0, 1, 1, 1, 0], [0, 1, 1, 0, 1, 0]
    found = analysed(list(zip(map(float, x), map(float, y), strict=True)))
    assert found.discrimination == pytest.approx(1 / 3)
    assert (found.decided, found.right, found.points) == (6, 0.5, 0.5)
    assert not found.doubtful
    assert analysed([(0.0, 0.0), (1.0, 1.0)] * 3).discrimination == pytest.approx(1.0)
    against = analysed([(0.0, 1.0), (1.0, 0.0)] * 3)
    assert against.discrimination == pytest.approx(-1.0)
    assert against.doubtful


def test_too_few_and_all_alike_tell_nothing() -> None:
    assert analysed([(0.0, 0.0), (1.0, 1.0)] * 2).discrimination is None
    assert analysed([(1.0, 0.0), (1.0, 1.0)] * 5).discrimination is None
    assert ItemAnalysis().figures("p", "a") == QuestionFigures(0, None, None, None, [], [], [], [])


def test_what_is_open_counts_nowhere_and_half_points_are_not_right() -> None:
    analysis = ItemAnalysis()
    for score in (2.0, 1.0, None, 0.0):
        analysis.add(result(item("a", score, 2.0, answer="~" if score is None else "1")))
    found = analysis.figures("p", "a")
    assert (found.decided, found.right, found.points) == (3, pytest.approx(1 / 3), 0.5)
    assert found.unread == [(1, "~")]


def test_errors_texts_and_groups() -> None:
    analysis = ItemAnalysis()
    for n in range(6):
        mark = f"{'as given' if n < 4 else 'without c1'} #{n:08x}"
        codes = ["NH_SUBTRACT"] if n % 2 else ["SPRING", "NH_SUBTRACT"]
        analysis.add(result(item("a", float(n < 3), codes=codes, variant=mark)), "north" if n < 2 else "south")
    found = analysis.figures("p", "a")
    assert [(count, code) for count, code, _ in found.codes] == [(6, "NH_SUBTRACT"), (3, "SPRING")]
    assert all(meaning for _, _, meaning in found.codes)
    assert [(g.name, g.answers, g.share) for g in found.classes] == [("north", 2, 1.0), ("south", 4, 0.25)]
    assert [(g.name, g.answers, g.share) for g in found.variants] == [("as given", 4, 0.75), ("without c1", 2, 0.0)]


@pytest.mark.sweep
def test_the_overview_shows_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1"]}
    asked = [{"id": "f", "ask": "dof"}, {"id": "k", "ask": "k"}]
    sheet, roster, answers = tmp_path / "sheet.json", tmp_path / "roster.csv", tmp_path / "answers.csv"
    sheet.write_text(json.dumps({"title": "T", "problems": [{"id": "p", "scene": scene, "questions": asked}]}))
    roster.write_text("email,section\n" + "".join(f"s{i}@x.org,{'north' if i < 3 else 'south'}\n" for i in range(6)))
    table = io.StringIO()
    csv.writer(table).writerows([("student", "p.f", "p.k"), *((f"s{i}@x.org", 1 if i < 3 else 2, 1) for i in range(6))])
    answers.write_text(table.getvalue())
    out = tmp_path / "pages"
    args = ["grade", str(sheet), str(answers), "--roster", str(roster), "--format", "html", "--out", str(out)]
    cli.app(args, standalone_mode=False)
    capsys.readouterr()
    page = (out / "index.html").read_text(encoding="utf-8")
    assert "50 % correct" in page
    assert "north: 100 % of the points (3)" in page
    assert "south: 0 % of the points (3)" in page
