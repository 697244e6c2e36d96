"""A relation between the angles and displacements of joints, such as gears, belts, differentials and mimic joints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import gcd, inf, isfinite, lcm, pi
from typing import Annotated, ClassVar, Literal, NamedTuple

from pydantic import Discriminator, Field, Tag, WrapValidator

from dofkit.base.errors import NoValueError
from dofkit.exact.matrices.sparse import combined
from dofkit.expressions.calculus import diff, linear_terms, substitute
from dofkit.expressions.enclosures import approximate
from dofkit.expressions.text import why_invalid
from dofkit.expressions.tree import MINUS_ONE, ONE, TIME, ZERO, Expr, coordinate, mul
from dofkit.expressions.vectors import difference, dot, length
from dofkit.scene.constraints.base import ConstraintBase, root, with_values
from dofkit.scene.constraints.joint_parts import JointGeometry, Measure, half_angle
from dofkit.scene.constraints.joints import Driven
from dofkit.scene.fields import Text, untagged
from dofkit.scene.frames import Frame
from dofkit.scene.ledger import FINITE
from dofkit.scene.names import within_member
from dofkit.scene.symbols import Symbol
from dofkit.scene.world import World
from dofkit.system import JointRate, Kinematics, Relation, TypeFacts, VelocityRow

#: A relation sum k_i angle_i = 0 with integers k_i is written without inverse functions up to this sum of the |k_i|.
MOST_TURNS = 8


def _coupling_rows(at: Kinematics) -> Iterator[VelocityRow]:
    """Yield the row of the sum over the joints: derivative of the relation by the joint, times the joint's rate."""
    if at.couplings:
        yield combined([(factor, rate(part)) for rate, factor, part in at.couplings])


def _shape(value: object) -> str:
    return "lettered" if isinstance(value, Mapping) else "named"


#: Names of joints, or a mapping from letters.
Joints = Annotated[
    Annotated[dict[str, str], Tag("lettered")] | Annotated[tuple[str, ...], Tag("named")],
    Discriminator(_shape),
    WrapValidator(untagged),
]


