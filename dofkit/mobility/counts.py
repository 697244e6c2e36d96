"""Counts of mobility by textbook formulas, and the reason if they differ from the true freedom.

f = N d - k counts coordinates and equations, with d(d+1)/2 for a rigid body. Gruebler and Kutzbach count bodies and
joints: M = D(N - 1 - j) + f_1 + ... + f_j with D = 3 in the plane and 6 in space assumes that every loop has D
independent closure conditions. It has only as many as the joint screws (twists that the joints allow) of the loop are
independent: 3 if all hinges are parallel or meet in one point, 3 for Bennett's four [GrueblerKutzbach] [Bennett1903].
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from dofkit.base.libraries import nx
from dofkit.base.wording import many, verb
from dofkit.exact.matrices.sparse import SparseRow, rank_of_rows
from dofkit.exact.residues import null_vectors, residue_matrix
from dofkit.mobility.placement import TURNS, Located, Member, Placement, rows_of
from dofkit.report import ConstraintEntry, Count, Mobility
from dofkit.system import DRIVE, GROUND, System

#: Bounds on the loops that are analysed one by one, and on those that are listed.
MOST_LOOPS, MOST_TOLD = 60, 4

#: A function that computes the placement at the reference configuration.
PlacementMaker = Callable[[], Placement | None]


@dataclass(frozen=True)
class CountedJoint:
    """A joint (a constraint) between two bodies, or a body and the ground; ``freedom``: its own, without its drive."""

    constraint: int
    first: str
    second: str
    freedom: int
    driven: bool


def joints_of(system: System, equations: Sequence[int]) -> list[CountedJoint]:
    """Return the constraints that count as joints; ``equations``: the number of equations of every constraint."""
    moving = set(system.bodies)
    whole = freedom_of_body(system)
    joints = []
    for c in system.connections:
        members = [m for m in c.members if m != GROUND]
        if not c.facts.joint or not members or len(members) > 2 or not moving.issuperset(members):
            continue
        first, second = (GROUND, *members)[-2:]
        freedom = whole - equations[c.constraint] + c.driven
        joints.append(CountedJoint(c.constraint, first, second, freedom, c.driven))
    return joints


def without_drives(system: System) -> System | None:
    """Return the system with every drive of a joint released; None if no joint is driven."""
    driven = {c.constraint for c in system.connections if c.driven}
    if not driven:
        return None
    return replace(
        system,
        constraints=tuple(
            c._replace(relations=[r for r in c.relations if r.part != DRIVE]) if i in driven else c
            for i, c in enumerate(system.constraints)
        ),
        connections=tuple(c._replace(driven=False) for c in system.connections),
    )


def freedom_of_body(system: System) -> int:
    """Return d (d + 1) / 2, the degrees of freedom of a free body."""
    return system.dimension * (system.dimension + 1) // 2


def kutzbach_count(
    system: System, equations: Sequence[int], freedom: int | None, placed: PlacementMaker
) -> Mobility | None:
    """Return Kutzbach's count, and why it is not ``freedom``; None without joints. ``equations``: by constraint."""
    joints = joints_of(system, equations)
    if not joints:
        return None
    whole, bodies = freedom_of_body(system), len(system.bodies)
    terms = _terms(system, joints, sum(equations) - sum(equations[j.constraint] for j in joints))
    base = whole * (bodies - len(joints)) + sum(j.freedom for j in joints)
    kutzbach = base + sum(number for _, number, _ in terms)
    letters = "".join(f" {sign} {letter}" for sign, _, letter in terms)
    numbers = "".join(f" {sign} {abs(number)}" for sign, number, _ in terms)
    formula = (
        f"M = {whole}(N - 1 - j) + sum f{letters} = "
        f"{whole}({bodies + 1} - 1 - {len(joints)}) + {sum(j.freedom for j in joints)}{numbers} = {kutzbach}"
    )
    return Mobility(
        links=bodies + 1,
        joints=len(joints),
        formula=formula,
        kutzbach=kutzbach,
        freedom=freedom,
        differs=None if freedom is None or freedom == kutzbach else _why(system, joints, kutzbach, freedom, placed),
    )


def _terms(system: System, joints: Sequence[CountedJoint], equations: int) -> list[tuple[str, int, str]]:
    """Return (sign, signed number, what it counts) of each nonzero term after those of bodies and joints."""
    driven = sum(j.driven for j in joints)
    owned = freedom_of_body(system) * len(system.bodies) + system.dimension * len(system.particles)
    further = len(system.coordinates) - owned
    terms = [
        ("-", -driven, "driven joints"),
        ("+", system.dimension * len(system.particles), f"{system.dimension} per particle"),
        ("+", further, "further coordinates"),
        ("-", -equations, "other equations"),
    ]
    return [term for term in terms if term[1]]


