"""Given geometry: the count in general position and Gruebler's and Kutzbach's, beside the truth; expected by hand."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import OURS, scene_of, spread, stem, swept

import dofkit
from dofkit.configuration import at_reference as local
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.interface.show.report import sheet_of_report
from dofkit.interface.show.terminal import as_text
from dofkit.mobility.placement import reference_placement, rows_of
from dofkit.report import Report
from dofkit.scene.constraints import TYPES
from dofkit.scene.lowering import lower
from dofkit.system import System

SCENES = Path(__file__).parents[1] / "scenes"


@cache
def told(name: str) -> Report:
    """The report of a scene of the tests or of the catalog."""
    found = sorted(SCENES.glob(f"*/{name}.yaml"))
    return dofkit.classify(dofkit.load(found[0] if found else name))


# Gruebler's and Kutzbach's count. M by hand from N, j and the freedoms of the joints.

COUNTS = [
    # scene, N, j, M = D(N - 1 - j) + sum f, truth
    ("bennett-exact", 4, 4, 6 * (4 - 1 - 4) + 4, 1),
    ("sarrus-linkage", 6, 6, 6 * (6 - 1 - 6) + 6, 1),
    ("bricard-orthogonal", 6, 6, 6 * (6 - 1 - 6) + 6, 1),
    ("goldberg-5r", 5, 5, 6 * (5 - 1 - 5) + 5, 1),
    ("parallelogram-three-cranks", 2, 3, 3 * (2 - 1 - 3) + 3 * 2, 1),
    ("four-cranks-parallel", 6, 8, 3 * (6 - 1 - 8) + 8, 1),
    ("door-two-hinges", 2, 2, 6 * (2 - 1 - 2) + 2, 1),
    ("door-three-hinges", 2, 3, 6 * (2 - 1 - 3) + 3, 1),
    ("four-bar-in-space", 4, 4, 6 * (4 - 1 - 4) + 4, 1),
    ("spherical-four-bar", 4, 4, 6 * (4 - 1 - 4) + 4, 1),
    ("rssr-linkage", 4, 4, 6 * (4 - 1 - 4) + 1 + 3 + 3 + 1, 2),
    ("four-bar-driven-crank", 4, 4, 3 * (4 - 1 - 4) + 4 - 1, 0),
]


@pytest.mark.parametrize(("name", "links", "joints", "kutzbach", "truth"), COUNTS, ids=[row[0] for row in COUNTS])
def test_kutzbach_beside_the_truth(name: str, links: int, joints: int, kutzbach: int, truth: int) -> None:
    found = told(name).mobility
    assert found is not None
    assert (found.links, found.joints, found.kutzbach, found.freedom) == (links, joints, kutzbach, truth)
    assert found.formula.endswith(f"= {kutzbach}")
    assert (found.differs is None) == (kutzbach == truth)


@pytest.mark.parametrize(
    ("name", "span"),
    [
        ("bennett-exact", 3),  # four hinges, one freedom: 4 - 3
        ("sarrus-linkage", 5),  # six hinges: 6 - 5
        ("bricard-orthogonal", 5),
        ("four-bar-in-space", 3),  # motions parallel to a plane
        ("spherical-four-bar", 3),  # rotations about a point
        ("door-two-hinges", 1),  # one and the same screw twice
    ],
)
def test_why_kutzbach_errs_is_the_span_of_the_screws(name: str, span: int) -> None:
    found = told(name).mobility
    assert found is not None
    assert found.differs is not None
    assert f"the joint screws form a {span}-system" in found.differs
    assert f"with {span} in place of 6" in found.differs


def test_what_is_counted_besides_joints_is_said() -> None:
    scene = {
        "dimension": 2,
        "bodies": ["rod"],
        "particles": [{"name": "A", "at": [2, 0]}],
        "constraints": [
            {"type": "revolute", "between": ["ground", "rod"], "at": [0, 0]},
            {"type": "link", "between": ["A", {"on": "rod", "at": [1, 0]}]},
        ],
    }
    found = dofkit.classify(dofkit.load(scene)).mobility
    assert found is not None
    # one hinge, two coordinates of A, the link: 3(2 - 1 - 1) + 1 + 2 - 1
    assert found.kutzbach == found.freedom == 2
    assert "2 per particle" in found.formula
    assert "other equations" in found.formula


def test_a_scene_without_joints_has_no_kutzbach_count() -> None:
    assert told("double-banana").mobility is None


# General position

GENERIC = [
    # scene, dof in general position, redundant there, instantaneous dof at the drawing, a word of the reason
    ("door-two-hinges", 0, 4, 1, "on one line"),
    ("four-bar-in-space", 0, 2, 1, "parallel"),
    ("spherical-four-bar", 0, 2, 1, "meet in one point"),
    ("cardan-joint", 0, 2, 1, "meet in one point"),
    ("bennett-exact", 0, 2, 1, "overconstrained"),
    ("sarrus-linkage", 0, 0, 1, "A1, A2 and A3 are parallel"),
    ("parallelogram-three-cranks", 0, 0, 1, "crank1, crank2 and crank3 are parallel"),
    ("three-bars-through-one-point", 0, 0, 1, "meet in one point"),
    ("collinear-one-one-two", 3, 0, 4, "A, B, C lie on one line"),
    ("k33-on-circle", 3, 0, 4, "one conic"),
    ("plate-between-three-fingers", 0, 0, 1, "the normal of upper and the normal of lower meet in one point"),
    ("prism-of-two-triangles-parallel", 3, 0, 4, "ad, be and cf are parallel"),
    ("rhombus-folded", 1, 0, 2, "A and C coincide"),
    ("four-bar-linkage", 1, 0, 1, None),
    ("double-banana", 7, 1, 7, None),  # Maxwell's count would say 6
    ("braced-square", 3, 1, 3, None),
]


@pytest.mark.parametrize(("name", "dof", "redundant", "here", "why"), GENERIC, ids=[row[0] for row in GENERIC])
def test_general_position_beside_the_drawing(name: str, dof: int, redundant: int, here: int, why: str | None) -> None:
    report = told(name)
    found = report.generic
    assert found is not None
    assert (found.dof, found.redundant_equations, report.instantaneous_dof) == (dof, redundant, here)
    if why is None:
        assert found.differs is None
    else:
        assert found.differs is not None
        assert why in found.differs


SLIDE, LINK = {"type": "prismatic", "axis": [1, 0]}, {"type": "link", "between": [[0, 0], "P"]}
#: Scenes of the plane, and why the drawing is special: the constraints say the same of it, but not in general position.
REPEATED = [
    ({"bodies": ["A"]}, [{**SLIDE, "between": ["ground", "A"]}] * 2, "; c1 and c2 slide in parallel directions"),
    ({"bodies": ["A", "B"]}, [{**SLIDE, "between": ["A", "B"]}] * 2, "; c1 and c2 slide in parallel directions"),
    (
        {"particles": [{"name": "P", "at": [3, 4]}]},
        [LINK, "x_P^2 + y_P^2 = 25"],
        "consistent with the others at the reference configuration only",
    ),
]


@pytest.mark.parametrize(("parts", "constraints", "why"), REPEATED)
def test_what_repeats_another_fits_at_the_drawing_only(parts: dict[str, Any], constraints: list[Any], why: str) -> None:
    report = dofkit.classify(dofkit.load({"dimension": 2, **parts, "constraints": constraints}))
    assert report.generic is not None
    assert report.generic.differs is not None
    assert report.generic.differs.endswith(why)


def test_points_in_one_plane_of_space() -> None:
    """A joint held by three links to the ground in one plane can move across it, to first order."""
    scene = {
        "particles": [{"name": "A", "at": [0, 0, 0]}],
        "constraints": [
            {"type": "link", "between": ["A", [3, 0, 0]]},
            {"type": "link", "between": ["A", [0, 4, 0]]},
            {"type": "link", "between": ["A", [-1, -2, 0]]},
        ],
    }
    report = dofkit.classify(dofkit.load(scene))
    assert report.generic is not None
    assert report.generic.differs is not None
    assert (report.generic.dof, report.instantaneous_dof) == (0, 1)
    assert "lie in one plane" in report.generic.differs


# Redundant equations by name: of a dependent set the last written

EQUATIONS = [
    # The plate turns about y by one chain and about x by the other, so about z by none.
    ("sarrus-linkage", {"B3": ["no rotation about (0, 0, 1)"]}),
    # A plane mechanism: that the last hinge stays in the plane and upright follows from the three before.
    (
        "four-bar-in-space",
        {
            "D": [
                "no displacement along z of the common point (5, 0, 0)",
                "no rotation about (1, 0, 0)",
                "no rotation about (0, 1, 0)",
            ]
        },
    ),
    # The lower hinge leaves the turn about z; only the upper's distance from that axis is a new condition: none.
    (
        "door-two-hinges",
        {
            "upper": [
                *(f"no displacement along {axis} of the common point (0, 0, 2)" for axis in "xyz"),
                "no rotation about (1, 0, 0)",
                "no rotation about (0, 1, 0)",
            ]
        },
    ),
    # With the hinge off the axis by 1/10 along x, the turn about z moves it along y: that equation is needed.
    (
        "door-hinges-out-of-line",
        {
            "upper": [
                "no displacement along x of the common point (1/10, 0, 2)",
                "no displacement along z of the common point (1/10, 0, 2)",
                "no rotation about (1, 0, 0)",
                "no rotation about (0, 1, 0)",
            ]
        },
    ),
    # Six distances of four points in the plane: 2 * 4 - 3 are independent.
    ("complete-framework-4-points-in-2d", {"rigid": ["the distance C-D"]}),
]


@pytest.mark.parametrize(("name", "expected"), EQUATIONS, ids=[row[0] for row in EQUATIONS])
def test_redundant_equations_are_named(name: str, expected: dict[str, list[str]]) -> None:
    entries = told(name).constraints
    assert {e.name: e.redundant_equations for e in entries if e.redundant_equations} == expected
    assert all(e.redundant_equations == [] for e in entries if e.name not in expected)
    for entry in entries:
        if entry.name in expected and entry.equations > 1:
            assert expected[entry.name][-1] in entry.reason


@pytest.mark.parametrize("texts", [[], ["phi_a = 0"]], ids=["turned from the drawing", "by Euler angles"])
def test_the_axis_of_a_redundant_rotation_is_its_own(texts: list[str]) -> None:
    """A hinge about z leaves the turn about z, one about x that about x: both keep the body from turning about y."""
    hinges = [
        {"name": name, "type": "revolute", "between": ["ground", "a"], "at": [0, 0, 0], "axis": axis}
        for name, axis in (("upright", [0, 0, 1]), ("level", [1, 0, 0]))
    ]
    scene = {"bodies": ["a"], "constraints": [*hinges, *texts], "configuration": {"theta_a": "pi/2"}}
    named = dofkit.classify(scene).constraints[1].redundant_equations
    assert [n for n in named or [] if "rotation" in n] in (
        ["no rotation about (0, 1, 0)"],
        ["no rotation about (0, -1, 0)"],
    )


def test_texts_keep_what_they_say_in_general_position() -> None:
    """A bead on a circle, and a rod from it to a bead on a line: 2 + 2 - 3, anywhere."""
    scene = {
        "dimension": 2,
        "particles": [{"name": "A", "at": [0, 1]}, {"name": "B", "at": [2, 0]}],
        "constraints": ["x_A^2 + y_A^2 = 1", "y_B = 0", {"type": "link", "between": ["A", "B"]}],
    }
    found = dofkit.classify(dofkit.load(scene)).generic
    assert found is not None
    assert (found.dof, found.redundant_equations, found.differs) == (1, 0, None)


def test_without_a_drawing_there_is_no_general_position_beside_it() -> None:
    scene = {"dimension": 2, "particles": ["A", "B"], "constraints": [{"type": "link", "between": ["A", "B"]}]}
    assert dofkit.classify(dofkit.load(scene)).generic is None


# The velocities of connections, written without angles, against those of the engines


def drawn_rank(system: System) -> int | None:
    """The rank of all connections' relations between twists, where they are drawn."""
    placement = reference_placement(system, frozenset())
    assert placement is not None
    p = placement.p
    rows = []
    for found in placement.located:
        own = rows_of(found)
        if own is None:
            return None
        rows += [{c: v % p for c, v in row.items() if v % p} for row in own]
    return rank_of_rows(rows, p)


