"""Reading: what may be written, what is refused, and where each fault is."""

from __future__ import annotations

import json
import os
import re
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import pytest
import yaml
from shared.known_scenes import EVERY, stem

import dofkit
from dofkit.base.documents import read_document
from dofkit.base.errors import Fault, SceneError
from dofkit.base.yaml_events import ComposedText, compose
from dofkit.interface.explanations import explanations_of
from dofkit.scene.catalog import find
from dofkit.scene.reading import MOST_FAULTS, SceneFile, load, loads
from dofkit.scene.scene import Scene

HERE = Path(__file__).parents[1]


def faults(data: bytes | str) -> tuple[Fault, ...]:
    with pytest.raises(SceneError) as caught:
        loads(data, "bad")
    return caught.value.faults


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-6", Decimal("1e-6")), ("1.0e-5", Decimal("1.0e-5")), (".5", Decimal("0.5")), ("1.", Decimal(1)),
        ("-.5", Decimal("-0.5")), ("0o17", 15), ("0x1F", 31), ("017", 17), ("+1", 1), ("1_000", "1_000"),
        ("0.1", Decimal("0.1")), ("on", "on"), ("off", "off"), ("yes", "yes"), ("no", "no"), ("y", "y"), ("n", "n"),
        ("~", None), ("null", None), ("true", True), ("2001-01-01", "2001-01-01"), ("1:30", "1:30"), ("=", "="),
        ("'1'", "1"), ('"1"', "1"), ('"a\\tb\\u00e9\\"\\\\"', 'a\tbé"\\'), ('"\\ud83d\\ude00"', "😀"), ("''''", "'"),
        ("-x", "-x"), ("...x", "...x"), ("a b", "a b"), ("x^2 + y^2 = 1", "x^2 + y^2 = 1"), ("!!str 1", "1"),
        ("[1, [2, 3], {a: b}]", [1, [2, 3], {"a": "b"}]), ("[]", []), ("{}", {}), ("|\n  a\n  b", "a\nb\n"),
        ("[a, b,]", ["a", "b"]), ("{a: , b: 1}", {"a": None, "b": 1}), ('{"a":1}', {"a": 1}), ("{a:b}", {"a:b": None}),
    ],
)  # fmt: skip
def test_scalars_follow_the_core_schema_exactly(text: str, value: object) -> None:
    for written in (f"k: {text}\n", f"k:\n- {text}\n"):
        document = read_document(written, "x")
        expected = value if written.startswith("k: ") else [value]
        assert document.faults == ()
        assert document.value["k"] == expected
        assert type(document.value["k"]) is type(expected)


def test_numbers_never_pass_through_floats() -> None:
    scene = loads("dimension: 1\nparticles: [{name: A, at: [0.1]}, {name: B, at: [1e-30]}]")
    assert [particle.at for particle in scene.particles] == [(Fraction(1, 10),), (Fraction(1, 10**30),)]


JSON_TEXTS = [
    '{"coordinates": ["x"], "constraints": []}',
    '{\n\t"coordinates":\t["x"],\r\n\t"constraints" : [ "x = 1" ]\n}\n',
    '{"coordinates": ["x\\u0031"], "title": "a \\/ \\"b\\" \\n c: d # e", "configuration": {"x1": -1.50E+2}}',
    '{"title": "\\ud83d\\ude00", "tolerance": 0.001, "dimension": 2, "notes": null}',
]


@pytest.mark.parametrize("text", JSON_TEXTS)
def test_json_reads_as_json(text: str) -> None:
    assert read_document(text, "x").value == json.loads(text, parse_float=Decimal)
    assert isinstance(loads(text), Scene)


@pytest.mark.parametrize("path", EVERY, ids=stem)
def test_a_scene_reads_alike_in_yaml_and_json(path: Path) -> None:
    """Also by PyYAML's own parser, which is asked where libyaml's finds an error."""
    text = path.read_text(encoding="utf-8")
    document, slow = read_document(text, "x"), ComposedText(text, yaml.SafeLoader)
    assert slow.value == document.value
    assert slow.places == document.places
    assert document.faults == ()
    written = json.dumps(document.value, default=float, ensure_ascii=False)
    as_json = read_document(written, "x")
    assert as_json.faults == ()
    assert compose(written).value == as_json.value
    assert set(as_json.places) == set(document.places)


