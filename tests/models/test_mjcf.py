"""MJCF as scenes: what is kept, what is told, and the freedom against MuJoCo's own count."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.base.errors import SceneError
from dofkit.models.mjcf import compiled
from dofkit.models.model_document import ModelFile

GEOM = "<geom type='sphere' size='0.1' mass='1'/>"


def model(body: str, rest: str = "", name: str = "m") -> str:
    return f"<mujoco model='{name}'>\n<worldbody>\n{body}\n</worldbody>\n{rest}\n</mujoco>"


def load(text: str, **more: Any) -> dofkit.Scene:
    from dofkit.scene.reading import SceneFile

    return SceneFile.read(text, "m", None, more.get("limits", False)).scene()


ARM = model(
    f"""<body name='upper' pos='0 0 1'>
<joint name='shoulder' type='hinge' axis='0 1 0' range='-90 90' limited='true'/>{GEOM}
<body name='fore-arm' pos='1 0 0'><joint name='elbow' type='hinge' axis='0 1 0' pos='0 0 0'/>
<geom type='sphere' size='0.1' mass='2' pos='0.5 0 0'/>
<body name='tip' pos='1 0 0'/></body></body>
<body name='table' pos='3 0 0'>{GEOM}</body>"""
)


def test_names_places_and_masses_are_kept() -> None:
    scene = load(ARM)
    assert [(b.name, b.mass) for b in scene.bodies] == [("upper", 1), ("fore_arm", 2)]
    assert [c.name for c in scene.constraints] == ["shoulder", "elbow"]
    shoulder, elbow = (dict(c) for c in scene.constraints)
    assert (shoulder["type"], shoulder["between"], shoulder["at"]) == ("revolute", ("ground", "upper"), (0, 0, 1))
    assert (elbow["between"], elbow["at"], elbow["axis"]) == (("upper", "fore_arm"), (1, 0, 1), (0, 1, 0))
    assert scene.configuration["x_fore_arm"] == 1.5
    assert scene.title == "m"
    assert scene.tolerance is None


def test_what_is_left_out_is_reported_with_why() -> None:
    told = load(ARM).left_out
    assert any("tip" in one and "marker" in one for one in told)
    assert any("table" in one and "fixed to the world" in one for one in told)
    assert any("shoulder from -1.571 to 1.571" in one for one in told)
    report = dofkit.classify(load(ARM))
    assert "left out: the ranges of joints" in report.modelled
    assert (report.dof, report.holonomic, report.verdict) == (2, True, "proved")


def test_ranges_become_inequalities_where_they_are_asked_for() -> None:
    scene = load(ARM, limits=True)
    (bound,) = [c for c in scene.constraints if c.name == "shoulder range"]
    assert bound.in_words.startswith("coupling -1.570796326795 <= p <= 1.570796326795")
    report = dofkit.classify(scene)
    assert (report.dof, report.holonomic, report.feasible) == (2, False, True)


def test_several_joints_of_a_body_are_in_series() -> None:
    body = "<joint name='x' type='slide' axis='1 0 0'/><joint name='y' type='slide' axis='0 1 0'/>"
    scene = load(model(f"<body name='cart'>{body}<joint name='turn' type='hinge' axis='0 0 1'/>{GEOM}</body>"))
    assert [b.name for b in scene.bodies] == ["after_x", "after_y", "cart"]
    assert [c.kind() for c in scene.constraints] == ["prismatic", "prismatic", "revolute"]
    assert dofkit.classify(scene).dof == 3


def test_free_and_ball_joints() -> None:
    scene = load(
        model(
            f"<body name='a'><freejoint/>{GEOM}</body>"
            f"<body name='b' pos='1 0 0'><joint type='ball' name='ball'/>{GEOM}</body>"
        )
    )
    assert [c.kind() for c in scene.constraints] == ["spherical"]
    assert dofkit.classify(scene).dof == 9


TWO = f"""<body name='a'><joint name='p' type='hinge' axis='0 0 1' ref='0'/>{GEOM}</body>
<body name='b' pos='1 0 0'><joint name='q' type='slide' axis='0 0 1'/>{GEOM}</body>"""

COUPLED = {
    "<equality><joint name='k' joint1='p' joint2='q' polycoef='0 2 0 0 0'/></equality>": ("p = 2 q", 1),
    "<equality><joint name='k' joint1='p' joint2='q' polycoef='0 1 0.5 0 0'/></equality>": ("p = q + 0.5 q^2", 1),
    "<equality><joint name='k' joint1='p'/></equality>": ("p = 0", 1),
    "<tendon><fixed name='t'><joint joint='p' coef='1'/><joint joint='q' coef='-0.5'/></fixed></tendon>"
    "<equality><tendon name='k' tendon1='t'/></equality>": ("p - 0.5 q = 0", 1),
}

COUPLED |= {
    "<tendon><fixed name='t'><joint joint='p' coef='1'/></fixed><fixed name='u'><joint joint='q' coef='-1'/></fixed>"
    f"</tendon><equality><tendon name='k' tendon1='t' tendon2='u' polycoef='{factors}'/></equality>": (text, 1)
    for factors, text in {"0 2 0 0 0": "p = 2 (-q)", "0 0 3 0 0": "p = 3 (-q)^2", "0 1 0 0 0": "p = (-q)"}.items()
}


@pytest.mark.parametrize("rest", COUPLED)
def test_equalities_of_joints_and_tendons_are_couplings(rest: str) -> None:
    text, freedom = COUPLED[rest]
    scene = load(model(TWO, rest))
    (coupling,) = [c for c in scene.constraints if c.kind() == "coupling"]
    assert coupling.model_dump()["text"] == text
    assert coupling.name == "k"
    assert dofkit.classify(scene).dof == freedom


LOOP = model(
    f"""<body name='crank'><joint name='A' type='hinge' axis='0 0 1'/>
