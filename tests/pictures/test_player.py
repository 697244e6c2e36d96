"""The page in headless Chromium, without a network: no error, a click on play moves a body, dragging turns."""

from __future__ import annotations

import shutil
import time
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from shared.browsed import AXE, violations

import dofkit
from dofkit.pictures.player import FRAME, page_height

CHROMIUM = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None
)
pytestmark = [
    pytest.mark.sweep,
    pytest.mark.skipif(CHROMIUM is None, reason="Chromium is no Python package: apt-get install chromium"),
    pytest.mark.skipif(
        find_spec("playwright") is None, reason="playwright drives Chromium: pip install 'dofkit[browser]'"
    ),
]


class Viewer:
    """A page of a browser that is offline, and what its console said."""

    def __init__(self, page: Any) -> None:
        self.page, self.said = page, list[str]()
        page.on("console", lambda message: self.said.append(message.text))
        page.on("pageerror", lambda error: self.said.append(str(error)))
        page.on("request", lambda request: self.said.extend([request.url] * (not request.url.startswith("file:"))))

    def show(self, path: Path) -> bytes:
        """Open a file, and what its canvas shows."""
        self.page.goto(path.as_uri())
        return self.shot()

    def shot(self) -> bytes:
        """What the canvas shows."""
        found: bytes = self.page.locator("canvas").screenshot()
        return found


@pytest.fixture(scope="module")
def viewer() -> Iterator[Viewer]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        context = browser.new_context(offline=True, viewport={"width": 760, "height": 800})
        yield Viewer(context.new_page())
        browser.close()


@pytest.mark.parametrize("name", ["four-bar-linkage", "rssr-linkage", "planetary-gear-bodies", "disc-rolling-on-plane"])
def test_a_click_on_play_moves_a_body(viewer: Viewer, name: str, tmp_path: Path) -> None:
    before = viewer.show(dofkit.animate(name).save(tmp_path / "a.html"))
    viewer.page.click("#play")
    viewer.page.wait_for_timeout(600)
    viewer.page.click("#play")
    assert viewer.shot() != before
    assert float(viewer.page.input_value("#slider")) > 0
    assert viewer.page.inner_text("#play") == "Play"
    assert viewer.said == []


def test_paper_is_dark_where_the_reader_has_it_so(viewer: Viewer, tmp_path: Path) -> None:
    paper = "[...document.querySelector('canvas').getContext('2d').getImageData(3, 3, 1, 1).data].slice(0, 3)"
    svg = "getComputedStyle(document.querySelector('rect')).fill"
    try:
        for scheme, colour in (("light", [255, 255, 255]), ("dark", [0x15, 0x1B, 0x23])):
            viewer.page.emulate_media(color_scheme=scheme)
            viewer.show(dofkit.animate("four-bar-linkage").save(tmp_path / "a.html"))
            assert viewer.page.evaluate(paper) == colour
            viewer.page.goto(dofkit.draw("four-bar-linkage").save(tmp_path / "a.svg").as_uri())
            assert viewer.page.evaluate(svg) == f"rgb({', '.join(map(str, colour))})"
    finally:
        viewer.page.emulate_media(color_scheme="light")
    assert viewer.said == []


@pytest.mark.parametrize("name", ["four-bar-linkage", "planetary-gear-bodies", "disc-rolling-on-plane"])
def test_a_page_fits_its_frame_in_a_notebook(viewer: Viewer, name: str, tmp_path: Path) -> None:
    animation = dofkit.animate(name)
    frame = page_height(animation.sketch, animation.clips)
    viewer.page.set_viewport_size({"width": FRAME, "height": 1200})
    viewer.show(animation.save(tmp_path / "a.html"))
    needed = viewer.page.evaluate("document.body.getBoundingClientRect().bottom")
    viewer.page.set_viewport_size({"width": 760, "height": 800})
    assert needed <= frame <= needed + 60


def test_another_motion_can_be_chosen(viewer: Viewer, tmp_path: Path) -> None:
    viewer.show(dofkit.animate("planetary-gear-bodies").save(tmp_path / "a.html"))
    assert viewer.page.locator("#clip option").count() == 2
    viewer.page.select_option("#clip", index=1)
    assert viewer.page.get_attribute("#slider", "max") == "27"
    assert viewer.said == []


