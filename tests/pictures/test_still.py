"""Still pictures: what they say of a report, in colour, pattern and words, and the files they are written to."""

from __future__ import annotations

import io
import re
from itertools import combinations, product
from pathlib import Path
from typing import Any, get_args
from xml.etree import ElementTree

import numpy as np
import pytest

import dofkit
from dofkit.base.errors import ArgumentError
from dofkit.pictures import stage
from dofkit.pictures.arrangement import SCHEMATIC
from dofkit.pictures.files import ExtraMissingError
from dofkit.pictures.layout import page_of
from dofkit.pictures.mechanism import FREE_PLACES
from dofkit.pictures.paper import FLAT, HIGH, Page, outline, width_of
from dofkit.pictures.shapes import ON_DARK, Role, Shape, State, ink_of, keys_of
from dofkit.pictures.stage import POINT
from dofkit.pictures.still import Picture
from dofkit.report import FieldVerdict

DOOR: dict[str, Any] = {
    "title": "A door",
    "bodies": ["door"],
    "constraints": [
        {"name": "lower", "type": "revolute", "between": ["ground", "door"], "at": [0, 0, 0], "axis": [0, 0, 1]},
        {"name": "upper", "type": "revolute", "between": ["ground", "door"], "at": [0, 0, 2], "axis": [0, 0, 1]},
    ],
}
APART: dict[str, Any] = {
    "dimension": 2,
    "particles": [{"name": "A", "at": [0, 0]}, {"name": "B", "at": [3, 0]}, "C"],
    "constraints": [
        {"name": "AB", "type": "link", "between": ["A", "B"]},
        {"name": "AC", "type": "link", "between": ["A", "C"], "length": 1},
        {"name": "BC", "type": "link", "between": ["B", "C"], "length": 1},
    ],
}
SVG = "{http://www.w3.org/2000/svg}"


def states(picture: Picture) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {}
    for shape in picture.sketch.shapes:
        if shape.kind != "words":
            found.setdefault(shape.owner, set()).add(shape.state)
    return found


def test_redundant_and_moving_parts_are_told() -> None:
    found = states(dofkit.draw(DOOR))
    assert found["upper"] == {"redundant"}
    assert found["lower"] == {"plain"}
    assert found["door"] == {"moving"}


def test_conflicting_parts_are_told() -> None:
    found = states(dofkit.draw(APART))
    assert found["AB"] == found["AC"] == found["BC"] == {"conflicting"}
    assert found["C"] == {"plain"}


def test_states_differ_by_pattern_not_by_colour_alone() -> None:
    shape = next(s for s in dofkit.draw(APART).sketch.shapes if s.owner == "AB" and s.kind == "line")
    inks = [ink_of(shape._replace(state=state)) for state in ("plain", "redundant", "conflicting")]
    assert len({ink.dash for ink in inks}) == 3
    body = next(s for s in dofkit.draw(DOOR).sketch.shapes if s.role == "body")
    assert not ink_of(body).hatch
    assert ink_of(body._replace(state="plain")).hatch


def linear(colour: str) -> list[float]:
    """Red, green and blue as linear light."""
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    return [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]


def brightness(colour: str) -> float:
    """The relative luminance of the guidelines for content of the web (WCAG 2)."""
    return sum(w * p for w, p in zip((0.2126, 0.7152, 0.0722), linear(colour), strict=True))


def contrast(one: str, other: str) -> float:
    low, high = sorted(map(brightness, (one, other)))
    return (high + 0.05) / (low + 0.05)


def test_every_line_and_name_is_as_clear_on_dark_paper() -> None:
    """A ratio of 3 is enough for what is drawn, and 4.5 for what is read."""
    for role, state in product(get_args(Role), get_args(State)):
        ink = ink_of(Shape("line", (), role, state))
        wanted = 4.5 if role == "name" else min(3.0, contrast(ink.line, "#FFFFFF"))
        assert contrast(ON_DARK[ink.line], ON_DARK["#FFFFFF"]) >= wanted, role
        assert ink.fill is None or ink.fill in ON_DARK


