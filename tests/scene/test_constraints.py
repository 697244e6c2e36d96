"""Every constraint type: its equations by hand, their number, and motions of the real joint that must satisfy them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import dofkit
from dofkit.base.errors import SceneError
from dofkit.expressions.calculus import diff
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import TIME, Expr, coordinate, parameter, velocity
from dofkit.scene.constraints import TYPES
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene
from dofkit.system import System

GROUND = "ground"
AXIS = [2, -1, 2]
Z = [0, 0, 1]
PLACE = [1, 2, 3]
AXES = [[1, 2, 2], [2, 1, -2]]


def system(dimension: int, *constraints: Any, **more: Any) -> System:
    return lower(Scene.model_validate({"dimension": dimension, "constraints": list(constraints), **more}))


def texts(found: System, index: int = 0) -> list[str]:
    return [f"{to_text(r.expr)} {r.sense} 0" for r in found.constraints[index].relations]


def value(e: Expr, at: dict[Expr, float]) -> float:
    """The value of an expression in floats."""
    if e.op == "num":
        return float(e.args[0])
    if e.op == "const":
        return {"pi": math.pi, "E": math.e}[e.args[0]]
    if e.op == "sym":
        return at[e]
    if e.op == "fn":
        function = {**vars(math), "abs": abs}[e.args[0]]
        return float(function(*(value(part, at) for part in e.args[1:])))
    parts = [value(part, at) for part in e.args]
    if e.op == "add":
        return sum(parts)
    return float(parts[0] ** parts[1]) if e.op == "pow" else math.prod(parts)


# The contract's table: (type, dimension) -> the fields, and the number of scalar equations.

P2: dict[str, Any] = {"particles": ["A", "B", "C"], "bodies": ["b", "c"]}
CASES: dict[tuple[str, int], tuple[dict[str, Any], int]] = {
    ("equation", 1): ({"text": "x_A = 1"}, 1),
    ("equation", 2): ({"text": "x_A dy_A = dt"}, 1),
    ("equation", 3): ({"text": "0 <= x_A"}, 1),
    ("on", 1): ({"members": ["A", "B"], "surface": "x^2 = 1"}, 2),
    ("on", 2): ({"members": ["A", "B"], "curve": ["x^2 + y^2 = 1"]}, 2),
    ("on", 3): ({"members": ["A", "B", "C"], "curve": ["x + y = 1", "z = x"]}, 6),
    ("link", 1): ({"between": ["A", "B"], "length": 2}, 1),
    ("link", 2): ({"between": ["A", {"on": "b", "at": [1, 2]}]}, 1),
    ("link", 3): ({"between": ["A", [1, 2, 3]], "length": "2 + t"}, 1),
    ("rigid", 1): ({"members": ["A", "B", "C"]}, 3),
    ("rigid", 2): ({"members": ["A", "B", "C"]}, 3),
    ("rigid", 3): ({"members": ["A", "B"]}, 1),
    ("fixed", 1): ({"body": "b"}, 1),
    ("fixed", 2): ({"body": "b"}, 3),
    ("fixed", 3): ({"body": "b"}, 6),
    ("revolute", 2): ({"between": ["b", "c"], "at": [1, 2]}, 2),
    ("revolute", 3): ({"between": ["b", "c"], "at": PLACE, "axis": AXIS}, 5),
    ("prismatic", 2): ({"between": ["b", "c"], "axis": [1, 2]}, 2),
    ("prismatic", 3): ({"between": ["b", "c"], "axis": AXIS}, 5),
    ("weld", 2): ({"between": ["b", "c"]}, 3),
    ("weld", 3): ({"between": ["b", "c"]}, 6),
    ("cylindrical", 3): ({"between": ["b", "c"], "at": PLACE, "axis": AXIS}, 4),
    ("screw", 3): ({"between": ["b", "c"], "at": PLACE, "axis": AXIS, "pitch": "1/2"}, 5),
    ("universal", 3): ({"between": ["b", "c"], "at": PLACE, "axes": AXES}, 4),
    ("spherical", 3): ({"between": ["b", "c"], "at": PLACE}, 3),
    ("planar", 3): ({"between": ["b", "c"], "at": PLACE, "axis": AXIS}, 3),
    ("coincident", 1): ({"between": ["A", "B"]}, 1),
    ("coincident", 2): ({"between": ["A", {"on": "b", "at": [1, 2]}]}, 2),
    ("coincident", 3): ({"between": [{"on": "c", "at": PLACE}, {"on": "b", "at": PLACE}]}, 3),
    ("slot", 2): ({"point": "A", "body": "b", "at": [1, 2], "axis": [1, 1]}, 1),
    ("slot", 3): ({"point": "A", "body": "b", "at": PLACE, "axis": AXIS}, 2),
    ("roll", 2): ({"body": "b", "radius": 2}, 2),
    ("roll", 3): ({"body": "b", "radius": "1/2"}, 3),
    ("string", 1): ({"along": ["A", [0], "B"], "length": 3}, 1),
    ("string", 2): ({"along": ["A", [0, 0], "B"], "length": 3}, 1),
    ("string", 3): ({"along": ["A", [0, 0, 0], "B"]}, 1),
    ("gear", 2): ({"between": ["b", "c"], "ratio": -2}, 1),
    ("cam", 2): ({"point": "A", "body": "b", "curve": "x^2 + 2 y^2 = 3"}, 1),
    ("coupling", 2): ({"joints": ["u", "v"], "text": "v = 2 u"}, 1),
    ("coupling", 3): ({"joints": ["u", "v"], "text": "v = 2 u"}, 1),
}
FIXED_POINTS = [({"point": "A"}, 1), ({"point": {"on": "b", "at": [1, 2]}}, 2), ({"point": "A"}, 3)]
JOINTS = [case for case in CASES if "at" in CASES[case][0] or "axis" in CASES[case][0]]


def hinges(dimension: int) -> list[dict[str, Any]]:
    """u joins b to the ground, v joins c to b."""
    turning = {"type": "revolute", "axis": Z} if dimension == 3 else {"type": "revolute"}
    return [
        {"name": "u", "between": [GROUND, "b"], "at": [0, 0, 0][:dimension], **turning},
        {"name": "v", "between": ["b", "c"], "at": [1, 0, 0][:dimension], **turning},
    ]


def test_the_types_are_those_of_the_contract_in_its_order() -> None:
    assert list(TYPES)[:4] == ["equation", "on", "link", "rigid"]
    assert list(TYPES)[-2:] == ["cam", "coupling"]
    assert all(cls.kind() == kind for kind, cls in TYPES.items())


def test_every_type_and_dimension_has_a_case() -> None:
    wanted = {(kind, d) for kind, cls in TYPES.items() for d in cls.dimensions}
    assert wanted == set(CASES)


@pytest.mark.parametrize(("kind", "dimension"), CASES)
def test_number_of_equations(kind: str, dimension: int) -> None:
    fields, expected = CASES[kind, dimension]
    found = system(dimension, {"type": kind, **fields}, *(hinges(dimension) if "joints" in fields else ()), **P2)
    assert len(found.constraints[0].relations) == expected
    assert found.constraints[0].type == kind
    assert found.constraints[0].text


@pytest.mark.parametrize(("fields", "dimension"), FIXED_POINTS)
def test_a_fixed_point_yields_d_equations(fields: dict[str, Any], dimension: int) -> None:
    found = system(dimension, {"type": "fixed", **fields}, **P2)
    assert len(found.constraints[0].relations) == dimension


@pytest.mark.parametrize(("kind", "dimension"), JOINTS)
def test_generic_geometry_yields_as_many(kind: str, dimension: int) -> None:
    fields, expected = CASES[kind, dimension]
    bare = {key: given for key, given in fields.items() if key not in ("at", "axis", "axes")}
    found = system(dimension, {"type": kind, **bare}, **P2)
    assert len(found.constraints[0].relations) == expected
    assert found.reference is None
    if kind != "planar":
        assert found.generic


# By hand


def test_planar_equations_by_hand() -> None:
    pin = {"type": "revolute", "between": [GROUND, "a"], "at": [1, 2]}
    assert texts(system(2, pin, bodies=["a"])) == [
        "x_a + cos(theta_a) - 2*sin(theta_a) - 1 = 0",
        "y_a + sin(theta_a) + 2*cos(theta_a) - 2 = 0",
    ]
    slider = {"type": "prismatic", "between": [GROUND, "a"], "axis": [1, 0], "drive": "v t"}
    assert texts(system(2, slider, bodies=["a"], parameters=["v"])) == ["theta_a = 0", "y_a = 0", "x_a - v*t = 0"]
    roll = {"type": "roll", "body": "a", "radius": "R"}
    rolling = system(2, roll, bodies=["a"], parameters=["R"]).constraints[0].relations
    assert to_text(rolling[0].expr) == "y_a - R"
    assert rolling[1].expr == velocity("x_a") + parameter("R") * velocity("theta_a")


def test_a_body_starts_where_the_configuration_puts_it() -> None:
    weld = {"type": "weld", "between": [GROUND, "a"]}
    found = system(2, weld, bodies=["a"], configuration={"x_a": 1, "y_a": 2, "theta_a": "pi/2"})
    assert texts(found) == ["theta_a - pi/2 = 0", "x_a - 1 = 0", "y_a - 2 = 0"]
    pin = {"type": "revolute", "between": [GROUND, "a"], "at": [1, 2]}
    found = system(2, pin, bodies=["a"], configuration={"x_a": 1, "y_a": 2, "theta_a": "pi/2"})
    assert texts(found) == ["x_a - 1 = 0", "y_a - 2 = 0"]


def test_spatial_equations_by_hand() -> None:
    pin = {"type": "revolute", "between": [GROUND, "a"], "at": [0, 0, 0], "axis": [0, 0, 1]}
    assert texts(system(3, pin, bodies=["a"]))[:3] == ["x_a = 0", "y_a = 0", "z_a = 0"]
    assert texts(system(3, pin, bodies=["a"]))[3:] == ["phi_a = 0", "theta_a = 0"]
    weld = {"type": "weld", "between": ["a", "b"]}
    names = ["phi", "theta", "psi", "x", "y", "z"]
    assert texts(system(3, weld, bodies=["a", "b"])) == [f"{q}_b - {q}_a = 0" for q in names]


def test_links_by_hand() -> None:
    squared = "(x_B - x_A)^2 + (y_B - y_A)^2"
    two = {"particles": ["A", "B"], "parameters": {"l": "positive", "w": "real"}}
    link = {"type": "link", "between": ["A", "B"]}
    assert texts(system(2, {**link, "length": "l"}, **two)) == [f"{squared} - l^2 = 0"]
    assert texts(system(2, {**link, "length": "sqrt(2)"}, **two)) == [f"{squared} - 2 = 0"]
    assert texts(system(2, link, **two)) == [f"{squared} - _L1 = 0"]
    assert system(2, link, **two).generic == ("_L1",)
    assert texts(system(1, {**link, "length": 3}, **two)) == ["(x_B - x_A)^2 - 9 = 0"]
    drawn = {"particles": [{"name": "A", "at": [0, 0]}, {"name": "B", "at": ["1/2", "sqrt(3)/2"]}]}
    assert texts(system(2, link, **drawn)) == [f"{squared} - 1 = 0"]
    assert texts(system(2, {**link, "length": 1}, **drawn)) == [f"{squared} - 1 = 0"]


def test_links_are_listed() -> None:
    found = system(
        2,
        "x_A = 0",
        {"type": "link", "between": ["A", "B"]},
        {"type": "link", "between": ["A", "B"], "length": "2 + t"},
        {"type": "link", "between": ["A", [0, 0]]},
        {"type": "rigid", "members": ["A", "B", "C"]},
        particles=["A", "B", "C"],
    )
    assert found.links == ((1, "A", "B"), (4, "A", "B"), (4, "A", "C"), (4, "B", "C"))


def test_on_and_inequalities_by_hand() -> None:
    sphere = {"type": "on", "members": ["A", [0, 0, 2]], "surface": "x^2 + y^2 + z^2 <= R^2"}
    found = system(3, sphere, particles=["A"], parameters={"R": "positive"})
    assert texts(found) == ["R^2 - x_A^2 - y_A^2 - z_A^2 >= 0", "R^2 - 4 >= 0"]
    chain = system(1, "0 < x_A <= 2", particles=["A"])
    assert texts(chain) == ["x_A > 0", "2 - x_A >= 0"]
    clash = {"type": "on", "members": ["A"], "surface": "y = x"}
    assert texts(system(2, clash, particles=["A"], coordinates=["x"])) == ["y_A - x_A = 0"]


def test_strings_and_gears_by_hand() -> None:
    hoist = {"type": "string", "along": ["A", [0], "B"], "length": 5}
    assert texts(system(1, hoist, particles=["A", "B"])) == ["abs(-x_A) + abs(x_B) - 5 = 0"]
    gears = {"type": "gear", "between": ["a", "b"], "ratio": -2, "carrier": "arm"}
    (text,) = texts(system(2, gears, bodies=["a", "b", "arm"]))
    assert text == "theta_b - 3*theta_arm + 2*theta_a = 0"


def test_cams_by_hand() -> None:
    groove = {"type": "cam", "point": "A", "body": GROUND, "curve": "x^2 + 2 y^2 = 3"}
    assert texts(system(2, groove, particles=["A"])) == ["x_A^2 + 2*y_A^2 - 3 = 0"]
    face = {"type": "cam", "point": [3, 0], "body": "b", "curve": "x = e(t)"}
    (text,) = texts(system(2, face, bodies=["b"], functions={"e": ["t"]}))
    assert text == "cos(theta_b)*(3 - x_b) - sin(theta_b)*y_b - e(t) = 0"


def test_notes() -> None:
    five = system(3, {"type": "rigid", "members": list("ABCDE")}, particles=list("ABCDE"))
    (note,) = five.constraints[0].notes
    assert "= 10 links" in note
    assert "= 9 are independent" in note
    assert not system(3, {"type": "rigid", "members": list("ABCD")}, particles=list("ABCD")).constraints[0].notes
    curve = {"type": "on", "members": ["A"], "curve": ["y = 0", "z = x^2"]}
    assert "two surfaces meet" in system(3, curve, particles=["A"]).constraints[0].notes[0]


# Motions of the real joints


def rotation(axis: Any, angle: float) -> np.ndarray:
    n = np.array(axis, float) / np.linalg.norm(axis)
    k = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


class Motion:
    """A rigid displacement x -> R x + s."""

    def __init__(self, r: np.ndarray, s: Any) -> None:
        self.r, self.s = r, np.array(s, float)

    def __matmul__(self, other: Motion) -> Motion:
        return Motion(self.r @ other.r, self.r @ other.s + self.s)


def about(axis: Any, angle: float, at: Any = PLACE, advance: float = 0.0) -> Motion:
    r, a = rotation(axis, angle), np.array(at, float)
    return Motion(r, a - r @ a + advance * np.array(axis, float) / np.linalg.norm(axis))


def euler_of(r: np.ndarray) -> tuple[float, float, float]:
    return math.atan2(r[0, 2], -r[1, 2]), math.acos(max(-1.0, min(1.0, r[2, 2]))), math.atan2(r[2, 0], r[2, 1])


def gibbs_of(r: np.ndarray) -> np.ndarray:
    return np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / (1 + np.trace(r))


def values_of(found: System, moved: dict[str, Motion]) -> dict[Expr, float]:
    """The coordinates of bodies that have been displaced from the reference."""
    at: dict[Expr, float] = {}
    for turned in found.rotations:
        motion = moved[turned.body]
        names = [q.name for q in found.coordinates if q.owner == turned.body]
        origin = np.array([value(found.pose[coordinate(name)], {}) for name in names[:3]])
        at.update(zip(map(coordinate, names[:3]), motion.r @ origin + motion.s, strict=True))
        if turned.chart == "gibbs":
            angles = tuple(gibbs_of(motion.r))
        else:
            phi, theta, psi = (value(angle, {}) for angle in turned.initial)
            angles = euler_of(
                motion.r @ rotation([0, 0, 1], phi) @ rotation([1, 0, 0], theta) @ rotation([0, 0, 1], psi)
            )
        at.update(zip(map(coordinate, turned.names), angles, strict=True))
    return at


A1, A2 = AXES
U, V = [1, 2, 0], [2, -4, -4]  # across AXIS
FREEDOMS: dict[str, Any] = {
    "revolute": lambda a, b, c: about(AXIS, a),
    "prismatic": lambda a, b, c: about(AXIS, 0, advance=b),
    "weld": lambda a, b, c: about(AXIS, 0),
    "cylindrical": lambda a, b, c: about(AXIS, a, advance=b),
    "screw": lambda a, b, c: about(AXIS, a, advance=0.5 * a / (2 * math.pi)),
    "universal": lambda a, b, c: about(A1, a) @ about(A2, b),
    "spherical": lambda a, b, c: about([1, 2, 0.3], a) @ about([0, 1, c], b),
    "planar": lambda a, b, c: Motion(np.eye(3), b * np.array(U) + c * np.array(V)) @ about(AXIS, a),
}
EULER = {"energies": {"kinetic": "phidot_b^2 + psidot_c^2"}}
MIXED = {"energies": {"kinetic": "phidot_b^2"}}
POSED = {"configuration": {"x_b": 1, "z_b": "1/2", "phi_b": "pi/5", "theta_b": 1, "psi_b": 2, "y_c": 3, "theta_c": "2"}}
WAYS = {"gibbs": {}, "posed": POSED, "euler": EULER | POSED, "mixed": MIXED | POSED}


@pytest.mark.parametrize("ends", [("b", "c"), (GROUND, "c"), ("b", GROUND)])
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("kind", FREEDOMS)
def test_a_joints_own_motions_satisfy_it_and_others_do_not(kind: str, way: str, ends: tuple[str, str]) -> None:
    fields, _ = CASES[kind, 3]
    found = system(3, {"type": kind, **fields, "between": list(ends)}, bodies=["b", "c"], **WAYS[way])
    relations = [r.expr for r in found.constraints[0].relations]
    draw = np.random.default_rng(7)
    for _ in range(3):
        first = about(draw.normal(size=3), draw.uniform(-1, 1)) @ Motion(np.eye(3), draw.normal(size=3))
        joint = FREEDOMS[kind](*draw.uniform(-1, 1, 3))
        if ends[0] == GROUND:
            moved = {"c": joint, "b": first}
        elif ends[1] == GROUND:
            moved = {"b": Motion(joint.r.T, -joint.r.T @ joint.s), "c": first}
        else:
            moved = {"b": first, "c": first @ joint}
        at = values_of(found, moved)
        assert max(abs(value(e, at)) for e in relations) < 1e-9
        body = ends[1] if ends[1] != GROUND else "b"
        moved[body] = moved[body] @ about([1, 5, 2], 0.3, at=[4, 0, 1], advance=0.2)
        at = values_of(found, moved)
        assert max(abs(value(e, at)) for e in relations) > 1e-3


@pytest.mark.parametrize("way", ["gibbs", "posed", "euler"])
@pytest.mark.parametrize("kind", FREEDOMS)
def test_a_joints_equations_are_independent_at_the_reference(kind: str, way: str) -> None:
    fields, equations = CASES[kind, 3]
    found = system(3, {"type": kind, **fields}, bodies=["b", "c"], **WAYS[way])
    at = {symbol: value(e, {}) for symbol, e in found.pose.items()}
    rows = [
        [value(diff(r.expr, coordinate(q.name)), at) for q in found.coordinates] for r in found.constraints[0].relations
    ]
    if way == "euler" and kind in ("prismatic", "weld"):
        assert max(abs(value(r.expr, at)) for r in found.constraints[0].relations) < 1e-12
    assert np.linalg.matrix_rank(np.array(rows), tol=1e-9) == equations


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(
    ("kind", "motion"),
    [
        ("revolute", lambda t: about(AXIS, t)),
        ("screw", lambda t: about(AXIS, t, advance=0.5 * t / (2 * math.pi))),
        ("prismatic", lambda t: about(AXIS, 0, advance=t)),
        ("cylindrical", lambda t: about(AXIS, 0.4, advance=t)),
    ],
)
def test_drives_prescribe_angle_or_displacement(kind: str, motion: Any, way: str) -> None:
    fields, equations = CASES[kind, 3]
    for ends in (("b", "c"), (GROUND, "c")):
        joint = {"type": kind, **fields, "drive": "t", "between": list(ends)}
        found = system(3, joint, bodies=["b", "c"], **WAYS[way])
        relations = [r.expr for r in found.constraints[0].relations]
        assert len(relations) == equations + 1
        first = about([1, 0, 2], 0.7) if ends[0] == "b" else Motion(np.eye(3), [0, 0, 0])
        for t in (0.0, 0.5, -1.2):
            at = {**values_of(found, {"b": first, "c": first @ motion(t)}), TIME: t}
            assert max(abs(value(e, at)) for e in relations) < 1e-9
            assert abs(value(relations[-1], {**at, TIME: t + 0.1})) > 1e-3


#: Type, fields, and t -> the second body's angle and displacement seen from the first.
PLANE: list[tuple[str, dict[str, Any], Any]] = [
    ("revolute", {"at": [1, 2]}, lambda t: (t, np.array([1, 2]) - turn(t) @ [1, 2])),
    ("prismatic", {"axis": [3, 4]}, lambda t: (0.0, t * np.array([0.6, 0.8]))),
    ("weld", {}, lambda t: (0.0, np.zeros(2))),
]


def turn(angle: float) -> np.ndarray:
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


@pytest.mark.parametrize(
    ("kind", "fields", "motion", "drive"),
    [(*joint, drive) for joint in PLANE for drive in (False, True) if not (drive and joint[0] == "weld")],
)
def test_plane_joints(kind: str, fields: dict[str, Any], motion: Any, drive: bool) -> None:
    start = {"x_b": 1, "y_b": 2, "theta_b": "1/2", "x_c": -1}
    joint = {"type": kind, "between": ["b", "c"], **fields, **({"drive": "t"} if drive else {})}
    found = system(2, joint, bodies=["b", "c"], configuration=start)
    t = 0.8
    angle, shift = motion(t)
    first = (0.3, np.array([2.0, -1.0]))
    places = {"b": first, "c": (first[0] + angle, turn(first[0]) @ shift + first[1])}
    at: dict[Expr, float] = {TIME: t}
    for body, (a, s) in places.items():
        origin = np.array([float(start.get(f"{x}_{body}", 0)) for x in "xy"])
        x, y = turn(a) @ origin + s
        at |= {coordinate(f"x_{body}"): x, coordinate(f"y_{body}"): y}
        at[coordinate(f"theta_{body}")] = a + (0.5 if body == "b" else 0.0)
    relations = [r.expr for r in found.constraints[0].relations]
    assert len(relations) == CASES[kind, 2][1] + drive
    assert max(abs(value(e, at)) for e in relations) < 1e-12


@pytest.mark.parametrize("way", ["gibbs", "euler"])
def test_a_rolling_sphere_has_no_velocity_at_its_foot(way: str) -> None:
    more = {"energies": {"kinetic": "phidot_b^2"}} if way == "euler" else {}
    found = system(3, {"type": "roll", "body": "b", "radius": 2}, bodies=["b"], **more)
    (turned,) = found.rotations
    assert turned.chart == way
    spin = np.array([0.3, -0.7, 0.4])
    r, h = rotation([1, 2, 3], 0.9), 1e-6
    later = rotation(spin, np.linalg.norm(spin) * h) @ r
    angles = gibbs_of if way == "gibbs" else euler_of
    now, then = np.array(angles(r)), np.array(angles(later))
    speed = -np.cross(spin, [0, 0, -2])
    at: dict[Expr, float] = {coordinate("x_b"): 5, coordinate("y_b"): 1, coordinate("z_b"): 2}
    at |= {velocity(f"{x}_b"): v for x, v in zip("xyz", speed, strict=True)}
    for name, a, b in zip(turned.names, now, then, strict=True):
        at |= {coordinate(name): a, velocity(name): (b - a) / h}
    assert max(abs(value(r.expr, at)) for r in found.constraints[0].relations) < 1e-4


def test_a_slot_carried_by_a_body() -> None:
    slot = {"type": "slot", "point": "A", "body": "b", "at": PLACE, "axis": AXIS}
    found = system(3, slot, bodies=["b"], particles=["A"])
    carried = about([1, 0, 1], 0.5) @ Motion(np.eye(3), [1, 2, 3])
    place = carried.r @ (np.array(PLACE) + 1.7 * np.array(AXIS)) + carried.s
    at = values_of(found, {"b": carried})
    at |= {coordinate(f"{x}_A"): part for x, part in zip("xyz", place, strict=True)}
    assert max(abs(value(r.expr, at)) for r in found.constraints[0].relations) < 1e-9
    at[coordinate("y_A")] += 0.1
    assert max(abs(value(r.expr, at)) for r in found.constraints[0].relations) > 1e-3


@pytest.mark.parametrize("start", [{}, {"x_b": 1, "y_b": "1/2", "theta_b": 2, "x_c": 3}])
@pytest.mark.parametrize("follower", ["particle", "body", "world"])
def test_a_profile_moves_and_turns_with_its_body(follower: str, start: dict[str, Any]) -> None:
    """The point of the ellipse at parameter s, wherever the body's frame is, and no other."""
    point: Any = {"particle": "A", "body": {"on": "c", "at": [1, 2]}, "world": [1, 2]}[follower]
    cam = {"type": "cam", "point": point, "body": "b", "curve": "x^2/9 + y^2/4 = k (1 + t)^2"}
    found = system(2, cam, particles=["A"], bodies=["b", "c"], parameters=["k"], configuration=start)
    (relation,) = [r.expr for r in found.constraints[0].relations]
    c_turn, c_start = 0.7, np.array([float(start.get("x_c", 0)), 0.0])
    at: dict[Expr, float] = {TIME: 0.2, parameter("k"): 1}
    at |= {coordinate("x_c"): -1, coordinate("y_c"): 0.3, coordinate("theta_c"): c_turn}
    carried = turn(c_turn) @ (np.array([1, 2]) - c_start) + [-1, 0.3]
    place = {"particle": np.array([4.0, -2.0]), "body": carried, "world": np.array([1, 2])}[follower]
    at |= {coordinate("x_A"): place[0], coordinate("y_A"): place[1]}
    for s, angle in ((0.4, 1.1), (2.0, -0.5)):
        own = 1.2 * np.array([3 * math.cos(s), 2 * math.sin(s)])
        origin = place - turn(angle) @ own
        at |= {coordinate("x_b"): origin[0], coordinate("y_b"): origin[1], coordinate("theta_b"): angle}
        assert abs(value(relation, at)) < 1e-12
        assert abs(value(relation, {**at, coordinate("theta_b"): angle + 0.1})) > 1e-3


