"""The runtime: a folder of static files with which a page runs dofkit in a worker of the browser.

```javascript
const worker = new Worker(new URL("./runtime/worker.js", import.meta.url), { type: "module" });
worker.postMessage({ id: 1, call: "report", args: [text, []] });   // answered by {id, value} or {id, error}
```

The calls are the functions of `dofkit.site.browser`: `check`, `report`, `as_json`, `picture`, `motion`, `equations`,
`read`, `judge`. The folder contains `worker.js`; the scripts of Pyodide (from npm, pinned by the lock file);
`core.bin`: Pyodide's compiled runtime, the standard library and the packages for reports in bytecode, compiled
libraries (from PyPI, in the installed versions; of FLINT only the used modules); and archives that are loaded when a
call needs them: `extras.zst` for linkages and pictures, with rarely used modules of the standard library, `sheets.zst`
for homework, and `symbols.zst` for equations of motion.
"""

from __future__ import annotations

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
from typing import Any

import yaml

from dofkit.base.errors import DofkitError

SOURCES = Path(__file__).parent / "bench"
PACKAGE = Path(__file__).parents[1]
#: The contents of the runtime: packages, files, and what is left out.
CONTENTS: dict[str, Any] = yaml.safe_load((SOURCES / "contents.yaml").read_text(encoding="utf-8"))
#: The scripts of Pyodide that are needed in addition to its compiled runtime and the standard library.
PYODIDE = ("pyodide.mjs", "pyodide.asm.mjs")
#: Pyodide's list of packages, and the only package of the list that is used.
LOCK, DISTRIBUTED = "pyodide-lock.json", "numpy"


class BenchError(DofkitError):
    """The files could not be built; the message names what is missing."""


def build_runtime(out: Path) -> None:
    """Build the runtime into ``out``. Raises BenchError if node, npm or a package is missing."""
    if shutil.which("node") is None or shutil.which("npm") is None:
        raise BenchError("node and npm are not installed")
    modules = SOURCES / "node_modules"
    if not (modules / ".package-lock.json").exists():
        run(["npm", "ci", "--no-audit", "--no-fund"], "npm ci")
    for name in PYODIDE:
        _copy(modules / "pyodide" / name, out / name)
    _write_lock(modules / "pyodide" / LOCK, out / LOCK)
    with TemporaryDirectory() as folder:
        packages = Path(folder)
        _copy(modules / "pyodide" / "pyodide.asm.wasm", packages / "library" / "pyodide.asm.wasm")
        _stage_library(modules / "pyodide" / "python_stdlib.zip", packages)
        _stage_compiled(packages / "core")
        _stage_dofkit(packages / "core")
        for archive, names in CONTENTS["packages"].items():
            _stage_packages(names, packages / archive)
        for archive, names in CONTENTS["rooms"].items():
            for name in names:
                _stage_folder(PACKAGE / name, packages / archive / "dofkit" / name)
        run(["node", "compile.mjs", str(packages), str(out.resolve())], "the compilation to bytecode")


def run(command: list[str], what: str) -> None:
    """Run a command in the folder of the sources. Raises BenchError if it fails; ``what`` names it in the message."""
    ran = subprocess.run(command, cwd=SOURCES, capture_output=True, text=True, check=False)
    if ran.returncode:
        raise BenchError(f"{what} failed: {(ran.stderr or ran.stdout).strip()[-2000:]}")


def _write_lock(source: Path, target: Path) -> None:
    """Write Pyodide's list of packages with numpy only, which depends on no other package."""
    lock = json.loads(source.read_text(encoding="utf-8"))
    lock["packages"] = {DISTRIBUTED: lock["packages"][DISTRIBUTED]}
    target.write_text(json.dumps(lock), encoding="utf-8")


def _stage_library(file: Path, packages: Path) -> None:
    """Unpack the standard library into ``library``, and its rarely used modules into ``extras``."""
    with zipfile.ZipFile(file) as archive:
        for name in archive.namelist():
            is_seldom = name.partition("/")[0].removesuffix(".py") in CONTENTS["seldom"]
            archive.extract(name, packages / ("extras" if is_seldom else "library"))


def _stage_compiled(target: Path) -> None:
    """Unpack the wheels for the browser, in the versions that are installed, without the modules that are not used."""
    with TemporaryDirectory() as folder:
        pins = [f"{name}=={version(name)}" for name in CONTENTS["compiled"]]
        command = [sys.executable, "-m", "pip", "download", "-q", "--only-binary=:all:", "--no-deps"]
        run([*command, *CONTENTS["platform"], "-d", folder, *pins], "the download of wheels for the browser")
        for wheel in sorted(Path(folder).glob("*.whl")):
            with zipfile.ZipFile(wheel) as archive:
                for path in map(Path, archive.namelist()):
                    is_metadata = path.parts[0].endswith(".dist-info")
                    if _is_used(path) and not is_metadata and path.name.split(".")[0] not in CONTENTS["unused_modules"]:
                        archive.extract(path.as_posix(), target)
    types = target / "flint" / "__init__.py"
    types.write_text(without_unused(types.read_text(encoding="utf-8")), encoding="utf-8")


def without_unused(text: str) -> str:
    """Return the text of FLINT's package without the imports of unused modules.

    >>> without_unused("from .types.arb import arb\\nfrom .types.nmod_series import nmod_series\\n")
    'from .types.arb import arb\\n'
    """
    imports = re.compile(rf"^from \.\w+\.(?:{'|'.join(CONTENTS['unused_modules'])}) import .*\n", re.MULTILINE)
    return imports.sub("", text)


def _stage_packages(names: Iterable[str], target: Path) -> None:
    """Copy packages of this environment, without compiled extensions. Raises BenchError if one is not installed."""
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
                head = metadata.read_text(encoding="utf-8").partition("\n\n")[0]
                _copy(metadata, target / metadata.parent.name / "METADATA").write_text(f"{head}\n", encoding="utf-8")


def _stage_dofkit(target: Path) -> None:
    _stage_folder(PACKAGE, target / "dofkit", CONTENTS["left_out"])
    _copy(PACKAGE / "site" / "__init__.py", target / "dofkit" / "site" / "__init__.py")
    _stage_folder(PACKAGE / "site" / "browser", target / "dofkit" / "site" / "browser")


def _stage_folder(source: Path, target: Path, left_out: Sequence[str] = ()) -> None:
    """Copy the used files of a folder, without compiled extensions and without the paths ``left_out``."""
    for path in source.rglob("*"):
        inner = path.relative_to(source)
        is_left_out = ".so" in inner.suffixes or any(inner.is_relative_to(name) for name in left_out)
        if path.is_file() and _is_used(inner) and not is_left_out:
            _copy(path, target / inner)


def _is_used(path: Path) -> bool:
    return path.suffix not in CONTENTS["unused_endings"] and set(CONTENTS["unused"]).isdisjoint(path.parts)


def _copy(source: Path, target: Path) -> Path:
    target.parent.mkdir(parents=True, exist_ok=True)
    return Path(shutil.copyfile(source, target))
