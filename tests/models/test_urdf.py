"""URDF as scenes: the tree, what mimics what, loops of extensions, and every fault in its line."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

import dofkit
from dofkit.base.errors import SceneError

MASS = (
    "<inertial><origin xyz='0 0 0.5'/><mass value='2'/>"
    "<inertia ixx='1' iyy='2' izz='3' ixy='0' ixz='0' iyz='0'/></inertial>"
)


def link(name: str, inertial: str = MASS) -> str:
    return f"<link name='{name}'>{inertial}</link>"


def joint(name: str, kind: str, parent: str, child: str, more: str = "") -> str:
    return f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{more}</joint>"


def robot(*parts: str) -> str:
    return "\n".join(["<robot name='r'>", *parts, "</robot>"])


def load(text: str, limits: bool = False) -> dofkit.Scene:
    from dofkit.scene.reading import SceneFile

    return SceneFile.read(text, "r", None, limits).scene()


TREE = robot(
    link("base"),
    link("upper"),
    link("lower"),
    link("tool", ""),
    joint("hip", "revolute", "base", "upper", "<origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/><axis xyz='1 0 0'/>"
          "<limit lower='-1' upper='2'/>"),
    joint("knee", "prismatic", "upper", "lower", "<origin xyz='1 0 0'/><axis xyz='0 1 0'/>"),
    joint("mount", "fixed", "lower", "tool", "<origin xyz='0 0 1'/><axis xyz='0 0 0'/>"),
)  # fmt: skip


def test_the_tree_stands_where_it_is_drawn() -> None:
    """The hip's frame is turned by a right angle about z: x is y there, and 1 along x is 1 along y."""
    scene = load(TREE)
    assert [b.name for b in scene.bodies] == ["base", "upper", "lower"]
    weld, hip, knee = (dict(c) for c in scene.constraints)
    assert (weld["type"], weld["between"]) == ("weld", ("ground", "base"))
    assert (hip["at"], hip["axis"]) == ((0, 0, 1), (0, 1, 0))
    assert (knee["at"], knee["axis"]) == ((0, 1, 1), (-1, 0, 0))
    assert [scene.configuration[f"{c}_lower"] for c in "xyz"] == [0, 1, 1.5]
    assert scene.bodies[1].inertia == (2, 3, 1)
    assert any("tool" in told for told in scene.left_out)
    report = dofkit.classify(scene)
    assert (report.dof, report.verdict) == (2, "proved")


def test_ranges_are_told_or_asked_for() -> None:
    assert any("hip from -1 to 2" in told for told in load(TREE).left_out)
    (bound,) = [c for c in load(TREE, limits=True).constraints if c.kind() == "coupling"]
    assert bound.model_dump()["text"] == "-1 <= p <= 2"


MIMIC = robot(
    link("base"), link("a"), link("b"), link("c"),
    joint("u", "revolute", "base", "a", "<axis xyz='0 0 1'/>"),
    joint("v", "revolute", "a", "b", "<axis xyz='0 0 1'/><mimic joint='u' multiplier='-2' offset='0.5'/>"),
    joint("w", "continuous", "b", "c", "<origin xyz='1 0 0'/><axis xyz='0 0 1'/><mimic joint='v'/>"),
)  # fmt: skip


def test_what_mimics_stands_at_its_offset() -> None:
    """v stands at 1/2 and w, which mimics v, too: c's frame is 1 along x as turned by 1/2."""
    scene = load(MIMIC)
    by_name = {c.name: dict(c) for c in scene.constraints}
    assert by_name["v mimics u"]["text"] == "p = -2 q"
    assert by_name["w mimics v"]["joints"] == {"p": "w", "q": "v"}
    assert [float(v) for v in by_name["w"]["at"]] == pytest.approx([math.cos(0.5), math.sin(0.5), 0])
    assert dofkit.classify(scene).dof == 1