def test_a_drawn_cam_moves_to_first_order_as_a_slot_along_its_tangent() -> None:
    """The tangent of 2 x^2 + y^2 = 6 at (1, 2) is (-1, 1), also seen from a frame that was placed and turned."""
    slot = {"type": "slot", "point": "A", "body": "b", "at": [1, 2], "axis": [-1, 1]}
    given = {"particles": [{"name": "A", "at": [1, 2]}], "bodies": ["b"]}
    poses = [("2 x^2 + y^2 = 6", {}), ("2 (1 - y)^2 + (x + 3)^2 = 6", {"x_b": 1, "y_b": 3, "theta_b": "pi/2"})]
    for curve, pose in poses:
        drawn = {**given, "configuration": {"x_b": 0, "y_b": 0, "theta_b": 0, **pose}}
        cam = {"type": "cam", "point": "A", "body": "b", "curve": curve}
        one, other = (system(2, c, **drawn).connections[0] for c in (cam, slot))
        assert one.members == other.members
        assert [value(x, {}) * 4 for x in one.directions[0] or ()] == pytest.approx([-16, 16])


@pytest.mark.parametrize("curve", ["abs(x - 1) = y - 2", "(x - 1)^2 = (y - 2)^3", "h(x) = y", "x + y = p"])
def test_no_tangent_at_a_corner_a_cusp_or_where_the_profile_is_not_known(curve: str) -> None:
    cam = {"type": "cam", "point": "A", "body": GROUND, "curve": curve}
    more = {"particles": [{"name": "A", "at": [1, 2]}], "functions": {"h": ["s"]}, "parameters": ["p"]}
    found = system(2, cam, **more)
    assert found.connections[0].directions == (None,)
    assert (found.reference is None) == (curve == "x + y = p")