#: What those without one kind of cones see (Machado, Oliveira and Fernandes 2009), from linear light to linear light.
COLOUR_BLIND = {
    "deuteranopia": [[0.3673, 0.8606, -0.2280], [0.2801, 0.6725, 0.0474], [-0.0118, 0.0429, 0.9690]],
    "protanopia": [[0.1523, 1.0526, -0.2049], [0.1145, 0.7863, 0.0992], [-0.0039, -0.0481, 1.0520]],
}
TO_XYZ = [[0.4339, 0.3762, 0.1899], [0.2126, 0.7152, 0.0722], [0.0177, 0.1095, 0.8728]]


@pytest.mark.parametrize("kind", COLOUR_BLIND)
def test_the_colour_blind_can_tell_what_moves_is_redundant_or_conflicts(kind: str) -> None:
    """Differences are those of CIE 1976 (L*, a*, b*), of which 20 is plain to see; patterns differ besides."""

    def seen(colour: str) -> np.ndarray:
        x, y, z = np.cbrt(np.array(TO_XYZ) @ np.clip(np.array(COLOUR_BLIND[kind]) @ linear(colour), 0.01, 1))
        return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])

    inks = [ink_of(Shape("hull", (), "body", state)) for state in ("plain", "moving")]
    inks += [ink_of(Shape("line", (), "bar", state)) for state in ("redundant", "conflicting")]
    for first, second in combinations(inks, 2):
        for one, other in ((first.line, second.line), (ON_DARK[first.line], ON_DARK[second.line])):
            assert np.linalg.norm(seen(one) - seen(other)) > 20
        assert (first.dash, first.hatch) != (second.dash, second.hatch)


def test_a_typesetter_that_knows_no_light_and_dark_has_white_paper(tmp_path: Path) -> None:
    from PIL import Image
    from typst import compile as typeset

    dofkit.draw(DOOR).save(tmp_path / "a.svg")
    (tmp_path / "a.typ").write_text('#image("a.svg")', encoding="utf-8")
    with Image.open(io.BytesIO(typeset(tmp_path / "a.typ", format="png", ppi=36))) as image:
        dark = sum(image.convert("L").histogram()[:64]) / (image.width * image.height)
    assert 0 < dark < 0.05


def test_the_alternative_text_states_the_answer() -> None:
    told = dofkit.draw(DOOR).alternative
    assert told.startswith("A door: 1 body, 2 constraints. 1 degree of freedom (")
    assert re.search(r"Redundant( \(probable\))?: upper\.$", told) is not None
    assert dofkit.draw(APART).alternative.split(". ")[1] == "no motion: AB, AC, BC contradict each other (proved)."


def legend(picture: Picture) -> set[str]:
    return {text for _, text in keys_of(picture.sketch.shapes, picture.sketch.meanings)}


def test_a_picture_is_no_surer_than_its_report() -> None:
    """What the report says less surely is said so in the answer, the alternative text, the notes and the legend."""
    report = dofkit.classify(DOOR)
    weaker = FieldVerdict(verdict="probable", argument="rows at a point", bound="2^-29")
    report = report.model_copy(update={"verdict": "probable", "verdicts": {**report.verdicts, "redundant": weaker}})
    picture = dofkit.draw(DOOR, report)
    assert picture.sketch.answer == "1 degree of freedom (probable)"
    assert picture.alternative.endswith("1 degree of freedom (probable). Redundant (probable): upper.")
    assert legend(picture) == {"mobile", "redundant or partly redundant (probable)"}
    assert dofkit.graph(DOOR, report).sketch.notes == ("upper depends on lower (probable).",)


