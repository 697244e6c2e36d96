"""The bench: a page that classifies a scene as one types, as a folder of static files.

The folder ``bench/`` contains the page, its scripts and their style; `runtime` builds the folder that runs dofkit. The
wheel contains neither.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
import re
import shutil
from collections.abc import Sequence
from pathlib import Path

from dofkit.pictures.player import player_script
from dofkit.scene.schema import scene_schema
from dofkit.site.browser.reports import report
from dofkit.site.gallery import ShownScene, folders
from dofkit.site.runtime import SOURCES, build_runtime, run

#: Files that the service worker keeps for offline visits only after their first use.
SELDOM = ("runtime/symbols.zst", "runtime/sheets.zst")
#: One script with everything that reads answers, for practice sheets: its name, its worker, the files that it contains.
ONE_SCRIPT, WORKER = "runtime.js", "runtime-worker.js"
IN_ONE_SCRIPT = ("pyodide-lock.json", "core.bin", "extras.zst", "sheets.zst")
#: The `expect` section of a catalog scene, which the bench does not show.
_EXPECTED = re.compile(r"^expect:.*\n(?:[ \t#].*\n|\n)*", re.MULTILINE)


def build_bench(out: Path, catalog: Sequence[ShownScene]) -> None:
    """Build the bench into ``out``, which is emptied first. Raises BenchError if node, npm or a package is missing."""
    shutil.rmtree(out, ignore_errors=True)
    build_runtime(out / "runtime")
    run(["node", "bundle.mjs", str(out.resolve())], "the bundle")
    (out / "player.js").write_text(player_script(), encoding="utf-8")
    _fill_script(out)
    for path in SOURCES.iterdir():
        if path.suffix in (".html", ".css", ".svg", ".webmanifest"):
            shutil.copyfile(path, out / path.name)
    _write_catalog(out, catalog)
    (out / "schema.json").write_text(json.dumps(scene_schema()), encoding="utf-8")
    _write_service_worker(out)


def _write_catalog(out: Path, catalog: Sequence[ShownScene]) -> None:
    """Write the pictures of the catalog's scenes, and ``catalog.json`` with their texts and reports."""
    (out / "pictures").mkdir()
    for scene in catalog:
        (out / "pictures" / f"{scene.name}.svg").write_text(scene.svg, encoding="utf-8")
    topics = {name: title.partition(" (")[0] for name, title in folders().items()}
    fields = [
        {
            "name": s.name,
            "topic": topics[s.folder],
            "title": s.title,
            "text": text,
            "alternative": s.alternative,
            "answer": report(text, ()),
        }
        for s in catalog
        if (text := _EXPECTED.sub("", s.written))
    ]
    (out / "catalog.json").write_text(json.dumps(fields, ensure_ascii=False), encoding="utf-8")


def _fill_script(out: Path) -> None:
    """Append the worker and its files, compressed and in base64, to the script that needs no web server."""
    sources = {"worker": out / WORKER} | {name: out / "runtime" / name for name in IN_ONE_SCRIPT}
    compressed = {name: gzip.compress(path.read_bytes(), 9, mtime=0) for name, path in sources.items()}
    packed = {name: base64.b64encode(data).decode() for name, data in compressed.items()}
    with (out / ONE_SCRIPT).open("a", encoding="utf-8") as script:
        script.write(f"Object.assign(dofkitRuntime.files, {json.dumps(packed)});\n")
    (out / WORKER).unlink()


def _write_service_worker(out: Path) -> None:
    """Write the service worker ``offline.js`` with the list of files to keep, and a digest of all as its version."""
    files = sorted(path for path in out.rglob("*") if path.is_file() and path.name != ONE_SCRIPT)
    digest = hashlib.sha256()
    for path in files:
        digest.update(path.read_bytes())
    listed = ["./", *(path.relative_to(out).as_posix() for path in files)]
    listed = [name for name in listed if name not in SELDOM]
    worker = (SOURCES / "offline.js").read_text(encoding="utf-8")
    filled = worker.replace("@VERSION@", digest.hexdigest()[:16]).replace('["@FILES@"]', json.dumps(listed))
    (out / "offline.js").write_text(filled, encoding="utf-8")
