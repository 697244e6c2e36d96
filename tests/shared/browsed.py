"""What the tests of pages in a browser look at: texts that appear, screenshots, and what axe-core finds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from shared.documented import ROOT
from shared.served import Served

AXE = ROOT / "dofkit" / "site" / "bench" / "node_modules" / "axe-core" / "axe.min.js"
#: Milliseconds for an answer of a Python that has started, on a busy machine.
SOON = 30_000
KNIFE = """\
coordinates: [x, y, theta]
constraints:
- {name: edge, type: equation, text: "sin(theta) dx - cos(theta) dy = 0"}
"""


def write(page: Any, text: str) -> None:
    """Put a text in place of all in the editor, as by pasting."""
    page.locator(".cm-content").click()
    page.keyboard.press("Control+A")
    page.keyboard.insert_text(text)


def seen(page: Any, selector: str, text: str) -> None:
    """Wait until an element has a text."""
    page.locator(selector).filter(has_text=text).first.wait_for(timeout=SOON)


def shot(page: Any, served: Served, name: str) -> None:
    """Keep screenshots at the width of a desk and of a telephone, to be looked at."""
    folder = served.folder / "screenshots"
    for device, width, height in (("desktop", 1280, 860), ("phone", 360, 740)):
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(200)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), f"{name} is too wide for {device}"
        page.screenshot(path=folder / f"{name}-{device}.png", full_page=device == "phone")
    page.set_viewport_size({"width": 1280, "height": 860})


def violations(page: Any) -> list[str]:
    """Return what axe-core finds."""
    page.evaluate(Path(AXE).read_text(encoding="utf-8"))
    violations = page.evaluate("axe.run({iframes: false})")["violations"]
    return [f"{v['id']}: {v['nodes'][0]['html'][:200]} {v['nodes'][0]['failureSummary']}" for v in violations]