class Coupling(ConstraintBase):
    """f(q1, q2, ...) = 0 for angles and displacements q of joints: 1 relation; an inequality bounds them.

    Each q counts from the reference configuration: the angle of the second body relative to the first, right-handed
    about the axis n, or the displacement along n. In space tan(q/2) = v.n / (s |n|) with the quaternion (s, v) of the
    relative rotation. An equation that is linear in angles with small integer factors k is written as Im prod (s |n| +
    i v.n)^k = 0, which determines the angles modulo whole turns.
    """

    type: Literal["coupling"] = Field(description="a relation between angles or displacements of joints")
    joints: Joints = Field(
        description="names of joints, or a mapping letter -> joint; for one that both turns and slides, `JOINT.angle` "
        "or `JOINT.displacement`"
    )
    text: Text = Field(description="the relation, such as `elbow = 2 shoulder`; may contain t")
    dimensions: ClassVar[tuple[int, ...]] = (2, 3)
    facts: ClassVar[TypeFacts] = TypeFacts(_coupling_rows)
    symbol: ClassVar[Symbol] = Symbol(run="locus")

    @property
    def lettered(self) -> dict[str, str]:
        """The joint's name for every letter; a name in a list is its own letter."""
        return dict(self.joints) if isinstance(self.joints, Mapping) else {name: name for name in self.joints}

    def relations(self, world: World) -> Iterator[Relation]:
        measured = self._measured(world)
        letters = tuple(self.lettered)
        names = replace(within_member(world.names, letters), coordinates=frozenset(letters))
        before = len(world.faults)
        relations = world.relations(self.text, "text", names=names, allow=FINITE)
        if measured is None or len(world.faults) > before:
            return
        senses = {relation.sense for relation in relations}
        if "=" in senses and len(relations) > 1:
            world.fault(
                "a coupling is either one equation or bounds", "text", hint="write a second coupling for the other one"
            )
            return
        bounds = [relation.expr for relation in relations]
        if "=" not in senses and not self._within_half_turns(world, bounds, measured):
            return
        for relation in relations:
            if relation.sense == "=" and not self._fits(world, relation.expr, measured):
                return
            in_arcs = with_values(relation, {letter: joint.value for letter, joint in measured.items()})
            yield in_arcs._replace(expr=_in_turns(relation.expr, measured) or in_arcs.expr)

    def _within_half_turns(self, world: World, bounds: Sequence[Expr], measured: Mapping[Expr, MeasuredJoint]) -> bool:
        """Return whether bounds on angles in space lie within half a turn of the reference; if not, record a fault.

        The angle is measured between -pi and pi: a bound beyond would exclude every configuration.
        """
        message = (
            "an angle in space is measured from the reference configuration, between -pi and pi, and these bounds lie "
            "beyond"
        )
        if any(_most(e, measured) < 0 for e in bounds):
            world.fault(message, "text", hint="choose a reference configuration nearer to the middle of their ranges")
            return False
        for letter, joint in measured.items():
            low, high = _bounds_of(letter, bounds) if joint.turns_in_space else (-inf, inf)
            if _stated_by_arcs(low, high):
                continue
            hint = "choose a reference configuration nearer to the middle of its range, or subtract whole turns"
            world.fault(message, "text", hint=hint)
            return False
        return True

    def _measured(self, world: World) -> dict[Expr, MeasuredJoint] | None:
        """Return the measured joint for every letter; None after a fault, here or in one of the joints."""
        before = len(world.faults)
        joints = {coordinate(letter): self._joint(world, letter, name) for letter, name in self.lettered.items()}
        measured = {letter: joint for letter, joint in joints.items() if joint is not None}
        return measured if len(measured) == len(joints) and len(world.faults) == before else None

    def _joint(self, world: World, letter: str, written: str) -> MeasuredJoint | None:
        """Return the joint that is ``written`` for a letter, such as `shoulder` or `nut.angle`; None after a fault."""
        why = why_invalid(letter)
        if why is not None:
            world.fault(why, "joints", letter, hint=f'write a letter for it: `joints: {{q: "{written}"}}`')
            return None
        name, what = _split(written, world.entries)
        joint = world.entries.get(name)
        if joint is None:
            joints = [key for key, entry in world.entries.items() if isinstance(entry, Driven)]
            world.unknown("joint", name, joints, "joints", letter)
            return None
        measures = joint.measures() if isinstance(joint, Driven) else {}
        if not isinstance(joint, Driven) or (not what and len(measures) != 1) or (what and what not in measures):
            choices = " or ".join(f"`{name}.{key}`" for key in measures)
            hint = f"write {choices}" if choices else "name a revolute, prismatic, cylindrical or screw joint"
            world.fault(f"'{written}' is not an angle or a displacement of a joint", "joints", letter, hint=hint)
            return None
        what = what or next(iter(measures))
        measured = self._located(world, letter, joint, measures[what])
        return None if measured is None else measured._replace(name=f"{name}.{what}")

    def _located(self, world: World, letter: str, joint: Driven, measure: Measure) -> MeasuredJoint | None:
        """Return the joint with its geometry in the reference configuration; None after a fault."""
        planar, placed = world.dimension == 2 and measure.turns, joint.holds.placed and not measure.turns
        if any(end not in world.frames and end != world.ground.name for end in joint.between):
            return None
        if (joint.axis is None and not planar) or (joint.at is None and placed):
            hint = "give the joint its `at` and `axis`"
            world.fault("a joint in general position has no angle that a coupling can use", "joints", letter, hint=hint)
            return None
        axis = None if planar else world.reference_direction(joint.axis)
        place = world.reference_vector(joint.at) if joint.holds.placed else None
        if (axis is None and not planar) or (place is None and placed):
            return None
        first, second = (world.frame(end, "joints", letter) for end in joint.between)
        world.placed.update(joint.between)
        return MeasuredJoint(first, second, JointGeometry(place, () if axis is None else (axis,)), measure, "")

    def _fits(self, world: World, e: Expr, measured: Mapping[Expr, MeasuredJoint]) -> bool:
        """Record the joints' rates at the reference, where all are at 0; return False if ``e`` has no value there."""
        at: dict[Expr, Expr] = {**dict.fromkeys(measured, ZERO), TIME: ZERO}
        try:
            gap = substitute(e, at)
            slopes = {letter: substitute(diff(e, letter), at) for letter in measured}
        except NoValueError:
            message = "the relation has no value or no derivative in the reference configuration"
            world.fault(f"{message}, where every joint is at 0", "text")
            return False
        for letter, joint in measured.items():
            if not slopes[letter].is_zero:
                world.mentioned.rates.append(joint.rate(slopes[letter]))
        if world.differs(gap):
            off, steep = approximate(gap), root(dot(tuple(slopes.values()), tuple(slopes.values())))
            message = "the reference configuration, where every joint is at 0, contradicts the relation"
            message += "" if off is None else f" by {abs(off):.6g}"
            hint = "angles and displacements are measured from the reference configuration"
            world.misfit(None if off is None or not steep else off / steep, message, "text", hint=hint)
        return True

    def texts(self) -> Iterator[str]:
        yield from ()

    @property
    def in_words(self) -> str:
        named = [f"{letter}: {name}" for letter, name in self.lettered.items() if letter != name]
        return f"coupling {self.text}" + (f" ({', '.join(named)})" if named else "")