def test_what_is_undecided_is_not_said_to_move() -> None:
    open_fields = {"dof": None, "velocity_dof": None, "instantaneous_dof": None, "verdict": "undecided"}
    picture = dofkit.draw(DOOR, dofkit.classify(DOOR).model_copy(update=open_fields))
    assert picture.sketch.answer == "number of degrees of freedom undecided"
    assert "degree of freedom" not in picture.alternative
    assert "infinitesimally mobile; finite motion undecided" in legend(picture)
    told = dofkit.classify(DOOR).model_copy(update={"consistent": None, "verdict": "undecided"})
    assert dofkit.draw(DOOR, told).sketch.answer == "1 degree of freedom, if the constraints are consistent (undecided)"


def test_a_shake_is_no_motion() -> None:
    """Two links in line: the joint between them has an infinitesimal motion and no finite one."""
    ends = [{"name": n, "at": [x, 0]} for n, x in (("A", 0), ("B", 1), ("C", 2))]
    held = [{"type": "fixed", "point": "A"}, {"type": "fixed", "point": "C"}]
    links = [{"type": "link", "between": list(pair)} for pair in ("AB", "BC")]
    picture = dofkit.draw({"dimension": 2, "particles": ends, "constraints": [*held, *links]})
    assert picture.sketch.answer.startswith(
        "0 degrees of freedom, instantaneous freedom 1 at this singular configuration"
    )
    assert {"infinitesimally mobile", "immobile"} <= legend(picture)


def test_inequalities_that_cannot_be_met_are_no_motion() -> None:
    scene = {"coordinates": ["x", "y"], "constraints": ["x >= 1", "x <= 0"]}
    picture = dofkit.draw(scene)
    assert picture.sketch.answer == "no motion: c1, c2 cannot be satisfied together (proved)"
    assert picture.sketch.notes[0] == SCHEMATIC
    assert not legend(picture) & {"mobile", "immobile"}
    assert dofkit.animate(scene).clips == ()


def test_what_was_not_looked_at_is_not_held_still(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stage, "MOST_COLUMNS", 5)
    picture = dofkit.draw(DOOR)
    assert not legend(picture) & {"mobile", "immobile"}
    assert stage.TOO_MANY in picture.sketch.notes


def test_what_is_redundant_in_part_is_reported() -> None:
    """A third parallel crank: one equation too many, and no joint that could be left out."""
    cranks = [("a", 0), ("b", 2), ("c", 4)]
    joints = [{"name": f"{k}0", "type": "revolute", "between": ["ground", k], "at": [x, 0]} for k, x in cranks]
    joints += [{"name": f"{k}1", "type": "revolute", "between": [k, "bar"], "at": [x, 1]} for k, x in cranks]
    picture = dofkit.draw({"dimension": 2, "bodies": ["a", "b", "c", "bar"], "constraints": joints})
    assert re.search(r"Partly redundant( \(probable\))?: c1\.", picture.alternative) is not None
    assert "Redundant:" not in picture.alternative
    assert states(picture)["c1"] == {"redundant"}


def test_chosen_places_and_numbers_are_told() -> None:
    notes = dofkit.draw("simple-pendulum-link").sketch.notes
    assert notes == (
        "The scene gives no positions: those drawn were chosen to satisfy its constraints.",
        "Drawn with l = 1.",
    )
    ends = [["ground", "a"], ["a", "b"], ["b", "ground"]]
    chain = {"dimension": 2, "bodies": ["a", "b"], "constraints": [{"type": "revolute", "between": e} for e in ends]}
    assert FREE_PLACES in dofkit.draw(chain).sketch.notes
    assert dofkit.draw("four-bar-linkage").sketch.notes == ()


def test_coordinates_alone_show_their_set() -> None:
    sketch = dofkit.draw({"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1"]}).sketch
    curve = [sketch.at(v) for s in sketch.shapes if s.role == "locus" for v in s.vertices]
    assert len(curve) > 30
    assert all(x * x + y * y == pytest.approx(1, abs=2e-2) for x, y, _ in curve)
    assert {v.carrier for s in sketch.shapes if s.kind == "ball" for v in s.vertices} == {POINT}