@pytest.mark.parametrize("path", [path for path in OURS if path.parent.name in ("mechanisms", "textbook")], ids=stem)
def test_twists_have_the_rank_of_the_coordinates(path: Path) -> None:
    """In scenes that say what the first order is where all is drawn exactly."""
    scene = scene_of(path)
    first = scene.expect.get("instantaneous_dof")
    if first is None or scene.tolerance is not None or any(c.facts.velocities is None for c in scene.constraints):
        return
    system = lower(scene)
    rank = drawn_rank(system)
    assert rank is not None
    assert len(system.coordinates) - rank == first


def test_every_type_is_known_as_a_connection_or_as_a_text() -> None:
    without = {kind for kind, cls in TYPES.items() if cls.facts.velocities is None}
    assert without == {"equation", "on", "string", "roll"}
    assert all("facts" in vars(cls) for cls in TYPES.values())


# No more than the scene needs


def cranks(more: list[dict[str, Any]] | None = None, bodies: list[str] | None = None) -> Report:
    """A rod on three parallel cranks, hinged, and what hangs on it."""
    joints = [("ground", "k1", [0, 0]), ("k1", "rod", [1, 2]), ("ground", "k2", [3, 0]), ("k2", "rod", [4, 2])]
    joints += [("ground", "k3", [7, 1]), ("k3", "rod", [8, 3])]
    constraints: list[dict[str, Any]] = [{"type": "revolute", "between": [a, b], "at": at} for a, b, at in joints]
    names = ["k1", "k2", "k3", "rod", *(bodies or [])]
    return dofkit.classify(dofkit.load({"dimension": 2, "bodies": names, "constraints": [*constraints, *(more or [])]}))


