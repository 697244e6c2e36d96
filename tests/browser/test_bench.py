"""The bench as a person uses it: typing, leaving out a constraint, examples, links, offline, embedded."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from shared.browsed import KNIFE, SOON, seen, shot, violations, write
from shared.documented import ROOT
from shared.served import Served

import dofkit
from dofkit.site.markdown import fragment
from dofkit.site.reference_pages import readme_page

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("browser"), pytest.mark.timeout(900)]
LINK = """\
dimension: 2
particles: [{name: base}, {name: tip}]
constraints:
- {type: link, between: [base, tip], length: 1}
"""
HOSTILE = """\
title: "<img src=x onerror=alert(1)><script>alert(2)</script>"
coordinates: [x, y]
constraints:
- {name: "<svg onload=alert(3)>", type: equation, text: "x dy + y dx = 0"}
- {name: "javascript:alert(4)", type: equation, text: "x = 1"}
"""


def test_a_fault_is_shown_while_typing_and_mended_by_a_click(served: Served, bench: Any) -> None:
    page = bench.page
    seen(page, "#report td", "non-holonomic, scleronomic")
    write(page, KNIFE.replace("theta) dx", "thetta) dx"))
    seen(page, "#faults", "thetta")
    assert "line 3, column " in page.inner_text("#faults")
    shot(page, served, "fault")
    page.get_by_role("button", name="Write theta").click()
    page.locator("#faults li").wait_for(state="detached", timeout=SOON)
    seen(page, "#report th", "edge")
    seen(page, "#report td", "(2, 3)")
    write(page, LINK.replace("link, between", "link, betwen"))
    page.get_by_role("button", name="Write between").click()
    page.locator("#faults li").wait_for(state="detached", timeout=SOON)
    write(page, LINK.replace("[base, tip]", "[base, tpi]"))
    page.get_by_role("button", name="Write tip").click()
    seen(page, "#report td", "2*2 - 1 = 3")
    assert bench.errors == []


def test_a_constraint_is_left_out(served: Served, bench: Any) -> None:
    page = bench.page
    page.get_by_label("along_x").uncheck()
    seen(page, "#report h3", "Without along_x")
    seen(page, "#report p", "velocity freedom: 2 -> 3")
    shot(page, served, "left-out")
    page.get_by_label("along_x").check()
    page.locator("#report h3", has_text="Without").wait_for(state="detached", timeout=SOON)
    assert bench.errors == []


def test_an_example_is_found_by_its_words(served: Served, bench: Any) -> None:
    page = bench.page
    page.get_by_role("button", name="Examples").click()
    page.get_by_label("Search").fill("pendulum angle")
    page.locator("#matching button").first.wait_for()
    assert "Lecture 6: Lagrange mechanics" in page.locator("#matching h3").all_inner_texts()
    shot(page, served, "examples")
    page.get_by_role("button", name="pendulum", exact=False).first.click()
    seen(page, "#report h2", "endulum")
    assert page.locator("#picture").get_attribute("alt")
    assert "#example=" in page.url
    assert bench.errors == []


def test_a_link_holds_the_scene(served: Served, bench: Any, visit: Any) -> None:
    write(bench.page, KNIFE)
    seen(bench.page, "#report th", "edge")
    bench.page.wait_for_url("**#scene=*")
    fresh = visit.page
    fresh.goto(bench.page.url)
    fresh.locator("#report th", has_text="edge").wait_for(timeout=4 * SOON)
    assert "sin(theta) dx" in fresh.locator(".cm-content").inner_text()
    fresh.goto(f"{served.url}/bench/{fragment(KNIFE.replace('edge', 'blade'))}")
    seen(fresh, "#report th", "blade")
    assert visit.errors == []


def test_scene_report_and_picture_are_exported(bench: Any, tmp_path: Path) -> None:
    page = bench.page
    saved = {}
    for name in ("yaml", "json", "report", "svg"):
        with page.expect_download() as download:
            page.get_by_label("Export").select_option(name)
        path = tmp_path / download.value.suggested_filename
        download.value.save_as(path)
        saved[name] = path
    for name in ("yaml", "json"):
        assert dofkit.load(saved[name]) == dofkit.load(saved["yaml"])
        report = dofkit.classify(saved[name]).to_dict()
        assert report["constraints"] == json.loads(saved["report"].read_text())["constraints"]
    assert ElementTree.parse(saved["svg"]).getroot().tag == "{http://www.w3.org/2000/svg}svg"
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_role("button", name="Copy link").click()
    seen(page, "#state", "The link was copied")
    assert page.evaluate("navigator.clipboard.readText()") == page.url
    assert bench.errors == []


@pytest.mark.parametrize(
    "broken", ["#scene=!!", "#scene=AAAA", "#scene=" + "A" * 1_000_000, "#scene=QUJD", fragment("a: b\n" * 200_000)]
)
def test_a_broken_or_long_link_hangs_nothing(served: Served, visit: Any, broken: str) -> None:
    page = visit.page
    page.goto(f"{served.url}/bench/index.html{broken}")
    page.locator(".cm-content").filter(has_text="no scene that can be read").wait_for(timeout=SOON)
    assert not [error for error in visit.errors if "dialog" in error]


def test_nothing_of_a_scene_becomes_html(served: Served, bench: Any) -> None:
    page = bench.page
    page.goto(f"{served.url}/bench/{fragment(HOSTILE)}")
    seen(page, "#report h2", "<img src=x")
    seen(page, "#report th", "<svg onload")
    assert page.locator("#report img, #report svg, #report script, #report a, #switches svg").count() == 0
    write(page, HOSTILE.replace("x = 1", "<script>alert(5)</script>"))
    page.locator("#faults li").first.wait_for(timeout=SOON)
    assert page.locator("#faults script").count() == 0
    assert bench.errors == []


def test_the_policy_refuses_inline_scripts(served: Served, visit: Any) -> None:
    page = visit.page
    page.goto(f"{served.url}/bench/index.html")
    page.evaluate(
        "document.body.append(Object.assign(document.createElement('script'), {textContent: 'window.ran = 1'}))"
    )
    assert page.evaluate("window.ran") is None
    for file in ("bench/index.html", "bench/player.html"):
        text = (served.folder / file).read_text(encoding="utf-8")
        assert "script-src 'self' 'wasm-unsafe-eval'" in text or "default-src 'self'\"" in text
        assert "unsafe-inline" not in text
        assert "style=" not in text.partition("<body")[2].replace("img style", "")


def test_it_works_offline_after_the_first_visit(served: Served, visit: Any) -> None:
    page = visit.opened(f"{served.url}/bench/")
    page.evaluate("navigator.serviceWorker.ready.then(() => null)")
    visit.context.set_offline(True)
    page.reload()
    page.locator("#report table").first.wait_for(timeout=4 * SOON)
    write(page, KNIFE)
    page.locator("#report th", has_text="edge").wait_for(timeout=4 * SOON)
    visit.context.set_offline(False)


def test_it_is_embedded_in_another_page(served: Served, visit: Any) -> None:
    source = f"/bench/?embed{fragment(KNIFE)}"
    (served.folder / "course.html").write_text(f'<iframe src="{source}" width="700" height="700"></iframe>')
    visit.page.goto(f"{served.url}/course.html")
    frame = visit.page.frame_locator("iframe")
    frame.locator("#report th", has_text="edge").wait_for(timeout=4 * SOON)
    assert frame.get_by_role("button", name="Examples").is_hidden()
    link = frame.get_by_role("link", name="Open in the bench").get_attribute("href")
    assert link.startswith("./#scene=")
    visit.page.screenshot(path=served.folder / "screenshots" / "embedded.png")
    assert visit.errors == []


def test_the_home_page_begins_with_a_small_bench_that_loads_when_it_is_touched(served: Served, visit: Any) -> None:
    home = readme_page((ROOT / "README.md").read_text(encoding="utf-8"), has_bench=True).text
    assert home.index('<div class="bench">') < home.index("```yaml")
    assert home.count("bench.png") == 1
    (served.folder / "home.html").write_text(home, encoding="utf-8")
    page = visit.page
    page.goto(f"{served.url}/home.html")
    assert len(page.frames) == 1 or page.frames[1].url == "about:blank"
    page.get_by_role("button", name="Try it here").click()
    page.frame_locator("iframe").locator("#report h2", has_text="Upright disc").wait_for(timeout=SOON)


def test_without_numpy_the_place_of_the_picture_says_so(served: Served, bench: Any) -> None:
    page = bench.page
    page.goto(f"{served.url}/bench/{fragment(KNIFE)}")
    seen(page, "#no-picture", "numpy could not be loaded")
    seen(page, "#report td", "(2, 3)")
    shot(page, served, "no-numpy")
    page.get_by_role("button", name="Show the motion").click()
    seen(page, "#state", "numpy could not be loaded")


def test_only_an_example_is_answered_before_python_has_started(served: Served, visit: Any, bench: Any) -> None:
    """The report on an example is the one that Python gives, and the title of the page is that of the scene."""
    visit.context.route("**/core.bin", lambda route: route.abort())
    page = visit.page
    page.goto(f"{served.url}/bench/")
    seen(page, "#report td", "non-holonomic, scleronomic")
    assert page.title() == f"{page.inner_text('#report h2')} - dofkit bench"
    built = page.inner_text("#report")
    example = dofkit.catalog_text("disc-rolling-on-plane").partition("expect:")[0]
    for text in (f"{example}\n", example.replace("dphi", "dtheta"), KNIFE):
        page.goto("about:blank")
        page.goto(f"{served.url}/bench/{fragment(text)}")
        seen(page, "#state", "core.bin")
        assert page.inner_text("#report") == ""
    write(bench.page, f"{example}# edited\n")
    bench.page.wait_for_url("**#scene=*")
    seen(bench.page, "#no-picture", "numpy could not be loaded")
    assert bench.page.inner_text("#report") == built


def test_a_long_run_is_named_and_can_be_stopped(served: Served, bench: Any) -> None:
    names = "abcdefg"
    sums = [" + ".join(f"{(3 * i + 5 * k) % 11 + 1} {name}" for i, name in enumerate(names)) for k in range(5)]
    texts = [f'- "({total})^6 + {name}^2 = 1"' for total, name in zip(sums, names, strict=False)]
    page = bench.page
    write(page, "\n".join((f"coordinates: [{', '.join(names)}]", "constraints:", *texts)))
    seen(page, "#state", "Classifying")
    page.get_by_role("button", name="Stop").click()
    seen(page, "#state", "Stopped")
    assert "Upright disc" in page.inner_text("#report h2")
    write(page, KNIFE)
    page.locator("#report th", has_text="edge").wait_for(timeout=4 * SOON)
    assert bench.errors == []


def test_equations_of_motion_are_derived_on_request(served: Served, bench: Any) -> None:
    page = bench.page
    page.goto(f"{served.url}/bench/#example=pendulum-angle")
    seen(page, "#report h2", "endulum")
    page.get_by_role("button", name="Derive equations of motion").click()
    page.locator("#derived math").first.wait_for(timeout=4 * SOON)
    shot(page, served, "equations")
    page.set_viewport_size({"width": 360, "height": 740})
    widths = "Array.from(document.querySelectorAll('.wide'), (box) => box.scrollWidth - box.clientWidth)"
    assert max(page.evaluate(widths)) > 0, "a wide table scrolls by itself"
    assert violations(page) == []
    assert bench.errors == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_no_violation(served: Served, bench: Any, scheme: str) -> None:
    page = bench.page
    page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    write(page, KNIFE.replace("theta) dx", "thetta) dx"))
    seen(page, "#faults", "thetta")
    shot(page, served, scheme)
    assert violations(page) == []
    page.get_by_role("button", name="Examples").click()
    page.locator("#matching button").first.wait_for()
    assert violations(page) == []


def test_the_keyboard_alone_is_enough(bench: Any) -> None:
    page = bench.page
    page.locator("h1 a").focus()
    order = []
    for _ in range(14):
        page.keyboard.press("Tab")
        order.append(
            page.evaluate("(document.activeElement.shadowRoot?.activeElement ?? document.activeElement).outerHTML")
        )
    text = "\n".join(html[:200] for html in order)
    positions = [text.find(word) for word in ("examples", "copy", "export", "cm-content", "along_y", "along_x")]
    assert positions == sorted(positions)
    assert positions[0] >= 0
    page.locator("#examples").focus()
    page.keyboard.press("Enter")
    page.keyboard.type("four bar")
    page.keyboard.press("Enter")
    page.wait_for_url(lambda url: "#example=" in url and "disc-rolling-on-plane" not in url)
    page.locator("#report h2").filter(has_not_text="Upright disc").wait_for(timeout=SOON)
    page.keyboard.press("Control+A")  # the editor has the focus once an example was chosen
    page.keyboard.insert_text(KNIFE.replace("theta) dx", "thetta) dx"))
    seen(page, "#faults", "thetta")
    for key in ("Tab", "Tab", "Enter"):  # to the place of the fault, and on to its correction
        page.keyboard.press(key)
    seen(page, "#report th", "edge")
    for key in ("Tab", "Space"):
        page.keyboard.press(key)
    seen(page, "#report h3", "Without edge")
    assert page.evaluate("document.activeElement.value") == "edge"
    assert bench.errors == []


def test_the_picture_of_the_readme(served: Served, bench: Any) -> None:
    """Make `screenshots/bench.png` in the folder of the pages; `dofkit/site/pages/bench.png` is a copy of it.

    After `python -m dofkit.site`: `DOFKIT_BENCH=build/site python -m pytest -m browser -k picture_of_the_readme`.
    """
    bench.page.set_viewport_size({"width": 1000, "height": 570})
    page = bench.page
    page.locator("#picture:not([hidden])").wait_for()
    page.get_by_label("along_x").uncheck()
    seen(page, "#report p", "velocity freedom: 2 -> 3")
    path = served.folder / "screenshots" / "bench.png"
    page.screenshot(path=path)
    assert path.stat().st_size < 120_000


def test_completion_offers_fields_types_and_names(served: Served, bench: Any) -> None:
    page = bench.page
    write(page, "coordinates: [x, y, theta]\nconstraints:\n")
    page.locator("#report").filter(has_not_text="phi").wait_for(timeout=SOON)  # so the names are those of this scene
    for typed, offered, key in (
        ("- {n", ["name"], "Enter"),
        ("edge, t", ["text", "type", "theta"], "Escape"),
        ("ype: e", ["equation"], "Enter"),
        (", te", ["text"], "Enter"),
        ('"cos(th', ["theta", "dtheta"], "Enter"),
    ):
        page.keyboard.type(typed)
        options = page.locator(".cm-tooltip-autocomplete li .cm-completionLabel")
        options.first.wait_for(timeout=SOON)
        page.wait_for_timeout(200)  # what has just appeared is not accepted yet
        assert options.all_inner_texts() == offered
        page.keyboard.press(key)
    page.keyboard.type(") dx + sin(theta) d")
    page.locator(".cm-tooltip-autocomplete").filter(has_text="dtheta").wait_for(timeout=SOON)
    assert page.locator(".cm-tooltip-autocomplete li .cm-completionLabel").all_inner_texts() == ["dtheta", "dx", "dy"]
    page.keyboard.press("Escape")
    page.keyboard.type("y = 0")
    seen(page, "#report th", "edge")
    seen(page, "#report td", "(2, 3)")
    assert bench.errors == []