def _why(system: System, joints: Sequence[CountedJoint], kutzbach: int, freedom: int, placed: PlacementMaker) -> str:
    """Return why the freedom differs from the count."""
    if freedom < kutzbach:
        return (
            "the equations remove more degrees of freedom than their number: this configuration is special, or they "
            "imply further equations"
        )
    placement = placed()
    cause = "" if placement is None else _of_screws(system, joints, freedom, placement)
    more = freedom - kutzbach
    start = f"{more} of the equations that are counted as independent {verb(more, 'depends', 'depend')} on the others"
    return f"{start}: {cause}" if cause else start


def _of_screws(system: System, joints: Sequence[CountedJoint], freedom: int, placement: Placement) -> str:
    """Return a reason by the dimension of the span of the joint screws, of all joints or loop by loop."""
    whole, d = freedom_of_body(system), system.dimension
    names = [c.name for c in system.constraints]
    screws = {j: allowed(placement.located[j.constraint], d, placement.p) for j in joints}
    span = rank_of_rows([s for j in joints for s in screws[j]], placement.p)
    only_joints = len(system.constraints) == len(joints)
    bodies, total = len(system.bodies), sum(j.freedom for j in joints)
    driven = sum(j.driven for j in joints)
    count = span * (bodies - len(joints)) + total - driven
    if span < whole and only_joints and count == freedom:
        numbers = f"{span}({bodies + 1} - 1 - {len(joints)}) + {total}{f' - {driven}' if driven else ''} = {count}"
        return (
            f"the joint screws form a {span}-system, not a {whole}-system; "
            f"with {span} in place of {whole} the count is {numbers}"
        )
    closures = []
    loops = _loops(joints)
    for loop in loops[:MOST_LOOPS]:
        span = rank_of_rows([s for j in loop for s in screws[j]], placement.p)
        if span < whole:
            closures.append(_closure([names[j.constraint] for j in loop], loop, span, whole))
    more = f"; and {many(len(closures) - MOST_TOLD, 'more loop')}" if len(closures) > MOST_TOLD else ""
    if closures:
        return "; ".join(closures[:MOST_TOLD]) + more
    return "together the loops impose fewer conditions than separately" if len(loops) > 1 else ""


def _closure(names: Sequence[str], loop: Sequence[CountedJoint], span: int, whole: int) -> str:
    """Return the sentence on a loop whose screws have the rank ``span``, less than the ``whole`` of a body."""
    if len(loop) == 2 and all(j.freedom == span for j in loop):
        return f"{names[0]} and {names[1]} allow the same bodies the same motions"
    conditions = many(span, "condition")
    return f"the loop {', '.join(names)} closes by {conditions}, not {whole}: its screws form a {span}-system"


def allowed(joint: Located, dimension: int, p: int) -> list[SparseRow]:
    """Return a basis of the twists that a joint allows its last body relative to the other, at the origin, modulo p."""
    size = dimension + TURNS[dimension]
    ground, free = Member(None), Member(0, (0,) * dimension)
    bodies = [m for m in joint.members if m.column is not None]
    ends = {id(bodies[-1]): free}
    members = tuple(ends.get(id(m), ground) for m in joint.members)
    points = tuple((ends.get(id(m), ground), at) for m, at in joint.points)
    rows = rows_of(replace(joint, members=members, points=points, driven=False)) or ()
    return _kernel([{c: v % p for c, v in row.items() if v % p} for row in rows], size, p)


def _kernel(rows: Sequence[SparseRow], size: int, p: int) -> list[SparseRow]:
    """Return a basis of the kernel of sparse rows modulo p."""
    matrix = residue_matrix([[row.get(c, 0) for c in range(size)] for row in rows] or [[0] * size], p)
    return [{c: int(v) for c, v in enumerate(vector) if v} for vector in null_vectors(matrix)]


def _loops(joints: Sequence[CountedJoint]) -> list[list[CountedJoint]]:
    """Return a basis of the loops: for every joint that closes one, the path between its ends in a spanning tree."""
    tree: nx.Graph = nx.Graph()
    trees: nx.utils.UnionFind[str] = nx.utils.UnionFind()
    closing = []
    for j in joints:
        if trees[j.first] == trees[j.second]:
            closing.append(j)
        else:
            trees.union(j.first, j.second)
            tree.add_edge(j.first, j.second, joint=j)
    loops = []
    for j in closing[:MOST_LOOPS]:
        path = nx.shortest_path(tree, j.first, j.second) if j.first != j.second else [j.first]
        around = [tree.edges[a, b]["joint"] for a, b in pairwise(path)]
        loops.append(sorted([*around, j], key=lambda joint: joint.constraint))
    return loops


