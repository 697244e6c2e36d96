"""The arguments by which answers are given: what each shows, from which hypotheses, and which function checks these.

An answer that is sure names a row here: `dofkit.base.verdicts.Claim` lets none be written without. The criteria for
motions at a drawing are rows of their own table (`configuration/local/criteria.py`), and are told here as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from dofkit.base.verdicts import ArgumentKey
from dofkit.configuration.local.criteria import CONCLUSIONS, CRITERIA


class Argument(NamedTuple):
    """A row: what it ``claims``, the key of its ``theorem`` in `THEOREMS.md` ("" where it is a definition or a count).

    ``hypotheses`` in words; ``checked_by``: the function that checks them.
    """

    claims: str
    theorem: str
    hypotheses: str
    checked_by: str


_OWN: dict[ArgumentKey, Argument] = {
    "nothing constrains": Argument(
        "every coordinate is free", "", "no equation contains them", "dofkit.configuration.search.find"
    ),
    "regular point": Argument(
        "near the witness the configuration space is a manifold of dimension n - r",
        "ImplicitFunctions",
        "interval Newton certifies a common zero of all r equations, at which their differentials are independent",
        "dofkit.configuration.generic_dimension.with_reality",
    ),
    "one relation": Argument(
        "the configuration space has dimension n - 1, and no component is larger",
        "ImplicitFunctions",
        "there is one equation, which is not identically zero and has a certified regular zero",
        "dofkit.configuration.components.of_largest_part",
    ),
    "graph": Argument(
        "the configuration space is a graph over the other coordinates",
        "ImplicitFunctions",
        "each equation determines a coordinate that occurs in it linearly with a constant coefficient, after "
        "the preceding ones are substituted",
        "dofkit.relations.linear_relations.explicit_relations",
    ),
    "joints that close no loop": Argument(
        "each joint removes its number of conditions from the freedom, everywhere",
        "GrueblerKutzbach",
        "each joint has a reference position and is the only connection between two parts of the system, one "
        "of which can be moved as a rigid body",
        "dofkit.mobility.joint_tree.bridges",
    ),
    "generic fibre": Argument(
        "for almost all values of the parameters the configuration space is a manifold",
        "Sard1942",
        "each equation has a parameter of its own, and its derivative by that parameter vanishes nowhere",
        "dofkit.configuration.components.of_largest_part",
    ),
    "cases": Argument(
        "no component is larger than that of the witness",
        "Buchberger1965",
        "in every case (a factor is zero; a coefficient is zero or is divided by) the complex solutions have "
        "at most that dimension",
        "dofkit.configuration.cases.cases_of",
    ),
    "singular values": Argument(
        "the rank of measured geometry",
        "",
        "the singular values are separated by a gap",
        "dofkit.configuration.measured.dimension.measured_freedom",
    ),
    "links in general position": Argument(
        "the rank of generic links",
        "PollaczekGeiringer1927",
        "all constraints are links, each with a length that occurs nowhere else",
        "dofkit.mobility.general_position.framework_answer",
    ),
    "linear contradiction": Argument(
        "no configuration satisfies the equations",
        "",
        "a rational combination of linear equations is a nonzero number",
        "dofkit.relations.linear_relations.solve_linear",
    ),
    "no real solution": Argument(
        "no real configuration satisfies the equations",
        "Moore1966",
        "every box of a cover of projective space is excluded",
        "dofkit.relations.normal.no_solution.no_solution",
    ),
    "lengths compared": Argument(
        "no positions have the given distances",
        "Menger1928",
        "one distance exceeds the sum of the others on a cycle, or a Cayley-Menger determinant has the wrong sign",
        "dofkit.configuration.distance_geometry.lengths_unmet",
    ),
    "inequality nowhere": Argument(
        "an inequality is satisfied nowhere",
        "Sylvester1852",
        "its expression has one sign",
        "dofkit.relations.normal.no_solution.holds_somewhere",
    ),
    "outside the domain": Argument(
        "the equations have no value on their own solution set",
        "",
        "the argument of a root or logarithm is negative, or a denominator is zero, wherever they are satisfied",
        "dofkit.classification.freedom.common_point.restricted_to_domain",
    ),
    "number left over": Argument(
        "no configuration satisfies the equations",
        "SchwartzZippel",
        "eliminating all unknowns leaves a nonzero number",
        "dofkit.configuration.search.find",
    ),
    "time fixed": Argument(
        "no motion through an interval of time satisfies the equations",
        "SchwartzZippel",
        "dt lies in the span of the rows, and the resulting equation is satisfied at isolated instants only",
        "dofkit.integrability.pfaffian_system.confinements",
    ),
    "generic points": Argument(
        "an identity at random points holds on the configuration space",
        "SchwartzZippel",
        "random points over GF(p) satisfy the equations",
        "dofkit.configuration.generic_dimension.variety_at",
    ),
    "Lie algebra, certified": Argument(
        "the degrees of freedom are n minus the rank of the largest integrable subsystem",
        "HermannNagano",
        "the Lie brackets are proved to be independent and leave nothing undetermined, or as many rows "
        "integrate on their own",
        "dofkit.integrability.row_labels.certificate",
    ),
    "Lie algebra at points": Argument(
        "the degrees of freedom are n minus the rank of the largest integrable subsystem",
        "SontagCoron1992",
        "Lie brackets along a random admissible curve over GF(p)",
        "dofkit.integrability.lie_algebra.span_at",
    ),
    "Lie algebra with balls": Argument(
        "the degrees of freedom are n minus the rank of the largest integrable subsystem",
        "SontagCoron1992",
        "a value whose tiny enclosure contains zero is zero",
        "dofkit.integrability.lie_algebra.ball_span",
    ),
    "states of motion": Argument(
        "the velocities that nonlinear equations allow",
        "ImplicitFunctions",
        "a certified state of motion, and curves of admissible velocities that span the solutions of the "
        "linear equations",
        "dofkit.integrability.nonlinear_velocities.set_velocity_freedom",
    ),
    "finite relation": Argument(
        "the constraint is holonomic",
        "",
        "it relates coordinates and time only",
        "dofkit.classification.labels.entry.entry",
    ),
    "inequality": Argument(
        "the constraint is not holonomic",
        "",
        "it is an inequality",
        "dofkit.classification.labels.entry.entry",
    ),
    "curved velocities": Argument(
        "the constraint is not holonomic",
        "",
        "the velocities that it allows span the affine space that the linear equations leave",
        "dofkit.integrability.nonlinear_velocities.set_velocity_freedom",
    ),
    "line field": Argument(
        "the constraint is holonomic",
        "Frobenius1877",
        "the constraints leave one direction",
        "dofkit.integrability.row_labels.field_labels",
    ),
    "form by itself": Argument(
        "the constraint is holonomic",
        "Frobenius1877",
        "the form is closed, has two variables, satisfies d(omega) ^ omega = 0, or has a verified integral",
        "dofkit.integrability.traits.proof",
    ),
    "in the integrable part": Argument(
        "the constraint is holonomic",
        "HermannNagano",
        "the form annihilates the Lie algebra at random points over GF(p)",
        "dofkit.integrability.row_labels.field_labels",
    ),
    "outside the integrable part": Argument(
        "the constraint is not holonomic",
        "HermannNagano",
        "the pairing of the form with a Lie bracket is proved to be nonzero",
        "dofkit.integrability.row_labels.certificate",
    ),
    "as written": Argument("a label", "", "it is read from the text", "dofkit.integrability.traits.traits"),
    "identity": Argument(
        "an expression is 0",
        "",
        "its canonical form is 0",
        "dofkit.exact.zero.zero_and_verdict",
    ),
    "zero with another derivative": Argument(
        "an expression is nonzero where another is zero",
        "KrawczykNewton",
        "the other has a certified zero, at which the enclosure of the expression excludes zero",
        "dofkit.integrability.traits.traits",
    ),
    "rank at the reference": Argument(
        "the velocities that the rows allow at the reference configuration",
        "",
        "the rank over GF(p) is that of all rows, or leaves only rigid motions of the system; otherwise the "
        "rank over the rationals",
        "dofkit.configuration.at_reference.at_reference",
    ),
    "zero at the reference": Argument(
        "the reference configuration satisfies the equations",
        "",
        "their values there are zero in exact arithmetic",
        "dofkit.exact.points.balls.vanish_exactly",
    ),
    "free Lie algebra": Argument(
        "dimensions of brackets",
        "Witt1937",
        "they attain the largest possible ranks, and a number that is nonzero over GF(p) is nonzero",
        "dofkit.integrability.lie_algebra.is_free",
    ),
    "brackets at points": Argument(
        "dimensions of brackets",
        "SchwartzZippel",
        "ranks along random curves over GF(p)",
        "dofkit.integrability.growth_vector.spanning_curves",
    ),
    "rows at a point": Argument(
        "dependences among the constraints",
        "Whitney1935",
        "the rows of the Jacobian at a generic point, or at the reference",
        "dofkit.classification.dependence.circuits.analyse",
    ),
    "implication": Argument(
        "a constraint is satisfied wherever the others are",
        "SchwartzZippel",
        "it is satisfied at random states on every branch of theirs",
        "dofkit.classification.dependence.implication.follows",
    ),
    "leaving out": Argument(
        "every constraint of the set is needed",
        "",
        "without any one of them the others can be satisfied",
        "dofkit.classification.dependence.implied_constraints.conflict",
    ),
    "count": Argument("a number determined by other fields", "", "the others", "dofkit.classification.passes.claims"),
    "exact elimination": Argument(
        "every field of a linear system",
        "",
        "the coefficients are rational numbers, and every linearly dependent row has the corresponding right-hand side",
        "dofkit.configuration.linear_blocks.elimination",
    ),
    "met at a point": Argument(
        "all inequalities can be satisfied",
        "KrawczykNewton",
        "a certified configuration of the constraints satisfies each of them",
        "dofkit.classification.feasibility.feasibility.feasibility",
    ),
    "excluded together": Argument(
        "the inequalities cannot all be satisfied",
        "Motzkin1936",
        "a contradictory combination, or a cover of space by excluded boxes",
        "dofkit.classification.feasibility.state_problem.refuted",
    ),
    "one method alone": Argument(
        "the answer of a single method",
        "",
        "those of the method's own row",
        "dofkit.methods.stages.report_of_method",
    ),
}


def _rows() -> Iterator[tuple[ArgumentKey, Argument]]:
    yield from _OWN.items()
    for row in CRITERIA:
        check, claims = f"{row.decide.__module__}.{row.decide.__name__}", CONCLUSIONS[row.concludes]
        yield row.key, Argument(claims, row.theorem, row.hypotheses, check)


TABLE: Mapping[ArgumentKey, Argument] = dict(_rows())