BAD = {
    "empty": (b"", 1, 1, "empty"),
    "blank": (b" \n\n", 1, 1, "empty"),
    "only a comment": (b"# nothing\n", 1, 1, "mapping"),
    "list": (b"- x\n", 1, 1, "mapping"),
    "text": (b"just words\n", 1, 1, "mapping"),
    "null": (b"---\n", 2, 1, "mapping"),
    "unknown key": (b"coordinates: [x]\nconstrains: []\n", 2, 1, "'constrains'"),
    "duplicate key": (b"coordinates: [x]\ntitle: a\ncoordinates: [y]\n", 3, 1, "'coordinates'"),
    "duplicate key in brackets": (b"particles:\n- {name: A, name: B}\n", 2, 13, "'name'"),
    "duplicate key in JSON": (b'{"coordinates": ["x"],\n "coordinates": ["y"]}', 2, 2, "'coordinates'"),
    "nul": (b"coordinates: [x]\ntitle: 'a\0b'\n", 2, 10, "U+0000"),
    "escape character": (b"title: \x1b[31m\n", 1, 8, "U+001B"),
    "latin-1": (b"coordinates: [x]\ntitle: caf\xe9\n", 2, 11, "UTF-8"),
    "utf-16": ("coordinates: [x]".encode("utf-16"), 1, 1, "UTF-16"),
    "tab": (b"configuration:\n\tx: 1\n", 2, 1, "tab"),
    "unclosed bracket": (b"coordinates: [x, y\ntitle: a\n", 2, 6, "line 1's bracket"),
    "unclosed quote": (b"title: a\nnotes: 'a\ncoordinates: [x]\n", 2, 8, "never closed"),
    "extra bracket": (b"coordinates: [x]]\n", 1, 17, "']'"),
    "extra comma": (b"coordinates: [x,, y]\n", 1, 17, "','"),
    "colon in text": (b"title: a: b\n", 1, 9, "':'"),
    "bad indent": (b"coordinates:\n- x\n y: 1\n", 3, 3, "':'"),
    "list after a value": (b"coordinates: [x]\n- y\n", 2, 1, "align"),
    "at sign": (b"title: @me\n", 1, 8, "@"),
    "percent": (b"title: %me\n", 1, 8, "%"),
    "star": (b"title: *\n", 1, 9, "*"),
    "bad escape": (b'title: "a\\qb"\n', 1, 11, "\\q"),
    "half a character": (b'{"title": "\\ud83d"}', 1, 11, "half a character"),
    "undefined alias": (b"title: *nobody\n", 1, 8, "nobody"),
    "alias of itself": (b"title: &a [*a]\n", 1, 12, "inside"),
    "two documents": (b"coordinates: [x]\n---\ncoordinates: [y]\n", 2, 1, "second"),
    "python tag": (b"coordinates: [x]\ntitle: !!python/object/apply:os.system ['true']\n", 2, 8, "python"),
    "custom tag": (b"title: !secret x\n", 1, 8, "!secret"),
    "a key that is a list": (b"? [a, b]\n: c\n", 1, 3, "key"),
    "deep": (b"title: " + b"[" * 5000, 1, 57, "deep"),
    "deep JSON": (b'{"title": ' + b"[" * 5000 + b"]" * 5000 + b"}", 1, 60, "deep"),
    "bomb": (
        b"a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n"
        + b"".join(b"a%d: &a%d [%s]\n" % (i, i, b", ".join([b"*a%d" % (i - 1)] * 10)) for i in range(1, 10)),
        6, 10, "aliases",
    ),
    "huge integer": (b"coordinates: [x]\nconfiguration: {x: " + b"9" * 100_000 + b"}", 2, 20, "100000 characters"),
    "huge exponent": (b"coordinates: [x]\nconfiguration: {x: 1e999999999}", 2, 20, "too large"),
    "tiny exponent": (b"coordinates: [x]\nconfiguration: {x: 1e-99999999999999999999}", 2, 20, "too small"),
    "infinite": (b"coordinates: [x]\nconfiguration: {x: .inf}", 2, 20, "finite"),
    "not a number": (b'{"coordinates": ["x"], "configuration": {"x": NaN}}', 1, 47, "finite"),
    "dimension": (b"dimension: 4\n", 1, 12, "1, 2 or 3"),
    "unknown type": (b"bodies: [a]\nconstraints:\n- {name: p, type: revolut, between: []}\n", 3, 19, "revolut"),
    "unknown key in a constraint": (b"particles: [A]\nconstraints:\n- {type: link, betwen: [A]}\n", 3, 16, "betwen"),
    "missing key": (b"particles: [A]\nconstraints:\n- {type: link}\n", 3, 3, "'between'"),
    "one end": (b"particles: [A]\nconstraints:\n- {type: link, between: [A]}\n", 3, 25, "2 entries"),
    "unknown name": (b"coordinates: [theta]\nconstraints:\n- thta = 1\n", 3, 3, "thta"),
    "unknown name in quotes": (b'coordinates: [theta]\nconstraints:\n- "1 = thta"\n', 3, 8, "thta"),
    "unknown name after an escape": (b'coordinates: [theta]\nconstraints:\n- "\\u0031 = thta"\n', 3, 13, "thta"),
    "unknown name in a field": (b"coordinates: [q]\nconstraints:\n- {type: equation, text: 'q = rr'}\n", 3, 31, "rr"),
    "a hyphen too far to the right": (b"coordinates: [x]\nconstraints:\n- x = 1\n - x = 2\n", 3, 3, "hyphen"),
    "a key that is no coordinate": (b"coordinates: [x]\nconfiguration: {x: 1, y: 2}\n", 2, 23, "'y'"),
    "unknown name in JSON": (b'{"coordinates": ["theta"],\n"constraints": ["theta = thta"]}', 2, 26, "thta"),
    "unknown name after CRLF": (b"coordinates: [theta]\r\nconstraints:\r\n- 1 = thta\r\n", 3, 7, "thta"),
    "unknown name after a BOM": (b"\xef\xbb\xbfcoordinates: [q]\nconstraints: [1 = thta]\n", 2, 19, "thta"),
    "nothing after an operator": (b"coordinates: [x]\nconstraints:\n- x >= 0 +\n", 3, 11, "missing after `+`"),
    "unknown body": (b"dimension: 2\nbodies: [crank]\nconstraints:\n- {type: fixed, body: crnk}\n", 4, 23, "crnk"),
    "number as a name": (b"coordinates: [1]\n", 1, 15, "text is needed"),
    "mapping as a list": (b"coordinates: {x: y}\n", 1, 14, "list is needed"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_every_fault_has_its_place_and_says_what_to_do(case: str) -> None:
    data, line, column, message = BAD[case]
    found = faults(data)
    assert (found[0].line, found[0].column) == (line, column), found[0]
    assert message in found[0].message
    for fault in found:
        assert fault.line is not None
        assert fault.column is not None
        assert fault.hint
        assert "Input should" not in fault.message
        assert len(fault.message) < 300
        assert fault.see is None or explanations_of(fault.see)


def test_all_faults_come_at_once_in_the_order_of_the_file() -> None:
    found = faults(
        "title: [1]\n"
        "coordinates: [theta, theta]\n"
        "constraints:\n"
        "- {type: link, betwen: [A, B]}\n"
        "- {type: revolut}\n"
        "- thta = 1\n"
        "- {type: equation, text: 'x = 1', txt: 1}\n"
        "configuraton: {}\n"
        "coordinates: [x]\n"
        "notes: !!python/name:os.system ''\n"
    )
    assert [fault.line for fault in found] == [1, 2, 4, 4, 5, 6, 7, 7, 8, 9, 10]
    told = [re.split(r";? (?:for|write) ", fault.hint)[0] for fault in found if fault.hint]
    assert [hint for hint in told if "did you mean" in hint] == [
        "did you mean 'between'?",
        "did you mean 'revolute'?",
        "did you mean `theta`?",
        "did you mean 'text'?",
        "did you mean 'configuration'?",
    ]


#: Texts with several mistakes: the column and the words of each, and its hint.
SEVERAL = {
    "x_A + y_B = thet": [(1, "`x_A` is not", "`x`?"), (7, "`y_B` is not", "`y`?"), (13, "`thet` is not", "`theta`?")],
    "thet_a = 3 +": [(1, "`thet_a` is not", "`theta`?"), (13, "missing after `+`", "complete")],
    "2 cm x = 3 kg": [(3, "`cm` is not", "write `2`"), (12, "`kg` is not", "write `3`")],
    "(fo' x + ba = fo": [(1, "`(` is never", "`)`"), (2, "`fo` is not", "are theta"), (10, "`ba` is not", "are")],
    "foo(x) = bar": [(1, "no function `foo`", "`functions: {foo: [s]}`")],
}


@pytest.mark.parametrize("text", SEVERAL)
def test_all_faults_of_a_text_come_at_once(text: str) -> None:
    found = faults(f'coordinates: [x, y, theta]\nconstraints: ["{text}"]\n')
    assert [fault.column for fault in found] == [15 + column for column, _, _ in SEVERAL[text]]
    for fault, (_, message, hint) in zip(found, SEVERAL[text], strict=True):
        assert message in fault.message
        assert hint in (fault.hint or "")


#: Scenes with one mistake, in which other things seem wrong because of it -> the line of the fault, and its hint.
WITH_ECHOES = {
    "a misspelt section": ("coordinates: [r, x]\nparams: {R: 2}\nconstraints: [x = R r]\n", 2, "'parameters'"),
    "a synonym of a section": ("points: [A, B]\nconstraints: [{type: link, between: [A, B]}]\n", 1, "'particles'"),
    "a section of joints": (
        "dimension: 2\nbodies: [a]\njoint: [{type: hinge, between: [ground, a], at: [0, 0]}]\n", 3, "'constraints'",
    ),
    "no bodies": (
        "dimension: 2\njoints:\n- {type: pin, between: [ground, a], at: [0, 0]}\n"
        "- {type: pin, between: [a, b], at: [1, 0]}\n", 3, "`bodies: [a, b]`",
    ),
    "no particles": (
        "constraints: [{type: link, between: [A, B]}, {type: link, between: [B, C]}]\n", 1, "`particles: [A, B, C]`",
    ),
    "a misspelt joint of a coupling": (
        "dimension: 2\nbodies: [a, b]\njoints:\n- {name: p, type: pinn, between: [ground, a], at: [0, 0]}\n"
        "- {name: q, type: pin, between: [ground, b], at: [1, 0]}\n- {type: coupling, joints: [p, q], text: q = 2 p}\n",
        4, "'revolute'",
    ),
    "a misspelt joint without a name, by letter": (
        "bodies: [a]\njoints:\n- {type: cylindricl, between: [ground, a], at: [0, 0, 0], axis: z}\n"
        "- {type: coupling, joints: {u: c1}, text: u = 0}\n", 3, "'cylindrical'",
    ),
    "a section that means nothing": ("vars: [x, y]\nconstraints: [x = 2 y]\n", 1, "the keys are"),
    "a tolerance that is none": (
        "tolerance: a\nparticles: [{name: A, at: [1.01, 0, 0]}]\n"
        "constraints: [{type: link, between: [[0, 0, 0], A], length: 1}]\n", 1, "1e-6",
    ),
    "names that cannot be read": ("coordinates: ['{x}']\nconstraints: ['{x} = 1', 'x = 2']\n", 1, "write `x`"),
    "a letter of another script": ("coordinates: [x, у]\nconstraints: [x = 1]\n", 1, "type `y` instead"),
    "a particle's name that cannot be read": ("particles: [A B]\nconstraints: [x_A = 1]\n", 1, "write `A_B`"),
    "a body in place of its coordinates": ("bodies: [a]\nconstraints: []\nconfiguration: {a: 1}\n", 3, "x_a: 0"),
}  # fmt: skip


@pytest.mark.parametrize("case", WITH_ECHOES)
def test_a_mistake_is_one_fault(case: str) -> None:
    text, line, hint = WITH_ECHOES[case]
    (fault,) = faults(text)
    assert fault.line == line
    assert hint in (fault.hint or ""), fault


def test_faults_without_end_are_counted() -> None:
    found = faults("coordinates: [q]\nconstraints:\n" + "- {type: equation, txt: q}\n" * 1000)
    assert len(found) == MOST_FAULTS + 1
    assert "800 further" in found[-1].message


def test_a_fault_found_later_gets_its_place_too() -> None:
    file = SceneFile.read('coordinates: [x]\nconstraints:\n- "x = 1"\n- "x = 2"\n', "x")
    located = file.error([Fault("no", ("constraints", 1))])
    assert (located.faults[0].line, located.faults[0].column) == (4, 3)


def test_anchors_are_read() -> None:
    scene = loads(
        "particles: [A, B, C]\nconstraints:\n- &l {type: link, between: [A, B]}\n"
        "- {type: link, between: [B, C]}\n- *l\n"
    )
    assert [constraint.in_words for constraint in scene.constraints] == ["link A-B", "link B-C", "link A-B"]


@pytest.mark.sweep
def test_a_fault_at_the_end_of_a_long_list_has_its_place() -> None:
    count = 5000
    entries = "".join(f"- {{type: link, between: [P{i}, P{i + 1}]}}\n" for i in range(count))
    text = "particles: [" + ", ".join(f"P{i}" for i in range(count + 1)) + "]\nconstraints:\n" + entries
    assert len(loads(text).constraints) == count
    found = faults(text.replace(f"P{count - 1}]", f"Q{count - 1}]"))
    assert [(fault.line, fault.column) for fault in found] == [(2 + count - 1, 33)]


def test_names_come_from_the_file_unless_the_scene_has_one(tmp_path: Path) -> None:
    (tmp_path / "pendulum.yaml").write_text("coordinates: [x]\n")
    (tmp_path / "other.json").write_text('{"name": "mine", "coordinates": ["x"]}')
    assert load(tmp_path / "pendulum.yaml").name == "pendulum"
    assert load(str(tmp_path / "other.json")).name == "mine"
    assert load(tmp_path / "pendulum.yaml", name="called").name == "called"
    assert loads("coordinates: [x]").name == "scene"


def test_what_cannot_be_found_is_named_with_the_nearest(tmp_path: Path) -> None:
    (tmp_path / "pendulum.yaml").write_text("coordinates: [x]\n")
    for source, message, hint in [
        (tmp_path / "pendulun.yaml", "there is no file", "pendulum.yaml"),
        (tmp_path / "no" / "p.yaml", "there is no file", "no folder"),
        (tmp_path, "is a folder", "*.yaml"),
        ("disc-rolling-on-plain", "no scene of that name", "'disc-rolling-on-plane'"),
        ("coordinates: [x]\n", "text of a scene", "loads"),
        ("a\0b", "there is no file", "catalog"),
        ("x" * 5000, "cannot be read", "path"),
    ]:
        with pytest.raises(SceneError) as caught:
            load(source)
        assert message in caught.value.faults[0].message
        assert hint in (caught.value.faults[0].hint or "")


@pytest.mark.skipif(not hasattr(os, "mkfifo") or os.geteuid() == 0, reason="root may read everything")
def test_a_file_that_may_not_be_read(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("coordinates: [x]\n")
    (tmp_path / "a.yaml").chmod(0)
    with pytest.raises(SceneError, match="permission denied"):
        load(tmp_path / "a.yaml")


def test_mappings_are_scenes_too() -> None:
    assert load({"coordinates": ["x"], "configuration": {"x": 0.1}}).configuration == {"x": Fraction(1, 10)}
    with pytest.raises(SceneError) as caught:
        load(
            {"coordinates": ["theta"], "constraints": ["thta = 1", {"type": "link", "betwen": [[0], [1]], "length": 1}]}
        )
    assert [fault.where[:3] for fault in caught.value.faults][:2] == [
        ("constraints", 0, "text"),
        ("constraints", 1, "betwen"),
    ]
    assert all(fault.hint for fault in caught.value.faults)
    endless: dict[str, object] = {}
    endless["expect"] = endless
    with pytest.raises(SceneError, match="deeper"):
        load(endless)


def test_the_catalog_is_found_by_name() -> None:
    names = dofkit.catalog_names()
    assert len(set(names)) == len(names) > 50
    assert find(names[0]).data == dofkit.catalog_text(names[0])
    assert load("disc-rolling-on-plane").name == "disc-rolling-on-plane"
    with pytest.raises(SceneError, match="did you mean 'disc-rolling-on-plane'"):
        dofkit.catalog_text("disc-rolling-on-plan")


def test_a_misspelt_body_where_a_point_is_needed_is_named() -> None:
    """The body that was meant, and a point of it; no example repeats the misspelling."""
    scene = {"dimension": 2, "bodies": ["crank", "rod"]}
    with pytest.raises(dofkit.SceneError) as found:
        dofkit.load({**scene, "constraints": [{"type": "link", "between": ["crnk", [0, 0]]}]})
    assert "did you mean the body 'crank'? name one of its points: `{on: crank, at: [0, 0]}`" in str(found.value)
    with pytest.raises(dofkit.SceneError) as found:
        dofkit.load({**scene, "constraints": [{"type": "weld", "between": ["crnk", "rod"]}]})
    assert "did you mean 'crank'?" in str(found.value)


def test_a_length_that_cannot_be_read_is_a_fault_of_every_link() -> None:
    text = "particles: [A, B, C]\nconstraints:\n- {type: link, between: [A, B], length: 2 +}\n"
    with pytest.raises(SceneError) as caught:
        loads(text + "".join(f"- {{type: link, between: [{a}, C], length: nosuch}}\n" for a in "AB"))
    assert len(caught.value.faults) == 3


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("dimension: 2\nparticles: [{name: A, mass: [1]}]\nconstraints: [x_A = q]\n", [2, 3]),
        ("dimension: 2\nbodies: [{name: A, inertia: {a: 1}}]\nconstraints: [x_A = q]\n", [2, 3]),
        ("coordinates: [x]\nfunctions: {f: 3}\nconstraints: [x = f(t), x = y]\n", [2, 3]),
        ("coordinates: [x]\ndimension: 4\nconstraints: [x = y]\n", [2, 3]),
    ],
)
def test_a_faulty_declaration_hides_no_fault_of_a_text(text: str, lines: list[int]) -> None:
    assert [fault.line for fault in faults(text)] == lines


#: Scenes with a fault of shape and faults in names and texts -> (line, what it says) of each.
SLED = "dimension: 2\nbodies: [sled]\nparticles: [A, B]\n"
HIDDEN = {
    "a misspelt key, an undeclared coordinate elsewhere": (
        SLED + "constraints:\n- {type: link, between: [A, B], lenght: 2}\n- sin(theta) dx_sled = dy_sled",
        [(5, "'lenght'"), (6, "`theta`")],
    ),
    "both in one constraint": (
        SLED + "constraints:\n- {type: equation, txt: x_sledd = 0}\n", [(5, "'txt'"), (5, "`x_sledd`")],
    ),
    "a misspelt type": (
        SLED + "constraints:\n- {type: slott, point: C, body: sled}\n- x_A = q\n",
        [(5, "'slott'"), (5, "'C'"), (6, "`q`")],
    ),
    "a misspelt key of a body": (
        "dimension: 2\nbodies: [{nam: sled}]\nconstraints: [x_sled = q]\n", [(2, "'nam'"), (3, "`q`")],
    ),
    "a misspelt section, with a misspelt key in it": (
        "dimension: 2\nparticles: [A, B]\nconstrains:\n- {type: link, betwen: [A, C]}\n- x_A = q\n",
        [(3, "'constrains'"), (4, "'betwen'"), (4, "'C'"), (5, "`q`")],
    ),
    "a section that is no list": (SLED + "forces: 3\nconstraints: [x_A = q]\n", [(4, "list"), (5, "`q`")]),
    "a joint that cannot be read hides no fault of the coupling": (
        "dimension: 2\nbodies: [a, b]\njoints:\n- {name: p, type: pin, between: [ground]}\n"
        "- {name: q, type: pin, between: [ground, b], at: [1, 0]}\n- {type: coupling, joints: [p, r], text: p = r}\n",
        [(4, "2 entries"), (6, "'r'")],
    ),
    "an entry whose names are not known": (
        "coordinates: [x, 3]\nconstraints: [x = y, x = 2 +]\n", [(2, "something is missing")],
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", HIDDEN)
def test_a_fault_of_shape_hides_no_other_fault(case: str) -> None:
    text, expected = HIDDEN[case]
    found = [fault for fault in faults(text) if fault.line != 1]
    assert [fault.line for fault in found] == [line for line, _ in expected]
    assert all(word in fault.message for fault, (_, word) in zip(found, expected, strict=True)), found
