"""Evidence for what an answer in equations is worth: scenes in which it holds, or does not, and what is feasible there.

An answer g = 0 says what a constraint does where no state meets the others, the constraint and g^2 > 0, and none the
others, the answer and f^2 > 0 for a relation f = 0 of the constraint. One such state shows that it does not.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from dofkit.checker.problem import canonical, read_problem
from dofkit.checker.relations import FAULTS
from dofkit.checker.trees import CheckError
from dofkit.methods.certificates.lowering import document_of_scene
from dofkit.methods.certificates.numerics import NoEstimateError
from dofkit.methods.certificates.room import ClaimTrial, Room, Told, empty_certificate
from dofkit.methods.certificates.scenery import Scenery, multiple, text_of
from dofkit.methods.certificates.steps import combined, rate_of
from dofkit.report import Report
from dofkit.scene.scene import Scene

#: What the inequality is called, and how many points are tried.
APART, MOST_POINTS = "it does not hold", 4


class PosedScene(NamedTuple):
    """A document, and the function that is said not to be 0 in it."""

    document: dict[str, Any]
    function: str


def posed(document: Mapping[str, Any], kept: Sequence[str], texts: Sequence[str], function: str) -> PosedScene:
    """A scene with the constraints that are kept, further equations, and a function that is not 0."""
    plain = canonical(document)
    named = [{"name": f"c{i}", **one} for i, one in enumerate(plain.get("constraints", []), 1)]
    constraints = [one for one in named if one["name"] in kept]
    constraints += _equations(texts)
    apart = {"name": APART, "text": f"({function})^2 > 0"}
    return PosedScene({**plain, "constraints": [*constraints, apart]}, function)


def functions_of(document: Mapping[str, Any], names: Sequence[str]) -> list[str]:
    """What constraints say is 0, in the checker's reading; `CheckError` where it holds lengths that are not told."""
    problem = read_problem(document)
    found = [one for one in problem.relations if one.owner in names]
    if any(one.kind == "inequality" or not one.left.symbols.isdisjoint(problem.world.generic) for one in found):
        raise CheckError("an inequality, or a length that is not told")
    return [text_of(one.left).replace("tdot", "1") for one in found]


def certificate_of_answer(one: PosedScene, report: Report, feasible: bool) -> dict[str, Any] | None:
    """A certificate that a posed scene is feasible, or that it is not; None where no evidence was found."""
    try:
        problem = read_problem(one.document)
        found = empty_certificate(APART, one.document)
        room = Room(report, one.document, Scenery(problem, False, found))
        trial = ClaimTrial(one.document, found, problem)
        trial.admit(room.scenery)
        for evidence in _met(room) if feasible else _refuted(room, one.function):
            claim = {"path": "/feasible", "value": feasible, **evidence}
            if trial.outcome(claim) == "shown":
                found["claims"].append(claim)
                return found
    except (*FAULTS, NoEstimateError):
        return None
    return None


def _met(room: Room) -> Iterator[Told]:
    """Points at which all holds, and velocities where there are some."""
    evidence, names = room.scenery.evidence, list(room.equations)
    unknowns = list(room.problem.coordinates)
    if evidence.moving or evidence.met_by(evidence.relation(APART).left):
        names += [rate for name in evidence.finite if (rate := rate_of(room.scenery, name))]
        unknowns += [f"{q}dot" for q in room.problem.coordinates]
    for seed in range(MOST_POINTS):
        point = room.search.somewhere(names, unknowns, 10 * seed + 1)
        if point is None or not room.differs(evidence.relation(APART).left, point):
            continue
        room.add_point(point)
        standing = room.standing_of(room.equations, point=point)
        if standing is not None and standing.rows:
            yield {"rule": "regular", "minor": room.minor(standing)}
        yield {"rule": "point", "at": point.name}


def _refuted(room: Room, function: str) -> Iterator[Told]:
    """A step by which the function is 0 wherever all else holds."""
    scenery, evidence = room.scenery, room.scenery.evidence
    rows = list(evidence.equations)
    rows += [rate for name in evidence.finite if (rate := rate_of(scenery, name))]
    scenery.add_step({"id": "what is asked", "by": "assumed", "function": function})
    for i, found in enumerate(_cofactors(room, "what is asked", rows)):
        try:
            scenery.add_step({"id": f"it holds {i}", "by": "implied", "function": function, **found})
        except CheckError:
            continue
        cofactors = {f"it holds {i}": f"-({function})"}
        yield {"rule": "nullstellensatz", "number": "0", "inequality": {APART: [["1", "1"]]}, "c": cofactors}


def _cofactors(room: Room, name: str, rows: Sequence[str]) -> Iterator[Told]:
    for row in rows:
        if (found := multiple(room.scenery, name, row)) is not None:
            yield found
    point = room.search.somewhere(room.scenery.evidence.finite, room.problem.coordinates, 1)
    if point is not None:
        yield from combined(room.scenery, name, rows, point)


def certificates_of(
    scene: Scene, asked: Sequence[str], texts: Sequence[str], report: Report, right: bool
) -> tuple[list[dict[str, Any]], str]:
    """Certificates of an answer to what constraints of a scene say, and where there are none, why."""
    document = document_of_scene(scene)
    try:
        others = [entry.name for entry in report.constraints if entry.name not in asked]
        own = functions_of(
            {**document, "constraints": _equations(texts)}, [f"the answer {i + 1}" for i in range(len(texts))]
        )
        told = [posed(document, [*others, *asked], [], one) for one in own]
        told += [posed(document, others, texts, one) for one in functions_of(document, asked)]
    except FAULTS as error:
        return [], f"it is not read here ({error!s:.80})"
    found = (certificate_of_answer(one, report, not right) for one in told)
    if right:
        whole = list(found)
        shown = [one for one in whole if one is not None]
        return (shown, "") if len(shown) == len(told) else ([], "no cofactors were found that do everywhere")
    first = next((one for one in found if one is not None), None)
    return ([], "no state was found that tells them apart") if first is None else ([first], "")


def _equations(texts: Sequence[str]) -> list[dict[str, str]]:
    return [{"name": f"the answer {i}", "text": text} for i, text in enumerate(texts, 1)]
