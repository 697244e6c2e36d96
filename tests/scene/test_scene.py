"""Scenes: what may be written, what is refused and where, and what becomes of names, numbers and the drawing."""

from __future__ import annotations

import json
import subprocess
import sys
from decimal import Decimal
from fractions import Fraction
from functools import partial
from typing import Any

import pytest
from pydantic import ValidationError
from shared.work import counted

from dofkit.base.errors import Fault, SceneError
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import ZERO, coordinate, fn, num, parameter, sqrt
from dofkit.scene.fields import as_written, exact, faults_of
from dofkit.scene.lowering import check, lower
from dofkit.scene.scene import Scene
from dofkit.system import System


def faults(scene: Any) -> tuple[Fault, ...]:
    try:
        return check(Scene.model_validate(scene))
    except ValidationError as error:
        return faults_of(error)


def system(**scene: Any) -> System:
    return lower(Scene.model_validate(scene))


# Numbers


@pytest.mark.parametrize(
    ("written", "value"),
    [
        (0.5, Fraction(1, 2)),
        (0.1, Fraction(1, 10)),
        (3, Fraction(3)),
        (Decimal("0.30"), Fraction(3, 10)),
        (Fraction(2, 7), Fraction(2, 7)),
        ("0.25", Fraction(1, 4)),
        ("2/3", Fraction(2, 3)),
        ("1e-6", Fraction(1, 10**6)),
        (-1e300, Fraction(-(10**300))),
    ],
)
def test_numbers_become_exact(written: Any, value: Fraction) -> None:
    assert exact(written) == value
    scene = Scene.model_validate({"parameters": {"a": written}})
    assert scene.parameters["a"] == value
    assert exact(as_written(value)) == value


@pytest.mark.parametrize("written", [float("nan"), float("inf"), True, False, Decimal("NaN"), "1e9999", [1], 1j])
def test_what_is_no_number(written: Any) -> None:
    (fault,) = faults({"parameters": {"a": written}})
    assert fault.where == ("parameters", "a")


# Names


@pytest.mark.parametrize(
    ("dimension", "particle", "body"),
    [
        (1, ["x_A"], ["x_B"]),
        (2, ["x_A", "y_A"], ["x_B", "y_B", "theta_B"]),
        (3, ["x_A", "y_A", "z_A"], ["x_B", "y_B", "z_B", "phi_B", "theta_B", "psi_B"]),
    ],
)
def test_coordinates_are_named_by_their_owner(dimension: int, particle: list[str], body: list[str]) -> None:
    found = system(dimension=dimension, particles=["A"], bodies=["B"], coordinates=["s"])
    assert [q.name for q in found.coordinates] == [*particle, *body, "s"]
    assert [q.owner for q in found.coordinates] == ["A"] * len(particle) + ["B"] * len(body) + [None]


def test_hyphens_of_particles_and_bodies_are_underscores_in_their_coordinates() -> None:
    found = system(dimension=2, particles=["k-1_0"], bodies=["left-link"], constraints=["x_k_1_0 = theta_left_link"])
    assert found.particles == ("k-1_0",)
    assert found.bodies == ("left-link",)
    names = ["x_k_1_0", "y_k_1_0", "x_left_link", "y_left_link", "theta_left_link"]
    assert [q.name for q in found.coordinates] == names


def test_coordinates_may_be_renamed() -> None:
    scene = {"dimension": 2, "bodies": [{"name": "B", "coordinates": ["X", "Y", "a"]}], "constraints": ["X = cos(a)"]}
    found = system(**scene)
    assert [q.name for q in found.coordinates] == ["X", "Y", "a"]
    assert found.constraints[0].relations[0].expr == coordinate("X") - fn("cos", coordinate("a"))


def test_parameters() -> None:
    found = system(
        parameters={"l": "positive", "m": None, "n": "nonzero", "a": "sqrt(3)/2", "b": "2 a l", "c": 0.5},
        coordinates=["x"],
        constraints=["x = a", "x = b", "x = c", "x = m n"],
    )
    assert dict(found.parameters) == {"l": "positive", "m": "real", "n": "nonzero"}
    x = coordinate("x")
    expected = [sqrt(num(3)) / 2, sqrt(num(3)) * parameter("l"), num(Fraction(1, 2)), parameter("m") * parameter("n")]
    assert [c.relations[0].expr for c in found.constraints] == [x - e for e in expected]
    assert system(parameters=["a", "b"]).parameters == {"a": "real", "b": "real"}