@pytest.mark.parametrize("name", ["four-bar-linkage", "five-particles-ten-links", "disc-rolling-on-plane"])
def test_axe_finds_nothing(viewer: Viewer, name: str, tmp_path: Path) -> None:
    """Of pages with points to drag, with switches, and with a loop and its size."""
    if not AXE.exists():
        pytest.skip("axe-core comes with the bench: npm install in dofkit/site/bench")
    viewer.show(dofkit.animate(name, loop=name.startswith("disc")).save(tmp_path / "a.html"))
    assert violations(viewer.page) == []


def test_the_first_frame_needs_no_script(viewer: Viewer, tmp_path: Path) -> None:
    """Without scripts a picture of the four-bar stands where the canvas will be."""
    path = dofkit.animate("four-bar-linkage").save(tmp_path / "a.html")
    context = viewer.page.context.browser.new_context(java_script_enabled=False, viewport={"width": 760, "height": 800})
    still = context.new_page()
    still.goto(path.as_uri())
    first = still.locator("#first").bounding_box()
    viewer.show(path)
    assert viewer.page.locator("#first").count() == 0
    assert viewer.page.locator("canvas").bounding_box() == pytest.approx(first, abs=1)
    context.close()


#: Milliseconds from the end of a page's transfer until something of it is painted.
PAINTED = """new Promise((done) => {
  const told = () => {
    const [paint] = performance.getEntriesByName("first-contentful-paint");
    const [page] = performance.getEntriesByType("navigation");
    if (paint) { done(paint.startTime - page.responseEnd); } else { setTimeout(told, 5); }
  };
  told();
})"""
#: So many milliseconds later than a page of one word, of which a busy machine takes any time; the least of some visits.
LATER, VISITS = 50, 10


def test_the_first_frame_is_painted_as_soon_as_a_page_of_one_word(viewer: Viewer, tmp_path: Path) -> None:
    word = tmp_path / "word.html"
    word.write_text("<!doctype html><html lang=en><title>a</title><p>word</p></html>", encoding="utf-8")
    names = ("four-bar-linkage", "disc-rolling-on-plane", "particle-on-longitude")
    pages = [word, *(dofkit.animate(name).save(tmp_path / f"{name}.html") for name in names)]
    times: dict[Path, list[float]] = {page: [] for page in pages}
    for _ in range(VISITS):
        for page in pages:
            viewer.page.goto(page.as_uri())
            times[page].append(viewer.page.evaluate(PAINTED))
    blank, *shown = (min(taken) for taken in times.values())
    assert max(shown) < blank + LATER
    assert viewer.said == []


def test_a_loop_has_a_size_and_says_what_is_displaced(viewer: Viewer, tmp_path: Path) -> None:
    before = viewer.show(dofkit.animate("disc-rolling-on-plane", loop=True).save(tmp_path / "a.html"))
    told = viewer.page.inner_text("#seen")
    assert "theta and phi return; displaced are x by" in told
    viewer.page.evaluate(
        "s => { s.value = 0; s.dispatchEvent(new Event('input')); }", viewer.page.query_selector("#size")
    )
    assert viewer.page.inner_text("#seen") != told
    viewer.page.evaluate(
        "s => { s.value = s.max; s.dispatchEvent(new Event('input')); }", viewer.page.query_selector("#slider")
    )
    assert viewer.shot() != before
    assert viewer.said == []


#: Drags a point of the picture about for two seconds, and returns the worst residual and the mean time of a step in ms.
DRAG = """async ([x, y]) => {
  const canvas = document.querySelector("canvas"), box = canvas.getBoundingClientRect();
  const point = (type, right, down) => canvas.dispatchEvent(new PointerEvent(type, {
    clientX: box.left + x * box.width + right, clientY: box.top + y * box.height + down, pointerId: 1 }));
  canvas.setPointerCapture = () => {};
  point("pointerdown", 0, 0);
  let worst = 0, spent = 0, count = 0;
  const start = performance.now();
  while (performance.now() - start < 2000) {
    const turn = (performance.now() - start) / 300, before = performance.now();
    point("pointermove", 60 * Math.sin(turn), 40 * (1 - Math.cos(turn)));
    spent += performance.now() - before;
    count += 1;
    worst = Math.max(worst, Number(canvas.dataset.residual));
    await new Promise((done) => requestAnimationFrame(done));
  }
  point("pointerup", 0, 0);
  return { worst, spent: spent / count };
}"""
#: Five triangles in a row on ten bars with the ground, closed by hinges: a planar ten-bar linkage of one freedom.
HINGES = "gP 0 0, PQ 0 1, QR 3 2, Rg 3 0, QS 4 3, ST 6 2, Tg 6 0, SU 7 3, UV 9 2, Vg 9 0, UW 10 3, WX 12 2, Xg 12 0"
TEN_BAR = {
    "dimension": 2,
    "bodies": list("PQRSTUVWX"),
    "constraints": [
        {
            "type": "revolute",
            "between": ["ground" if m == "g" else m for m in pair],
            "at": [int(x), int(y)],
        }
        for pair, x, y in (hinge.split() for hinge in HINGES.split(", "))
    ],
}