class MeasuredJoint(NamedTuple):
    """A joint with its geometry in the reference configuration, and the angle or displacement that is measured."""

    first: Frame
    second: Frame
    geometry: JointGeometry
    measure: Measure
    name: str

    @property
    def turns_in_space(self) -> bool:
        """Whether an angle about an axis in space is measured."""
        return self.measure.turns and bool(self.geometry.axes)

    @property
    def value(self) -> Expr:
        """The measured angle or displacement."""
        return self.measure.value(self.first, self.second, self.geometry)

    def rate(self, slope: Expr) -> JointRate:
        """Return the joint's term in the rate of a relation whose derivative by the joint is ``slope``."""
        axis = self.geometry.axis.vector if self.geometry.axes else ()
        return JointRate(
            self.name,
            slope,
            self.measure.rate,
            (self.first.name, self.second.name),
            self.geometry.place or (ZERO,) * self.first.dimension,
            axis,
            slope / length(axis) if axis else slope,
            not self.measure.turns,
        )

    def half(self) -> tuple[Expr, Expr] | None:
        """Return (cosine, sine) of half the angle, times a positive factor; None without two Gibbs vectors."""
        return half_angle(self.first, self.second, self.geometry) if self.turns_in_space else None


def _most(e: Expr, measured: Mapping[Expr, MeasuredJoint]) -> float:
    """Return the maximum of a linear ``e`` in several angles in space, each at most pi; infinity for other ``e``."""
    slopes = {letter: approximate(diff(e, letter)) for letter in measured}
    moving = [letter for letter, slope in slopes.items() if slope != 0]
    at = approximate(substitute(e, dict.fromkeys(measured, ZERO)))
    turning = all(measured[letter].turns_in_space for letter in moving)
    if at is None or None in slopes.values() or len(moving) < 2 or not turning:
        return inf
    return at + pi * sum(abs(slope or 0.0) for slope in slopes.values())


def _stated_by_arcs(low: float, high: float) -> bool:
    """Return whether bounds on the angle between -pi and pi mean the same as bounds on the accumulated angle."""
    if not isfinite(low + high):
        return low < pi and high > -pi
    return (-pi <= low and high <= pi) or (low <= -pi and high >= pi)


def _bounds_of(letter: Expr, relations: Sequence[Expr]) -> tuple[float, float]:
    """Return (low, high): the bounds on ``letter`` by those relations e >= 0 that are linear in ``letter`` alone."""
    low, high = -inf, inf
    for e in relations:
        slope, at = approximate(diff(e, letter)), approximate(substitute(e, {letter: ZERO}))
        if slope and at is not None:
            low, high = (max(low, -at / slope), high) if slope > 0 else (low, min(high, -at / slope))
    return low, high


def _split(written: str, entries: Mapping[str, object]) -> tuple[str, str]:
    """Return the joint's name, and `angle` or `displacement` if that is written after a point, else ""."""
    name, dot_, what = written.rpartition(".")
    return (name, what) if dot_ and written not in entries else (written, "")


def _in_turns(e: Expr, measured: Mapping[Expr, MeasuredJoint]) -> Expr | None:
    """Return sum k_i angle_i = 0 with small integers k_i as Im prod z_i^k_i = 0, z_i at half the angle; else None."""
    terms = linear_terms(e)
    halves = {letter: measured[letter].half() for letter in terms if letter in measured}
    if len(halves) < len(terms) or any(half is None for half in halves.values()):
        return None
    factors = _whole([terms[letter] for letter in halves])
    if not factors or sum(map(abs, factors)) > MOST_TURNS:
        return None
    total = ONE, ZERO
    for half, k in zip(filter(None, halves.values()), factors, strict=True):
        factor = half if k > 0 else (half[0], mul(MINUS_ONE, half[1]))
        for _ in range(abs(k)):
            total = _product(total, factor)
    return total[1]


def _product(first: tuple[Expr, Expr], second: tuple[Expr, Expr]) -> tuple[Expr, Expr]:
    """Return the product of two complex numbers, each given as (real part, imaginary part)."""
    imaginary = mul(first[0], second[1]) + mul(first[1], second[0])
    return difference(mul(first[0], second[0]), mul(first[1], second[1])), imaginary


def _whole(factors: Sequence[Fraction]) -> list[int]:
    """Return the coprime integers in the ratio of ``factors``; an empty list if all are 0."""
    below = lcm(*(f.denominator for f in factors))
    above = [int(f * below) for f in factors]
    common = gcd(*above)
    return [a // common for a in above] if common else []
