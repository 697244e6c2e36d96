"""What one point tells of some of a block's forms: curvature, and whether brackets reach everything."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from dofkit.classification.study import study
from dofkit.integrability.pfaffian_system import codistribution
from dofkit.integrability.single_form import SharedForms, shared_forms
from dofkit.scene.lowering import lower
from dofkit.scene.reading import load


def of_block(names: str, *constraints: str) -> SharedForms | None:
    known = study(lower(load({"coordinates": names.split(), "constraints": list(constraints)})))
    (block,) = known.outcome.blocks
    return shared_forms(codistribution(block, known.setting, ()))


@pytest.mark.parametrize(
    ("names", "form", "is_open", "is_curved"),
    [
        ("x y z", "dz - y dx = 0", True, True),
        ("x y z", "y dx + x dy + dz = 0", False, False),
        ("x y z", "z y dx + z x dy + z dz = 0", True, False),
        ("x y", "x dy - y dx = 0", True, False),
        ("x y th", "sin(th) dx = cos(th) dy", True, True),
        ("x t1 y", "exp(t1) dx + exp(t1) y dy = 0", True, False),
    ],
)
def test_curvature_of_one_form(names: str, form: str, is_open: bool, is_curved: bool) -> None:
    """dz - y dx has d = dx ^ dy; a closed form has none; z times a closed form is open, and integrates."""
    shared = of_block(names, form)
    assert shared is not None
    assert (shared.curl(0).is_open, shared.curl(0).is_curved) == (is_open, is_curved)
    assert shared.reach_everything([0]) is is_curved


EDGES = ("sin(th) dx = cos(th) dy", "sin(th) dx = cos(th) dy + dth")
DISC = ("dx = cos(th) dph", "dy = sin(th) dph")


@pytest.mark.parametrize(
    ("names", "forms", "numbers", "reach"),
    [
        ("x y th", EDGES, [0], True),
        ("x y th", EDGES, [0, 1], False),
        ("x y th ph", DISC, [0, 1], True),
        ("x y z w", ("dz = y dx", "dw = y dx"), [0, 1], False),
        ("x y z w v", ("dz = y dx", "dw = z dx", "dv = dw"), [0, 1], True),
        ("x y z w v", ("dz = y dx", "dw = z dx", "dv = dw"), [1, 2], False),
    ],
)
def test_brackets_of_some_forms(names: str, forms: Sequence[str], numbers: list[int], reach: bool) -> None:
    """Two edges leave a line; z - w integrates; Engel's pair reaches all of its four coordinates; v - w integrates."""
    shared = of_block(names, *forms)
    assert shared is not None
    assert shared.reach_everything(numbers) is reach


def test_where_a_point_does_not_tell() -> None:
    """A finite relation, or functions that may be related in an unseen way."""
    assert of_block("x y z", "x^2 + y^2 = 1", "dz = y dx") is None
    assert of_block("x y z", "dz = asin(y) dx + asin(x) dy") is None
