"""How long the bench takes and what it transfers: measured in Chromium and printed (`pytest -m browser -s`)."""

from __future__ import annotations

import time
from statistics import quantiles
from typing import Any

import pytest
from shared.browsed import KNIFE, SOON, write
from shared.served import PageHandler, Served

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("browser"), pytest.mark.timeout(900)]
#: Milliseconds for Python to start, on a busy machine.
WAIT = 4 * SOON
#: A worker that also says how much memory Python has: it grows as Python asks for more, and never shrinks.
WEIGHED = """
const { instantiate, instantiateStreaming } = WebAssembly;
let memory;
const kept = (made) => { memory ??= (made.instance ?? made).exports.memory; return made; };
WebAssembly.instantiate = (...given) => instantiate(...given).then(kept);
WebAssembly.instantiateStreaming = (...given) => instantiateStreaming(...given).then(kept);
addEventListener("message", ({ data }) => data === "memory" && postMessage({ memory: memory.buffer.byteLength }));
import("./worker.js");
"""
#: Asks for the faults and the report of every scene, and how long each took; then for fifty reports once more.
ASK = """async ([url, texts]) => {
  const worker = new Worker(url, {type: "module"});
  const heard = (holds) => new Promise((resolve) => {
    const hear = ({data}) => { if (holds(data)) { worker.removeEventListener("message", hear); resolve(data); } };
    worker.addEventListener("message", hear);
  });
  await heard((data) => data.state === "ready");
  let id = 0;
  const asked = async (call, ...args) => {
    const start = performance.now();
    const answer = heard((data) => data.id === id);
    worker.postMessage({id, call, args});
    const {value, error} = await answer;
    id += 1;
    return {value, error, took: performance.now() - start};
  };
  const memory = () => {
    const weighed = heard((data) => data.memory);
    worker.postMessage("memory");
    return weighed;
  };
  await asked("check", texts[0]);
  const checks = [], reports = [], faults = [], memories = [];
  for (const text of texts) {
    checks.push((await asked("check", text)).took);
    const {value, error, took} = await asked("report", text, []);
    reports.push(took);
    if (error || value.faults.length) faults.push(text.slice(0, 60));
  }
  memories.push((await memory()).memory);
  for (const text of texts.slice(0, 50)) await asked("report", text, []);
  memories.push((await memory()).memory);
  return {checks, reports, faults, memories};
}"""


#: What says how long it took from the next keystroke until its report is there.
TIMED = """() => {
  window.answered = new Promise((resolve) => {
    let start;
    addEventListener("keydown", () => { start = performance.now(); }, { capture: true, once: true });
    new MutationObserver((_, observer) => { observer.disconnect(); resolve(performance.now() - start); })
      .observe(document.getElementById("report"), { childList: true });
  });
}"""


def measured(what: str, value: float, unit: str) -> None:
    """Print a figure."""
    print(f"{what}: {value:.3g} {unit}")


def visited(page: Any, url: str, which: str) -> None:
    """Measure a visit: until the first report with its picture is there, and until an edit is answered."""
    sizes: list[int] = []  # of what the page and its worker ask for, not the service worker
    page.on("response", lambda answer: sizes.append(int(answer.headers.get("content-length", 0))))
    page.goto("about:blank")
    start = time.perf_counter()
    page.goto(url)
    page.locator("#picture:not([hidden])").wait_for()
    page.locator("#report table").first.wait_for()
    measured(f"{which} visit, page to report with picture", time.perf_counter() - start, "s")
    measured(f"{which} visit, transferred before the first report", sum(sizes) / 1e6, "MB")
    write(page, KNIFE)
    page.locator("#report th", has_text="edge").wait_for(timeout=WAIT)
    measured(f"{which} visit, page to the report on an edited scene", time.perf_counter() - start, "s")
    measured(f"{which} visit, transferred before the report on an edited scene", sum(sizes) / 1e6, "MB")


def test_the_first_and_the_second_visit(served: Served, visit: Any) -> None:
    visited(visit.page, f"{served.url}/bench/", "first")
    visit.page.evaluate("navigator.serviceWorker.ready.then(() => null)")
    visited(visit.page, f"{served.url}/bench/", "second")


def test_the_first_visit_over_a_slow_line(served: Served, visit: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PageHandler, "rate", 20e6 / 8)
    start = time.perf_counter()
    page = visit.page
    page.goto(f"{served.url}/bench/")
    page.locator("#report table").first.wait_for()
    measured("first visit over 20 Mbit/s, page to report", time.perf_counter() - start, "s")
    write(page, KNIFE)
    page.locator("#report th", has_text="edge").wait_for(timeout=WAIT)
    measured("first visit over 20 Mbit/s, page to the report on an edited scene", time.perf_counter() - start, "s")


def test_a_keystroke_and_its_report(bench: Any) -> None:
    """The 300 ms for which a page waits before it asks are part of what is measured; the scene is new to Python."""
    page = bench.page
    texts = page.evaluate("fetch('catalog.json').then((a) => a.json()).then((all) => all.map((scene) => scene.text))")
    times = []
    for text in texts[::4]:
        write(page, f"{text}\n# edited\n}}")
        page.locator("#faults li").wait_for(timeout=SOON)
        page.evaluate(TIMED)
        page.keyboard.press("Backspace")
        times.append(page.evaluate("window.answered"))
    measured("a keystroke to its report in the page, 95 of 100 scenes within", quantiles(times, n=20)[-1], "ms")
    measured("a keystroke to its report in the page, median", quantiles(times, n=2)[0], "ms")


def test_the_faults_and_reports_of_the_catalog_and_their_memory(served: Served, visit: Any) -> None:
    (served.folder / "bench" / "runtime" / "weighed.js").write_text(WEIGHED, encoding="utf-8")
    page = visit.page
    page.goto(f"{served.url}/bench/player.html")
    texts = page.evaluate("fetch('catalog.json').then((a) => a.json()).then((all) => all.map((scene) => scene.text))")
    answer = page.evaluate(ASK, [f"{served.url}/bench/runtime/weighed.js", texts])
    for name in ("checks", "reports"):
        measured(f"{name}, 95 of 100 scenes within", quantiles(answer[name], n=20)[-1], "ms")
        measured(f"{name}, slowest", max(answer[name]), "ms")
    assert answer["faults"] == []
    before, after = answer["memories"]
    measured(f"memory of Python after {len(texts)} reports", before / 1e6, "MB")
    measured(f"memory of Python after {len(texts) + 50} reports", after / 1e6, "MB")
    assert after == before
    assert after < 200e6
