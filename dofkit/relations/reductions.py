"""What need not be modelled, as a table: what each reduction leaves out, and why no answer changes by it.

Every reduction can be left out: a `Setting` carries the names of those in use, so the cost of each can be measured
(`dofkit.benchmark.ablation`) and that it changes no answer can be tested.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

ReductionName = Literal[
    "untouched",
    "blocks",
    "twins",
    "copies",
    "still",
    "welds",
    "clusters",
    "eliminations",
    "bridges",
    "classes",
    "closed",
    "cheapest",
]
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
    "still": Reduction(
        "bodies that do not turn",
        "where relations are followed from a drawing, the angles that a linear relation fixes or ties to other angles",
        "the configuration space is a graph over the other coordinates, so they are coordinates of it",
    ),
    "welds": Reduction(
        "welded bodies are one",
        "where relations are followed from a drawing, the coordinates of the second body of a weld that is linear: of "
        "bodies whose frames coincide there",
        "the set is a graph over the coordinates of the first body",
    ),
    "clusters": Reduction(
        "rigid clusters of links are one body",
        "where relations are followed from a drawing in the plane, all but two particles of a cluster whose links are "
        "infinitesimally rigid there, at rational places",
        # [AsimowRoth1978]
        "infinitesimally rigid is rigid (Asimow and Roth): near the drawing the cluster is where a body takes it",
    ),
    "eliminations": Reduction(
        "explicit coordinates",
        "linear relations among the finite ones, solved beforehand and not at every point; where relations are "
        "followed from a drawing, the coordinates that such a relation gives (z = 0)",
        "an invertible change of linear equations has the same solutions (Gauss), and they are a graph",
    ),
    "bridges": Reduction(
        "joints that close no loop",
        "at a drawing, the equations of joints that are all that holds some bodies to the rest; in space they are not "
        "even written out",
        "the set is a product with the joint's own manifold, after moving these bodies as one; so its equations are "
        "independent of all others",
    ),
    "classes": Reduction(
        "classes of dependent relations",
        "at a drawing, relations that are in no dependent set are not followed; the others class by class, and a class "
        "that leaves the motions of a rigid body only is one",
        # [ImplicitFunctions] [AsimowRoth1978]
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
