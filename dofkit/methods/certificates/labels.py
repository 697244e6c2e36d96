"""Evidence for the labels of one constraint."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from dofkit.checker.trees import CheckError, Tree, add, derivative, negative, number, power, symbol, times
from dofkit.methods.certificates.forms import integrable_names, involutive_rows, pairing, reach, words_of
from dofkit.methods.certificates.found_points import FoundPoint
from dofkit.methods.certificates.integrals import combined_integral, follows_from_integrals
from dofkit.methods.certificates.reductions import without_factor
from dofkit.methods.certificates.room import FAR, Room, Told
from dofkit.methods.certificates.texts import text_of
from dofkit.report import ConstraintEntry


def holonomic(room: Room, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """Finite, an inequality, integrated, or reached across."""
    evidence = room.scenery.evidence
    if evidence.owned(entry.name, ("inequality",)):
        yield {"rule": "inequality"}
        return
    if not evidence.owned(entry.name, ("velocity",)):
        yield {"rule": "finite"}
        return
    alone = field == "holonomic_alone"
    names = list(evidence.owned(entry.name))
    if alone and len(names) == 1 and getattr(entry, field) is True:
        yield {"rule": "wedge"}
    if getattr(entry, field) is False:
        if alone and len(names) == 1 and (found := _wedge(room, names[0])):
            yield found
        if found := _reached(room, entry.name, alone):
            yield found
        return
    if found := _integrated(room, entry):
        yield found
    yield from involutive_rows(room, names if alone else integrable_names(room))


def _wedge(room: Room, name: str) -> Told | None:
    """A point and three variables where omega ^ d(omega) is not 0."""
    point = room.point
    form = room.form(name)
    if point is None or form is None:
        return None
    for triple in combinations([v for v in room.scenery.evidence.variables if v in room.met(form)], 3):
        i, j, k = triple
        parts = ((i, j, k), (j, k, i), (k, i, j))
        tree = add(*(times(form.get(a, number(0)), curl(form, b, c)) for a, b, c in parts))
        if room.differs(tree, point):
            return {"rule": "wedge", "at": point.name, "triple": list(triple)}
    return None


def curl(form: dict[str, Tree], i: str, j: str) -> Tree:
    """d_i form_j - d_j form_i."""
    zero = number(0)
    return add(derivative(form.get(j, zero), i), negative(derivative(form.get(i, zero), j)))


def _reached(room: Room, owner: str, alone: bool) -> Told | None:
    """A word of brackets that a form of the constraint does not allow."""
    evidence = room.scenery.evidence
    standing = room.standing_of(evidence.owned(owner)) if alone else room.standing
    if standing is None or room.nonlinear or not (alone or standing.accounted):
        return None
    words = words_of(room, standing, len(room.problem.coordinates) + 1 if alone else reach(room))
    if words is None:
        return None
    for name in evidence.owned(owner, ("velocity",)):
        for word, vector in zip(words.words, words.vectors, strict=True):
            if len(word) > 1 and abs(pairing(room, name, standing.point, vector)) > FAR:
                used = {"fields": words.fields, "rows": words.rows, "word": word, "pairs": name}
                if any(map(evidence.is_open, (evidence.relation(one).left for one in evidence.finite))):
                    used["minor"] = room.minor(standing)
                return {"rule": "bracket", "at": standing.point.name, **used}
    return None


def _integrated(room: Room, entry: ConstraintEntry) -> Told | None:
    """The rule `integral`: a step for the integral that is told, and one by which the form follows from it."""
    names = room.scenery.evidence.owned(entry.name)
    if len(names) != 1 or room.point is None or (step := integral_step(room, entry, names[0])) is None:
        return None
    return {"rule": "integral", "at": room.point.name, "integrals": [step]}


def integral_step(room: Room, entry: ConstraintEntry, name: str) -> str | None:
    """Steps for an integral of one form alone: its id, where they stand up."""
    function = integral_text(entry)
    factor = factor_text(room, entry, name)
    ids = f"{name} integrated", f"rate of {name} integrated", f"{name} from its integral"
    if function is None or factor is None:
        return None
    if ids[0] in room.scenery.evidence.known:
        return ids[0]
    try:
        room.scenery.add_step({"id": ids[0], "by": "integral", "function": function, "c": {name: factor}})
        room.scenery.add_step({"id": ids[1], "by": "rate", "of": ids[0]})
        room.scenery.add_step({"id": ids[2], "by": "implied", "of": name, "h": factor, "c": {ids[1]: "1"}})
    except CheckError:
        return None
    return ids[0]


def integral_text(entry: ConstraintEntry) -> str | None:
    """The function that is said to be constant."""
    return entry.integral.rpartition("=")[0].strip() if entry.integral else None


def factor_text(room: Room, entry: ConstraintEntry, name: str) -> str | None:
    """The factor with d(function) = factor * form, from a quotient of components."""
    text, form = integral_text(entry), room.form(name)
    if text is None or form is None:
        return None
    try:
        function = room.scenery.evidence.text(text)
        for v, part in form.items():
            quotient = times(derivative(function, v), power(part, number(-1)))
            for given in ("1", "-1", entry.integrating_factor):
                if given and room.scenery.evidence.ring.vanishes(
                    add(quotient, negative(room.scenery.evidence.text(given)))
                ):
                    return given
        v = next(iter(form))
        return text_of(times(derivative(function, v), power(form[v], number(-1))))
    except (CheckError, StopIteration):
        return None


def integral(room: Room, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """The integral that is told: of the form alone, or in the system."""
    names = room.scenery.evidence.owned(entry.name, ("velocity",))
    function = integral_text(entry)
    if len(names) != 1 or room.point is None or function is None:
        return
    found = {"rule": "integral", "at": room.point.name}
    if alone := integral_step(room, entry, names[0]):
        yield {**found, "step": alone}
        if other := room.search.somewhere(room.scenery.evidence.finite, room.problem.coordinates, seed=1):
            yield {**found, "step": alone, "at": room.add_point(other)}
    if (step := combined_integral(room, function)) is None:
        return
    if follows_from_integrals(room, names[0], [step]):
        yield {**found, "step": step}
    texts = [one for other in room.report.constraints if (one := integral_text(other))]
    others = [one for text in texts if (one := combined_integral(room, text)) and one != step]
    others = list(dict.fromkeys(others))
    standing = room.standing_of([*room.scenery.evidence.finite, *others, names[0]])
    if follows_from_integrals(room, names[0], [step, *others]) and standing is not None and names[0] in standing.rows:
        yield {**found, "step": step, "integrals": others, "minor": room.minor(standing)}


def integrating_factor(room: Room, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """The factor that is told."""
    if room.point is not None:
        yield {"rule": "integral", "at": room.point.name}


def exact(room: Room, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """Closed, or a point where it is not."""
    if entry.exact:
        yield {"rule": "exact"}
        return
    names, point = room.scenery.evidence.owned(entry.name, ("velocity",)), room.point
    if point is None:
        return
    for name in names:
        form = room.form(name) or {}
        for i, j in combinations([v for v in room.scenery.evidence.variables if v in room.met(form)], 2):
            if room.differs(curl(form, i, j), point):
                told = {"relation": name} if len(names) > 1 else {}
                yield {"rule": "not exact", "at": point.name, "pair": [i, j], **told}
                break


def scleronomic(room: Room, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """Time does not occur, or matters at a point."""
    if getattr(entry, field):
        yield from timeless(room, entry, field)
        return
    evidence = room.scenery.evidence
    for name in evidence.owned(entry.name, ("finite", "velocity", "inequality")):
        for found in _turning(room, name, field):
            yield {"rule": "turns", "relation": name, **found}


def timeless(room: Room, entry: ConstraintEntry, field: str) -> Iterator[Told]:
    """Time does not occur; what is nonlinear in velocities is homogeneous."""
    yield {"rule": "timeless"}
    names = room.scenery.evidence.owned(entry.name)
    steps = [without_factor(room.scenery, name) for name in names]
    if steps != list(names):
        yield {"rule": "timeless", "steps": steps}


def _turning(room: Room, name: str, field: str) -> Iterator[Told]:
    if room.scenery.evidence.relation(name).kind == "velocity":
        yield from _turning_form(room, name, field)
        return
    turned = derivative(room.scenery.left(name), "t")
    if turned == number(0):
        return
    for point in _points_of(room, name):
        if point is not None and room.differs(turned, point):
            yield {"at": room.add_point(point)}


def _points_of(room: Room, name: str) -> Iterator[FoundPoint | None]:
    """The main point, where it is one of the relation, and others."""
    if room.scenery.evidence.relation(name).kind != "inequality":
        yield room.point
    yield from (room.search.touching(name, seed) for seed in (50, 60))


def _turning_form(room: Room, name: str, field: str) -> Iterator[Told]:
    form, point = room.form(name), room.point
    if point is None:
        return
    left = room.scenery.left(name)
    rates = {v: times(symbol(v), derivative(left, v)) for v in room.scenery.evidence.velocities if v in left.symbols}
    turned = form.get("t", number(0)) if form else derivative(left, "t")
    if field == "catastatic" and form is None:
        turned = add(*rates.values())
    if room.differs(turned, point):
        yield {"at": point.name}
    if form is None:
        return
    for a, b in combinations(form, 2) if field == "scleronomic" else ():
        back = negative(times(form[b], derivative(form[a], "t")))
        if room.differs(add(times(form[a], derivative(form[b], "t")), back), point):
            yield {"at": point.name, "pair": [a, b]}
