"""Constraints of distance: a link, a rigid set, a string over pulleys."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from itertools import chain, combinations, pairwise
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from dofkit.base.wording import many, verb
from dofkit.exact.matrices.sparse import along, less
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.real_values import Requirement
from dofkit.expressions.renaming import renamed, shape_of
from dofkit.expressions.tree import ONE, TIME, TWO, ZERO, Expr, add, coordinate, fn, mul, parameter, power, sqrt
from dofkit.expressions.vectors import Vec, difference, minus, square, square_between
from dofkit.scene.constraints.base import ConstraintBase
from dofkit.scene.fields import Value, as_written
from dofkit.scene.frames import Placed, between
from dofkit.scene.parts import Ends, Point, show_point
from dofkit.scene.symbols import Symbol
from dofkit.scene.world import World
from dofkit.system import Kinematics, Relation, TypeFacts, VelocityRow


def distance_rows(at: Kinematics) -> Iterator[VelocityRow]:
    """Yield the row (b - a).(v_b - v_a) for every two points a, b."""
    for j, k in combinations(range(len(at.points)), 2):
        arm: Sequence[Any] = [q - p for p, q in zip(at.points[j][1], at.points[k][1], strict=True)]
        yield along(arm, less(at.velocity(k), at.velocity(j)))


class Link(ConstraintBase):
    """|A - B|^2 - length^2 = 0, also in one dimension.

    ``length`` defaults to the distance in the reference configuration, and without one to a generic length.
    """

    type: Literal["link"] = Field(description="two points at a given distance")
    between: Ends = Field(description="the two points")
    length: Value | None = Field(None, description="their distance; may contain t; default: the reference distance")
    facts: ClassVar[TypeFacts] = TypeFacts(distance_rows, joint=True, bars=True, surface=True)
    symbol: ClassVar[Symbol] = Symbol(run="bar")

    def relations(self, world: World) -> Iterator[Relation]:
        first, second = (world.point(end, "between", i) for i, end in enumerate(self.between))
        if first.label == second.label or _same_place(first, second):
            hint = "name two different points"
            world.fault(f"a link needs two different points, not {first.label} twice", "between", 1, hint=hint)
            return
        given_length = None if self.length is None else world.expression(self.length, "length")
        if given_length is not None:
            reference_length = (
                sqrt(square_between(first.reference, second.reference))
                if first.reference and second.reference
                else None
            )
            _check_length(world, given_length, reference_length, f"{first.label} and {second.label} are", "apart")
        moving = given_length is not None and any(symbol.args[0] != "parameter" for symbol in given_length.symbols)
        if first.frame is None and second.frame is None and not moving:
            world.links.append((world.index, first.label, second.label))
        at_least_zero: tuple[Requirement, ...] = ()
        if given_length is not None and given_length.symbols and "call" not in given_length.functions:
            at_least_zero = ((given_length, ">="),)
        yield Relation(distance(world, first, second, given_length), domain=at_least_zero)

    @property
    def in_words(self) -> str:
        ends = "-".join(show_point(end) for end in self.between)
        return f"link {ends}" + ("" if self.length is None else f", length {as_written(self.length)}")


def _same_place(first: Placed, second: Placed) -> bool:
    return first.frame is not None and first.frame == second.frame and first.reference == second.reference


def distance(world: World, first: Placed, second: Placed, length: Expr | None) -> Expr:
    """Return |A - B|^2 - length^2 times its denominator; ``length`` None stands for the reference or a generic one."""
    known_square = square_between(first.reference, second.reference) if first.reference and second.reference else None
    if length is not None:
        squared = power(length, TWO)
        if squared.is_zero:
            world.warnings.append(
                f"the link {first.label}-{second.label} has length 0: one equation that is satisfied only "
                "where all coordinates agree; `coincident` states the same with regular equations"
            )
    elif known_square is not None:
        squared = known_square
        if known_square.is_zero:
            world.warnings.append(
                f"the points {first.label} and {second.label} of a link coincide in the reference configuration"
            )
    else:
        squared = world.fresh("L")
        symbols = (*chain.from_iterable(zip(second.over, first.over, strict=True)), squared)
        names = [str(s.args[1]) for s in symbols if s.op == "sym"]
        if first.frame is None and second.frame is None and len({*names}) == len(symbols):
            link = _link_of_particles(world.dimension)
            return renamed(link, dict(zip(shape_of(link).names, names, strict=True)))
    world.apart(first, second, squared)
    if known_square is not None and first.frame is not None and first.frame == second.frame:
        return difference(known_square, squared)
    arm, under = between(first, second)
    return difference(square(arm), squared if under is ONE else mul(squared, power(under, TWO)))


@cache
def _link_of_particles(dimension: int) -> Expr:
    """Return |A - B|^2 - L for two particles; its copies in other names have its shape, which is computed once."""
    first, second = (tuple([coordinate(f"{end}{k}") for k in range(dimension)]) for end in "AB")
    return difference(square(minus(second, first)), parameter("_L"))


def _check_length(world: World, length: Expr, reference_length: Expr | None, before: str, after: str) -> None:
    """Record a fault for a ``length`` that is negative or at time 0 not ``reference_length``."""
    start = substitute(length, {TIME: ZERO})
    figure = approximate(start)
    if figure is not None and figure < 0:
        world.fault(f"a length cannot be negative ({figure:.6g})", "length", hint=f"write `length: {-figure:.6g}`")
    if reference_length is None or not world.differs(difference(power(start, TWO), power(reference_length, TWO))):
        return
    measured = approximate(reference_length)
    measurement = f"{before} {_figure(measured)} {after}"
    message = f"the length {_figure(figure)} contradicts the reference configuration, where {measurement}"
    hint = f"write `length: {_figure(measured)}` or leave it out; set `tolerance` if it is measured"
    off = None if figure is None or measured is None else figure - measured
    world.misfit(off, message, "length", hint=hint)


def _figure(number: float | None) -> str:
    return "?" if number is None else f"{number:.12g}"


class Rigid(ConstraintBase):
    """|A - B|^2 - d_AB^2 = 0 for every pair of the m members: m(m-1)/2 relations."""

    type: Literal["rigid"] = Field(description="particles that keep all their distances")
    members: Annotated[tuple[str, ...], Field(min_length=2)] = Field(description="particles")
    facts: ClassVar[TypeFacts] = TypeFacts(distance_rows, joint=True, bars=True, complete=True)
    symbol: ClassVar[Symbol] = Symbol(run="bars")

    def relations(self, world: World) -> Iterator[Relation]:
        seen: set[str] = set()
        placed = []
        for i, member in enumerate(self.members):
            if member in seen:
                world.fault(f"'{member}' is named twice", "members", i, hint="name every particle once")
                continue
            seen.add(member)
            placed.append(world.particle(member, "members", i))
        for first, second in combinations(placed, 2):
            world.links.append((world.index, first.label, second.label))
            yield Relation(distance(world, first, second, None), part=f"length {first.label}-{second.label}")

    def notes(self, world: World) -> Iterator[str]:
        n, d = len(self.members), world.dimension
        if n <= d + 1:
            return
        links, freedom = n * (n - 1) // 2, d * (d + 1) // 2
        yield (
            f"Of the N(N-1)/2 = {links} links among N = {n} particles only N d - d(d+1)/2 = {n * d} - {freedom} = "
            f"{n * d - freedom} are independent (in general position): once d+1 = {d + 1} of the particles are rigid, "
            f"{many(d, 'link')} {verb(d, 'fixes', 'fix')} each further one, and its other links are redundant. "
            "Counting every link fails for N > d+1."
        )

    @property
    def in_words(self) -> str:
        return "rigid " + ", ".join(self.members)


class String(ConstraintBase):
    """A taut string along points in order: |P1 - P2| + |P2 - P3| + ... - length = 0, one relation.

    The points between the ends are small pulleys. ``length`` defaults to the length in the reference configuration, and
    without one to a generic length.
    """

    type: Literal["string"] = Field(description="an inextensible string over small pulleys")
    along: Annotated[tuple[Point, ...], Field(min_length=2)] = Field(description="the points it runs along, in order")
    length: Value | None = Field(None, description="its length; may contain t; default: the reference length")
    facts: ClassVar[TypeFacts] = TypeFacts(string=True)
    symbol: ClassVar[Symbol] = Symbol(run="rope")

    def relations(self, world: World) -> Iterator[Relation]:
        points = [world.point(point, "along", i) for i, point in enumerate(self.along)]
        lengths, reference_lengths = [], []
        for i, (first, second) in enumerate(pairwise(points)):
            if first.label == second.label or _same_place(first, second):
                world.fault(f"the string passes {first.label} twice in a row", "along", i + 1)
                return
            arm, under = between(first, second)
            lengths.append(_length(arm) / under)
            if first.reference is not None and second.reference is not None:
                reference_lengths.append(sqrt(square_between(first.reference, second.reference)))
        total = add(*reference_lengths) if len(reference_lengths) == len(lengths) else None
        if self.length is not None:
            given_length = world.expression(self.length, "length")
            _check_length(world, given_length, total, "the string is", "long")
        else:
            given_length = world.fresh("L") if total is None else total
        for first, second in combinations(points, 2):
            if first.label != second.label:
                world.apart(first, second, power(given_length, TWO), at_most=True)
        yield Relation(difference(add(*lengths), given_length))

    @property
    def in_words(self) -> str:
        run = "-".join(show_point(point) for point in self.along)
        return f"string {run}" + ("" if self.length is None else f", length {as_written(self.length)}")


def _length(arm: Vec) -> Expr:
    return fn("abs", arm[0]) if len(arm) == 1 else sqrt(square(arm))
