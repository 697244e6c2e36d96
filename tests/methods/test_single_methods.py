"""Each method by itself on small cases worked out by hand: where it is right, where it is wrong, what it cannot."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from shared.known_scenes import SCENES, VARIED, dealt, few, report_of, scene_of

import dofkit
import dofkit.methods
from dofkit.base.verdicts import VERDICTS
from dofkit.benchmark.sentences import explained
from dofkit.exact.points.balls import balls_of
from dofkit.methods.ask import answered
from dofkit.methods.numeric import tolerance_of
from dofkit.methods.table import ENGINES, METHODS, QUESTIONS, MethodName, Question, function_of, methods
from dofkit.report import Report

HOME = Path(dofkit.methods.__file__).parent
#: Modules of the package that are no method.
SHARED = {
    "__init__", "as_written", "ask", "classify", "single_method", "table", "verify",
}  # fmt: skip
RIVALS: tuple[MethodName, ...] = tuple(m for m in METHODS if m not in ENGINES)
#: Rivals that are quick enough for every scene.
QUICK: tuple[MethodName, ...] = tuple(m for m in RIVALS if m != "symbolic")
#: The scenes that half of the rivals look at, and those of which each question is asked.
HALF = frozenset(dealt("alone", SCENES, 2)[0])
DEALT: dict[Question, list[Path]] = dict(zip(QUESTIONS[:3], dealt("ask", SCENES, 3), strict=True))
ENTRY = ("holonomic", "holonomic_alone", "scleronomic", "bilateral", "exact", "independent", "equations")


def scene(*constraints: Any, coordinates: tuple[str, ...] = ("x", "y", "z"), **more: Any) -> dict[str, Any]:
    return {"coordinates": list(coordinates), "constraints": list(constraints), **more}


def points(*places: tuple[str, tuple[int, ...] | None], links: str, dimension: int = 2, **more: Any) -> dict[str, Any]:
    """Particles, drawn or not, and links between them."""
    particles = [name if at is None else {"name": name, "at": list(at)} for name, at in places]
    bars = [{"name": pair, "type": "link", "between": list(pair)} for pair in links.split()]
    return {"dimension": dimension, "particles": particles, "constraints": bars, **more}


#: A square with both diagonals, the last link redundant: 8 coordinates, 5 independent links, 3 left.
BRACED = points(*((n, None) for n in "ABCD"), links="AB BC CD DA AC BD")
#: Three points on a line, all joined: one link redundant at the drawing only; held apart it is a shake of B.
STRAIGHT = points(("A", (0, 0)), ("B", (1, 0)), ("C", (2, 0)), links="AB BC AC")
#: dy = p dx, dp = q dx: not integrable, and yet d(dy - p dx) = dx dp vanishes modulo both forms (Goursat).
CHAIN = scene("dy - p dx = 0", "dp - q dx = 0", coordinates=("x", "y", "p", "q"))
#: x = 0 with xdot = y forces y = 0; nobody wrote it.
HIDDEN = scene("x = 0", "xdot = y", coordinates=("x", "y"))
#: One form has the factor 1/x^2, so that y/x is constant; it is not closed.
FACTOR = scene("x dy - y dx = 0")
TWICE = scene("x + y = 1", "2 x + 2 y = 2")

#: (question, scene, truth, what each method tells; a method that is not named cannot answer)
Case = tuple[str, Question, dict[str, Any], Any, dict[MethodName, Any]]
NONE, SLOW = object(), object()
CASES: list[Case] = [
    ("a product beside its factor", "dof", {"coordinates": ["x", "y"], "constraints": ["x y = 0", "y = 0", "x = 1"]}, 0,
     {"count": None, "field": 0, "balls": 0, "numeric": 0, "symbolic": 0}),
    ("braced square", "dof", BRACED, 3,
     {"count": 2, "graph": 3, "field": 3, "balls": 3, "exact": 3, "numeric": 3, "symbolic": SLOW}),
    ("braced square", "redundancy", BRACED, ["BD"],
     {"count": NONE, "graph": ["BD"], "field": ["BD"], "balls": ["BD"], "exact": ["BD"], "numeric": ["BD"],
      "symbolic": SLOW}),
    ("straight triangle", "dof", STRAIGHT, 3,
     {"count": 3, "graph": 3, "field": 3, "balls": 3, "exact": 4, "numeric": 4, "symbolic": 4}),
    ("forms in a chain", "integrability", CHAIN, {"c1": False, "c2": False},
     {"count": {"c1": False, "c2": False}, "field": {"c1": False, "c2": False}, "balls": {"c1": False, "c2": False},
      "exact": {"c1": True, "c2": False}, "numeric": {"c1": True, "c2": False}, "symbolic": {"c1": True, "c2": False}}),
    ("a form with a factor", "integrability", FACTOR, {"c1": True},
     {"count": {"c1": False}, "field": {"c1": True}, "balls": {"c1": True}, "exact": {"c1": True},
      "numeric": {"c1": True}, "symbolic": {"c1": True}}),
    ("a form with a factor", "dof", FACTOR, 2,
     {"count": 3, "field": 2, "balls": 2, "exact": 2, "numeric": 2, "symbolic": 2}),
    ("a hidden relation", "dof", HIDDEN, 0,
     {"count": 1, "field": 0, "balls": 0, "exact": 1, "numeric": 1, "symbolic": 1}),
    ("written twice", "dof", TWICE, 2,
     {"count": 1, "field": 2, "balls": 2, "exact": 2, "numeric": 2, "symbolic": 2}),
    ("written twice", "redundancy", TWICE, ["c2"],
     {"count": [], "field": ["c2"], "balls": ["c2"], "exact": ["c2"], "numeric": ["c2"], "symbolic": ["c2"]}),
    ("nothing is left over", "redundancy", scene("x = 1", "y = 2"), [],
     {"count": [], "field": [], "balls": [], "exact": [], "numeric": [], "symbolic": []}),
    ("two values for one", "dof", scene("x = 1", "x = 2"), -1,
     {"count": 1, "field": -1, "balls": -1, "exact": -1, "numeric": -1, "symbolic": 2}),
    ("a square and its root", "dof", scene("(x - y)^2 = 0", "x = y"), 2,
     {"count": 1, "field": 2, "balls": 2, "exact": 2, "numeric": 2, "symbolic": 2}),
    ("a sum of squares", "dof", scene("x^2 + y^2 = 0"), 1,
     {"count": 2, "field": 1, "balls": 1, "numeric": 2, "symbolic": 2}),
    ("links are finite", "integrability", BRACED, dict.fromkeys(("AB", "BC", "CD", "DA", "AC", "BD"), True),
     {m: dict.fromkeys(("AB", "BC", "CD", "DA", "AC", "BD"), True) for m in METHODS if m != "auto"}),
]  # fmt: skip


@pytest.mark.parametrize(("title", "question", "given", "truth", "told"), CASES, ids=lambda v: v if v is str(v) else "")
def test_what_each_method_tells(
    title: str, question: Question, given: dict[str, Any], truth: Any, told: dict[MethodName, Any]
) -> None:
    assert answered(given, question, "auto").value == truth
    for method in METHODS:
        if method == "auto" or told.get(method) is SLOW:
            continue
        reply = answered(given, question, method)
        wanted = told.get(method, NONE)
        assert reply.value == (None if wanted is NONE else wanted), (title, method, reply)
        assert reply.cannot == (method not in told)
        assert reply.value is not None or reply.reason


FLAT = scene("z = 0", "x + z = 1")
#: (scene, constraint, answer, truth, who says that it is the same); with ? who does not tell; all others say it is not.
ANSWERS: list[tuple[dict[str, Any], str, str, bool, str]] = [
    (FLAT, "c2", "x + z = 1", True, "auto count field balls"),
    (FLAT, "c2", "x=1-z", True, "auto field balls"),
    (FLAT, "c2", "5 x + 5 z = 5", True, "auto field balls"),
    (FLAT, "c2", "x = 1", True, "auto field balls"),
    (FLAT, "c2", "x = 1 + y", False, ""),
    (FLAT, "c2", "x + z^2 = 1", True, "auto field balls"),
    (scene("x = y"), "c1", "(x - y)^2 = 0", False, ""),
    (scene("zdot = y xdot"), "c1", "2 dz - 2 y dx = 0", True, "auto field balls"),
    (scene("zdot = y xdot"), "c1", "dz = x dy", False, ""),
    (scene("x = 0"), "c1", "x + y/10^12 = 0", False, ""),
]


@pytest.mark.parametrize(("given", "name", "text", "truth", "same"), ANSWERS, ids=lambda v: v if v is str(v) else "")
def test_which_answers_each_method_takes_for_the_same(
    given: dict[str, Any], name: str, text: str, truth: bool, same: str
) -> None:
    assert truth == ("auto" in same)
    for method in METHODS:
        if "equivalence" in methods()[method].uses:
            reply = answered(given, "equivalence", method, answer={"constraint": name, "text": text})
            wanted = None if f"{method}?" in same.split() else method in same.split()
            assert reply.value is wanted, (method, reply)


def test_every_row_has_a_module_and_every_module_a_row() -> None:
    assert {p.stem for p in HOME.glob("*.py")} - SHARED == set(RIVALS)


@pytest.mark.parametrize("method", METHODS)
def test_a_method_answers_what_its_row_says(method: MethodName) -> None:
    assert all(use.sound and use.costs for use in methods()[method].uses.values())
    assert method in ENGINES or all(callable(function_of(method, question)) for question in methods()[method].uses)


def test_what_is_small_is_taken_for_zero() -> None:
    given = scene("x = 0", "x + y/10^10 = 0", coordinates=("x", "y"))
    assert [answered(given, "dof", method).value for method in ("numeric", "auto")] == [1, 0]
    with tolerance_of(1e-12):
        assert answered(given, "dof", "numeric").value == 0


def test_balls_of_few_bits_do_not_tell_a_small_number_from_zero() -> None:
    """e^(pi sqrt 163) is 262537412640768744 but for 7.5e-13, which 100 bits do not show beside it and 128 do."""
    given = scene("dz + (exp(pi*sqrt(163)) - 262537412640768744) y dx = 0")
    for bits, holonomic in ((53, None), (128, False)):
        with balls_of(bits):
            assert answered(given, "integrability", "balls").value == {"c1": holonomic}


def test_a_question_alone_is_answered_as_the_report_answers_it() -> None:
    reply = dofkit.ask(dofkit.load(HIDDEN), "dof")
    assert (reply.value, reply.reason) == (0, "")
    assert dofkit.ask(dofkit.load(TWICE), "redundancy").value == ["c2"]
    late = dofkit.ask(dofkit.load(TWICE), "redundancy", budget=0)
    assert (late.value, late.verdict) == (None, "undecided")
    assert late.reason


def report(given: dict[str, Any], method: MethodName) -> Report:
    return dofkit.classify(dofkit.load(given), method=method)


def test_the_report_of_a_method_alone_is_sure_of_what_it_is_sound_for_only() -> None:
    count = report(BRACED, "count")
    assert (count.dof, count.count.naive_dof, count.verdict) == (None, 2, "undecided")
    assert any("gives 2 degrees of freedom" in w and "independent" in w for w in count.warnings)
    graph = report(BRACED, "graph")
    assert (graph.dof, graph.redundant, graph.verdicts["dof"].verdict) == (3, ["BD"], "proved")
    assert report(STRAIGHT, "graph").dof is None
    for method in ("exact", "numeric"):
        drawn = report(STRAIGHT, method)
        assert (drawn.dof, drawn.verdict) == (None, "undecided")
        assert any("4 degrees of freedom" in w and "independent there" in w for w in drawn.warnings) == (
            method == "exact"
        )
    symbolic = report(FACTOR, "symbolic")
    assert (symbolic.dof, symbolic.constraints[0].holonomic) == (None, None)
    assert any("2 degrees of freedom" in w for w in symbolic.warnings)


def test_independent_equations_at_the_reference_prove_the_freedom() -> None:
    """A triangle 3-4-5 of links: the implicit function theorem."""
    triangle = points(("A", (0, 0)), ("B", (3, 0)), ("C", (0, 4)), links="AB BC AC")
    for method, sure in (("exact", "proved"), ("numeric", "numeric")):
        told = report(triangle, method)
        assert (told.dof, told.verdicts["dof"].verdict) == (3, sure)


def test_a_form_that_is_not_closed_is_undecided_by_the_count() -> None:
    entry = report(FACTOR, "count").constraints[0]
    assert (entry.holonomic, entry.verdict) == (None, "undecided")
    closed = report(scene("x dy + y dx = 0"), "count").constraints[0]
    assert (closed.holonomic, closed.holonomic_alone, closed.verdicts["holonomic"].verdict) == (True, True, "proved")


@pytest.mark.parametrize("path", few("expected", VARIED[::2], 6), ids=lambda path: path.stem)
def test_no_method_alone_contradicts_what_is_expected(path: Path) -> None:
    given = scene_of(path)
    expect = given.expect
    for method in QUICK[::2] if path in HALF else QUICK[1::2]:
        report = dofkit.classify(given, method=method)
        data = report.model_dump(mode="json")
        for key in ("consistent", "dof", "velocity_dof", "instantaneous_dof", "singular", "redundant_equations"):
            assert key not in expect or data[key] in (None, expect[key]), (method, key)
        for entry in data["constraints"]:
            wanted = expect.get("constraints", {}).get(entry["name"], {})
            wrong = [k for k in ENTRY if k in wanted and entry[k] not in (None, wanted[k])]
            assert not wrong, (method, entry["name"])
        best = VERDICTS.index(methods()[method].best)
        assert all(VERDICTS.index(v) >= best for v in (report.verdict, *(e.verdict for e in report.constraints)))
        assert report.method.startswith(f"{method} alone: ")
        assert methods()[method].cannot in report.method


@pytest.mark.parametrize("path", few("questions", VARIED[1::2], 24), ids=lambda path: path.stem)
def test_a_question_alone_has_the_answer_of_the_report(path: Path) -> None:
    """One of the questions for each scene, dealt out."""
    told, given = report_of(path), scene_of(path)
    question = next(q for q, paths in DEALT.items() if path in paths)
    reply = dofkit.ask(given, question)
    if question == "dof":
        assert reply.value == (-1 if told.consistent is False else told.dof)
    elif question == "integrability":
        assert reply.value == {e.name: e.holonomic for e in told.constraints}
    elif told.redundant_equations is None:
        assert reply.value is None
    else:
        assert reply.value is None or sorted(reply.value) == sorted(told.redundant)


#: A triangle with a square on it, its diagonal twice: drawn, redundant and rigid.
TWICE_DRAWN = points(("A", (0, 0)), ("B", (3, 0)), ("C", (3, 3)), ("D", (0, 3)), links="AB BC CD DA AC BD")


def test_single_questions_about_drawn_links_and_joints() -> None:
    """One link too many, as sure as in a report; flexible; hinges."""
    rigid = dofkit.ask(dofkit.load(TWICE_DRAWN), "redundancy")
    assert (rigid.value, rigid.verdict) == (["BD"], "probable")
    assert dofkit.ask(dofkit.load(TWICE_DRAWN), "dof").value == 3
    assert dofkit.ask(dofkit.load(STRAIGHT), "dof").value == 3
    hinge = {"type": "revolute", "between": ["ground", "door"], "at": [0, 0, 0], "axis": [0, 0, 1]}
    door = {"bodies": ["door"], "constraints": [{**hinge, "name": "a"}, {**hinge, "name": "b"}]}
    assert dofkit.ask(dofkit.load(door), "dof").value == 1
    assert dofkit.ask(dofkit.load(door), "redundancy").value == ["b"]
    apart = {"bodies": ["door"], "constraints": [{**hinge, "name": "a"}, {**hinge, "name": "b", "at": [0, 0, 2]}]}
    assert dofkit.ask(dofkit.load(apart), "dof").value == 1


def test_a_link_too_many_that_grows_is_inconsistent_although_the_reference_satisfies_it() -> None:
    """Two bars hold A; the third fits them at t = 0 only, so no motion through time satisfies all three."""
    bars = [([0, 0], {}), ([3, 1], {}), ([3, 5], {"length": "5 + t"})]
    scene = {
        "dimension": 2,
        "particles": [{"name": "A", "at": [0, 1]}],
        "constraints": [{"type": "link", "between": ["A", end], **more} for end, more in bars],
    }
    assert dofkit.classify(dofkit.load(scene)).consistent is False
    reply = dofkit.ask(dofkit.load(scene), "dof")
    assert (reply.value, reply.verdict) == (-1, "proved")


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("coordinates", "constraints"),
    [
        # ydot = 0 and udot = 0, so that wdot = 0: all are holonomic
        ("x y z w u", ["abs(ydot) + abs(udot + (w + z) ydot) = 0", "(1 + x^2) wdot + ydot = 0"]),
        # it has no value where all velocities are 0
        ("x y th", ["cos(th) = xdot/sqrt(xdot^2 + ydot^2)"]),
    ],
)
def test_what_a_method_does_not_read_makes_its_labels_undecided(
    method: MethodName, coordinates: str, constraints: list[str]
) -> None:
    scene = {"coordinates": coordinates.split(), "constraints": constraints}
    entries = dofkit.classify(scene, method=method).constraints
    assert not any(e.holonomic is False and e.form == "pfaffian" for e in entries)


def test_every_failure_is_explained_by_a_sentence() -> None:
    for method in METHODS:
        for question in QUESTIONS:
            for outcome in ("wrong", "undecided", "cannot", "timed out"):
                explanation = explained(method, question, outcome)
                assert explanation[0].isupper()
                assert explanation.endswith(".")
    assert explained("graph", "dof", "cannot", "no link") == "No link."
    assert explained("no method", "dof", "wrong")
