"""dofkit and what it needs as wheels, for a machine without a network."""

from __future__ import annotations

import base64
import hashlib
import subprocess
import sys
import zipfile
from collections.abc import Iterator, Sequence
from importlib import metadata, resources
from importlib.resources.abc import Traversable
from pathlib import Path

from dofkit.base import __version__
from dofkit.scene.catalog import catalog_folder

#: What wheels for Linux on a usual processor are called.
PLATFORMS = ("manylinux_2_28_x86_64", "manylinux_2_17_x86_64", "manylinux2014_x86_64")
PIP_SECONDS = 600.0


def own_wheel(folder: Path) -> Path:
    """The wheel of this dofkit, made from what is installed, in a folder."""
    name = f"dofkit-{__version__}"
    info = f"{name}.dist-info"
    files = dict(_files())
    files[f"{info}/METADATA"] = "".join(f"{line}\n" for line in _metadata()).encode()
    files[f"{info}/WHEEL"] = b"Wheel-Version: 1.0\nGenerator: dofkit\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    files[f"{info}/entry_points.txt"] = b"[console_scripts]\ndofkit = dofkit.interface.entry:main\n"
    record = f"{info}/RECORD"
    files[record] = "".join([*(_recorded(path, data) for path, data in files.items()), f"{record},,\n"]).encode()
    wheel = folder / f"{name}-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, data in files.items():
            archive.writestr(zipfile.ZipInfo(path), data, zipfile.ZIP_DEFLATED)
    return wheel


def requirements() -> list[str]:
    """What dofkit needs, without its extras; none where it is not installed, so that nothing is known of it."""
    try:
        needed = metadata.requires("dofkit") or []
    except metadata.PackageNotFoundError:
        return []
    return [requirement for requirement in needed if "extra ==" not in requirement]


def download(folder: Path, python: str, needed: Sequence[str]) -> str | None:
    """Get the wheels of requirements for a version of Python, such as 3.12; why that did not work, or None."""
    platforms = [option for platform in PLATFORMS for option in ("--platform", platform)]
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--dest", str(folder)]
    command = [*pip, "--only-binary=:all:", "--implementation", "cp", "--python-version", python, *platforms, *needed]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PIP_SECONDS, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error)
    if done.returncode == 0:
        return None
    lines = [line for line in done.stderr.splitlines() if line.startswith(("ERROR", "/"))] or done.stderr.splitlines()
    return lines[-1] if lines else "pip failed"


def _metadata() -> Iterator[str]:
    yield from ("Metadata-Version: 2.1", "Name: dofkit", f"Version: {__version__}")
    yield "Requires-Python: >=3.11"
    yield from (f"Requires-Dist: {requirement}" for requirement in requirements())


def _files() -> Iterator[tuple[str, bytes]]:
    yield from _below(resources.files("dofkit"), "dofkit")
    if not (resources.files("dofkit") / "_catalog").is_dir():
        yield from _below(catalog_folder(), "dofkit/_catalog")


def _below(folder: Traversable, path: str) -> Iterator[tuple[str, bytes]]:
    for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
        if entry.name.startswith((".", "__pycache__")):
            continue
        if entry.is_dir():
            yield from _below(entry, f"{path}/{entry.name}")
        else:
            yield f"{path}/{entry.name}", entry.read_bytes()


def _recorded(path: str, data: bytes) -> str:
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{path},sha256={digest},{len(data)}\n"
