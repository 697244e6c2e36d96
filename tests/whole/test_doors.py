"""What stands at the front of the package: its names, and what its functions take from whoever calls them."""

from __future__ import annotations

import copy
import doctest
import pickle
import pydoc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.base.errors import ArgumentError
from dofkit.methods.table import METHODS, QUESTIONS
from dofkit.scene.lowering import lower, survey_of

MAPPING: dict[str, Any] = {"name": "m", "coordinates": ["x", "y"], "constraints": ["x dy + y dx = 0"]}
PENDULUM = {
    "name": "m",
    "coordinates": ["theta"],
    "energies": {"kinetic": "thetadot^2/2", "potential": "-cos(theta)"},
}

#: The package for calls that its types forbid.
ANY: Any = dofkit

DOORS: dict[str, Callable[[Any], object]] = {
    "classify": dofkit.classify,
    "derived_flag": dofkit.derived_flag,
    "ask": lambda given: dofkit.ask(given, "dof"),
    "lagrange": dofkit.lagrange,
    "configurations": lambda given: dofkit.configurations(given, steps=1),
}
SYSTEMS = ("classify", "derived_flag", "ask", "configurations")
NO_SCENES: tuple[Any, ...] = (None, 3, ["x"], ("a", "b"), {1}, object, b"coordinates: [x]", 1.5, True)


def test_dir_and_help_show_the_public_names() -> None:
    assert set(dofkit.__all__) < set(dir(dofkit))
    assert all(hasattr(dofkit, name) for name in dir(dofkit))
    assert dofkit.__doc__ is not None
    assert all(f"`{name}`" in dofkit.__doc__ for name in dir(dofkit))
    helped = pydoc.plain(pydoc.render_doc(dofkit))
    functions = helped[helped.index("\nFUNCTIONS") :]
    shown = [line.strip().split("(")[0] for line in functions.splitlines() if line[:4] == "    " and line[4:5].strip()]
    assert {name for name in shown if name.isidentifier()} == set(dofkit.__all__)
    assert len(helped.splitlines()) < 300
    assert "import_module" not in helped
    assert "_HOMES" not in helped


@pytest.mark.parametrize("name", [name for name in dir(dofkit) if name != "__version__"])
def test_every_public_name_has_an_example_that_runs(name: str) -> None:
    public = getattr(dofkit, name)
    assert public.__doc__ is not None
    assert ">>>" in public.__doc__
    (test,) = (t for t in doctest.DocTestFinder(recurse=False).find(public, name, globs={name: public}) if t.examples)
    assert doctest.DocTestRunner().run(test).failed == 0


@pytest.mark.parametrize("name", DOORS)
def test_a_door_takes_what_stands_for_a_scene(name: str, tmp_path: Path) -> None:
    made = PENDULUM if name == "lagrange" else MAPPING
    file = tmp_path / "m.yaml"
    file.write_text(str(made))
    scene = dofkit.load(made)
    expected = DOORS[name](scene)
    for given in (made, str(file), file, *([lower(scene)] if name in SYSTEMS else [])):
        assert DOORS[name](given) == expected
    with pytest.raises(dofkit.SceneError, match="did you mean"):
        DOORS[name]("four-bar-linkages")


@pytest.mark.parametrize("given", NO_SCENES, ids=repr)
@pytest.mark.parametrize("name", [*DOORS, "load"])
def test_a_door_says_what_it_takes(name: str, given: Any) -> None:
    if name == "classify" and isinstance(given, list | tuple):
        given = [given]
    with pytest.raises(ArgumentError, match="a Scene, a path, a catalog name or a mapping, not "):
        {**DOORS, "load": dofkit.load}[name](given)


def test_a_list_of_scenes_gives_a_list_of_reports_and_all_faults_at_once() -> None:
    names = ["four-bar-linkage", dofkit.load("disc-rolling-on-plane"), MAPPING]
    assert dofkit.classify(names) == [dofkit.classify(name) for name in names]
    assert dofkit.classify(()) == []
    with pytest.raises(dofkit.SceneError) as caught:
        dofkit.classify([{**MAPPING, "constraints": ["dz = 0", "w = 1"]}, MAPPING, "no-such-scene"])
    assert [fault.where[0] for fault in caught.value.faults] == [0, 0, 2]
    assert str(caught.value).splitlines()[0].startswith("[0].constraints[0]: `dz` is not declared")