<geom type='capsule' size='0.1' fromto='0 0 0 1 0 0'/>
<body name='rod' pos='1 0 0'><joint name='B' type='hinge' axis='0 0 1'/>
<geom type='capsule' size='0.1' fromto='0 0 0 0 2 0'/></body></body>
<body name='rocker' pos='4 2 0'><joint name='D' type='hinge' axis='0 0 1'/>{GEOM}</body>""",
    "<equality><connect name='C' body1='rod' body2='rocker' anchor='0 2 0'/></equality>",
)


def test_a_connect_closes_a_loop_of_parallel_axes() -> None:
    """Three hinges and a ball: 18 coordinates less 15 less 3, of which one, out of the plane, says nothing new."""
    scene = load(LOOP)
    assert scene.tolerance is not None
    report = dofkit.classify(scene)
    told = compiled(ModelFile(LOOP, "m")).content
    assert told["left"] == report.instantaneous_dof == report.dof == 1
    assert report.redundant_equations == 1


def test_a_connect_that_is_open_where_it_is_written_is_closed() -> None:
    """Sites a tenth apart: the drawing moves to where they meet."""
    sites = LOOP.replace("<equality><connect name='C' body1='rod' body2='rocker' anchor='0 2 0'/></equality>", "")
    sites = sites.replace("fromto='0 0 0 0 2 0'/>", "fromto='0 0 0 0 2 0'/><site name='s' pos='0 2.1 0'/>")
    sites = sites.replace(f"axis='0 0 1'/>{GEOM}", f"axis='0 0 1'/>{GEOM}<site name='u' pos='-3 0 0'/>")
    sites = sites.replace("</mujoco>", "<equality><connect name='C' site1='s' site2='u'/></equality></mujoco>")
    scene = load(sites)
    assert any("does not satisfy the equalities" in told for told in scene.left_out)
    assert dofkit.classify(scene).instantaneous_dof == 1


FREE = f"<body name='a'><freejoint/>{GEOM}</body><body name='b' pos='1 0 0'><freejoint/>{GEOM}</body>"
#: What holds two free bodies, of 12 freedoms, and how many are left.
HELD = {
    "<equality><weld body1='a' body2='b'/></equality>": 6,
    "<equality><weld body1='a' body2='b' torquescale='0'/></equality>": 9,
    "<option><flag equality='disable'/></option><equality><weld body1='a' body2='b'/></equality>": 12,
    "<option><flag constraint='disable'/></option><equality><weld body1='a' body2='b'/></equality>": 12,
}


@pytest.mark.parametrize("rest", HELD)
def test_welds_hold_as_far_as_they_are_in_force(rest: str) -> None:
    """A weld whose torque counts nothing holds a point, and not the turn."""
    text = model(FREE, rest)
    assert dofkit.classify(load(text)).dof == HELD[rest] == compiled(ModelFile(text, "m")).content["left"]


def test_rows_that_are_empty_do_not_stop_the_count() -> None:
    """Two bodies that slide as one, held together: three rows that MuJoCo leaves out, and keeps room for."""
    body = f"<body name='a'><joint type='slide'/>{GEOM}<body name='b'>{GEOM}</body></body>"
    text = model(body, "<equality><connect body1='a' body2='b' anchor='1 0 0'/></equality>")
    assert compiled(ModelFile(text, "m")).content["left"] == dofkit.classify(load(text)).dof == 1


def test_a_tendon_from_site_to_site_is_a_string() -> None:
    body = f"<body name='a' pos='0 0 1'><freejoint/>{GEOM}<site name='s'/></body><site name='o' pos='0 0 0'/>"
    spatial = "<tendon><spatial name='t'><site site='o'/><site site='s'/></spatial></tendon>"
    scene = load(model(body, f"{spatial}<equality><tendon name='k' tendon1='t'/></equality>"))
    assert [c.kind() for c in scene.constraints] == ["string"]
    assert dofkit.classify(scene).dof == 5
    assert load(model(body, spatial)).constraints == ()


def test_an_equality_that_is_not_read_is_a_warning() -> None:
    body = f"""<body name='a' pos='0 0 1'><freejoint/>{GEOM}<site name='s'/></body><site name='o' pos='0 0 0'/>
