"""Relations that are linear in the velocities on each side of some planes: abs(xdot) + abs(ydot) = abs(zdot).

At a configuration every choice of the signs of what stands in abs() leaves a polyhedron of velocities. Two of them that
share a velocity at which one sign alone changes are joined in motion, if the relations tell it from rest: a motion
passes from one to the other without a stop. What is reached along the fields of several polyhedra is then reached by
motions [Krener1974], so that no finite relation holds on all of these but what the smallest affine space around the
polyhedra leaves.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations
from itertools import product as cartesian
from typing import NamedTuple

from flint import arb, fmpq

from dofkit.base.libraries import nx
from dofkit.configuration.states import state_relations
from dofkit.exact.errors import NoValueError
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.points.frames import Pivots, certified_rank, kernel, solve
from dofkit.exact.ring.instructions import Scalar
from dofkit.exact.solving.linear_inequalities import LinearCondition, solution
from dofkit.expressions.tree import Expr
from dofkit.relations.blocks import Row
from dofkit.relations.normal.normal_form import linear_form, velocities_of
from dofkit.relations.normal.pieces import Pfaffian
from dofkit.relations.normal.signs import arguments_of, with_signs

#: What stands in abs(), of all relations of a block together.
MAX_ARGUMENTS = 5

Balls = list[list[arb]]


class SignedForms(NamedTuple):
    """For one choice of signs: the forms that vanish, and those that are >= 0, one for each sign."""

    signs: tuple[int, ...]
    relations: tuple[Pfaffian, ...]
    sides: tuple[Pfaffian, ...]


class VelocityFan(NamedTuple):
    """``linear`` forms vanish for all choices of signs; ``bent``: how many relations depend on these."""

    linear: tuple[Pfaffian, ...]
    choices: tuple[SignedForms, ...]
    bent: int

    @property
    def coefficients(self) -> list[Expr]:
        """Everything that is evaluated."""
        forms = [*self.linear, *(f for c in self.choices for f in (*c.relations, *c.sides))]
        return list(dict.fromkeys(e for f in forms for e in (*f.coefficients.values(), f.dt)))


def velocity_fan(rows: Sequence[Row], hidden: Sequence[Expr]) -> VelocityFan | None:
    """The forms for each choice of signs; None where one is not linear, or there are many."""
    forms = {e: linear_form(e) for e in state_relations(rows, hidden) if velocities_of(e)}
    bent = [e for e, form in forms.items() if form is None]
    arguments = list(dict.fromkeys(u for e in bent for u in arguments_of(e) if velocities_of(u)))
    if not 0 < len(arguments) <= MAX_ARGUMENTS:
        return None
    choices = []
    for signs in cartesian((1, -1), repeat=len(arguments)):
        chosen = dict(zip(arguments, signs, strict=True))
        told = [f for e in bent if (f := linear_form(with_signs(e, chosen))) is not None]
        sides = [f for u, s in chosen.items() if (f := linear_form(with_signs(u, chosen) * s)) is not None]
        if len(told) < len(bent) or len(sides) < len(arguments):
            return None
        choices.append(SignedForms(signs, tuple(told), tuple(sides)))
    return VelocityFan(tuple(f for f in forms.values() if f is not None), tuple(choices), len(bent))


class Polyhedron(NamedTuple):
    """Rows (a, b), a . v + b: those of ``relations`` are 0, those of ``sides`` >= 0."""

    signs: tuple[int, ...]
    relations: Balls
    sides: Balls

    def directions(self) -> Balls | None:
        """A basis of the velocities along it."""
        matrix = _without_constants(self.relations)
        part = ball_part(matrix)
        free = tuple(c for c in range(len(matrix[0])) if c not in set(part.columns))
        try:
            return kernel(matrix, Pivots(tuple(part.rows), tuple(part.columns), free), arb(0))
        except NoValueError:
            return None


def joined_span(fan: VelocityFan, at: dict[Expr, Scalar], coordinates: Sequence[str], left: int) -> bool:
    """Do polyhedra joined in motion lie in no less than the ``left`` velocities of the linear forms?

    ``at``: the coefficients at a certified configuration. Every polyhedron is to be smaller by as many as are bent.
    """
    linear = [_row(f, at, coordinates) for f in fan.linear]
    cells = [
        Polyhedron(
            c.signs,
            [*linear, *(_row(f, at, coordinates) for f in c.relations)],
            [_row(f, at, coordinates) for f in c.sides],
        )
        for c in fan.choices
    ]
    rank = len(coordinates) - left
    if linear and certified_rank(_without_constants(linear)) != rank:
        return False
    if any(certified_rank(_without_constants(c.relations)) != rank + fan.bent for c in cells):
        return False
    graph: nx.Graph = nx.Graph()
    graph.add_edges_from((a, b) for a, b in combinations(range(len(cells)), 2) if _joined(cells[a], cells[b], fan.bent))
    return any(_span(cells[k] for k in part) == left for part in nx.connected_components(graph))


def _row(form: Pfaffian, at: dict[Expr, Scalar], coordinates: Sequence[str]) -> list[arb]:
    """The coefficients of a form, and its constant."""
    return [*(at[form.coefficients[c]] if c in form.coefficients else arb(0) for c in coordinates), at[form.dt]]


def _without_constants(rows: Balls) -> Balls:
    return [row[:-1] for row in rows]


def _span(cells: Iterable[Polyhedron]) -> int:
    vectors = [v for cell in cells for v in cell.directions() or ()]
    return certified_rank(vectors)


def _joined(one: Polyhedron, other: Polyhedron, bent: int) -> bool:
    """Do two polyhedra that differ in one sign share a velocity on the sides of all others, told from rest?

    The forms that depend on signs, without their constants, are not all 0 there: what they do not see may move anyway.
    """
    different = [k for k, (s, t) in enumerate(zip(one.signs, other.signs, strict=True)) if s != t]
    if len(different) != 1:
        return False
    (k,) = different
    rows = [*one.relations, one.sides[k]]
    strict = [row for i, row in enumerate(one.sides) if i != k]
    part = ball_part(_without_constants(rows))
    if part.rank <= ball_part(_without_constants(one.relations)).rank:
        return False
    kept = [rows[r] for r in part.rows]
    moving = [[*row[:-1], arb(0)] for row in (*one.relations[-bent:], *one.sides)]
    both = [way for row in moving for way in (row, [-v for v in row])]
    return any(_holds_at_a_solution(kept, part.columns, [*strict, way]) for way in both)


def _holds_at_a_solution(rows: Balls, pivots: Sequence[int], strict: Balls) -> bool:
    """Is there a true solution of independent rows at which others are > 0? One of near rows shows where."""
    near = solution([*(_near(r, "=") for r in rows), *(_near(r, ">") for r in strict)])
    if not near:
        return False
    free = [c for c in range(len(near)) if c not in set(pivots)]
    known = [sum((row[c] * near[c] for c in free), row[-1]) for row in rows]
    try:
        solved = solve([[row[c] for c in pivots] for row in rows], [[-v] for v in known])
    except NoValueError:
        return False
    v = [arb(x) for x in near]
    for c, (value,) in zip(pivots, solved, strict=True):
        v[c] = value
    return all(sum((a * x for a, x in zip(row, v, strict=False)), row[-1]) > 0 for row in strict)


def _near(row: Sequence[arb], sense: str) -> LinearCondition:
    """The row with the middles of its balls."""
    *coefficients, constant = (fmpq(v.mid().fmpq()) for v in row)
    return LinearCondition(tuple(coefficients), constant, "=" if sense == "=" else ">")
