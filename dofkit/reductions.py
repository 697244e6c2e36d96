"""What need not be modelled, as a table: what each reduction leaves out, and why no answer changes by it.

Every reduction can be left out: a `Setting` carries the names of those in use, so the cost of each can be measured
(`dofkit.chart.ablation`) and that it changes no answer can be tested.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

ReductionName = Literal["untouched", "blocks", "twins", "copies", "eliminations", "classes", "closed", "cheapest"]
Reductions = frozenset[ReductionName]


class Reduction(NamedTuple):
    """``title``: a few words for a chart; ``leaves_out``: of the model; ``sound``: why nothing changes."""

    title: str
    leaves_out: str
    sound: str


REDUCTIONS: Mapping[ReductionName, Reduction] = {
    "untouched": Reduction(
        "coordinates nothing touches",
        "coordinates that occur in no relation, coefficients and velocities included",
        "the configuration space is a product with a line for each of them",
    ),
    "blocks": Reduction(
        "independent blocks",
        "the zeros between relations that share no coordinate anywhere",
        "the configuration space is a product, and the codistribution, its derived flag and its rank are direct sums",
    ),
    "twins": Reduction(
        "equal blocks once",
        "blocks that are another one's up to the names of coordinates",
        "renaming coordinates is a diffeomorphism, and every answer is invariant under those",
    ),
    "copies": Reduction(
        "constraints written twice",
        "relations that an earlier constraint wrote already, up to a number",
        "the same set and the same span; what is redundant is told from the list of copies",
    ),
    "eliminations": Reduction(
        "explicit coordinates",
        "linear relations among the finite ones: they are solved beforehand, exactly, and not at every point",
        "an invertible change of a system of linear equations has the same solutions (Gauss)",
    ),
    "classes": Reduction(
        "classes of dependent relations",
        "at a drawing, relations that are in no dependent set are not followed; the others class by class, and a class "
        "that leaves the motions of a rigid body only is one",
        "where every class cuts out a manifold, so do all relations together (implicit function theorem); "
        "infinitesimally rigid is rigid (Asimow and Roth)",
    ),
    "closed": Reduction(
        "no Frobenius test of finite relations",
        "the integrability test of blocks all of whose relations are finite",
        "d(dg) = 0: their differentials are closed, so they are in I^(inf)",
    ),
    "cheapest": Reduction(
        "the cheapest sound method",
        "coordinates altogether, where generic rigid links between particles are answered by counting in their graph",
        "Pollaczek-Geiringer and Laman in the plane, spanning forests on the line; in space a rank at random positions",
    ),
}

#: All of them: what is in use unless something else is asked for.
ALL: Reductions = frozenset(REDUCTIONS)