<site name='side' pos='0 1 0.5'/><geom name='g' type='sphere' size='0.1' pos='0 0 0.5'/>"""
    spatial = "<spatial name='t'><site site='o'/><geom geom='g' sidesite='side'/><site site='s'/></spatial>"
    scene = load(model(body, f"<tendon>{spatial}</tendon><equality><tendon name='k' tendon1='t'/></equality>"))
    report = dofkit.classify(scene)
    assert any("the true freedom may be smaller: constraint k" in told for told in report.warnings)
    assert any("the tendons t, which wrap around shapes" in told for told in scene.left_out)


def test_what_is_no_number_is_reported_in_its_line() -> None:
    with pytest.raises(SceneError) as raised:
        load(model(f"<body name='a'\n pos='0 nan 0'>\n<joint axis='0 0 -INF'/>{GEOM}</body>"))
    told = [(fault.line, fault.message) for fault in raised.value.faults]
    assert told == [(3, "`pos` of <body> holds 'nan'"), (5, "`axis` of <joint> holds '-INF'")]


def test_missing_files_never_stop_a_model(tmp_path: Path) -> None:
    text = model(
        "<body name='a'><joint name='j'/><geom type='mesh' mesh='cup'/></body>",
        "<asset><mesh name='cup' file='package://cups/cup.stl'/><texture name='t' type='2d' file='no.png'/></asset>",
    )
    place = tmp_path / "cup.xml"
    place.write_text(text)
    scene = dofkit.load(place)
    assert dofkit.classify(scene).dof == 1
    assert any("cup.stl" in told and "missing" in told for told in scene.left_out)


def test_included_files_are_read_from_beside(tmp_path: Path) -> None:
    (tmp_path / "part.xml").write_text(f"<mujocoinclude><body name='a'><joint name='j'/>{GEOM}</body></mujocoinclude>")
    place = tmp_path / "whole.xml"
    place.write_text(model("<include file='part.xml'/>"))
    assert dofkit.classify(place).dof == 1
    (tmp_path / "part.xml").write_text("<!DOCTYPE a [<!ENTITY b 'c'>]><mujocoinclude>&b;</mujocoinclude>")
    with pytest.raises(SceneError, match=r"line 3.*'part.xml' cannot be included: entities"):
        dofkit.load(place)


def test_faults_of_the_compiler_name_their_line() -> None:
    with pytest.raises(SceneError) as raised:
        load(model("<body name='a'>\n<joint type='hinge' axis='0 0 1' colour='red'/></body>"))
    (fault,) = raised.value.faults
    assert fault.line == 4
    assert "colour" in fault.message


def test_a_fault_of_the_scene_is_reported_in_the_line_of_the_model() -> None:
    """Two couplings of one joint contradict each other: the drawing satisfies one of them only."""
    clash = "<equality>\n<joint name='one' joint1='p' polycoef='0.5'/>\n<joint name='two' joint1='p'/></equality>"
    with pytest.raises(SceneError, match="satisfied neither in the given pose"):
        load(model(TWO, clash))


def test_lagrange_works_on_a_pendulum() -> None:
    pendulum = model("<body name='bob'><joint name='j' axis='0 1 0' pos='0 0 1'/><geom size='0.1' mass='2'/></body>")
    report = dofkit.lagrange(load(pendulum))
    assert report.lagrangian
    assert report.equations


def test_what_only_moves_it_is_reported() -> None:
    """A spring, friction and a rotor: without a word of them energy would be conserved."""
    joint = "<joint name='j' type='slide' axis='0 0 1' stiffness='3' damping='1' armature='2'/>"
    told = " ".join(load(model(f"<body name='bob' gravcomp='1'>{joint}{GEOM}</body>")).left_out)
    assert all(one in told for one in ("springs of joints", "damping and friction", "armature", "compensation"))
    still = load(model(f"<body>{joint}{GEOM}</body>", "<option><flag gravity='disable'/></option>"))
    assert still.forces == ()
