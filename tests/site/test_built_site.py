"""The whole site: built without a warning, and read in a browser without a network."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import dofkit
from dofkit.scene.constraints import TYPES
from dofkit.site.building import build

CHROMIUM = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None
)
#: Pixels of a screen and of a telephone, and the colours asked for.
SCREENS = ((1280, "light"), (390, "dark"))
SHOWN = (
    "index.html", "tutorial.html", "gallery/index.html", "gallery/joints.html", "reference/types/index.html",
    "reference/types/on.html", "reference/glossary.html", "reference/python.html", "reference/commands.html",
    "about/theorems.html", "about/methods.html", "guide/answers.html",
)  # fmt: skip

pytestmark = [
    pytest.mark.sweep,
    pytest.mark.xdist_group("site"),
    pytest.mark.skipif(
        find_spec("mkdocstrings") is None, reason="the site needs the extra `docs`: pip install '.[docs]'"
    ),
]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("built") / "site"
    build(out)
    return out


class Reader(NamedTuple):
    """A page of a browser that is offline, and what its console said of errors."""

    page: Any
    said: list[str]


@pytest.fixture(scope="module", params=SCREENS, ids=["screen", "telephone"])
def reader(request: pytest.FixtureRequest) -> Iterator[Reader]:
    if CHROMIUM is None or find_spec("playwright") is None:
        pytest.skip("no Chromium, or no playwright to look at pages with")
    from playwright.sync_api import sync_playwright

    width, colours = request.param
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        context = browser.new_context(offline=True, viewport={"width": width, "height": 900}, color_scheme=colours)
        page, said = context.new_page(), []
        page.on("console", lambda told: said.append(told.text) if told.type == "error" else None)
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("requestfailed", lambda request: said.append(request.url))
        yield Reader(page, said)
        browser.close()


def test_every_type_and_scene_has_its_page(site: Path) -> None:
    assert all((site / "reference" / "types" / f"{kind}.html").is_file() for kind in TYPES)
    gallery = "".join(path.read_text(encoding="utf-8") for path in (site / "gallery").glob("*.html"))
    for name in dofkit.catalog_names():
        assert (site / "gallery" / f"{name}.svg").is_file()
        assert f'<h2 id="{name}">' in gallery


def test_no_page_asks_for_anything_of_the_network(site: Path) -> None:
    for path in set(site.rglob("*.html")) - {site / "bench" / "index.html"}:  # which may ask for Python
        text = path.read_text(encoding="utf-8")
        assert not [word for word in ("unpkg", "googleapis", "jsdelivr", "cdnjs") if word in text], path


@pytest.mark.parametrize("name", SHOWN)
def test_pages_are_read_without_an_error_and_fit_the_screen(site: Path, reader: Reader, name: str) -> None:
    reader.said.clear()
    reader.page.goto((site / name).as_uri())
    reader.page.wait_for_timeout(300)
    assert reader.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    broken = "[...document.images].filter(i => i.complete && !i.naturalWidth).map(i => i.src)"
    assert reader.page.evaluate(broken) == []
    assert reader.said == []


def test_words_are_found_in_pages_that_are_opened_as_files(site: Path, reader: Reader) -> None:
    reader.page.goto((site / "index.html").as_uri())
    reader.page.wait_for_timeout(500)
    reader.page.keyboard.press("/")
    reader.page.keyboard.type("growth_vector")
    reader.page.wait_for_selector(".md-search-result__link", state="attached", timeout=20_000)
    links = reader.page.eval_on_selector_all(".md-search-result__link", "found => found.map(one => one.href)")
    assert any("reference/glossary.html" in link for link in links)
