"""The build of the site: hand-written and generated pages and the charts in one folder, from which MkDocs makes it."""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import yaml

from dofkit.base.errors import DofkitError
from dofkit.scene.constraints import TYPES
from dofkit.site.bench import build_bench
from dofkit.site.gallery import FOLDER as GALLERY
from dofkit.site.gallery import ShownScene, catalog_scenes, folders, gallery_pages
from dofkit.site.markdown import SitePage, with_bench_links
from dofkit.site.reference_pages import FOLDER as TYPE_FOLDER
from dofkit.site.reference_pages import GLOSSARY, command_pages, constraint_pages, readme_page, report_pages, rooms_page
from dofkit.site.runtime import BenchError

ROOT = Path(__file__).parents[2]
WRITTEN = Path(__file__).parent / "pages"
SETTINGS = Path(__file__).parent / "mkdocs.yml"
CHARTS = ROOT / "tests" / "charts"
#: Placeholders in the settings for the constraint types, the pages of the gallery and the folder of the package.
TYPES_HERE, GALLERY_HERE, PACKAGE_HERE = "every constraint type", "every folder of the catalog", "PACKAGE"


class SiteError(DofkitError):
    """The site could not be built."""


def build(out: Path) -> str | None:
    """Build the site into ``out``; return why it has no bench, or None if it has one.

    Raises SiteError if MkDocs is missing, or finds a broken link.
    """
    if not all(map(importlib.util.find_spec, ("material", "mkdocstrings"))):
        raise SiteError("mkdocs-material or mkdocstrings is missing: run pip install '.[docs]' in a clone")
    sources_folder = out.parent / f"{out.name}-sources"
    catalog = list(catalog_scenes())
    bench = out.parent / f"{out.name}-bench"
    missing = _without_bench(bench, catalog)
    sources(sources_folder, catalog, has_bench=missing is None)
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "-f", str(sources_folder / "mkdocs.yml")]
    run = subprocess.run([*command, "-d", str(out.resolve())], capture_output=True, text=True, check=False)
    if run.returncode:
        raise SiteError(f"mkdocs refused:\n{run.stdout}{run.stderr}")
    if missing is None:
        shutil.copytree(bench, out / "bench")
    return missing


def _without_bench(out: Path, catalog: Sequence[ShownScene]) -> str | None:
    """Build the bench; return None, or the reason why it cannot be built."""
    try:
        build_bench(out, catalog)
    except BenchError as error:
        return str(error)
    return None


def sources(folder: Path, catalog: Sequence[ShownScene], has_bench: bool = False) -> None:
    """Write the input of MkDocs into ``folder``: its settings, the pages, their pictures."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(WRITTEN, folder / "pages")
    shutil.copytree(CHARTS, folder / "pages" / "charts", ignore=shutil.ignore_patterns("*.csv", "*.json"))
    for page in generated(catalog, has_bench):
        target = folder / "pages" / page.path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(page.text, encoding="utf-8")
    if has_bench:
        for path in (folder / "pages").rglob("*.md"):
            bench = f"{'../' * (len(path.relative_to(folder).parts) - 2)}bench"
            path.write_text(with_bench_links(path.read_text(encoding="utf-8"), bench), encoding="utf-8")
    # JSON, because in YAML the type `on` would be read as the value true
    (folder / "mkdocs.yml").write_text(json.dumps(settings(catalog)), encoding="utf-8")


def generated(catalog: Sequence[ShownScene], has_bench: bool = False) -> Iterator[SitePage]:
    """Yield every page and picture that is generated from the package; ``has_bench``: with links to the bench."""
    yield readme_page((ROOT / "README.md").read_text(encoding="utf-8"), has_bench)
    yield rooms_page()
    yield from constraint_pages(catalog)
    yield from report_pages((WRITTEN / GLOSSARY).read_text(encoding="utf-8"))
    yield from command_pages()
    yield from gallery_pages(catalog, folders(), has_bench)


def settings(catalog: Sequence[ShownScene]) -> Any:
    """Return the settings of MkDocs, with every constraint type and every page of the gallery in the navigation."""
    table = yaml.safe_load(SETTINGS.read_text(encoding="utf-8"))
    names = folders()
    types = [f"{TYPE_FOLDER}/index.md", *({kind: f"{TYPE_FOLDER}/{kind}.md"} for kind in TYPES)]
    shelves = dict.fromkeys(scene.folder for scene in catalog)
    gallery = [f"{GALLERY}/index.md", *({names.get(name, name): f"{GALLERY}/{name}.md"} for name in shelves)]
    lists = {TYPES_HERE: types, GALLERY_HERE: gallery, PACKAGE_HERE: str(ROOT)}
    return {key: _filled(value, lists) for key, value in table.items()}


def _filled(entry: Any, lists: dict[str, Any]) -> Any:
    """Return ``entry`` with the values of ``lists`` in place of its placeholders."""
    if isinstance(entry, str):
        return lists.get(entry, entry)
    if isinstance(entry, dict):
        return {key: _filled(value, lists) for key, value in entry.items()}
    return [_filled(part, lists) for part in entry] if isinstance(entry, list) else entry