def test_a_pole_is_no_curve() -> None:
    sketch = dofkit.draw({"coordinates": ["x", "y"], "constraints": ["1/x = y"]}).sketch
    curve = [sketch.at(v) for s in sketch.shapes if s.role == "locus" for v in s.vertices]
    assert curve
    assert all(abs(x * y - 1) < 0.1 for x, y, _ in curve)


def test_surfaces_of_space_meet_in_a_curve() -> None:
    sketch = dofkit.draw("particle-on-latitude").sketch  # R = 1, z = sin(1)
    curve = [sketch.at(v) for s in sketch.shapes if s.role == "locus" for v in s.vertices]
    assert len(curve) > 30
    assert all(x * x + y * y == pytest.approx(0.2919, abs=1e-3) for x, y, _ in curve)  # cos(1)^2
    assert all(z == pytest.approx(0.8415, abs=1e-3) for _, _, z in curve)


def test_a_moving_curve_is_smooth() -> None:
    """A circle through fifteen points: its outline stays within 1/200 of it, where chords would leave 1/40."""
    hoop = {"curve": "hoop", "at": ["x + sin(u)", "cos(u)"], "range": {"u": [0, "2 pi"]}}
    sketch = dofkit.draw({"coordinates": ["x"], "configuration": {"x": 0}, "picture": [hoop]}).sketch
    (curve,) = (s for s in sketch.shapes if s.kind == "curve")
    far = np.linalg.norm(outline(sketch, curve, sketch.poses, FLAT), axis=1)
    assert np.max(np.abs(far - 1)) < 1 / 200


@pytest.mark.parametrize("odd", [{"dimension": 2}, {"coordinates": ["x"], "constraints": ["x^2 = 4"]}])
def test_odd_scenes_are_drawn(odd: dict[str, Any]) -> None:
    for door in (dofkit.draw, dofkit.graph):
        assert ElementTree.fromstring(door(odd).svg()).tag == f"{SVG}svg"


# -- on paper --------------------------------------------------------------------------------------


def boxes(page: Page) -> list[tuple[float, float, float, float, str]]:
    found = []
    for mark in page.marks:
        if mark.text:
            (x, y), wide = mark.positions[0], width_of(mark.text, mark.size)
            left = {"start": x, "middle": x - wide / 2, "end": x - wide}[mark.align]
            found.append((left, left + wide, y, y + mark.size * (HIGH - 0.4), mark.text))
    return found


@pytest.mark.parametrize("name", ["four-bar-linkage", "planetary-gear-bodies", "rccc-linkage", "slider-crank"])
def test_names_do_not_overlap_and_stay_on_the_sheet(name: str) -> None:
    page = page_of(dofkit.draw(name).sketch)
    for a, b in combinations(boxes(page), 2):
        apart = a[1] <= b[0] or b[1] <= a[0] or a[3] <= b[2] or b[3] <= a[2]
        assert apart, (a[4], b[4])
    positions = [p for mark in page.marks for p in mark.positions]
    assert all(0 <= x <= page.width and 0 <= y <= page.height for x, y in positions)


# -- files -----------------------------------------------------------------------------------------


HOSTILE: dict[str, Any] = {
    "title": "<script>alert(1)</script> & $x^2$ @data@",
    "dimension": 2,
    "particles": ["P"],
    "constraints": [{"name": "</script><b>&", "type": "link", "between": [[0, 0], "P"], "length": 1}],
}


def test_names_are_text_and_never_markup() -> None:
    root = ElementTree.fromstring(dofkit.draw(HOSTILE).svg())
    assert root.findtext(f"{SVG}title") == HOSTILE["title"]
    assert not root.findall(f".//{SVG}script")
    graph = dofkit.graph(HOSTILE).svg()
    assert graph.count("<script>") == graph.count("</script>") == 1
    page = dofkit.animate(HOSTILE).html()
    assert "<script>alert" not in page
    assert page.count("</script>") == 2
    assert "@data@" in page.split("<canvas")[0]