def test_functions_know_their_arguments() -> None:
    found = system(functions={"h": ["s"], "f": "t"}, coordinates=["s", "z"], constraints=["z = h", "z = h(s - f)"])
    assert dict(found.functions) == {"h": 1, "f": 1}
    assert to_text(found.constraints[0].relations[0].expr) == "z - h(s)"


def test_shorthand_and_emptiness() -> None:
    empty = Scene.model_validate(dict.fromkeys(["particles", "bodies", "constraints", "parameters", "configuration"]))
    assert lower(empty).coordinates == ()
    scene = Scene.model_validate({"coordinates": ["x"], "constraints": ["x = 1"]})
    assert scene.constraints[0].model_dump() == {"name": None, "type": "equation", "text": "x = 1"}


def test_a_scene_survives_json() -> None:
    scene = Scene.model_validate(
        {
            "dimension": 2,
            "parameters": {"a": 0.1, "l": "positive"},
            "particles": ["A", {"name": "B", "at": [0.5, "sqrt(2)"], "mass": "m0", "coordinates": ["u", "v"]}],
            "bodies": ["c"],
            "constraints": [
                "x_A = 1",
                {"type": "link", "between": ["A", {"on": "c", "at": [1, 2]}], "length": "l"},
                {"type": "revolute", "between": ["c", "ground"], "at": [0.25, 3]},
            ],
            "tolerance": 1e-6,
        }
    )
    document = json.loads(json.dumps(scene.model_dump(mode="json")))
    assert Scene.model_validate(document) == scene


# The drawing


def test_reference_needs_a_drawing_of_everything_that_is_constrained() -> None:
    pin = {"type": "revolute", "between": ["ground", "a"], "at": [1, 2]}
    found = system(dimension=2, bodies=["a"], constraints=[pin])
    assert found.reference == dict.fromkeys(map(coordinate, ["x_a", "y_a", "theta_a"]), ZERO)
    assert found.pose == found.reference
    beside = system(dimension=2, bodies=["a", "b"], particles=["P"], constraints=[pin]).reference
    assert beside is not None
    assert {str(s.args[1]): value for s, value in beside.items()}["x_P"] == ZERO
    weld = {"type": "weld", "between": ["a", "b"]}
    assert system(dimension=2, bodies=["a", "b"], constraints=[pin, weld]).reference is not None
    bare = {"type": "revolute", "between": ["ground", "a"]}
    assert system(dimension=2, bodies=["a"], constraints=[bare]).reference is None
    low = "y_P = 1"
    assert system(dimension=2, bodies=["a"], particles=["P"], constraints=[pin, low]).reference is None
    assert system(dimension=2, bodies=["a", "b"], constraints=[pin, "dx_b = 0"]).reference is None
    placed = [{"name": "P", "at": ["sqrt(3)/2", 1]}]
    found = system(dimension=2, bodies=["a"], particles=placed, constraints=[pin])
    assert found.reference is not None
    assert found.reference[coordinate("x_P")] == sqrt(num(3)) / 2
    assert system(coordinates=["s"]).reference is None
    assert system(coordinates=["s"], configuration={"s": "pi/3"}).reference is not None


def test_spatial_bodies_keep_euler_angles_only_where_a_text_names_them() -> None:
    pose = {"phi_a": "pi/2"}
    pin = {"type": "revolute", "between": ["ground", "a"], "at": [0, 0, 1], "axis": [0, 0, 1]}
    found = system(bodies=["a", "b"], constraints=[pin], configuration=pose)
    assert [r.chart for r in found.rotations] == ["gibbs", "gibbs"]
    assert found.pose[coordinate("phi_a")] == ZERO
    found = system(bodies=["a", "b"], constraints=[pin, "psidot_a = 1"], configuration=pose)
    assert [r.chart for r in found.rotations] == ["euler", "gibbs"]
    assert to_text(found.pose[coordinate("phi_a")]) == "pi/2"
    found = system(bodies=["a"], constraints=["cos(θ_a) = 1"])
    assert found.rotations[0].chart == "euler"
    assert system(bodies=["a"], energies={"kinetic": "phidot_a^2"}).rotations[0].chart == "euler"