def test_a_tree_that_hangs_on_a_mechanism_changes_none_of_its_verdicts() -> None:
    """60 pendulums in a chain under the rod: 60 more freedoms, as sure as without them."""
    names = [f"p{i}" for i in range(60)]
    chain = [
        {"type": "revolute", "between": [names[i - 1] if i else "rod", name], "at": [4, 2 - i]}
        for i, name in enumerate(names)
    ]
    alone, hung = cranks(), cranks(chain, names)
    assert (alone.dof, hung.dof) == (1, 61)
    assert (alone.verdict, alone.redundant_equations) == (hung.verdict, hung.redundant_equations)


def test_a_grid_of_squares_with_braces_is_settled() -> None:
    """Squares with braces, the rows and columns a graph (Bolker and Crapo).

    Without braces 12 rows and columns turn by an angle each, and the whole shifts: 14. The braces at (0, 0), (0, 1),
    (1, 0) hold two rows and two columns to one angle, which leaves 11, and the one at (1, 1) is too many.
    """
    n = 6
    particles = [{"name": f"p{i}_{j}", "at": [i, j]} for i in range(n + 1) for j in range(n + 1)]
    links = [(f"p{i}_{j}", f"p{i + 1}_{j}") for i in range(n) for j in range(n + 1)]
    links += [(f"p{i}_{j}", f"p{i}_{j + 1}") for i in range(n + 1) for j in range(n)]
    links += [(f"p{i}_{j}", f"p{i + 1}_{j + 1}") for i in (0, 1) for j in (0, 1)]
    constraints = [{"type": "link", "between": list(pair)} for pair in links]
    report = dofkit.classify(dofkit.load({"dimension": 2, "particles": particles, "constraints": constraints}))
    assert (report.dof, report.instantaneous_dof) == (11, 11)
    # 98 coordinates, 88 links: one of them does nothing at this drawing.
    assert report.redundant_equations == 1
    assert "are in no dependent set" in report.modelled


