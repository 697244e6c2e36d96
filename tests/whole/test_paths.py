"""Every path and module that the README, the theorems or a docstring names is there."""

from __future__ import annotations

import re
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

import dofkit

PACKAGE = Path(dofkit.__file__).parent
ROOT = next(folder for folder in Path(__file__).parents if (folder / "pyproject.toml").exists())
TOLD = [ROOT / "README.md", *PACKAGE.rglob("*.md"), *PACKAGE.rglob("*.py"), *(ROOT / "tests").rglob("*.py")]
_NAME = re.compile(r"`(dofkit(?:\.[A-Za-z_]\w*)+)`")
_PATH = re.compile(r"`((?:dofkit|tests|catalog|[a-z_]+)/(?:[\w.-]+/)*(?:[\w-]+\.\w+)?)`")
_LINK = re.compile(r"\]\(((?:tests|dofkit|catalog)/[^)#]+)\)")


def resolves(name: str) -> bool:
    """Is it a module, or an attribute of one?"""
    module, _, attribute = name.rpartition(".")
    if find_spec(name.partition(".")[0]) is None:
        return False
    try:
        import_module(name)
    except ModuleNotFoundError:
        return bool(module) and hasattr(import_module(module), attribute)
    return True


@pytest.mark.parametrize("path", [p for p in TOLD if "`dofkit" in p.read_text("utf-8")], ids=lambda p: p.name)
def test_names(path: Path) -> None:
    missing = {name for name in _NAME.findall(path.read_text("utf-8")) if not resolves(name)}
    assert not missing


@pytest.mark.parametrize("path", [ROOT / "README.md", *PACKAGE.rglob("*.md")], ids=lambda p: p.name)
def test_paths(path: Path) -> None:
    text = path.read_text("utf-8")
    named = {*_PATH.findall(text), *_LINK.findall(text)}
    missing = {name for name in named if not ((ROOT / name).exists() or (PACKAGE / name).exists())}
    assert not missing


def test_docstrings_name_files_that_are_there() -> None:
    missing = []
    for path in PACKAGE.rglob("*.py"):
        for name in re.findall(r"`((?:[a-z_]+/)+[a-z_]+\.(?:py|md))`", path.read_text("utf-8")):
            if not ((PACKAGE / name).exists() or (ROOT / name).exists()):
                missing.append(f"{path.relative_to(PACKAGE)}: {name}")
    assert not missing
