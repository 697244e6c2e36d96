"""The pages of sheets as students use them: practice sheets on a server, and a sheet to hand in from a folder."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from shared.browsed import SOON, seen, shot, violations
from shared.served import Served

import dofkit
from dofkit.homework.answers.roster import Participant, Roster
from dofkit.homework.assignment import load_assignment
from dofkit.homework.handout.class_sheets import write_sheets
from dofkit.homework.handout.page_sheets import put_runtime
from dofkit.interface.assignment_commands import drawing

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("browser"), pytest.mark.timeout(900)]


def test_a_practice_sheet_in_german(served: Served, visit: Any) -> None:
    page = visit.page
    page.goto(f"{served.url}/practice/")
    fields = page.locator("textarea")
    assert fields.count() == 3
    seen(page, ".note", "Dieses Blatt dient der Übung")
    fields.nth(0).fill("f = 2")
    fields.nth(1).fill("dx + R sin(theta dphi = 0")
    fields.nth(2).fill("nicht-holonom, skleronom")
    page.locator(".read").nth(2).filter(has_text="Gelesen als: nicht").wait_for(timeout=4 * SOON)
    page.locator(".read pre").filter(has_text="^").wait_for(timeout=SOON)
    shot(page, served, "practice-unread")
    fields.nth(1).fill("dx + R sin(theta) dphi = 0")
    page.locator(".read math").wait_for(timeout=SOON)
    page.get_by_role("button", name="Alle Antworten prüfen").click()
    page.locator(".judged").nth(2).filter(has_text="richtig").wait_for(timeout=4 * SOON)
    assert "falsch (0 von 2)" in page.locator(".judged").nth(0).inner_text()
    assert "richtig" in page.locator(".judged").nth(1).inner_text()
    assert page.locator("h1").bounding_box()["x"] == page.locator("h2").last.bounding_box()["x"]
    shot(page, served, "practice-judged")
    assert violations(page) == []
    page.reload()
    assert page.locator("textarea").nth(0).input_value() == "f = 2"
    assert visit.errors == []


SHEET: dict[str, Any] = {
    "title": "Sheet 1",
    "problems": [
        {
            "id": "pendulum",
            "title": "A pendulum",
            "text": "A particle $P$ hangs on a rod of the length $l$.",
            "scene": "simple-pendulum-link",
            "questions": [
                {"id": "f", "ask": "dof", "points": 2},
                {"id": "rod", "ask": "equation", "constraint": "rod", "points": 3},
                {"id": "label", "ask": "label", "constraint": "rod"},
            ],
        }
    ],
}


def test_a_sheet_is_filled_in_from_a_folder_without_a_network(served: Served, visit: Any, tmp_path: Path) -> None:
    prepared = load_assignment(SHEET)
    members = Roster((Participant("ada@x", "Ada", "ada@x"), Participant("grace@x", "Grace", "grace@x")))
    write_sheets(prepared, members, "page", drawing(), tmp_path)
    page = visit.page
    visit.context.set_offline(True)
    page.goto((tmp_path / "ada@x.html").as_uri())
    seen(page, ".state", "runtime.js is not beside this page")
    assert page.locator("textarea").count() == 3
    put_runtime(tmp_path, served.folder / "bench" / "runtime.js")
    visit.errors.clear()
    page.reload()
    fields, read = page.locator("textarea"), page.locator(".read")
    fields.nth(0).fill("f = 1")
    fields.nth(1).fill("x_P² + y_P² = (l²")
    read.nth(0).filter(has_text="Read as: 1").wait_for(timeout=4 * SOON)
    read.nth(1).locator("pre", has_text="^").wait_for(timeout=SOON)
    shot(page, served, "sheet-unread")
    fields.nth(1).fill("x_P² + y_P² = l²")
    fields.nth(2).fill("holonom, skleronom")
    read.nth(1).locator("math msup").first.wait_for(timeout=SOON)
    read.nth(2).filter(has_text="holonomic, scleronomic").wait_for(timeout=SOON)
    with page.expect_download() as download:
        page.get_by_role("button", name="Save the file to submit").click()
    seen(page, ".said", "3 of 3 answers are in the file ada@x.json")
    saved = tmp_path / download.value.suggested_filename
    download.value.save_as(saved)
    assert json.loads(saved.read_text())["student"] == "ada@x"
    assert dofkit.grade(prepared, saved).score == 6
    shot(page, served, "sheet-read")
    page.emulate_media(color_scheme="dark")
    shot(page, served, "sheet-dark")
    assert violations(page) == []
    page.reload()
    assert fields.nth(0).input_value() == "f = 1"
    assert visit.errors == []
