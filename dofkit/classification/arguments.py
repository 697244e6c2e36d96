"""The arguments by which answers are given: what each shows, from which hypotheses, and which function checks these.

An answer that is sure names a row here: `dofkit.base.verdicts.Claim` lets none be written without. The criteria for
motions at a drawing are rows of their own table (`configuration/local/criteria.py`), and are told here as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from dofkit.base.verdicts import ArgumentKey
from dofkit.configuration.local.criteria import CRITERIA


class Argument(NamedTuple):
    """A row: what it ``claims``, the key of its ``theorem`` in `THEOREMS.md` ("" where it is a definition or a count).

    ``hypotheses`` in words; ``checked_by``: the function that checks them; ``evidence``: what a case at hand leaves
    that a second program could check again.
    """

    claims: str
    theorem: str
    hypotheses: str
    checked_by: str
    evidence: str


_POINT = "a point: a box with its rows and columns, or rational coordinates"
_OWN: dict[ArgumentKey, Argument] = {
    "nothing constrains": Argument(
        "every coordinate is free", "", "no relation mentions them", "dofkit.configuration.search.find", "nothing"
    ),
    "regular point": Argument(
        "near the witness the set is a manifold of dimension n - r",
        "ImplicitFunctions",
        "interval Newton certifies a zero of r relations, all of them, with independent differentials",
        "dofkit.configuration.reality.with_reality",
        _POINT,
    ),
    "one relation": Argument(
        "the set has dimension n - 1, and no part is larger",
        "ImplicitFunctions",
        "one relation, not 0 everywhere, with a certified regular zero",
        "dofkit.configuration.components.of_largest_part",
        _POINT,
    ),
    "graph": Argument(
        "the set is a graph over the other coordinates",
        "ImplicitFunctions",
        "each relation gives a coordinate that stands in it once, times a number, after those before are put in",
        "dofkit.configuration.components.explicit_relations",
        "the coordinates in their order",
    ),
    "joints that close no loop": Argument(
        "each joint takes the freedoms away that it does not leave, everywhere",
        "GrueblerKutzbach",
        "each is drawn and the only thing between two parts of the scene, of which one can be moved as one body",
        "dofkit.mobility.bridges.bridges",
        "a minor",
    ),
    "generic fibre": Argument(
        "for almost all values of the parameters the set is a manifold",
        "Sard1942",
        "each relation has a parameter of its own in which it is nowhere stationary",
        "dofkit.configuration.components.of_largest_part",
        "a parameter for each relation",
    ),
    "cases": Argument(
        "no part of the set is larger than that of the witness",
        "Buchberger1965",
        "all cases (a factor is 0; a coefficient is 0, or is divided by) have complex points of that dimension at most",
        "dofkit.configuration.cases.cases_of",
        "the cases with their bases",
    ),
    "isolated zeros": Argument(
        "some coordinates have isolated values, the others are free or given by them",
        "IsolatedZeros",
        "relations of one coordinate each, analytic everywhere and not 0 everywhere, with an exact common zero",
        "dofkit.configuration.isolated_zeros.isolated",
        "the zeros",
    ),
    "singular values": Argument(
        "the rank of measured geometry",
        "",
        "a gap between singular values",
        "dofkit.configuration.drawing.measured.measure",
        "the singular values",
    ),
    "links in general position": Argument(
        "the rank of generic links",
        "PollaczekGeiringer1927",
        "nothing but links, each of a length that nothing else mentions",
        "dofkit.mobility.frameworks.framework_answer",
        "an orientation, or a minor at random whole numbers",
    ),
    "linear contradiction": Argument(
        "no configuration satisfies the relations",
        "",
        "a combination of linear relations over the rationals is a number that is not 0",
        "dofkit.relations.linear.presolve",
        "the factors of the combination",
    ),
    "no real solution": Argument(
        "no real configuration satisfies the relations",
        "Moore1966",
        "boxes that cover projective space are excluded one by one",
        "dofkit.relations.normal.no_solution.no_solution",
        "the tree of boxes",
    ),
    "lengths compared": Argument(
        "no places have the distances that are asked for",
        "Menger1928",
        "a side longer than the way by the others, or distances whose determinant has the wrong sign",
        "dofkit.configuration.distance_geometry.lengths_unmet",
        "the side and the way, or the joints",
    ),
    "inequality nowhere": Argument(
        "an inequality holds nowhere",
        "Sylvester1852",
        "its expression has one sign",
        "dofkit.relations.normal.one_sided.holds_somewhere",
        "a sum of squares, or boxes",
    ),
    "outside the domain": Argument(
        "the relations have no value where they hold",
        "",
        "what stands in a root, a logarithm or below a line is negative, or 0, wherever they hold",
        "dofkit.classification.freedom.domain.restricted_to_domain",
        "the condition",
    ),
    "number left over": Argument(
        "no configuration satisfies the relations",
        "SchwartzZippel",
        "eliminating all unknowns leaves a number that is not 0",
        "dofkit.configuration.search.find",
        "the number",
    ),
    "time fixed": Argument(
        "no motion through an interval of time satisfies the relations",
        "SchwartzZippel",
        "dt lies in the span of the rows, and the relation that this forces holds at single moments",
        "dofkit.integrability.prolongation.confinements",
        "the combination of rows",
    ),
    "generic points": Argument(
        "what holds at random points holds on the set",
        "SchwartzZippel",
        "points over GF(p) drawn on the set",
        "dofkit.configuration.generic_dimension.variety_at",
        "the points",
    ),
    "Lie algebra, certified": Argument(
        "the freedom is n less the rank of the largest integrable part",
        "HermannNagano",
        "brackets proved to be independent, and nothing left over; or as many rows that integrate by themselves",
        "dofkit.integrability.labels_by_field.certificate",
        "brackets and a minor of theirs",
    ),
    "Lie algebra at points": Argument(
        "the freedom is n less the rank of the largest integrable part",
        "SontagCoron1992",
        "brackets along a random admissible curve over GF(p)",
        "dofkit.integrability.lie_algebra_at_points.span_at",
        "the points",
    ),
    "Lie algebra with balls": Argument(
        "the freedom is n less the rank of the largest integrable part",
        "SontagCoron1992",
        "what a tiny ball contains 0 of is 0",
        "dofkit.integrability.lie_algebra_at_points.ball_span",
        "the point",
    ),
    "states of motion": Argument(
        "the velocities that nonlinear relations allow",
        "ImplicitFunctions",
        "a certified state of motion, and curves of velocities that span what the linear relations leave",
        "dofkit.integrability.nonlinear_velocities.set_velocity_freedom",
        "the state",
    ),
    "finite relation": Argument(
        "holonomic",
        "",
        "it is a relation between coordinates and time",
        "dofkit.classification.labels.entry.entry",
        "the text",
    ),
    "inequality": Argument(
        "not holonomic", "", "it is an inequality", "dofkit.classification.labels.entry.entry", "the text"
    ),
    "one side": Argument(
        "not holonomic",
        "",
        "a certified state of motion that the lines of the constraint allow lies beyond the side to which it keeps",
        "dofkit.classification.labels.one_sided.with_sides",
        "the state",
    ),
    "curved velocities": Argument(
        "not holonomic",
        "",
        "the velocities that it allows lie in no affine space that the linear relations do not leave",
        "dofkit.integrability.nonlinear_velocities.set_velocity_freedom",
        "the state and the curves",
    ),
    "line field": Argument(
        "holonomic",
        "Frobenius1877",
        "the constraints leave one direction",
        "dofkit.integrability.labels_by_field.field_labels",
        "a minor",
    ),
    "form by itself": Argument(
        "holonomic",
        "Frobenius1877",
        "closed, in two variables, d(omega) ^ omega = 0 in the canonical ring, or an integral that was checked",
        "dofkit.integrability.single_form.proof",
        "the integral and its factor",
    ),
    "in the integrable part": Argument(
        "holonomic",
        "HermannNagano",
        "the form annihilates the Lie algebra at random points over GF(p)",
        "dofkit.integrability.labels_by_field.field_labels",
        "structure functions",
    ),
    "outside the integrable part": Argument(
        "not holonomic",
        "HermannNagano",
        "the form pairs with a bracket to a number that is proved not to be 0",
        "dofkit.integrability.labels_by_field.certificate",
        "the bracket as a word",
    ),
    "as written": Argument("a label", "", "it is read off the text", "dofkit.integrability.traits.traits", "the text"),
    "identity": Argument(
        "an expression is 0",
        "",
        "its canonical form is 0",
        "dofkit.exact.zero.identity.zero_and_verdict",
        "the expression",
    ),
    "zero with another derivative": Argument(
        "an expression is not 0 where another is",
        "KrawczykNewton",
        "a certified zero at which its ball excludes 0",
        "dofkit.integrability.traits.traits",
        _POINT,
    ),
    "rank at the reference": Argument(
        "the velocities that the rows allow at the reference",
        "",
        "as many rows, or velocities of the whole, as the rank over GF(p) says; else the rank over the rationals",
        "dofkit.configuration.drawing.at_reference.at_reference",
        "the rows, and a minor",
    ),
    "zero at the reference": Argument(
        "the relations hold at the reference",
        "",
        "their values there are 0 in exact arithmetic",
        "dofkit.exact.points.exact.vanish_exactly",
        "the reference",
    ),
    "free Lie algebra": Argument(
        "dimensions of brackets",
        "Witt1937",
        "they grow as fast as can be, and what is not 0 over GF(p) is not 0",
        "dofkit.integrability.growth_vector.is_free",
        "words and a minor",
    ),
    "brackets at points": Argument(
        "dimensions of brackets",
        "SchwartzZippel",
        "ranks along random curves over GF(p)",
        "dofkit.integrability.growth_vector.growth",
        "words",
    ),
    "rows at a point": Argument(
        "what depends on what",
        "Whitney1935",
        "the rows of the Jacobian at a generic point, or at the reference",
        "dofkit.classification.dependence.circuits.analyse",
        "the factors of each dependence",
    ),
    "implication": Argument(
        "a constraint holds where the others do",
        "SchwartzZippel",
        "it does at drawn states on every branch of theirs",
        "dofkit.classification.dependence.implication.follows",
        "cofactors",
    ),
    "leaving out": Argument(
        "no constraint of a set can be spared",
        "",
        "without any one of them the others hold somewhere",
        "dofkit.classification.dependence.conflicts.conflict",
        "a point for each",
    ),
    "count": Argument(
        "a number that follows from others", "", "the others", "dofkit.classification.claims.claims", "the others"
    ),
    "exact elimination": Argument(
        "all that is asked of linear relations",
        "",
        "coefficients are rational numbers, and every row that is a sum of others has the same sum on its right side",
        "dofkit.configuration.linear_blocks.elimination",
        "the factors of each sum",
    ),
    "met at a point": Argument(
        "inequalities can all be met",
        "KrawczykNewton",
        "a certified point of the constraints at which each holds",
        "dofkit.classification.feasibility.feasibility.feasibility",
        _POINT,
    ),
    "excluded together": Argument(
        "inequalities cannot all be met",
        "Motzkin1936",
        "a combination that contradicts itself, or boxes that cover space",
        "dofkit.classification.feasibility.refutation.refuted",
        "the multipliers, or the tree of boxes",
    ),
    "one method alone": Argument(
        "what a method that was asked alone is sound for",
        "",
        "those of the method's own row",
        "dofkit.methods.shared.reporting.report_alone",
        "what the method tells",
    ),
}


def _rows() -> Iterator[tuple[ArgumentKey, Argument]]:
    yield from _OWN.items()
    for row in CRITERIA:
        check = f"{row.applies.__module__}.{row.applies.__name__}"
        yield (
            row.key,
            Argument(row.concludes, row.theorem, row.hypotheses, check, "the reference, and what the criterion saw"),
        )


TABLE: Mapping[ArgumentKey, Argument] = dict(_rows())