def test_png_holds_its_alternative_text(tmp_path: Path) -> None:
    from PIL import Image

    path = dofkit.draw("four-bar-linkage").save(tmp_path / "a.png")
    with Image.open(path) as image:
        assert image.size[0] > 900
        assert image.info["Title"] == "Planar four-bar linkage"
        assert image.info["Description"].endswith("1 degree of freedom (proved).")


def test_other_files(tmp_path: Path) -> None:
    picture = dofkit.draw(DOOR)
    assert picture.save(tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")
    page = picture.save(tmp_path / "a.html").read_text(encoding="utf-8")
    assert "<canvas" in page
    assert "src=" not in page
    assert "href=" not in page
    assert '<iframe class="dofkit-picture" srcdoc=' in picture._repr_html_()
    assert dofkit.draw("four-bar-linkage")._repr_html_().startswith("<svg")
    assert (picture._repr_png_() or b"").startswith(b"\x89PNG")
    with pytest.raises(ArgumentError, match=r"there is no ending '\.jpg'"):
        picture.save(tmp_path / "a.jpg")


def test_without_matplotlib_what_needs_it_says_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("dofkit.pictures.files.find_spec", lambda name: None)
    picture = dofkit.draw("four-bar-linkage")
    picture.save(tmp_path / "a.svg")
    assert picture._repr_png_() is None
    for name in ("a.png", "a.pdf"):
        with pytest.raises(ExtraMissingError, match=r"needs matplotlib: pip install 'dofkit\[pictures\]'"):
            picture.save(tmp_path / name)
    with pytest.raises(ExtraMissingError, match=r"pip install 'dofkit\[pictures\]'"):
        dofkit.draw({"coordinates": ["x", "y"], "constraints": ["x^2 + y^2 = 1"]})
    with pytest.raises(ExtraMissingError, match=r"pip install 'dofkit\[pictures\]'"):
        dofkit.animate("four-bar-linkage").save(tmp_path / "a.gif")


# -- graphs ----------------------------------------------------------------------------------------


def test_the_graph_joins_constraints_to_what_they_hold() -> None:
    picture = dofkit.graph("four-bar-linkage")
    drawn = [s for s in picture.sketch.shapes if s.kind == "line"]
    assert len(drawn) == 8  # four hinges, two bodies each
    assert {s.owner for s in picture.sketch.shapes if s.kind == "ball"} == {"ground", "crank", "coupler", "rocker"}


def test_circuits_are_told_and_lit() -> None:
    picture = dofkit.graph(DOOR)
    assert picture.sketch.notes[0].startswith("upper depends on lower")
    assert '{"upper": ["upper", "lower"]}' in picture.svg()
    assert picture._repr_html_().partition("</style>")[2].startswith("<iframe")


@pytest.mark.sweep
@pytest.mark.parametrize("name", dofkit.catalog_names())
def test_the_whole_catalog_is_drawn(name: str, tmp_path: Path) -> None:
    picture = dofkit.draw(name)
    root = ElementTree.fromstring(picture.svg())
    assert root.findtext(f"{SVG}desc") == picture.alternative
    assert picture.save(tmp_path / "a.png").stat().st_size > 8000
    positions = [p for mark in picture.page.marks for p in mark.positions]
    assert all(0 <= x <= picture.page.width and 0 <= y <= picture.page.height for x, y in positions)
    texts = [box for box in boxes(picture.page) if box[4]]
    overlapping = [
        (a[4], b[4])
        for a, b in combinations(texts, 2)
        if min(a[1], b[1]) - max(a[0], b[0]) > 2 and min(a[3], b[3]) - max(a[2], b[2]) > 2
    ]
    assert not overlapping
    ElementTree.fromstring(dofkit.graph(name).svg())