def test_floating_planar_and_ball_joints() -> None:
    scene = load(
        robot(
            link("world", ""), link("a"), link("b"), link("c"),
            joint("one", "floating", "world", "a"),
            joint("two", "planar", "a", "b", "<axis xyz='0 0 1'/>"),
            joint("three", "ball", "b", "c"),
        )
    )  # fmt: skip
    assert [c.kind() for c in scene.constraints] == ["planar", "spherical"]
    assert dofkit.classify(scene).dof == 12


BAR = "<origin xyz='{} {} 0'/><axis xyz='0 0 1'/>"
OPEN_LOOP = (
    link("base"), link("crank"), link("rod"), link("rocker"),
    joint("A", "continuous", "base", "crank", BAR.format(0, 0)),
    joint("B", "continuous", "crank", "rod", BAR.format(1, 0)),
    joint("D", "continuous", "base", "rocker", BAR.format(4, 2)),
)  # fmt: skip
LOOPS = {
    "hinge": "<loop_joint name='C' type='continuous'><link1 link='rod' xyz='0 2 0'/><link2 link='rocker' xyz='-3 0 0'/>"
    "<axis xyz='0 0 1'/></loop_joint>",
    "ball": "<loop_joint name='C' type='ball'><link1 link='rod' xyz='0 2 0'/><link2 link='rocker' xyz='-3 0 0'/>"
    "</loop_joint>",
    "drake": "<drake:ball_constraint xmlns:drake='d'><drake:ball_constraint_body_A name='rod'/>"
    "<drake:ball_constraint_p_AP value='0 2 0'/><drake:ball_constraint_body_B name='rocker'/>"
    "<drake:ball_constraint_p_BQ value='-3 0 0'/></drake:ball_constraint>",
}


@pytest.mark.parametrize("name", LOOPS)
def test_loops_of_extensions_are_closed(name: str) -> None:
    scene = load(robot(*OPEN_LOOP, LOOPS[name]))
    assert scene.tolerance is not None
    report = dofkit.classify(scene)
    assert report.dof == 1
    assert report.redundant_equations == (3 if name == "hinge" else 1)


def test_a_link_of_two_parents_closes_a_loop() -> None:
    twice = robot(
        link("base"), link("a"), joint("one", "revolute", "base", "a", "<axis xyz='0 0 1'/>"),
        joint("two", "revolute", "base", "a", "<axis xyz='0 0 1'/>"),
    )  # fmt: skip
    report = dofkit.classify(load(twice))
    assert (report.dof, report.redundant) == (1, ["two"])


@pytest.mark.sweep
def test_a_joint_that_closes_a_loop_may_stand_elsewhere_than_at_0() -> None:
    """The rocker stands at (4, 2) turned by a right angle against the rod, and its arm reaches back to (1, 2)."""
    turned = (*OPEN_LOOP[:6], joint("D", "continuous", "base", "rocker", "<origin xyz='4 2 0' rpy='0 0 0.5'/>" + Z))
    arm = (-3 * math.cos(0.5), 3 * math.sin(0.5))
    loop = f"<link1 link='rod' xyz='0 2 0'/><link2 link='rocker' xyz='{arm[0]:.12f} {arm[1]:.12f} 0'/>{Z}"
    assert dofkit.classify(load(robot(*turned, f"<loop_joint name='C' type='continuous'>{loop}</loop_joint>"))).dof == 1


def test_a_loop_of_rounded_angles_is_closed_to_their_last_digit() -> None:
    """Links of length 10 at right angles that are written as 1.5708: the ends are some 4e-5 apart."""
    corner = "<origin xyz='{} 0 0' rpy='0 0 {}'/>" + Z
    square = (
        link("base"), link("a"), link("b"), link("c"),
        joint("A", "continuous", "base", "a", corner.format(0, 0)),
        joint("B", "continuous", "a", "b", corner.format(10, 1.5708)),
        joint("C", "continuous", "b", "c", corner.format(10, 1.5708)),
        f"<loop_joint name='D' type='continuous'><link1 link='c' xyz='10 0 0'/><link2 link='base' xyz='0 10 0'/>{Z}"
        "</loop_joint>",
    )  # fmt: skip
    assert dofkit.classify(load(robot(*square))).dof == 1


