"""How large the pages of moving pictures are, how soon they are drawn, and how long a frame takes, beside plotly's.

`python tests/bench_pictures.py [SCENE...]`; needs Chromium and playwright, and plotly for the comparison.
"""

from __future__ import annotations

import json
import shutil
import statistics
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import dofkit
from dofkit.pictures.animation import Animation

SCENES = ("four-bar-linkage", "rssr-linkage")
REPEATS, FRAMES = 3, 12
#: What is measured in each page: it sets `ready` when it is drawn, and `step` shows the next frame.
FRAME_TIME = """async () => {
  const start = performance.now();
  for (let k = 0; k < FRAMES; k++) { await window.step(); await new Promise(r => requestAnimationFrame(r)); }
  return (performance.now() - start) / FRAMES;
}""".replace("FRAMES", str(FRAMES))


def own_page(animation: Animation) -> str:
    """The page as it is saved, with the two hooks."""
    end = '  window.addEventListener("resize", draw);\n  draw();'
    page = animation.html()
    assert end in page
    return page.replace(end, f"{end}\n  window.ready = performance.now(); window.step = advance;")


def plotly_page(animation: Animation) -> str | None:
    """The same lines and frames by plotly, its script inside."""
    if find_spec("plotly") is None:
        return None
    import plotly.graph_objects as go

    sketch = animation.sketch

    def traces(poses: Any) -> list[Any]:
        lines = [[sketch.at(v, poses) for v in s.vertices] for s in sketch.shapes if s.kind != "words"]
        columns = [list(zip(*line, strict=True)) for line in lines]
        return [go.Scatter3d(x=x, y=y, z=z, mode="lines", line={"width": 4}) for x, y, z in columns]

    frames = [go.Frame(data=traces(poses)) for poses in animation.clips[0].frames]
    figure = go.Figure(data=traces(sketch.poses), frames=frames)
    hooks = f"""window.ready = performance.now(); let k = 0;
    const frames = document.getElementById("fig")._transitionData._frames;
    window.step = () => {{ k = (k + 1) % frames.length; return Plotly.animate("fig", {{data: frames[k].data,
      traces: {json.dumps(list(range(len(figure.data))))}}}, {{frame: {{duration: 0, redraw: true}}}}); }};"""
    told: str = figure.to_html(include_plotlyjs=True, div_id="fig", post_script=hooks)
    return told


def measured(browser: Any, path: Path) -> tuple[float, float]:
    """Milliseconds until a page is drawn, and for a frame."""
    ready, frame = [], []
    for _ in range(REPEATS):
        page = browser.new_page(viewport={"width": 760, "height": 700})
        page.goto(path.as_uri())
        page.wait_for_function("window.ready")
        ready.append(page.evaluate("window.ready"))
        frame.append(page.evaluate(FRAME_TIME))
        page.close()
    return statistics.median(ready), statistics.median(frame)


def main(names: list[str]) -> None:
    """Print a line for each scene and each way to draw it."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        print(f"{'scene':<24}{'page by':<10}{'kB':>8}{'drawn, ms':>12}{'frame, ms':>12}")
        for name in names:
            animation = dofkit.animate(name)
            for way, page in (("dofkit", own_page(animation)), ("plotly", plotly_page(animation))):
                if page is None:
                    continue
                path = Path(folder) / f"{way}.html"
                path.write_text(page, encoding="utf-8")
                ready, frame = measured(browser, path)
                print(f"{name:<24}{way:<10}{len(page.encode()) / 1000:>8.0f}{ready:>12.0f}{frame:>12.1f}")
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1:] or list(SCENES))
