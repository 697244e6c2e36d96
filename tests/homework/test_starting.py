"""A first assignment asks of each scene what is most worth asking."""

from __future__ import annotations

from pathlib import Path

import pytest

from dofkit.homework.answers.submission import FilePlace, of_text
from dofkit.homework.assignment import load_assignment
from dofkit.homework.key.key import Key
from dofkit.homework.starting import best_questions, starting, template
from dofkit.scene.catalog import catalog_names
from dofkit.scene.reading import load


def asked(name: str) -> list[str]:
    found = best_questions(Key(load(name)))
    return [f"{q['ask']} {q.get('constraint') or q.get('coordinate') or ''}".strip() for q in found]


@pytest.mark.parametrize(
    ("name", "worth"),
    [
        # two velocities beside four degrees of freedom, and forms that do not integrate
        ("disc-rolling-on-plane", {"dof", "velocity_dof", "label along_y", "integral along_y"}),
        # something follows from the rest
        ("five-particles-ten-links", {"dof", "redundant"}),
        # an equation that has to be found, a choice of coordinates
        ("simple-pendulum-link", {"dof", "coordinates", "label rod", "equation rod"}),
        # energies
        ("trolley-pendulum-linearized", {"dof", "lagrangian", "motion"}),
        # time enters
        ("bead-on-rotating-rod", {"dof", "label rod"}),
        ("x-dy-plus-y-dx", {"dof", "label c1", "integral c1"}),
    ],
)
def test_what_is_most_worth_asking(name: str, worth: set[str]) -> None:
    found = asked(name)
    assert worth <= set(found)


def test_an_equation_that_the_scene_tells_is_not_asked_for() -> None:
    assert not [one for one in asked("x-dy-plus-y-dx") if one.startswith("equation")]


@pytest.mark.sweep
@pytest.mark.parametrize("name", catalog_names())
def test_a_question_of_each_kind_of_every_scene(name: str) -> None:
    found = asked(name)
    assert len({one.split()[0] for one in found}) == len(found)
    assert "dof" in found


def test_a_template_is_a_submission_with_every_question(tmp_path: Path) -> None:
    path = tmp_path / "sheet.yaml"
    path.write_text(starting(["x-dy-plus-y-dx"]))
    sheet = load_assignment(path)
    empty = of_text(template(sheet, "yaml"), "ada", FilePlace(), sheet.columns())
    assert (empty.student, empty.error, empty.answers) == ("ada", None, {"x-dy-plus-y-dx": {}})
    filled = template(sheet, "yaml").replace('"dof":', '"dof": 1')
    one = of_text(filled, "ada", FilePlace(), sheet.columns())
    assert one.answers == {"x-dy-plus-y-dx": {"dof": 1}}
    assert template(sheet, "csv").split(",")[:2] == ["student", "x-dy-plus-y-dx.dof"]
