"""The bench and a practice sheet, built once and served from this machine; Chromium to look at them."""

from __future__ import annotations

import os
import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from shared.browsed import seen
from shared.served import PageHandler, PageServer, Served

from dofkit.homework.assignment import load_assignment
from dofkit.homework.handout.page_sheets import put_runtime, write_page
from dofkit.interface.assignment_commands import drawing

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
#: Milliseconds for Python to start, on a busy machine.
WAIT = 120_000
CHROMIUM = next((path for name in BROWSERS if (path := shutil.which(name))), None)
GERMAN: dict[str, Any] = {
    "title": "Übung 3: Zwangsbedingungen",
    "language": "de",
    "problems": [
        {
            "id": "disc",
            "title": "Rollende Scheibe",
            "text": "Eine Scheibe mit dem Radius $R$ rollt aufrecht auf einer Ebene, ohne zu gleiten.",
            "scene": "disc-rolling-on-plane",
            "questions": [
                {"id": "f", "ask": "dof", "points": 2},
                {"id": "eq", "ask": "equation", "constraint": ["along_x"], "points": 3},
                {"id": "label", "ask": "label", "constraint": "along_y", "points": 2},
            ],
        }
    ],
}


@pytest.fixture(scope="session")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    for name in ("node", "npm"):
        if shutil.which(name) is None:
            pytest.skip(f"the bench is built with {name}, which is not installed")
    from dofkit.site.bench import build_bench
    from dofkit.site.gallery import catalog_scenes
    from dofkit.site.runtime import BenchError

    folder = Path(os.environ.get("DOFKIT_BENCH") or tmp_path_factory.mktemp("pages"))
    if not (folder / "bench").exists():
        try:
            build_bench(folder / "bench", list(catalog_scenes()))
        except BenchError as error:
            pytest.skip(f"the bench cannot be built: {error}")
    (folder / "screenshots").mkdir(exist_ok=True)
    put_runtime(folder / "practice", folder / "bench" / "runtime.js")
    write_page(load_assignment(GERMAN), drawing(), folder / "practice" / "index.html", judges=True)
    server = PageServer(("127.0.0.1", 0), partial(PageHandler, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield Served(f"http://127.0.0.1:{server.server_port}", folder, server)
    server.shutdown()


@pytest.fixture(scope="session")
def chromium() -> Iterator[Any]:
    if find_spec("playwright") is None:
        pytest.skip("playwright is not installed: pip install '.[browser]'")
    if CHROMIUM is None:
        pytest.skip("no Chromium is installed")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


class Visit:
    """A page of a profile of its own, and what its console said of errors; texts in dialogs are kept."""

    def __init__(self, context: Any) -> None:
        self.context, self.page = context, context.new_page()
        self.errors: list[str] = []
        self.page.on("console", lambda line: self._console(line.type, line.text))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("dialog", lambda dialog: (self.errors.append(f"dialog {dialog.message}"), dialog.dismiss()))

    def _console(self, kind: str, text: str) -> None:
        # CodeMirror clones its own element, whose style attribute the policy ignores: nothing is lost by that
        if kind == "error" and "Applying inline style" not in text and "cdn.jsdelivr.net" not in text:
            self.errors.append(text)

    def opened(self, url: str) -> Any:
        """Return the page once it has a report and Python has started."""
        self.page.goto(url)
        self.page.locator("#report table").first.wait_for(timeout=WAIT)
        self.page.locator("#state").filter(has_not_text="Loading").wait_for(timeout=WAIT, state="attached")
        return self.page


@contextmanager
def visiting(chromium: Any) -> Iterator[Visit]:
    """A visit in a profile of its own, which cannot reach Pyodide's distribution."""
    context = chromium.new_context(viewport={"width": 1280, "height": 860})
    context.route("https://cdn.jsdelivr.net/**", lambda route: route.abort())
    yield Visit(context)
    context.close()


@pytest.fixture
def visit(chromium: Any) -> Iterator[Visit]:
    with visiting(chromium) as fresh:
        yield fresh


@pytest.fixture(scope="session")
def started(served: Served, chromium: Any) -> Iterator[Visit]:
    with visiting(chromium) as first:
        first.opened(f"{served.url}/bench/")
        yield first


@pytest.fixture
def bench(served: Served, started: Visit) -> Visit:
    """The bench at its first example, in a page that tests share: Python takes seconds to start."""
    page = started.page
    page.set_viewport_size({"width": 1280, "height": 860})
    page.emulate_media(color_scheme="null", reduced_motion="null")
    page.evaluate("document.getElementById('menu').close()")
    for name, title in (("knife-edge", "Knife edge"), ("disc-rolling-on-plane", "Upright disc")):
        page.goto(f"{served.url}/bench/#example={name}")
        seen(page, "#report h2", title)
        page.locator("#picture:not([hidden])").wait_for()
    started.errors.clear()
    return started