# f = N d - k


@dataclass(frozen=True)
class CountedFacts:
    """The numbers with which f = N d - k is compared, such as those of ``written`` and ``hidden`` equations."""

    written: int
    dof: int | None
    consistent: bool | None
    hidden: int
    entries: Sequence[ConstraintEntry]


def count(system: System, facts: CountedFacts) -> Count:
    """Return the textbook count f = N d - k of all geometric equations as written, and why it differs."""
    coordinates = len(system.coordinates)
    naive = coordinates - facts.written
    return Count(
        particles=len(system.particles),
        bodies=len(system.bodies),
        dimension=system.dimension,
        coordinates=coordinates,
        constraints=facts.written,
        independent=None if facts.dof is None else coordinates - facts.dof,
        naive_dof=naive,
        formula=formula(system, facts.written),
        errs=why(system, facts, naive),
    )


def formula(system: System, written: int) -> str:
    """Return the count as a line of text with its numbers."""
    d, terms, numbers = system.dimension, [], []
    if system.particles:
        terms.append("N d")
        numbers.append(f"{len(system.particles)}*{d}")
    if system.bodies:
        terms.append("B d(d+1)/2")
        numbers.append(f"{len(system.bodies)}*{d * (d + 1) // 2}")
    owned = len(system.particles) * d + len(system.bodies) * d * (d + 1) // 2
    further = len(system.coordinates) - owned
    if further or not terms:
        terms.append("n")
        numbers.append(str(further))
    return f"f = {' + '.join(terms)} - k = {' + '.join(numbers)} - {written} = {len(system.coordinates) - written}"


def why(system: System, facts: CountedFacts, naive: int) -> str | None:
    """Return why the textbook count ``naive`` is not the degrees of freedom; None if equal or not known."""
    if facts.consistent is False:
        return "no motion satisfies all constraints, so there are no degrees of freedom to count"
    if facts.dof is None or facts.dof == naive:
        return None
    reasons = []
    if facts.dof > naive:
        most = facts.written - facts.dof + naive  # fewer are independent if others remove freedom too
        only = "only" if most == sum(e.independent or 0 for e in facts.entries if e.form == "finite") else "at most"
        reasons.append(
            "the geometric equation removes no degree of freedom"
            if facts.written == 1
            else f"{only} {most} of the {facts.written} geometric equations {verb(most)} independent: "
            "a dependent equation removes no degree of freedom"
        )
        reasons += complete_sets(system)
    if facts.dof < naive:
        reasons += _why_fewer(facts)
    return "; ".join(reasons)


def _why_fewer(facts: CountedFacts) -> list[str]:
    """Return reasons for less freedom than the count of the geometric equations as written."""
    forms = [e for e in facts.entries if e.form in ("pfaffian", "nonlinear")]
    integrable = [e.name for e in forms if e.holonomic]
    reasons = []
    if integrable:
        verb = "integrates to a geometric equation" if len(integrable) == 1 else "integrate to geometric equations"
        reasons.append(f"{', '.join(integrable)} {verb}, which the count does not include")
    if facts.hidden:
        reasons.append(
            f"the differential constraints imply {many(facts.hidden, 'geometric equation')} besides those written"
        )
    if forms and not reasons:
        reasons.append("a combination of the differential constraints integrates to a geometric equation")
    if not reasons:
        reasons.append(
            "over the reals one equation imposes several conditions, so it removes more than one degree of freedom"
        )
    return reasons


def complete_sets(system: System) -> list[str]:
    """Return sentences on complete sets of N > d+1 linked particles: only N d - d(d+1)/2 links are independent."""
    d = system.dimension
    sentences = []
    for constraint in system.constraints:
        if not constraint.facts.complete:
            continue
        links = len(constraint.relations)
        n = round((1 + (1 + 8 * links) ** 0.5) / 2)
        if n > d + 1:
            sentences.append(
                f"of the N(N-1)/2 = {links} links among N = {n} particles in {many(d, 'dimension')} only "
                f"N d - d(d+1)/2 = {n * d - d * (d + 1) // 2} are independent, because N > d+1 = {d + 1}"
            )
    return sentences