Z = "<axis xyz='0 0 1'/>"
#: The rod's end stands at (1, 2, 0); a crank of length 1 and a rocker pivoted at (3, 0, 0).
RODS = (
    link("base"), link("a"), link("b"), link("c"),
    joint("A", "revolute", "base", "a", Z),
    joint("B", "revolute", "a", "b", "<origin xyz='0 1 0'/>" + Z),
)  # fmt: skip
OPEN = "is open where every joint is at 0"
OPEN_ROBOTS: dict[str, tuple[str, tuple[str, ...]]] = {
    "place": (f"the loop that 'D' closes {OPEN}", (
        *RODS, joint("C", "revolute", "base", "c", "<origin xyz='2 0 0'/>" + Z),
        joint("D", "revolute", "b", "c", "<origin xyz='3 0 0'/>" + Z))),
    "axis": (f"the loop that 'D' closes {OPEN}", (
        *RODS, joint("C", "revolute", "base", "c", "<origin xyz='3 1 0' rpy='0.5 0 0'/>" + Z),
        joint("D", "revolute", "b", "c", "<origin xyz='3 0 0'/>" + Z))),
    "slider": (f"the loop that 'D' closes {OPEN}", (
        *RODS, joint("C", "revolute", "base", "c", "<origin xyz='3 1 0' rpy='0 0 0.5'/>" + Z),
        joint("D", "prismatic", "b", "c", "<origin xyz='3 0 0'/>" + Z))),
    "extension": (f"the loop that 'D' closes {OPEN}", (
        *RODS, joint("C", "revolute", "base", "c", "<origin xyz='2 0 0'/>" + Z),
        f"<loop_joint name='D' type='revolute'><link1 link='b' xyz='2 0 0'/><link2 link='c' xyz='0 7 0'/>{Z}"
        "</loop_joint>")),
    "mimic": ("'D' mimics 'A', and one of them closes a loop", (
        *RODS, joint("C", "revolute", "base", "c", "<origin xyz='3 1 0' rpy='0 0 0.5'/>" + Z),
        joint("D", "revolute", "b", "c", "<origin xyz='3 0 0'/><mimic joint='A'/>" + Z))),
    "adrift": ("the link 'd' is not connected to a root link", (
        *RODS[:3], link("d"), link("e"), joint("A", "revolute", "base", "a", Z),
        joint("B", "fixed", "base", "b"), joint("D", "ball", "e", "d"), joint("E", "ball", "d", "e"))),
}  # fmt: skip


@pytest.mark.parametrize("name", OPEN_ROBOTS)
def test_what_stands_nowhere_or_does_not_meet_is_a_fault(name: str) -> None:
    """A loop that is drawn open is another mechanism than the one it would be where it is closed."""
    message, parts = OPEN_ROBOTS[name]
    with pytest.raises(SceneError) as raised:
        load(robot(*parts))
    assert any(message in str(fault) for fault in raised.value.faults)


def test_the_range_of_a_joint_that_closes_a_loop_is_left_out() -> None:
    closed = (
        *RODS, joint("C", "revolute", "base", "c", "<origin xyz='3 1 0' rpy='0 0 0.5'/>" + Z),
        joint("D", "revolute", "b", "c", "<origin xyz='3 0 0'/><limit lower='-1' upper='1'/>" + Z),
    )  # fmt: skip
    scene = load(robot(*closed), limits=True)
    assert "the range of D: it closes a loop" in scene.left_out


def test_a_fixed_joint_that_closes_a_loop_may_mimic() -> None:
    weld = joint("D", "fixed", "b", "c", "<origin xyz='3 0 0'/><mimic joint='A'/>")
    scene = load(robot(*RODS, joint("C", "revolute", "base", "c", "<origin xyz='3 1 0'/>" + Z), weld))
    assert [c.kind() for c in scene.constraints] == ["weld", *["revolute"] * 3, "weld"]