def test_a_body_that_nothing_places_may_touch_anywhere() -> None:
    cam = {"type": "cam", "point": [7, 0], "body": "b", "curve": "x^2 + y^2 = 1"}
    assert system(2, cam, bodies=["b"]).reference is None
    pin = {"type": "revolute", "between": [GROUND, "b"], "at": [0, 0]}
    for order in ([pin, cam], [cam, pin]):
        with pytest.raises(SceneError, match=r"off the profile of b: there `.*` fails by 48"):
            system(2, *order, bodies=["b"])
        measured = {**cam, "curve": "x^2 + y^2 = 49.0001"}
        assert system(2, *[measured if c is cam else c for c in order], bodies=["b"], tolerance=0.001).reference


def test_two_profiles_that_touch_are_not_one_contact() -> None:
    """At the drawing both say the same of velocities; the bead can go on along neither of them."""
    bead = {"type": "cam", "point": "A", "body": GROUND}
    given = {"dimension": 2, "particles": [{"name": "A", "at": [0, 1]}]}
    curves = ["x^2 + y^2 = 1", "y = 1"]
    scene = dofkit.load({**given, "constraints": [{**bead, "curve": curve} for curve in curves]})
    assert dofkit.ask(scene, "dof").value == 0
    assert dofkit.ask(scene, "redundancy").value == []
    again = dofkit.load({**given, "constraints": [{**bead, "curve": curves[0]}] * 2})
    assert dofkit.ask(again, "dof").value == 1
    assert dofkit.ask(again, "redundancy").value == ["c2"]