DEPENDENT = [
    "bennett-driven",
    "dixon-first-k44",
    "four-cranks-parallel",
    "gimbal-lock",
    "hart-inversor-guided",
    "kempe-reversor",
    "oldham-coupling-space",
    "pantograph-with-two-guides",
    "pentagon-with-all-diagonals",
    swept("spherical-four-bar-stretched"),
    "square-bracing-with-crossed-diagonals",
    "tarnai-ring",
    "three-cranks-in-line",
]


@pytest.mark.parametrize("name", spread(DEPENDENT))
def test_looking_at_dependent_relations_alone_changes_nothing(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    apart = told(name)
    monkeypatch.setattr(local, "_by_classes", lambda *_: None)
    whole = dofkit.classify(dofkit.load(next(SCENES.glob(f"*/{name}.yaml"))))
    kept = (
        "consistent",
        "dof",
        "velocity_dof",
        "instantaneous_dof",
        "singular",
        "redundant",
        "redundancies",
        "generic",
    )
    for field in kept:
        assert getattr(apart, field) == getattr(whole, field)
    assert apart.constraints == whole.constraints


# Nearly special drawings


def three_bars(off: str, scale: int = 1, tolerance: float | None = None) -> Report:
    """A body on three bars whose lines meet in (0, 0), but that the third is drawn off by a little."""
    bars = [("1", "0", "2", "0"), ("0", "1", "0", "3"), ("-1", "-1", "-2", f"-2 + {off}")]
    constraints = [
        {
            "type": "link",
            "between": [
                [f"{scale} * ({c})", f"{scale} * ({d})"],
                {"on": "body", "at": [f"{scale} * ({a})", f"{scale} * ({b})"]},
            ],
        }
        for a, b, c, d in bars
    ]
    scene: dict[str, Any] = {"dimension": 2, "bodies": ["body"], "constraints": constraints}
    return dofkit.classify(dofkit.load(scene if tolerance is None else scene | {"tolerance": tolerance}))


@pytest.mark.parametrize("off", ["10^-4", "10^-7", "10^-10"])
@pytest.mark.parametrize("scale", [1, 1000])
def test_a_near_dependence_suggests_a_tolerance(off: str, scale: int) -> None:
    exact = three_bars(off, scale)
    assert exact.instantaneous_dof == 0
    said = next(warning for warning in exact.warnings if "nearly dependent" in warning)
    suggested = float(said.partition("`tolerance: ")[2].partition("`")[0])
    assert three_bars(off, scale, suggested).instantaneous_dof == 1


@pytest.mark.parametrize("off", ["0", "1/10", "1"])
def test_what_is_special_or_far_from_it_is_not_nearly_so(off: str) -> None:
    assert not any("nearly dependent" in warning for warning in three_bars(off).warnings)


@pytest.mark.sweep
def test_no_scene_of_the_tables_is_nearly_dependent() -> None:
    names = [row[0] for row in COUNTS] + [row[0] for row in GENERIC]
    assert not any("nearly dependent" in warning for name in names for warning in told(name).warnings)


def test_a_small_body_in_a_large_scene_is_not_nearly_dependent() -> None:
    """A wheel of size 1/1000, far out, on a frame of size 1: only its sizes differ."""
    scene = {
        "dimension": 2,
        "bodies": ["frame", "wheel"],
        "constraints": [
            {"type": "revolute", "between": ["ground", "frame"], "at": [0, 0]},
            {"type": "revolute", "between": ["frame", "wheel"], "at": [1, 0]},
            {"type": "link", "between": [[2, 0], {"on": "wheel", "at": ["1001/1000", "1/2000"]}]},
        ],
    }
    report = dofkit.classify(dofkit.load(scene))
    assert report.instantaneous_dof == 1
    assert not any("nearly dependent" in warning for warning in report.warnings)


def test_what_is_rigid_is_one_body() -> None:
    """A square with both diagonals, rigid with one bar too many, and a swinging triangle at its corner."""
    names = "ABCDEF"
    places = [[0, 0], [3, 0], [3, 3], [0, 3], [5, 4], [4, 6]]
    pairs = ["AB", "BC", "CD", "DA", "AC", "BD", "CE", "EF", "FC"]
    scene = {
        "dimension": 2,
        "particles": [{"name": n, "at": at} for n, at in zip(names, places, strict=True)],
        "constraints": [{"type": "link", "between": list(pair)} for pair in pairs],
    }
    report = dofkit.classify(dofkit.load(scene))
    assert (report.dof, report.verdicts["dof"].verdict, report.redundant) == (4, "proved", ["c6"])
    assert "3 of 9 relations are in no dependent set" in report.modelled


def test_a_driven_count_adds_up() -> None:
    """Bennett's loop with one hinge driven: 3(4 - 1 - 4) + 4 - 1 = 0."""
    found = told("bennett-driven").mobility
    assert found is not None
    assert found.differs is not None
    assert found.differs.endswith("3(4 - 1 - 4) + 4 - 1 = 0")


def test_both_counts_and_why_they_err_are_shown() -> None:
    text = " ".join(as_text(sheet_of_report(told("sarrus-linkage")), 200).split())
    assert "Gruebler-Kutzbach M = 6(N - 1 - j) + sum f = 6(6 - 1 - 6) + 6 = 0" in text
    assert "with 5 in place of 6 the count is 5(6 - 1 - 6) + 6 = 1" in text
    assert "generic mobility 0 " in text
    assert "1 of its 5 equations is implied by the preceding ones: no rotation about (0, 0, 1)" in text


def slide(name: str, between: list[str], axis: list[int]) -> dict[str, Any]:
    return {"name": name, "type": "prismatic", "between": between, "axis": axis}


#: Two slides at a right angle.
CROSSED = [slide("p", ["ground", "a"], [1, 0, 0]), slide("q", ["a", "b"], [0, 1, 0])]


def test_three_slides_lie_in_a_plane_by_chance_and_two_always() -> None:
    wedges = [*CROSSED, slide("r", ["b", "ground"], [1, 1, 0])]
    report = dofkit.classify({"bodies": ["a", "b"], "constraints": wedges})
    assert report.generic is not None
    assert report.generic.differs is not None
    assert report.generic.differs.endswith("p, q and r slide parallel to one plane")
    bar = {"type": "link", "between": [{"on": "b", "at": [0, 0, 0]}, [0, 0, 3]]}
    report = dofkit.classify({"bodies": ["a", "b"], "constraints": [*CROSSED, bar]})
    assert report.generic is not None
    assert report.generic.differs is not None
    assert "plane" not in report.generic.differs


@pytest.mark.parametrize(("height", "said"), [("1/10^6", True), ("1/10^3", False), ("1/2", False)])
def test_bars_nearly_in_line_are_said_to_be(height: str, said: bool) -> None:
    """Two bars at an angle of 4 h hold P up: their rows of length 1 have a singular value of 4 h/sqrt(2), less beside
    a third bar; the other one is near sqrt(2)."""
    points = {"P": ["1/2", height], "Q": [3, 3], "R": [5, 0]}
    bars: list[list[Any]] = [[[0, 0], "P"], ["P", [1, 0]], ["P", "Q"], ["Q", "R"]]
    report = dofkit.classify(
        {
            "dimension": 2,
            "particles": [{"name": name, "at": at} for name, at in points.items()],
            "constraints": [{"type": "link", "between": pair} for pair in bars],
        }
    )
    assert (report.dof, report.instantaneous_dof) == (2, 2)
    small = r"nearly dependent at the reference configuration \(singular values of (\S+) beside"
    values = [float(match[1]) for match in (re.search(small, w) for w in report.warnings) if match]
    assert bool(values) == said
    assert all(1e-6 < v < 2.9e-6 for v in values)


def test_a_body_that_is_fixed_keeps_its_origin_and_its_turn() -> None:
    """v at the point that its coordinates tell, wherever that stands, and w."""
    scene = {
        "dimension": 2,
        "bodies": ["b"],
        "constraints": [{"type": "fixed", "body": "b"}],
        "configuration": {"x_b": 3, "y_b": 4},
    }
    placement = reference_placement(lower(dofkit.load(scene)), frozenset())
    assert placement is not None
    rows = rows_of(placement.located[0])
    assert rows is not None
    assert [{c: v for c, v in row.items() if v != 0} for row in rows] == [{0: 1}, {1: 1}, {2: 1}]
