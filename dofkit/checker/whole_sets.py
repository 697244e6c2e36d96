"""The rule `everywhere`: the largest number of freedoms over all parts of a set."""

from dofkit.checker.dimension_rules import bounds
from dofkit.checker.evidence import CheckedEvidence, Told
from dofkit.checker.geometry import determinant, dot
from dofkit.checker.point import CheckedPoint, not_zero
from dofkit.checker.trees import ONE, derivative, refuse

MOST_FORMS, HIGHEST_DEGREE = 6, 4


def everywhere(evidence: CheckedEvidence, claim: Told, verified: Told) -> int:
    """The largest number over all parts of the set, from relations of four kinds, from which the others follow.

    ``order``: each relation has a coordinate, or its velocity, that those before do not hold. As a derivative by it is
    nowhere 0, a few values of that at most are left, whatever the others are. Where it is the first derivative of all,
    the finite ones are a graph, in one part if they are linear in what they give, and all have constant rank. Instead
    of a coordinate one may give t, of which almost all values are then regular, if nothing else is claimed (Sard 1942).
    ``gram``: forms without these velocities whose Gram determinant is positive by itself are independent everywhere.
    ``alone``: an analytic relation beside a graph, or the only form, depends on it on a part of less dimension at most.
    ``generic``: relations with a symbol of their own in which they are nowhere stationary: for almost all values of
    these they cut every manifold of those that the others consist of regularly (Sard 1942, Lojasiewicz 1965). Where
    all are generic, the set is a manifold of the rank that a cover of all shows (Federer 3.4.3).
    dof, where there are forms: that near a point (``most``, ``least``). None is larger where the geometric equations
    allow no more, or where all relations are named here, analytic, and the finite ones a graph: then orbits have the
    dimension that the brackets span, which is largest almost everywhere at once (Nagano 1966).
    """
    order, generic = claim.get("order", []), claim.get("generic", [])
    alone, gram = [claim["alone"]] if "alone" in claim else [], claim.get("gram", {"forms": [], "value": "1"})
    names = [*(name for name, _ in order), *gram["forms"], *alone, *(name for name, _ in generic)]
    size = len(evidence.problem.coordinates)
    evidence.follow(names, evidence.equations, None, "the relations")
    wanted = evidence.equations if claim["path"] == "/velocity_dof" else evidence.finite
    evidence.follow(wanted, names, None, "those that are named")
    fits = claim.get("about") == "everywhere" and len(set(names)) == len(names) and all(map(evidence.is_linear, names))
    fits = fits and not any(evidence.relation(name).leaf for name in names)
    refuse(not fits, "a relation stands twice or is not linear, or the claim is not about everywhere")
    forms = [name for name in names if evidence.relation(name).kind != "finite"]
    _independent_everywhere(evidence, gram, [f"{q}dot" for _, q in order])
    minor = evidence.accounts(evidence.minor(claim["minor"], names), names) if "minor" in claim else None
    rank, graph = len(minor.rows if minor else names), _is_graph(evidence, order, minor and minor.point) and not generic
    for name, letter in generic:
        refuse(not evidence.own_symbol(name, [letter]), f"`{letter}` is not the own symbol of `{name}`")
    refuse(alone and not (graph and forms in ([], alone)), "what stands alone stands beside a graph, and no form")
    smooth = all(_is_analytic(evidence, name, name in alone or not graph) for name in names)
    finite = [(name, q) for name, q in order if evidence.relation(name).kind == "finite"]
    smooth &= not graph or all(q not in evidence.slope(name, q).symbols for name, q in finite)
    refuse((not graph or alone or rank < len(names) or not minor) and not smooth, "it may not be one analytic part")
    timed = any(q == "t" for _, q in order) and (not graph or alone or evidence.moving or not minor)
    refuse(timed or (not minor and (alone or not graph)), "t is given beside others, or a point is needed")
    graph &= alone in ([], forms)
    refuse((forms or claim["path"] == "/velocity_dof") and not graph, "forms stand beside a graph")
    if minor:
        verified[f"{claim['path']} at"] = evidence.is_about("here", minor.point)
    refuse(rank > len(names), "there are more rows than relations that are named")
    if rank < len(names):
        (rows,) = (evidence.seen["covers", name] for name in claim["covers"])
        refuse(order or sorted(rows) != sorted(names), "one cover of all holonomic equations is needed")
    if not evidence.moving or claim["path"] == "/velocity_dof":
        return size - rank
    whole = evidence.closure(names, None).issuperset(evidence.equations)
    dof = bounds(evidence, {**claim, "about": "here"}, verified)
    refuse(dof != size - rank + len(forms) and not (whole and smooth and graph), "another part may be larger")
    return dof


