"""Libraries that are imported when they are needed."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction

import pytest

from dofkit.base.libraries import LateLibrary


def test_a_library_is_imported_for_its_first_attribute() -> None:
    library = LateLibrary("fractions")
    assert library.Fraction is Fraction
    assert vars(library)["Fraction"] is Fraction
    with pytest.raises(AttributeError):
        _ = library.no_such_thing


def test_forms_need_neither_numpy_nor_networkx() -> None:
    code = (
        "import sys, dofkit; assert dofkit.classify('disc-rolling-on-plane').dof == 4; "
        "print([m for m in ('numpy', 'networkx', 'sympy') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
