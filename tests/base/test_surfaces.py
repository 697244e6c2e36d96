"""What a room hands on, and that its door is light."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module
from typing import Literal, get_origin

import pytest

ROOMS = ("base", "expressions", "exact", "scene", "relations", "interface")


@pytest.mark.parametrize("room", ROOMS)
def test_every_name_of_a_surface_is_there(room: str) -> None:
    package = import_module(f"dofkit.{room}")
    assert dir(package) == sorted(package.__all__)
    for name in package.__all__:
        found = getattr(package, name)
        assert found.__doc__ or get_origin(found) is Literal
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        vars(package)["__getattr__"]("nothing")


def test_a_door_imports_nothing_heavy() -> None:
    code = "import sys; " + "; ".join(f"import dofkit.{room}" for room in ROOMS)
    heavy = "print(*({'flint', 'numpy', 'sympy', 'pydantic'} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-c", f"{code}; {heavy}"], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