def _independent_everywhere(evidence: CheckedEvidence, gram: Told, ordered: list[str]) -> None:
    """`CheckError` unless det(J D J^T) is as it is stated, and positive; D positive by itself (Cauchy and Binet)."""
    forms, scales = gram["forms"], {q: evidence.text(text) for q, text in gram.get("scales", {}).items()}
    relations = [evidence.relation(name) for name in forms]
    fits = all(form.kind == "velocity" and form.tree.symbols.isdisjoint(ordered) for form in relations)
    refuse(not fits or len(forms) > MOST_FORMS, "no form, one that holds a velocity that is given, or too many")
    value, coordinates = evidence.text(gram["value"]), evidence.problem.coordinates
    positive = all(evidence.is_nowhere_zero(tree, True) for tree in (value, *scales.values()))
    refuse(not positive, "the determinant or a scale is not positive by itself")
    rows = [[evidence.slope(name, q) for q in coordinates] for name in forms]
    scaled = [[scales.get(q, ONE) * slope for q, slope in zip(coordinates, row, strict=True)] for row in rows]
    matrix = [[dot(row, other) for other in scaled] for row in rows]
    evidence.identity(determinant(matrix), value, "the determinant of the forms")


def _is_analytic(evidence: CheckedEvidence, name: str, poles: bool) -> bool:
    """Whether a relation is analytic at all places; a form, or with ``poles``, up to a denominator."""
    checked = evidence.relation(name)
    return evidence.has_value_everywhere(checked.tree, poles or checked.kind != "finite") and not checked.tree.applied


def _is_graph(evidence: CheckedEvidence, order: list[list[str]], point: CheckedPoint | None) -> bool:
    """Whether first derivatives show it; `CheckError` where a relation does not give its coordinate."""
    later = [q for _, q in order]
    refuse(len({*later}) < len(later) or not {*later} <= {*evidence.variables}, "one coordinate for each relation")
    degrees = [degree(evidence, name, q, point) for name, q in order]
    for i, (name, q) in enumerate(order):
        checked = evidence.relation(name)
        dot = "dot" if checked.kind == "velocity" else ""
        refuse(not degrees[i] or q + dot == "tdot", f"`{name}` does not give `{q}` everywhere")
        refuse(not checked.tree.symbols.isdisjoint(q + dot for q in later[i + 1 :]), f"`{name}` holds what comes later")
    return {*degrees} <= {1}


def degree(evidence: CheckedEvidence, name: str, q: str, point: CheckedPoint | None, most: int = HIGHEST_DEGREE) -> int:
    """Return how often to differentiate a relation by what it gives until that is nowhere 0; 0 if that is not shown.

    It is so by itself; or made of parameters, for almost all of which it is not 0 as it is not at the point.
    """
    slope = evidence.slope(name, q)
    for often in range(1, 1 + (most if evidence.relation(name).kind == "finite" else 1)):
        plain = slope.symbols <= evidence.chosen and evidence.has_value_everywhere(slope)
        sure = evidence.ring.rational(slope) or evidence.is_nowhere_zero(slope)
        if sure or (plain and point and not_zero(point.value(slope))):
            return often
        slope = derivative(slope, q)
    return 0
