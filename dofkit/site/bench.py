"""The bench: dofkit in the browser, as a folder of static files.

``bench/`` has the page, the worker and their style. Added here: Pyodide and the editor (from npm, pinned by the lock
file), the two compiled wheels of Pyodide's platform (from PyPI, in the versions that are installed), and archives of
the Python packages, in bytecode. The folder is not part of the wheel.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
import importlib.util
import json
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterable, Sequence
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory

from dofkit.base.errors import DofkitError
from dofkit.pictures.player import player_script
from dofkit.scene.schema import scene_schema
from dofkit.site.gallery import ShownScene

SOURCES = Path(__file__).parent / "bench"
PACKAGE = Path(__file__).parents[1]
#: The compiled packages, and the platform and the Python of Pyodide.
COMPILED = ("python-flint", "pydantic-core")
PLATFORM = ("--platform", "pyemscripten_2026_0_wasm32", "--python-version", "3.14", "--abi", "cp314")
#: The packages of each archive: what a report needs, and what is loaded after it for homework and equations of motion.
CORE = (
    "annotated_types",
    "latex2mathml",
    "lazy_loader",
    "networkx",
    "pydantic",
    "typing_extensions",
    "typing_inspection",
    "yaml",
)
SHEETS = ("markdown_it", "mdit_py_plugins", "mdurl")
SYMBOLS = ("mpmath", "sympy")
#: Folders of dofkit that no page needs; of its site only what the worker calls.
LEFT_OUT = ("benchmark", "homework", "site", "_catalog")
#: Files that tests and typists need.
UNUSED = ("tests", "test", "__pycache__", "testing")
#: What Pyodide needs at run time.
RUNTIME = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")


#: All that reads answers in one script, for the pages of sheets; the files in it beside its worker.
ONE_SCRIPT, WORKER = "runtime.js", "runtime-worker.js"
IN_ONE_SCRIPT = ("pyodide/pyodide.asm.wasm", "pyodide/python_stdlib.zip", "pyodide/pyodide-lock.json")
ARCHIVES = ("core.zip", "sheets.zip")

#: What a scene of the catalog expects of its report: the bench is not for reading that.
_EXPECTED = re.compile(r"^expect:.*\n(?:[ \t#].*\n|\n)*", re.MULTILINE)


class BenchError(DofkitError):
    """The bench could not be built; the message names what is missing."""


def build_bench(out: Path, catalog: Sequence[ShownScene]) -> None:
    """Build the bench into ``out``. Raises BenchError where node, npm or a package cannot be had."""
    if shutil.which("node") is None or shutil.which("npm") is None:
        raise BenchError("node and npm are not installed")
    modules = SOURCES / "node_modules"
    if not (modules / ".package-lock.json").exists():
        _run(["npm", "ci", "--no-audit", "--no-fund"], "npm ci")
    shutil.rmtree(out, ignore_errors=True)
    (out / "pyodide").mkdir(parents=True)
    (out / "player.js").write_text(player_script(), encoding="utf-8")
    for name in RUNTIME:
        shutil.copyfile(modules / "pyodide" / name, out / "pyodide" / name)
    with TemporaryDirectory() as folder:
        stage = Path(folder)
        _stage_compiled(stage / "core")
        _stage_packages(CORE, stage / "core")
        _stage_dofkit(stage / "core")
        _stage_packages(SHEETS, stage / "sheets")
        _stage_folder(PACKAGE / "homework", stage / "sheets" / "dofkit" / "homework")
        _stage_packages(SYMBOLS, stage / "symbols")
        _run(["node", "compile.mjs", str(stage), str(out.resolve())], "the compilation to bytecode")
    _run(["node", "bundle.mjs", str(out.resolve())], "the bundle")
    _fill_script(out)
    for path in SOURCES.iterdir():
        if path.suffix in (".html", ".css", ".svg", ".webmanifest"):
            shutil.copyfile(path, out / path.name)
    _write_catalog(out, catalog)
    (out / "schema.json").write_text(json.dumps(scene_schema()), encoding="utf-8")
    _write_version(out)


def _run(command: list[str], what: str) -> None:
    run = subprocess.run(command, cwd=SOURCES, capture_output=True, text=True, check=False)
    if run.returncode:
        raise BenchError(f"{what} failed: {(run.stderr or run.stdout).strip()[-2000:]}")


def _stage_compiled(target: Path) -> None:
    """Unpack the compiled wheels, in the versions that are installed."""
    with TemporaryDirectory() as folder:
        pins = [f"{name}=={version(name)}" for name in COMPILED]
        command = [sys.executable, "-m", "pip", "download", "-q", "--only-binary=:all:", "--no-deps", *PLATFORM]
        _run([*command, "-d", folder, *pins], "the download of wheels for the browser")
        for wheel in sorted(Path(folder).glob("*.whl")):
            with zipfile.ZipFile(wheel) as archive:
                names = [n for n in archive.namelist() if _is_used(Path(n)) and ".dist-info/" not in n]
                archive.extractall(target, names)


def _stage_packages(names: Iterable[str], target: Path) -> None:
    """Copy packages of this environment, without what is compiled for it."""
    for name in names:
        spec = importlib.util.find_spec(name)
        if spec is None or spec.origin is None:
            raise BenchError(f"the package {name} is not installed")
        origin = Path(spec.origin)
        if spec.submodule_search_locations is None:
            _copy(origin, target / origin.name)
        else:
            _stage_folder(origin.parent, target / name)
            for metadata in origin.parents[1].glob(f"{name}-*.dist-info/METADATA"):  # some ask for their own version
                _copy(metadata, target / metadata.parent.name / "METADATA")


def _stage_dofkit(target: Path) -> None:
    _stage_folder(PACKAGE, target / "dofkit", LEFT_OUT)
    _copy(PACKAGE / "site" / "__init__.py", target / "dofkit" / "site" / "__init__.py")
    _stage_folder(PACKAGE / "site" / "browser", target / "dofkit" / "site" / "browser")


def _stage_folder(source: Path, target: Path, left_out: Sequence[str] = ()) -> None:
    for path in source.rglob("*"):
        inner = path.relative_to(source)
        if path.is_file() and _is_used(inner) and inner.parts[0] not in left_out and ".so" not in inner.suffixes:
            _copy(path, target / inner)


def _is_used(path: Path) -> bool:
    return path.suffix not in (".pyi", ".pyd", ".pyx", ".c", ".typed") and not set(path.parts) & set(UNUSED)


def _copy(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def _write_catalog(out: Path, catalog: Sequence[ShownScene]) -> None:
    (out / "pictures").mkdir()
    for scene in catalog:
        (out / "pictures" / f"{scene.name}.svg").write_text(scene.svg, encoding="utf-8")
    fields = [
        {
            "name": s.name,
            "folder": s.folder,
            "title": s.title,
            "text": _EXPECTED.sub("", s.written),
            "alternative": s.alternative,
        }
        for s in catalog
    ]
    (out / "catalog.json").write_text(json.dumps(fields, ensure_ascii=False), encoding="utf-8")


def _fill_script(out: Path) -> None:
    """Put the worker and its files into the script that needs no web server, compressed and in base64."""
    sources = {"worker": out / WORKER} | {Path(name).name: out / name for name in (*IN_ONE_SCRIPT, *ARCHIVES)}
    packed = {
        name: base64.b64encode(gzip.compress(path.read_bytes(), 9, mtime=0)).decode() for name, path in sources.items()
    }
    with (out / ONE_SCRIPT).open("a", encoding="utf-8") as script:
        script.write(f"Object.assign(dofkitRuntime.files, {json.dumps(packed)});\n")
    (out / WORKER).unlink()


def _write_version(out: Path) -> None:
    """Write what the service worker keeps: every file that the bench loads, and a digest of all of them."""
    files = sorted(path for path in out.rglob("*") if path.is_file() and path.name != ONE_SCRIPT)
    digest = hashlib.sha256()
    for path in files:
        digest.update(path.read_bytes())
    listed = ["./", *(path.relative_to(out).as_posix() for path in files)]
    worker = (SOURCES / "offline.js").read_text(encoding="utf-8")
    filled = worker.replace("@VERSION@", digest.hexdigest()[:16]).replace('["@FILES@"]', json.dumps(listed))
    (out / "offline.js").write_text(filled, encoding="utf-8")
