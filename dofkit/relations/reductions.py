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
        "the zeros between equations that share no coordinate",
        "the configuration space is a product, and the codistribution, its derived flag and its rank are direct sums",
    ),
    "twins": Reduction(
        "equal blocks once",
        "blocks that equal another one up to the names of coordinates",
        "renaming coordinates is a diffeomorphism, and every answer is invariant under those",
    ),
    "copies": Reduction(
        "constraints written twice",
        "equations that an earlier constraint states already, up to a numerical factor",
        "the solution set and the span are the same; which constraints are redundant is known from the list of copies",
    ),
    "still": Reduction(
        "bodies that do not turn",
        "where equations are evaluated at the reference configuration, the angles that a linear equation fixes or "
        "relates to other angles",
        "the configuration space is a graph over the other coordinates, so they are coordinates of it",
    ),
    "welds": Reduction(
        "welded bodies are one",
        "where equations are evaluated at the reference configuration, the coordinates of the second body of a linear "
        "weld, whose frames coincide there",
        "the set is a graph over the coordinates of the first body",
    ),
    "clusters": Reduction(
        "rigid clusters of links are one body",
        "where equations are evaluated at the reference configuration in the plane, all but two particles of a cluster "
        "whose links are infinitesimally rigid there, at rational positions",
        # [AsimowRoth1978]
        "infinitesimal rigidity implies rigidity (Asimow and Roth): near the reference configuration the cluster moves "
        "as one body",
    ),
    "eliminations": Reduction(
        "explicit coordinates",
        "linear holonomic equations, solved beforehand and not at every point; where equations are evaluated at the "
        "reference configuration, the coordinates that such an equation gives (z = 0)",
        "an invertible change of linear equations has the same solutions (Gauss), and they are a graph",
    ),
    "bridges": Reduction(
        "joints that close no loop",
        "at a reference configuration, the equations of joints that alone connect some bodies to the others; in space "
        "they are not written out",
        "the set is a product with the joint's own manifold, after moving these bodies as one; so its equations are "
        "independent of all others",
    ),
    "classes": Reduction(
        "classes of dependent relations",
        "at a reference configuration, equations in no dependent set are not evaluated further; the others are "
        "treated class by class, and a class that allows rigid motions only is one body",
        # [ImplicitFunctions] [AsimowRoth1978]
        "where every class defines a manifold, so do all equations together (implicit function theorem); "
        "infinitesimal rigidity implies rigidity (Asimow and Roth)",
    ),
    "closed": Reduction(
        "no Frobenius test of holonomic equations",
        "the integrability test of blocks all of whose equations are holonomic",
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