@pytest.mark.parametrize(("limits", "text"), [("3.5 5", "-2.78318530718 <= p <= -1.28318530718"), ("3 4", "")])
def test_ranges_beyond_half_a_turn_are_counted_less_whole_turns(limits: str, text: str) -> None:
    low, high = limits.split()
    scene = load(
        robot(
            link("base"), link("a"), joint("j", "revolute", "base", "a", f"<limit lower='{low}' upper='{high}'/>{Z}")
        ),
        limits=True,
    )
    ranged = [c.model_dump()["text"] for c in scene.constraints if c.kind() == "coupling"]
    assert ranged == ([text] if text else [])
    assert any("beyond half a turn" in told for told in scene.left_out) is not bool(text)


FAULTS: dict[str, tuple[str, ...]] = {
    "line 3, column 1: there is no joint type 'revolut' (did you mean 'revolute'?)": (
        link("a") + link("b"), joint("j", "revolut", "a", "b")),
    "line 3, column 1: 'j' needs a child that is a link, not 'bb' (did you mean 'b'?)": (
        link("a") + link("b"), joint("j", "fixed", "a", "bb")),
    "line 2, column 1: `xyz` needs 3 numbers, not '1 2'": (
        link("a") + link("b") + joint("j", "fixed", "a", "b", "<origin xyz='1 2'/>"),),
    "line 2, column 1: the axis of 'j' is zero": (
        link("a") + link("b") + joint("j", "revolute", "a", "b", "<axis xyz='0 0 0'/>"),),
    "line 2, column 1: the mass of 'a' is negative": (link("a", "<inertial><mass value='-1'/></inertial>"),),
    "line 3, column 1: 'j' mimics 'k', which it cannot": (
        link("a") + link("b"), joint("j", "revolute", "a", "b", "<mimic joint='k'/>")),
    "no link is the root": (
        link("a") + link("b"), joint("j", "fixed", "a", "b"), joint("k", "fixed", "b", "a")),
    "the joint 'j' is defined twice": (
        link("a") + link("b"), joint("j", "fixed", "a", "b"), joint("j", "fixed", "a", "b")),
    "this robot has no link": ("<group name='arm'/>",),
    "line 2, column 1: this file has xacro macros": ("<xacro:macro xmlns:xacro='x' name='m'/>",),
    "mimics itself through other joints": (
        link("a") + link("b") + link("c"),
        joint("j", "revolute", "a", "b", "<mimic joint='k'/>"), joint("k", "revolute", "b", "c", "<mimic joint='j'/>")),
}  # fmt: skip


@pytest.mark.parametrize("message", FAULTS)
def test_faults(message: str) -> None:
    with pytest.raises(SceneError) as raised:
        load(robot(*FAULTS[message]))
    told = [str(fault) for fault in raised.value.faults]
    assert any(message in one for one in told), told


def test_meshes_are_not_looked_for(tmp_path: Path) -> None:
    shape = "<visual><geometry><mesh filename='package://nowhere/a.stl'/></geometry></visual>"
    place = tmp_path / "r.urdf"
    place.write_text(robot(link("a"), f"<link name='b'>{MASS}{shape}</link>", joint("j", "continuous", "a", "b")))
    assert dofkit.classify(place).dof == 1


def test_a_stranger_element_is_reported() -> None:
    scene: Any = load(robot(link("a"), "<magic/>", "<gazebo/>"))
    assert any("<magic>" in told for told in scene.left_out)
    assert any("Gazebo" in told for told in scene.left_out)


def test_friction_is_reported() -> None:
    rubs = [
        joint("j", "continuous", "a", "b", f"<dynamics damping='{value}' friction='0.0'/>") for value in ("0.0", "2")
    ]
    told = [" ".join(load(robot(link("a"), link("b"), one)).left_out) for one in rubs]
    assert ["damping and friction" in one for one in told] == [False, True]