def test_a_catalog_name_is_a_scene() -> None:
    assert dofkit.classify("four-bar-linkage").dof == dofkit.ask("four-bar-linkage", "dof").value == 1


def test_other_functions_say_what_they_take() -> None:
    with pytest.raises(ArgumentError, match=r"dofkit\.load takes the rest"):
        ANY.loads(3)
    with pytest.raises(ArgumentError, match="an assignment is given as"):
        ANY.load_assignment(["x"])
    with pytest.raises(ArgumentError, match="not of a System"):
        dofkit.ask(lower(dofkit.load(MAPPING)), "equivalence", {"constraint": "c1", "text": "x = 1"})


def test_a_wrong_method_or_question_is_reported_with_the_right_ones() -> None:
    with pytest.raises(dofkit.DofkitError, match="no method 'exakt'") as caught:
        ANY.classify(MAPPING, method="exakt")
    assert "did you mean 'exact'?" in str(caught.value)
    assert all(name in str(caught.value) for name in METHODS)
    with pytest.raises(dofkit.DofkitError, match="no question 'velocity_dof'") as caught:
        ANY.ask(MAPPING, "velocity_dof")
    assert all(name in str(caught.value) for name in QUESTIONS)
    with pytest.raises(dofkit.DofkitError, match="a method is one of"):
        ANY.classify(MAPPING, method=None)
    with pytest.raises(dofkit.DofkitError, match="did you mean 'x'"):
        dofkit.configurations(MAPPING, along="X")


@pytest.mark.parametrize(
    "answer", [None, {}, {"text": "x = 1"}, {"constraint": "c1"}, {"constraint": 1, "text": "x = 1"}, "x = 1", ["c1"]]
)
def test_equivalence_needs_an_answer(answer: Any) -> None:
    with pytest.raises(ArgumentError, match=r"'constraint': NAME, 'text': TEXT"):
        dofkit.ask(MAPPING, "equivalence", answer)


def test_an_answer_names_a_constraint_that_there_is() -> None:
    named = {**MAPPING, "constraints": [{"type": "equation", "name": "skate", "text": "x dy + y dx = 0"}]}
    with pytest.raises(ArgumentError, match=r"no constraint 'skates' \(did you mean 'skate'\?\)"):
        dofkit.ask(named, "equivalence", {"constraint": "skates", "text": "x = 1"})


@pytest.mark.parametrize("budget", ["5", [], True, float("nan"), object])
@pytest.mark.parametrize("door", [dofkit.classify, dofkit.derived_flag, dofkit.lagrange, None])
def test_a_budget_is_seconds(door: Any, budget: Any) -> None:
    with pytest.raises(ArgumentError, match="the budget is a number of seconds"):
        dofkit.ask(MAPPING, "dof", budget=budget) if door is None else door(MAPPING, budget=budget)


def test_what_is_known_of_a_scene_is_no_part_of_it() -> None:
    scene, other = dofkit.load(MAPPING), dofkit.Scene.model_validate(MAPPING)
    known = survey_of(scene)
    assert survey_of(scene) is known
    assert scene == other
    assert pickle.dumps(scene) == pickle.dumps(other)
    for copied in (pickle.loads(pickle.dumps(scene)), copy.copy(scene), copy.deepcopy(scene), scene.model_copy()):
        assert copied == scene
        assert survey_of(copied) is not known
        assert survey_of(scene) is known


def test_a_changed_copy_is_read_again() -> None:
    scene = dofkit.load({**MAPPING, "parameters": {"a": 1}, "constraints": ["x = a"]})
    lower(scene)
    more = scene.model_copy(update={"constraints": (*scene.constraints, *scene.constraints)})
    assert len(lower(more).constraints) == 2
    assert len(lower(scene.model_copy(update={"constraints": ()})).constraints) == 0
    assert len(lower(scene).constraints) == 1
    scene.parameters["a"] = dofkit.load({"parameters": {"a": 2}}).parameters["a"]
    assert lower(scene).constraints[0].relations[0].expr.args != lower(dofkit.load(
        {**MAPPING, "parameters": {"a": 1}, "constraints": ["x = a"]}
    )).constraints[0].relations[0].expr.args  # fmt: skip
