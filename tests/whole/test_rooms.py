"""The rooms hand on their surface, each name as it is in its file, and nothing is imported before it is asked for."""

from __future__ import annotations

import ast
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import dofkit

PACKAGE = Path(dofkit.__file__).parent


def lazy_rooms() -> list[str]:
    """The packages inside dofkit that hand on names, as they are, by ``_HOMES``."""
    files = [path for path in sorted(PACKAGE.rglob("__init__.py")) if path.parent != PACKAGE]
    rooms = [path.parent for path in files if "_HOMES = {" in path.read_text(encoding="utf-8")]
    names = [".".join(("dofkit", *room.relative_to(PACKAGE).parts)) for room in rooms]
    return [name for name in names if all(isinstance(home, str) for home in import_module(name)._HOMES.values())]


ROOMS = lazy_rooms()


def test_the_three_rooms_of_mechanics_hand_on_names() -> None:
    assert {"dofkit.mobility", "dofkit.configuration", "dofkit.integrability"} <= set(ROOMS)


@pytest.mark.parametrize("room", ROOMS)
def test_a_surface_is_what_lives_where_it_says(room: str) -> None:
    package = import_module(room)
    assert sorted(package.__all__) == sorted(package._HOMES)
    for name, home in package._HOMES.items():
        assert getattr(package, name) is getattr(import_module(home), name)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = package.nothing


@pytest.mark.parametrize("room", ROOMS)
def test_no_file_takes_the_name_of_what_is_handed_on(room: str) -> None:
    """A module that is imported becomes an attribute of its package, and would hide a function of its name."""
    folder = PACKAGE.joinpath(*room.split(".")[1:])
    assert not {path.stem for path in folder.iterdir()} & set(import_module(room).__all__)


@pytest.mark.parametrize("room", ROOMS)
def test_types_are_imported_from_the_same_places(room: str) -> None:
    path = PACKAGE.joinpath(*room.split(".")[1:], "__init__.py")
    imports = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ImportFrom)]
    shown = {alias.name: node.module for node in imports for alias in node.names}
    homes = import_module(room)._HOMES
    own = {name: home for name, home in shown.items() if (home or "").startswith("dofkit.")}
    assert own == {**homes, "handed_on": "dofkit.base.surface"}


def test_a_room_imports_nothing_heavy() -> None:
    heavy = ["numpy", "flint", "networkx", "sympy", "pydantic", "rich"]
    script = f"import sys; import {', '.join(ROOMS)}; print([m for m in {heavy} if m in sys.modules])"
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"