@pytest.mark.parametrize(
    ("scene", "at"), [("four-bar-linkage", [0.3, 0.25]), (TEN_BAR, [0.3, 0.45]), ("double-pendulum-links", [0.5, 0.5])]
)
def test_a_point_is_dragged_within_the_constraints(viewer: Viewer, scene: Any, at: list[float], tmp_path: Path) -> None:
    before = viewer.show(dofkit.animate(scene).save(tmp_path / "a.html"))
    if at != [0.5, 0.5]:
        dragged = viewer.page.evaluate(DRAG, at)
        assert dragged["worst"] < 1e-9
        assert dragged["spent"] < 1000 / 30
    viewer.page.focus("canvas")
    for _ in range(4):
        viewer.page.keyboard.press("ArrowLeft")
    assert float(viewer.page.get_attribute("canvas", "data-residual")) < 1e-9
    assert viewer.shot() != before
    assert viewer.said == []


def test_a_switch_keeps_the_motion_or_shows_a_new_one(viewer: Viewer, tmp_path: Path) -> None:
    viewer.show(dofkit.animate("five-particles-ten-links").save(tmp_path / "a.html"))
    boxes = viewer.page.locator("#switches input")
    motion = viewer.page.input_value("#clip")
    boxes.last.uncheck()
    boxes.first.uncheck()
    assert boxes.last.is_checked()
    boxes.first.check()
    assert viewer.page.input_value("#clip") == motion
    assert viewer.said == []


def test_a_page_opens_and_plays_at_once(viewer: Viewer, tmp_path: Path) -> None:
    """The script draws within 100 ms of its start, and 30 frames within a second, in the best of some visits."""
    count = "new Promise((end) => { let n = 0; const f = () => ++n < 30 ? requestAnimationFrame(f) : end(n); f(); })"
    for name in ("four-bar-linkage", "five-particles-ten-links"):
        path, opened, played = dofkit.animate(name).save(tmp_path / "a.html"), list[float](), list[float]()
        for _ in range(VISITS):
            viewer.show(path)
            opened.append(float(viewer.page.get_attribute("canvas", "data-opened")))
            viewer.page.click("#play")
            start = time.perf_counter()
            viewer.page.evaluate(count)
            played.append(time.perf_counter() - start)
            if min(opened) < 100 and min(played) < 1:
                break
        assert min(opened) < 100
        assert min(played) < 1
    assert viewer.said == []


def test_dragging_turns_a_picture_of_space(viewer: Viewer, tmp_path: Path) -> None:
    before = viewer.show(dofkit.draw("rssr-linkage").save(tmp_path / "a.html"))
    box = viewer.page.locator("canvas").bounding_box()
    viewer.page.mouse.move(box["x"] + 200, box["y"] + 200)
    viewer.page.mouse.down()
    viewer.page.mouse.move(box["x"] + 300, box["y"] + 220)
    viewer.page.mouse.up()
    assert viewer.shot() != before
    assert not viewer.page.locator(".controls").is_visible()
    assert viewer.said == []


def test_pointing_at_a_constraint_lights_its_circuit(viewer: Viewer, tmp_path: Path) -> None:
    viewer.page.goto(dofkit.graph("five-particles-ten-links").save(tmp_path / "a.html").as_uri())
    faint = "document.querySelectorAll('[style*=\"opacity: 0.15\"]').length"
    assert viewer.page.evaluate(faint) == 0
    viewer.page.hover("path[data-owner=DF] >> nth=-1")
    assert viewer.page.evaluate(faint) > 0
    assert viewer.said == []
