"""Wrong claims, put into sound reports and made by broken engines: the checker accepts no evidence for them."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import dofkit
from dofkit.methods.certificates.certificate import Certifying
from dofkit.methods.certificates.lowering import document_of_scene

ROOT = Path(__file__).parents[3]
SKATE = {"coordinates": ["x", "y", "theta"], "constraints": ["sin(theta) dx - cos(theta) dy = 0"]}
HYPERBOLA = {"coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]}
PENDULUM = {"coordinates": ["x", "y"], "configuration": {"x": 1, "y": 0}, "constraints": ["x^2 + y^2 = 1"]}
TWICE = {"coordinates": ["x", "y", "z"], "constraints": ["x = y", "y = z", "x = z"]}
CROSS = {"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1", "2 x y = 1"]}


def _script() -> ModuleType:
    """The script of bugs, which is no module of a package."""
    spec = importlib.util.spec_from_file_location("broken_engines", ROOT / "tests" / "broken_engines.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["broken_engines"] = module
    spec.loader.exec_module(module)
    return module


BROKEN = _script()


def certified(scene: Any, entry: dict[str, Any] | None = None, **changes: Any) -> tuple[dict[str, Any], dict[str, str]]:
    """The certificate of a report, some of whose fields (or of its last entry's) were changed, and what it refutes."""
    loaded = dofkit.load(scene)
    report = dofkit.classify(loaded).model_copy(update=changes)
    last = report.constraints[-1].model_copy(update=entry or {})
    report = report.model_copy(update={"constraints": [*report.constraints[:-1], last]})
    making = Certifying(document_of_scene(loaded), report)
    return making.written(), making.contradictions


def unconfirmed(scene: Any, entry: dict[str, Any] | None = None, **changes: Any) -> set[str]:
    """The claims of a changed report for which there is no evidence, or evidence of another value."""
    certificate, contradictions = certified(scene, entry, **changes)
    assert {claim["path"] for claim in certificate["claims"]}.isdisjoint(certificate["uncovered"])
    return {*certificate["uncovered"], *contradictions}


#: A form times a function of time is told of without it, a factor that is a sum of squares by its terms.
SCALED = {"coordinates": ["x", "y", "z"], "constraints": ["exp(t) (dz - y dx) = 0"]}
POINT = {
    "coordinates": ["u", "v", "w"],
    "configuration": {"u": "5", "v": "0", "w": "0"},
    "constraints": ["(w^2 + (u - 5)^2) (u - 10) = 0"],
}


@pytest.mark.parametrize("scene", [SKATE, HYPERBOLA, PENDULUM, TWICE, CROSS, SCALED, POINT])
def test_nothing_is_contradicted_that_is_so(scene: Any) -> None:
    assert certified(scene)[1] == {}


@pytest.mark.parametrize(
    ("scene", "changes", "path"),
    [
        # The skate's brackets reach all three directions; x dy + y dx = d(xy) leaves one.
        (SKATE, {"dof": 2}, "/dof"),
        (HYPERBOLA, {"dof": 2}, "/dof"),
        (HYPERBOLA, {"generalized_coordinates": ["x", "y"]}, "/generalized_coordinates"),
        (SKATE, {"growth_vector": [2]}, "/growth_vector"),
        (SKATE, {"velocity_dof": 3}, "/velocity_dof"),
        (SKATE, {"consistent": False}, "/consistent"),
        (PENDULUM, {"instantaneous_dof": 2}, "/instantaneous_dof"),
        (PENDULUM, {"singular": True}, "/singular"),
        (TWICE, {"redundant": []}, "/redundant"),
        (PENDULUM, {"redundant": ["c1"]}, "/redundant"),
    ],
)
def test_wrong_numbers_are_not_confirmed(scene: Any, changes: dict[str, Any], path: str) -> None:
    assert path in unconfirmed(scene, **changes)


@pytest.mark.parametrize(
    ("scene", "changes", "path"),
    [
        (SKATE, {"holonomic": True}, "holonomic"),
        (SKATE, {"holonomic_alone": True}, "holonomic_alone"),
        (HYPERBOLA, {"holonomic": False}, "holonomic"),
        (HYPERBOLA, {"exact": False}, "exact"),
        (HYPERBOLA, {"integral": "x - y = C"}, "integral"),
        (HYPERBOLA, {"scleronomic": False}, "scleronomic"),
        # Of x = y, y = z, x = z the last needs both; it adds nothing.
        (TWICE, {"circuit": ["c1"]}, "circuit"),
        (TWICE, {"independent": 1}, "independent"),
    ],
)
def test_wrong_labels_are_not_confirmed(scene: Any, changes: dict[str, Any], path: str) -> None:
    name = dofkit.classify(scene).constraints[-1].name
    assert f"/constraints/{name}/{path}" in unconfirmed(scene, changes)


def test_another_part_of_the_set_contradicts_nothing() -> None:
    # The circle is told of: the point that lies beside it, at the origin, has no freedom.
    scene = {"coordinates": ["x", "y"], "constraints": ["(x^2 + y^2 - 1) (x^2 + y^2) = 0"]}
    assert certified(scene)[1] == {}


@pytest.mark.sweep
@pytest.mark.parametrize("name", sorted(BROKEN.BUGS))
def test_a_broken_engine_is_caught(name: str, tmp_path: Path) -> None:
    bug = BROKEN.BUGS[name]
    scene = str(ROOT / bug.scene)
    sound = BROKEN.answers(ROOT, [scene])[scene]
    found = BROKEN.answers(BROKEN.broken(bug, tmp_path), [scene])[scene]
    assert (sound.caught, sound.error, found.error) == ([], "", "")
    wrong = set(BROKEN.wrong(sound, found))
    assert wrong & set(sound.shown)
    assert wrong.isdisjoint(found.shown)