def test_generic_joints_close_at_the_pose() -> None:
    for (kind, d), (fields, _) in CASES.items():
        if kind not in TYPES or "between" not in fields or not {"at", "axis"} & set(fields):
            continue
        bare = {key: given for key, given in fields.items() if key not in ("at", "axis", "axes")}
        found = system(d, {"type": kind, **bare}, bodies=["b", "c"])
        at = {symbol: value(e, {}) for symbol, e in found.pose.items()}
        draw = np.random.default_rng(3)
        at |= {parameter(name): draw.uniform(1, 2) for name in found.generic}
        assert max(abs(value(r.expr, at)) for r in found.constraints[0].relations) < 1e-12


def _planetary(*more: dict[str, Any], **gear: Any) -> tuple[str, ...]:
    """Warnings of a sun and an arm on the ground and a planet on the arm, geared."""
    hinges = [("ground", "sun", 0), ("ground", "arm", 0), ("arm", "planet", 3)]
    joints = [{"type": "revolute", "between": [a, b], "at": [x, 0]} for a, b, x in hinges]
    mesh = {"name": "mesh", "type": "gear", "between": ["sun", "planet"], "ratio": -2, **gear}
    scene = {"dimension": 2, "bodies": ["sun", "planet", "arm"], "constraints": [*joints, mesh, *more]}
    return lower(dofkit.load(scene)).warnings


def test_a_gear_on_a_moving_arm_is_reported_of_its_carrier() -> None:
    (told,) = _planetary()
    assert "'mesh'" in told
    assert "'planet' turns on 'arm'" in told
    assert "`carrier: arm`" in told
    assert _planetary(carrier="arm") == ()
    assert _planetary({"type": "weld", "between": ["arm", "ground"]}) == ()
    assert _planetary({"type": "fixed", "body": "arm"}) == ()