def test_size_is_the_largest_distance() -> None:
    points = [{"name": f"p{i}", "at": [i, 0]} for i in range(4)]
    assert system(dimension=2, particles=points).size == 3
    assert system(dimension=2).size == 1
    many = [{"name": f"p{i}", "at": [i % 40, i // 40]} for i in range(1600)]
    assert system(dimension=2, particles=many).size == pytest.approx(39 * 2**0.5)


def test_lengths_that_hold_parameters_make_no_reference() -> None:
    scene = {
        "dimension": 2,
        "parameters": {"l": "positive"},
        "particles": [{"name": "A", "at": [0, -1]}],
        "constraints": [{"type": "link", "between": [[0, 0], "A"], "length": "l"}],
    }
    assert system(**scene).reference is None
    assert system(**scene).warnings
    scene["particles"] = [{"name": "A", "at": ["l sin(pi/6)", "-l cos(pi/6)"]}]
    assert system(**scene).reference is not None


def test_measured_lengths_may_differ_within_the_tolerance() -> None:
    link = {"type": "link", "between": [[0, 0], "A"], "length": 2.236}
    scene = {"dimension": 2, "particles": [{"name": "A", "at": [1, 2]}], "constraints": [link]}
    (fault,) = faults(scene)
    assert fault.where == ("constraints", 0, "length")
    assert "2.236 " in fault.message
    assert "2.2360679775" in fault.message
    assert not faults({**scene, "tolerance": 1e-4})
    assert faults({**scene, "tolerance": 1e-6})


def test_forces_never_constrain() -> None:
    forces = [{"type": "spring", "between": ["A", [0, 0]], "stiffness": "k"}, {"type": "gravity", "name": "weight"}]
    found = system(dimension=2, particles=["A"], parameters=["k"], forces=forces)
    assert [f.name for f in found.forces] == ["f1", "weight"]
    assert all("no constraint" in f.reason for f in found.forces)
    assert found.constraints == ()


def test_a_link_of_length_zero_is_kept_with_a_warning() -> None:
    found = system(dimension=2, particles=["A"], constraints=[{"type": "link", "between": ["A", [0, 0]], "length": 0}])
    assert len(found.constraints[0].relations) == 1
    assert "coincident" in found.warnings[0]


# Bad input: (scene, where, column, a part of the message, a part of the hint)

PLANE: dict[str, Any] = {"dimension": 2, "particles": ["A", {"name": "B", "at": [1, 2]}], "bodies": ["crank"]}
SPACE: dict[str, Any] = {"bodies": ["a", "b"], "particles": ["A"]}


def plane(constraint: Any, **more: Any) -> dict[str, Any]:
    return {**PLANE, "constraints": [constraint], **more}


def space(constraint: Any) -> dict[str, Any]:
    return {**SPACE, "constraints": [constraint]}


C0 = ("constraints", 0)
CAM = {"type": "cam", "point": "B", "body": "ground"}
BAD: list[tuple[Any, tuple[str | int, ...], int | None, str, str]] = [
    ({"particels": ["A"]}, ("particels",), None, "unknown key 'particels'", "'particles'"),
    ({"particles": [{"name": "A", "mas": 1}]}, ("particles", 0, "mas"), None, "unknown key 'mas'", "'mass'"),
    ({"particles": ["A", "A"]}, ("particles", 1, "name"), None, "'A' is given twice", "particle"),
    ({"particles": ["A"], "bodies": ["A"]}, ("bodies", 0, "name"), None, "'A' is given twice", "particle"),
    ({"particles": ["A"], "coordinates": ["x_A"]}, ("coordinates", 0), None, "coordinate of particle 'A'", "rename"),
    ({"particles": ["A 1"]}, ("particles", 0, "name"), None, "cannot be the name of a particle", "`A_1`"),
    ({"bodies": ["left.link"]}, ("bodies", 0, "name"), None, "cannot be the name of a body", "`left_link`"),
    ({"coordinates": ["s-1"]}, ("coordinates", 0), None, "the character '-'", "write `s_1`"),
    ({"parameters": ["k-1_0"]}, ("parameters", "k-1_0"), None, "the character '-'", "write `k_1_0`"),
    ({"particles": ["A-1"], "coordinates": ["x_A_1"]}, ("coordinates", 0), None, "of particle 'A-1'", "rename"),
    ({"coordinates": ["x", "x"]}, ("coordinates", 1), None, "'x' is given twice", "rename"),
    ({"coordinates": ["theta", "θ"]}, ("coordinates", 1), None, "given twice", "rename"),
    ({"coordinates": ["t"]}, ("coordinates", 0), None, "time", "another name"),
    ({"bodies": ["ground"]}, ("bodies", 0, "name"), None, "fixed world", "another name"),
    ({"coordinates": ["sin"]}, ("coordinates", 0), None, "reserved", "another name"),
    ({"coordinates": ["x", "xdot"]}, ("coordinates", 1), None, "the velocity of 'x'", "rename"),
    ({"coordinates": ["x", "xd", "xddot"]}, ("coordinates", 2), None, "the velocity of 'xd'", "rename"),
    ({"coordinates": ["xd", "x", "xddot"]}, ("coordinates", 2), None, "the acceleration of 'x'", "rename"),
    ({"coordinates": ["x"], "parameters": ["dx"]}, ("parameters", "dx"), None, "the differential of 'x'", "rename"),
    ({"functions": {"x": ["x"]}, "coordinates": ["x"]}, ("functions", "x"), None, "given twice", "rename"),
    ({"functions": {"h": ["s t"]}}, ("functions", "h", 0), None, "s t", "names"),
    ({"parameters": {1: 2}}, ("parameters", 1), None, "not 1", ""),
    ({"coordinates": ["x"], "forces": [{"type": "spring", "stifness": 1}]}, ("forces", 0, "stifness"), None,
     "unknown key", "'stiffness'"),
    ({"functions": {"h": []}}, ("functions", "h"), None, "at least 1", ""),
    ({"parameters": ["a", "a"]}, ("parameters", 1), None, "given twice", ""),
    ({"parameters": {"a": "positve"}}, ("parameters", "a"), None, "not a kind of parameter", "'positive'"),
    ({"parameters": {"a": "negative"}}, ("parameters", "a"), None, "not a kind of parameter", "nonzero"),
    ({"parameters": {"a": "2 b"}}, ("parameters", "a"), 3, "`b` is not declared", ""),
    ({"dimension": 4}, ("dimension",), None, "1, 2 or 3, not 4", ""),
    ({"dimension": True}, ("dimension",), None, "true", ""),
    ({"tolerance": -1}, ("tolerance",), None, "fraction of the scene's size", ""),
    ({"particles": [1]}, ("particles", 0), None, "a name or a mapping", ""),
    ({"particles": [{"name": "A", "at": [1, 2]}]}, ("particles", 0, "at"), None, "2 components", "`at: [1, 2, 0]`"),
    ({"particles": [{"name": "A", "coordinates": ["x"]}]}, ("particles", 0, "coordinates"), None, "3 coordinates", ""),
    ({"configuration": {"x": 1}, "coordinates": ["xx"]}, ("configuration", "x"), None, "no coordinate 'x'", "'xx'"),
    ({"expect": {"doff": 1}}, ("expect", "doff"), None, "not a field of a report", "'dof'"),
    ({"constraints": {}}, ("constraints",), None, "a list is needed", ""),
    ({"constraints": [7]}, C0, None, "a text or a mapping", ""),
    ({"coordinates": ["x"], "constraints": ["x + foo = 1"]}, (*C0, "text"), 5, "`foo` is not declared", ""),
    ({"coordinates": ["x"], "constraints": ["x = 1/0"]}, (*C0, "text"), 7, "zero", ""),
    (plane({"type": "lnk"}), (*C0, "type"), None, "no constraint type 'lnk'", "'link'"),
    (plane({"between": ["A", "B"]}), C0, None, "`type`", "link"),
    (plane({"equation": "x_A = 1", "name": "wall"}), C0, None, "`type`", "'equation'"),
    (plane({"type": "link", "between": ["A"]}), (*C0, "between", 1), None, "2 entries", ""),
    (plane({"type": "link", "between": ["A", "C"]}), (*C0, "between", 1), None, "no particle 'C'", "A, B"),
    (plane({"type": "link", "between": ["A", "A"]}), (*C0, "between", 1), None, "two different points", ""),
    (plane({"type": "link", "between": ["A", "crank"]}), (*C0, "between", 1), None, "is a body", "{on: crank"),
    (plane({"type": "link", "between": ["A", "B"], "lenght": 3}), (*C0, "lenght"), None, "unknown key", "'length'"),
    (plane({"type": "link", "between": [[0, 0], "B"], "length": 3}), (*C0, "length"), None, "contradicts", "leave"),
    (plane({"type": "link", "between": [[0, 0], "B"], "length": "3 + t"}), (*C0, "length"), None, "contradicts", ""),
    (plane({"type": "link", "between": ["A", "B"], "length": "xdot_A"}), (*C0, "length"), None, "velocity of x_A", ""),
    (plane({"type": "link", "between": ["A", "B"], "length": -1}), (*C0, "length"), None, "negative", ""),
    (plane({"type": "link", "between": ["A", [0, 0, 0]]}), (*C0, "between", 1), None, "3 components", "`[0, 0]`"),
    (plane({"type": "link", "between": [{"on": "crank"}, "A"]}), (*C0, "between", 0, "at"), None, "needs 'at'", ""),
    (plane({"type": "weld", "between": ["crank", "crank"]}), (*C0, "between", 1), None, "joined to itself", ""),
    (plane({"type": "weld", "between": ["crank", "A"]}), (*C0, "between", 1), None, "is a particle", "coincident"),
    (plane({"type": "weld", "between": ["crnk", "ground"]}), (*C0, "between", 0), None, "no body 'crnk'", "'crank'"),
    (
        plane({"type": "revolute", "between": ["crank", "ground"], "axis": [0, 0, 1]}),
        (*C0, "axis"), None, "no `axis` in dimension 2", "leave it out",
    ),
    (plane({"type": "spherical", "between": ["crank", "ground"]}), (*C0, "type"), None, "dimension 3", "revolute"),
    (
        plane({"type": "prismatic", "between": ["crank", "ground"], "axis": [0, "sqrt(4) - 2"]}),
        (*C0, "axis"), None, "cannot be zero", "",
    ),
    (plane({"type": "on", "members": ["A"], "surface": "x + w"}), (*C0, "surface"), 5, "`w` is not declared", ""),
    (plane({"type": "on", "members": ["A", [1, 0]], "curve": "x/y = 1"}), (*C0, "members", 1), None, "no value", ""),
    (plane({"type": "on", "members": ["A"]}), C0, None, "`surface` and `curve`", ""),
    (plane({"type": "rigid", "members": ["A", "A"]}), (*C0, "members", 1), None, "named twice", ""),
    (plane({"type": "fixed", "body": "ground"}), (*C0, "body"), None, "fixed already", ""),
    (plane({"type": "roll", "body": "crank", "radius": 0}), (*C0, "radius"), None, "positive", ""),
    (
        plane({"type": "slot", "point": "B", "body": "ground", "at": [0, 0], "axis": [1, 1]}),
        (*C0, "point"), None, "off the line", "",
    ),
    (plane({**CAM, "curve": "x^2 + w"}), (*C0, "curve"), 7, "`w` is not declared", "x, y"),
    (plane({**CAM, "curve": "x = y_B"}), (*C0, "curve"), None, "coordinate y_B cannot stand", "x and y of the body"),
    (plane({**CAM, "curve": "x = ydot"}), (*C0, "curve"), None, "velocity of y cannot stand", ""),
    (plane({**CAM, "curve": "x <= 1"}), (*C0, "curve"), None, "one equation in x and y", "inequality"),
    (plane({**CAM, "curve": "1 = 1"}), (*C0, "curve"), None, "one equation in x and y", ""),
    (plane({**CAM, "curve": "x^2 + y^2 = 9"}), (*C0, "point"), None, "B at (1, 2), off the profile", "move"),
    (plane({**CAM, "curve": "y/(x - 1) = 2"}), (*C0, "point"), None, "has no value", "move"),
    (plane({**CAM, "point": [1, 2], "curve": "x = 1"}), (*C0, "point"), None, "a point of ground itself", ""),
    (
        space({"type": "cam", "point": [1, 0, 0], "body": "a", "curve": "x = 1"}),
        (*C0, "type"), None, "dimension 2", "in space",
    ),
    (
        plane({"type": "coincident", "between": ["B", {"on": "crank", "at": [1, 3]}]}),
        (*C0, "between"), None, "(1, 2) and (1, 3)", "",
    ),
    (plane({"name": "c1", "type": "fixed", "point": "A"}, forces=[{"type": "sprng"}]), ("forces", 0, "type"), None,
     "'sprng'", "'spring'"),
    (
        space({"type": "revolute", "between": ["a", "b"], "at": [0, 0, 0]}),
        C0, None, "no `axis`", "leave both out",
    ),
    (
        space({"type": "universal", "between": ["a", "b"], "at": [0, 0, 0]}),
        C0, None, "no `axes`", "leave both out",
    ),
    (
        space({"type": "universal", "between": ["a", "b"], "axes": [[1, 0, 0], [1, 1, 0]]}),
        (*C0, "axes"), None, "not perpendicular", "",
    ),
    (space({"type": "screw", "between": ["a", "b"]}), (*C0, "pitch"), None, "needs 'pitch'", ""),
    (
        {"dimension": 1, "bodies": ["a"], "constraints": [{"type": "revolute", "between": ["a", "ground"]}]},
        (*C0, "type"), None, "dimension 2 or 3", "on a line",
    ),
    (plane("x_A = 1", energies={"kinetic": "m xdot_A^2"}), ("energies", "kinetic"), 1, "`m` is not declared", ""),
    (plane("x_A = 1", energies={"forces": {"x_C": 1}}), ("energies", "forces", "x_C"), None, "no coordinate", ""),
]  # fmt: skip


@pytest.mark.parametrize(("scene", "where", "column", "message", "hint"), BAD)
def test_bad_input_is_reported(
    scene: Any, where: tuple[str | int, ...], column: int | None, message: str, hint: str
) -> None:
    (fault,) = faults(scene)
    assert fault.where == where
    assert fault.column == column
    assert message in fault.message
    assert hint in (fault.hint or "")


def test_all_faults_at_once() -> None:
    scene = plane("x_A + foo", configuration={"q": 1})
    scene["constraints"] = ["x_A + foo", {"type": "link", "between": ["A", "C"]}, {"type": "fixed", "body": "cank"}]
    found = faults(scene)
    assert [fault.where for fault in found] == [
        ("configuration", "q"),
        ("constraints", 0, "text"),
        ("constraints", 1, "between", 1),
        ("constraints", 2, "body"),
    ]
    with pytest.raises(SceneError) as caught:
        lower(Scene.model_validate(scene))
    assert caught.value.faults == found


def test_a_default_name_that_is_taken() -> None:
    scene = {"coordinates": ["x"], "constraints": [{"name": "c2", "type": "equation", "text": "x"}, "x = 0"]}
    (fault,) = faults(scene)
    assert fault.where == ("constraints", 1)
    assert "default name" in fault.message


# The rest


def test_every_field_is_described_in_the_schema() -> None:
    schema = Scene.model_json_schema()
    models = {"Scene": schema, **schema["$defs"]}
    bare = [
        f"{name}.{key}"
        for name, model in models.items()
        for key, field in model.get("properties", {}).items()
        if "description" not in field
    ]
    assert not bare
    assert {"type": "string"} in schema["properties"]["constraints"]["items"]["anyOf"]
    assert {"type": "string"} in schema["properties"]["particles"]["items"]["anyOf"]


def test_reading_a_scene_needs_no_algebra_package() -> None:
    code = "import sys, dofkit.scene.scene, dofkit.scene.lowering; print({'sympy', 'numpy'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def lowered(n: int) -> int:
    """The links of a large scene."""
    links = [
        {"type": "link", "between": [f"p{i}", f"p{(i + k + 1) % n}"]}
        for i in range(n)
        for k in range(2)
    ]  # fmt: skip
    points = [{"name": f"p{i}", "at": [i % 100, i // 100]} for i in range(n)]
    return len(system(dimension=2, particles=points, constraints=links).links)


def test_the_work_of_lowering_grows_with_the_scene() -> None:
    (few, small), (many, large) = (counted(partial(lowered, n)) for n in (200, 1600))
    assert (few, many) == (400, 3200)
    assert large < 1.5 * 8 * small
